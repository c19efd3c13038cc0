//! From a triangulation that is nearly Delaunay to the Delaunay triangulation: exact edge flips (Lawson 1977), then the
//! insertion of the points that it lacks.
//!
//! Flipping never gets stuck in the plane (the paper's §5.6). What it starts from is a triangulation by signs that may have
//! been those of rounded coordinates, so some triangles may be flat or inverted on the true ones:
//!
//! 1. An edge is flipped when the triangle on one side is in conflict with the vertex on the other. With ghosts as
//!    triangles like others, a flip at the hull takes a flat triangle off it, or fills a dent.
//! 2. A flip must make triangles that are counter-clockwise. So inverted ones only become fewer.
//! 3. At the end no uncertain triangle is flat or inverted, and the hull turns once; with all edges locally Delaunay, the
//!    triangulation is the one that is asked for. If that is not so, flipping gives up.

use crate::d2::{
    insert::{BEFORE, NEXT, insert_points},
    triangulation::Triangulation2,
};
use crate::{
    Error,
    predicates::{Sign, filter::PredicateContext2},
};

/// How often progress is reported, in flips.
const REPORT: u64 = 1 << 12;

/// A triangulation that is Delaunay but for some places that are known.
#[derive(Debug, Clone)]
pub struct NearDelaunay2 {
    /// The triangulation, ghosts included. It must be a sphere: neighbours are mutual and run against each other.
    pub triangulation: Triangulation2,
    /// Triangles and ghosts, in any order, some perhaps twice, such that every triangle not among them is counter-clockwise,
    /// and every edge without any of them on a side is locally Delaunay, in the exact coordinates.
    pub uncertain: Vec<u32>,
    /// PredicateContext that are no vertices of the triangulation yet, each with a triangle or ghost to start looking from.
    pub missing: Vec<(u32, u32)>,
}

/// What became of a nearly Delaunay triangulation.
#[derive(Debug)]
pub enum Outcome {
    /// The Delaunay triangulation, and how many flips it took.
    Delaunay(Triangulation2, u64),
    /// The CPU engine must start from the points.
    Aborted(Aborted),
}

/// Why flipping gave up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aborted {
    /// It took more flips than were allowed.
    Work,
    /// Rounding had folded the triangulation over itself in a way that flips do not undo.
    Folded,
}

/// Makes `near` the Delaunay triangulation of all `vertices` but the duplicates, with at most `most_flips` flips. `report`
/// learns now and then which share is done, and can stop.
///
/// # Errors
///
/// [`Error::Cancelled`] from `report`, and [`Error::OutOfMemory`].
pub fn lawson(
    vertices: &PredicateContext2<'_>,
    near: NearDelaunay2,
    most_flips: u64,
    report: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<Outcome, Error> {
    let NearDelaunay2 { triangulation: mut mesh, uncertain, missing } = near;
    if missing.len() as u64 > most_flips {
        return Ok(Outcome::Aborted(Aborted::Work));
    }
    let mut pending: Vec<u32> = uncertain.iter().flat_map(|&t| [4 * t, 4 * t + 1, 4 * t + 2]).collect();
    let mut stuck = Vec::new();
    let mut flips = 0;
    while let Some(edge) = pending.pop() {
        if mesh.is_delaunay(vertices, edge) {
            continue;
        }
        if !mesh.can_flip(vertices, edge) {
            stuck.push(edge);
            continue;
        }
        if flips == most_flips {
            return Ok(Outcome::Aborted(Aborted::Work));
        }
        if flips % REPORT == 0 {
            report(flips as f64 / most_flips as f64)?;
        }
        flips += 1;
        let [t, u] = mesh.flip(edge);
        pending.extend([4 * t, 4 * t + 2, 4 * u, 4 * u + 1]);
    }
    let hull_turns_once = mesh.hull_turns_once(vertices);
    let counter_clockwise = uncertain.iter().all(|&t| mesh.is_ghost(t) || mesh.orientation(vertices, t) > 0);
    if !hull_turns_once || !counter_clockwise || stuck.iter().any(|&edge| !mesh.is_delaunay(vertices, edge)) {
        return Ok(Outcome::Aborted(Aborted::Folded));
    }
    // Those that start from the same triangle are near each other.
    for near in missing.chunk_by(|(_, start), (_, other)| start == other) {
        insert_points(&mut mesh, vertices, near.iter().map(|&(v, _)| v), near[0].1, |_| report(1.0))?;
    }
    Ok(Outcome::Delaunay(mesh, flips))
}

impl Triangulation2 {
    fn orientation(&self, vertices: &PredicateContext2<'_>, t: u32) -> Sign {
        let [a, b, c] = self.triangles[t as usize];
        vertices.orient2d(a, b, c)
    }

    /// The four vertices around an edge: [p, a, b, q] for the triangles p, a, b and q, b, a.
    fn around(&self, edge: u32) -> [u32; 4] {
        let corners = |e: u32| (self.triangles[e as usize / 4], e as usize % 4);
        let (t, k) = corners(edge);
        let (u, l) = corners(self.neighbors[edge as usize / 4][edge as usize % 4]);
        [t[k], t[NEXT[k]], t[BEFORE[k]], u[l]]
    }

    /// Whether the triangle on neither side of the edge is in conflict with the vertex on the other: both say the same.
    fn is_delaunay(&self, vertices: &PredicateContext2<'_>, edge: u32) -> bool {
        let across = self.neighbors[edge as usize / 4][edge as usize % 4];
        let [p, .., q] = self.around(edge);
        // A ghost's conflict with infinity has no meaning.
        if p == q {
            // All that was on either side of the edge has been peeled off.
            false
        } else if q == self.infinite {
            !self.in_conflict(vertices, across >> 2, p)
        } else {
            !self.in_conflict(vertices, edge >> 2, q)
        }
    }

    /// Whether the triangles that a flip would make are counter-clockwise or ghosts.
    fn can_flip(&self, vertices: &PredicateContext2<'_>, edge: u32) -> bool {
        let [p, a, b, q] = self.around(edge);
        let proper = |t: [u32; 3]| t.contains(&self.infinite) || vertices.orient2d(t[0], t[1], t[2]) > 0;
        p != q && proper([p, a, q]) && proper([p, q, b])
    }

    /// Puts the other diagonal in place of an edge: triangles p, a, b and q, b, a become p, a, q and p, q, b. Gives the
    /// two, in this order; the edges around them are opposite the vertices 0 and 2, and 0 and 1.
    fn flip(&mut self, edge: u32) -> [u32; 2] {
        let across = self.neighbors[edge as usize / 4][edge as usize % 4];
        let [p, a, b, q] = self.around(edge);
        let [t, u] = [edge, across].map(|e| e >> 2);
        let beyond = |e: u32, to: [usize; 3]| self.neighbors[e as usize / 4][to[e as usize % 4]];
        // Across the edges a b → p a, b p and a q, q b.
        let (pa, bp) = (beyond(edge, BEFORE), beyond(edge, NEXT));
        let (aq, qb) = (beyond(across, NEXT), beyond(across, BEFORE));
        self.triangles[t as usize] = [p, a, q];
        self.triangles[u as usize] = [p, q, b];
        self.join(4 * t, aq);
        self.join(4 * t + 2, pa);
        self.join(4 * u, qb);
        self.join(4 * u + 1, bp);
        self.join(4 * t + 1, 4 * u + 2);
        [t, u]
    }

    /// Whether the hull is one polygon without a dent that turns once: one vertex of it is before both its neighbours in
    /// the order of coordinates, and one is after.
    fn hull_turns_once(&self, vertices: &PredicateContext2<'_>) -> bool {
        let ghosts = (0..self.triangles.len() as u32).filter(|&t| self.is_ghost(t)).count();
        let hull = self.hull_vertices();
        if hull.len() != ghosts {
            return false;
        }
        let before = |v: u32, w: u32| vertices.point(v) < vertices.point(w);
        let corners = (0..hull.len()).map(|i| [0, 1, 2].map(|k| hull[(i + k) % hull.len()]));
        let [mut first, mut last] = [0, 0];
        for [a, b, c] in corners {
            match (before(a, b), before(b, c)) {
                (true, false) => last += 1,
                (false, true) => first += 1,
                _ => {}
            }
            // The hull is clockwise.
            if vertices.orient2d(a, b, c) > 0 {
                return false;
            }
        }
        first == 1 && last == 1
    }
}
