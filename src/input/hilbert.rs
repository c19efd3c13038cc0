//! Hilbert curves in three and two dimensions, for the spatial sort of the paper's §4.3.
//!
//! The 3D curve is that of Hamilton and Rau-Chaplin, *Compact Hilbert indices* (2008), without the
//! compaction.

/// For each of the 24 states and each octant (bit *k* is set in the upper half of axis *k*): the
/// octant's place along the curve, and the state within it.
///
/// A state is `3·e + d`, where *e* is the octant in which the curve enters and *d* the axis along
/// which it leaves.
const STEPS_3D: [[(u8, u8); 8]; 24] = steps();

/// Rotates a number of three bits.
const fn rotate_left(bits: u32, by: u32) -> u32 {
    ((bits << (by % 3)) | (bits >> (3 - by % 3))) & 7
}

/// Computes [`STEPS_3D`] from the Gray code of the octants.
const fn steps() -> [[(u8, u8); 8]; 24] {
    let mut table = [[(0, 0); 8]; 24];
    let mut state = 0;
    while state < 24 {
        let (e, d) = (state as u32 / 3, state as u32 % 3);
        let mut place = 0;
        while place < 8 {
            let octant = rotate_left(place ^ place >> 1, d + 1) ^ e;
            let entry = if place == 0 { 0 } else { (place - 1) & !1 };
            let entry = entry ^ entry >> 1;
            let direction = match place {
                0 => 0,
                p if p % 2 == 0 => (p - 1).trailing_ones(),
                p => p.trailing_ones(),
            };
            let next_e = e ^ rotate_left(entry, d + 1);
            let next_d = (d + direction + 1) % 3;
            table[state][octant as usize] = (place as u8, (3 * next_e + next_d) as u8);
            place += 1;
        }
        state += 1;
    }
    table
}

/// Returns the place along the 3D curve of the cell with the given coordinates, of which the lowest
/// `bits` ≤ 21 count.
pub fn index3d(cell: [u32; 3], bits: u32) -> u64 {
    let mut state = 0;
    let mut index = 0;
    for bit in (0..bits).rev() {
        let octant = (cell[0] >> bit & 1) | (cell[1] >> bit & 1) << 1 | (cell[2] >> bit & 1) << 2;
        let (place, next) = STEPS_3D[state][octant as usize];
        index = index << 3 | u64::from(place);
        state = usize::from(next);
    }
    index
}

/// For each of the 4 states of the 2D curve and each quadrant (x in bit 1, y in bit 0): the
/// quadrant's place along the curve, and the state within it.
///
/// The states are the curve, the curve with its axes exchanged, and these two rotated by 180°.
const STEPS_2D: [[(u8, u8); 4]; 4] = [
    [(0, 1), (1, 0), (3, 3), (2, 0)],
    [(0, 0), (3, 2), (1, 1), (2, 1)],
    [(2, 2), (3, 1), (1, 2), (0, 3)],
    [(2, 3), (1, 3), (3, 0), (0, 2)],
];

/// Returns the place along the 2D curve of the cell with the given coordinates, of which the lowest
/// `bits` ≤ 32 count.
pub(crate) fn index2d([x, y]: [u32; 2], bits: u32) -> u64 {
    let mut state = 0;
    let mut index = 0;
    for bit in (0..bits).rev() {
        let quadrant = (x >> bit & 1) << 1 | (y >> bit & 1);
        let (place, next) = STEPS_2D[state][quadrant as usize];
        index = index << 2 | u64::from(place);
        state = usize::from(next);
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consecutive_cells_are_neighbours() {
        for bits in 1..=5 {
            let side = 1u32 << bits;
            let mut cells = vec![None; (side * side * side) as usize];
            for x in 0..side {
                for y in 0..side {
                    for z in 0..side {
                        assert_eq!(cells[index3d([x, y, z], bits) as usize].replace([x, y, z]), None);
                    }
                }
            }
            for pair in cells.windows(2) {
                let (a, b) = (pair[0].unwrap(), pair[1].unwrap());
                assert_eq!((0..3).map(|k| a[k].abs_diff(b[k])).sum::<u32>(), 1, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn consecutive_cells_of_the_2d_curve_are_neighbours() {
        for bits in 1..=6 {
            let side = 1u32 << bits;
            let mut cells = vec![None; (side * side) as usize];
            for x in 0..side {
                for y in 0..side {
                    assert_eq!(cells[index2d([x, y], bits) as usize].replace([x, y]), None);
                }
            }
            for pair in cells.windows(2) {
                let (a, b) = (pair[0].unwrap(), pair[1].unwrap());
                assert_eq!((0..2).map(|k| a[k].abs_diff(b[k])).sum::<u32>(), 1, "{a:?} {b:?}");
            }
        }
    }
}
