//! Points as the kernels see them.
//!
//! | form | words of vertex *v* |
//! | --- | --- |
//! | narrow | x, y |
//! | wide | high words of x and y, low words of x and y; the highest bit of the third says that the point was rounded |
//!
//! Only ties ask for a vertex's input index: that is in the buffer of sorted pairs, beside its key.

use crate::gpu::dim::words_of;
use crate::input::lattice::Width;

/// The bit of a wide vertex's third word that says that the point was rounded.
pub const ROUNDED: u32 = 1 << 31;

/// Appends the words of a vertex with lattice coordinates `position`. `rounded` says that they are
/// not the true ones; only the wide form keeps that, because the narrow lattice rounds nothing.
pub fn append_words(words: &mut Vec<i32>, width: Width, position: [i64; 2], rounded: bool) {
    match width {
        Width::Narrow => words.extend(position.map(|q| q as i32)),
        Width::Wide => {
            let [[high_x, low_x], [high_y, low_y]] = position.map(words_of);
            let mark = if rounded { ROUNDED as i32 } else { 0 };
            words.extend([high_x, high_y, low_x | mark, low_y]);
        }
    }
}

/// Returns the lattice coordinates in the words of a vertex.
pub fn position(words: &[i32]) -> [i64; 2] {
    std::array::from_fn(|axis| match words {
        [_, _, _, _] => i64::from(words[axis]) << 31 | i64::from(words[2 + axis] & 0x7fff_ffff),
        _ => i64::from(words[axis]),
    })
}
