//! Errors, as values.

/// The reason why no triangulation was made.
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
    /// The length of an array of interleaved coordinates is not a multiple of the dimension.
    #[error(
        "{length} interleaved coordinates are not a whole number of points: the length must be a multiple of {dimension}"
    )]
    NotWholePoints {
        /// The length of the array.
        length: usize,
        /// The number of coordinates per point.
        dimension: usize,
    },
    /// The mesh would need more tetrahedra than can be indexed.
    #[error("{points} points are too many: this engine holds at most {limit}")]
    TooManyPoints {
        /// The number of points of the input.
        points: usize,
        /// The maximum number of points.
        limit: usize,
    },
    /// There is no GPU, or it provides no device.
    #[error("no GPU can be used: {reason}")]
    NoAdapter {
        /// The message of the system.
        reason: String,
    },
    /// No GPU of this machine has the requested index or name.
    #[error("there is no GPU {wanted:?}; this machine has {available:?}")]
    AdapterNotFound {
        /// The requested index, or part of a name.
        wanted: String,
        /// The names of the available GPUs, in the order of their indices.
        available: Vec<String>,
    },
    /// The GPU was reset, unplugged or taken away while it was working.
    #[error("the GPU was lost: {reason}")]
    DeviceLost {
        /// The message of the driver or of the browser.
        reason: String,
    },
    /// The GPU does not have enough free memory.
    #[error("the GPU ran out of memory: {what}")]
    OutOfDeviceMemory {
        /// What the memory was for.
        what: &'static str,
    },
    /// A buffer would be larger than kernels on this GPU can bind.
    #[error("the buffer of {label} would need {bytes} bytes, but this GPU binds at most {limit}{}", fitting(.points))]
    BufferTooLarge {
        /// What the buffer holds.
        label: &'static str,
        /// The size that the buffer would have, in bytes.
        bytes: u128,
        /// The maximum size of a binding on this GPU, in bytes.
        limit: u64,
        /// The approximate number of points that would fit, if the buffer belongs to a
        /// triangulation.
        points: Option<usize>,
    },
    /// The GPU reports an error that should not occur: a defect of this crate or of the driver.
    #[error("the GPU reports: {message}")]
    Gpu {
        /// The message of the driver or of wgpu.
        message: String,
    },
    /// The triangulation has more tetrahedra than can be indexed, which happens only for contrived
    /// inputs.
    #[error("the triangulation has more than {limit} tetrahedra, the most that this engine holds")]
    TooManyTetrahedra {
        /// The maximum number of tetrahedra.
        limit: usize,
    },
    /// There is not enough memory for the mesh.
    #[error("out of memory: there is no room for {tetrahedra} tetrahedra")]
    OutOfMemory {
        /// The number of tetrahedra (triangles in 2D) for which memory was requested.
        tetrahedra: usize,
    },
    /// The progress callback requested cancellation.
    #[error("cancelled")]
    Cancelled,
}

/// Says what would fit, for [`Error::BufferTooLarge`].
fn fitting(points: &Option<usize>) -> String {
    points.map_or_else(String::new, |points| format!(", enough for about {points} points"))
}

#[cfg(feature = "gpu")]
impl Error {
    /// Returns whether the error is the GPU's, so that the CPU may still succeed.
    pub(crate) fn is_of_the_gpu(&self) -> bool {
        use Error::*;
        match self {
            NoAdapter { .. } | AdapterNotFound { .. } | DeviceLost { .. } | OutOfDeviceMemory { .. } => true,
            BufferTooLarge { .. } | Gpu { .. } | TooManyPoints { .. } | TooManyTetrahedra { .. } => true,
            NotFinite { .. } | NotWholePoints { .. } | OutOfMemory { .. } | Cancelled => false,
        }
    }
}
