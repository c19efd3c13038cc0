//! What computes a triangulation.

use crate::fields::{Field, Value};
use std::fmt;

/// What computes the triangulation. All backends give the same mesh, up to the order of its
/// simplices.
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
    /// The GPU where there is a hardware GPU and the input is large enough to be worth it, else the
    /// CPU; also the CPU when the GPU fails. [`Stats::fallback`](crate::stats::Stats::fallback)
    /// then gives the reason.
    ///
    /// A GPU is worth it from 6,000 points on in 3D and from 30,000 on in 2D. It is opened once
    /// the inputs of that size would have made up for the time that opening takes: 100,000 points
    /// in 3D, 560,000 in 2D.
    #[default]
    Auto,
    /// Incremental insertion, by all threads of the machine or by the requested number.
    Cpu,
    /// Insertion and flipping on the GPU, then star splaying (3D) or flips (2D) on the CPU.
    ///
    /// If you request the GPU explicitly, GPU failures are returned as errors, and so is a build
    /// without the feature `gpu`. Only inputs that the GPU cannot triangulate, such as coplanar
    /// points in 3D, are left to the CPU; [`Stats::fallback`](crate::stats::Stats::fallback) then
    /// gives the reason.
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

/// In JavaScript, the backend of a finished run.
impl Field for Backend {
    fn value(&self) -> Value<'_> {
        Value::Text(self.name().into())
    }

    /// Returns the backends that compute: `auto` is only a request.
    fn typescript() -> Option<String> {
        Some("'gpu' | 'cpu'".to_owned())
    }
}
