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

#[cfg(test)]
mod tests {
    use super::*;

    /// The curve visits each cell once and goes from each to a neighbour.
    fn is_a_hilbert_curve<const D: usize>(side: u32) {
        let cells = (0..side.pow(D as u32)).map(|i| std::array::from_fn(|axis| i / side.pow(axis as u32) % side));
        let mut cells: Vec<(u32, [u32; D])> = cells.map(|cell| (hilbert_key(cell), cell)).collect();
        cells.sort_unstable();
        for pair in cells.windows(2) {
            let [(k, a), (l, b)] = [pair[0], pair[1]];
            assert_eq!(k + 1, l);
            assert_eq!((0..D).map(|i| a[i].abs_diff(b[i])).sum::<u32>(), 1, "{a:?} {b:?}");
        }
    }

    #[test]
    fn it_is_a_hilbert_curve() {
        is_a_hilbert_curve::<3>(16);
        is_a_hilbert_curve::<2>(64);
    }
}
