//! Phase 2 (§3.2): from a triangulation that is nearly Delaunay to the Delaunay triangulation, by adaptive star splaying.
//!
//! `uncertain tetrahedra → peel flat ones → failed vertices → convex stars → consistent stars → patch → missing points`
//!
//! All signs are those of the true coordinates, with the ties that define the answer. The work is proportional to what
//! has to change: neither the triangulation nor its hull is ever looked at as a whole. Where that turns out to be too
//! much, or the triangulation was none, splaying gives up, and says so.

mod build;
mod consistency;
mod flip_flop;
mod ledger;
mod patch;
mod peel;
mod predicates;
mod star;

use crate::{
    Error,
    d3::{
        insert,
        triangulation::{Triangulation, state},
    },
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    stats::SplayStats,
};
use build::Known;
use consistency::Splaying;
use predicates::StarPredicates;
use rustc_hash::FxHashSet;

/// No tetrahedron, in [`NearDelaunay::incident`].
pub const NONE: u32 = star::NONE;

/// What Phase 1 makes: a triangulation that is nearly Delaunay, and where it may not be. What neither `failed` nor `uncertain` has
/// is taken for proven.
#[derive(Debug, Clone)]
pub struct NearDelaunay {
    /// All tetrahedra, ghosts included. Inverted and flat ones are no harm as long as they are among the uncertain.
    pub triangulation: Triangulation,
    /// A tetrahedron at each vertex, a ghost if there is one; [`NONE`] for those that are missing.
    pub incident: Vec<u32>,
    /// The vertices of all facets that are known not to be locally Delaunay, ghosts' facets included.
    pub failed: Vec<u32>,
    /// The tetrahedra that may be flat or inverted, or have a facet that is not locally Delaunay for other reasons.
    pub uncertain: Vec<u32>,
    /// The vertices that the triangulation lacks; best if neighbours in the order are neighbours in space.
    pub missing: Vec<u32>,
}

/// What splaying came to.
#[derive(Debug)]
pub enum Outcome {
    /// The Delaunay triangulation.
    Delaunay(Box<Triangulation>, SplayStats),
    /// None, for this reason: the CPU engine has to make it.
    Aborted(Aborted),
}

/// Why there is no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aborted {
    /// There is more work to do than the caller allows.
    Work,
    /// What there was is no triangulation.
    Inconsistent(&'static str),
}

/// Tetrahedra that a thread looks at together.
const TETRAHEDRA: usize = 256;

/// Why splaying ends early.
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

impl NearDelaunay {
    /// About as many signs as the CPU engine asks for to make the triangulation from nothing.
    pub fn evaluations_from_scratch(&self) -> u64 {
        16 * self.triangulation.tetrahedra().len() as u64
    }
}

/// The Delaunay triangulation of `vertices`, of which `near` is nearly one. It gives up when the stars ask for more than
/// `max_evaluations`, the measure of its work; see [`NearDelaunay::evaluations_from_scratch`]. The work is that of `threads`, unless the
/// vertices are stored. `report` learns now and then which share of it is done, and can stop it.
///
/// # Errors
///
/// What `report` returns, [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub fn splay(
    vertices: &PredicateContext<'_>,
    near: NearDelaunay,
    max_evaluations: u64,
    threads: Threads,
    report: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<Outcome, Error> {
    match try_splay(vertices, near, max_evaluations, threads, report) {
        Ok((triangulation, stats)) => Ok(Outcome::Delaunay(Box::new(triangulation), stats)),
        Err(Stop::Aborted(reason)) => Ok(Outcome::Aborted(reason)),
        Err(Stop::Error(error)) => Err(error),
    }
}

fn try_splay(
    vertices: &PredicateContext<'_>,
    near: NearDelaunay,
    max_evaluations: u64,
    threads: Threads,
    report: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<(Triangulation, SplayStats), Stop> {
    let NearDelaunay { triangulation: mut mesh, mut incident, mut failed, uncertain, missing } = near;
    let kernel = kernel(&mesh, vertices).ok_or(Aborted::Inconsistent("all tetrahedra are flat"))?;
    let space = StarPredicates::new(vertices, mesh.infinite, kernel);
    let mut free = Vec::new();

    let mut flat = space
        .shared(threads, uncertain.len(), TETRAHEDRA, |space, range| {
            let is_flat = |&t: &u32| !mesh.is_ghost(t) && space.orient(mesh.vertices(t)) == 0;
            uncertain[range].iter().copied().filter(is_flat).collect::<Vec<_>>()
        })
        .concat();
    let found = flat.len();
    let mut suspect = peel::peel(&mut mesh, &space, threads, &mut flat, &mut incident, &mut free)?;
    let peeled = found - flat.len();

    suspect.extend(uncertain);
    parallel::sort(threads, &mut suspect);
    suspect.dedup();
    let mut turned = FxHashSet::default();
    for (more_failed, more_turned) in space.shared(threads, suspect.len(), TETRAHEDRA, |space, range| {
        let (mut failed, mut turned) = (Vec::new(), Vec::new());
        for &t in suspect[range].iter().filter(|&&t| mesh.state(t) != state::FREE) {
            if add_failed(&mesh, space, t, &mut failed) {
                turned.push(t);
            }
        }
        (failed, turned)
    }) {
        failed.extend(more_failed);
        turned.extend(more_turned);
    }
    failed.retain(|&v| v != mesh.infinite);
    failed.sort_unstable();
    failed.dedup();
    let mut has_failed = vec![false; mesh.infinite as usize + 1];
    failed.iter().for_each(|&v| has_failed[v as usize] = true);

    let known = Known { mesh: &mesh, incident: &incident, failed: has_failed, turned };
    let splaying = Splaying::new(known, threads);
    let (remove, add, mut stats) = splaying.run(&space, &failed, max_evaluations, report)?;
    let filled = patch::patch(&mut mesh, &space, threads, &remove, &add, &mut free)?;

    let start = filled.last().or(incident.iter().find(|&&t| t != NONE)).copied().unwrap_or(0);
    stats.signs = space.signs();
    stats.inserted = missing.len();
    if !missing.is_empty() {
        insert::insert_points(&mut mesh, vertices, missing, start, |_| report(1.0))?;
    }
    stats.peeled = peeled;
    stats.failed = failed.len();
    (stats.removed, stats.added) = (remove.len(), add.len());
    Ok((mesh, stats))
}

/// The first tetrahedron that is positively oriented.
fn kernel(mesh: &Triangulation, vertices: &PredicateContext<'_>) -> Option<[u32; 4]> {
    let mut finite = (0..mesh.tetrahedra.len() as u32).filter(|&t| mesh.state(t) != state::FREE && !mesh.is_ghost(t));
    finite.find_map(|t| {
        let [a, b, c, d] = mesh.vertices(t);
        (vertices.orient3d(a, b, c, d) > 0).then_some([a, b, c, d])
    })
}

/// Adds the vertices of a tetrahedron that is not positively oriented, or else of those of its facets that are not
/// locally Delaunay. True if it is not positively oriented.
fn add_failed(mesh: &Triangulation, space: &StarPredicates<'_>, t: u32, failed: &mut Vec<u32>) -> bool {
    let v = mesh.vertices(t);
    let mut add = |vertices: &[usize]| failed.extend(vertices.iter().map(|&i| v[i]).filter(|&v| v != mesh.infinite));
    if space.orient(v) <= 0 {
        add(&[0, 1, 2, 3]);
        return true;
    }
    for (k, facet) in crate::d3::mesh::FACETS.iter().enumerate() {
        if !patch::is_locally_delaunay(mesh, space, t, k) {
            add(facet);
        }
    }
    false
}
