//! The end of a GPU triangulation: exact edge flips (Lawson 1977) make a nearly Delaunay
//! triangulation Delaunay, then the points that it lacks are inserted.
//!
//! Flipping never gets stuck in 2D (the paper's §5.6). The triangulation was made by predicates
//! that may have used rounded coordinates, however, so some triangles may be flat or inverted in
//! the exact ones:
//!
//! 1. An edge is flipped if the triangle on one side is in conflict with the vertex on the other.
//!    Ghosts are triangles like any others, so a flip at the hull removes a flat triangle from it,
//!    or fills a dent.
//! 2. The triangles that a flip makes must be counter-clockwise. So the number of inverted
//!    triangles only decreases.
//! 3. At the end, no uncertain triangle may be flat or inverted, and the hull must turn once. Then,
//!    with all edges locally Delaunay, the triangulation is the Delaunay triangulation. Otherwise
//!    flipping aborts.

use crate::d2::{
    insert::{NEXT, PREVIOUS},
    triangulation::Triangulation2,
};
use crate::{
    cpu::insert_points,
    d2::insert::in_conflict,
    error::Error,
    options::Winding,
    predicates::{Sign, filter::PredicateContext2},
};

/// The number of flips between two reports of progress: few enough for a smooth display, and so
/// many that reports cost little beside the flips.
const REPORT: u64 = 1 << 12;

/// A triangulation that is Delaunay except in known places.
#[derive(Debug, Clone)]
pub struct NearDelaunay2 {
    /// All triangles, ghosts included. Topologically it must be a sphere: neighbours are mutual,
    /// and shared edges have opposite directions.
    pub triangulation: Triangulation2,
    /// Triangles and ghosts, in any order and possibly repeated. In exact coordinates, every
    /// triangle that is not among them must be counter-clockwise, and every edge without one of
    /// them on either side must be locally Delaunay.
    pub uncertain: Vec<u32>,
    /// The vertices that the triangulation lacks, each with a triangle or ghost where its location
    /// starts.
    pub missing: Vec<(u32, u32)>,
}

/// The result of [`lawson`].
#[derive(Debug)]
pub enum LawsonOutcome {
    /// The Delaunay triangulation, and the number of flips.
    Delaunay(Triangulation2, u64),
    /// The reason why there is no triangulation: the CPU has to triangulate the points from
    /// scratch.
    Aborted(Aborted),
}

/// The reason why flipping aborted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aborted {
    /// More flips are needed than the caller allows.
    BudgetExceeded,
    /// Rounding folded the triangulation over itself in a way that flips do not undo.
    Folded,
}

/// Makes `near` the Delaunay triangulation of all `vertices` except duplicates, with at most
/// `max_flips` flips.
///
/// Calls `report` with the share of the work that is done from time to time; an error from it ends
/// the work.
///
/// # Errors
///
/// Returns the errors of `report` and [`Error::OutOfMemory`].
pub fn lawson(
    vertices: &PredicateContext2<'_>,
    near: NearDelaunay2,
    max_flips: u64,
    report: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<LawsonOutcome, Error> {
    let NearDelaunay2 { triangulation: mut mesh, uncertain, missing } = near;
    if missing.len() as u64 > max_flips {
        return Ok(LawsonOutcome::Aborted(Aborted::BudgetExceeded));
    }
    let pending = uncertain.iter().flat_map(|&t| [4 * t, 4 * t + 1, 4 * t + 2]).collect();
    let mut flips = 0;
    let report_flips = |flips: u64| report(flips as f64 / max_flips as f64);
    let Some(stuck) = flip_edges(&mut mesh, vertices, pending, &mut flips, max_flips, &report_flips)? else {
        return Ok(LawsonOutcome::Aborted(Aborted::BudgetExceeded));
    };
    let hull_turns_once = mesh.hull_turns_once(vertices);
    let counter_clockwise = uncertain.iter().all(|&t| mesh.is_ghost(t) || mesh.orientation(vertices, t) > 0);
    if !hull_turns_once || !counter_clockwise || stuck.iter().any(|&edge| !mesh.is_delaunay(vertices, edge)) {
        return Ok(LawsonOutcome::Aborted(Aborted::Folded));
    }
    // Vertices that start from the same triangle are near each other.
    for near in missing.chunk_by(|(_, start), (_, other)| start == other) {
        insert_points(&mut mesh, vertices, near.iter().map(|&(v, _)| v), near[0].1, |_| report(1.0))?;
    }
    Ok(LawsonOutcome::Delaunay(mesh, flips))
}

/// Flips edges until those that are not locally Delaunay cannot be flipped, and returns these;
/// `None` if that takes more than `max_flips` flips. `flips` counts them.
///
/// Calls `report` with their number from time to time; an error from it ends the work.
///
/// # Errors
///
/// Returns the errors of `report`.
fn flip_edges(
    mesh: &mut Triangulation2,
    vertices: &PredicateContext2<'_>,
    mut pending: Vec<u32>,
    flips: &mut u64,
    max_flips: u64,
    report: &dyn Fn(u64) -> Result<(), Error>,
) -> Result<Option<Vec<u32>>, Error> {
    let mut stuck = Vec::new();
    while let Some(edge) = pending.pop() {
        if mesh.is_delaunay(vertices, edge) {
            continue;
        }
        if !mesh.can_flip(vertices, edge) {
            stuck.push(edge);
            continue;
        }
        if *flips == max_flips {
            return Ok(None);
        }
        if flips.is_multiple_of(REPORT) {
            report(*flips)?;
        }
        *flips += 1;
        let [t, u] = mesh.flip(edge);
        pending.extend([4 * t, 4 * t + 2, 4 * u, 4 * u + 1]);
    }
    Ok(Some(stuck))
}

impl Triangulation2 {
    /// Returns the orientation of triangle `t`.
    fn orientation(&self, vertices: &PredicateContext2<'_>, t: u32) -> Sign {
        let [a, b, c] = self.triangles[t as usize];
        vertices.orient2d(a, b, c)
    }

    /// Returns the four vertices around an edge: [p, a, b, q] for the triangles p, a, b and q, b,
    /// a.
    fn around(&self, edge: u32) -> [u32; 4] {
        let corners = |e: u32| (self.triangles[e as usize / 4], e as usize % 4);
        let (t, k) = corners(edge);
        let (u, l) = corners(self.neighbors[edge as usize / 4][edge as usize % 4]);
        [t[k], t[NEXT[k]], t[PREVIOUS[k]], u[l]]
    }

    /// Returns whether the triangle on one side of the edge is not in conflict with the vertex on
    /// the other; both sides give the same answer.
    fn is_delaunay(&self, vertices: &PredicateContext2<'_>, edge: u32) -> bool {
        let across = self.neighbors[edge as usize / 4][edge as usize % 4];
        let [p, .., q] = self.around(edge);
        // A conflict between a ghost and infinity has no meaning, so the other side is tested then.
        if p == q {
            // Everything on either side of the edge has been peeled off.
            false
        } else if q == self.infinite {
            !in_conflict(self, &vertices.at(p), across >> 2)
        } else {
            !in_conflict(self, &vertices.at(q), edge >> 2)
        }
    }

    /// Returns whether the triangles that a flip would make are counter-clockwise or ghosts.
    fn can_flip(&self, vertices: &PredicateContext2<'_>, edge: u32) -> bool {
        let [p, a, b, q] = self.around(edge);
        let proper = |t: [u32; 3]| t.contains(&self.infinite) || vertices.orient2d(t[0], t[1], t[2]) > 0;
        p != q && proper([p, a, q]) && proper([p, q, b])
    }

    /// Replaces an edge by the other diagonal: triangles p, a, b and q, b, a become p, a, q and p,
    /// q, b.
    ///
    /// Returns the two triangles, in this order. Their outer edges are opposite corners 0 and 2 of
    /// the first, and corners 0 and 1 of the second.
    fn flip(&mut self, edge: u32) -> [u32; 2] {
        let across = self.neighbors[edge as usize / 4][edge as usize % 4];
        let [p, a, b, q] = self.around(edge);
        let [t, u] = [edge, across].map(|e| e >> 2);
        let beyond = |e: u32, to: [usize; 3]| self.neighbors[e as usize / 4][to[e as usize % 4]];
        // The neighbours across the edges p a and b p, and a q and q b.
        let (pa, bp) = (beyond(edge, PREVIOUS), beyond(edge, NEXT));
        let (aq, qb) = (beyond(across, NEXT), beyond(across, PREVIOUS));
        self.triangles[t as usize] = [p, a, q];
        self.triangles[u as usize] = [p, q, b];
        self.join(4 * t, aq);
        self.join(4 * t + 2, pa);
        self.join(4 * u, qb);
        self.join(4 * u + 1, bp);
        self.join(4 * t + 1, 4 * u + 2);
        [t, u]
    }

    /// Returns whether the hull is one polygon that [`turns_once`].
    fn hull_turns_once(&self, vertices: &PredicateContext2<'_>) -> bool {
        let ghosts = (0..self.triangles.len() as u32).filter(|&t| self.is_ghost(t)).count();
        let hull = self.hull_vertices();
        hull.len() == ghosts && turns_once(vertices, &hull, Winding::Clockwise)
    }
}

/// Returns whether a polygon has no dent and turns once: exactly one of its vertices precedes both
/// its neighbours in lexicographic order, and exactly one follows both.
pub(crate) fn turns_once(vertices: &PredicateContext2<'_>, polygon: &[u32], winding: Winding) -> bool {
    let dent = match winding {
        Winding::Clockwise => 1,
        Winding::CounterClockwise => -1,
    };
    let before = |v: u32, w: u32| vertices.point(v) < vertices.point(w);
    let corners = (0..polygon.len()).map(|i| [0, 1, 2].map(|k| polygon[(i + k) % polygon.len()]));
    let [mut first, mut last] = [0, 0];
    for [a, b, c] in corners {
        match (before(a, b), before(b, c)) {
            (true, false) => last += 1,
            (false, true) => first += 1,
            _ => {}
        }
        if vertices.orient2d(a, b, c) == dent {
            return false;
        }
    }
    first == 1 && last == 1
}
