//! Which triangles are inside the boundaries.

use super::{Constraints, Fill};
use crate::{d2::Mesh2, error::Error, index::NONE, input::points::Points2, predicates::orient2d};

/// How often boundaries run along an edge, from its lower vertex to the higher one, less those that run back; or, for
/// the even-odd rule, how often they do so either way.
pub(super) type Weight = i32;

/// Checks that boundaries are closed, which are edges between vertices below `points`.
///
/// # Errors
///
/// [`Error::OpenBoundary`] names the lowest vertex where they are not.
pub(super) fn check_closed(points: usize, fill: Fill, edges: impl Iterator<Item = [u32; 2]>) -> Result<(), Error> {
    let mut ends = vec![0i64; points];
    for [from, to] in edges {
        ends[from as usize] += 1;
        ends[to as usize] += if fill == Fill::NonZero { -1 } else { 1 };
    }
    let is_open = |&count: &i64| if fill == Fill::NonZero { count != 0 } else { count % 2 != 0 };
    match ends.iter().position(is_open) {
        Some(point) => Err(Error::OpenBoundary { point }),
        None => Ok(()),
    }
}

/// Returns whether each triangle is inside, where each constrained edge of the mesh has a weight.
pub(super) fn inside(mesh: &Mesh2, points: Points2<'_>, constraints: &Constraints, weights: &[Weight]) -> Vec<bool> {
    let mut inside = match constraints.fill {
        Fill::All | Fill::Enclosed => vec![true; mesh.triangles.len()],
        fill => by_winding(mesh, fill, weights),
    };
    let mut outside = Vec::new();
    if constraints.fill == Fill::Enclosed {
        let is_open = |t: usize| (0..3).any(|k| mesh.neighbor(t, k).is_none() && !mesh.is_constrained(mesh.edge(t, k)));
        outside.extend((0..inside.len()).filter(|&t| is_open(t)));
    }
    if outside.is_empty() && constraints.holes.is_empty() {
        return inside;
    }
    let regions = regions(mesh);
    let count = regions.iter().max().map_or(0, |&last| last as usize + 1);
    let mut is_outside = vec![false; count];
    for region in outside.into_iter().map(|t| regions[t]).chain(holes(mesh, points, &constraints.holes, &regions)) {
        is_outside[region as usize] = true;
    }
    for (inside, region) in inside.iter_mut().zip(regions) {
        *inside &= !is_outside[region as usize];
    }
    inside
}

/// Returns the regions around places; none for those on segments and outside the hull.
fn holes(mesh: &Mesh2, points: Points2<'_>, places: &[[f64; 2]], regions: &[u32]) -> Vec<u32> {
    let contains = |t: usize, place: [f64; 2]| {
        let corners = mesh.triangles[t].map(|v| points.get(v as usize));
        // Most triangles are beside the place along an axis.
        let is_beside = |axis: usize| {
            corners.iter().all(|p| p[axis] < place[axis]) || corners.iter().all(|p| p[axis] > place[axis])
        };
        !is_beside(0) && !is_beside(1) && (0..3).all(|k| orient2d(corners[k], corners[(k + 1) % 3], place) >= 0)
    };
    let of = |&place: &[f64; 2]| {
        let mut around = (0..regions.len()).filter(|&t| contains(t, place)).map(|t| regions[t]);
        let first = around.next()?;
        around.all(|region| region == first).then_some(first)
    };
    places.iter().filter(|place| place.iter().all(|x| x.is_finite())).filter_map(of).collect()
}

/// Returns whether boundaries wind around each triangle.
fn by_winding(mesh: &Mesh2, fill: Fill, weights: &[Weight]) -> Vec<bool> {
    // What is to the left of an edge counts more than what is to the right by the weight of the edge.
    let step = |t: usize, k: usize| {
        let [from, to] = mesh.edge(t, k);
        let found = mesh.constraints.binary_search(&[from.min(to), from.max(to)]);
        let weight = found.ok().and_then(|at| weights.get(at)).copied().unwrap_or(0);
        if from < to { weight } else { weight.wrapping_neg() }
    };
    let mut windings: Vec<Option<Weight>> = vec![None; mesh.triangles.len()];
    let mut pending = Vec::new();
    for (t, (across, winding)) in mesh.halfedges.iter().zip(&mut windings).enumerate() {
        if let Some(k) = across.iter().position(|&e| e == NONE) {
            *winding = Some(step(t, k));
            pending.push(t);
        }
    }
    while let Some(t) = pending.pop() {
        let winding = windings[t].unwrap_or(0);
        for k in 0..3 {
            let Some(u) = mesh.neighbor(t, k).filter(|&u| windings[u].is_none()) else { continue };
            windings[u] = Some(winding.wrapping_sub(step(t, k)));
            pending.push(u);
        }
    }
    let is_inside = |winding: Weight| if fill == Fill::EvenOdd { winding % 2 != 0 } else { winding != 0 };
    windings.into_iter().map(|winding| winding.is_some_and(is_inside)).collect()
}

/// Numbers the regions that the constrained edges separate, in the order of their lowest triangles. Returns that of
/// each triangle.
pub(super) fn regions(mesh: &Mesh2) -> Vec<u32> {
    let mut regions = vec![NONE; mesh.triangles.len()];
    let mut pending = Vec::new();
    let mut count = 0;
    for first in 0..regions.len() {
        if regions[first] != NONE {
            continue;
        }
        regions[first] = count;
        pending.push(first);
        while let Some(t) = pending.pop() {
            for k in 0..3 {
                let Some(u) = mesh.neighbor(t, k).filter(|&u| regions[u] == NONE) else { continue };
                if !mesh.is_constrained(mesh.edge(t, k)) {
                    regions[u] = count;
                    pending.push(u);
                }
            }
        }
        count += 1;
    }
    regions
}
