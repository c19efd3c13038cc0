//! The device that clones of a triangulator share, with what is compiled for it, and when
//! [`Backend::Auto`](crate::Backend::Auto) takes it.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        AdapterChoice, Gpu,
        device_mesh::MeshArrays,
        engine::{Complete, GpuEngine},
        phase1::Finish,
    },
    stats::Fallback,
};

/// The number of points in 3D from which on [`Backend::Auto`](crate::Backend::Auto) takes the GPU engine if it is open.
///
/// A bound, measured on one NVIDIA H200 and the Xeon beside it: the GPU engine takes 4.2 ms for 10,000 uniform points, and
/// 15 in Chromium (2026-11-28), hardly less for fewer. The CPU engine takes at least 2.0 µs per point with one thread, and
/// 4.2 in Chromium; with 4 and with 16 threads it takes longer than the GPU from 2,000 points on (2026-11-24). The rest is
/// for devices that take longer to start.
pub const MIN_POINTS_3D: usize = 6_000;

/// The number of points in 3D that the CPU engine triangulates in the time that it takes to open
/// the GPU and compile its kernels: 188 and 74 ms on the same machine, against 245 ms for 100,000
/// points. [`Backend::Auto`](crate::Backend::Auto) opens it when it has seen so many in all that the GPU would have
/// taken, so opening never costs more than was lost by not having done so.
pub const OPENING_POINTS_3D: usize = 100_000;

/// The number of points in 2D from which on [`Backend::Auto`](crate::Backend::Auto) takes the GPU engine if it is open:
/// on the same machine (2026-11-22), the GPU engine takes 8 ms
/// for 50,000 points, and the CPU engine 0.43 µs per point, so it is no faster from 19,000 points
/// on.
pub const MIN_POINTS_2D: usize = 30_000;

/// The number of points in 2D that the CPU engine triangulates while the GPU is opened and its
/// kernels compiled: 188 and 52 ms, at 0.43 µs per point.
pub const OPENING_POINTS_2D: usize = 560_000;

/// The device, and what is compiled for it.
#[derive(Debug, Default)]
pub struct State {
    pub(super) d3: Slot<3>,
    /// On the same device.
    pub(super) d2: Slot<2>,
    /// The device that was opened here, while it is open.
    pub(super) opened: Option<Gpu>,
    /// The caller's device, which [`Backend::Auto`] may take though it is software, and which is
    /// not destroyed here.
    pub(super) caller_supplied: Option<Gpu>,
    /// Why [`Backend::Auto`] does not try to open a device again.
    pub(super) unusable: Option<Fallback>,
}

#[derive(Debug)]
pub struct Slot<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    /// The GPU engine, while it is open.
    pub(super) engine: Option<GpuEngine<D>>,
    /// The points of the inputs so far that it would have been taken for, had it been open.
    points_seen: usize,
}

impl<const D: usize> Default for Slot<D>
where
    Dimension<D>: Finish<D>,
{
    fn default() -> Self {
        Slot { engine: None, points_seen: 0 }
    }
}

/// What [`Backend::Auto`] has to know of a dimension.
pub trait Choice<const D: usize>: Complete<D> + MeshArrays<D>
where
    Dimension<D>: Complete<D>,
{
    const MIN_POINTS: usize;
    const OPENING_POINTS: usize;

    fn slot(state: &mut State) -> &mut Slot<D>;
}

impl Choice<3> for Dimension<3> {
    const MIN_POINTS: usize = MIN_POINTS_3D;
    const OPENING_POINTS: usize = OPENING_POINTS_3D;

    fn slot(state: &mut State) -> &mut Slot<3> {
        &mut state.d3
    }
}

impl Choice<2> for Dimension<2> {
    const MIN_POINTS: usize = MIN_POINTS_2D;
    const OPENING_POINTS: usize = OPENING_POINTS_2D;

    fn slot(state: &mut State) -> &mut Slot<2> {
        &mut state.d2
    }
}

impl State {
    /// Returns the GPU engine, opened if it is not.
    pub(super) async fn open<const D: usize>(&mut self, adapter: &AdapterChoice) -> Result<&mut GpuEngine<D>, Error>
    where
        Dimension<D>: Choice<D>,
    {
        let engine = match Dimension::<D>::slot(self).engine.take() {
            Some(engine) => engine,
            None => GpuEngine::new(self.device(adapter).await?).await?,
        };
        Ok(Dimension::<D>::slot(self).engine.insert(engine))
    }

    /// Returns the device, opened if it is not.
    pub(super) async fn device(&mut self, adapter: &AdapterChoice) -> Result<Gpu, Error> {
        match self.opened.as_ref().or(self.caller_supplied.as_ref()) {
            Some(gpu) => Ok(gpu.clone()),
            None => Ok(self.opened.insert(Gpu::open(adapter).await?).clone()),
        }
    }

    /// Forgets the device that was opened, and what was compiled.
    pub(super) fn close(&mut self) {
        self.opened = None;
        self.d3.engine = None;
        self.d2.engine = None;
    }

    /// Opens the GPU engine for an input of `points` points if it is not open, or says why not to
    /// take it.
    pub(super) async fn open_if_it_pays<const D: usize>(
        &mut self,
        adapter: &AdapterChoice,
        points: usize,
    ) -> Result<(), Fallback>
    where
        Dimension<D>: Choice<D>,
    {
        if let Some(why) = &self.unusable {
            return Err(why.clone());
        }
        if let Some(gpu) = &self.opened {
            self.check_usable(gpu)?;
        }
        if Dimension::<D>::slot(self).engine.is_some() {
            return Ok(());
        }
        let missing = Dimension::<D>::OPENING_POINTS.saturating_sub(Dimension::<D>::slot(self).points_seen);
        if points < missing && self.caller_supplied.is_none() {
            Dimension::<D>::slot(self).points_seen += points;
            return Err(Fallback::FewPoints { points, least: missing });
        }
        let opened = match self.device(adapter).await {
            Ok(gpu) => match self.check_usable(&gpu) {
                Ok(()) => GpuEngine::new(gpu).await.map_err(Fallback::NoGpu),
                Err(why) => Err(why),
            },
            Err(error) => Err(Fallback::NoGpu(error)),
        };
        match opened {
            Ok(engine) => {
                Dimension::<D>::slot(self).engine = Some(engine);
                Ok(())
            }
            Err(why) => {
                self.opened = None;
                Err(self.unusable.insert(why).clone())
            }
        }
    }

    /// Forgets the device if `result` says that it is lost: the next run opens another.
    pub(super) fn forget_if_lost<T>(&mut self, result: &Result<T, Error>) {
        if matches!(result, Err(Error::DeviceLost { .. })) {
            self.close();
            self.caller_supplied = None;
        }
    }

    /// Says why [`Backend::Auto`](crate::Backend::Auto) cannot use this device: an adapter that is software is of no use
    /// to it, unless the caller supplied it.
    fn check_usable(&self, gpu: &Gpu) -> Result<(), Fallback> {
        match gpu.adapter().software && self.caller_supplied.is_none() {
            true => Err(Fallback::SoftwareGpu(gpu.adapter().name.clone())),
            false => Ok(()),
        }
    }
}
