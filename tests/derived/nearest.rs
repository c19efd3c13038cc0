//! Nearest vertices, against all distances in big integers.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3, queries};
use gdel::{
    Locator, Mesh, Points,
    internals::geometry::{Euclidean, Geometry},
};
use num_bigint::BigInt;

/// Returns `x`·2¹⁰⁷⁴.
pub fn integer(x: f64) -> BigInt {
    let exponent = (x.to_bits() >> 52 & 0x7ff) as i32;
    let fraction = (x.to_bits() & ((1 << 52) - 1)) as i64;
    let magnitude =
        if exponent == 0 { BigInt::from(fraction) } else { BigInt::from(fraction | 1 << 52) << (exponent - 1) };
    if x < 0.0 { -magnitude } else { magnitude }
}

pub fn check<const D: usize, const N: usize>(name: &str, mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: Geometry<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap();
    // Every third one.
    let queries: Vec<_> = queries(points).into_iter().step_by(3).collect();
    let nearest = locator.nearest_many(Points::F64(&queries)).unwrap();
    let exact: Vec<[BigInt; D]> = points.iter().map(|p| p.map(integer)).collect();
    let is_vertex = |i: &usize| mesh.duplicate_of()[*i] == gdel::NONE;
    for (&q, &nearest) in queries.iter().zip(&nearest) {
        let exact_q = q.map(integer);
        let distance = |i: usize| -> BigInt { exact[i].iter().zip(&exact_q).map(|(x, y)| (x - y) * (x - y)).sum() };
        let mut expected: Vec<(BigInt, u32)> =
            (0..points.len()).filter(is_vertex).map(|i| (distance(i), i as u32)).collect();
        expected.sort();
        let expected: Vec<u32> = expected.into_iter().map(|(_, i)| i).collect();
        assert_eq!(nearest, expected.first().copied(), "{name}: {q:?}");
        assert_eq!(locator.nearest(q).unwrap(), nearest, "{name}: {q:?}");
        for k in [0, 1, 7, 40, points.len() + 1] {
            assert_eq!(locator.nearest_k(q, k).unwrap(), expected[..k.min(expected.len())], "{name}: {q:?}");
        }
    }
}

#[test]
fn nearest_vertices_in_3d() {
    for (name, points) in inputs3() {
        check(name, &mesh3(&points), &points);
    }
}

#[test]
fn nearest_vertices_in_2d() {
    for (name, points) in inputs2() {
        check(name, &mesh2(&points), &points);
    }
}
