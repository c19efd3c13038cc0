//! Minimum spanning trees, against Kruskal's algorithm on all pairs with exact lengths.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3};
use gdel::{
    Mesh, Points, SpanningTree,
    internals::geometry::{Euclidean, Geometry},
};
use num_bigint::BigInt;

/// Returns `x`·2¹⁰⁷⁴.
fn integer(x: f64) -> BigInt {
    let exponent = (x.to_bits() >> 52 & 0x7ff) as i32;
    let fraction = (x.to_bits() & ((1 << 52) - 1)) as i64;
    let magnitude =
        if exponent == 0 { BigInt::from(fraction) } else { BigInt::from(fraction | 1 << 52) << (exponent - 1) };
    if x < 0.0 { -magnitude } else { magnitude }
}

fn check<const D: usize, const N: usize>(name: &str, mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: Geometry<D, N>,
{
    let tree = SpanningTree::new(mesh, Points::F64(points)).unwrap();
    let exact: Vec<[BigInt; D]> = points.iter().map(|p| p.map(integer)).collect();
    let is_vertex = |i: &usize| mesh.duplicate_of()[*i] == gdel::NONE;
    let vertices: Vec<usize> = (0..points.len()).filter(is_vertex).collect();
    let mut pairs = Vec::new();
    for (i, &v) in vertices.iter().enumerate() {
        for &w in &vertices[i + 1..] {
            let squared: BigInt = (0..D).map(|k| (&exact[v][k] - &exact[w][k]) * (&exact[v][k] - &exact[w][k])).sum();
            pairs.push((squared, [v as u32, w as u32]));
        }
    }
    pairs.sort();
    let mut label: Vec<usize> = (0..points.len()).collect();
    // Duplicates come first, with edges of length 0.
    let duplicates = (0..).zip(mesh.duplicate_of()).filter(|&(_, &of)| of != gdel::NONE);
    let mut expected: Vec<[u32; 2]> = duplicates.map(|(i, &of)| [of, i]).collect();
    expected.sort_unstable();
    for (_, [v, w]) in &pairs {
        let (one, other) = (label[*v as usize], label[*w as usize]);
        if one != other {
            expected.push([*v, *w]);
            label.iter_mut().filter(|label| **label == other).for_each(|label| *label = one);
        }
    }
    assert_eq!(tree.edges, expected, "{name}");
    for (&[v, w], &length) in tree.edges.iter().zip(&tree.lengths) {
        let (p, q) = (points[v as usize], points[w as usize]);
        let largest = (0..D).fold(0.0, |m: f64, i| m.max((p[i] - q[i]).abs()));
        let exact = if largest == 0.0 {
            0.0
        } else {
            largest * (0..D).map(|i| ((p[i] - q[i]) / largest).powi(2)).sum::<f64>().sqrt()
        };
        assert!((length - exact).abs() <= 1e-14 * exact, "{name}: {length} {exact}");
    }
    assert!(tree.total_length() == tree.lengths.iter().sum::<f64>());

    // Clusters: equal labels for what the shorter edges connect.
    for count in [0, 1, 2, 7, points.len() + 3] {
        let labels = tree.clusters(count);
        let clusters = labels.iter().max().map_or(0, |&label| label as usize + 1);
        assert_eq!(clusters, count.clamp(1, vertices.len().max(1)).min(vertices.len()), "{name}");
        for (i, &d) in mesh.duplicate_of().iter().enumerate().filter(|&(_, &d)| d != gdel::NONE) {
            assert_eq!(labels[i], labels[d as usize], "{name}");
        }
        // Counted in the order of their first points.
        let mut highest = 0;
        for &label in &labels {
            assert!(label <= highest, "{name}");
            highest = highest.max(label + 1);
        }
    }
    if let Some(&length) = tree.lengths.get(tree.lengths.len() / 2) {
        let labels = tree.clusters_within(length);
        for (&[v, w], &l) in tree.edges.iter().zip(&tree.lengths) {
            assert_eq!(labels[v as usize] == labels[w as usize], l <= length, "{name}");
        }
    }
}

#[test]
fn trees_in_3d() {
    for (name, points) in inputs3() {
        check(name, &mesh3(&points), &points);
    }
}

#[test]
fn trees_in_2d() {
    for (name, points) in inputs2() {
        check(name, &mesh2(&points), &points);
    }
}

/// More edges than are sorted at once.
#[test]
fn a_large_grid_is_connected_by_its_shortest_edges() {
    let side = 150;
    let points: Vec<[f64; 2]> = (0..side * side).map(|i| [i % side, i / side].map(f64::from)).collect();
    let mesh = mesh2(&points);
    let tree = SpanningTree::new(&mesh, &points).unwrap();
    assert_eq!(tree.edges.len(), points.len() - 1);
    assert!(tree.lengths.iter().all(|&length| length == 1.0));
    assert!(tree.edges.is_sorted());
}
