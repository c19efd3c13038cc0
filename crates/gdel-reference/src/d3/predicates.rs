//! The reference of `shaders/d3/perturbed.wgsl`, which explains how ties are broken.
//!
//! The signs agree; the way to them differs: fixed-width integers of the CPU decide nearly
//! everything, and big integers what is left to the lowered coordinates.

use num_bigint::BigInt;
use std::cmp::Reverse;

use crate::ties::{by_index, sign_of};
use gdel::internals::{
    input::lattice::Width,
    predicates::{Sign, integer, symbolic},
};

/// A lattice point with its input index.
pub type Vertex = crate::Vertex<3>;

/// The sets of coordinates to lower: 3·rank + (z: 0, y: 1, x: 2) is the bit of one coordinate.
const PERTURBATIONS: [u32; 15] = [0, 1, 2, 4, 8, 10, 12, 16, 20, 32, 64, 66, 68, 80, 84];

/// Returns the position of the point of this rank with the coordinates in `set` lowered.
fn lowered(position: [i64; 3], set: u32, rank: usize) -> [i64; 3] {
    let bits = set >> (3 * rank);
    std::array::from_fn(|axis| position[axis] - i64::from(bits >> (2 - axis) & 1))
}

fn orient3d_at(width: Width, [a, b, c, d]: [[i64; 3]; 4]) -> Sign {
    match width {
        Width::Narrow => integer::orient3d_narrow(a, b, c, d),
        Width::Wide => integer::orient3d_wide(a, b, c, d),
    }
}

/// Returns the sign of det(b − a, c − a, d − a), with ties broken: never 0 for vertices with
/// different indices. Infinity leans away from `interior`, a point with an index above theirs,
/// which may also be one of them.
pub fn orient3d(width: Width, vertices: [Vertex; 4], interior: Vertex) -> Sign {
    let orientation = |positions: [[i64; 3]; 5]| orient3d_at(width, symbolic::without(positions, 4));
    let [a, b, c, d] = vertices;
    perturbed(width, [a, b, c, d, interior], orientation, |_| 0)
}

/// Returns the sign of e against the sphere through the positively oriented a, b, c, d, positive
/// inside, with ties broken: never 0 for vertices with different indices.
///
/// The vertices were inserted in `rounds`; `interior` is a point with an index above theirs.
pub fn insphere(width: Width, vertices: [Vertex; 5], rounds: [u32; 5], interior: Vertex) -> Sign {
    let positions = vertices.map(|v| v.position);
    let mut latest_first = [0, 1, 2, 3, 4];
    latest_first.sort_unstable_by_key(|&k: &usize| (Reverse(rounds[k]), vertices[k].index));
    let by_round = |lower: [[i64; 3]; 5]| {
        let mut signs = latest_first.into_iter().map(|k| {
            // The interior point comes last, and the last one to the place of the one that is left out.
            let positions = exchanged(positions, k, interior.position);
            let lower = exchanged(lower, k, interior.position);
            let indices = exchanged(vertices.map(|v| v.index), k, interior.index);
            let sign = match lifted(positions, lower) {
                0 => heights(width, indices, lower),
                sign => sign,
            };
            if k == 4 { sign } else { -sign }
        });
        signs.find(|&sign| sign != 0).unwrap_or(0)
    };
    perturbed(width, vertices, |_| 0, by_round)
}

/// Returns the first sign that is not 0, over all sets of coordinates to lower: that of `first`, of
/// the in-sphere determinant, of the heights in it, and of `last`.
fn perturbed(
    width: Width,
    vertices: [Vertex; 5],
    first: impl Fn([[i64; 3]; 5]) -> Sign,
    last: impl Fn([[i64; 3]; 5]) -> Sign,
) -> Sign {
    let positions = vertices.map(|v| v.position);
    let order = by_index(&vertices);
    let sign_at = |set: u32| {
        let mut lower = positions;
        for (rank, &i) in order.iter().enumerate() {
            lower[i] = lowered(positions[i], set, rank);
        }
        let in_sphere = || if set == 0 { insphere_at(width, positions) } else { lifted(positions, lower) };
        let by_heights = || heights(width, vertices.map(|v| v.index), lower);
        let nonzero = |sign: Sign| (sign != 0).then_some(sign);
        let sign = nonzero(first(lower)).or_else(|| nonzero(in_sphere())).or_else(|| nonzero(by_heights()));
        sign.or_else(|| nonzero(last(lower)))
    };
    PERTURBATIONS.into_iter().find_map(sign_at).unwrap_or(0)
}

/// Returns the five with the last one in the place of the one that is left out, and `interior` last.
fn exchanged<T: Copy>(mut five: [T; 5], left_out: usize, interior: T) -> [T; 5] {
    five[left_out] = five[4];
    five[4] = interior;
    five
}

/// Returns the sign that the heights give to an in-sphere determinant that is 0.
fn heights(width: Width, indices: [u32; 5], positions: [[i64; 3]; 5]) -> Sign {
    symbolic::break_tie(indices, |k| orient3d_at(width, symbolic::without(positions, k)))
}

fn insphere_at(width: Width, [a, b, c, d, e]: [[i64; 3]; 5]) -> Sign {
    match width {
        Width::Narrow => integer::insphere_narrow(a, b, c, d, e),
        Width::Wide => integer::insphere_wide(a, b, c, d, e),
    }
}

/// Returns the sign of the in-sphere determinant of the positions `lowered`, with the heights of
/// `positions`.
fn lifted(positions: [[i64; 3]; 5], lowered: [[i64; 3]; 5]) -> Sign {
    let big = |p: [i64; 3], q: [i64; 3]| -> [BigInt; 3] { std::array::from_fn(|axis| BigInt::from(p[axis] - q[axis])) };
    let [a, b, c, d]: [_; 4] = std::array::from_fn(|i| big(lowered[i], lowered[4]));
    let heights = positions.map(|p| big(p, positions[4]).iter().map(|x| x * x).sum::<BigInt>());
    let det = |u: &[BigInt; 3], v: &[BigInt; 3], w: &[BigInt; 3]| {
        &u[0] * (&v[1] * &w[2] - &v[2] * &w[1]) - &u[1] * (&v[0] * &w[2] - &v[2] * &w[0])
            + &u[2] * (&v[0] * &w[1] - &v[1] * &w[0])
    };
    let value = &heights[0] * det(&b, &c, &d) - &heights[1] * det(&a, &c, &d) + &heights[2] * det(&a, &b, &d)
        - &heights[3] * det(&a, &b, &c);
    sign_of(&value)
}
