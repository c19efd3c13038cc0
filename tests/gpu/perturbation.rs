//! The perturbation that breaks ties, carried out in big integers.

use crate::oracle;
use gdel::internals::predicates::Sign;
use num_bigint::BigInt;

/// Exponents of two, for coordinates below 16: δᵢ = 2^(−16 (i + 1)) is small enough to leave every
/// determinant's sign alone; η = 2^−128 for every product of a determinant and a δ; ζ = 2^(−128 (2 + k))
/// for the point that is the (k + 1)th to move towards the interior point; and the ε's,
/// 2^(−1024·2^bit), for every product of those before them.
const DELTA: usize = 16;
const ETA: usize = 128;
const ZETA: usize = 128;
const EPSILON: usize = 1024;

/// A row for each index and position: the coordinates, the height and 1, perturbed, and all times
/// the power of two that makes the smallest ε an integer. Only the coordinates of the `D` lowest
/// ranks are perturbed.
pub fn perturbed_rows<const D: usize>(vertices: &[(u32, [i64; D])]) -> Vec<Vec<BigInt>> {
    let one = EPSILON << (D * D - 1);
    let row = |&(index, position): &(u32, [i64; D])| {
        let rank = vertices.iter().filter(|(other, _)| *other < index).count();
        let coordinates = (0..D).map(|axis| {
            let bit = D * rank + D - 1 - axis;
            let epsilon = if rank < D { BigInt::from(1) << (one - (EPSILON << bit)) } else { BigInt::ZERO };
            (BigInt::from(position[axis]) << one) - epsilon
        });
        let height: i64 = position.iter().map(|q| q * q).sum();
        let delta = BigInt::from(1) << (one - DELTA * (rank + 1));
        coordinates.chain([(BigInt::from(height) << one) + delta, BigInt::from(1) << one]).collect()
    };
    vertices.iter().map(row).collect()
}

/// The rows with the interior point as the origin.
fn translated<const D: usize>(mut rows: Vec<Vec<BigInt>>, interior: [i64; D]) -> Vec<Vec<BigInt>> {
    let one = EPSILON << (D * D - 1);
    for row in &mut rows {
        // |p − i|² = |p|² − 2 p·i + |i|², of the coordinates before they are lowered by less than a
        // half.
        let before = |x: &BigInt| (x + (BigInt::from(1) << (one - 1))) >> one;
        let shift: BigInt = (0..D).map(|axis| interior[axis] * (interior[axis] - 2 * before(&row[axis]))).sum();
        row[D] += shift << one;
        (0..D).for_each(|axis| row[axis] -= BigInt::from(interior[axis]) << one);
    }
    rows
}

/// The rows of an orientation, where infinity leans away from the interior point: with that point
/// as the origin, 1 + η·height in the place of 1.
pub fn leaning<const D: usize>(rows: Vec<Vec<BigInt>>, interior: [i64; D]) -> Vec<Vec<BigInt>> {
    let mut rows = translated(rows, interior);
    for row in &mut rows {
        let lean = &row[D] >> ETA;
        row[D + 1] += lean;
    }
    rows
}

/// The rows of an in-sphere determinant, with the interior point as the origin and 1 + ζ in the place of 1:
/// of the points in this order, the first one moves furthest towards it.
pub fn nearer<const D: usize>(rows: Vec<Vec<BigInt>>, interior: [i64; D], order: &[usize]) -> Vec<Vec<BigInt>> {
    let one = EPSILON << (D * D - 1);
    let mut rows = translated(rows, interior);
    for (k, &i) in order.iter().enumerate() {
        rows[i][D + 1] += BigInt::from(1) << (one - ZETA * (2 + k));
    }
    rows
}

/// The sign of the determinant of these columns.
pub fn sign_of_columns(rows: &[Vec<BigInt>], columns: &[usize]) -> Sign {
    let rows: Vec<Vec<BigInt>> = rows.iter().map(|row| columns.iter().map(|&c| row[c].clone()).collect()).collect();
    oracle::sign(&oracle::determinant(&rows))
}
