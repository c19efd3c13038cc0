//! File formats, the verifier, and synthetic point clouds.

use js_sys::{Array, Float32Array, Float64Array, Int32Array, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::wasm::{
    objects::{error, object},
    points::{Coordinates, zeros},
};
use crate::{
    Mesh3,
    d3::{
        generate::{self, Distribution},
        verify::{MeshView, verify3d},
    },
    io::{PointBuf, PointCloud, PointFormat, SurfaceFormat, write_ele, write_neigh, write_node, write_npz, write_vtu},
    verify::{Check, Outcome, Report},
};

/// `count` points of the distribution of that name, interleaved.
#[wasm_bindgen]
pub fn generate(kind: &str, count: u32, seed: u64) -> Result<Float64Array, JsValue> {
    let names = || Distribution::ALL.map(Distribution::name).join(", ");
    let distribution = Distribution::ALL.into_iter().find(|d| d.name() == kind);
    let distribution = distribution
        .ok_or_else(|| error("BAD_INPUT", &format!("there is no distribution {kind:?}, but {}", names())))?;
    // Fails here where the points could not be held twice, and not half-way.
    drop(zeros::<[f64; 6]>(count)?);
    let points = generate::generate(distribution, count as usize, seed);
    Ok(Float64Array::new_from_slice(points.as_flattened()))
}

/// The extensions of the files that `read_points` knows.
#[wasm_bindgen]
pub fn point_extensions() -> Vec<String> {
    PointFormat::ALL.iter().flat_map(|format| format.extensions()).map(|&extension| extension.to_owned()).collect()
}

/// Reads a point cloud in the format of files with this extension.
#[wasm_bindgen]
pub fn read_points(bytes: &Uint8Array, extension: &str) -> Result<JsValue, JsValue> {
    let format = PointFormat::from_extension(extension)
        .ok_or_else(|| error("UNKNOWN_FORMAT", &format!("there is no format of point clouds named {extension:?}")))?;
    let mut content = zeros(bytes.length())?;
    bytes.copy_to(&mut content);
    let cloud: PointCloud = format.read(content).map_err(|e| error("BAD_FILE", &e.to_string()))?;
    let points = match &cloud.points {
        PointBuf::F32(points) => Float32Array::new_from_slice(points.as_flattened()).into(),
        PointBuf::F64(points) => Float64Array::new_from_slice(points.as_flattened()).into(),
    };
    Ok(object([("points", points), ("noReturn", (cloud.no_return as f64).into())]))
}

/// A mesh, copied into this module's memory.
#[wasm_bindgen]
pub struct Mesh {
    points: Coordinates,
    mesh: Mesh3,
    stated: Stated,
}

/// Which arrays the caller gave.
struct Stated {
    neighbors: bool,
    hull: bool,
    duplicate_of: bool,
    dimension: bool,
}

#[wasm_bindgen]
impl Mesh {
    #[wasm_bindgen(constructor)]
    pub fn new(
        points: &JsValue,
        tetrahedra: &Uint32Array,
        neighbors: Option<Int32Array>,
        hull: Option<Uint32Array>,
        duplicate_of: Option<Int32Array>,
        dimension: Option<u8>,
    ) -> Result<Mesh, JsValue> {
        let points = Coordinates::new(points)?;
        points.points::<3>()?.validate()?;
        let stated = Stated {
            neighbors: neighbors.is_some(),
            hull: hull.is_some(),
            duplicate_of: duplicate_of.is_some(),
            dimension: dimension.is_some(),
        };
        let mut mesh = Mesh3::default();
        mesh.tetrahedra = rows("tetrahedra", tetrahedra.length(), |to| tetrahedra.copy_to(to))?;
        mesh.neighbors = neighbors.map_or(Ok(vec![]), |a| rows("neighbors", a.length(), |to| a.copy_to(to)))?;
        mesh.hull = hull.map_or(Ok(vec![]), |a| rows("hull", a.length(), |to| a.copy_to(to)))?;
        mesh.duplicate_of = duplicate_of.map_or(Ok(vec![]), |a| copied(a.length(), |to| a.copy_to(to)))?;
        mesh.dimension = dimension.unwrap_or(3);
        Ok(Mesh { points, mesh, stated })
    }

    /// The mesh or its hull as files of a format: `{ extension: bytes }`, more than one only for TetGen.
    pub fn write(&self, format: &str) -> Result<JsValue, JsValue> {
        let points = self.points.points::<3>()?;
        let mesh = &self.mesh;
        check_vertices(mesh.tetrahedra.as_flattened().iter().chain(mesh.hull.as_flattened()), points.len())?;
        match format {
            "vtu" => Ok(object([file("vtu", |to| write_vtu(to, points, mesh))?])),
            "npz" => Ok(object([file("npz", |to| write_npz(to, points, mesh))?])),
            "tetgen" => Ok(object([
                file("node", |to| write_node(to, points))?,
                file("ele", |to| write_ele(to, mesh))?,
                file("neigh", |to| write_neigh(to, mesh))?,
            ])),
            _ => {
                let hull = SurfaceFormat::from_extension(format).ok_or_else(|| no_format(format))?;
                Ok(object([file(hull.extensions()[0], |to| hull.write(to, points, mesh))?]))
            }
        }
    }

    /// What the verifier finds.
    pub fn verify(&self) -> Result<JsValue, JsValue> {
        let Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension, .. } = &self.mesh;
        let mut view = MeshView::of_tetrahedra(tetrahedra);
        view.neighbors = self.stated.neighbors.then_some(neighbors);
        view.hull = self.stated.hull.then_some(hull);
        view.duplicate_of = self.stated.duplicate_of.then_some(duplicate_of);
        view.dimension = self.stated.dimension.then_some(*dimension);
        let report = verify3d(self.points.points::<3>()?, view)?;
        let counts = report.counts;
        Ok(report_object(
            &report,
            object([
                ("points", counts.points.into()),
                ("distinctPoints", counts.distinct_points.into()),
                ("vertices", counts.vertices.into()),
                ("edges", counts.edges.into()),
                ("facets", counts.facets.into()),
                ("tetrahedra", counts.tetrahedra.into()),
                ("hullTriangles", counts.hull_triangles.into()),
            ]),
        ))
    }
}

/// What the verifier found, with the counts that its dimension has.
pub(super) fn report_object(report: &Report, counts: JsValue) -> JsValue {
    let check = |(check, outcome): &(Check, Outcome)| {
        let (state, detail, count) = match outcome {
            Outcome::Passed => ("passed", String::new(), 0),
            Outcome::Failed { first, count } => ("failed", first.to_string(), *count),
            Outcome::NotStated => ("not stated", "the mesh does not state it".to_owned(), 0),
            Outcome::Blocked(required) => ("not decided", format!("not decided without {required}"), 0),
        };
        object([
            ("name", check.name().into()),
            ("outcome", state.into()),
            ("passed", matches!(outcome, Outcome::Passed).into()),
            ("detail", detail.into()),
            ("defects", count.into()),
        ])
    };
    let checks: Array = report.outcomes.iter().map(check).collect();
    object([
        ("passed", report.passed().into()),
        ("dimension", report.dimension.into()),
        ("checks", checks.into()),
        ("counts", counts),
    ])
}

/// The content of a file of the package, by its extension.
pub(super) fn file(
    extension: &'static str,
    write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>,
) -> Result<(&'static str, JsValue), JsValue> {
    let mut bytes = Vec::new();
    write(&mut bytes).map_err(|e| error("OUT_OF_MEMORY", &e.to_string()))?;
    Ok((extension, Uint8Array::new_from_slice(&bytes).into()))
}

/// The error for a format that no writer knows.
pub(super) fn no_format(format: &str) -> JsValue {
    error("UNKNOWN_FORMAT", &format!("there is no format {format:?} of meshes or hulls")).into()
}

/// Writers trust the indices of the vertices.
pub(super) fn check_vertices<'a>(mut vertices: impl Iterator<Item = &'a u32>, points: usize) -> Result<(), JsValue> {
    match vertices.find(|&&v| v as usize >= points) {
        Some(v) => Err(error("BAD_INPUT", &format!("the mesh names point {v}, but there are {points}")).into()),
        None => Ok(()),
    }
}

pub(super) fn copied<T: Clone + Default>(length: u32, copy: impl FnOnce(&mut [T])) -> Result<Vec<T>, JsValue> {
    let mut values = zeros(length)?;
    copy(&mut values);
    Ok(values)
}

pub(super) fn rows<T: bytemuck::Pod + Default, const N: usize>(
    name: &str,
    length: u32,
    copy: impl FnOnce(&mut [T]),
) -> Result<Vec<[T; N]>, JsValue> {
    if length as usize % N != 0 {
        return Err(error("BAD_INPUT", &format!("the length of {name}, {length}, is not a multiple of {N}")).into());
    }
    let mut rows = vec![];
    rows.try_reserve_exact(length as usize / N)
        .map_err(|_| error("OUT_OF_MEMORY", &format!("there is no room for {length} numbers of {name}")))?;
    rows.resize(length as usize / N, [T::default(); N]);
    copy(rows.as_flattened_mut());
    Ok(rows)
}
