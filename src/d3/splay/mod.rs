//! Phase 2 (§3.2): adaptive star splaying makes a nearly Delaunay triangulation Delaunay, then the
//! points that it lacks are inserted.
//!
//! `uncertain tetrahedra → peel flat ones → failed vertices → convex stars → consistent stars →
//! patch → missing points`
//!
//! All predicates are evaluated at the exact coordinates, with the ties that define the result. The
//! work is proportional to what has to change: neither the triangulation nor its hull is ever
//! visited as a whole. If that turns out to be too much, or the input is not a triangulation,
//! splaying aborts and returns the reason.

mod build;
mod consistency;
mod flip_flop;
mod ledger;
mod patch;
mod peel;
mod predicates;
mod star;

use crate::{
    cpu::insert_points,
    d3::triangulation::{Triangulation3, state},
    error::Error,
    index::NO_INDEX,
    parallel::{self, Threads},
    predicates::filter::PredicateContext3,
    stats::SplayStats,
};
use build::Known;
use consistency::Splaying;
use predicates::StarPredicates;
use rustc_hash::FxHashSet;

/// The result of Phase 1: a triangulation that is nearly Delaunay, and where it may not be.
/// A tetrahedron that is not `uncertain` is taken to be positively oriented, and its facets to be
/// locally Delaunay unless all three vertices have `failed`.
#[derive(Debug, Clone)]
pub struct NearDelaunay3 {
    /// All tetrahedra, ghosts included. Inverted and flat ones are allowed if they are among the
    /// uncertain ones.
    pub triangulation: Triangulation3,
    /// A tetrahedron at each vertex, a ghost if there is one; [`NO_INDEX`] for the vertices that
    /// are missing.
    pub incident: Vec<u32>,
    /// The vertices of all facets that are known not to be locally Delaunay, the facets of ghosts
    /// included.
    pub failed: Vec<u32>,
    /// The tetrahedra that may be flat or inverted, or may have a facet that is not locally
    /// Delaunay for other reasons.
    pub uncertain: Vec<u32>,
    /// The vertices that the triangulation lacks. Their insertion is fast if consecutive vertices
    /// are near each other.
    pub missing: Vec<u32>,
}

/// The result of [`splay`].
#[derive(Debug)]
pub enum SplayOutcome {
    /// The Delaunay triangulation, and what splaying did.
    Delaunay(Box<Triangulation3>, SplayStats),
    /// No triangulation, for this reason: the CPU has to triangulate the points from scratch.
    Aborted(Aborted),
}

/// The reason why splaying aborted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aborted {
    /// More predicate evaluations are needed than the caller allows.
    BudgetExceeded,
    /// The input is not a triangulation, for this reason.
    Inconsistent(&'static str),
}

/// The number of tetrahedra that a thread takes at a time.
const TETRAHEDRON_GRAIN: usize = 256;

/// The reason why splaying ends early.
enum Stop {
    Aborted(Aborted),
    Error(Error),
}

impl From<Aborted> for Stop {
    fn from(reason: Aborted) -> Self {
        Stop::Aborted(reason)
    }
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Stop::Error(error)
    }
}

impl NearDelaunay3 {
    /// Returns the approximate number of predicate evaluations that the CPU needs to triangulate
    /// the points from scratch: 16 per tetrahedron.
    pub fn evaluations_from_scratch(&self) -> u64 {
        16 * self.triangulation.tetrahedra().len() as u64
    }
}

/// Returns the Delaunay triangulation of `vertices`, given `near`, which is nearly one.
///
/// Splaying aborts if it needs more than `max_evaluations` predicate evaluations, the measure of
/// its work; see [`NearDelaunay3::evaluations_from_scratch`]. `threads` share the work, unless
/// `vertices` stores coordinates. Calls `report` with the share of the work that is done from time
/// to time; an error from it ends the work.
///
/// # Errors
///
/// What `report` returns, [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub fn splay(
    vertices: &PredicateContext3<'_>,
    near: NearDelaunay3,
    max_evaluations: u64,
    threads: Threads,
    report: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<SplayOutcome, Error> {
    match try_splay(vertices, near, max_evaluations, threads, report) {
        Ok((triangulation, stats)) => Ok(SplayOutcome::Delaunay(Box::new(triangulation), stats)),
        Err(Stop::Aborted(reason)) => Ok(SplayOutcome::Aborted(reason)),
        Err(Stop::Error(error)) => Err(error),
    }
}

fn try_splay(
    vertices: &PredicateContext3<'_>,
    near: NearDelaunay3,
    max_evaluations: u64,
    threads: Threads,
    report: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<(Triangulation3, SplayStats), Stop> {
    let NearDelaunay3 { triangulation: mut mesh, mut incident, mut failed, uncertain, missing } = near;
    let spanning = spanning_tetrahedron(&mesh, vertices).ok_or(Aborted::Inconsistent("all tetrahedra are flat"))?;
    let predicates = StarPredicates::new(vertices, mesh.infinite, spanning);
    let mut free = Vec::new();

    let mut flat = predicates
        .shared(threads, uncertain.len(), TETRAHEDRON_GRAIN, |predicates, range| {
            let is_flat = |&t: &u32| !mesh.is_ghost(t) && predicates.orient(mesh.vertices(t)) == 0;
            uncertain[range].iter().copied().filter(is_flat).collect::<Vec<_>>()
        })
        .concat();
    let found = flat.len();
    let mut suspect = peel::peel(&mut mesh, &predicates, threads, &mut flat, &mut incident, &mut free)?;
    let peeled = found - flat.len();

    suspect.extend(uncertain);
    parallel::sort(threads, &mut suspect);
    suspect.dedup();
    let mut inverted = FxHashSet::default();
    for (more_failed, more_inverted) in
        predicates.shared(threads, suspect.len(), TETRAHEDRON_GRAIN, |predicates, range| {
            let (mut failed, mut inverted) = (Vec::new(), Vec::new());
            for &t in suspect[range].iter().filter(|&&t| mesh.state(t) != state::FREE) {
                if add_failed(&mesh, predicates, t, &mut failed) {
                    inverted.push(t);
                }
            }
            (failed, inverted)
        })
    {
        failed.extend(more_failed);
        inverted.extend(more_inverted);
    }
    failed.retain(|&v| v != mesh.infinite);
    failed.sort_unstable();
    failed.dedup();
    let mut has_failed = vec![false; mesh.infinite as usize + 1];
    failed.iter().for_each(|&v| has_failed[v as usize] = true);

    let known = Known { mesh: &mesh, incident: &incident, failed: has_failed, inverted };
    let splaying = Splaying::new(known, threads);
    let (remove, add, mut stats) = splaying.run(&predicates, &failed, max_evaluations, report)?;
    let filled = patch::patch(&mut mesh, &predicates, threads, &remove, &add, &mut free)?;

    let start = filled.last().or(incident.iter().find(|&&t| t != NO_INDEX)).copied().unwrap_or(0);
    stats.signs = predicates.evaluations();
    stats.inserted = missing.len();
    if !missing.is_empty() {
        insert_points(&mut mesh, vertices, missing, start, |_| report(1.0))?;
    }
    stats.peeled = peeled;
    stats.failed = failed.len();
    (stats.removed, stats.added) = (remove.len(), add.len());
    Ok((mesh, stats))
}

/// Returns the first tetrahedron that is positively oriented.
fn spanning_tetrahedron(mesh: &Triangulation3, vertices: &PredicateContext3<'_>) -> Option<[u32; 4]> {
    let mut finite = (0..mesh.tetrahedra.len() as u32).filter(|&t| mesh.state(t) != state::FREE && !mesh.is_ghost(t));
    finite.find_map(|t| {
        let [a, b, c, d] = mesh.vertices(t);
        (vertices.orient3d(a, b, c, d) > 0).then_some([a, b, c, d])
    })
}

/// Adds to `failed` the vertices of a tetrahedron that is not positively oriented, or else those of
/// its facets that are not locally Delaunay. Returns whether it is not positively oriented.
fn add_failed(mesh: &Triangulation3, predicates: &StarPredicates<'_>, t: u32, failed: &mut Vec<u32>) -> bool {
    let v = mesh.vertices(t);
    let mut add = |vertices: &[usize]| failed.extend(vertices.iter().map(|&i| v[i]).filter(|&v| v != mesh.infinite));
    if predicates.orient(v) <= 0 {
        add(&[0, 1, 2, 3]);
        return true;
    }
    for (k, facet) in crate::d3::mesh::FACETS.iter().enumerate() {
        if !patch::is_locally_delaunay(mesh, predicates, t, k) {
            add(facet);
        }
    }
    false
}
