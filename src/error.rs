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
