//! The reference of `shaders/d3/hilbert.wgsl`.

/// Returns the place of a cell of a grid along the Hilbert curve (Skilling, *Programming the
/// Hilbert curve*, 2004), here in the loops of the paper: of a 1024³ grid in 3D, of a 32768² one in
/// 2D.
pub fn hilbert_key<const D: usize>(mut x: [u32; D]) -> u32 {
    let bits = 30 / D as u32;
    for bit in (1..bits).rev() {
        let lower = (1 << bit) - 1;
        for axis in 0..D {
            if x[axis] >> bit & 1 == 1 {
                x[0] ^= lower;
            } else {
                let exchanged = (x[0] ^ x[axis]) & lower;
                x[0] ^= exchanged;
                x[axis] ^= exchanged;
            }
        }
    }
    for axis in 1..D {
        x[axis] ^= x[axis - 1];
    }
    let flips = (1..bits).filter(|&bit| x[D - 1] >> bit & 1 == 1).fold(0, |flips, bit| flips ^ ((1 << bit) - 1));
    let x = x.map(|x| x ^ flips);
    (0..bits).rev().fold(0, |key, bit| x.iter().fold(key, |key, x| key << 1 | x >> bit & 1))
}
