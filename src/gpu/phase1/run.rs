//! A run of Phase 1: submits batches of rounds as its plan says, and reads what they did.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Pending, Profiler, Recorder, Rooms,
        device::ErrorScope,
        dim::Corners,
        layout::{Counters, Params},
        phase1::{
            buffers::Buffers,
            finish::Finish,
            iterations::Needed,
            kernels::Phase1,
            plan::{Plan, first_counters},
            record::{DeviceRun, counters_in},
            settings::Settings,
            stats::Meter,
        },
        start::{StartMesh, StartSimplex},
    },
    platform::gpu::Report,
    stats::Round,
};
use std::collections::VecDeque;

/// A run in progress.
pub struct Phase1Run<'a, const D: usize>
where
    Dimension<D>: Finish<D>,
{
    pub(super) kernels: &'a mut Phase1<D>,
    pub(super) gpu: &'a Gpu,
    pub(super) profiler: Option<&'a mut Profiler>,
    pub(super) device: DeviceRun<D>,
    pub(super) first: StartSimplex<D>,
    pub(super) start: StartMesh,
    pub(super) plan: Plan,
    /// The iterations used by the last run of equal size.
    pub(super) before: Needed,
    /// Batches of rounds whose counters are not read yet, oldest first.
    pub(super) submitted: VecDeque<Submitted>,
    /// Memory for the simplices and their neighbours, if the host is to have them.
    pub(super) rooms: Rooms<Corners<D>>,
    pub(super) meter: Meter,
}

/// A batch that was submitted.
pub(super) struct Submitted {
    /// Awaited with the counters, so that the next batch is submitted meanwhile: in browsers it takes a while.
    report: Report,
    submission: wgpu::SubmissionIndex,
    counters: Pending<u32>,
    /// The dispatches of its rounds.
    dispatches: usize,
}

impl<'a, const D: usize> Phase1Run<'a, D>
where
    Dimension<D>: Finish<D>,
{
    /// Returns the device.
    pub(crate) fn gpu(&self) -> &'a Gpu {
        self.gpu
    }

    /// Returns whether the run goes on from a mesh whose points have moved.
    pub(crate) fn has_moved(&self) -> bool {
        self.plan.has_moved()
    }

    /// Returns the settings.
    pub(crate) fn settings(&self) -> &Settings<D> {
        &self.device.settings
    }

    /// Returns the buffers, for tests.
    pub fn buffers(&self) -> &Buffers<D> {
        &self.device.memory.buffers
    }

    /// Returns the parameters, and the counters as they were last read.
    pub fn control(&self) -> (Params, Counters) {
        (self.device.params, *self.plan.counters())
    }

    /// Returns the number of points that are not inserted yet.
    pub fn waiting(&self) -> u32 {
        self.plan.waiting()
    }

    /// Returns the number of active simplices.
    pub fn active(&self) -> u32 {
        self.plan.counters().active()
    }

    /// Returns the workgroups of a kernel with an invocation per slot.
    pub(crate) fn workgroups(&self) -> u32 {
        self.device.workgroups(self.gpu)
    }

    /// Runs rounds of insertion and flips, and, when all points are inserted, flip iterations,
    /// until it knows of the next batch what was done. Returns whether there is more to do.
    ///
    /// # Errors
    ///
    /// [`Error::BufferTooLarge`] and [`Error::OutOfDeviceMemory`] when there are more tetrahedra
    /// than the device can hold; [`Error::DeviceLost`], [`Error::Gpu`] and [`Error::WrongResults`].
    pub async fn advance(&mut self) -> Result<bool, Error> {
        while !self.plan.is_far_ahead() {
            self.submit().await?;
        }
        let Some(batch) = self.submitted.pop_front() else { return Ok(false) };
        let dispatches = batch.dispatches;
        let read = self.receive(batch).await?;
        let elapsed = self.meter.round_clock.lap();
        self.meter.dispatch_time = elapsed / dispatches.max(1) as u32;
        if read.long_walks > 0 && self.start.points.len() > D + 1 {
            // A point may lie in no simplex of the start, which the host and the device see with
            // different perturbations. It lies in one of those around the first simplex.
            self.plan.set_counters(read);
            self.receive_all().await?;
            self.begin_with(StartMesh::of_first(&self.first));
            return Ok(true);
        }
        let rounds = self.plan.read(read).map_err(|what| self.gpu.wrong(what))?;
        let time = elapsed / rounds.len().max(1) as u32;
        self.meter.stats.rounds.extend(rounds.into_iter().map(|round| Round { time, ..round }));
        let goes_on = self.plan.goes_on();
        // When nothing is left, the device waits for the host anyway, which `end` counts.
        self.meter.stats.stalls += usize::from(goes_on && self.submitted.is_empty());
        Ok(goes_on)
    }

    /// Submits a batch.
    pub(super) async fn submit(&mut self) -> Result<(), Error> {
        let scope = ErrorScope::open(self.gpu, "Phase 1");
        let submitted = self.submit_batch();
        let report = scope.close();
        let (submission, counters, dispatches) = match submitted {
            Ok(submitted) => submitted,
            // A lack of memory is reported more precisely than what comes of it.
            Err(error) => return report.await.and(Err(error)),
        };
        self.submitted.push_back(Submitted { report, submission, counters, dispatches });
        self.meter.stats.submits += 1;
        Ok(())
    }

    fn submit_batch(&mut self) -> Result<(wgpu::SubmissionIndex, Pending<u32>, usize), Error> {
        let piece = self.piece();
        let Phase1Run { gpu, kernels, device, plan, .. } = self;
        let mut recorder = Recorder::new(gpu, self.profiler.as_deref_mut());
        let batch = plan.next_batch();
        if batch.is_first {
            device.record_start(gpu, &mut recorder, &self.start, plan.counters());
        }
        let before = recorder.dispatches();
        device.record_batch(gpu, &kernels.stages, &mut recorder, &batch, piece)?;
        let dispatches = recorder.dispatches() - before;
        self.meter.stats.dispatches += recorder.dispatches();
        let counters = device.read_counters(gpu, &mut kernels.readback, &mut recorder);
        Ok((recorder.submit(gpu), counters, dispatches))
    }

    /// Waits for the counters after a batch.
    async fn receive(&mut self, batch: Submitted) -> Result<Counters, Error> {
        let Submitted { report, submission, counters, .. } = batch;
        report.await?;
        let words = self.kernels.readback.receive(self.gpu, &submission, counters).await?;
        Ok(counters_in(&words))
    }

    /// Waits for all batches that were submitted, whatever they did.
    pub(super) async fn receive_all(&mut self) -> Result<(), Error> {
        for batch in std::mem::take(&mut self.submitted) {
            self.receive(batch).await?;
        }
        Ok(())
    }

    /// Returns how many dispatches are to be submitted at a time, by the time that those took that were read last.
    fn piece(&self) -> usize {
        // The next rounds may insert all others, and take longer by as much.
        let growth = f64::from(self.device.params.infinite) / f64::from(self.plan.counters().inserted.max(1));
        let longest = growth * self.meter.dispatch_time.as_secs_f64();
        // As long as nothing was read, there is no limit.
        (self.settings().budget.submission.as_secs_f64() / longest) as usize
    }

    /// Has all points of the input wait to be inserted into `start`.
    pub(super) fn begin_with(&mut self, start: StartMesh) {
        self.device.set_start(&start);
        let start_points = start.points.len();
        let long_walks = self.plan.counters().long_walks;
        self.plan = Plan::new(*self.plan.rules(), start_points as u32, self.before);
        self.plan.set_counters(Counters { long_walks, ..first_counters(self.device.params.infinite) });
        self.meter.stats.rounds.clear();
        self.meter.stats.start_points = start_points;
        self.start = start;
    }
}
