//! Meshes in the memory of the CPU whose points move, come and go.

use gdel::{
    Backend, Error, Mesh2, Mesh3, Points,
    internals::{
        Options, Winding,
        cpu::{
            Incremental, Insert, MeshOf,
            edit::{Edit, Used, delaunay_of_used, edit},
            sparse::Sparse,
            update::{Limits, update},
        },
        dimension::Dimension,
        mesh::MeshInfo,
    },
    stats::UpdateStats,
};
use js_sys::{Function, Uint32Array};
use std::sync::Arc;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    arrays::{
        d2::mesh2,
        d3::{Outputs, mesh3},
    },
    mesh::CallerMesh,
    objects::{Thrown, error, object, set},
    points::Coordinates,
    run::{reporting, statistics},
};

/// Returns the 3D mesh of points, given the one of the points where they were. If these have to be
/// triangulated from scratch, and all are used, the result has only the statistics of the attempt, as
/// `update`.
#[wasm_bindgen]
pub fn update3d(points: JsValue, moved: JsValue, outputs: Outputs, report: Function) -> Result<JsValue, Thrown> {
    let coordinates = Coordinates::new(&points)?;
    let points = coordinates.points()?;
    let before = Mesh3::from(CallerMesh::new(&moved, "tetrahedra", "neighbors")?);
    let options = options(report);
    let (mesh, stats) = update::<3>(&before, points, &options, Limits::measured(3))?;
    let mesh = mesh.map_or_else(|| of_used(points, &before.duplicate_of, stats, &options), |mesh| Ok(Some(mesh)))?;
    drop(before);
    Ok(mesh.map_or_else(|| restarted(&stats), |mesh| mesh3(mesh, outputs)))
}

/// Does the same in 2D, in delaunator's orientation.
#[wasm_bindgen]
pub fn update2d(points: JsValue, moved: JsValue, report: Function) -> Result<JsValue, Thrown> {
    let coordinates = Coordinates::new(&points)?;
    let points = coordinates.points()?;
    let before = Mesh2::from(CallerMesh::new(&moved, "triangles", "halfedges")?);
    let options = Options { winding: Winding::Clockwise, ..options(report) };
    let (mesh, stats) = update::<2>(&before, points, &options, Limits::measured(2))?;
    let mesh = mesh.map_or_else(|| of_used(points, &before.duplicate_of, stats, &options), |mesh| Ok(Some(mesh)))?;
    drop(before);
    Ok(mesh.map_or_else(|| restarted(&stats), |mesh| mesh2(mesh, true)))
}

/// Returns the mesh of the points that are used; `None` if all are.
fn of_used<const D: usize>(
    points: Points<'_, D>,
    duplicate_of: &[i32],
    stats: UpdateStats,
    options: &Options,
) -> Result<Option<MeshOf<D>>, Error>
where
    Dimension<D>: Incremental<D>,
{
    let used = Used::of(points, duplicate_of);
    used.map(|used| delaunay_of_used(points, Some(&used), stats, options)).transpose()
}

/// Returns the 3D mesh of the points `before`, those in `points`, which follow them, and without those
/// with the indices in `removed`. If these are not given, no index of it is unused any more, and the
/// result has what the indices were, as `kept`. The result has the points as well.
#[wasm_bindgen]
pub fn edit3d(
    points: JsValue,
    before: JsValue,
    moved: JsValue,
    removed: Option<Vec<f64>>,
    outputs: Outputs,
    report: Function,
) -> Result<JsValue, Thrown> {
    let mut mesh = Mesh3::from(CallerMesh::new(&moved, "tetrahedra", "neighbors")?);
    let extra = edited::<3, 4>(&mut mesh, &points, &before, removed, &options(report), Mesh3::compact)?;
    Ok(extra.added_to(mesh3(mesh, outputs)))
}

/// Does the same in 2D, in delaunator's orientation.
#[wasm_bindgen]
pub fn edit2d(
    points: JsValue,
    before: JsValue,
    moved: JsValue,
    removed: Option<Vec<f64>>,
    report: Function,
) -> Result<JsValue, Thrown> {
    let mut mesh = Mesh2::from(CallerMesh::new(&moved, "triangles", "halfedges")?);
    let options = Options { winding: Winding::Clockwise, ..options(report) };
    let extra = edited::<2, 3>(&mut mesh, &points, &before, removed, &options, Mesh2::compact)?;
    Ok(extra.added_to(mesh2(mesh, true)))
}

/// What the result of a change has besides the mesh.
struct Extra {
    points: Coordinates,
    kept: Option<Vec<u32>>,
}

impl Extra {
    /// Returns a mesh that has it as well.
    fn added_to(self, mesh: JsValue) -> JsValue {
        set(&mesh, "points", self.points.into_js());
        if let Some(kept) = self.kept {
            set(&mesh, "kept", Uint32Array::new_from_slice(&kept));
        }
        mesh
    }
}

/// Changes a mesh as its caller wants.
fn edited<const D: usize, const N: usize>(
    mesh: &mut MeshOf<D>,
    points: &JsValue,
    before: &JsValue,
    removed: Option<Vec<f64>>,
    options: &Options,
    compact: fn(&mut MeshOf<D>) -> Vec<u32>,
) -> Result<Extra, Thrown>
where
    Dimension<D>: Edit<D, N>,
    for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
{
    let new = Coordinates::new(points)?;
    // The index in an error is that among the new ones.
    new.points::<D>()?.validate()?;
    let mut coordinates = Coordinates::new(before)?;
    let known = mesh.duplicate_of().len();
    if coordinates.points::<D>()?.len() != known {
        return Err(Error::PointCount { points: coordinates.points::<D>()?.len(), expected: known }.into());
    }
    let Some(removed) = removed else {
        let kept = compact(mesh);
        let points = coordinates.select::<D>(&kept);
        mesh.stats_mut().update = Some(UpdateStats::default());
        return Ok(Extra { points, kept: Some(kept) });
    };
    let index = |i: f64| match i as u32 {
        index if f64::from(index) == i => Ok(index),
        _ => Err(error("BAD_INPUT", &format!("{i} is not the index of a point"))),
    };
    let removed: Vec<u32> = removed.into_iter().map(index).collect::<Result<_, _>>()?;
    coordinates.append(new);
    let points = coordinates.points::<D>()?;
    if let Some(again) = edit::<D, N>(mesh, points, &removed, options, Limits::measured(D))? {
        *mesh = delaunay_of_used(points, again.used(points).as_ref(), again.update, options)?;
    }
    Ok(Extra { points: coordinates, kept: None })
}

fn options(report: Function) -> Options {
    Options { on_progress: Some(Arc::new(reporting(report))), ..Options::default() }
}

fn restarted(stats: &UpdateStats) -> JsValue {
    object([("update", statistics(stats))])
}
