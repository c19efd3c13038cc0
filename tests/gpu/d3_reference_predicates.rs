//! The reference of the GPU's predicates: its ties are those of a perturbation that is carried out.

use crate::perturbation::{leaning, nearer, perturbed_rows, sign_of_columns};
use gdel::internals::{gpu::start::first_simplex, input::lattice::Width, predicates::Sign};
use gdel_reference::{
    d3::predicates::{self as reference, Vertex},
    insphere_symbolic,
};
use num_bigint::BigInt;
use rand::{Rng, RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;
use std::cmp::Reverse;

/// (x, y, z, height, 1), perturbed.
fn rows(vertices: &[Vertex]) -> Vec<Vec<BigInt>> {
    perturbed_rows(&vertices.iter().map(|v| (v.index, v.position)).collect::<Vec<_>>())
}

fn perturbed_orient3d(vertices: [Vertex; 4], interior: Vertex) -> Sign {
    -sign_of_columns(&leaning(rows(&vertices), interior.position), &[0, 1, 2, 4])
}

fn perturbed_insphere(vertices: [Vertex; 5], rounds: [u32; 5], interior: Vertex) -> Sign {
    let mut order = [0, 1, 2, 3, 4];
    order.sort_unstable_by_key(|&k: &usize| (Reverse(rounds[k]), vertices[k].index));
    -sign_of_columns(&nearer(rows(&vertices), interior.position, &order), &[0, 1, 2, 3, 4])
}

/// Rounds of which some are the same.
fn rounds(rng: &mut impl Rng) -> [u32; 5] {
    std::array::from_fn(|_| rng.random_range(0..3))
}

/// A point of a grid of `side`³, with an index above all others.
fn interior_point(side: i64, rng: &mut impl Rng) -> Vertex {
    Vertex { position: std::array::from_fn(|_| rng.random_range(0..side)), index: u32::MAX }
}

/// Points of a grid of `side`³ with indices in no order.
fn vertices<const N: usize>(side: i64, rng: &mut impl Rng) -> [Vertex; N] {
    let mut indices: Vec<u32> = (0..N as u32).collect();
    indices.shuffle(rng);
    std::array::from_fn(|i| Vertex {
        position: std::array::from_fn(|_| rng.random_range(0..side)),
        index: indices[i] * 1000,
    })
}

/// Points on grids so small that they are often coplanar, collinear or equal.
#[test]
fn ties_are_those_of_the_perturbation() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    for i in 0..600 {
        let side = 1 + i % 4;
        let four = vertices(side, &mut rng);
        let interior = interior_point(side, &mut rng);
        let expected = perturbed_orient3d(four, interior);
        assert_ne!(expected, 0);
        for width in [Width::Narrow, Width::Wide] {
            assert_eq!(reference::orient3d(width, four, interior), expected, "{four:?}, {interior:?}");
        }
        let five = vertices(side, &mut rng);
        let rounds = rounds(&mut rng);
        let expected = perturbed_insphere(five, rounds, interior);
        assert_ne!(expected, 0);
        for width in [Width::Narrow, Width::Wide] {
            let sign = reference::insphere(width, five, rounds, interior);
            assert_eq!(sign, expected, "{five:?}, {rounds:?}, {interior:?}");
        }
    }
}

#[test]
fn exchanging_two_arguments_changes_the_sign() {
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    for _ in 0..2000 {
        let five: [Vertex; 5] = vertices(3, &mut rng);
        let four = [five[0], five[1], five[2], five[3]];
        let (interior, rounds) = (interior_point(3, &mut rng), rounds(&mut rng));
        for (i, j) in [(0, 1), (1, 2), (0, 3), (2, 3)] {
            let mut exchanged = four;
            exchanged.swap(i, j);
            assert_eq!(
                reference::orient3d(Width::Wide, exchanged, interior),
                -reference::orient3d(Width::Wide, four, interior),
                "{four:?}"
            );
        }
        for (i, j) in [(0, 1), (1, 2), (0, 4), (3, 4)] {
            let (mut exchanged, mut their_rounds) = (five, rounds);
            exchanged.swap(i, j);
            their_rounds.swap(i, j);
            assert_eq!(
                reference::insphere(Width::Narrow, exchanged, their_rounds, interior),
                -reference::insphere(Width::Narrow, five, rounds, interior),
                "{five:?}"
            );
        }
    }
}

/// Where the points are not all coplanar, the heights decide, as they do in the definition of the
/// triangulation.
#[test]
fn heights_come_before_lowered_coordinates() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let mut compared = 0;
    for _ in 0..5000 {
        let five: [Vertex; 5] = vertices(3, &mut rng);
        let defined = insphere_symbolic(five.map(|v| (v.index, v.position.map(|q| q as f64))));
        if defined != 0 {
            let (rounds, interior) = (rounds(&mut rng), interior_point(3, &mut rng));
            assert_eq!(reference::insphere(Width::Narrow, five, rounds, interior), defined, "{five:?}");
            compared += 1;
        }
    }
    assert!(compared > 3000, "{compared}");
}

/// All sets of four of `n`.
fn fours(n: usize) -> impl Iterator<Item = [usize; 4]> {
    (0..n).flat_map(move |a| {
        (a + 1..n).flat_map(move |b| (b + 1..n).flat_map(move |c| (c + 1..n).map(move |d| [a, b, c, d])))
    })
}

/// The perturbed points have a triangulation with no ties at all: the one that the crate promises.
/// Infinity, which leans away from a point inside, is outside of all its spheres, and so none of
/// its tetrahedra is flat.
#[test]
fn the_perturbed_triangulation_is_the_answer() {
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let mut coplanar = 0;
    for i in 0..200 {
        let side = 2 + i % 3;
        // With room for the interior point.
        let mut points: Vec<[i64; 3]> =
            (0..9).map(|_| std::array::from_fn(|_| 4 * rng.random_range(0..side))).collect();
        points.sort_unstable();
        points.dedup();
        points.shuffle(&mut rng);
        let Some(start) = first_simplex(Width::Narrow, points.len(), |i| points[i]) else { continue };
        let interior = Vertex { position: start.interior_point, index: u32::MAX };
        let vertex = |i: usize| Vertex { position: points[i], index: i as u32 };
        // In whatever order they were inserted.
        let rounds: Vec<u32> = points.iter().map(|_| rng.random_range(0..4)).collect();
        let coordinates = |i: usize| points[i].map(|q| q as f64);
        let is_flat = |t: [usize; 4]| {
            let [a, b, c, d] = t.map(coordinates);
            gdel::internals::predicates::orient3d(a, b, c, d) == 0
        };
        let others = |t: [usize; 4]| (0..points.len()).filter(move |p| !t.contains(p));
        let perturbed: Vec<_> = fours(points.len())
            .filter(|&t| {
                let [a, b, c, d] = t.map(vertex);
                let orientation = reference::orient3d(Width::Narrow, [a, b, c, d], interior);
                others(t).all(|e| {
                    let five = [t[0], t[1], t[2], t[3], e];
                    let rounds = five.map(|i| rounds[i]);
                    reference::insphere(Width::Narrow, five.map(vertex), rounds, interior) == -orientation
                })
            })
            .collect();
        let promised: Vec<_> = fours(points.len())
            .filter(|&t| !is_flat(t))
            .filter(|&t| {
                let [a, b, c, d] = t.map(coordinates);
                let orientation = gdel::internals::predicates::orient3d(a, b, c, d);
                others(t).all(|e| {
                    let five = [t[0], t[1], t[2], t[3], e].map(|i| (i as u32, coordinates(i)));
                    insphere_symbolic(five) == -orientation
                })
            })
            .collect();
        coplanar += fours(points.len()).filter(|&t| is_flat(t)).count();
        assert_eq!(perturbed, promised, "{points:?}");
    }
    assert!(coplanar > 1000, "{coplanar}");
}
