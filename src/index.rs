//! The mark for the absence of an index.

/// Marks the absence of a simplex, point or cell in arrays of indices.
///
/// It stands in [`Mesh3::neighbors`](crate::Mesh3::neighbors) and
/// [`Mesh2::halfedges`](crate::Mesh2::halfedges) outside the hull, and in `duplicate_of` for points
/// that are not duplicates. In JavaScript's signed arrays and in files it is −1, which has the same
/// bits.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// // A single triangle has no neighbours.
/// assert_eq!(gdel::delaunay2d(&points)?.halfedges, [[gdel::NONE; 3]]);
/// # Ok::<(), gdel::Error>(())
/// ```
pub const NONE: u32 = u32::MAX;

/// Writes an entry of an array of indices for people: "none" in place of [`NONE`].
pub(crate) struct Entry(pub(crate) u32);

impl std::fmt::Display for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0 == NONE { f.write_str("none") } else { self.0.fmt(f) }
    }
}

/// Makes hash tables of indices fast: hashes by a multiplication and a rotation for each. They are not chosen by an
/// adversary.
#[derive(Default)]
pub(crate) struct IndexHasher(u64);

pub(crate) type BuildIndexHasher = std::hash::BuildHasherDefault<IndexHasher>;

impl std::hash::Hasher for IndexHasher {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&b| self.write_u32(b.into()));
    }
    fn write_u32(&mut self, x: u32) {
        self.0 = (self.0 ^ u64::from(x)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    }
}
