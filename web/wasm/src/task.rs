//! A mesh of the package with its points, for the modules that derive something from it. 2D meshes have delaunator's
//! orientation: they are made counter-clockwise by the negation of all *y*, which is undone in what is returned.

use crate::{
    mesh::CallerMesh,
    objects::{Thrown, error, get},
    points::{Coordinates, points_of_mesh},
};
use gdel::{Error, Mesh, Mesh2, Mesh3};
use js_sys::{Float64Array, Function};
use wasm_bindgen::prelude::JsValue;

/// Calls a function for the meshes of 2 or 3 dimensions.
macro_rules! in_dimension {
    ($dimension:ident, $function:ident($($argument:ident),*)) => {
        match $dimension {
            2 => $function::<Mesh2, 2, 3>($($argument),*),
            _ => $function::<Mesh3, 3, 4>($($argument),*),
        }
    };
}
pub(crate) use in_dimension;

/// A mesh of the package.
pub trait OfCaller<const D: usize, const N: usize>: Mesh<D, N> + Sized {
    /// The name of the array of simplices.
    const SIMPLICES: &str;

    /// Copies a mesh.
    fn of_caller(mesh: &JsValue) -> Result<Self, Thrown>;
}

impl OfCaller<3, 4> for Mesh3 {
    const SIMPLICES: &str = "tetrahedra";

    fn of_caller(mesh: &JsValue) -> Result<Self, Thrown> {
        let caller = CallerMesh::<4, 3>::new(mesh, Self::SIMPLICES, "neighbors")?;
        let mut mesh = Mesh3::default();
        mesh.tetrahedra = caller.simplices;
        mesh.neighbors = caller.neighbors.unwrap_or_default();
        mesh.duplicate_of = caller.duplicate_of.unwrap_or_default();
        mesh.weights = caller.weights.unwrap_or_default();
        Ok(mesh)
    }
}

impl OfCaller<2, 3> for Mesh2 {
    const SIMPLICES: &str = "triangles";

    fn of_caller(mesh: &JsValue) -> Result<Self, Thrown> {
        let caller = CallerMesh::<3, 1>::new(mesh, Self::SIMPLICES, "halfedges")?;
        let mut mesh = Mesh2::default();
        mesh.triangles = caller.simplices;
        mesh.halfedges = caller.neighbors.unwrap_or_default();
        mesh.duplicate_of = caller.duplicate_of.unwrap_or_default();
        mesh.weights = caller.weights.unwrap_or_default();
        mesh.constraints = caller.constraints.edges;
        Ok(mesh)
    }
}

/// A mesh with its points, and who is told how far the work has come.
pub struct Task<M> {
    pub points: Coordinates,
    pub mesh: M,
    pub report: Function,
    pub phase: &'static str,
}

impl<M> Task<M> {
    /// Copies points and mesh, and reports that the work begins.
    pub fn new<const D: usize, const N: usize>(
        points: &JsValue,
        mesh: &JsValue,
        report: Function,
        phase: &'static str,
    ) -> Result<Self, Thrown>
    where
        M: OfCaller<D, N>,
    {
        let mut points = points_of_mesh::<D>(points)?;
        if D == 2 {
            points.flip_y();
        }
        let task = Task { points, mesh: M::of_caller(mesh)?, report, phase };
        task.report(0.1)?;
        Ok(task)
    }

    /// Reports the progress, and returns an error if the task is to end.
    pub fn report(&self, fraction: f64) -> Result<(), Error> {
        match self.report.call2(&JsValue::NULL, &self.phase.into(), &fraction.into()) {
            Ok(stop) if stop.is_falsy() => Ok(()),
            _ => Err(Error::Cancelled),
        }
    }
}

/// Returns coordinates, interleaved.
#[cfg_attr(
    not(any(feature = "derived", feature = "surface")),
    expect(dead_code, reason = "balls have no options here")
)]
pub fn coordinates<const D: usize>(points: &[[f64; D]]) -> Float64Array {
    if D != 2 {
        return Float64Array::new_from_slice(points.as_flattened());
    }
    let mut points = points.to_vec();
    // Not −0.
    points.iter_mut().for_each(|p| p[1] = 0.0 - p[1]);
    Float64Array::new_from_slice(points.as_flattened())
}

/// Takes over an option, unless it is not given.
#[cfg_attr(
    not(any(feature = "derived", feature = "surface")),
    expect(dead_code, reason = "balls have no options here")
)]
pub fn option<T>(
    options: &JsValue,
    name: &str,
    must_be: &str,
    convert: impl FnOnce(&JsValue) -> Option<T>,
    to: &mut T,
) -> Result<(), Thrown> {
    let value = get(options, name);
    if !value.is_undefined() {
        let converted = convert(&value);
        *to = converted.ok_or_else(|| error("BAD_INPUT", &format!("the option {name} must be {must_be}")))?;
    }
    Ok(())
}
