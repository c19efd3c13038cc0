//! Statistics of a run: what it did, and how long each part took.

mod gpu;
#[cfg(feature = "serde")]
mod serialize;
mod stopwatch;
mod update;

pub use gpu::{GpuStats, Round, SplayStats};
pub(crate) use stopwatch::Stopwatch;
pub use update::{Restart, UpdateStats};

use crate::{
    backend::Backend,
    error::Error,
    fields::{Field, Value, with_fields},
};
use std::{fmt, time::Duration};

with_fields! {
    /// Statistics of the run that computed a mesh.
    ///
    /// With the feature `serde`, all statistics can be serialised; times become seconds, and names
    /// such as those of [`Phase`] become strings. On WebAssembly without the feature `gpu` there is
    /// no clock, and all times are zero.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator, stats::Phase};
    ///
    /// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
    /// let stats = Triangulator::new().backend(Backend::Cpu).delaunay2d(&points)?.stats;
    /// assert_eq!(stats.backend, Backend::Cpu);
    /// assert!(stats.time_of(Phase::Insert) <= stats.total_time());
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize))]
    #[non_exhaustive]
    pub struct Stats {
        /// The backend that computed the mesh.
        pub backend: Backend,
        /// Why the CPU computed the mesh, if it was not requested explicitly.
        pub fallback: Option<Fallback>,
        /// The phases in the order in which they ran, with the time that each took. Phases of an
        /// attempt that failed are not included.
        #[cfg_attr(feature = "serde", serde(rename = "seconds", serialize_with = "serialize::phases"))]
        pub phases: Vec<(Phase, Duration)>,
        /// Predicate evaluations on the CPU that the floating-point filter left open, by what
        /// decided them.
        pub exact: ExactCounts,
        /// What the GPU did, including an attempt after which the CPU had to take over.
        pub gpu: Option<GpuStats>,
        /// What star splaying did after that; 3D only.
        pub splay: Option<SplayStats>,
        /// What [`Triangulator::update`](crate::Triangulator::update),
        /// [`insert`](crate::Triangulator::insert) or [`remove`](crate::Triangulator::remove) did, if
        /// that made the mesh.
        pub update: Option<UpdateStats>,
        /// How many meshes of the GPU, if it was considered, have failed a check so far, each of which was an error or
        /// left to the CPU; earlier processes are included where they have kept that.
        pub wrong_meshes: u64,
        /// The intermediate triangulations, if [`Triangulator::trace`](crate::Triangulator::trace)
        /// requested them.
        #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
        pub trace: Option<Trace>,
    }
}

impl Stats {
    /// Creates the statistics of a run that `backend` begins.
    pub(crate) fn new(backend: Backend) -> Self {
        Stats {
            backend,
            fallback: None,
            phases: Vec::new(),
            exact: ExactCounts::default(),
            gpu: None,
            splay: None,
            update: None,
            wrong_meshes: 0,
            trace: None,
        }
    }

    /// Returns the time that all phases took together.
    pub fn total_time(&self) -> Duration {
        self.phases.iter().map(|&(_, time)| time).sum()
    }

    /// Returns the time that one phase took; zero if it did not run.
    pub fn time_of(&self, phase: Phase) -> Duration {
        self.phases.iter().filter(|&&(ran, _)| ran == phase).map(|&(_, time)| time).sum()
    }
}

/// Returns the statistics of an empty run on the CPU.
impl Default for Stats {
    fn default() -> Self {
        Stats::new(Backend::Cpu)
    }
}

/// A phase of a run.
///
/// On the CPU the phases are [`Sort`](Phase::Sort), [`Insert`](Phase::Insert) and
/// [`Finish`](Phase::Finish). On the GPU they are [`Lattice`](Phase::Lattice),
/// [`Phase1`](Phase::Phase1), then [`Splay`](Phase::Splay) and [`Readback`](Phase::Readback) in 3D, the
/// latter first where a mesh is read before it is splayed, or [`Readback`](Phase::Readback),
/// [`Check`](Phase::Check) and [`Flip`](Phase::Flip) in 2D, and [`Finish`](Phase::Finish); an update on
/// the device has the same. Inserting points into a mesh and removing them has the phases of the
/// CPU, after a [`Readback`](Phase::Readback) for a mesh on the device.
///
/// # Examples
///
/// ```
/// use gdel::stats::Phase;
///
/// assert_eq!(Phase::Insert.to_string(), "insert");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Phase {
    /// Validating the points, ordering them along a Hilbert curve, and finding duplicates.
    Sort,
    /// Inserting the points one by one; where points come and go, removing others before.
    Insert,
    /// Validating the points and fitting the integer lattice.
    Lattice,
    /// Insertion and flipping on the GPU: Phase 1 of the gDel3D paper.
    Phase1,
    /// Copying the result of the GPU to host memory. A 3D mesh that is copied while it is splayed has here
    /// what is left to copy afterwards.
    Readback,
    /// Repairing a triangulation by star splaying: Phase 2 of the gDel3D paper.
    Splay,
    /// Evaluating exactly what rounding to the lattice left open, in 2D.
    Check,
    /// Repairing a triangulation by flips.
    Flip,
    /// Removing the ghosts and extracting the hull.
    Finish,
    /// Finding the weights of [`Triangulator::transport3d`](crate::Triangulator::transport3d), which has no other phase.
    Transport,
    /// Making points vertices of [`Triangulator::tin`](crate::Triangulator::tin), which has no other phase.
    Tin,
}

impl Phase {
    /// Returns the name of the phase, such as `insert`.
    pub fn name(self) -> &'static str {
        match self {
            Phase::Sort => "sort",
            Phase::Insert => "insert",
            Phase::Lattice => "lattice",
            Phase::Phase1 => "phase 1",
            Phase::Readback => "readback",
            Phase::Splay => "splay",
            Phase::Check => "check",
            Phase::Flip => "flip",
            Phase::Finish => "finish",
            Phase::Transport => "transport",
            Phase::Tin => "tin",
        }
    }
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Why the CPU computed a mesh although it was not requested explicitly.
///
/// # Examples
///
/// ```
/// use gdel::stats::Fallback;
///
/// // `Backend::Auto` does not use a GPU for three points.
/// let stats = gdel::delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]])?.stats;
/// match stats.fallback {
///     Some(Fallback::FewPoints { points, .. }) => assert_eq!(points, 3),
///     Some(reason) => println!("no GPU: {reason}"),
///     None => unreachable!("three points are left to the CPU"),
/// }
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fallback {
    /// The CPU triangulates so few points faster than the GPU.
    #[error("{points} points are too few to be worth the GPU, which needs {least}")]
    FewPoints {
        /// The number of points of the input.
        points: usize,
        /// The number of points from which on the GPU would have been used.
        least: usize,
    },
    /// The CPU triangulates so few points before the GPU could begin, whose kernels are not compiled yet.
    #[error("{points} points take the CPU less time than it takes to compile the kernels for the GPU")]
    Compiling {
        /// The number of points of the input.
        points: usize,
    },
    /// There is no GPU, or it cannot be opened.
    #[error("{0}")]
    NoGpu(Error),
    /// The only GPU is a program that runs on the CPU; the name of its adapter is given.
    #[error("the only GPU is software ({0})")]
    SoftwareGpu(String),
    /// The GPU failed.
    #[error("{0}")]
    GpuFailed(Error),
    /// The points are coplanar, or so nearly coplanar that the lattice cannot tell.
    #[error("the points are coplanar, or nearly")]
    Coplanar,
    /// The points of a 2D input are collinear, or so nearly collinear that the lattice cannot tell.
    #[error("the points are collinear, or nearly")]
    Collinear,
    /// The points are weighted, and only the CPU takes weights.
    #[error("the points are weighted, which only the CPU takes")]
    Weights,
    /// Flipping took more work than the CPU backend needs for the whole input.
    #[error("flipping took too much work")]
    Flips,
    /// In 2D, rounding had folded the triangulation over itself in a way that flips do not undo.
    #[error("rounding had folded the triangulation over itself")]
    Folded,
    /// Star splaying took more predicate evaluations than the CPU backend needs for the whole
    /// input.
    #[error("star splaying took too much work")]
    Splaying,
    /// Star splaying found that Phase 1 had not produced a triangulation of the exact coordinates.
    #[error("{0}")]
    Inconsistent(&'static str),
}

impl Fallback {
    /// Returns the name of the reason, such as `few-points`.
    pub fn name(&self) -> &'static str {
        match self {
            Fallback::FewPoints { .. } => "few-points",
            Fallback::Compiling { .. } => "compiling",
            Fallback::NoGpu(_) => "no-gpu",
            Fallback::SoftwareGpu(_) => "software-gpu",
            Fallback::GpuFailed(_) => "gpu-failed",
            Fallback::Coplanar => "coplanar",
            Fallback::Collinear => "collinear",
            Fallback::Weights => "weights",
            Fallback::Flips => "flips",
            Fallback::Folded => "folded",
            Fallback::Splaying => "splaying",
            Fallback::Inconsistent(_) => "inconsistent",
        }
    }
}

/// The intermediate triangulations of a run on the GPU in 3D.
///
/// # Examples
///
/// ```
/// use gdel::{Backend, Triangulator};
///
/// let points: Vec<[f32; 3]> =
///     (0..100).map(|i| [(i * 7 % 11) as f32, (i * i % 13) as f32, i as f32]).collect();
/// let traced = Triangulator::new().backend(Backend::Gpu).trace(true).delaunay3d(&points);
/// if let Some(trace) = traced.ok().and_then(|mesh| mesh.stats.trace) {
///     for (i, tetrahedra) in trace.rounds.iter().enumerate() {
///         println!("round {i}: {} tetrahedra", tetrahedra.len());
///     }
/// }
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Trace {
    /// The finite tetrahedra after each of [`GpuStats::rounds`], as input indices. Star splaying
    /// begins with the last.
    pub rounds: Vec<Vec<[u32; 4]>>,
    /// The facets between finite tetrahedra that were not locally Delaunay after Phase 1, as input
    /// indices.
    pub not_locally_delaunay: Vec<[u32; 3]>,
    /// For each tetrahedron of the mesh, whether star splaying created it rather than Phase 1.
    pub splayed: Vec<bool>,
}

with_fields! {
    /// The number of predicate evaluations that each exact stage decided after the floating-point
    /// filter.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// // All eight corners of a cube lie on one sphere, so ties are broken symbolically.
    /// let cube: Vec<[f32; 3]> =
    ///     (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|x| x as f32)).collect();
    /// let exact = Triangulator::new().backend(Backend::Cpu).delaunay3d(&cube)?.stats.exact;
    /// assert!(exact.symbolic > 0);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize))]
    #[non_exhaustive]
    pub struct ExactCounts {
        /// Decided by fixed-width integers on the lattice.
        pub integer: u64,
        /// Decided by floating-point expansions or big integers, where a point does not fit the
        /// lattice.
        pub expansion: u64,
        /// Cospherical or cocircular points: decided by the symbolic perturbation.
        pub symbolic: u64,
    }
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

impl Field for Fallback {
    fn value(&self) -> Value<'_> {
        Value::Text(self.to_string().into())
    }

    fn typescript() -> Option<String> {
        Some("string".to_owned())
    }
}

impl Field for (Phase, Duration) {
    fn value(&self) -> Value<'_> {
        let &(phase, time) = self;
        let milliseconds = Value::Number(1e3 * time.as_secs_f64());
        Value::Object(vec![
            ("name".to_owned(), Value::Text(phase.name().into())),
            ("milliseconds".to_owned(), milliseconds),
        ])
    }

    fn typescript() -> Option<String> {
        Some("{ name: string; milliseconds: number }".to_owned())
    }
}

/// In JavaScript the trace belongs to the mesh, and has typed arrays.
impl Field for Option<Trace> {
    fn value(&self) -> Value<'_> {
        Value::Omitted
    }

    fn typescript() -> Option<String> {
        None
    }
}
