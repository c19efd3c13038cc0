//! Inputs of the kinds that have broken 2D triangulators: those of the issues that delaunator's
//! users have reported, and of the literature on robustness, made anew. On each the CPU engine, in
//! several insertion orders, and the GPU engine agree, and the exact verifier proves the mesh.

use crate::d2::engine;
use gdel::{
    Mesh2,
    internals::{Options, cpu::delaunay_in_order, input::order::Order},
    verify2d,
};
use pollster::block_on;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

/// The mesh of the engine `gpu`, which all others agree with.
fn agreed(points: &[[f64; 2]]) -> Mesh2 {
    let mesh = {
        let mut engine = engine();
        block_on(engine.triangulate(points.into(), &Options::default())).expect("triangulates")
    };
    let report = verify2d(points, &mesh).expect("finite points");
    assert!(report.passed(), "gpu:\n{report}");
    for order in [Order::default(), Order::Shuffled(1), Order::Shuffled(2)] {
        let other = delaunay_in_order::<2>(points.into(), &Options::default(), order).expect("triangulates");
        let report = verify2d(points, &other).expect("finite points");
        assert!(report.passed(), "cpu, {order:?}:\n{report}");
        assert_eq!(mesh.canonical(), other.canonical(), "{order:?}");
        assert_eq!((&mesh.hull, mesh.dimension), (&other.hull, other.dimension), "{order:?}");
        assert_eq!(mesh.duplicate_of, other.duplicate_of, "{order:?}");
    }
    mesh
}

/// The same, where the GPU must have done the work.
fn agreed_by_the_gpu(points: &[[f64; 2]]) -> Mesh2 {
    let mesh = agreed(points);
    assert_eq!(mesh.stats.fallback, None);
    mesh
}

fn rng(seed: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed)
}

/// `x` moved by this many steps to the next `f64`.
fn stepped(x: f64, steps: i64) -> f64 {
    (0..steps.abs()).fold(x, |x, _| if steps < 0 { x.next_down() } else { x.next_up() })
}

fn turned(p: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [p[0] * cos - p[1] * sin, p[0] * sin + p[1] * cos]
}

/// Delaunator's issue 11: half-edges did not always point to each other.
#[test]
fn a_few_points_of_small_integers() {
    for seed in 0..12 {
        let mut rng = rng(seed);
        let count = rng.random_range(7..40);
        let points: Vec<[f64; 2]> = (0..count).map(|_| [0; 2].map(|_| rng.random_range(0..1000u32).into())).collect();
        agreed_by_the_gpu(&points);
    }
}

/// Issue 13: flips at the boundary, on points of a circle.
#[test]
fn corners_of_a_regular_polygon() {
    for corners in [3, 4, 5, 8, 17, 64, 257] {
        let corner = |i: u32| TAU * f64::from(i) / f64::from(corners);
        let points: Vec<_> = (0..corners).map(|i| [1.0 + 3.0 * corner(i).cos(), 1.0 + 3.0 * corner(i).sin()]).collect();
        let mesh = agreed_by_the_gpu(&points);
        // Rounding puts none of them inside.
        assert_eq!(mesh.hull.len(), points.len());
        let with_centre: Vec<_> = points.iter().copied().chain([[1.0, 1.0]]).collect();
        agreed_by_the_gpu(&with_centre);
    }
}

/// Issue 24: missing edges in the drawing of a tree, most of whose points are in one column.
#[test]
fn a_tree_drawn_in_columns() {
    for seed in 0..6 {
        let mut rng = rng(seed);
        let columns: [(u32, usize); 4] = [(140, 1), (380, 40), (620, 6), (380, 25)];
        let points: Vec<[f64; 2]> = columns
            .into_iter()
            .flat_map(|(x, count)| vec![x; count])
            .map(|x| [f64::from(x), rng.random_range(80..350u32).into()])
            .collect();
        agreed_by_the_gpu(&points);
    }
}

/// Issue 43: a hull that was wrong by the orientations of points on parallel lines, rounded.
#[test]
fn rows_of_parallel_slanted_lines() {
    for (along, across) in
        [([37.92, -54.6173], [11.36, 7.9]), ([0.1, 0.3], [-0.7, 0.2]), ([1.0 / 3.0, 1.0 / 7.0], [-0.2, 0.9])]
    {
        let point = |i: u32| -> [f64; 2] {
            let (s, t) = (f64::from(i % 23), f64::from(i / 23));
            std::array::from_fn(|axis| -612.483_19 + s * along[axis] + t * across[axis])
        };
        agreed_by_the_gpu(&(0..23 * 9).map(point).collect::<Vec<_>>());
        agreed_by_the_gpu(&(0..23 * 2).map(point).collect::<Vec<_>>());
    }
}

/// Issue 44: an endless loop on the points of a scanner, in rows that nearly meet.
#[test]
fn rows_of_a_scan_in_single_precision() {
    let mut rng = rng(44);
    let mut points = Vec::new();
    for row in 0..60u32 {
        for column in 0..50u32 {
            let depth = 1.7 + 1e-3 * f64::from(row * row % 7);
            let noise = 2e-7 * rng.random::<f64>();
            let [x, y] = [f64::from(column) - 24.5, f64::from(row / 2) - 14.5].map(|x| depth * x / 525.0);
            points.push([x, y + noise].map(|x| f64::from(x as f32)));
        }
    }
    agreed_by_the_gpu(&points);
}

/// Issue 61: triangles across the whole of a grid that is turned by some degrees.
#[test]
fn a_grid_turned_by_degrees() {
    for (side, degrees) in [(8, [6.0, 88.207, 302.328]), (41, [1.0, 30.0, 211.17])] {
        for degrees in degrees {
            let square = |i: u32| turned([i % side, i / side].map(f64::from), degrees * TAU / 360.0);
            // Rounding to the lattice may fold the rows along the hull over each other.
            agreed(&(0..side * side).map(square).collect::<Vec<_>>());
        }
    }
}

/// Pull request 69: a thin triangle of geographic coordinates, its edges halved again and again.
#[test]
fn a_thin_triangle_with_midpoints() {
    let corners = [[-121.873_246_1, 37.512_790_4], [-121.873_011_7, 37.512_911_2], [-121.872_777_2, 37.513_032_1]];
    for halvings in 0..7 {
        let pieces = 1 << halvings;
        let mut points = Vec::new();
        for k in 0..3 {
            let [from, to]: [[f64; 2]; 2] = [corners[k], corners[(k + 1) % 3]];
            points.extend((0..pieces).map(|i| -> [f64; 2] {
                std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * f64::from(i) / f64::from(pieces))
            }));
        }
        agreed(&points);
    }
}

/// Issue 94: points were left out that are nearly those of others.
#[test]
fn points_one_rounding_step_from_others() {
    let mut rng = rng(94);
    let mut points: Vec<[f64; 2]> = (0..30).map(|_| [0; 2].map(|_| 0.06 * rng.random::<f64>())).collect();
    for i in 0..30 {
        let [x, y] = points[i];
        points.push([stepped(x, rng.random_range(-2..=2)), stepped(y, rng.random_range(-2..=2))]);
        points.push([x, 5.2e-18 * rng.random::<f64>()]);
        points.push([stepped(x, 1), -4.8e-18 * rng.random::<f64>()]);
    }
    let mesh = agreed_by_the_gpu(&points);
    let used: std::collections::HashSet<u32> = mesh.triangles.iter().flatten().copied().collect();
    assert_eq!(used.len(), points.len() - mesh.duplicate_count());
}

/// The test `robustness`: outlines with nearly equal points, at sizes for which absolute tolerances
/// fail.
#[test]
fn an_outline_at_many_scales() {
    let mut rng = rng(1);
    let mut outline: Vec<[f64; 2]> = Vec::new();
    for i in 0..400 {
        let angle = TAU * f64::from(i) / 400.0;
        let radius = 66.0 + 9.0 * (5.0 * angle).sin() + rng.random::<f64>();
        let p = turned([radius, 0.0], angle).map(|x| x + 103.4);
        outline.push(p);
        if i % 3 == 0 {
            // The ends of two pieces, which should be one point.
            outline.push([p[0] + 1.4e-14, p[1] - 1.4e-14]);
        }
    }
    for scale in [1.0, 1e-9, 1e-2, 1e2, 1e9] {
        let scaled: Vec<_> = outline.iter().map(|p| p.map(|x| x * scale)).collect();
        agreed_by_the_gpu(&scaled);
        agreed_by_the_gpu(&scaled[..100]);
    }
}

/// Pull request 28: directions of which one component is lost beside the other.
#[test]
fn points_beside_an_axis() {
    let mut points = Vec::new();
    for i in 1..60 {
        let x = 0.071 * f64::from(i);
        let y = 6.938_893_903_907e-18 * f64::from(i % 4);
        points.extend([[x, y], [-x, y], [y, x], [y, -x]]);
    }
    agreed_by_the_gpu(&points);
}

/// Kettner, Mehlhorn, Pion, Schirra and Yap, *Classroom examples of robustness problems in
/// geometric computations* (2008): every point that is some steps of `f64` from (0.5, 0.5), and two
/// points of the diagonal.
#[test]
fn all_points_next_to_one_half_and_two_of_the_diagonal() {
    for (on_line, side) in [([12.0, 24.0], 16), ([17.3, 24.000_000_000_000_05], 12), ([8.8, 12.1], 12)] {
        let next_to = |i: i32| 0.5 + f64::from(i) / (1u64 << 53) as f64;
        let grid = (0..side * side).map(|i| [next_to(i % side), next_to(i / side)]);
        let points: Vec<_> = grid.chain(on_line.map(|x| [x, x])).collect();
        agreed(&points);
        // Symmetric about the diagonal, which passes through the grid.
        let negative: Vec<_> = points.iter().copied().chain(on_line.map(|x| [-x, -x])).collect();
        agreed(&negative);
    }
}

/// The convex hull of the same paper begins with three points that are nearly collinear; here they
/// come in crowds.
#[test]
fn points_some_steps_off_a_line() {
    for seed in 0..4 {
        let mut rng = rng(seed);
        let mut points: Vec<[f64; 2]> = (0..300)
            .map(|_| {
                let x = rng.random::<f64>();
                [x, stepped(0.3 * x + 0.1, rng.random_range(-2..=2))]
            })
            .collect();
        agreed(&points);
        points.extend([[0.0, 1.0], [1.0, -1.0]]);
        agreed_by_the_gpu(&points);
    }
}

/// As in the pictures of Shewchuk's lecture notes: in-circle tests that rounding decides either
/// way.
#[test]
fn points_some_steps_off_a_circle() {
    for seed in 0..3 {
        let mut rng = rng(seed);
        let points: Vec<[f64; 2]> = (0..400)
            .map(|_| turned([1.0, 0.0], TAU * rng.random::<f64>()).map(|x| stepped(x, rng.random_range(-2..=2))))
            .collect();
        agreed_by_the_gpu(&points);
        let centre: Vec<_> = (0..9).map(|i| [i % 3 - 1, i / 3 - 1].map(|k| f64::from(k) * 5e-324)).collect();
        agreed_by_the_gpu(&[points, centre].concat());
    }
}

/// On a line but for what rounding the coordinates made of it: not collinear, and as thin as can
/// be.
#[test]
fn multiples_of_decimal_fractions() {
    for [x, y] in [[0.1, 0.3], [1.1, 2.2], [0.7, -0.1], [1e-3, 1e3]] {
        let points: Vec<_> = (0..200).map(|i| [x * f64::from(i), y * f64::from(i)]).collect();
        agreed(&points);
    }
}

/// Exactly collinear in every direction, in any order, with duplicates: no triangles, and no crash.
#[test]
fn collinear_points() {
    let mut rng = rng(20);
    for [dx, dy] in [[1, 0], [0, 1], [1, 1], [-3, 5], [7, 2]] {
        let points: Vec<_> = (0..60)
            .map(|_| rng.random_range(-40..40))
            .map(|t| [dx * t, dy * t].map(|x: i32| f64::from(x) * 0.375))
            .collect();
        let mesh = agreed(&points);
        assert_eq!((mesh.dimension, mesh.triangles.len()), (1, 0));
    }
    for equal in [vec![[0.1, 0.2]; 5], vec![[0.0, 0.0], [-0.0, 0.0]], vec![[1e308, -1e308]]] {
        assert_eq!(agreed(&equal).dimension, 0);
    }
}

/// Where the offset leaves only a few bits for what varies.
#[test]
fn small_shapes_far_from_the_origin() {
    let mut rng = rng(9);
    for offset in [1e6, 1e9, 1e12, 4e15] {
        let points: Vec<[f64; 2]> =
            (0..500).map(|_| [0; 2].map(|_| offset + 40.0 * rng.random::<f64>() * (1.0 + offset * 1e-15))).collect();
        agreed_by_the_gpu(&points);
    }
}

/// Exponents from one end of `f64` to the other: no lattice holds them all.
#[test]
fn coordinates_of_all_sizes() {
    let mut rng = rng(3);
    let points: Vec<[f64; 2]> = (0..200)
        .map(|_| {
            [0; 2].map(|_| {
                let size = f64::from_bits(u64::from(rng.random_range(0..2046u32)) << 52);
                if rng.random() { size } else { -size }
            })
        })
        .collect();
    agreed(&points);
    let spiral: Vec<_> = (0..300).map(|i| turned([0.9f64.powi(i), 0.0], 0.3 * f64::from(i))).collect();
    agreed_by_the_gpu(&spiral);
}
