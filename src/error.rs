//! What can go wrong, as values.

/// Why no triangulation was made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN or infinite.
    #[error("point {index}: the {axis} coordinate is {value}, which is not a finite number")]
    NotFinite {
        /// The first point, in input order, with such a coordinate.
        index: usize,
        /// `'x'`, `'y'` or `'z'`.
        axis: char,
        /// `NaN`, `inf` or `-inf`.
        value: &'static str,
    },
    /// Interleaved coordinates do not come in whole points.
    #[error(
        "{length} interleaved coordinates are not a whole number of points: the length must be a multiple of {dimension}"
    )]
    NotWholePoints {
        /// The length of the array.
        length: usize,
        /// Coordinates a point.
        dimension: usize,
    },
    /// The mesh would need more tetrahedra than an index can name.
    #[error("{points} points are too many: this engine holds at most {limit}")]
    TooManyPoints {
        /// The points of the input.
        points: usize,
        /// The most that this engine can take.
        limit: usize,
    },
    /// There is no GPU, or it gives no device.
    #[error("no GPU can be used: {reason}")]
    NoAdapter {
        /// What the system says.
        reason: String,
    },
    /// No GPU of this machine has the wanted index or name.
    #[error("there is no GPU {wanted:?}; this machine has {available:?}")]
    AdapterNotFound {
        /// The index or the part of a name that was asked for.
        wanted: String,
        /// The names of the GPUs that there are, in the order of their indices.
        available: Vec<String>,
    },
    /// The GPU was reset, unplugged or taken away while it was at work.
    #[error("the GPU was lost: {reason}")]
    DeviceLost {
        /// What the driver or the browser says.
        reason: String,
    },
    /// The GPU has not enough free memory.
    #[error("the GPU ran out of memory: {what}")]
    OutOfDeviceMemory {
        /// What the memory was for.
        what: &'static str,
    },
    /// A buffer would be larger than kernels on this GPU can see.
    #[error("the buffer of {label} would need {bytes} bytes, but this GPU binds at most {limit}{}", fitting(.points))]
    BufferTooLarge {
        /// What the buffer holds.
        label: &'static str,
        /// The size that it would have.
        bytes: u128,
        /// The largest size that this GPU can bind.
        limit: u64,
        /// About how many points it can take, where the buffer is one of a triangulation.
        points: Option<usize>,
    },
    /// The GPU reports what should not happen: a defect of this crate or of the driver.
    #[error("the GPU reports: {message}")]
    Gpu {
        /// What it reports.
        message: String,
    },
    /// The input's triangulation is larger than an index can name, as only contrived inputs' are.
    #[error("the triangulation has more than {limit} tetrahedra, the most that this engine holds")]
    TooManyTetrahedra {
        /// The most that the engine holds.
        limit: usize,
    },
    /// The machine has no memory left for the mesh.
    #[error("out of memory: there is no room for {tetrahedra} tetrahedra")]
    OutOfMemory {
        /// The tetrahedra that room was asked for.
        tetrahedra: usize,
    },
    /// The progress callback asked to stop.
    #[error("cancelled")]
    Cancelled,
}

/// What can be done instead.
fn fitting(points: &Option<usize>) -> String {
    points.map_or_else(String::new, |points| format!(", enough for about {points} points"))
}

#[cfg(feature = "gpu")]
impl Error {
    /// Whether it is the GPU's, so that the CPU engine may still do what this one could not.
    pub(crate) fn is_of_the_gpu(&self) -> bool {
        use Error::*;
        match self {
            NoAdapter { .. } | AdapterNotFound { .. } | DeviceLost { .. } | OutOfDeviceMemory { .. } => true,
            BufferTooLarge { .. } | Gpu { .. } | TooManyPoints { .. } | TooManyTetrahedra { .. } => true,
            NotFinite { .. } | NotWholePoints { .. } | OutOfMemory { .. } | Cancelled => false,
        }
    }
}
