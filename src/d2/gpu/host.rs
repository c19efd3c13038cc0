//! What the engine of 2D asks of the host: the tests that rounding leaves open, and flips.

use crate::{
    d2::{
        Triangulation2,
        gpu::{
            certify::{failed_tests, near_delaunay},
            layout::UncertainTest,
        },
        lawson::{self, Aborted, LawsonOutcome, turns_once},
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
    predicates::filter::PredicateContext2,
    stats::{ExactCounts, Phase},
};

/// What is known of a mesh that takes flips.
#[derive(Debug, Default)]
pub struct Work2 {
    /// Prepared for the run: the field `duplicate_of` without duplicates.
    duplicate_of: Vec<u32>,
    /// The points that the mesh lacks, each with the vertex at the same place of the lattice.
    missing: Vec<[u32; 2]>,
    /// The tests with the wrong answer, if these are known.
    failed: Option<Vec<UncertainTest>>,
    hull: Vec<u32>,
}

impl Work<2> for Dimension<2> {
    type Work = Work2;

    fn prepare(work: &mut Work2, points: usize) {
        work.duplicate_of = parallel::filled(Threads::All, points, NONE);
    }
}

impl Answer<2> for Dimension<2> {
    fn answer(side: &mut Side<'_, 2>, kind: u32, request: Vec<Vec<u32>>) -> Option<Vec<Vec<u32>>> {
        match kind {
            <Fit as Request<2>>::KIND => answer_words::<Fit, 2>(side, request),
            <MakeStart as Request<2>>::KIND => answer_words::<MakeStart, 2>(side, request),
            Check::KIND => answer_words::<Check, 2>(side, request),
            Flip::KIND => answer_words::<Flip, 2>(side, request),
            <Samples as Request<2>>::KIND => answer_words::<Samples, 2>(side, request),
            _ => None,
        }
    }

    fn is_delaunay(vertices: &PredicateContext2<'_>, corners: &[u32], apexes: &[u32]) -> bool {
        let &[a, b, c] = corners else { return false };
        let is_outside = |&apex: &u32| apex == NONE || vertices.incircle([a, b, c], apex) < 0;
        vertices.orient2d(a, b, c) > 0 && apexes.iter().all(is_outside)
    }
}

/// Asks whether the device's mesh is that of the true points.
#[derive(Debug)]
pub(super) struct Check {
    /// The half-edges of the hull, in no order.
    pub(super) hull: Vec<[u32; 2]>,
    /// The tests that rounding leaves open; `None` if these are too many.
    pub(super) uncertain: Option<Vec<UncertainTest>>,
    pub(super) merged: Merged,
}
message!(Check { hull, uncertain, merged });

/// What is known of the device's mesh.
#[derive(Debug)]
pub(super) struct Checked {
    /// The vertices of the hull, from the lowest.
    pub(super) hull: Vec<u32>,
    /// Whether the mesh is that of the true points, if its hull turns once. Otherwise it takes [`Flip`].
    pub(super) is_proven: bool,
    /// Whether the hull turns once.
    pub(super) turns_once: bool,
    /// How many points the mesh lacks.
    pub(super) missing: usize,
    pub(super) duplicate_of: Vec<u32>,
    pub(super) exact: ExactCounts,
}
message!(Checked { hull, is_proven, turns_once, missing, duplicate_of, exact });

impl Request<2> for Check {
    type Answer = Checked;

    const KIND: u32 = 2;
    const PHASE: Phase = Phase::Check;

    fn answer(self, side: &mut Side<'_, 2>, _report: Report<'_>) -> Result<Checked, Error> {
        let Check { hull, uncertain, merged } = self;
        let (points, options, lattice, work) = side.parts();
        let (missing, duplicate_of) = merged.missing(points, std::mem::take(&mut work.duplicate_of));
        let mut exact = ExactCounts::default();
        let failed = uncertain.map(|tests| {
            let (failed, counts) = failed_tests(points, lattice, &tests);
            exact = counts;
            failed
        });
        let hull = in_order(&hull, points.len());
        // The triangles of points that have moved may go round more than once.
        let turns_once = turns_once(&PredicateContext2::of_input(points, lattice), &hull, options.winding);
        let is_proven = missing.is_empty() && failed.as_ref().is_some_and(Vec::is_empty);
        let missing_count = missing.len();
        if !is_proven {
            (work.missing, work.failed, work.hull) = (missing, failed, hull.clone());
        }
        Ok(Checked { hull, is_proven, turns_once, missing: missing_count, duplicate_of, exact })
    }
}

/// Asks for the mesh of the true points, given the device's mesh, after [`Check`].
#[derive(Debug)]
pub(super) struct Flip {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) halfedges: Vec<[u32; 3]>,
}
message!(Flip { triangles, halfedges });

/// The mesh of the true points.
#[derive(Debug)]
pub(super) struct Flipped {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) halfedges: Vec<[u32; 3]>,
    pub(super) hull: Vec<u32>,
    /// Whether the hull turns once.
    pub(super) turns_once: bool,
    pub(super) exact: ExactCounts,
}
message!(Flipped { triangles, halfedges, hull, turns_once, exact });

impl Message for Aborted {
    fn write(self, to: &mut Packer) {
        (self == Aborted::BudgetExceeded).write(to);
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        Some(if bool::read(from)? { Aborted::BudgetExceeded } else { Aborted::Folded })
    }
}

/// The flips per point after which the CPU engine finishes sooner: about as many as it takes from
/// nothing.
const FLIPS_PER_POINT: u64 = 3;

impl Request<2> for Flip {
    type Answer = Result<Flipped, Aborted>;

    const KIND: u32 = 3;
    const PHASE: Phase = Phase::Flip;

    fn answer(self, side: &mut Side<'_, 2>, report: Report<'_>) -> Result<Self::Answer, Error> {
        let Flip { triangles, halfedges } = self;
        let (points, options, lattice, work) = side.parts();
        let Work2 { missing, failed, hull, .. } = std::mem::take(work);
        let count = points.len() as u32;
        let vertices = PredicateContext2::of_input(points, lattice);
        let triangulation = Triangulation2::from_mesh(triangles, halfedges, &hull, count, options.winding);
        let near = near_delaunay(triangulation, failed.as_deref(), &missing);
        let triangulation = match lawson::lawson(&vertices, near, FLIPS_PER_POINT * u64::from(count), report)? {
            LawsonOutcome::Delaunay(triangulation, _) => triangulation,
            LawsonOutcome::Aborted(reason) => return Ok(Err(reason)),
        };
        let exact = vertices.exact_counts();
        let indices: Vec<u32> = (0..count).collect();
        let (triangles, halfedges, hull) = triangulation.into_mesh(&indices, options.winding, Threads::All);
        let turns_once = turns_once(&PredicateContext2::of_input(points, lattice), &hull, options.winding);
        Ok(Ok(Flipped { triangles, halfedges, hull, turns_once, exact }))
    }
}

/// Returns the vertices of the hull, from the lowest index, by its edges.
fn in_order(edges: &[[u32; 2]], points: usize) -> Vec<u32> {
    let mut next = vec![NONE; points];
    for &[from, to] in edges {
        next[from as usize] = to;
    }
    let lowest = edges.iter().map(|&[from, _]| from).min();
    std::iter::successors(lowest, |&v| next.get(v as usize).copied().filter(|&v| v != NONE)).take(edges.len()).collect()
}
