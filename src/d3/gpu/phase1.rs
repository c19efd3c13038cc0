//! Phase 1: parallel insertion and flipping (§3.1), from lattice points to a nearly Delaunay triangulation.
//!
//! 1. *Points*: lattice, points at the same place, order along the Hilbert curve ([`points`](crate::gpu::points)).
//! 2. *Rounds*, until no point waits: every tetrahedron with waiting points picks one and is split; flip iterations
//!    until (nearly) none is active; the waiting points follow the history of the flips.
//! 3. *Last flips*, until no tetrahedron is active.
//! 4. *Finish*: failed vertices, the mesh without gaps, what rounding leaves open, and the one large readback.
//!
//! What it costs, for *n* points in *r* rounds of *k* flip iterations (uniform, 1 M: r = 11, k ≈ 20, of which a fifth too
//! many are recorded): dispatches, 15 for the points, 5 + 3¼·k a round, 8 to finish, about 1,400 in all; a flip iteration
//! visits its active tetrahedra (42·n in all, 14·n flips) at 4 to 10 sectors of 32 bytes each, so 10 to 15 GB of traffic for
//! 1 M points, most of it in the cache. Readbacks: one of a hundred bytes a round, one or two for the last flips, 8 to finish.
//!
//! Flip iterations are recorded ahead, some more than the last round took: those that find nothing to do cost microseconds, and
//! what they leave undone is taken up in the next round. No flip is lost for want of room: when the slots or the history run
//! out, flips wait in the active list until there is more.

use super::{memory, run::Run, vertex};
use crate::d3::gpu::start::Start;
use crate::gpu::layout::{Counters, Pick};
use crate::gpu::{Gpu, Kernel, Profiler, Readback, shader};
use crate::{
    Error, Points,
    input::lattice::{Lattice, Width},
    stats::{GpuStats, Round},
};
use crate::{
    d3::gpu::{finish::Finish, flip::Flip, insert::Insert, relocate::Relocate},
    gpu::points::PointStage,
};

/// How Phase 1 works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// How points are picked.
    pub pick: Pick,
    /// Insert all points before flipping (§5.3).
    pub insert_all: bool,
    /// With fewer active tetrahedra than this, and than one for 1,024 points that are inserted, flipping waits for the
    /// next round; except at the end.
    pub min_active: u32,
    /// Workgroups of a dispatch, at most. Kernels stride over what there is to do.
    pub workgroups: u32,
    /// There is a block in the tail for so many points, at the start and again whenever slots run out.
    pub points_per_tail_block: u32,
    /// Nodes of the history, for every point, if the device can bind so many. Uniform points take 3.1 in the round that
    /// takes most; flips for which there is no room wait for the next round.
    pub history: u32,
    /// After a flip iteration with an active tetrahedron for so many slots, or more of them, the next ones are found by looking
    /// at all slots; otherwise the flips list them (§4.2). With 0, they always do.
    pub slots_per_active: u32,
    /// Flip iterations of a run, past which the engine `gpu` leaves it to the CPU engine. Most inputs take some hundred, a million
    /// points or not. More are a sign that the flips wait for each other; then the CPU engine is sooner done.
    pub max_iterations: u32,
    /// Whether points are ordered along the Hilbert curve, and so are the blocks of their tetrahedra in memory (§4.3).
    pub sort: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            pick: Pick::Circumcenter,
            insert_all: false,
            min_active: 1024,
            workgroups: 1024,
            points_per_tail_block: 16,
            history: 4,
            slots_per_active: 0,
            max_iterations: 1 << 14,
            sort: true,
        }
    }
}

/// The points of a run.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a> {
    /// The points, in input order.
    pub points: Points<'a>,
    /// The lattice that is fitted to them.
    pub lattice: &'a Lattice,
    /// The first tetrahedron, by input indices.
    pub start: Start,
}

/// What a run did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Phase1Stats {
    /// The insertion rounds, the first with the ordering of the points; then the rounds of the last flips.
    pub rounds: Vec<Round>,
    /// The kernels' counters.
    pub counters: Counters,
    /// Dispatches.
    pub dispatches: usize,
    /// Submissions.
    pub submits: usize,
    /// Readbacks.
    pub readbacks: usize,
    /// The most bytes of GPU memory that were held at a time.
    pub bytes: u64,
    /// Milliseconds from the upload to the end of the last kernel, on the host's clock; 0 where there is none.
    pub milliseconds: f64,
    /// Milliseconds of the readback of the result, on the host's clock.
    pub readback_milliseconds: f64,
}

impl Phase1Stats {
    /// The same for users, on an adapter of this name.
    pub fn summary(&self, adapter: &str) -> GpuStats {
        let Counters { flips_23, flips_32, iterations, exact, not_locally_delaunay, failed, merged, .. } =
            self.counters;
        GpuStats {
            adapter: adapter.to_owned(),
            rounds: self.rounds.clone(),
            flips_23: flips_23.into(),
            flips_32: flips_32.into(),
            flips_22: 0,
            flip_iterations: iterations.into(),
            exact_tests: exact.into(),
            not_locally_delaunay: not_locally_delaunay.into(),
            failed_vertices: failed.into(),
            merged: merged.into(),
            readbacks: self.readbacks as u64,
            dispatches: self.dispatches as u64,
            submits: self.submits as u64,
            bytes: self.bytes,
        }
    }
}

/// A triangulation whose only facets that are not locally Delaunay cannot be flipped.
///
/// PredicateContext are places in the input. All tetrahedra are positively oriented in the sense of the perturbed predicates: there
/// can be flat ones.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Phase1Output {
    /// Four vertices a tetrahedron, the finite ones first. The infinite ones have the vertex at infinity, the number of
    /// points, last.
    pub tets: Vec<[u32; 4]>,
    /// Entry *k* is 4·tetrahedron + face across the facet opposite vertex *k*.
    pub neighbors: Vec<[u32; 4]>,
    /// The number of finite tetrahedra.
    pub finite: usize,
    /// The vertices with a facet that is not locally Delaunay, ascending.
    pub failed: Vec<u32>,
    /// One tetrahedron of each vertex, infinity last; [`NONE`](crate::gpu::layout::NONE) for those that others stand for.
    pub tet_of: Vec<u32>,
    /// Points that are vertices of no tetrahedron, with that of the point at the same place of the lattice: exact
    /// duplicates, and points that were rounded to the same place, which Phase 2 has to insert.
    pub merged: Vec<[u32; 2]>,
    /// Tetrahedra, ascending, that are flat (bit 4); and where coordinates were rounded to the lattice, those of which it
    /// does not prove everything: whether facet *k* is locally Delaunay (bit *k*), or the orientation (bit 4). Each facet
    /// is listed with one of its tetrahedra.
    pub uncertain: Vec<[u32; 2]>,
    /// What the run did.
    pub stats: Phase1Stats,
}

/// The kernels of Phase 1, for points of one width, and the buffers of the last run, which serve the next one if that has
/// as many points of the same precision.
#[derive(Debug)]
pub struct Phase1 {
    pub(crate) points: PointStage,
    pub(crate) insert: Insert,
    pub(crate) flip: Flip,
    pub(crate) relocate: Relocate,
    pub(crate) finish: Finish,
    pub(crate) fill_free: Kernel,
    pub(crate) readback: Readback,
    pub(crate) kept: memory::Kept,
}

impl Phase1 {
    /// Compiles the kernels.
    ///
    /// # Errors
    ///
    /// As [`Gpu::with_error_scope`].
    pub async fn new(gpu: &Gpu, width: Width) -> Result<Self, Error> {
        gpu.with_error_scope("pipelines", || {
            Ok(Phase1 {
                points: PointStage::new(gpu, &shader::D3, vertex::words_per_vertex),
                insert: Insert::new(gpu, width),
                flip: Flip::new(gpu, width),
                relocate: Relocate::new(gpu, width),
                finish: Finish::new(gpu, width),
                fill_free: Kernel::new(gpu, shader::D3.get("fill_free"), width),
                readback: Readback::default(),
                kept: memory::Kept::default(),
            })
        })
        .await
    }

    /// Gives the buffers of the last run back.
    pub fn release(&mut self) {
        self.readback = Readback::default();
        self.kept = memory::Kept::default();
    }

    /// Runs Phase 1.
    ///
    /// # Errors
    ///
    /// As [`Run::new`], [`Run::round`] and [`Run::finish`].
    pub async fn run(
        &mut self,
        gpu: &Gpu,
        input: Input<'_>,
        settings: &Settings,
        profiler: Option<&mut Profiler>,
    ) -> Result<Phase1Output, Error> {
        let mut run = Run::new(self, gpu, input, *settings, profiler).await?;
        while run.round().await? {}
        run.finish().await
    }
}
