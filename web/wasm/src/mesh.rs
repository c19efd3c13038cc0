//! Meshes from JavaScript.

#[cfg(feature = "tools")]
use gdel::Points;
#[cfg(any(feature = "edit", feature = "tools"))]
use gdel::{Mesh2, Mesh3};
use js_sys::{Float64Array, Int32Array, Uint32Array};
use wasm_bindgen::{JsCast, JsValue};

use crate::{
    objects::{Thrown, error, get},
    points::{room, zeros},
};

/// A mesh copied into this module's memory: `N` vertices per simplex, `H` per hull facet in `hull`.
/// `None` stands for what the caller did not state.
#[cfg_attr(not(feature = "tools"), expect(dead_code, reason = "hidden points are for proofs"))]
pub(crate) struct CallerMesh<const N: usize, const H: usize> {
    pub(crate) simplices: Vec<[u32; N]>,
    pub(crate) neighbors: Option<Vec<[u32; N]>>,
    pub(crate) hull: Option<Vec<[u32; H]>>,
    pub(crate) duplicate_of: Option<Vec<u32>>,
    pub(crate) dimension: Option<u8>,
    pub(crate) weights: Option<Vec<f64>>,
    pub(crate) hidden: Option<Vec<u32>>,
    /// In 2D.
    pub(crate) constraints: CallerConstraints,
}

/// The constraints of a mesh: its constrained edges, and the segments that these are pieces of.
#[derive(Default)]
pub(crate) struct CallerConstraints {
    pub(crate) edges: Vec<[u32; 2]>,
    #[cfg_attr(not(any(feature = "tools", feature = "edit")), expect(dead_code, reason = "segments are for proofs"))]
    pub(crate) segments: Option<Vec<[u32; 2]>>,
}

impl CallerConstraints {
    fn new(mesh: &JsValue) -> Result<Self, Thrown> {
        let constraints = get(mesh, "constraints");
        if constraints.is_undefined() || constraints.is_null() {
            return Ok(Self::default());
        }
        let pairs = |name: &str| {
            property::<Uint32Array>(&constraints, name)?
                .map(|array| rows(name, array.length(), |to| array.copy_to(to)))
                .transpose()
        };
        Ok(CallerConstraints { edges: pairs("edges")?.unwrap_or_default(), segments: pairs("segments")? })
    }
}

/// Returns whether each triangle is inside the boundaries of the constraints; nothing without constraints.
#[cfg(any(feature = "edit", feature = "derived"))]
pub(crate) fn inside_of(mesh: &JsValue) -> Result<Vec<bool>, Thrown> {
    let inside = property::<js_sys::Uint8Array>(&get(mesh, "constraints"), "inside")?.map(|inside| inside.to_vec());
    Ok(inside.unwrap_or_default().into_iter().map(|inside| inside != 0).collect())
}

impl<const N: usize, const H: usize> CallerMesh<N, H> {
    /// Copies the arrays of `mesh`, of which those of simplices and neighbors have these names.
    pub(crate) fn new(mesh: &JsValue, simplices: &str, neighbors: &str) -> Result<Self, Thrown> {
        let all = property::<Uint32Array>(mesh, simplices)?;
        let all = all.ok_or_else(|| error("BAD_INPUT", &format!("the mesh has no {simplices}")))?;
        Ok(CallerMesh {
            simplices: rows(simplices, all.length(), |to| all.copy_to(to))?,
            neighbors: property::<Int32Array>(mesh, neighbors)?
                .map(|array| {
                    rows(neighbors, array.length(), |to| array.copy_to(bytemuck::cast_slice_mut::<u32, _>(to)))
                })
                .transpose()?,
            hull: property::<Uint32Array>(mesh, "hull")?
                .map(|array| rows("hull", array.length(), |to| array.copy_to(to)))
                .transpose()?,
            duplicate_of: property::<Int32Array>(mesh, "duplicateOf")?
                .map(|array| {
                    let mut values: Vec<u32> = zeros(array.length())?;
                    array.copy_to(bytemuck::cast_slice_mut(&mut values));
                    Ok::<_, Thrown>(values)
                })
                .transpose()?,
            dimension: get(mesh, "dimension").as_f64().map(|dimension| dimension as u8),
            weights: property::<Float64Array>(mesh, "weights")?
                .map(|array| {
                    let mut values: Vec<f64> = zeros(array.length())?;
                    array.copy_to(&mut values);
                    Ok::<_, Thrown>(values)
                })
                .transpose()?,
            hidden: property::<Uint32Array>(mesh, "hidden")?
                .map(|array| {
                    let mut values: Vec<u32> = zeros(array.length())?;
                    array.copy_to(&mut values);
                    Ok::<_, Thrown>(values)
                })
                .transpose()?,
            constraints: CallerConstraints::new(mesh)?,
        })
    }

    /// Checks that all vertices are among the points, which the writers rely on.
    #[cfg(feature = "tools")]
    pub(crate) fn check_vertices<const D: usize>(&self, points: Points<'_, D>) -> Result<(), Thrown> {
        let mut vertices = self.simplices.as_flattened().iter().chain(self.hull.iter().flatten().flatten());
        match vertices.find(|&&v| v as usize >= points.len()) {
            Some(v) => {
                let message = format!("a vertex of the mesh is point {v}, but there are only {} points", points.len());
                Err(error("BAD_INPUT", &message).into())
            }
            None => Ok(()),
        }
    }

    /// Takes the weights, of which there are as many as points or none, and which points are hidden.
    #[cfg(feature = "tools")]
    pub(crate) fn take_weights(&mut self, points: usize) -> Result<(Vec<f64>, Vec<u32>), Thrown> {
        let weights = self.weights.take().unwrap_or_default();
        if !weights.is_empty() && weights.len() != points {
            let message = format!("there are {} weights for {points} points", weights.len());
            return Err(error("BAD_INPUT", &message).into());
        }
        Ok((weights, self.hidden.take().unwrap_or_default()))
    }
}

#[cfg(any(feature = "edit", feature = "tools"))]
impl From<CallerMesh<4, 3>> for Mesh3 {
    fn from(caller: CallerMesh<4, 3>) -> Mesh3 {
        let mut mesh = Mesh3::default();
        mesh.tetrahedra = caller.simplices;
        mesh.neighbors = caller.neighbors.unwrap_or_default();
        mesh.hull = caller.hull.unwrap_or_default();
        mesh.duplicate_of = caller.duplicate_of.unwrap_or_default();
        mesh.dimension = caller.dimension.unwrap_or(3);
        mesh
    }
}

#[cfg(any(feature = "edit", feature = "tools"))]
impl From<CallerMesh<3, 1>> for Mesh2 {
    fn from(caller: CallerMesh<3, 1>) -> Mesh2 {
        let mut mesh = Mesh2::default();
        mesh.triangles = caller.simplices;
        mesh.halfedges = caller.neighbors.unwrap_or_default();
        mesh.hull = caller.hull.unwrap_or_default().into_iter().flatten().collect();
        mesh.duplicate_of = caller.duplicate_of.unwrap_or_default();
        mesh.dimension = caller.dimension.unwrap_or(2);
        mesh.constraints = caller.constraints.edges;
        mesh
    }
}

/// Returns a property that is an array, or `None` if it is undefined.
pub(crate) fn property<T: JsCast>(object: &JsValue, name: &str) -> Result<Option<T>, Thrown> {
    let value = get(object, name);
    if value.is_undefined() {
        return Ok(None);
    }
    let array = value.dyn_into();
    Ok(Some(array.map_err(|_| error("BAD_INPUT", &format!("{name} is not an array of the required type")))?))
}

fn rows<T: bytemuck::Pod + Default, const N: usize>(
    name: &str,
    length: u32,
    copy: impl FnOnce(&mut [T]),
) -> Result<Vec<[T; N]>, Thrown> {
    let length = length as usize;
    if !length.is_multiple_of(N) {
        return Err(error("BAD_INPUT", &format!("the length of {name}, {length}, is not a multiple of {N}")).into());
    }
    let mut rows = room(length / N)?;
    rows.resize(length / N, [T::default(); N]);
    copy(rows.as_flattened_mut());
    Ok(rows)
}
