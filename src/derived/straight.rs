//! Walks along a straight line, from a vertex to a query (Devillers, Pion and Teillaud, *Walking in a triangulation*,
//! 2002).
//!
//! In a constrained triangulation, a visibility walk can go around in a circle. A straight line leads through no
//! triangle twice.

use super::{
    Locator,
    locate::{Beyond, ENDLESS, Place},
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet},
    index::NONE,
};

/// Where a line from a vertex leaves the first triangle, as (triangle, number of the opposite vertex), or where it ends
/// before it has entered one.
enum First<const D: usize> {
    Exit(usize, usize),
    End(Place<D>),
}

impl<const D: usize, const N: usize> Locator<'_, D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Walks from the first vertex of a triangle to the place of a query. For 2D meshes.
    pub(super) fn walk_straight(&self, query: [f64; D], start: usize) -> Result<Place<D>, Error> {
        let complex = &self.complex;
        let first = complex.simplices[start][0];
        let origin = complex.point(first);
        if origin == query {
            return Ok(self.inside(query, start, true));
        }
        let (mut t, mut exit) = match self.first_exit(query, start, first)? {
            First::Exit(t, exit) => (t, exit),
            First::End(place) => return Ok(place),
        };
        let line = std::array::from_fn(|i| if i == 0 { origin } else { query });
        let side = |v: u32| Euclidean::side(&line, complex.point(v));
        // The ends of the edge that the line crosses. One of them is off the line, and the vertices on its side replace it;
        // all others replace the other one, those on the line, too.
        let [mut off, mut other] = [1, 2].map(|k| complex.simplices[t][(exit + k) % N]);
        if side(off) == 0 {
            (off, other) = (other, off);
        }
        let side_of_off = side(off);
        for _ in 0..=complex.simplices.len() {
            let corners = complex.corners(t);
            let side_of_query = Euclidean::side(&facet(&corners, exit), query);
            if side_of_query >= 0 {
                let on_facet = (0..N).any(|k| Euclidean::side(&facet(&corners, k), query) == 0);
                return Ok(self.inside(query, t, on_facet));
            }
            let Some(across) = complex.across(t, exit) else { return Ok(outside(query, t, exit)) };
            let entry = complex.facet_towards(across, t);
            let Some(&vertex) = complex.simplices[across].get(entry) else { return Err(ENDLESS) };
            let replaced = if side(vertex) == side_of_off { &mut off } else { &mut other };
            let gone = std::mem::replace(replaced, vertex);
            exit = complex.simplices[across].iter().position(|&v| v == gone).ok_or(ENDLESS)?;
            t = across;
        }
        Err(ENDLESS)
    }

    /// Turns around a vertex of a triangle until the line to a query leads into a triangle.
    fn first_exit(&self, query: [f64; D], start: usize, vertex: u32) -> Result<First<D>, Error> {
        let complex = &self.complex;
        // Both ways, since the vertex may be on the hull.
        for way in [1, 2] {
            let mut t = start;
            for _ in 0..=complex.simplices.len() {
                let corner = complex.simplices[t].iter().position(|&v| v == vertex).ok_or(ENDLESS)?;
                let corners = complex.corners(t);
                let side = |k: usize| Euclidean::side(&facet(&corners, k), query);
                let [next, last] = [way, 3 - way].map(|k| (corner + k) % N);
                if side(next) >= 0 && side(last) >= 0 {
                    return Ok(First::Exit(t, corner));
                }
                match complex.neighbors[t][next] {
                    NONE if side(next) < 0 => return Ok(First::End(outside(query, t, next))),
                    NONE => break,
                    across if across as usize == start => return Err(ENDLESS),
                    across => t = across as usize,
                }
            }
        }
        Err(ENDLESS)
    }
}

/// Returns the place of a query that is outside the hull, beyond facet `k` of triangle `t`.
fn outside<const D: usize>(query: [f64; D], t: usize, k: usize) -> Place<D> {
    Place { at: query, simplex: t, beyond: Some(Beyond { facet: k, near: false }), on_facet: false }
}
