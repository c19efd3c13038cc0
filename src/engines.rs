//! The engines behind one function: the GPU engine is opened when it is first needed, and kept for later inputs.

use crate::{
    Engine, Error, Mesh2, Mesh3, Options, Points, cpu,
    gpu::{AdapterChoice, Gpu},
    hybrid::Hybrid,
    plane::{delaunay2d_in_order, hybrid::Hybrid2},
    points::Points2,
    stats::Fallback,
};
use async_lock::Mutex;

/// From so many points on, [`Engine::Auto`] takes the GPU engine if it is open.
///
/// A bound, from `cargo run --release --example experiments -- crossing` on one NVIDIA H200 and one core of the Xeon beside
/// it, 2026-11-21: the GPU engine takes 27 ms for 100,000 uniform points, and never more for fewer; the CPU engine takes 2.0 µs
/// a point at least, so it is no faster from 14,000 points on. The rest is for devices that take longer to start.
pub const LEAST_POINTS: usize = 24_000;

/// The points that the CPU engine triangulates in the time that it takes to open the GPU and compile its kernels: 188 and 74 ms
/// on the same machine, against 245 ms for 100,000 points. [`Engine::Auto`] opens it when it has been asked for so many in all
/// that the GPU would have taken, so opening never costs more than was lost by not having done so.
pub const OPENING_POINTS: usize = 100_000;

/// Both engines, for any number of inputs.
///
/// [`delaunay3d`](crate::delaunay3d) has one of these for the whole process. Make another to choose the adapter, or where
/// nothing may block (browsers). The device does one run at a time; others wait for it.
#[derive(Debug, Default)]
pub struct Engines {
    adapter: AdapterChoice,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// The GPU engine, while it is open.
    hybrid: Option<Hybrid>,
    /// The GPU engine for the plane, on the same device, while it is open.
    plane: Option<Hybrid2>,
    /// Whether [`Engine::Auto`] may take it though it is software.
    given: bool,
    /// Why [`Engine::Auto`] does not try to open it again.
    unusable: Option<Fallback>,
    /// Points of the inputs that the GPU engine would have been taken for, had it been open.
    missed: usize,
}

impl Engines {
    /// Engines of which that for the GPU will use this adapter.
    pub fn new(adapter: AdapterChoice) -> Self {
        Engines { adapter, ..Engines::default() }
    }

    /// Engines with this GPU engine, which [`Engine::Auto`] takes even if it is software. When its device is lost, the
    /// default adapter replaces it.
    pub fn with_hybrid(hybrid: Hybrid) -> Self {
        let state = State { hybrid: Some(hybrid), given: true, ..State::default() };
        Engines { state: Mutex::new(state), ..Engines::default() }
    }

    /// Those of this process.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn shared() -> &'static Engines {
        static SHARED: std::sync::LazyLock<Engines> = std::sync::LazyLock::new(Engines::default);
        &SHARED
    }

    /// The GPU, opened if it is not. The kernels are compiled for it, too.
    ///
    /// # Errors
    ///
    /// As [`Gpu::open`] and [`Hybrid::new`].
    pub async fn gpu(&self) -> Result<Gpu, Error> {
        let mut state = self.state.lock().await;
        Ok(state.open(&self.adapter).await?.gpu().clone())
    }

    /// Gives the device back now, and not when the last reference to it goes. A later run opens it anew.
    pub async fn close(&self) {
        let mut state = self.state.lock().await;
        if let Some(gpu) = state.open_device() {
            gpu.device().destroy();
        }
        state.close();
    }

    /// The triangulation of `points` by the engine that `options` name: see [`delaunay3d`](crate::delaunay3d).
    ///
    /// # Errors
    ///
    /// As for [`delaunay3d`](crate::delaunay3d).
    pub async fn delaunay3d(&self, points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
        match options.engine {
            Engine::Cpu => cpu::delaunay3d(points, options),
            Engine::Gpu => {
                let mut state = self.state.lock().await;
                state.open(&self.adapter).await?;
                state.run(points, options).await
            }
            Engine::Auto => {
                let options = &options.monotone();
                let why = match self.try_gpu(points, options).await {
                    Ok(result) => return result,
                    Err(why) => why,
                };
                let mut mesh = cpu::delaunay3d(points, options)?;
                mesh.stats.fallback = Some(why);
                Ok(mesh)
            }
        }
    }

    /// The triangulation of points of the plane by the engine that `options` name: see [`delaunay2d`](crate::delaunay2d).
    ///
    /// # Errors
    ///
    /// As for [`delaunay2d`](crate::delaunay2d).
    pub async fn delaunay2d(&self, points: Points2<'_>, options: &Options) -> Result<Mesh2, Error> {
        match options.engine {
            Engine::Auto | Engine::Cpu => delaunay2d_in_order(points, options, cpu::Order::default()),
            Engine::Gpu => {
                let mut state = self.state.lock().await;
                let result = state.open_plane(&self.adapter).await?.delaunay2d(points, options).await;
                if matches!(result, Err(Error::DeviceLost { .. })) {
                    state.close();
                }
                result
            }
        }
    }

    /// What the GPU engine makes of the points, or why the CPU engine has to.
    async fn try_gpu(&self, points: Points<'_>, options: &Options) -> Result<Result<Mesh3, Error>, Fallback> {
        if points.len() < LEAST_POINTS {
            return Err(Fallback::FewPoints { points: points.len(), least: LEAST_POINTS });
        }
        let mut state = self.state.lock().await;
        state.open_if_it_pays(&self.adapter, points.len()).await?;
        match state.run(points, options).await {
            Err(error) if error.is_of_the_gpu() => Err(Fallback::GpuFailed(error)),
            result => Ok(result),
        }
    }
}

impl State {
    /// The GPU engine, opened if it is not.
    async fn open(&mut self, adapter: &AdapterChoice) -> Result<&mut Hybrid, Error> {
        let hybrid = match self.hybrid.take() {
            Some(hybrid) => hybrid,
            None => Hybrid::new(self.device(adapter).await?).await?,
        };
        Ok(self.hybrid.insert(hybrid))
    }

    /// The GPU engine for the plane, opened if it is not.
    async fn open_plane(&mut self, adapter: &AdapterChoice) -> Result<&mut Hybrid2, Error> {
        let plane = match self.plane.take() {
            Some(plane) => plane,
            None => Hybrid2::new(self.device(adapter).await?).await?,
        };
        Ok(self.plane.insert(plane))
    }

    /// The device of the engines that are open: they share one.
    fn open_device(&self) -> Option<Gpu> {
        self.hybrid.as_ref().map(Hybrid::gpu).or(self.plane.as_ref().map(Hybrid2::gpu)).cloned()
    }

    /// That device, or a new one.
    async fn device(&self, adapter: &AdapterChoice) -> Result<Gpu, Error> {
        match self.open_device() {
            Some(gpu) => Ok(gpu),
            None => Gpu::open(adapter).await,
        }
    }

    /// Forgets a device that is lost or given back, and what was compiled for it.
    fn close(&mut self) {
        self.hybrid = None;
        self.plane = None;
        self.given = false;
    }

    /// Opens the GPU engine for an input of `points` points if it is not open, or says why not to take it.
    async fn open_if_it_pays(&mut self, adapter: &AdapterChoice, points: usize) -> Result<(), Fallback> {
        if let Some(why) = &self.unusable {
            return Err(why.clone());
        }
        if let Some(hybrid) = &self.hybrid {
            return if self.given { Ok(()) } else { hardware(hybrid.gpu()) };
        }
        let least = OPENING_POINTS.saturating_sub(self.missed);
        if points < least {
            self.missed += points;
            return Err(Fallback::FewPoints { points, least });
        }
        let opened = match self.device(adapter).await {
            Ok(gpu) => match hardware(&gpu) {
                Ok(()) => Hybrid::new(gpu).await.map_err(Fallback::NoGpu),
                Err(why) => Err(why),
            },
            Err(error) => Err(Fallback::NoGpu(error)),
        };
        match opened {
            Ok(hybrid) => {
                self.hybrid = Some(hybrid);
                Ok(())
            }
            Err(why) => Err(self.unusable.insert(why).clone()),
        }
    }

    /// Runs the GPU engine, which is open. If its device gets lost, the next run has to open it anew.
    async fn run(&mut self, points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
        let Some(hybrid) = &mut self.hybrid else {
            return Err(Error::NoAdapter { reason: "it is not open".to_owned() });
        };
        let result = hybrid.delaunay3d(points, options).await;
        if matches!(result, Err(Error::DeviceLost { .. })) {
            self.close();
        }
        result
    }
}

/// An adapter that is none is no use to [`Engine::Auto`].
fn hardware(gpu: &Gpu) -> Result<(), Fallback> {
    match gpu.adapter().software {
        true => Err(Fallback::SoftwareGpu(gpu.adapter().name.clone())),
        false => Ok(()),
    }
}
