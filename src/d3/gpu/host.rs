//! What the engine of 3D asks of the host: star splaying, and the proof of a hull.

use crate::d3::{
    gpu::finish::NearMesh,
    splay::{NearDelaunay3, SplayOutcome},
    triangulation::FiniteMesh,
};
use crate::{
    d3::{
        gpu::trace::facets_not_delaunay,
        hull::encloses_once,
        splay::{self, Aborted, Doubts, Gathered, IndexSet, KeptRegion, Patch, Region, SLOT, Splay, Stop, Terms},
        triangulation::Triangulation3,
    },
    dimension::Dimension,
    error::Error,
    gpu::{
        host::{Answer, Fit, MakeStart, Merged, Report, Request, Side, Work, answer_words},
        mesh_check::Samples,
        message::{Message, Packer, Unpacker, message},
    },
    index::NONE,
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    stats::{ExactCounts, Phase, SplayStats},
};
use std::fmt;

/// Splaying, and the memory that it uses again.
#[derive(Default)]
pub struct Work3 {
    kept: KeptRegion,
    /// Prepared for the run: a region without stars, and the field `duplicate_of` without duplicates.
    region: Option<Region>,
    duplicate_of: Vec<u32>,
    /// What splaying has come to, if it lacks stars, and which.
    lacking: Option<(Splay, Vec<u32>)>,
    /// The slots of the mesh.
    slots: usize,
}

impl fmt::Debug for Work3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Work3").field("slots", &self.slots).finish_non_exhaustive()
    }
}

impl Work3 {
    /// Returns memory for what is gathered next.
    pub(super) fn spare(&mut self) -> Gathered {
        match &mut self.lacking {
            Some((splay, _)) => splay.region().spare(),
            None => self.region.as_mut().map_or_else(Gathered::default, Region::spare),
        }
    }

    /// Returns how the mesh of the points changes, or which stars are lacking.
    fn advance(
        &mut self,
        mut splay: Splay,
        vertices: &PredicateContext<'_, 3>,
        terms: Terms<'_>,
    ) -> Result<Step, Stop> {
        let vertices_lacking = splay.advance(vertices, terms)?;
        if vertices_lacking.is_empty() {
            let patch = splay.region().patch(self.slots, terms.threads);
            let (region, stats) = splay.finish();
            self.kept.keep(region);
            return Ok(Step::Splayed(patch, stats));
        }
        let next = splay.region().next();
        self.lacking = Some((splay, vertices_lacking.clone()));
        Ok(Step::Lacking { vertices: vertices_lacking, next })
    }
}

impl Work<3> for Dimension<3> {
    type Work = Work3;

    fn prepare(work: &mut Work3, points: usize) {
        work.duplicate_of = parallel::filled(Threads::All, points, NONE);
        work.region = Some(Region::again(work.kept.take(), points, Threads::All));
        work.lacking = None;
    }
}

impl Answer<3> for Dimension<3> {
    fn answer(side: &mut Side<'_, 3>, kind: u32, request: Vec<Vec<u32>>) -> Option<Vec<Vec<u32>>> {
        match kind {
            <Fit as Request<3>>::KIND => answer_words::<Fit, 3>(side, request),
            <MakeStart as Request<3>>::KIND => answer_words::<MakeStart, 3>(side, request),
            Begin::KIND => answer_words::<Begin, 3>(side, request),
            Stars::KIND => answer_words::<Stars, 3>(side, request),
            Encloses::KIND => answer_words::<Encloses, 3>(side, request),
            Facets::KIND => answer_words::<Facets, 3>(side, request),
            Whole::KIND => answer_words::<Whole, 3>(side, request),
            <Samples as Request<3>>::KIND => answer_words::<Samples, 3>(side, request),
            _ => None,
        }
    }

    fn is_delaunay(vertices: &PredicateContext<'_, 3>, corners: &[u32], apexes: &[u32]) -> bool {
        let &[a, b, c, d] = corners else { return false };
        let is_outside = |&apex: &u32| apex == NONE || vertices.insphere([a, b, c, d], apex) < 0;
        vertices.orient3d(a, b, c, d) > 0 && apexes.iter().all(is_outside)
    }
}

/// Returns the result of a step, and what ends it in place of an answer.
fn outcome<T>(step: Result<T, Stop>) -> Result<Result<T, Aborted>, Error> {
    match step {
        Ok(step) => Ok(Ok(step)),
        Err(Stop::Aborted(reason)) => Ok(Err(reason)),
        Err(Stop::Error(error)) => Err(error),
    }
}

/// How far splaying has come.
#[derive(Debug)]
pub(super) enum Step {
    /// The stars of these vertices are lacking; their tetrahedra get numbers from this one on.
    Lacking { vertices: Vec<u32>, next: u32 },
    /// The change of the mesh, and what was done for it.
    Splayed(Patch, SplayStats),
}

impl Message for Step {
    fn write(self, to: &mut Packer) {
        let (lacking, splayed) = match self {
            Step::Lacking { vertices, next } => (Some((vertices, next)), None),
            Step::Splayed(patch, stats) => (None, Some((patch, stats))),
        };
        lacking.is_some().write(to);
        if let Some((vertices, next)) = lacking {
            vertices.write(to);
            next.write(to);
        }
        if let Some((patch, stats)) = splayed {
            patch.write(to);
            stats.write(to);
        }
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        Some(if bool::read(from)? {
            Step::Lacking { vertices: Message::read(from)?, next: Message::read(from)? }
        } else {
            Step::Splayed(Message::read(from)?, Message::read(from)?)
        })
    }
}

message!(Gathered { tetrahedra, neighbors, slots });
message!(Patch { slots, tetrahedra, neighbors, len, more });

/// The text of what is inconsistent stays where it was found.
impl Message for Aborted {
    fn write(self, to: &mut Packer) {
        (self == Aborted::BudgetExceeded).write(to);
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        let is_exceeded = bool::read(from)?;
        Some(if is_exceeded {
            Aborted::BudgetExceeded
        } else {
            Aborted::Inconsistent("the stars do not fit each other")
        })
    }
}

/// Asks for splaying, with what the device has gathered for it.
#[derive(Debug)]
pub(super) struct Begin {
    /// The stars of the failed vertices and of the corners of uncertain tetrahedra.
    pub(super) gathered: Gathered,
    /// The failed vertices, ascending.
    pub(super) failed: Vec<u32>,
    /// The slots of the uncertain tetrahedra, ascending.
    pub(super) uncertain: Vec<u32>,
    pub(super) merged: Merged,
    /// The slots of the mesh.
    pub(super) slots: usize,
}
message!(Begin { gathered, failed, uncertain, merged, slots });

/// The first step of splaying.
#[derive(Debug)]
pub(super) struct Begun {
    pub(super) step: Result<Step, Aborted>,
    /// How many points the mesh lacked.
    pub(super) missing: usize,
    pub(super) duplicate_of: Vec<u32>,
    pub(super) exact: ExactCounts,
}
message!(Begun { step, missing, duplicate_of, exact });

impl Request<3> for Begin {
    type Answer = Begun;

    const KIND: u32 = 2;
    const PHASE: Phase = Phase::Splay;

    fn answer(self, side: &mut Side<'_, 3>, report: Report<'_>) -> Result<Begun, Error> {
        let Begin { gathered, failed, uncertain, merged, slots } = self;
        let (points, _, lattice, work) = side.parts();
        let (missing, duplicate_of) = merged.missing(points, std::mem::take(&mut work.duplicate_of));
        let missing_count = missing.len();
        let region = work.region.take();
        let region = region.unwrap_or_else(|| Region::again(work.kept.take(), points.len(), Threads::All));
        work.slots = slots;
        let vertices = PredicateContext::of_input(points, lattice);
        let terms = terms(slots, report);
        let first = || {
            let (region, doubts) = begin(region, gathered, failed, uncertain)?;
            let splay = Splay::begin(&vertices, region, Doubts { missing, ..doubts }, terms)?;
            work.advance(splay, &vertices, terms)
        };
        let step = outcome(first())?;
        Ok(Begun { step, missing: missing_count, duplicate_of, exact: vertices.exact_counts() })
    }
}

/// Returns the terms on which a mesh of so many slots is splayed.
fn terms(slots: usize, report: Report<'_>) -> Terms<'_> {
    Terms { max_evaluations: splay::evaluations_from_scratch(slots), threads: Threads::All, report }
}

/// Adds what was gathered to a region, which has nothing yet. Returns it with the doubts by its numbers.
fn begin(
    mut region: Region,
    gathered: Gathered,
    failed: Vec<u32>,
    uncertain: Vec<u32>,
) -> Result<(Region, Doubts), Aborted> {
    let infinite = region.infinite();
    let first = region.next();
    let mut numbers = vec![NONE; uncertain.len()];
    // Most tetrahedra are certain, which a bit tells sooner than a search.
    let mut is_uncertain = IndexSet::new(uncertain.last().map_or(0, |&t| t as usize + 1));
    uncertain.iter().for_each(|&t| is_uncertain.insert(t));
    for (number, word) in (first..).zip(&gathered.slots).filter(|(_, word)| is_uncertain.has(**word & SLOT)) {
        if let Ok(i) = uncertain.binary_search(&(word & SLOT)) {
            numbers[i] = number;
        }
    }
    if numbers.contains(&NONE) {
        return Err(Aborted::Inconsistent("an uncertain tetrahedron was not gathered"));
    }
    let uncertain = numbers;
    let corners = uncertain.iter().flat_map(|&t| gathered.tetrahedra[(t - first) as usize]);
    let stars: Vec<u32> = corners.filter(|&v| v != infinite).chain(failed.iter().copied()).collect();
    region.add(stars, gathered, Threads::All)?;
    Ok((region, Doubts { failed, uncertain, missing: Vec::new() }))
}

/// Asks for the next step of splaying, with the stars that were lacking.
#[derive(Debug)]
pub(super) struct Stars(pub(super) Gathered);

impl Message for Stars {
    fn write(self, to: &mut Packer) {
        self.0.write(to);
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        Some(Stars(Message::read(from)?))
    }
}

/// A further step of splaying.
#[derive(Debug)]
pub(super) struct Advanced {
    pub(super) step: Result<Step, Aborted>,
    pub(super) exact: ExactCounts,
}
message!(Advanced { step, exact });

impl Request<3> for Stars {
    type Answer = Advanced;

    const KIND: u32 = 3;
    const PHASE: Phase = Phase::Splay;

    fn answer(self, side: &mut Side<'_, 3>, report: Report<'_>) -> Result<Advanced, Error> {
        let (points, _, lattice, work) = side.parts();
        let vertices = PredicateContext::of_input(points, lattice);
        let terms = terms(work.slots, report);
        let next = || {
            let (mut splay, lacking) = work.lacking.take().ok_or(Aborted::Inconsistent("no stars were lacking"))?;
            splay.add(lacking, self.0)?;
            work.advance(splay, &vertices, terms)
        };
        let step = outcome(next())?;
        Ok(Advanced { step, exact: vertices.exact_counts() })
    }
}

/// Asks whether a hull is convex and encloses its inside once.
#[derive(Debug)]
pub(super) struct Encloses {
    pub(super) hull: Vec<[u32; 3]>,
    /// The vertices of a tetrahedron that is positively oriented.
    pub(super) spanning: [u32; 4],
}
message!(Encloses { hull, spanning });

impl Request<3> for Encloses {
    type Answer = bool;

    const KIND: u32 = 4;

    fn answer(self, side: &mut Side<'_, 3>, _report: Report<'_>) -> Result<bool, Error> {
        let (points, _, lattice, _) = side.parts();
        Ok(encloses_once(points, lattice, &self.hull, self.spanning))
    }
}

/// Asks for the facets between finite tetrahedra that are not locally Delaunay, for a trace.
#[derive(Debug)]
pub(super) struct Facets {
    pub(super) tetrahedra: Vec<[u32; 4]>,
    pub(super) neighbors: Vec<[u32; 4]>,
}
message!(Facets { tetrahedra, neighbors });

impl Request<3> for Facets {
    type Answer = Vec<[u32; 3]>;

    const KIND: u32 = 5;

    fn answer(self, side: &mut Side<'_, 3>, _report: Report<'_>) -> Result<Vec<[u32; 3]>, Error> {
        let (points, _, lattice, _) = side.parts();
        let mesh = Triangulation3::new(self.tetrahedra, self.neighbors, points.len() as u32);
        Ok(facets_not_delaunay(&mesh, &PredicateContext::of_input(points, lattice)))
    }
}

/// Asks for the mesh of what the device has, all of which was read.
#[derive(Debug)]
pub(super) struct Whole {
    pub(super) near: NearMesh,
    pub(super) merged: Merged,
}

/// The mesh.
#[derive(Debug)]
pub(super) struct WholeSplayed {
    pub(super) tetrahedra: Vec<[u32; 4]>,
    pub(super) neighbors: Vec<[u32; 4]>,
    pub(super) hull: Vec<[u32; 3]>,
    pub(super) duplicate_of: Vec<u32>,
    pub(super) missing: usize,
    pub(super) stats: SplayStats,
    pub(super) exact: ExactCounts,
}

message!(NearMesh { tets, neighbors, finite, failed, vertex_simplex, uncertain });
message!(Whole { near, merged });
message!(WholeSplayed { tetrahedra, neighbors, hull, duplicate_of, missing, stats, exact });

impl Request<3> for Whole {
    type Answer = Result<WholeSplayed, Aborted>;

    const KIND: u32 = 6;
    const PHASE: Phase = Phase::Splay;

    fn answer(self, side: &mut Side<'_, 3>, report: Report<'_>) -> Result<Self::Answer, Error> {
        let NearMesh { tets, neighbors, failed, mut vertex_simplex, uncertain, .. } = self.near;
        let (points, _, lattice, work) = side.parts();
        let (missing, duplicate_of) = self.merged.missing(points, std::mem::take(&mut work.duplicate_of));
        vertex_simplex.truncate(points.len());
        let near = NearDelaunay3 {
            triangulation: Triangulation3::new(tets, neighbors, points.len() as u32),
            vertex_simplex,
            failed,
            uncertain: uncertain.into_iter().map(|[t, _]| t).collect(),
            missing: missing.iter().map(|&[i, _]| i).collect(),
        };
        let vertices = PredicateContext::of_input(points, lattice);
        let terms = terms(near.triangulation.tetrahedra().len(), report);
        Ok(match splay::splay_again(&vertices, near, terms, &mut work.kept)? {
            SplayOutcome::Aborted(reason) => Err(reason),
            SplayOutcome::Delaunay(triangulation, stats) => {
                let FiniteMesh { tetrahedra, neighbors, hull } = triangulation.into_mesh(None, Threads::All);
                let exact = vertices.exact_counts();
                Ok(WholeSplayed { tetrahedra, neighbors, hull, duplicate_of, missing: missing.len(), stats, exact })
            }
        })
    }
}
