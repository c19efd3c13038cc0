//! The twin of `shaders/shared/hilbert.wgsl`.

/// The place of a cell of a 1024³ grid along the Hilbert curve (Skilling, *Programming the Hilbert curve*, 2004): here
/// in the loops of the paper.
pub fn hilbert_key(mut x: [u32; 3]) -> u32 {
    const BITS: u32 = 10;
    for bit in (1..BITS).rev() {
        let lower = (1 << bit) - 1;
        for axis in 0..3 {
            if x[axis] >> bit & 1 == 1 {
                x[0] ^= lower;
            } else {
                let exchanged = (x[0] ^ x[axis]) & lower;
                x[0] ^= exchanged;
                x[axis] ^= exchanged;
            }
        }
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    let flips = (1..BITS).filter(|&bit| x[2] >> bit & 1 == 1).fold(0, |flips, bit| flips ^ ((1 << bit) - 1));
    let x = x.map(|x| x ^ flips);
    (0..BITS).rev().fold(0, |key, bit| x.iter().fold(key, |key, x| key << 1 | x >> bit & 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The curve visits each cell once and goes from each to a neighbour.
    #[test]
    fn it_is_a_hilbert_curve() {
        let side = 16;
        let mut cells = Vec::new();
        for x in 0..side {
            for y in 0..side {
                for z in 0..side {
                    cells.push((hilbert_key([x, y, z]), [x, y, z]));
                }
            }
        }
        cells.sort_unstable();
        for pair in cells.windows(2) {
            let [(k, a), (l, b)] = [pair[0], pair[1]];
            assert_eq!(k + 1, l);
            assert_eq!((0..3).map(|i| a[i].abs_diff(b[i])).sum::<u32>(), 1, "{a:?} {b:?}");
        }
    }
}
