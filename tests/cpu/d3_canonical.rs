//! The 3D triangulation on the CPU is the one that the definition names, and no other.

use crate::oracle::{Definition, definition};
use gdel::{
    delaunay3d,
    internals::{Options, cpu::delaunay_in_order, input::order::Order},
    verify3d,
};
use proptest::prelude::*;

/// Checks that the mesh is that of the definition, for several insertion orders, and that the
/// verifier agrees.
fn check(points: &[[f64; 3]]) -> Result<(), TestCaseError> {
    let expected = definition(points);
    let orders = [Order::default(), Order::Shuffled(1), Order::Shuffled(2)];
    for order in orders {
        let mesh = delaunay_in_order::<3>(points.into(), &Options::default(), order)?;
        let tetrahedra = mesh.canonical();
        let report = verify3d(points, &mesh)?;
        let found = Definition { tetrahedra, duplicate_of: mesh.duplicate_of, dimension: mesh.dimension };
        prop_assert_eq!(&found, &expected, "{:?}", order);
        prop_assert!(report.passed(), "{order:?}:\n{report}");
    }
    Ok(())
}

/// Random points of the integer grid with `side` points along each axis, duplicates included.
fn grid(side: u8) -> impl Strategy<Value = [f64; 3]> {
    [0..side, 0..side, 0..side].prop_map(|p| p.map(f64::from))
}

/// All integer points at a given squared distance from the origin.
fn sphere(squared_radius: i32) -> impl Strategy<Value = [f64; 3]> {
    let range = || -10..=10;
    let all = range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z])));
    let on: Vec<_> = all.filter(|p| p.iter().map(|x| x * x).sum::<i32>() == squared_radius).collect();
    prop::sample::select(on).prop_map(|p| p.map(f64::from))
}

/// Small integers at scales that are far apart: no lattice represents them all.
fn mixed_scales() -> impl Strategy<Value = [f64; 3]> {
    let scale = prop::sample::select(vec![f64::from_bits(1), 1e-300, f64::MIN_POSITIVE, 1.0, 3e7, 1e300]);
    (prop::array::uniform3(-3i8..=3), scale).prop_map(|(p, scale)| p.map(|x| f64::from(x) * scale))
}

/// Any finite numbers.
fn any_finite() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(any::<f64>().prop_filter("finite", |x| x.is_finite()))
}

/// Points of a small grid, some of which are off by one rounding step.
fn nearly_grid() -> impl Strategy<Value = [f64; 3]> {
    let coordinate =
        (1..4u8, -1..=1i64).prop_map(|(x, steps)| f64::from_bits(f64::from(x).to_bits().wrapping_add_signed(steps)));
    [coordinate.clone(), coordinate.clone(), coordinate]
}

/// Points on the line through two small integer points.
fn line() -> impl Strategy<Value = Vec<[f64; 3]>> {
    let ends = [prop::array::uniform3(-4..=4i8), prop::array::uniform3(-4..=4i8)];
    (ends, prop::collection::vec(-9..=9i8, 0..16)).prop_map(|([origin, step], multiples)| {
        let at = |t: i8| std::array::from_fn(|i| f64::from(origin[i]) + f64::from(t) * f64::from(step[i]));
        multiples.into_iter().map(at).collect()
    })
}

/// Points in a plane through small integer points, and up to two points that may be off it.
fn plane() -> impl Strategy<Value = Vec<[f64; 3]>> {
    let frame = [prop::array::uniform3(-3..=3i8), prop::array::uniform3(-3..=3i8), prop::array::uniform3(-3..=3i8)];
    let inside = prop::collection::vec([-3..=3i8, -3..=3i8], 0..14);
    (frame, inside, prop::collection::vec(grid(3), 0..=2)).prop_map(|([origin, u, v], inside, off)| {
        let at = |[s, t]: [i8; 2]| {
            std::array::from_fn(|i| {
                f64::from(origin[i]) + f64::from(s) * f64::from(u[i]) + f64::from(t) * f64::from(v[i])
            })
        };
        inside.into_iter().map(at).chain(off).collect()
    })
}

/// At most `max` points.
fn some(point: impl Strategy<Value = [f64; 3]>, max: usize) -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec(point, 0..=max)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn points_of_a_grid_of_side_2(points in some(grid(2), 12)) { check(&points)? }

    #[test]
    fn points_of_a_grid_of_side_3(points in some(grid(3), 18)) { check(&points)? }

    #[test]
    fn points_of_a_grid_of_side_5(points in some(grid(5), 18)) { check(&points)? }

    #[test]
    fn points_of_a_sphere(points in prop::sample::select(vec![9, 26, 41, 65]).prop_flat_map(|r| some(sphere(r), 18))) {
        check(&points)?;
    }

    #[test]
    fn points_of_a_line(points in line()) { check(&points)? }

    #[test]
    fn points_of_a_plane(points in plane()) { check(&points)? }

    #[test]
    fn points_of_mixed_scales(points in some(mixed_scales(), 12)) { check(&points)? }

    #[test]
    fn points_of_any_finite_numbers(points in some(any_finite(), 12)) { check(&points)? }

    #[test]
    fn points_one_rounding_step_off_a_grid(points in some(nearly_grid(), 14)) { check(&points)? }

    #[test]
    fn points_of_a_grid_and_of_another_scale(points in some(prop_oneof![grid(3), mixed_scales()], 12)) {
        check(&points)?;
    }
}

#[test]
fn forty_points_of_a_grid() {
    let points: Vec<_> = (0..40).map(|i| [i % 3, i / 3 % 4, i / 12].map(f64::from)).collect();
    check(&points).unwrap();
}

#[test]
fn whole_grids_in_any_order_of_the_indices() {
    let cube: Vec<_> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
    let grid: Vec<_> = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(f64::from)).collect();
    for step in [1, 3, 5, 7] {
        let permuted =
            |points: &[[f64; 3]]| (0..points.len()).map(|i| points[i * step % points.len()]).collect::<Vec<_>>();
        check(&permuted(&cube)).unwrap();
        // Multiples of 3 permute the grid only together with the duplicates that they make.
        check(&permuted(&grid)).unwrap();
    }
}

/// Results of another program for the same definition, `canonical.py` beside them.
#[test]
fn fixtures() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/canonical");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "xyz") {
            continue;
        }
        let points: Vec<[f64; 3]> = rows(&path);
        let expected: Vec<[u32; 4]> = rows(&path.with_extension("tetrahedra"));
        assert!(!expected.is_empty());
        assert_eq!(delaunay3d(&points).unwrap().canonical(), expected, "{}", path.display());
        assert_eq!(definition(&points).tetrahedra, expected, "{}", path.display());
        count += 1;
    }
    assert!(count >= 6, "{count} fixtures");
}

fn rows<T: std::str::FromStr<Err: std::fmt::Debug>, const N: usize>(path: &std::path::Path) -> Vec<[T; N]> {
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let values: Vec<T> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        values.try_into().ok().expect("a row of the right length")
    };
    text.lines().map(row).collect()
}
