//! What a caller can choose.

use std::{fmt, ops::ControlFlow, sync::Arc};

/// Which engine computes the triangulation. All give the same set of tetrahedra.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Backend {
    /// The GPU engine where there is a graphics card and the input is large enough to be worth it
    /// ([`engines`](crate::triangulator) has the numbers), else the CPU engine; also when the GPU fails in the middle.
    /// [`Stats::fallback`](crate::stats::Stats::fallback) says why it was the CPU engine. Without the feature `gpu`, and
    /// in a browser where nothing may wait, it is the CPU engine.
    #[default]
    Auto,
    /// Incremental insertion on one core.
    Cpu,
    /// Flipping on the graphics card, splaying on the CPU; an error where the device fails or cannot hold the input. Input
    /// that is no work for it is left to the CPU engine: see
    /// [`GpuEngine::triangulate`](crate::gpu::engine::GpuEngine::triangulate).
    #[cfg(feature = "gpu")]
    Gpu,
}

/// How far a run has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The phase that is running, by its name in [`Stats::phases`](crate::stats::Stats::phases).
    pub phase: &'static str,
    /// The share of the whole run that is done, 0 to 1.
    pub fraction: f64,
}

/// Receives progress; [`ControlFlow::Break`] cancels the run.
pub type OnProgress = Arc<dyn Fn(Progress) -> ControlFlow<()> + Send + Sync>;

/// How to triangulate.
#[derive(Clone, Default)]
pub struct Options {
    /// Which engine to use.
    pub backend: Backend,
    /// Called a few hundred times in a run, in the calling thread.
    pub on_progress: Option<OnProgress>,
    /// Whether the GPU engine shall keep [`Stats::trace`](crate::stats::Stats::trace). All tetrahedra are read back after
    /// every round and their facets tested once more, so a run takes several times as long: for small inputs.
    pub trace: bool,
}

impl fmt::Debug for Options {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("backend", &self.backend)
            .field("on_progress", &self.on_progress.as_ref().map(|_| "…"))
            .field("trace", &self.trace)
            .finish()
    }
}

impl Options {
    /// Options for a run that may have to begin again: its progress goes on from where it was.
    #[cfg(feature = "gpu")]
    pub(crate) fn monotone(&self) -> Options {
        let on_progress = self.on_progress.clone().map(|callback| {
            // The share that was done when the run began again, and what was last reported.
            let state = std::sync::Mutex::new((0.0, 0.0));
            let continued = move |progress: Progress| {
                let fraction = {
                    let mut state = state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                    let (base, last) = *state;
                    let base: f64 = if progress.fraction < last { base + (1.0 - base) * last } else { base };
                    *state = (base, progress.fraction);
                    base + (1.0 - base) * progress.fraction
                };
                callback(Progress { fraction, ..progress })
            };
            Arc::new(continued) as OnProgress
        });
        Options { on_progress, ..self.clone() }
    }

    /// Reports progress; an error when the caller wants to stop.
    pub(crate) fn report(&self, phase: &'static str, fraction: f64) -> Result<(), crate::Error> {
        match &self.on_progress {
            Some(callback) if callback(Progress { phase, fraction }).is_break() => Err(crate::Error::Cancelled),
            _ => Ok(()),
        }
    }
}
