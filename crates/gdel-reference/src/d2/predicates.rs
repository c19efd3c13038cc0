//! The reference of `shaders/d2/predicates.wgsl`, in big integers.

use num_bigint::BigInt;

use crate::ties::{by_index, sign_of};
use gdel::internals::predicates::Sign;

/// A lattice point with its input index.
pub type Vertex = crate::Vertex<2>;

/// The sets of coordinates to lower: 2·rank + (y: 0, x: 1) is the bit of one coordinate.
const PERTURBATIONS: [u32; 5] = [0, 1, 2, 4, 6];

/// Returns the positions with the coordinates in `set` lowered.
fn lowered<const N: usize>(vertices: [Vertex; N], set: u32) -> [[i64; 2]; N] {
    let mut positions = vertices.map(|v| v.position);
    for (rank, i) in by_index(&vertices).into_iter().enumerate() {
        let bits = set >> (2 * rank);
        positions[i][0] -= i64::from(bits >> 1 & 1);
        positions[i][1] -= i64::from(bits & 1);
    }
    positions
}

fn cross(p: [i64; 2], q: [i64; 2]) -> i128 {
    i128::from(p[0]) * i128::from(q[1]) - i128::from(p[1]) * i128::from(q[0])
}

fn minus(p: [i64; 2], q: [i64; 2]) -> [i64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

/// Returns the sign of det(b − a, c − a): 0 for collinear points.
pub fn orient2d_exact([a, b, c]: [[i64; 2]; 3]) -> Sign {
    cross(minus(b, a), minus(c, a)).signum() as Sign
}

/// Returns the sign of det(b − a, c − a), with ties broken: never 0 for vertices with different
/// indices. Infinity leans away from `interior`, a point with an index above theirs, which may also
/// be one of them.
pub fn orient2d([a, b, c]: [Vertex; 3], interior: Vertex) -> Sign {
    perturbed([a, b, c, interior], |[a, b, c, _]| orient2d_exact([a, b, c]))
}

/// Returns the sign of d against the circle through the positively oriented a, b, c, positive
/// inside, with ties broken: never 0 for vertices with different indices.
pub fn incircle(vertices: [Vertex; 4]) -> Sign {
    perturbed(vertices, |_| 0)
}

/// Returns the first sign that is not 0, over all sets of coordinates to lower: that of `first`, of
/// the in-circle determinant, and of the heights in it.
fn perturbed(vertices: [Vertex; 4], first: impl Fn([[i64; 2]; 4]) -> Sign) -> Sign {
    let positions = vertices.map(|v| v.position);
    let heights = positions.map(|p| {
        let [x, y] = minus(p, positions[3]);
        i128::from(x) * i128::from(x) + i128::from(y) * i128::from(y)
    });
    let order = by_index(&vertices);
    let sign_in = |set: u32| {
        let lower @ [a, b, c, d] = lowered(vertices, set);
        let [p, q, r] = [minus(a, d), minus(b, d), minus(c, d)];
        let minors = [cross(q, r), cross(r, p), cross(p, q)];
        let volume: BigInt = (0..3).map(|k| BigInt::from(heights[k]) * BigInt::from(minors[k])).sum();
        let by_volume = sign_of(&volume);
        let coefficients = [minors[0], minors[1], minors[2], -minors.iter().sum::<i128>()];
        let by_height = order.into_iter().map(|k| coefficients[k].signum() as Sign);
        [first(lower), by_volume].into_iter().chain(by_height).find(|&sign| sign != 0)
    };
    PERTURBATIONS.into_iter().find_map(sign_in).unwrap_or(0)
}
