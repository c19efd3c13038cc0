//! Statistics of a run: what it did, and how long each part took.

use crate::{
    backend::Backend,
    error::Error,
    fields::{Field, Value, with_fields},
    platform::Instant,
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
            Fallback::NoGpu(_) => "no-gpu",
            Fallback::SoftwareGpu(_) => "software-gpu",
            Fallback::GpuFailed(_) => "gpu-failed",
            Fallback::Coplanar => "coplanar",
            Fallback::Collinear => "collinear",
            Fallback::Flips => "flips",
            Fallback::Folded => "folded",
            Fallback::Splaying => "splaying",
            Fallback::Inconsistent(_) => "inconsistent",
        }
    }
}

with_fields! {
    /// What Phase 1 did on the GPU.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let points: Vec<[f32; 2]> = (0..1000).map(|i| [(i * i % 997) as f32, i as f32]).collect();
    /// match Triangulator::new().backend(Backend::Gpu).delaunay2d(&points) {
    ///     Ok(mesh) => {
    ///         let gpu = mesh.stats.gpu.expect("the GPU was used");
    ///         println!("{}: {} rounds, {} bytes", gpu.adapter, gpu.rounds.len(), gpu.bytes);
    ///     }
    ///     Err(error) => println!("{error}"),
    /// }
    /// ```
    #[derive(Debug, Clone, Default, PartialEq)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize))]
    #[non_exhaustive]
    pub struct GpuStats {
        /// The name of the adapter.
        pub adapter: String,
        /// The insertion rounds, then the rounds that only flipped.
        pub rounds: Vec<Round>,
        /// The number of points that Phase 1 started with, which count as inserted by the first
        /// round: those that the CPU triangulated, or the corners of one simplex where that is
        /// faster, or the sample has duplicates.
        pub start_points: u64,
        /// The number of flips of two tetrahedra into three.
        pub flips_23: u64,
        /// The number of flips of three tetrahedra into two.
        pub flips_32: u64,
        /// The number of flips of two triangles into two, in 2D.
        pub flips_22: u64,
        /// The number of flip iterations that had something to do.
        pub flip_iterations: u64,
        /// The number of predicate evaluations that took exact arithmetic.
        pub exact_tests: u64,
        /// The number of facets that were not locally Delaunay and could not be flipped, including
        /// those with the vertex at infinity.
        pub not_locally_delaunay: u64,
        /// The number of vertices of such facets, without the vertex at infinity.
        pub failed_vertices: u64,
        /// The number of points that were merged with another one at the same lattice position:
        /// duplicates, and points that were rounded there.
        pub merged: u64,
        /// The number of results that were read back.
        pub readbacks: u64,
        /// How often the host waited for one of them while the device had nothing else to do.
        pub stalls: u64,
        /// The number of bytes that were read back.
        pub bytes_read: u64,
        /// The number of kernels that were run.
        pub dispatches: u64,
        /// The number of submissions to the queue.
        pub submits: u64,
        /// The largest amount of GPU memory that was held at a time, in bytes.
        pub bytes: u64,
    }
}

with_fields! {
    /// A round of Phase 1: insertions, and the flips that follow them.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let points: Vec<[f32; 2]> = (0..1000).map(|i| [(i * i % 997) as f32, i as f32]).collect();
    /// if let Ok(mesh) = Triangulator::new().backend(Backend::Gpu).delaunay2d(&points) {
    ///     for round in mesh.stats.gpu.iter().flat_map(|gpu| &gpu.rounds) {
    ///         println!("{} points, {} flips, {:?}", round.inserted, round.flips, round.time);
    ///     }
    /// }
    /// ```
    #[derive(Debug, Clone, Copy, Default, PartialEq)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize))]
    #[non_exhaustive]
    pub struct Round {
        /// The number of points that were inserted.
        pub inserted: u32,
        /// The number of tetrahedra, or triangles in 2D, whose facets were still to be checked at
        /// the end.
        pub active: u32,
        /// The number of flips.
        pub flips: u32,
        /// The number of flip iterations that had something to do.
        pub iterations: u32,
        /// The time by the host's clock: an equal share of that of the rounds which were submitted
        /// together.
        #[cfg_attr(feature = "serde", serde(rename = "seconds", serialize_with = "serialize::seconds"))]
        pub time: Duration,
    }
}

with_fields! {
    /// What star splaying did.
    ///
    /// # Examples
    ///
    /// ```
    /// // Star splaying repairs what the GPU's Phase 1 leaves open, so the CPU backend has none.
    /// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
    /// assert_eq!(gdel::delaunay3d(&points)?.stats.splay, None);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize))]
    #[non_exhaustive]
    pub struct SplayStats {
        /// The number of flat tetrahedra on the hull that were peeled off.
        pub peeled: usize,
        /// The number of failed vertices.
        pub failed: usize,
        /// The number of stars that were made convex: those of failed vertices, and some that had
        /// flat or inverted tetrahedra.
        pub built: usize,
        /// How many of these were built from their points because Flip-Flop could not start or was
        /// stuck.
        pub from_points: usize,
        /// The number of stars that were taken from the triangulation unchanged.
        pub pulled: usize,
        /// The number of Flip-Flop's flips.
        pub flips: usize,
        /// The number of insertions of points into stars.
        pub insertions: usize,
        /// The number of checks whether all stars agree about a tetrahedron.
        pub checks: usize,
        /// The number of tetrahedra that were removed from the triangulation.
        pub removed: usize,
        /// The number of tetrahedra that were added to it.
        pub added: usize,
        /// The number of missing points that were inserted.
        pub inserted: usize,
        /// The number of predicate evaluations.
        pub signs: u64,
        /// The number of rounds of insertions.
        pub rounds: usize,
        /// The number of times that stars were gathered from the device.
        pub gathers: usize,
        /// The number of tetrahedra that were gathered.
        pub gathered: usize,
    }
}

with_fields! {
    /// What an update, an insertion or a removal did to make a mesh from the one before.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [0.0, 1.0], [1.0, 0.5f64]];
    /// let mut mesh = triangulator.delaunay2d(&points)?;
    /// triangulator.remove(&mut mesh, &points, &[4])?;
    /// let update = mesh.stats.update.expect("the mesh was changed");
    /// assert_eq!((update.removed, update.inserted, update.restarted), (1, 0, None));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize))]
    #[non_exhaustive]
    pub struct UpdateStats {
        /// The number of tetrahedra, or triangles in 2D, that were flat or inverted at the new
        /// points. Like the next three, it is counted by updates of meshes on a device.
        pub inverted: usize,
        /// The number of facets, or edges in 2D, that were not locally Delaunay there.
        pub not_locally_delaunay: usize,
        /// The number of flips.
        pub flips: u64,
        /// The number of stars that were made convex; 3D only.
        pub stars: usize,
        /// The number of vertices that were removed because their points were.
        pub removed: usize,
        /// The number of points that were inserted: new ones, and former duplicates.
        pub inserted: usize,
        /// Whether a mesh on the device was read, changed on the host, and uploaded.
        pub on_host: bool,
        /// Why the points were triangulated from scratch, if they were. On a device, after two such
        /// updates in a row, only every fourth looks at the mesh; the others have the reason of the one
        /// before.
        pub restarted: Option<Restart>,
    }
}

impl UpdateStats {
    /// Returns the statistics of a run from scratch.
    pub(crate) fn from_scratch(why: Restart) -> Self {
        UpdateStats { restarted: Some(why), ..UpdateStats::default() }
    }
}

/// Why the points of a mesh were triangulated from scratch, and the mesh not changed.
///
/// # Examples
///
/// ```
/// use gdel::{Backend, Triangulator, stats::Restart};
///
/// let triangulator = Triangulator::new().backend(Backend::Cpu);
/// let mut mesh = triangulator.delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]])?;
/// triangulator.update(&mut mesh, &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0f64]])?;
/// // Only meshes on a device are repaired.
/// assert_eq!(mesh.stats.update.and_then(|update| update.restarted), Some(Restart::NotResident));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum Restart {
    /// The points span fewer dimensions, or did before.
    #[error("the points span fewer dimensions, or did before")]
    Degenerate,
    /// More simplices are flat or inverted at the new points than it pays to repair.
    #[error("too many simplices are inverted")]
    Inverted,
    /// More has changed for other reasons than it pays to repair.
    #[error("too much has changed")]
    Changed,
    /// The repair did not lead to the Delaunay triangulation.
    #[error("flips and star splaying do not lead to the Delaunay triangulation")]
    Stuck,
    /// Points that were apart have the same coordinates now.
    #[error("points that were apart have the same coordinates")]
    Coincident,
    /// Too many duplicates have parted from their points: inserting them takes longer.
    #[error("too many duplicates have parted")]
    Parted,
    /// Only a mesh on the device that triangulates its points can be repaired: this one is in the
    /// host's memory or on another device, or the CPU triangulates the points.
    #[error("the mesh is not on the device that triangulates its points")]
    NotResident,
    /// The arrays of the mesh are not those of a triangulation of its points.
    #[error("the mesh is not a triangulation")]
    Broken,
    /// More points come or go than it pays to insert or remove one by one.
    #[error("too many points come or go")]
    Points,
}

impl Restart {
    /// Returns the name of the reason, such as `inverted`.
    pub fn name(self) -> &'static str {
        match self {
            Restart::Degenerate => "degenerate",
            Restart::Inverted => "inverted",
            Restart::Changed => "changed",
            Restart::Stuck => "stuck",
            Restart::Coincident => "coincident",
            Restart::Parted => "parted",
            Restart::NotResident => "not-resident",
            Restart::Broken => "broken",
            Restart::Points => "points",
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

impl Field for Restart {
    fn value(&self) -> Value<'_> {
        Value::Text(self.name().into())
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

#[cfg(feature = "serde")]
mod serialize {
    use super::{Fallback, Phase, Restart};
    use serde::{
        Serialize, Serializer,
        ser::{SerializeMap, SerializeStruct},
    };
    use std::time::Duration;

    impl Serialize for Phase {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            serializer.serialize_str(self.name())
        }
    }

    impl Serialize for Restart {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            serializer.serialize_str(self.name())
        }
    }

    impl Serialize for Fallback {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let mut reason = serializer.serialize_struct("Fallback", 2)?;
            reason.serialize_field("reason", self.name())?;
            reason.serialize_field("message", &self.to_string())?;
            reason.end()
        }
    }

    pub(super) fn seconds<S: Serializer>(time: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(time.as_secs_f64())
    }

    pub(super) fn phases<S: Serializer>(phases: &[(Phase, Duration)], serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(phases.len()))?;
        for (phase, time) in phases {
            map.serialize_entry(phase, &time.as_secs_f64())?;
        }
        map.end()
    }
}

/// Times consecutive phases.
pub(crate) struct Stopwatch {
    started: Instant,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Stopwatch { started: Instant::now() }
    }

    /// Returns the time since the start or the last lap; zero where there is no clock.
    pub(crate) fn lap(&mut self) -> Duration {
        let now = Instant::now();
        let time = now - self.started;
        self.started = now;
        time
    }
}
