//! A mesh whose points have moved, in place of the rounds that insert points.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Recorder,
        device_mesh::DeviceMesh,
        host::{Host, MakeStart},
        layout::Counters,
        phase1::{
            capacity::MAX_SIMPLICES, ended::pairs, finish::Finish, plan::Plan, record::counters_in, run::Phase1Run,
        },
    },
};

impl<const D: usize> Phase1Run<'_, D>
where
    Dimension<D>: Finish<D>,
{
    /// Takes the simplices of `mesh`, the triangulation of the points where they were, in place of
    /// the rounds that insert points, and finds out what is wrong with them. Returns the number of
    /// those that are not positively oriented, and that of facets that are not locally Delaunay;
    /// `None` if the arrays of the mesh do not fit each other.
    ///
    /// The flips that follow repair what they can. If `flips_at_once`, the first of them are submitted
    /// with it; the device leaves them out beyond [`Limits`](crate::gpu::update::Limits).
    /// [`Phase1Run::forget`] has the points inserted instead.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub(crate) async fn update(
        &mut self,
        mesh: &DeviceMesh<D>,
        flips_at_once: bool,
    ) -> Result<Option<[usize; 2]>, Error> {
        let gpu = self.gpu;
        let profiler = self.profiler.take();
        let (submission, counters) = gpu
            .with_error_scope("the mesh of points that have moved", || {
                let mut recorder = Recorder::new(gpu, profiler);
                self.device.record_moved(gpu, &self.kernels.stages, &mut recorder, mesh)?;
                self.meter.stats.dispatches += recorder.dispatches();
                self.meter.stats.submits += 1;
                let counters = self.device.read_counters(gpu, &mut self.kernels.readback, &mut recorder);
                Ok((recorder.submit(gpu), counters))
            })
            .await?;
        self.plan = Plan::of_moved(*self.plan.rules());
        self.meter.stats.start_points = 0;
        if flips_at_once {
            self.submit().await?;
        }
        let words = self.kernels.readback.receive(gpu, &submission, counters).await?;
        let counters = counters_in(&words);
        self.plan.set_counters(counters);
        let Counters { inverted, violated, .. } = counters;
        Ok((inverted < MAX_SIMPLICES).then_some([inverted as usize, violated as usize]))
    }

    /// Forgets the mesh that was taken: all points of the input wait to be inserted. `starts_later` is that of
    /// [`Begin`](crate::gpu::phase1::Begin).
    ///
    /// # Errors
    ///
    /// Those of [`Host::ask`] and [`Phase1Run::advance`].
    pub(crate) async fn forget(&mut self, host: &mut impl Host<D>, starts_later: bool) -> Result<(), Error> {
        let start = if starts_later {
            let wanted = self.settings().start_points(host.point_count());
            host.ask(MakeStart { wanted }).await?
        } else {
            std::mem::take(&mut self.start)
        };
        self.receive_all().await?;
        self.begin_with(start);
        Ok(())
    }

    /// Reads the points that are vertices of no simplex, as
    /// [`Phase1Output::merged`](crate::gpu::phase1::Phase1Output::merged) has them, after [`Phase1Run::update`].
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub(crate) async fn read_merged(&mut self) -> Result<Vec<[u32; 2]>, Error> {
        if self.plan.counters().merged == 0 {
            return Ok(Vec::new());
        }
        let merged_into = &self.device.memory.buffers.points.merged_into;
        self.meter.stats.submits += 1;
        self.meter.stats.stalls += 1;
        Ok(pairs(self.kernels.readback.read(self.gpu, merged_into, 0, merged_into.len()).await?))
    }
}
