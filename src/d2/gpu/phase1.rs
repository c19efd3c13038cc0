//! The Delaunay triangulation of the plane on the GPU: Phase 1 with triangles and edge flips (§5.6).
//!
//! 1. *Points*: lattice, points at the same place, order along the Hilbert curve ([`points`](crate::gpu::points)).
//! 2. *Rounds*, until no point waits: every triangle with waiting points picks one and is split 1-to-3; flip iterations
//!    until (nearly) none is active; the waiting points follow the history of the flips.
//! 3. *Last flips*, until no triangle is active. Flipping never gets stuck in the plane, so the result is the Delaunay
//!    triangulation of the lattice's points, with its coordinates perturbed.
//! 4. *Answer*: flat triangles and infinite ones left out, in input indices. Where coordinates were rounded, also the signs
//!    that the lattice leaves open, as questions to the CPU.
//!
//! Dispatches, for *r* rounds of *k* flip iterations: 15 for the points, 5 + 3·k a round, 5 for the answer. Readbacks: one
//! of the counters a round, 6 for the answer.
//!
//! What [`phase1`](crate::d3::gpu::phase1) says of recording iterations ahead and of running out of history holds here too. Slots
//! never run out.

use super::{
    kernels::Kernels,
    layout::UncertainTest,
    run::{self, Run},
    start::Start,
    vertex,
};
use crate::gpu::{
    Gpu, Profiler, Readback,
    layout::{Counters, Pick},
    points::PointStage,
    shader,
};
use crate::{
    Error,
    input::{
        lattice::{Lattice, Width},
        points::Points2,
    },
    stats::{GpuStats, Round},
};

/// How a run works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// How points are picked: here "circumcentre" is that of a triangle's circle.
    pub pick: Pick,
    /// Insert all points before flipping (`InsAll` in the paper's Figure 12).
    pub insert_all: bool,
    /// Sort the points along the Hilbert curve, and with them the triangles (Figure 12).
    pub sort: bool,
    /// With fewer active triangles than this, and than one for 1,024 points that are inserted, flipping waits for the next
    /// round; except at the end.
    pub min_active: u32,
    /// Workgroups of a dispatch, at most. Kernels stride over what there is to do.
    pub workgroups: u32,
    /// Nodes of the history, for every point, if the device can bind so many; flips for which there is no room wait for
    /// the next round.
    pub history: u32,
    /// Flip iterations of a run, past which the engine `gpu` leaves it to the CPU engine. Most inputs take some hundred, a million
    /// points or not. More are a sign that the flips wait for each other, as where a fan of flat triangles is turned over; then the
    /// CPU engine is sooner done.
    pub max_iterations: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            pick: Pick::Circumcenter,
            insert_all: false,
            sort: true,
            min_active: 1024,
            workgroups: 1024,
            history: 2,
            max_iterations: 1 << 12,
        }
    }
}

/// The points of a run.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a> {
    /// The points, in input order.
    pub points: Points2<'a>,
    /// The lattice that is fitted to them.
    pub lattice: &'a Lattice<2>,
    /// The first triangle, by input indices.
    pub start: Start,
}

/// What a run did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlaneStats {
    /// The insertion rounds, then the rounds in which the last flips were done.
    pub rounds: Vec<Round>,
    /// The kernels' counters.
    pub counters: Counters,
    /// Dispatches.
    pub dispatches: usize,
    /// Submissions.
    pub submits: usize,
    /// Readbacks.
    pub readbacks: usize,
    /// The bytes of GPU memory that were held.
    pub bytes: u64,
    /// Milliseconds from the upload to the end of the last kernel, on the host's clock; 0 where there is none.
    pub milliseconds: f64,
    /// Milliseconds of the readback of the result, on the host's clock.
    pub readback_milliseconds: f64,
}

impl PlaneStats {
    /// The same for users, on an adapter of this name.
    pub fn summary(&self, adapter: &str) -> GpuStats {
        let Counters { flips_22, iterations, exact, merged, .. } = self.counters;
        GpuStats {
            adapter: adapter.to_owned(),
            rounds: self.rounds.clone(),
            flips_22: flips_22.into(),
            flip_iterations: iterations.into(),
            exact_tests: exact.into(),
            merged: merged.into(),
            readbacks: self.readbacks as u64,
            dispatches: self.dispatches as u64,
            submits: self.submits as u64,
            bytes: self.bytes,
            ..GpuStats::default()
        }
    }
}

/// Triangles in input indices and as [`Mesh2`](crate::d2::Mesh2) has it, but for the hull.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mesh {
    /// Three vertices a triangle, clockwise with the *y* axis up, none flat.
    pub triangles: Vec<[u32; 3]>,
    /// Entry *k* is the half-edge that runs against the one from vertex *k* to the next, 3·(triangle) + (vertex); -1 on the
    /// hull.
    pub halfedges: Vec<[i32; 3]>,
    /// The half-edges of the hull, from where to where, in no order.
    pub hull: Vec<[u32; 2]>,
}

/// What a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneOutput {
    /// The Delaunay triangulation of the lattice's points; that of the true points, if all `questions` have the right
    /// answer.
    pub mesh: Mesh,
    /// What the lattice does not prove of it, because coordinates were rounded; `None` if that is more than the device has
    /// room for.
    pub questions: Option<Vec<UncertainTest>>,
    /// Points that are vertices of no triangle, with that of the point at the same place of the lattice: exact duplicates,
    /// and points that were rounded to the same place.
    pub merged: Vec<[u32; 2]>,
    /// What the run did.
    pub stats: PlaneStats,
}

/// The kernels of the plane, for points of one width, and the buffers of the last run, which serve the next one if that
/// has as many points of the same precision.
#[derive(Debug)]
pub struct Plane {
    pub(crate) points: PointStage<2>,
    pub(crate) kernels: Kernels,
    pub(crate) readback: Readback,
    pub(crate) kept: run::Kept,
}

impl Plane {
    /// Compiles the kernels.
    ///
    /// # Errors
    ///
    /// As [`Gpu::with_error_scope`].
    pub async fn new(gpu: &Gpu, width: Width) -> Result<Self, Error> {
        gpu.with_error_scope("pipelines", || {
            Ok(Plane {
                points: PointStage::new(gpu, &shader::D2, vertex::words),
                kernels: Kernels::new(gpu, width),
                readback: Readback::default(),
                kept: run::Kept::default(),
            })
        })
        .await
    }

    /// Gives the buffers of the last run back.
    pub fn release(&mut self) {
        self.readback = Readback::default();
        self.kept = run::Kept::default();
    }

    /// Triangulates.
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
    ) -> Result<PlaneOutput, Error> {
        let mut run = Run::new(self, gpu, input, *settings, profiler).await?;
        while run.round().await? {}
        run.finish().await
    }
}
