//! Options for a triangulation, as [`Triangulator`](crate::Triangulator) collects them.

use crate::{Error, stats::Phase};
use std::{fmt, ops::ControlFlow, sync::Arc};

/// What computes the triangulation. All backends give the same mesh, up to the order of its simplices.
///
/// # Examples
///
/// ```
/// use gdel::{Backend, Triangulator};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let mesh = Triangulator::new().backend(Backend::Cpu).delaunay2d(&points)?;
/// assert_eq!(mesh.stats.backend, Backend::Cpu);
/// assert_eq!(Backend::Cpu.to_string(), "cpu");
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Backend {
    /// The GPU where there is a hardware GPU and the input is large enough to be worth it, else the CPU; also the CPU
    /// when the GPU fails. [`Stats::fallback`](crate::stats::Stats::fallback) then gives the reason.
    ///
    /// A GPU is worth it from 24,000 points on in 3D and from 30,000 on in 2D. It is opened once the inputs of that size
    /// would have made up for the time that opening takes: 100,000 points in 3D, 560,000 in 2D.
    #[default]
    Auto,
    /// Incremental insertion on one core.
    Cpu,
    /// Insertion and flipping on the GPU, then star splaying (3D) or flips (2D) on the CPU.
    ///
    /// If you request the GPU explicitly, GPU failures are returned as errors, and so is a build without the feature
    /// `gpu`. Only inputs that the GPU cannot triangulate, such as coplanar points in 3D, are left to the CPU;
    /// [`Stats::fallback`](crate::stats::Stats::fallback) then gives the reason.
    Gpu,
}

impl Backend {
    /// Returns the name of the backend: `auto`, `cpu` or `gpu`.
    pub fn name(self) -> &'static str {
        match self {
            Backend::Auto => "auto",
            Backend::Cpu => "cpu",
            Backend::Gpu => "gpu",
        }
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Backend {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// How far a run has come, as [`Triangulator::on_progress`](crate::Triangulator::on_progress) reports it.
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
    /// Called a few hundred times per run, in the calling thread.
    pub on_progress: Option<OnProgress>,
    /// Whether the GPU keeps [`Stats::trace`](crate::stats::Stats::trace).
    pub trace: bool,
    /// The orientation of 2D meshes: the JavaScript package's is not that of [`Mesh2`](crate::Mesh2).
    pub winding: Winding,
}

impl fmt::Debug for Options {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("backend", &self.backend)
            .field("on_progress", &self.on_progress.as_ref().map(|_| "…"))
            .field("trace", &self.trace)
            .field("winding", &self.winding)
            .finish()
    }
}

impl Options {
    /// Returns options for a run that may have to begin again: its progress continues from where it was.
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
    pub(crate) fn report(&self, phase: Phase, fraction: f64) -> Result<(), Error> {
        match &self.on_progress {
            Some(callback) if callback(Progress { phase, fraction }).is_break() => Err(Error::Cancelled),
            _ => Ok(()),
        }
    }
}
