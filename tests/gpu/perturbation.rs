//! The perturbation that breaks ties, carried out in big integers.

use crate::oracle;
use gdel::internals::predicates::Sign;
use num_bigint::BigInt;

/// Exponents of two, for coordinates below 16: δᵢ = 2^(−16 (i + 1)) is small enough to leave every
/// determinant's sign alone, and the ε's, 2^(−256·2^bit), are small enough for every product of the
/// δ's and the ε's before them.
const DELTA: usize = 16;
const EPSILON: usize = 256;

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

/// The sign of the determinant of these columns.
pub fn sign_of_columns(rows: &[Vec<BigInt>], columns: &[usize]) -> Sign {
    let rows: Vec<Vec<BigInt>> = rows.iter().map(|row| columns.iter().map(|&c| row[c].clone()).collect()).collect();
    oracle::sign(&oracle::determinant(&rows))
}
