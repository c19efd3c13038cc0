//! What differs between the dimensions in Voronoi cells.

use super::{
    super::complex::Complex,
    polytope::{Polygon, Polyhedron, Polytope},
};
use crate::{
    geometry::{Euclidean, Geometry, vector},
    index::NONE,
};

/// The measures of a facet.
#[derive(Debug, Clone, Copy)]
pub struct FacetMeasures<const D: usize> {
    /// The area; in 2D the length.
    pub(crate) area: f64,
    /// The volume of the pyramid with its apex at the origin, in 2D the area of the triangle;
    /// positive if the origin is inside.
    pub(crate) volume: f64,
    /// The integral of the coordinates over that pyramid.
    pub(crate) moment: [f64; D],
}

/// What differs between the dimensions in Voronoi cells.
#[doc(hidden)]
pub trait VoronoiShapes<const D: usize, const N: usize>: Geometry<D, N> {
    /// The shape of a cell while it is clipped.
    type Polytope: Polytope<D>;

    /// Calls `visit` with each neighbour *a* of vertex *v*, the simplices around the edge between
    /// both as places in the star of *v*, and whether they close a ring, or in 2D whether there are
    /// two. They are counter-clockwise as seen from *a* in 3D, and from right to left as seen from
    /// *v* in 2D, where the neighbours come counter-clockwise, on the hull from the first.
    fn for_rings(
        complex: &Complex<'_, D, N>,
        v: u32,
        star: &[u32],
        scratch: &mut Star,
        visit: impl FnMut(u32, &[u32], bool),
    );

    /// The number of Voronoi edges, or vertices in 2D, that a bounded facet has at least.
    const FACET_EDGES: usize;

    /// Returns the outer normal of the facet of a simplex, and its product with the points of the
    /// facet.
    fn plane(facet: &[[f64; D]; D]) -> ([f64; D], f64);

    /// Returns the measures of a facet.
    fn facet_measures(corners: &[[f64; D]]) -> FacetMeasures<D>;
}

impl VoronoiShapes<2, 3> for Euclidean {
    type Polytope = Polygon<2>;

    fn for_rings(
        complex: &Complex<'_, 2, 3>,
        v: u32,
        star: &[u32],
        _: &mut Star,
        mut visit: impl FnMut(u32, &[u32], bool),
    ) {
        // Of a counter-clockwise triangle (v, a, b), the next one is across (v, b), opposite a, and
        // the one before opposite b.
        let corner = |place: u32, after: usize| {
            let t = star[place as usize] as usize;
            let corner = complex.simplices[t].iter().position(|&w| w == v).unwrap_or(0);
            (t, (corner + after) % 3)
        };
        let across = |place: u32, after: usize| {
            let (t, corner) = corner(place, after);
            let across = complex.across(t, corner)?;
            // A star is in ascending order. Only a broken mesh has other triangles around the
            // vertex.
            star.binary_search(&(across as u32)).ok().map(|place| place as u32)
        };
        let vertex = |place: u32, after: usize| {
            let (t, corner) = corner(place, after);
            complex.simplices[t][corner]
        };
        let mut first = 0;
        // Only a broken mesh needs the limits.
        for _ in 0..star.len() {
            match across(first, 2) {
                Some(before) if before != 0 => first = before,
                _ => break,
            }
        }
        match across(first, 2) {
            Some(before) => visit(vertex(first, 1), &[before, first], true),
            None => visit(vertex(first, 1), &[first], false),
        }
        let mut at = first;
        for _ in 0..star.len() {
            match across(at, 1) {
                Some(next) if next == first => break,
                Some(next) => {
                    visit(vertex(at, 2), &[at, next], true);
                    at = next;
                }
                None => {
                    visit(vertex(at, 2), &[at], false);
                    break;
                }
            }
        }
    }

    const FACET_EDGES: usize = 1;

    fn plane(&[a, b]: &[[f64; 2]; 2]) -> ([f64; 2], f64) {
        // To the right of the edge.
        let normal = [b[1] - a[1], a[0] - b[0]];
        (normal, vector::dot(normal, a))
    }

    fn facet_measures(corners: &[[f64; 2]]) -> FacetMeasures<2> {
        let &[p, q] = corners else { return FacetMeasures { area: 0.0, volume: 0.0, moment: [0.0; 2] } };
        let volume = 0.5 * (p[0] * q[1] - p[1] * q[0]);
        let moment = vector::times(volume / 3.0, vector::plus(p, q));
        FacetMeasures { area: vector::norm(vector::minus(q, p)), volume, moment }
    }
}

/// The star of a vertex in 3D, with places in it instead of indices of the mesh.
#[derive(Debug, Default)]
pub struct Star {
    /// The other vertices *a*, *b*, *c* of each tetrahedron, so that (v, a, b, c) is positive;
    /// [`VISITED`] when the ring around the edge to one is.
    corners: Vec<[u32; 3]>,
    /// The place of the tetrahedron across the facet opposite each of them, or [`OUTSIDE`].
    across: Vec<[u32; 3]>,
    ring: Vec<u32>,
    /// The tetrahedra with their places, by a hash of their index, with room for four times as many,
    /// so that most are found at once.
    table: Vec<(u32, u32)>,
}

/// No vertex any more.
const VISITED: u32 = u32::MAX;
/// No place in the star: outside the hull.
const OUTSIDE: u32 = u32::MAX;

impl Star {
    fn fill(&mut self, complex: &Complex<'_, 3, 4>, v: u32, star: &[u32]) {
        let mask = (4 * star.len()).next_power_of_two() - 1;
        let slot = |t: u32| (t.wrapping_mul(0x9e37_79b9) >> 7) as usize & mask;
        self.table.clear();
        self.table.resize(mask + 1, (u32::MAX, OUTSIDE));
        for (place, &t) in (0..).zip(star) {
            let mut at = slot(t);
            while self.table[at].1 != OUTSIDE {
                at = (at + 1) & mask;
            }
            self.table[at] = (t, place);
        }
        let place_of = |t: i32| {
            if t == NONE {
                return OUTSIDE;
            }
            let mut at = slot(t as u32);
            // What is not there ends at an empty slot, which says `OUTSIDE`.
            while self.table[at].0 != t as u32 && self.table[at].1 != OUTSIDE {
                at = (at + 1) & mask;
            }
            self.table[at].1
        };
        self.corners.clear();
        self.across.clear();
        for &t in star {
            let (simplex, neighbors) = (&complex.simplices[t as usize], &complex.neighbors[t as usize]);
            let [_, i, j, k] = EVEN[place(simplex, v)];
            self.corners.push([i, j, k].map(|corner| simplex[corner]));
            self.across.push([i, j, k].map(|corner| place_of(neighbors[corner])));
        }
    }
}

/// For each corner of a tetrahedron, an even permutation that begins with it.
const EVEN: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];

/// Puts the tetrahedra around the edge from vertex *v* to vertex *a* of tetrahedron `t` into
/// `ring`: counter-clockwise as seen from *a*. Returns whether they close a ring.
pub(in super::super) fn ring(complex: &Complex<'_, 3, 4>, v: u32, a: u32, t: usize, ring: &mut Vec<u32>) -> bool {
    ring.clear();
    let (simplices, neighbors) = (&*complex.simplices, &*complex.neighbors);
    // Of a positive tetrahedron (v, a, b, c), the next one counter-clockwise is across (v, a, c).
    let next = |t: usize, from: u32, to: u32| {
        let across = *neighbors[t].get(THIRD[place(&simplices[t], from)][place(&simplices[t], to)])?;
        (across != NONE).then_some(across as usize)
    };
    let mut at = t;
    // Only a broken mesh needs the limits.
    for _ in 0..=simplices.len() {
        ring.push(at as u32);
        match next(at, v, a) {
            Some(t_next) if t_next == t => return true,
            Some(t_next) => at = t_next,
            None => break,
        }
    }
    // Clockwise from the first one, as counter-clockwise in the other direction.
    let forward = ring.len();
    let mut at = t;
    for _ in 0..=simplices.len() {
        let Some(before) = next(at, a, v) else { break };
        ring.push(before as u32);
        at = before;
    }
    ring[forward..].reverse();
    ring.rotate_left(forward);
    false
}

/// Returns the place of a vertex in a tetrahedron, without branches; 0 if it is not there, as
/// happens in broken meshes only.
#[inline(always)]
pub(in super::super) fn place(simplex: &[u32; 4], v: u32) -> usize {
    // Not a sum: a broken mesh may have a vertex twice in a tetrahedron.
    usize::from(simplex[1] == v) | (usize::from(simplex[2] == v) << 1) | (usize::from(simplex[3] == v) * 3)
}

/// For corners *i* and *j* of a tetrahedron, the corner *k* such that (i, j, k, l) is an even
/// permutation.
pub(crate) const THIRD: [[usize; 4]; 4] = [[4, 2, 3, 1], [3, 4, 0, 2], [1, 3, 4, 0], [2, 0, 1, 4]];

impl VoronoiShapes<3, 4> for Euclidean {
    type Polytope = Polyhedron;

    fn for_rings(
        complex: &Complex<'_, 3, 4>,
        v: u32,
        star: &[u32],
        scratch: &mut Star,
        mut visit: impl FnMut(u32, &[u32], bool),
    ) {
        scratch.fill(complex, v, star);
        let Star { corners, across, ring, .. } = scratch;
        for start in 0..star.len() {
            for corner in 0..3 {
                let a = corners[start][corner];
                // Each ring once: from the first of its tetrahedra.
                if a == VISITED {
                    continue;
                }
                let mut turn = |at: usize, after: usize| {
                    // Without a branch, which nothing could predict.
                    let corner = usize::from(corners[at][1] == a) | usize::from(corners[at][2] == a) << 1;
                    if *corners[at].get(corner)? != a {
                        return None;
                    }
                    let next = across[at][(corner + after) % 3];
                    corners[at][corner] = VISITED;
                    (next != OUTSIDE).then_some(next as usize)
                };
                ring.clear();
                // Of a positive tetrahedron (v, a, b, c), the next one counter-clockwise is across
                // (v, a, c), and the one before across (v, a, b).
                let before = across[start][(corner + 2) % 3];
                let mut at = start;
                let is_closed = loop {
                    ring.push(at as u32);
                    match turn(at, 1) {
                        Some(next) if next == start => break true,
                        // Only a broken mesh needs the limit.
                        Some(next) if ring.len() < star.len() => at = next,
                        _ => break false,
                    }
                };
                if !is_closed {
                    // Clockwise from the first one, as counter-clockwise in the other direction.
                    let forward = ring.len();
                    let mut at = (before != OUTSIDE).then_some(before as usize);
                    while let Some(place) = at.filter(|_| ring.len() < star.len()) {
                        ring.push(place as u32);
                        at = turn(place, 2);
                    }
                    ring[forward..].reverse();
                    ring.rotate_left(forward);
                }
                visit(a, ring, is_closed);
            }
        }
    }

    const FACET_EDGES: usize = 3;

    fn plane(&[a, b, c]: &[[f64; 3]; 3]) -> ([f64; 3], f64) {
        let normal = vector::cross(vector::minus(b, a), vector::minus(c, a));
        (normal, vector::dot(normal, a))
    }

    fn facet_measures(corners: &[[f64; 3]]) -> FacetMeasures<3> {
        let mut normal = [0.0; 3];
        let (mut volume, mut moment) = (0.0, [0.0; 3]);
        if let &[first, ref others @ ..] = corners {
            for pair in others.windows(2) {
                let (u, v) = (vector::minus(pair[0], first), vector::minus(pair[1], first));
                let twice = vector::cross(u, v);
                let share = vector::dot(first, twice) / 6.0;
                normal = vector::plus(normal, twice);
                volume += share;
                let corners = vector::plus(first, vector::plus(pair[0], pair[1]));
                moment = vector::plus(moment, vector::times(share / 4.0, corners));
            }
        }
        FacetMeasures { area: 0.5 * vector::norm(normal), volume, moment }
    }
}
