//! Statistics of Phase 1 on the GPU, and of star splaying.

use crate::fields::with_fields;
#[cfg(feature = "serde")]
use crate::stats::serialize;
use std::time::Duration;

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
        /// The number of submissions to the queue. One that is split, because the device takes long for it, counts once.
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
        /// The number of stars that were taken from the triangulation unchanged.
        pub pulled: usize,
        /// The number of Flip-Flop's flips.
        pub flips: usize,
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
