//! Points as the kernels see them.
//!
//! The buffer `vertices` is an array of `vec4<i32>`. A lattice coordinate has a high word of 31 bits and, in the wide
//! form, a low word of 31 more.
//!
//! | form | words of vertex *v* |
//! | --- | --- |
//! | narrow | `vertices[v]` = x, y, z, input index |
//! | wide | `vertices[2 v]` = high words of x, y, z, input index; `vertices[2 v + 1]` = their low words, 0 |
//!
//! One buffer and not two, because a kernel can bind only eight; the words of a wide vertex share a 32-byte sector.

use crate::gpu::shader::constants::d3;
use crate::input::lattice::{Lattice, Width};

/// The vertex at infinity: above every vertex, and above every input index.
pub const INFINITE: u32 = d3::INFINITE;

/// The elements of `vertices` that one vertex takes.
pub const fn stride(width: Width) -> usize {
    match width {
        Width::Narrow => 1,
        Width::Wide => 2,
    }
}

/// The words of `vertices` that one vertex takes.
pub const fn words_per_vertex(width: Width) -> usize {
    4 * stride(width)
}

/// Appends the words of a vertex with lattice coordinates `position`.
pub fn append_words(words: &mut Vec<[i32; 4]>, width: Width, position: [i64; 3], index: u32) {
    let [x, y, z] = position;
    let index = index as i32;
    match width {
        Width::Narrow => words.push([x as i32, y as i32, z as i32, index]),
        Width::Wide => {
            let high = |q: i64| (q >> 31) as i32;
            let low = |q: i64| (q & 0x7fff_ffff) as i32;
            words.push([high(x), high(y), high(z), index]);
            words.push([low(x), low(y), low(z), 0]);
        }
    }
}

/// The words of `points`, in the order given, with their input indices. The lattice must be fitted to them.
pub fn words(lattice: &Lattice, points: impl ExactSizeIterator<Item = (u32, [f64; 3])>) -> Vec<[i32; 4]> {
    let width = lattice.width();
    let mut words = Vec::with_capacity(points.len().saturating_mul(stride(width)));
    for (index, p) in points {
        append_words(&mut words, width, lattice.coordinates(p).map(|c| c.value), index);
    }
    words
}
