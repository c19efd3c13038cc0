//! The engines behind one function: the GPU engine is opened when it is first needed, and kept for later inputs.

use crate::{
    Engine, Error, Mesh3, Options, Points, cpu,
    gpu::{AdapterChoice, Gpu},
    hybrid::Hybrid,
    stats::Fallback,
};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// From so many points on, [`Engine::Auto`] takes the GPU engine if it is open.
///
/// Measured with `cargo run --release --example experiments -- crossing`. Uniform points, one NVIDIA H200 and one core of
/// the Xeon beside it, 2026-11-21: the CPU engine takes 2.0 µs a point, the GPU engine 47 ms for 100,000 and never more for
/// fewer, so they cross at 24,000 points or below.
pub const LEAST_POINTS: usize = 24_000;

/// The points that the CPU engine triangulates in the time that it takes to open the GPU and compile its kernels: 200 ms on
/// the same machine. [`Engine::Auto`] opens it when it has been asked for so many in all that the GPU would have taken, so
/// opening never costs more than was lost by not having done so.
pub const OPENING_POINTS: usize = 100_000;

/// Both engines, for any number of inputs.
///
/// [`delaunay3d`](crate::delaunay3d) has one of these for the whole process. Make another to choose the adapter, or where
/// nothing may block (browsers).
#[derive(Debug, Default)]
pub struct Engines {
    adapter: AdapterChoice,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// The GPU engine, while it is open.
    hybrid: Option<Arc<Hybrid>>,
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
        let state = State { hybrid: Some(Arc::new(hybrid)), given: true, ..State::default() };
        Engines { state: Mutex::new(state), ..Engines::default() }
    }

    /// Those of this process.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn shared() -> &'static Engines {
        static SHARED: std::sync::LazyLock<Engines> = std::sync::LazyLock::new(Engines::default);
        &SHARED
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
                let hybrid = self.hybrid().await?;
                let result = hybrid.delaunay3d(points, options).await;
                self.forget_if_lost(&hybrid, &result);
                result
            }
            Engine::Auto => self.auto(points, options).await,
        }
    }

    /// The GPU engine, opened if it is not.
    ///
    /// # Errors
    ///
    /// As [`Gpu::open`] and [`Hybrid::new`].
    pub async fn hybrid(&self) -> Result<Arc<Hybrid>, Error> {
        if let Some(hybrid) = &self.state().hybrid {
            return Ok(Arc::clone(hybrid));
        }
        let gpu = Gpu::open(&self.adapter).await?;
        self.keep(gpu).await
    }

    async fn auto(&self, points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
        let options = &options.monotone();
        let why = match self.hybrid_if_it_pays(points.len()).await {
            Ok(hybrid) => {
                let result = hybrid.delaunay3d(points, options).await;
                self.forget_if_lost(&hybrid, &result);
                match result {
                    Err(error) if error.is_of_the_gpu() => Fallback::GpuFailed(error),
                    result => return result,
                }
            }
            Err(why) => why,
        };
        let mut mesh = cpu::delaunay3d(points, options)?;
        mesh.stats.fallback = Some(why);
        Ok(mesh)
    }

    /// The GPU engine for an input of `points` points, or why the CPU engine is to be preferred.
    async fn hybrid_if_it_pays(&self, points: usize) -> Result<Arc<Hybrid>, Fallback> {
        if points < LEAST_POINTS {
            return Err(Fallback::FewPoints { points, least: LEAST_POINTS });
        }
        {
            let mut state = self.state();
            if let Some(why) = &state.unusable {
                return Err(why.clone());
            }
            match &state.hybrid {
                Some(hybrid) if hybrid.gpu().adapter().software && !state.given => return Err(software(hybrid.gpu())),
                Some(hybrid) => return Ok(Arc::clone(hybrid)),
                None => {}
            }
            let least = OPENING_POINTS.saturating_sub(state.missed);
            if points < least {
                state.missed += points;
                return Err(Fallback::FewPoints { points, least });
            }
        }
        let opened = match Gpu::open(&self.adapter).await {
            Ok(gpu) if gpu.adapter().software => Err(software(&gpu)),
            Ok(gpu) => self.keep(gpu).await.map_err(Fallback::NoGpu),
            Err(error) => Err(Fallback::NoGpu(error)),
        };
        if let Err(why) = &opened {
            self.state().unusable = Some(why.clone());
        }
        opened
    }

    /// Compiles the kernels for `gpu`, and keeps them unless somebody else was faster.
    async fn keep(&self, gpu: Gpu) -> Result<Arc<Hybrid>, Error> {
        let hybrid = Arc::new(Hybrid::new(gpu).await?);
        Ok(Arc::clone(self.state().hybrid.get_or_insert(hybrid)))
    }

    /// Lets the next input open the GPU anew, where it was lost with this one.
    fn forget_if_lost(&self, hybrid: &Arc<Hybrid>, result: &Result<Mesh3, Error>) {
        let mut state = self.state();
        let is_kept = state.hybrid.as_ref().is_some_and(|kept| Arc::ptr_eq(kept, hybrid));
        if is_kept && matches!(result, Err(Error::DeviceLost { .. })) {
            state.hybrid = None;
            state.given = false;
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Nothing that holds the lock can leave a half-made state.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn software(gpu: &Gpu) -> Fallback {
    Fallback::SoftwareGpu(gpu.adapter().name.clone())
}
