//! Phase 2 (§3.2): adaptive star splaying makes a nearly Delaunay triangulation Delaunay, then the
//! points that it lacks are inserted.
//!
//! `uncertain tetrahedra → peel flat ones → failed vertices → convex stars → consistent stars →
//! patch → missing points`
//!
//! All predicates are evaluated at the exact coordinates, with the ties that define the result. The
//! work is proportional to what has to change: neither the triangulation nor its hull is ever
//! visited as a whole. It need not be here as a whole, either: splaying works on a [`Region`], and
//! says which stars it lacks. If that turns out to be too much, or the input is not a triangulation,
//! splaying aborts and returns the reason.

mod build;
mod consistency;
mod flip_flop;
mod gathered;
mod index_set;
mod insert;
mod ledger;
mod memory;
mod patch;
mod peel;
pub(in crate::d3) mod predicates;
mod region;
mod star;

use crate::{
    d3::triangulation::{Triangulation3, state},
    error::Error,
    index::NONE,
    parallel::{self, Threads},
    predicates::filter::PredicateContext3,
    stats::{Fallback, SplayStats},
};
use build::Known;
use consistency::Splaying;
#[cfg(feature = "gpu")]
pub(crate) use gathered::SLOT;
pub use gathered::{Gathered, NAMED_SHIFT};
pub(in crate::d3) use index_set::IndexSet;
use predicates::StarPredicates;
pub use region::{KEEP, KeptRegion, Patch, Region};

/// The result of Phase 1: a triangulation that is nearly Delaunay, and where it may not be.
/// A tetrahedron that is not `uncertain` is taken to be positively oriented, and its facets to be
/// locally Delaunay unless all three vertices have `failed`.
#[derive(Debug, Clone)]
pub struct NearDelaunay3 {
    /// All tetrahedra, ghosts included. Inverted and flat ones are allowed if they are among the
    /// uncertain ones.
    pub triangulation: Triangulation3,
    /// A tetrahedron at each vertex, a ghost if there is one; [`NONE`] for the vertices that
    /// are missing.
    pub vertex_simplex: Vec<u32>,
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

/// Where a triangulation may not be Delaunay: [`NearDelaunay3`] for a [`Region`] of it.
#[derive(Debug, Clone, Default)]
pub struct Doubts {
    /// The vertices of all facets that are known not to be locally Delaunay. The region has their
    /// stars.
    pub failed: Vec<u32>,
    /// The tetrahedra that may be flat or inverted, or may have a facet that is not locally
    /// Delaunay for other reasons. The region has the stars of their vertices.
    pub uncertain: Vec<u32>,
    /// The vertices that the triangulation lacks, each with one near it that it has, or with
    /// [`NONE`] if it is near the one before.
    pub missing: Vec<[u32; 2]>,
}

/// How splaying ends.
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

/// Why the CPU engine has to do what splaying aborted.
impl From<Aborted> for Fallback {
    fn from(reason: Aborted) -> Self {
        match reason {
            Aborted::BudgetExceeded => Fallback::Splaying,
            Aborted::Inconsistent(what) => Fallback::Inconsistent(what),
        }
    }
}

/// The number of tetrahedra that a thread takes at a time.
const TETRAHEDRON_GRAIN: usize = 256;

/// The reason why splaying ends early.
#[derive(Debug)]
pub enum Stop {
    /// The CPU has to triangulate the points from scratch.
    Aborted(Aborted),
    /// An error of the caller's, or a lack of memory.
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

/// Returns the approximate number of predicate evaluations that the CPU needs to triangulate
/// points from scratch whose triangulation has so many tetrahedra: 16 for each.
#[cfg(feature = "gpu")]
pub fn evaluations_from_scratch(tetrahedra: usize) -> u64 {
    16 * tetrahedra as u64
}

/// How splaying is limited and followed.
#[derive(Clone, Copy)]
pub struct Terms<'a> {
    /// Splaying aborts if it needs more predicate evaluations, the measure of its work; see
    /// [`evaluations_from_scratch`].
    pub max_evaluations: u64,
    /// Who shares the work, unless the context of the vertices stores coordinates.
    pub threads: Threads,
    /// Receives the share of the work that is done from time to time; an error from it ends the
    /// work.
    pub report: &'a dyn Fn(f64) -> Result<(), Error>,
}

impl Terms<'static> {
    /// Returns the terms without a limit and without reports.
    pub fn unlimited(threads: Threads) -> Self {
        Terms { max_evaluations: u64::MAX, threads, report: &|_| Ok(()) }
    }
}

/// Returns the Delaunay triangulation of `vertices`, given `near`, which is nearly one.
///
/// # Errors
///
/// What the report of `terms` returns, [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub fn splay(vertices: &PredicateContext3<'_>, near: NearDelaunay3, terms: Terms<'_>) -> Result<SplayOutcome, Error> {
    let mut kept = KeptRegion::default();
    let outcome = splay_again(vertices, near, terms, &mut kept);
    parallel::dispose(kept);
    outcome
}

/// Splays as [`splay`] does, with the memory of stars that `kept` has from the run before, and keeps it there.
///
/// # Errors
///
/// Those of [`splay`].
pub fn splay_again(
    vertices: &PredicateContext3<'_>,
    near: NearDelaunay3,
    terms: Terms<'_>,
    kept: &mut KeptRegion,
) -> Result<SplayOutcome, Error> {
    let NearDelaunay3 { triangulation, vertex_simplex, failed, uncertain, missing } = near;
    let missing = missing.into_iter().map(|v| [v, NONE]).collect();
    let region = Region::whole(kept.take(), triangulation, vertex_simplex);
    let splayed = || -> Result<_, Stop> {
        let mut splay = Splay::begin(vertices, region, Doubts { failed, uncertain, missing }, terms)?;
        // Nothing is lacking of what is there as a whole.
        splay.advance(vertices, terms)?;
        Ok(splay.finish())
    };
    match splayed() {
        Ok((mut region, stats)) => {
            let triangulation = region.take_mesh();
            kept.keep(region);
            Ok(SplayOutcome::Delaunay(Box::new(triangulation), stats))
        }
        Err(Stop::Aborted(reason)) => Ok(SplayOutcome::Aborted(reason)),
        Err(Stop::Error(error)) => Err(error),
    }
}

/// Splaying of a region, which goes on as far as the region has the stars that it needs.
///
/// The vertices and the terms are the same in all calls.
pub struct Splay {
    stars: Splaying,
    /// Four vertices that are not coplanar.
    spanning: [u32; 4],
    /// Whether the triangulation is Delaunay, except that it lacks points.
    is_delaunay: bool,
    /// The unused slots.
    free: Vec<u32>,
    missing: Vec<[u32; 2]>,
    /// The predicate evaluations of the calls before.
    evaluations: u64,
}

impl Splay {
    /// Begins to make the triangulation of `vertices` that `region` is a part of Delaunay, given
    /// where it may not be.
    ///
    /// # Errors
    ///
    /// Returns why splaying ends early.
    pub fn begin(
        vertices: &PredicateContext3<'_>,
        mut region: Region,
        doubts: Doubts,
        terms: Terms<'_>,
    ) -> Result<Self, Stop> {
        let threads = terms.threads;
        let Doubts { mut failed, uncertain, missing } = doubts;
        let is_delaunay = failed.is_empty() && uncertain.is_empty();
        let infinite = region.mesh.infinite;
        let spanning = if is_delaunay { Some([0; 4]) } else { spanning_tetrahedron(&region.mesh, vertices) };
        let spanning = spanning.ok_or(Aborted::Inconsistent("all tetrahedra are flat"))?;
        let predicates = StarPredicates::new(vertices, infinite, spanning);
        let mut free = Vec::new();

        let mesh = &region.mesh;
        let mut flat = predicates
            .shared(threads, uncertain.len(), TETRAHEDRON_GRAIN, |predicates, range| {
                let is_flat = |&t: &u32| !mesh.is_ghost(t) && predicates.orient(mesh.vertices(t)) == 0;
                uncertain[range].iter().copied().filter(is_flat).collect::<Vec<_>>()
            })
            .concat();
        let found = flat.len();
        let Region { mesh, vertex_simplex, .. } = &mut region;
        let mut suspect = peel::peel(mesh, &predicates, threads, &mut flat, vertex_simplex, &mut free)?;
        let peeled = found - flat.len();

        suspect.extend(uncertain);
        parallel::sort(threads, &mut suspect);
        suspect.dedup();
        let mesh = &region.mesh;
        let mut inverted = Vec::new();
        for (more_failed, more_inverted) in
            predicates.shared(threads, suspect.len(), TETRAHEDRON_GRAIN, |predicates, range| {
                let (mut failed, mut inverted) = (Vec::new(), Vec::new());
                for &t in suspect[range].iter().filter(|&&t| mesh.state(t) != state::FREE) {
                    if add_failed(mesh, predicates, t, &mut failed) {
                        inverted.push(t);
                    }
                }
                (failed, inverted)
            })
        {
            failed.extend(more_failed);
            inverted.extend(more_inverted);
        }
        failed.retain(|&v| v != infinite);
        failed.sort_unstable();
        failed.dedup();
        // Stars that are near each other have tetrahedra and points in common.
        let places = failed.iter().map(|&v| region.vertex_simplex[v as usize]).collect();
        parallel::sort_by_keys(threads, &mut failed, places);
        let mut has_failed = IndexSet::new(infinite as usize);
        failed.iter().for_each(|&v| has_failed.insert(v));

        let mut inverted_at = IndexSet::new(infinite as usize);
        let corners = inverted.iter().flat_map(|&t| region.mesh.vertices(t));
        corners.filter(|&v| v != infinite).for_each(|v| inverted_at.insert(v));
        let stars = Splaying::new(Known { region, failed: has_failed, inverted, inverted_at }, threads);
        let mut splay = Splay { stars, spanning, is_delaunay, free, missing, evaluations: 0 };
        let limited = limited(&predicates, 0, terms);
        splay.stars.begin(&predicates, &failed, &limited)?;
        splay.evaluations = predicates.evaluations();
        let stats = &mut splay.stars.stats;
        (stats.peeled, stats.failed, stats.inserted) = (peeled, failed.len(), splay.missing.len());
        Ok(splay)
    }

    /// Goes on. Returns the vertices of which the region lacks the stars; none at the end.
    ///
    /// # Errors
    ///
    /// Returns why splaying ends early.
    pub fn advance(&mut self, vertices: &PredicateContext3<'_>, terms: Terms<'_>) -> Result<Vec<u32>, Stop> {
        if !self.is_delaunay {
            let predicates = StarPredicates::new(vertices, self.region().mesh.infinite, self.spanning);
            let lacking = self.stars.settle(&predicates, &limited(&predicates, self.evaluations, terms))?;
            if lacking.is_empty() {
                let (remove, add) = self.stars.difference()?;
                let Known { region, .. } = &mut self.stars.known;
                let mesh = &mut region.mesh;
                let filled = patch::patch(mesh, &predicates, terms.threads, &remove, &add, &mut self.free)?;
                if !self.missing.is_empty() {
                    region.note(filled);
                }
                (self.stars.stats.removed, self.stars.stats.added) = (remove.len(), add.len());
                self.is_delaunay = true;
            }
            self.evaluations += predicates.evaluations();
            if !lacking.is_empty() {
                return Ok(lacking);
            }
        }
        insert::insert(&mut self.stars.known.region, vertices, &mut self.missing, terms.report)
    }

    /// Returns the region.
    pub fn region(&mut self) -> &mut Region {
        &mut self.stars.known.region
    }

    /// Adds the stars of `vertices`, as [`Region::add`] does.
    ///
    /// # Errors
    ///
    /// Those of [`Region::add`].
    pub fn add(&mut self, vertices: Vec<u32>, gathered: Gathered) -> Result<(), Stop> {
        Ok(self.stars.known.region.add(vertices, gathered, self.stars.threads)?)
    }

    /// Returns the region, of the Delaunay triangulation when nothing is lacking any more, and what
    /// splaying did.
    pub fn finish(self) -> (Region, SplayStats) {
        let (region, mut stats) = self.stars.finish();
        stats.signs = self.evaluations;
        [stats.gathers, stats.gathered] = region.gathers;
        (region, stats)
    }
}

/// Returns a report that ends the work beyond the number of predicate evaluations that `terms`
/// allow, of which there were so many before.
fn limited<'a>(
    predicates: &'a StarPredicates<'_>,
    before: u64,
    terms: Terms<'a>,
) -> impl Fn(f64) -> Result<(), Stop> + 'a {
    move |share| {
        (terms.report)(share)?;
        let is_exceeded = before + predicates.evaluations() > terms.max_evaluations;
        if is_exceeded { Err(Aborted::BudgetExceeded.into()) } else { Ok(()) }
    }
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
