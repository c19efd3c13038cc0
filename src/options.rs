//! What a caller can choose.

use std::{fmt, ops::ControlFlow, sync::Arc};

/// Which engine computes the triangulation. All give the same set of tetrahedra.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Engine {
    /// The CPU engine, for now.
    #[default]
    Auto,
    /// Incremental insertion on one core.
    Cpu,
    /// Flipping on the graphics card, splaying on the CPU. Opens the default adapter anew in every call: those with more
    /// than one input keep a [`Hybrid`](crate::hybrid::Hybrid).
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
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
    pub engine: Engine,
    /// Called a few hundred times in a run, in the calling thread.
    pub on_progress: Option<OnProgress>,
    /// Whether the GPU engine shall keep [`Stats::trace`](crate::stats::Stats::trace). All tetrahedra are read back after
    /// every round and their facets tested once more, so a run takes several times as long: for small inputs.
    pub trace: bool,
}

impl fmt::Debug for Options {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("engine", &self.engine)
            .field("on_progress", &self.on_progress.as_ref().map(|_| "…"))
            .field("trace", &self.trace)
            .finish()
    }
}

impl Options {
    /// Reports progress; an error when the caller wants to stop.
    pub(crate) fn report(&self, phase: &'static str, fraction: f64) -> Result<(), crate::Error> {
        match &self.on_progress {
            Some(callback) if callback(Progress { phase, fraction }).is_break() => Err(crate::Error::Cancelled),
            _ => Ok(()),
        }
    }
}
