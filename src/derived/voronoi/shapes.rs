//! The parts of Voronoi cells that depend on the dimension.

use super::{
    super::complex::Complex,
    polytope::{Polygon, Polyhedron, Polytope},
};
use crate::{
    cpu,
    error::Error,
    geometry::{Euclidean, Geometry, vector},
    index::NONE,
    input::points::Points,
    mesh::Csr,
    options::Options,
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

/// The vertices of a simplex and its neighbours.
pub type Row<const N: usize> = ([u32; N], [u32; N]);

/// The parts of Voronoi cells that depend on the dimension.
#[doc(hidden)]
pub trait VoronoiShapes<const D: usize, const N: usize>: Geometry<D, N> {
    /// The shape of a cell while it is clipped.
    type Polytope: Polytope<D>;

    /// Appends to `rings` the simplices around each edge from vertex *v* for which `is_wanted`
    /// returns true, as places in its star, whose simplices have these rows. `is_wanted` gets the
    /// edge's other vertex *a*, the places, and whether they close a ring, or in 2D whether there are
    /// two. They are counter-clockwise as seen from *a* in 3D, and from right to left as seen from *v*
    /// in 2D, where the neighbours come counter-clockwise, on the hull from the first.
    fn push_rings(
        v: u32,
        star: &[u32],
        rows: &[Row<N>],
        scratch: &mut Star,
        rings: &mut Csr,
        is_wanted: impl FnMut(u32, &[u32], bool) -> bool,
    );

    /// The number of Voronoi edges, or vertices in 2D, that a bounded facet has at least.
    const FACET_EDGES: usize;

    /// Returns the outer normal of the facet of a simplex, and its product with the points of the
    /// facet.
    fn plane(facet: &[[f64; D]; D]) -> ([f64; D], f64);

    /// Returns the facets of the convex hull; none if the points are flat.
    fn hull(points: &[[f64; D]]) -> Result<Vec<[u32; D]>, Error>;

    /// Returns the measures of a facet, whose corners are places in a list.
    fn facet_measures(vertices: &[[f64; D]], corners: &[u32]) -> FacetMeasures<D>;
}

impl VoronoiShapes<2, 3> for Euclidean {
    type Polytope = Polygon<2>;

    fn push_rings(
        v: u32,
        star: &[u32],
        rows: &[Row<3>],
        _: &mut Star,
        rings: &mut Csr,
        mut is_wanted: impl FnMut(u32, &[u32], bool) -> bool,
    ) {
        let mut visit = |a: u32, ring: &[u32], is_closed: bool| {
            if is_wanted(a, ring, is_closed) {
                rings.push(ring.iter().copied());
            }
        };
        // Of a counter-clockwise triangle (v, a, b), the next one is across (v, b), opposite a, and
        // the one before opposite b.
        let corner = |place: u32, after: usize| {
            let (simplex, neighbors) = &rows[place as usize];
            let corner = (simplex.iter().position(|&w| w == v).unwrap_or(0) + after) % 3;
            (simplex[corner], neighbors[corner])
        };
        let across = |place: u32, after: usize| {
            let (_, across) = corner(place, after);
            // A star is in ascending order. Only a broken mesh has other triangles around the
            // vertex.
            star.binary_search(&across).ok().map(|place| place as u32)
        };
        let vertex = |place: u32, after: usize| corner(place, after).0;
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

    fn hull(points: &[[f64; 2]]) -> Result<Vec<[u32; 2]>, Error> {
        let mesh = cpu::delaunay(Points::F64(points), &Options::default())?;
        // The hull of collinear points is a sequence.
        let sides = if mesh.triangles.is_empty() { 0 } else { mesh.hull.len() };
        Ok((0..sides).map(|i| [mesh.hull[i], mesh.hull[(i + 1) % sides]]).collect())
    }

    fn facet_measures(vertices: &[[f64; 2]], corners: &[u32]) -> FacetMeasures<2> {
        let &[p, q] = corners else { return FacetMeasures { area: 0.0, volume: 0.0, moment: [0.0; 2] } };
        let [p, q] = [p, q].map(|corner| vertices[corner as usize]);
        let volume = 0.5 * (p[0] * q[1] - p[1] * q[0]);
        let moment = vector::times(volume / 3.0, vector::plus(p, q));
        FacetMeasures { area: vector::norm(vector::minus(q, p)), volume, moment }
    }
}

/// The star of a vertex in 3D, with places in it instead of indices of the mesh.
///
/// Corner *k* of the tetrahedron at place *p*, with *k* below 3, has the number 4·*p* + *k*.
#[derive(Debug, Default)]
pub struct Star {
    /// The other vertices *a*, *b*, *c* of each tetrahedron, so that (v, a, b, c) is positive.
    corners: Vec<[u32; 3]>,
    /// The tetrahedra across the facets opposite them.
    across: Vec<[u32; 3]>,
    /// For each corner that of the next tetrahedron counter-clockwise around the edge to it; or
    /// [`OUTSIDE`], or [`VISITED`]. Those with *k* = 3 are none.
    next: Vec<[u32; 4]>,
    /// Places in stars by a hash of the tetrahedron's index. What it says has to be checked: others
    /// overwrite it, and it is not cleared.
    table: Vec<u32>,
}

/// No corner any more.
const VISITED: u32 = u32::MAX - 1;
/// No place in the star, or corner of it: outside the hull.
const OUTSIDE: u32 = NONE;

impl Star {
    /// Fills in the star of vertex *v*. Returns whether anything is outside.
    fn fill(&mut self, v: u32, star: &[u32], rows: &[Row<4>]) -> bool {
        let Star { corners, across, next, table } = self;
        corners.clear();
        across.clear();
        for (simplex, neighbors) in rows {
            let [_, i, j, k] = EVEN[place(simplex, v)];
            corners.push([i, j, k].map(|corner| simplex[corner]));
            across.push([i, j, k].map(|corner| neighbors[corner]));
        }
        // So large that few overwrite each other.
        let bits = (8 * star.len()).next_power_of_two().ilog2().clamp(10, 31);
        let slot = |t: u32| (t.wrapping_mul(0x9e37_79b9) >> (32 - bits)) as usize;
        if table.len() < 1 << bits {
            table.resize(1 << bits, OUTSIDE);
        }
        for (place, &t) in (0..).zip(star) {
            table[slot(t)] = place;
        }
        let mut is_open = false;
        next.clear();
        for (corners_here, across) in corners.iter().zip(&*across) {
            let mut row = [OUTSIDE; 4];
            for (k, &a) in corners_here.iter().enumerate() {
                // Of a positive tetrahedron (v, a, b, c), the next one counter-clockwise is across
                // (v, a, c).
                let t = across[(k + 1) % 3];
                let mut place = table[slot(t)];
                if star.get(place as usize) != Some(&t) {
                    // A star is in ascending order.
                    place = star.binary_search(&t).map_or(OUTSIDE, |place| place as u32);
                }
                match corners.get(place as usize) {
                    // Without a branch, which nothing could predict.
                    Some(others) => row[k] = (place * 4) | u32::from(others[1] == a) | (u32::from(others[2] == a) << 1),
                    None => is_open = true,
                }
            }
            next.push(row);
        }
        is_open
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

    fn push_rings(
        v: u32,
        star: &[u32],
        rows: &[Row<4>],
        scratch: &mut Star,
        rings: &mut Csr,
        mut is_wanted: impl FnMut(u32, &[u32], bool) -> bool,
    ) {
        let is_open = scratch.fill(v, star, rows);
        let Star { corners, next, .. } = scratch;
        let next = next.as_flattened_mut();
        // Rings that are not closed, from their first tetrahedra.
        if is_open {
            let mut is_first = vec![true; next.len()];
            for &corner in &*next {
                if let Some(is_first) = is_first.get_mut(corner as usize) {
                    *is_first = false;
                }
            }
            for (start, _) in is_first.iter().enumerate().filter(|&(corner, &is_first)| is_first && corner % 4 < 3) {
                push_ring(corners, next, start, rings, &mut is_wanted);
            }
        }
        for start in 0..next.len() {
            // Each ring once: from the first of its tetrahedra.
            if start % 4 < 3 && next[start] != VISITED {
                push_ring(corners, next, start, rings, &mut is_wanted);
            }
        }
    }

    const FACET_EDGES: usize = 3;

    fn plane(&[a, b, c]: &[[f64; 3]; 3]) -> ([f64; 3], f64) {
        let normal = vector::cross(vector::minus(b, a), vector::minus(c, a));
        (normal, vector::dot(normal, a))
    }

    fn hull(points: &[[f64; 3]]) -> Result<Vec<[u32; 3]>, Error> {
        let mesh = cpu::delaunay(Points::F64(points), &Options::default())?;
        Ok(if mesh.tetrahedra.is_empty() { Vec::new() } else { mesh.hull })
    }

    fn facet_measures(vertices: &[[f64; 3]], corners: &[u32]) -> FacetMeasures<3> {
        let mut normal = [0.0; 3];
        let (mut volume, mut moment) = (0.0, [0.0; 3]);
        if let &[first, second, ref others @ ..] = corners {
            let first = vertices[first as usize];
            let mut u = vector::minus(vertices[second as usize], first);
            for &corner in others {
                let v = vector::minus(vertices[corner as usize], first);
                let twice = vector::cross(u, v);
                let share = vector::dot(first, twice);
                normal = vector::plus(normal, twice);
                volume += share;
                moment = vector::plus(moment, vector::times(share, vector::plus(u, v)));
                u = v;
            }
            // The centre of a tetrahedron with one corner at the origin.
            let from_first = vector::times(3.0 * volume, first);
            moment = vector::times(1.0 / 24.0, vector::plus(moment, from_first));
        }
        FacetMeasures { area: 0.5 * vector::norm(normal), volume: volume / 6.0, moment }
    }
}

/// Appends the ring that begins at a corner of a star.
#[inline(always)]
fn push_ring(
    corners: &[[u32; 3]],
    next: &mut [u32],
    start: usize,
    rings: &mut Csr,
    is_wanted: &mut impl FnMut(u32, &[u32], bool) -> bool,
) {
    let first = rings.indices.len();
    let mut at = start;
    let is_closed = loop {
        rings.indices.push(at as u32 / 4);
        // In a broken mesh, a ring may lead into itself elsewhere than where it began.
        match std::mem::replace(&mut next[at], VISITED) as usize {
            to if to == start => break true,
            to if to >= next.len() => break false,
            to => at = to,
        }
    };
    if is_wanted(corners[start / 4][start % 4], &rings.indices[first..], is_closed) {
        rings.offsets.push(rings.indices.len());
    } else {
        rings.indices.truncate(first);
    }
}
