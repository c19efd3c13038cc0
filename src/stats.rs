//! What a run did, and how long it took.

use crate::Error;

/// How a mesh came about.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stats {
    /// The engine that made the mesh: `"cpu"` or `"gpu"`.
    pub engine: &'static str,
    /// Why the CPU engine made the mesh, where it was not asked for by name.
    pub fallback: Option<Fallback>,
    /// The phases in the order in which they ran, with the seconds that each took; those of an attempt that failed are not
    /// among them. Zeros on wasm without the feature `gpu`, where there is no clock.
    pub phases: Vec<(&'static str, f64)>,
    /// Signs that the floating-point filter left open on the CPU, by what decided them.
    pub exact: ExactCounts,
    /// What the GPU did, also where the CPU engine had to take over from it.
    pub gpu: Option<GpuStats>,
    /// What star splaying did after that.
    pub splay: Option<SplayStats>,
    /// How the mesh came about step by step, if [`Options::trace`](crate::Options::trace) asked for it.
    pub trace: Option<Trace>,
}

/// Why the CPU engine made a mesh, though it was not asked for by name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fallback {
    /// The CPU engine is sooner done with so few points.
    #[error("{points} points are too few to be worth the GPU, which needs {least}")]
    FewPoints {
        /// The points of the input.
        points: usize,
        /// From so many on the GPU would have been used.
        least: usize,
    },
    /// There is no GPU, or none that can be opened.
    #[error("{0}")]
    NoGpu(Error),
    /// The only GPU is a program that runs on the CPU.
    #[error("the only GPU is software ({0})")]
    SoftwareGpu(String),
    /// The GPU failed.
    #[error("{0}")]
    GpuFailed(Error),
    /// The points are coplanar or so nearly so that the lattice cannot tell.
    #[error("the points are coplanar, or nearly")]
    Coplanar,
    /// The points of the plane are collinear or so nearly so that the lattice cannot tell.
    #[error("the points are collinear, or nearly")]
    Collinear,
    /// The device's flips waited for each other in a row that was too long; or, in the plane, what rounding left open took more flips
    /// than the CPU engine would have.
    #[error("flipping was too much work")]
    Flips,
    /// In the plane, rounding had folded the triangulation over itself in a way that flips do not undo.
    #[error("rounding had folded the triangulation over itself")]
    Folded,
    /// Splaying asked for more signs than the CPU engine would have.
    #[error("splaying was too much work")]
    Work,
    /// Splaying found that Phase 1 had made no triangulation of the true coordinates.
    #[error("{0}")]
    Inconsistent(&'static str),
}

/// What Phase 1 did on the GPU.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GpuStats {
    /// The adapter's name.
    pub adapter: String,
    /// The insertion rounds, then the rounds in which the last flips were done.
    pub rounds: Vec<Round>,
    /// Flips of two tetrahedra into three.
    pub flips_23: u64,
    /// Flips of three tetrahedra into two.
    pub flips_32: u64,
    /// In the plane: flips of two triangles into two.
    pub flips_22: u64,
    /// Flip iterations that had something to do.
    pub flip_iterations: u64,
    /// Signs that took exact arithmetic.
    pub exact_tests: u64,
    /// Facets that were not locally Delaunay and could not be flipped, those with the vertex at infinity included.
    pub not_locally_delaunay: u64,
    /// The vertices of such facets, infinity left out.
    pub failed_vertices: u64,
    /// Points that another one at the same place of the lattice stood for: duplicates, and points that were rounded there.
    pub merged: u64,
    /// Results that were read back.
    pub readbacks: u64,
    /// Kernels that were run.
    pub dispatches: u64,
    /// Submissions to the queue.
    pub submits: u64,
    /// The most bytes of GPU memory that were held at a time.
    pub bytes: u64,
}

/// A round of Phase 1.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Round {
    /// Points that were inserted.
    pub inserted: u32,
    /// Tetrahedra whose facets are still to be checked at the end.
    pub active: u32,
    /// Flips.
    pub flips: u32,
    /// Flip iterations that had something to do.
    pub iterations: u32,
    /// Milliseconds on the host's clock.
    pub milliseconds: f64,
}

/// What splaying did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SplayStats {
    /// Flat tetrahedra on the hull that were peeled off.
    pub peeled: usize,
    /// Failed vertices.
    pub failed: usize,
    /// Stars that were made convex: those of failed vertices, and some that had flat or inverted tetrahedra.
    pub built: usize,
    /// Of these, the ones that were built from their points, where Flip-Flop could not start or was stuck.
    pub from_points: usize,
    /// Stars that were taken from the triangulation as they are.
    pub pulled: usize,
    /// Flips of Flip-Flop.
    pub flips: usize,
    /// Points that were inserted into stars.
    pub insertions: usize,
    /// Checks whether all stars agree about a tetrahedron.
    pub checks: usize,
    /// Tetrahedra that were removed from the triangulation.
    pub removed: usize,
    /// Tetrahedra that were added to it.
    pub added: usize,
    /// Missing points that were inserted.
    pub inserted: usize,
    /// Signs that were asked for.
    pub signs: u64,
    /// Rounds of insertions.
    pub rounds: usize,
}

/// How a mesh came about, step by step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// The finite tetrahedra after each of [`GpuStats::rounds`], as input indices. The last are what splaying begins with.
    pub rounds: Vec<Vec<[u32; 4]>>,
    /// The facets between finite tetrahedra that were not locally Delaunay when Phase 1 was done, as input indices.
    pub not_locally_delaunay: Vec<[u32; 3]>,
    /// For each tetrahedron of the mesh, whether splaying made it and not Phase 1.
    pub splayed: Vec<bool>,
}

/// How many signs each stage of the predicates decided, after the floating-point filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ExactCounts {
    /// Decided by fixed-width integers on the lattice.
    pub integer: u64,
    /// Decided by floating-point expansions or big integers, where a point does not fit the lattice.
    pub expansion: u64,
    /// Cospherical: decided by the symbolic perturbation.
    pub symbolic: u64,
}

impl std::ops::Add for ExactCounts {
    type Output = Self;

    fn add(self, more: Self) -> Self {
        ExactCounts {
            integer: self.integer + more.integer,
            expansion: self.expansion + more.expansion,
            symbolic: self.symbolic + more.symbolic,
        }
    }
}

impl Stats {
    /// The seconds that all phases took together.
    pub fn total_seconds(&self) -> f64 {
        self.phases.iter().map(|(_, seconds)| seconds).sum()
    }
}

/// Times consecutive phases. Reads no clock on wasm without the feature `gpu`, which has none; with it, the browser's.
pub(crate) struct Stopwatch {
    #[cfg(any(feature = "gpu", not(target_arch = "wasm32")))]
    started: Instant,
}

#[cfg(not(target_arch = "wasm32"))]
use std::time::Instant;
#[cfg(all(feature = "gpu", target_arch = "wasm32"))]
use web_time::Instant;

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Stopwatch {
            #[cfg(any(feature = "gpu", not(target_arch = "wasm32")))]
            started: Instant::now(),
        }
    }

    /// The seconds since the start or the last lap.
    #[cfg(any(feature = "gpu", not(target_arch = "wasm32")))]
    pub(crate) fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let seconds = (now - self.started).as_secs_f64();
        self.started = now;
        seconds
    }

    /// Zero: there is no clock.
    #[cfg(not(any(feature = "gpu", not(target_arch = "wasm32"))))]
    pub(crate) fn lap(&mut self) -> f64 {
        0.0
    }
}
