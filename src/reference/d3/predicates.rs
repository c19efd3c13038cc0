//! The reference of `shaders/d3/predicates.wgsl`, which explains how ties are broken.
//!
//! The signs agree; the way to them differs: fixed-width integers of the CPU decide nearly
//! everything, and big integers what is left to the lowered coordinates.

use num_bigint::BigInt;

use crate::{
    d3::gpu::vertex::INFINITE,
    input::lattice::Width,
    predicates::{Sign, integer, symbolic},
    reference::ties::{by_index, sign_of},
};

/// A lattice point with its input index, or the vertex at infinity.
pub type Vertex = crate::reference::Vertex<3>;

impl Vertex {
    /// The vertex at infinity.
    pub const AT_INFINITY: Vertex = Vertex { position: [0; 3], index: INFINITE };
}

/// The sets of coordinates to lower: 3·rank + (z: 0, y: 1, x: 2) is the bit of one coordinate.
const PERTURBATIONS: [u32; 15] = [0, 1, 2, 4, 8, 10, 12, 16, 20, 32, 64, 66, 68, 80, 84];

/// Returns the position of the point of this rank with the coordinates in `set` lowered.
fn lowered(position: [i64; 3], set: u32, rank: usize) -> [i64; 3] {
    let bits = set >> (3 * rank);
    std::array::from_fn(|axis| position[axis] - i64::from(bits >> (2 - axis) & 1))
}

/// Returns the places of the vertices in the order of their indices, and the sign of that
/// permutation.
fn ranks<const N: usize>(vertices: [Vertex; N]) -> ([usize; N], Sign) {
    let order = by_index(&vertices);
    let inversions = (0..N).flat_map(|i| (0..i).map(move |j| (i, j))).filter(|&(i, j)| order[j] > order[i]).count();
    (order, if inversions % 2 == 0 { 1 } else { -1 })
}

fn orient3d_at(width: Width, [a, b, c, d]: [[i64; 3]; 4]) -> Sign {
    match width {
        Width::Narrow => integer::orient3d_narrow(a, b, c, d),
        Width::Wide => integer::orient3d_wide(a, b, c, d),
    }
}

/// Returns the sign of det(b − a, c − a, d − a), with ties broken: never 0 for vertices with
/// different indices.
pub fn orient3d(width: Width, vertices: [Vertex; 4]) -> Sign {
    match orient3d_at(width, vertices.map(|v| v.position)) {
        0 => {
            let (order, parity) = ranks(vertices);
            let sorted = order.map(|i| vertices[i].position);
            let lowered = |set| orient3d_at(width, std::array::from_fn(|rank| lowered(sorted[rank], set, rank)));
            parity * PERTURBATIONS.into_iter().map(lowered).find(|&sign| sign != 0).unwrap_or(0)
        }
        sign => sign,
    }
}

/// Returns the sign of e against the sphere through the positively oriented a, b, c, d, positive
/// inside, with ties broken: never 0 for vertices with different indices, one of which may be at
/// infinity.
pub fn insphere(width: Width, vertices: [Vertex; 5]) -> Sign {
    if let Some(k) = vertices.iter().position(|v| v.index == INFINITE) {
        let sign = orient3d(width, symbolic::without(vertices, k));
        return if k % 2 == 0 { -sign } else { sign };
    }
    let positions = vertices.map(|v| v.position);
    let [a, b, c, d, e] = positions;
    let sign = match width {
        Width::Narrow => integer::insphere_narrow(a, b, c, d, e),
        Width::Wide => integer::insphere_wide(a, b, c, d, e),
    };
    let by_heights = |positions| {
        symbolic::break_tie(vertices.map(|v| v.index), |k| orient3d_at(width, symbolic::without(positions, k)))
    };
    [sign, by_heights(positions)].into_iter().find(|&sign| sign != 0).unwrap_or_else(|| {
        let (order, _) = ranks(vertices);
        let lower = |set: u32| {
            let mut positions = positions;
            for (rank, &i) in order.iter().enumerate() {
                positions[i] = lowered(positions[i], set, rank);
            }
            positions
        };
        PERTURBATIONS
            .into_iter()
            .map(lower)
            .flat_map(|lower| [lifted(positions, lower), by_heights(lower)])
            .find(|&sign| sign != 0)
            .unwrap_or(0)
    })
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
