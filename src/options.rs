//! Options for a triangulation, as [`Triangulator`](crate::Triangulator) collects them.

use crate::{backend::Backend, error::Error, stats::Phase};
use std::{fmt, num::NonZeroUsize, ops::ControlFlow, sync::Arc};

/// How far a run has come, as [`Triangulator::on_progress`](crate::Triangulator::on_progress)
/// reports it.
///
/// # Examples
///
/// ```
/// use gdel::{Progress, Triangulator};
/// use std::ops::ControlFlow;
///
/// let report = |Progress { phase, fraction, .. }: Progress| {
///     println!("{phase}: {:.0} %", 100.0 * fraction);
///     ControlFlow::Continue(())
/// };
/// Triangulator::new().on_progress(report).delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]])?;
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// The phase that is running.
    pub phase: Phase,
    /// The share of the whole run that is done, from 0 to 1. It never decreases.
    pub fraction: f64,
}

/// Receives progress; [`ControlFlow::Break`] cancels the run.
pub type OnProgress = Arc<dyn Fn(Progress) -> ControlFlow<()> + Send + Sync>;

/// The orientation of a 2D mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Winding {
    /// Counter-clockwise with *y* up, as [`Mesh2`](crate::Mesh2) promises.
    #[default]
    CounterClockwise,
    /// Clockwise with *y* up, as the JavaScript library delaunator has it.
    Clockwise,
}

/// Options for a triangulation.
#[derive(Clone, Default)]
pub struct Options {
    /// What computes the triangulation.
    pub backend: Backend,
    /// The number of threads of the CPU backend; by default that of rayon's pool.
    pub threads: Option<NonZeroUsize>,
    /// Called a few hundred times per run, in the calling thread or, if the number of threads is
    /// set, in one of these.
    pub on_progress: Option<OnProgress>,
    /// Whether the GPU keeps [`Stats::trace`](crate::stats::Stats::trace).
    pub trace: bool,
    /// The orientation of 2D meshes: the JavaScript package's is not that of
    /// [`Mesh2`](crate::Mesh2).
    pub winding: Winding,
}

impl fmt::Debug for Options {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("backend", &self.backend)
            .field("threads", &self.threads)
            .field("on_progress", &self.on_progress.as_ref().map(|_| "…"))
            .field("trace", &self.trace)
            .field("winding", &self.winding)
            .finish()
    }
}

impl Options {
    /// Returns options for a run that may restart: its progress never decreases.
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

    /// Reports progress. Returns [`Error::Cancelled`] if the caller wants to stop.
    pub(crate) fn report(&self, phase: Phase, fraction: f64) -> Result<(), Error> {
        match &self.on_progress {
            Some(callback) if callback(Progress { phase, fraction }).is_break() => Err(Error::Cancelled),
            _ => Ok(()),
        }
    }
}
