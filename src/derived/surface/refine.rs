//! Finer surfaces: each edge gets a new vertex, on the quadric through the points around its middle.
//!
//! The facets of a surface through points of something curved are flat, so that it lies inside what is
//! convex. A new vertex stays in the middle where the points do not fit a quadric, as at sharp edges, and
//! where the surface would intersect itself.

use super::{boundary::Boundary, crossing, neighbors::Tree, quadrics};
use crate::{
    geometry::{Euclidean, Geometry, factorial, vector},
    index::NONE,
    parallel::{self, Threads},
};

/// A vertex moves at most by this share of the length of its edge.
const MAX_MOVE: f64 = 0.25;

/// So often vertices are put back that make the surface intersect itself, before all are.
const ROUNDS: u32 = 8;

/// The number of edges that is worth handing to another thread.
const GRAIN: usize = 1 << 9;

/// A surface with a new vertex on each edge of another.
pub(super) struct Refined<const D: usize> {
    pub(super) facets: Vec<[u32; D]>,
    /// What the vertices enclose more than before, scaled.
    pub(super) gain: f64,
}

/// Splits each facet, and appends the new vertices. `scale` is what makes the coordinates neither large nor
/// small.
pub(super) fn refine<const D: usize, const N: usize>(
    boundary: &Boundary<D>,
    vertices: &mut Vec<[f64; D]>,
    scale: f64,
) -> Refined<D>
where
    Euclidean: Geometry<D, N>,
{
    let old: Vec<[f64; D]> = vertices.iter().map(|&p| vector::times(scale, p)).collect();
    let (facets, ends) = split(boundary, old.len() as u32);
    // So that files in single precision have the new vertices exactly, too.
    let is_single = vertices.as_flattened().iter().all(|&x| f64::from(x as f32) == x);
    // What is stored, scaled again.
    let rounded = |p: [f64; D]| {
        let p = vector::times(1.0 / scale, p);
        vector::times(scale, if is_single { p.map(|x| f64::from(x as f32)) } else { p })
    };
    let middles: Vec<[f64; D]> = ends
        .iter()
        .map(|&[a, b]| rounded(vector::plus(vector::times(0.5, old[a as usize]), vector::times(0.5, old[b as usize]))))
        .collect();
    let moved: Vec<[f64; D]> = moved(&old, &ends, &middles).into_iter().map(rounded).collect();
    let mut all = [&old[..], &moved].concat();
    put_back(&facets, &mut all, &middles, old.len());
    let gain = enclosed(&facets, &all) - enclosed(&boundary.facets, &old);
    vertices.extend(all[old.len()..].iter().map(|&p| vector::times(1.0 / scale, p)));
    Refined { facets, gain }
}

/// Splits each facet at the middles of its edges, which are numbered from `first` on. Returns the new facets,
/// and the ends of the edges.
fn split<const D: usize>(boundary: &Boundary<D>, first: u32) -> (Vec<[u32; D]>, Vec<[u32; 2]>) {
    let mut ends = Vec::new();
    let mut facets = Vec::with_capacity(boundary.facets.len() << (D - 1));
    // The middle of the edge opposite each corner.
    let mut middles = vec![NONE; D * boundary.facets.len()];
    for (f, facet) in boundary.facets.iter().enumerate() {
        let mut new = |h: usize, edge: [u32; 2]| {
            if middles[h] == NONE {
                middles[h] = first + ends.len() as u32;
                ends.push(edge);
                // In 2D, corners are opposite vertices, and each edge has one facet.
                if let Some(mate) = boundary.mates.as_flattened().get(h).filter(|&&mate| D == 3 && mate != NONE) {
                    middles[*mate as usize] = middles[h];
                }
            }
            middles[h]
        };
        let mut part = |corners: [u32; 3]| facets.push(std::array::from_fn(|k| corners[k]));
        if D == 2 {
            let middle = new(D * f, [facet[0], facet[1]]);
            part([facet[0], middle, NONE]);
            part([middle, facet[1], NONE]);
            continue;
        }
        let corner = |k: usize| facet[k % D];
        let [a, b, c] = [0, 1, 2].map(|k| new(D * f + k, [corner(k + 1), corner(k + 2)]));
        part([corner(0), c, b]);
        part([corner(1), a, c]);
        part([corner(2), b, a]);
        part([a, b, c]);
    }
    (facets, ends)
}

/// Returns the middles of edges on the quadrics around them.
fn moved<const D: usize>(old: &[[f64; D]], ends: &[[u32; 2]], middles: &[[f64; D]]) -> Vec<[f64; D]> {
    if old.len() < quadrics::MIN_POINTS {
        return middles.to_vec();
    }
    let tree = Tree::new(old);
    let parts = parallel::map_grains(Threads::All, ends.len(), GRAIN, |range| {
        let mut near = Vec::new();
        let on_quadric = |i: usize| {
            let [a, b] = ends[i].map(|v| old[v as usize]);
            let offset = quadrics::offset(&tree, middles[i], &mut near).unwrap_or([0.0; D]);
            let limit = MAX_MOVE * MAX_MOVE * vector::squared_norm(vector::minus(a, b));
            if vector::squared_norm(offset) <= limit { vector::plus(middles[i], offset) } else { middles[i] }
        };
        range.map(on_quadric).collect::<Vec<_>>()
    });
    parallel::joined(parts)
}

/// Puts new vertices back to the middles of their edges until no facets of theirs intersect others.
fn put_back<const D: usize, const N: usize>(
    facets: &[[u32; D]],
    vertices: &mut [[f64; D]],
    middles: &[[f64; D]],
    first: usize,
) where
    Euclidean: Geometry<D, N>,
{
    for round in 0..=ROUNDS {
        let crossing = crossing::facets(facets, vertices);
        let mut is_changed = false;
        for v in crossing.into_iter().flat_map(|f| facets[f as usize]).filter(|&v| v as usize >= first) {
            let middle = middles[v as usize - first];
            is_changed |= vertices[v as usize] != middle;
            vertices[v as usize] = middle;
        }
        if !is_changed {
            return;
        }
        if round + 1 == ROUNDS {
            vertices[first..].copy_from_slice(middles);
        }
    }
}

/// Returns what closed facets enclose.
fn enclosed<const D: usize, const N: usize>(facets: &[[u32; D]], vertices: &[[f64; D]]) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let Some(&origin) = vertices.first() else { return 0.0 };
    let parts = facets.iter().map(|facet| {
        let corners = facet.map(|v| vector::minus(vertices[v as usize], origin));
        vector::dot(Euclidean::facet_normal(&corners), corners[0])
    });
    parts.fold(0.0, |sum, part| sum + part) / factorial(D)
}
