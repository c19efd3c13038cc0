//! Points as the kernels see them.
//!
//! The buffer `vertices` is an array of `vec4<i32>`. A lattice coordinate has a high word of 31
//! bits and, in the wide form, a low word of 31 more.
//!
//! | form | words of vertex *v* |
//! | --- | --- |
//! | narrow | `vertices[v]` = x, y, z, input index |
//! | wide | `vertices[2 v]` = high words of x, y, z, input index; `vertices[2 v + 1]` = their low words, 1 if rounded |
//!
//! One buffer and not two, because a kernel can bind only eight; the words of a wide vertex share a
//! 32-byte sector.

use crate::gpu::dim::words_of;
use crate::input::lattice::Width;

/// Appends the words of a vertex with lattice coordinates `position`. `rounded` says that they are
/// not the true ones; only the wide form keeps that, because the narrow lattice rounds nothing.
pub fn append_words(words: &mut Vec<i32>, width: Width, position: [i64; 3], index: u32, rounded: bool) {
    let index = index as i32;
    match width {
        Width::Narrow => {
            words.extend(position.map(|q| q as i32));
            words.push(index);
        }
        Width::Wide => {
            let [[high_x, low_x], [high_y, low_y], [high_z, low_z]] = position.map(words_of);
            words.extend([high_x, high_y, high_z, index, low_x, low_y, low_z, i32::from(rounded)]);
        }
    }
}

/// Returns the lattice coordinates in the words of a vertex.
pub fn position(words: &[i32]) -> [i64; 3] {
    std::array::from_fn(|axis| match words.len() {
        8 => i64::from(words[axis]) << 31 | i64::from(words[4 + axis]),
        _ => i64::from(words[axis]),
    })
}
