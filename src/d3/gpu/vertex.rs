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

use crate::input::lattice::Width;

/// Returns the words that one vertex takes.
pub const fn words_per_vertex(width: Width) -> usize {
    match width {
        Width::Narrow => 4,
        Width::Wide => 8,
    }
}

/// Appends the words of a vertex with lattice coordinates `position`. `rounded` says that they are
/// not the true ones; only the wide form keeps that, because the narrow lattice rounds nothing.
pub fn append_words(words: &mut Vec<i32>, width: Width, position: [i64; 3], index: u32, rounded: bool) {
    let [x, y, z] = position;
    let index = index as i32;
    match width {
        Width::Narrow => words.extend([x as i32, y as i32, z as i32, index]),
        Width::Wide => {
            let high = |q: i64| (q >> 31) as i32;
            let low = |q: i64| (q & 0x7fff_ffff) as i32;
            words.extend([high(x), high(y), high(z), index]);
            words.extend([low(x), low(y), low(z), i32::from(rounded)]);
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
