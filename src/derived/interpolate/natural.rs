//! Natural neighbours of a point: what the Voronoi cell that it would have takes from the cells of
//! the vertices (Sibson 1981).
//!
//! The cell is the dual of the *cavity*, the simplices whose circumspheres contain the point. Its
//! measures are sums over the facets of the cavity's simplices. Each facet is dual to a Voronoi
//! edge between two circumcentres, and counts, with one sign or the other, for all its vertices, so
//! the shares of all vertices add up to the cell whatever rounding did to the circumcentres. No
//! facet is taken out of order, and none is special: a grid's cavities are as good as any.
//!
//! Near the hull the cell is long, and terms as large as its square cancel. Where that costs too
//! much of the precision, the sums are done again in twice the precision.

use super::{
    super::{Interpolation, Locator},
    StolenMeasures,
    cavity::{Cavity, CavityFacet, Vertex},
    numeric::difference,
};
use crate::geometry::{
    Euclidean, Geometry, facet,
    real::{Double, Real},
    vector,
};
use rustc_hash::FxHashMap;

/// Lists that are used for one point after the other.
#[derive(Debug, Default)]
pub(super) struct Scratch<const D: usize> {
    /// The simplices of the cavity.
    conflict: Vec<u32>,
    /// The place of each simplex in `conflict`, or `None` if its circumsphere does not contain the
    /// point.
    place: FxHashMap<u32, Option<u32>>,
    /// The places of the cavity's vertices.
    local: FxHashMap<u32, u32>,
    cavity: Cavity<f64, D>,
}

/// Appends the natural neighbours of a query, which simplex `t` contains and which is no vertex,
/// with their weights; nothing where the hull is too near for twice the precision.
pub(super) fn weights<const D: usize, const N: usize>(
    locator: &Locator<'_, D, N>,
    method: Interpolation,
    query: [f64; D],
    (t, on_facet): (usize, bool),
    scratch: &mut Scratch<D>,
    weights: &mut Vec<(u32, f64)>,
) where
    Euclidean: StolenMeasures<D, N>,
{
    if on_facet {
        let facets = locator.hull_facets_at(query, t);
        if !facets.is_empty() {
            return Euclidean::weights_on_hull(locator, method, query, &facets, weights);
        }
    }
    let Scratch { conflict, place, local, cavity } = scratch;
    find(locator, query, t, conflict, place);
    measure(locator, query, conflict, place, local, cavity);
    if !cavity.weights(method, weights) {
        let mut precise = Cavity::<Double, D>::default();
        measure(locator, query, conflict, place, local, &mut precise);
        precise.weights(method, weights);
    }
}

/// Finds the cavity of a query inside the hull.
///
/// A circumsphere that has the query on it counts as empty, so that the query is strictly on the
/// inner side of every facet of the cavity.
fn find<const D: usize, const N: usize>(
    locator: &Locator<'_, D, N>,
    query: [f64; D],
    t: usize,
    conflict: &mut Vec<u32>,
    place: &mut FxHashMap<u32, Option<u32>>,
) where
    Euclidean: Geometry<D, N>,
{
    conflict.clear();
    place.clear();
    conflict.push(t as u32);
    place.insert(t as u32, Some(0));
    let mut next = 0;
    while let Some(&t) = conflict.get(next) {
        next += 1;
        for k in 0..N {
            let Some(across) = locator.complex.visible_across(t as usize, k) else { continue };
            place.entry(across as u32).or_insert_with(|| {
                let in_conflict = Euclidean::in_sphere(&locator.complex.corners(across), query) > 0;
                in_conflict.then(|| {
                    conflict.push(across as u32);
                    conflict.len() as u32 - 1
                })
            });
        }
    }
}

/// Gathers the vertices and facets of a cavity, and measures what the query's cell takes from those
/// of the vertices.
fn measure<T: Real, const D: usize, const N: usize>(
    locator: &Locator<'_, D, N>,
    query: [f64; D],
    conflict: &[u32],
    place: &FxHashMap<u32, Option<u32>>,
    local: &mut FxHashMap<u32, u32>,
    cavity: &mut Cavity<T, D>,
) where
    Euclidean: StolenMeasures<D, N>,
{
    local.clear();
    cavity.clear();
    let complex = &locator.complex;
    // Scaled so that no measure overflows, and relative to the query.
    let scaled = |p: [f64; D]| vector::times(locator.scale, p);
    let query = scaled(query);
    let relative = |p: [f64; D]| difference(p, query);
    let centers: Vec<[T; D]> = conflict
        .iter()
        .map(|&t| {
            let corners = complex.corners(t as usize).map(scaled);
            let (offset, first) = (T::circumcenter_offset(&corners), relative(corners[0]));
            std::array::from_fn(|axis| first[axis] + offset[axis])
        })
        .collect();
    for (&t, &inside) in conflict.iter().zip(&centers) {
        let simplex = complex.simplices[t as usize];
        let corners = simplex.map(|v| {
            *local.entry(v).or_insert_with(|| {
                cavity.vertices.push(Vertex::new(v, relative(scaled(complex.point(v)))));
                cavity.vertices.len() as u32 - 1
            })
        });
        for k in 0..N {
            let across = complex.visible_across(t as usize, k);
            let other = across.and_then(|across| *place.get(&(across as u32))?);
            let corners = facet(&corners, k);
            match other {
                Some(other) if across < Some(t as usize) => {
                    let beyond = centers[other as usize];
                    cavity.facets.push(CavityFacet { corners, inside, beyond, is_boundary: false });
                }
                // The other simplex lists it.
                Some(_) => {}
                None => {
                    let mut with_query = [query; N];
                    for (to, v) in with_query[1..].iter_mut().zip(facet(&simplex, k)) {
                        *to = scaled(complex.point(v));
                    }
                    let beyond = T::circumcenter_offset(&with_query);
                    cavity.facets.push(CavityFacet { corners, inside, beyond, is_boundary: true });
                }
            }
        }
    }
    Euclidean::measure(cavity);
}
