//! Errors, as values.

/// Why there is no triangulation.
///
/// Coplanar, collinear or coincident points, or none at all, are not an error: see
/// [`Mesh3::dimension`](crate::Mesh3::dimension).
///
/// # Examples
///
/// ```
/// use gdel::Error;
///
/// let points = [[0.0, 0.0], [1.0, f64::NAN], [0.0, 1.0]];
/// match gdel::delaunay2d(&points) {
///     Err(Error::NotFinite { index, axis, .. }) => assert_eq!((index, axis), (1, 'y')),
///     result => panic!("{result:?}"),
/// }
/// ```
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN or infinite.
    #[error("point {index}: the {axis} coordinate is {value}, which is not a finite number")]
    NotFinite {
        /// The index of the first point with such a coordinate.
        index: usize,
        /// `'x'`, `'y'` or `'z'`.
        axis: char,
        /// `NaN`, `inf` or `-inf`.
        value: &'static str,
    },
    /// Interleaved coordinates end in the middle of a point.
    #[error(
        "{length} interleaved coordinates are not a whole number of points: the length must be a multiple of {dimension}"
    )]
    NotWholePoints {
        /// The length of the array.
        length: usize,
        /// The number of coordinates per point.
        dimension: usize,
    },
    /// A two-dimensional array does not have one point per row.
    #[error(
        "an array of shape {rows} × {columns} does not hold points: it must have {dimension} columns, one row per point"
    )]
    ArrayShape {
        /// The number of rows of the array.
        rows: usize,
        /// The number of columns of the array.
        columns: usize,
        /// The number of coordinates per point.
        dimension: usize,
    },
    /// The rows of a two-dimensional array do not lie in memory one after the other.
    #[error("the points of the array are not contiguous in memory: pass a copy in row-major order")]
    ArrayLayout,
    /// The input has more points than the backend can number.
    #[error("{points} points are too many: at most {limit} can be triangulated")]
    TooManyPoints {
        /// The number of points of the input.
        points: usize,
        /// The largest number of points that the backend can take.
        limit: usize,
    },
    /// The GPU was requested where it cannot be used: the crate was built without it, or may not
    /// wait for it.
    #[error("the GPU cannot be used: {reason}")]
    GpuUnavailable {
        /// What makes it unavailable.
        reason: &'static str,
    },
    /// There is no GPU, or its driver gives no access to it.
    #[error("no GPU can be opened: {reason}")]
    NoAdapter {
        /// The operating system's or browser's message.
        reason: String,
    },
    /// No GPU of this machine has the requested index or name.
    #[error("there is no GPU {wanted:?}; this machine has {}", listed(.available))]
    AdapterNotFound {
        /// The requested index or part of a name.
        wanted: String,
        /// The names of all GPUs, in the order of their indices.
        available: Vec<String>,
    },
    /// [`Triangulator::adapter`](crate::Triangulator::adapter) was called for a triangulator that was
    /// created from a device.
    #[error("the triangulator was created from a device: it cannot choose an adapter")]
    AdapterOfDevice,
    /// The GPU was reset, unplugged or taken away during the run.
    #[error("the connection to the GPU was lost: {reason}")]
    DeviceLost {
        /// The driver's or browser's message.
        reason: String,
    },
    /// The GPU does not have enough free memory.
    #[error("the GPU ran out of memory for {label}")]
    OutOfDeviceMemory {
        /// What the memory was for.
        label: &'static str,
    },
    /// A buffer would be larger than the GPU allows.
    #[error("the buffer of {label} would need {bytes} bytes, but this GPU allows at most {limit}{}", fitting(.points))]
    BufferTooLarge {
        /// What the buffer holds.
        label: &'static str,
        /// The size that the buffer would have, in bytes.
        bytes: u128,
        /// The largest size that this GPU allows, in bytes.
        limit: u64,
        /// About how many points would fit, if the buffer is one of a triangulation.
        points: Option<usize>,
    },
    /// The GPU reports an error that should not happen: a defect of this crate or of the driver.
    #[error("the GPU failed unexpectedly: {reason}")]
    Gpu {
        /// The message of the GPU's driver or of wgpu.
        reason: String,
    },
    /// The GPU computes something else than it should: a defect of it or of its driver. It is not to be used.
    #[error("the GPU ({adapter}) computes wrong results: {test}")]
    WrongResults {
        /// The name of the GPU.
        adapter: String,
        /// What noticed it: a test with a known answer, or a check of a mesh.
        test: &'static str,
    },
    /// The system does not start as many threads as were requested.
    #[error("{threads} threads cannot be started: {reason}")]
    Threads {
        /// The requested number of threads.
        threads: usize,
        /// The system's message.
        reason: String,
    },
    /// The triangulation has more tetrahedra, or triangles in 2D, than can be numbered, as only
    /// contrived inputs have.
    #[error("the triangulation has more than {limit} simplices, the largest number that can be stored")]
    TooManySimplices {
        /// The largest number that can be stored.
        limit: usize,
    },
    /// The machine has no memory left for the mesh.
    #[error("out of memory: there is no room for {simplices} simplices")]
    OutOfMemory {
        /// The number of tetrahedra, or triangles in 2D, that room was requested for.
        simplices: usize,
    },
    /// Equal points have different values, and that was to be an error.
    #[error("points {first} and {other} are equal, but their values differ")]
    DuplicateValues {
        /// The index of the first of the points.
        first: usize,
        /// The lowest index of a point with another value.
        other: usize,
    },
    /// A mesh was given with other points than its own.
    #[error("the mesh has {expected} points, not {points}")]
    PointCount {
        /// The number of points that were given.
        points: usize,
        /// The number of points of the mesh.
        expected: usize,
    },
    /// A point cannot be removed from a mesh.
    #[error("point {index} cannot be removed: {reason}")]
    BadIndex {
        /// The index of the point.
        index: u32,
        /// There is no such point, it was removed before, or it is given twice.
        reason: &'static str,
    },
    /// There is not one value per point.
    #[error("there are {values} values for {points} points")]
    ValueCount {
        /// The number of values.
        values: usize,
        /// The number of points.
        points: usize,
    },
    /// A weight is NaN or infinite.
    #[error("weight {index} is not a finite number")]
    BadWeight {
        /// The index of the first point with such a weight.
        index: usize,
    },
    /// A radius is negative or NaN.
    #[error("radius {index} is not a number from 0 on")]
    BadRadius {
        /// The index of the first point with such a radius.
        index: usize,
    },
    /// A mass is not a positive finite number.
    #[error("mass {index} is not a positive number")]
    BadMass {
        /// The index of the first point with such a mass.
        index: usize,
    },
    /// The cells cannot have the masses as volumes.
    #[error("the sum of the masses is {masses}, but the volume that they are to fill is {volume}")]
    MassSum {
        /// The sum of the masses.
        masses: String,
        /// The volume, in 2D the area, of what the cells are clipped to.
        volume: String,
    },
    /// Rounding keeps the cells from having the masses as exactly as was asked for.
    #[error("cells with these masses were not found: they differ by {error} of a mass, more than the tolerance")]
    TransportStopped {
        /// The largest difference between a mass and a volume that was reached, as a share of the mass.
        error: String,
    },
    /// What was asked for exists for Delaunay triangulations only, and the mesh is one of weighted points. In place of
    /// their alpha shape there is [`BallComplex`](crate::BallComplex).
    #[error("this is not possible with a mesh of weighted points")]
    WeightedMesh,
    /// What was asked for does not exist for meshes with constraints so far, and the mesh has some.
    #[error("this is not possible with a mesh that has constraints")]
    ConstrainedMesh,
    /// An end of a constraint is not a point.
    #[error("the segment {}–{} has an end that is not one of the {points} points", .segment[0], .segment[1])]
    BadConstraint {
        /// The first such segment.
        segment: [u32; 2],
        /// The number of points.
        points: usize,
    },
    /// Constraints cross where there is no point.
    #[error("constraints cross where there is no point: {}", crossing(.pairs, *.count))]
    CrossingConstraints {
        /// The number of pairs of segments that cross. A segment counts only where it crosses one before it that
        /// crosses none itself there.
        count: usize,
        /// The first pairs in the order of the input, at most 16.
        pairs: Vec<[[u32; 2]; 2]>,
    },
    /// A fill rule needs closed boundaries.
    #[error("the boundaries are not closed: at point {point}, they do not begin as often as they end")]
    OpenBoundary {
        /// The lowest index of a vertex where they are not.
        point: usize,
    },
    /// The box that a Voronoi diagram is to be clipped to has no inside, or is not finite.
    #[error("the box has no inside: along the {axis} axis, its lower end must be below its upper end, and both finite")]
    EmptyBox {
        /// `'x'`, `'y'` or `'z'`.
        axis: char,
    },
    /// The radius of an alpha complex is negative or NaN.
    #[error("alpha must be a number that is not negative")]
    BadAlpha,
    /// An option of [`Surface::new`](crate::Surface::new) is out of its range.
    #[error("{option} must be {range}")]
    BadOption {
        /// The name of the option.
        option: &'static str,
        /// What it may be.
        range: &'static str,
    },
    /// A mesh is not the Delaunay triangulation of the points that were given with it, and cannot
    /// be used.
    #[error("the mesh is not the Delaunay triangulation of the points: {reason}")]
    BrokenMesh {
        /// How that was noticed.
        reason: &'static str,
    },
    /// A tile was created with what does not belong to it.
    #[error("tile {tile} cannot be made: {reason}")]
    BadTile {
        /// The number of the tile.
        tile: u32,
        /// What does not belong to it.
        reason: &'static str,
    },
    /// A message is not what another tile has sent.
    #[error("this is not a message between tiles: {reason}")]
    BadMessage {
        /// How that was noticed.
        reason: &'static str,
    },
    /// The progress callback requested to stop.
    #[error("the triangulation was cancelled")]
    Cancelled,
}

/// Returns the part of a message that names what would fit.
fn fitting(points: &Option<usize>) -> String {
    points.map_or_else(String::new, |points| format!(", enough for about {points} points"))
}

/// Returns the part of a message that lists segments that cross.
fn crossing(pairs: &[[[u32; 2]; 2]], count: usize) -> String {
    let shown: Vec<String> = pairs.iter().map(|[[a, b], [c, d]]| format!("{a}–{b} and {c}–{d}")).collect();
    let more = if count > pairs.len() { format!(", and {} more pairs", count - pairs.len()) } else { String::new() };
    shown.join(", ") + &more
}

fn listed(available: &[String]) -> String {
    if available.is_empty() { "none".to_owned() } else { available.join(", ") }
}

#[cfg(feature = "gpu")]
impl Error {
    /// Returns whether the error is one of the GPU, so that the CPU may still succeed.
    pub(crate) fn is_of_the_gpu(&self) -> bool {
        use Error::*;
        match self {
            GpuUnavailable { .. } | NoAdapter { .. } | AdapterNotFound { .. } | DeviceLost { .. } => true,
            OutOfDeviceMemory { .. } | BufferTooLarge { .. } | Gpu { .. } | WrongResults { .. } => true,
            TooManyPoints { .. } | TooManySimplices { .. } => true,
            NotFinite { .. } | NotWholePoints { .. } | ArrayShape { .. } | ArrayLayout => false,
            AdapterOfDevice | OutOfMemory { .. } | Threads { .. } | Cancelled => false,
            PointCount { .. } | BadIndex { .. } | ValueCount { .. } | DuplicateValues { .. } | EmptyBox { .. } => false,
            BadAlpha | BadOption { .. } | BrokenMesh { .. } | BadWeight { .. } | BadRadius { .. } => false,
            WeightedMesh | ConstrainedMesh | BadMass { .. } | MassSum { .. } | TransportStopped { .. } => false,
            BadConstraint { .. } | CrossingConstraints { .. } | OpenBoundary { .. } => false,
            BadTile { .. } | BadMessage { .. } => false,
        }
    }
}
