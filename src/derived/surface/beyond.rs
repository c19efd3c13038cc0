//! The solid with what is beyond the hull, for open surfaces: there, too, some is inside.
//!
//! Where the ground is known to be solid, a part of the surface may be on the hull with the outside within,
//! as at the bottom of a valley at the border of terrain, or the walls of a room that was scanned from
//! inside. So the hull's facets become simplices with a vertex at infinity, each inside or outside by the
//! evidence, and the facets between those are removed at the end.

use super::{
    super::complex::{Complex, Coordinates},
    evidence::{Beyond, Hints},
};
use crate::{
    geometry::{Euclidean, Geometry, facet},
    index::NONE,
};
use rustc_hash::FxHashMap;
use std::borrow::Cow;

/// The name of the vertex at infinity.
pub(super) const INFINITY: u32 = NONE - 1;

/// A complex whose hull has a simplex beyond each facet.
pub(super) struct Extended<'a, const D: usize, const N: usize> {
    pub(super) complex: Complex<'a, D, N>,
    /// The names of the vertices.
    pub(super) names: Vec<u32>,
    pub(super) is_inside: Vec<bool>,
}

impl<'a, const D: usize, const N: usize> Extended<'a, D, N>
where
    Euclidean: Geometry<D, N>,
{
    pub(super) fn new(complex: &'a Complex<'_, D, N>, names: &[u32], is_inside: &[bool], hints: &Hints<D>) -> Self {
        let infinity = names.len() as u32;
        let (mut simplices, mut neighbors) = (complex.simplices.to_vec(), complex.neighbors.to_vec());
        let mut is_inside = is_inside.to_vec();
        // Where the facets between the new simplices are, by their other vertices: simplex and facet.
        let mut sides: FxHashMap<[u32; N], (usize, usize)> = FxHashMap::default();
        for t in 0..complex.simplices.len() {
            for k in (0..N).filter(|&k| complex.across(t, k).is_none()) {
                let new = simplices.len();
                let beyond = hints.beyond_facet_of(complex, facet(&complex.simplices[t], k));
                is_inside.push(match beyond {
                    Beyond::Outside => false,
                    Beyond::Inside => true,
                    Beyond::Unknown => is_inside[t],
                });
                // The vertex at infinity is on the other side of the facet; two others swapped, it is positive again.
                let mut simplex = complex.simplices[t];
                simplex[k] = infinity;
                simplex.swap((k + 1) % N, (k + 2) % N);
                let mut across = [NONE; N];
                across[k] = t as u32;
                neighbors[t][k] = new as u32;
                simplices.push(simplex);
                neighbors.push(across);
                for l in (0..N).filter(|&l| l != k) {
                    let mut ridge = simplex;
                    ridge[l] = NONE;
                    ridge.sort_unstable();
                    if let Some((other, facet)) = sides.insert(ridge, (new, l)) {
                        neighbors[other][facet] = new as u32;
                        neighbors[new][l] = other as u32;
                    }
                }
            }
        }
        let complex = Complex {
            points: Coordinates::Borrowed(complex.points()),
            simplices: Cow::Owned(simplices),
            neighbors: Cow::Owned(neighbors),
            duplicate_of: Cow::Borrowed(&complex.duplicate_of),
            weights: Cow::Borrowed(&[]),
            visible: None,
        };
        Extended { complex, names: [names, &[INFINITY]].concat(), is_inside }
    }
}
