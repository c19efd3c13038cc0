//! Meshes in the memory of the CPU whose points move, come and go.

use gdel::{
    Error, Mesh2, Mesh3,
    internals::{
        Options, Winding,
        cpu::{
            Insert, MeshOf,
            edit::{Edit, Used, delaunay_of_used, edit},
            sparse::Sparse,
            update::{Limits, update},
        },
        dimension::Dimension,
        mesh::MeshInfo,
    },
    stats::UpdateStats,
};
use js_sys::{Float64Array, Function, Uint32Array};
use std::sync::Arc;
use wasm_bindgen::{
    JsCast,
    prelude::{JsValue, wasm_bindgen},
};

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

/// Returns the mesh of points of 2 or 3 dimensions, given the one of the points where they were; in 2D
/// in delaunator's orientation. If these have to be triangulated from scratch, and all are used, the
/// result has only the statistics of the attempt, as `update`.
///
/// With the points `before`, it is the mesh of these, of those in `points`, which follow them, and
/// without those with the indices in the array `removed`. If there is none, no index of it is unused any
/// more, and the result has what the indices were, as `kept`. The result has the points as well.
#[wasm_bindgen]
pub fn change(
    dimension: u32,
    points: JsValue,
    before: JsValue,
    moved: JsValue,
    removed: JsValue,
    outputs: Outputs,
    report: Function,
) -> Result<JsValue, Thrown> {
    let options = Options { on_progress: Some(Arc::new(reporting(report))), ..Options::default() };
    if dimension == 3 {
        let mut mesh = Mesh3::from(CallerMesh::new(&moved, "tetrahedra", "neighbors")?);
        let changed = changed::<3, 4>(&mut mesh, &points, &before, &removed, &options, Mesh3::compact)?;
        return Ok(changed.of(|| mesh3(mesh, outputs)));
    }
    let options = Options { winding: Winding::Clockwise, ..options };
    let mut mesh = Mesh2::from(CallerMesh::new(&moved, "triangles", "halfedges")?);
    let changed = changed::<2, 3>(&mut mesh, &points, &before, &removed, &options, Mesh2::compact)?;
    Ok(changed.of(|| mesh2(mesh, true)))
}

/// What has become of a mesh.
enum Changed {
    /// It is that of the points where they are now.
    Moved,
    /// The points are to be triangulated from scratch.
    Restarted(UpdateStats),
    /// It is that of these points. They were numbered in this way before if some were dropped.
    Edited(Coordinates, Option<Vec<u32>>),
}

impl Changed {
    /// Returns it with the mesh.
    fn of(self, mesh: impl FnOnce() -> JsValue) -> JsValue {
        match self {
            Changed::Moved => mesh(),
            Changed::Restarted(stats) => object([("update", statistics(&stats))]),
            Changed::Edited(points, kept) => {
                let mesh = mesh();
                set(&mesh, "points", points.into_js());
                if let Some(kept) = kept {
                    set(&mesh, "kept", Uint32Array::new_from_slice(&kept));
                }
                mesh
            }
        }
    }
}

/// Changes a mesh as its caller wants.
fn changed<const D: usize, const N: usize>(
    mesh: &mut MeshOf<D>,
    points: &JsValue,
    before: &JsValue,
    removed: &JsValue,
    options: &Options,
    compact: fn(&mut MeshOf<D>) -> Vec<u32>,
) -> Result<Changed, Thrown>
where
    Dimension<D>: Edit<D, N>,
    for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
{
    let new = Coordinates::new(points)?;
    if before.is_undefined() {
        let points = new.points::<D>()?;
        let (followed, stats) = update::<D>(mesh, points, options, Limits::measured(D))?;
        *mesh = match (followed, Used::of(points, mesh.duplicate_of())) {
            (Some(followed), _) => followed,
            (None, used @ Some(_)) => delaunay_of_used(points, used.as_ref(), stats, options)?,
            (None, None) => return Ok(Changed::Restarted(stats)),
        };
        return Ok(Changed::Moved);
    }
    // The index in an error is that among the new ones.
    new.points::<D>()?.validate()?;
    let mut coordinates = Coordinates::new(before)?;
    let (known, expected) = (coordinates.points::<D>()?.len(), mesh.duplicate_of().len());
    if known != expected {
        return Err(Error::PointCount { points: known, expected }.into());
    }
    let Some(removed) = removed.dyn_ref::<Float64Array>() else {
        let kept = compact(mesh);
        mesh.stats_mut().update = Some(UpdateStats::default());
        return Ok(Changed::Edited(coordinates.select::<D>(&kept), Some(kept)));
    };
    let index = |i: f64| match i as u32 {
        index if f64::from(index) == i => Ok(index),
        _ => Err(error("BAD_INPUT", &format!("{i} is not the index of a point"))),
    };
    let removed: Vec<u32> = removed.to_vec().into_iter().map(index).collect::<Result<_, _>>()?;
    coordinates.append(new);
    let points = coordinates.points::<D>()?;
    if let Some(again) = edit::<D, N>(mesh, points, &removed, options, Limits::measured(D))? {
        *mesh = delaunay_of_used(points, again.used(points).as_ref(), again.update, options)?;
    }
    Ok(Changed::Edited(coordinates, None))
}
