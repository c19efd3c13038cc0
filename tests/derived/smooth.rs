//! Smooth interpolation: gradients, continuity, flat points, grids and tables of weights.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3, queries};
use gdel::{
    Error, Grid, Interpolation, Interpolator, Locator, Mesh, Outside, Points,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        derived::StolenMeasures,
        geometry::Euclidean,
    },
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const SMOOTH: [Interpolation; 2] = [Interpolation::SibsonC1, Interpolation::CloughTocher];

fn methods<const D: usize>(is_flat: bool) -> &'static [Interpolation] {
    if D == 2 || is_flat { &SMOOTH } else { &SMOOTH[..1] }
}

/// Linear functions, the values of vertices, and one query after the other, on inputs of all kinds.
fn check<const D: usize, const N: usize>(name: &str, mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: StolenMeasures<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap();
    let queries: Vec<_> = queries(points).into_iter().step_by(4).collect();
    let largest = points.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE);
    let linear = |p: &[f64; D]| p.iter().zip([0.5, -0.25, 0.125]).map(|(x, a)| x / largest * a).sum::<f64>() + 0.25;
    let values: Vec<f64> = points.iter().map(linear).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    // Values are rounded, and so are slopes along edges between points that are near each other.
    let mut bound = 1e-10;
    if !mesh.simplices().is_empty() {
        let vertices = (0..points.len()).filter(|&i| mesh.duplicate_of()[i] == gdel::NONE);
        let error = |i: usize| {
            let gradient = interpolator.gradients()[i];
            (0..D).map(|axis| (gradient[axis] * largest - [0.5, -0.25, 0.125][axis]).abs()).fold(0.0, f64::max)
        };
        let error = vertices.map(error).fold(0.0, f64::max);
        assert!(error < 1e-6, "{name}: {error}");
        bound += 6.0 * error;
    }
    for &method in methods::<D>(mesh.simplices().is_empty()) {
        let found = interpolator.interpolate_many(method, Points::F64(&queries)).unwrap().values;
        let plain = interpolator.interpolate_many(Interpolation::Linear, Points::F64(&queries)).unwrap().values;
        for ((q, found), plain) in queries.iter().zip(found).zip(plain) {
            let at = || format!("{name} {method:?}: {q:?}");
            assert_eq!(interpolator.interpolate(method, *q).unwrap().to_bits(), found.to_bits(), "{}", at());
            assert_eq!(found.is_nan(), plain.is_nan(), "{}: {found}", at());
            if !found.is_nan() {
                assert!((found - linear(q)).abs() <= bound, "{}: {found} instead of {}", at(), linear(q));
            }
            if let Some(v) = points.iter().position(|p| p == q) {
                assert_eq!(found, values[v], "{}", at());
            }
        }
    }
}

#[test]
fn linear_functions_are_reproduced() {
    for (name, points) in inputs2() {
        check(name, &mesh2(&points), &points);
    }
    for (name, points) in inputs3() {
        check(name, &mesh3(&points), &points);
    }
}

fn wave<const D: usize>(p: &[f64; D]) -> f64 {
    p.iter().zip([3.0, 4.0, 5.0]).map(|(x, a)| (a * x).sin()).sum()
}

/// Along random segments, neither values nor slopes jump: differences of slopes shrink with the step, except with
/// linear interpolation.
fn check_continuity<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: StolenMeasures<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap();
    let values: Vec<f64> = points.iter().map(wave).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let largest_jump = |method: Interpolation, step: f64| {
        let (mut random, mut largest) = (Pcg64Mcg::seed_from_u64(7), 0.0f64);
        for _ in 0..20 {
            let ends: [[f64; D]; 2] =
                std::array::from_fn(|_| std::array::from_fn(|_| 0.2 + 0.6 * random.random::<f64>()));
            let length = (0..D).map(|a| (ends[1][a] - ends[0][a]).powi(2)).sum::<f64>().sqrt();
            let count = (length / step) as usize;
            let along: Vec<[f64; D]> = (0..=count)
                .map(|i| std::array::from_fn(|a| ends[0][a] + (ends[1][a] - ends[0][a]) * i as f64 * step / length))
                .collect();
            let found = interpolator.interpolate_many(method, Points::F64(&along)).unwrap().values;
            let slopes: Vec<f64> = found.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect();
            largest = slopes.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(largest, f64::max);
        }
        largest
    };
    let ratio = |method| largest_jump(method, 1e-5) / largest_jump(method, 1e-4);
    assert!(ratio(Interpolation::Linear) > 0.5);
    for &method in methods::<D>(false) {
        assert!(ratio(method) < 0.2, "{method:?}: {}", ratio(method));
    }
}

#[test]
fn slopes_are_continuous() {
    let points = generate2d(Distribution2::Uniform, 300, 5);
    check_continuity(&mesh2(&points), &points);
    let points = generate3d(Distribution3::Uniform, 1000, 5);
    check_continuity(&mesh3(&points), &points);
}

/// The mean errors of smooth interpolation of a smooth function are a fraction of those of linear interpolation.
#[test]
fn smooth_functions_are_nearer_to_the_truth() {
    fn errors<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]])
    where
        Euclidean: StolenMeasures<D, N>,
    {
        let locator = Locator::new(mesh, Points::F64(points)).unwrap();
        let values: Vec<f64> = points.iter().map(wave).collect();
        let interpolator = Interpolator::new(&locator, &values).unwrap();
        let mut random = Pcg64Mcg::seed_from_u64(8);
        let queries: Vec<[f64; D]> =
            (0..2000).map(|_| std::array::from_fn(|_| 0.15 + 0.7 * random.random::<f64>())).collect();
        let error = |method| {
            let found = interpolator.interpolate_many(method, Points::F64(&queries)).unwrap().values;
            queries.iter().zip(found).map(|(q, found)| (wave(q) - found).abs()).sum::<f64>()
        };
        let linear = error(Interpolation::Linear);
        for &method in methods::<D>(false) {
            let smooth = error(method);
            assert!(smooth < 0.35 * linear, "{method:?}: {smooth} {linear}");
        }
    }
    let points = generate2d(Distribution2::Uniform, 1000, 6);
    errors(&mesh2(&points), &points);
    let points = generate3d(Distribution3::Uniform, 3000, 6);
    errors(&mesh3(&points), &points);
}

/// Points on a line: the gradients are those of the natural cubic spline.
#[test]
fn the_spline_of_points_on_a_line() {
    let xs = [0.0, 1.0, 2.5, 3.0, 5.0];
    let points: Vec<[f64; 3]> = xs.iter().map(|&x| [2.0 * x + 1.0, 2.0 * x, x]).collect();
    let values = [0.0, 1.0, -1.0, 2.0, 1.0];
    let mesh = mesh3(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let at = |x: f64| interpolator.interpolate(Interpolation::CloughTocher, [2.0 * x + 1.0, 2.0 * x, x]).unwrap();
    // Second derivatives from within each segment agree at its ends, and are 0 at the ends of all.
    let second = |x: f64, to: f64| {
        let h = (to - x) / 64.0;
        (2.0 * at(x) - 5.0 * at(x + h) + 4.0 * at(x + 2.0 * h) - at(x + 3.0 * h)) / (h * h)
    };
    assert!(second(xs[0], xs[1]).abs() < 1e-8 && second(xs[4], xs[3]).abs() < 1e-8);
    for i in 1..4 {
        let (before, after) = (second(xs[i], xs[i - 1]), second(xs[i], xs[i + 1]));
        assert!((before - after).abs() < 1e-7, "{before} {after}");
    }
    for gradient in interpolator.gradients() {
        // Nothing is known across the line.
        assert!((gradient[0] - gradient[1]).abs() < 1e-14 && (gradient[0] - 2.0 * gradient[2]).abs() < 1e-14);
    }
}

/// The same in a plane of space as in the plane.
#[test]
fn a_plane_of_space() {
    let points = generate2d(Distribution2::Uniform, 200, 9);
    // Turned without rounding, by integers whose rows have length 3, and so enlarged.
    let turned = |[x, y]: [f64; 2]| [x + 2.0 * y, 2.0 * x + y, 2.0 * x - 2.0 * y];
    let points: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| (x * 4096.0).round() / 4096.0)).collect();
    let queries: Vec<[f64; 2]> = points.windows(2).map(|p| [0, 1].map(|a| 0.25 * p[0][a] + 0.75 * p[1][a])).collect();
    let [solid, solid_queries] =
        [&points, &queries].map(|points| points.iter().map(|&p| turned(p)).collect::<Vec<_>>());
    let values: Vec<f64> = points.iter().map(wave).collect();
    let (mesh, flat) = (mesh2(&points), mesh3(&solid));
    let (locator, of_flat) = (Locator::new(&mesh, &points).unwrap(), Locator::new(&flat, &solid).unwrap());
    let plain = Interpolator::new(&locator, &values).unwrap();
    let lifted = Interpolator::new(&of_flat, &values).unwrap();
    for method in SMOOTH {
        let expected = plain.interpolate_many(method, &queries).unwrap();
        let found = lifted.interpolate_many(method, &solid_queries).unwrap();
        assert_eq!(expected.outside, found.outside);
        for (a, b) in expected.values.iter().zip(&found.values) {
            assert!((a - b).abs() < 1e-10, "{method:?}: {a} {b}");
        }
    }
    for ([x, y], &[u, v, w]) in plain.gradients().iter().zip(lifted.gradients()) {
        let along = [u + 2.0 * v + 2.0 * w, 2.0 * u + v - 2.0 * w];
        assert!((along[0] - x).abs() < 1e-9 && (along[1] - y).abs() < 1e-9);
        assert!((2.0 * u - 2.0 * v + w).abs() < 1e-9);
    }
}

#[test]
fn there_are_no_thirds_of_tetrahedra_and_no_weights_of_smooth_methods() {
    let points = generate3d(Distribution3::Uniform, 50, 1);
    let mesh = mesh3(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let values = vec![0.0; 50];
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let error = interpolator.interpolate(Interpolation::CloughTocher, [0.5; 3]).unwrap_err();
    assert!(matches!(error, Error::BadOption { .. }), "{error}");
    assert_eq!(interpolator.interpolate_many(Interpolation::CloughTocher, &[[0.5; 3]]).unwrap_err(), error);
    let error = interpolator.weights(Interpolation::SibsonC1, [0.5; 3]).unwrap_err();
    assert!(matches!(error, Error::BadOption { .. }), "{error}");
    assert_eq!(interpolator.weights_many(Interpolation::SibsonC1, &[[0.5; 3]]).unwrap_err(), error);
}

/// What is outside goes on from the border, whose values are cubics.
#[test]
fn values_go_on_outside() {
    let points = generate2d(Distribution2::Uniform, 100, 3);
    let mesh = mesh2(&points);
    let values: Vec<f64> = points.iter().map(wave).collect();
    let locator = Locator::new(&mesh, &points).unwrap();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let interpolator = interpolator.outside(Outside::Linear);
    for method in SMOOTH {
        for edge in mesh.hull_edges() {
            let [p, q] = edge.map(|v| points[v as usize]);
            let middle = [0.7 * p[0] + 0.3 * q[0], 0.7 * p[1] + 0.3 * q[1]];
            let near: Vec<[f64; 2]> = [-1e-7, 0.0, 1e-7]
                .iter()
                .map(|h| [middle[0] + h * (q[1] - p[1]), middle[1] - h * (q[0] - p[0])])
                .collect();
            let found = interpolator.interpolate_many(method, &near).unwrap().values;
            assert!((found[0] - found[1]).abs() < 1e-5 && (found[2] - found[1]).abs() < 1e-5, "{method:?}: {found:?}");
        }
    }
}

/// A value that is missing is missed nearby only.
#[test]
fn missing_values_stay_where_they_are() {
    let points: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i % 10), f64::from(i / 10)]).collect();
    let mut values: Vec<f64> = points.iter().map(|[x, y]| x + 2.0 * y).collect();
    values[55] = f64::NAN;
    let mesh = mesh2(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    for method in SMOOTH {
        assert!(interpolator.interpolate(method, [5.25, 5.25]).unwrap().is_nan(), "{method:?}");
        for q in [[3.3, 3.6], [7.2, 5.5], [5.5, 1.25]] {
            let found = interpolator.interpolate(method, q).unwrap();
            assert!((found - (q[0] + 2.0 * q[1])).abs() < 1e-12, "{method:?}: {found}");
        }
    }
}

/// Neither the unit of length nor that of the values matters.
#[test]
fn scale_does_not_matter() {
    let points = generate2d(Distribution2::Uniform, 100, 4);
    let values: Vec<f64> = points.iter().map(wave).collect();
    let queries: Vec<[f64; 2]> =
        points.windows(3).map(|p| [0, 1].map(|a| (p[0][a] + p[1][a] + p[2][a]) / 3.0)).collect();
    let found = |unit: f64, method| {
        let scaled = |points: &[[f64; 2]]| points.iter().map(|p| p.map(|x| x * unit)).collect::<Vec<_>>();
        let points = scaled(&points);
        let mesh = mesh2(&points);
        let locator = Locator::new(&mesh, &points).unwrap();
        Interpolator::new(&locator, &values).unwrap().interpolate_many(method, &scaled(&queries)).unwrap().values
    };
    for method in SMOOTH {
        let one = found(1.0, method);
        for unit in [2f64.powi(-600), 2f64.powi(600)] {
            for (a, b) in one.iter().zip(found(unit, method)) {
                assert!((a - b).abs() < 1e-12 || (a.is_nan() && b.is_nan()), "{method:?} {unit:e}: {a} {b}");
            }
        }
    }
}

fn check_grid<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]], size: [usize; D])
where
    Euclidean: StolenMeasures<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap();
    let values: Vec<f64> = points.iter().map(wave).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let grid = Grid { size, bounds: [[-0.1; D], [1.05; D]] };
    let centers: Vec<[f64; D]> = (0..grid.check().unwrap()).map(|cell| grid.center(cell)).collect();
    for method in [Interpolation::Linear, Interpolation::Sibson, Interpolation::SibsonC1] {
        let raster = interpolator.interpolate_grid(method, &grid).unwrap();
        let many = interpolator.interpolate_many(method, Points::F64(&centers)).unwrap();
        assert_eq!(raster.outside, many.outside);
        assert!(raster.values.iter().zip(&many.values).all(|(a, b)| a.to_bits() == b.to_bits()), "{method:?}");
        if method.is_smooth() {
            continue;
        }
        let table = interpolator.weights_many(method, Points::F64(&centers)).unwrap();
        assert_eq!(table.outside, many.outside);
        assert_eq!(table.offsets.len(), centers.len() + 1);
        let error = Error::ValueCount { values: 1, points: points.len() };
        assert_eq!(table.apply(&[0.0]).unwrap_err(), error);
        assert!(
            table.apply(&values).unwrap().iter().zip(&many.values).all(|(a, b)| a.to_bits() == b.to_bits()),
            "{method:?}"
        );
    }
}

#[test]
fn grids_and_tables_are_queries() {
    let points = generate2d(Distribution2::Uniform, 500, 2);
    check_grid(&mesh2(&points), &points, [70, 45]);
    check_grid(&mesh2(&points), &points, [1, 3]);
    let line: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i) / 8.0; 2]).collect();
    check_grid(&mesh2(&line), &line, [9, 9]);
    let points = generate3d(Distribution3::Uniform, 500, 2);
    check_grid(&mesh3(&points), &points, [20, 17, 33]);
}

#[test]
fn grids_without_cells_and_without_an_inside() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mesh = mesh2(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let interpolator = Interpolator::new(&locator, &[0.0; 3]).unwrap();
    let grid = |size, bounds| interpolator.interpolate_grid(Interpolation::Linear, &Grid { size, bounds });
    assert_eq!(grid([0, 5], [[0.0; 2], [1.0; 2]]).unwrap().values, [0.0; 0]);
    assert_eq!(grid([5, 5], [[0.0, 1.0], [1.0, 1.0]]).unwrap_err(), Error::EmptyBox { axis: 'y' });
    assert_eq!(grid([5, 5], [[0.0; 2], [f64::NAN, 1.0]]).unwrap_err(), Error::EmptyBox { axis: 'x' });
    for size in [1 << 20, usize::MAX] {
        let error = grid([size, size], [[0.0; 2], [1.0; 2]]).unwrap_err();
        assert_eq!(error.to_string(), "the number of cells of a grid must be below 2³²");
    }
    assert_eq!(interpolator.interpolate_many(Interpolation::SibsonC1, &[] as &[[f64; 2]]).unwrap().values, [0.0; 0]);
}
