//! Interpolation: what defines it, on degenerate cavities and on the hull's boundary too, and brute
//! force.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3, queries};
use gdel::{
    Error, Interpolation, Interpolator, Locator, Mesh, Points,
    internals::{
        d3::generate::{Distribution3, generate3d},
        derived::StolenMeasures,
        geometry::Euclidean,
    },
};

const METHODS: [Interpolation; 3] = [Interpolation::Linear, Interpolation::Laplace, Interpolation::Sibson];

pub fn check<const D: usize, const N: usize>(name: &str, mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: StolenMeasures<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap().exact();
    let queries: Vec<_> = queries(points).into_iter().step_by(4).collect();
    let largest = points.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE);
    // A linear function with values of about 1.
    let linear = |p: &[f64; D]| p.iter().zip([0.5, -0.25, 0.125]).map(|(x, a)| x / largest * a).sum::<f64>() + 0.25;
    let values: Vec<f64> = points.iter().map(linear).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let located = locator.locate_many(Points::F64(&queries)).unwrap();
    for method in METHODS {
        let found = interpolator.interpolate_many(method, Points::F64(&queries)).unwrap().values;
        for ((q, found), location) in queries.iter().zip(found).zip(&located) {
            let at = || format!("{name} {method:?}: {q:?} in {location:?}");
            let one = interpolator.interpolate(method, *q).unwrap();
            assert_eq!(one.to_bits(), found.to_bits(), "{}", at());
            let weights = interpolator.weights(method, *q).unwrap();
            // Flat points have values within their own dimension.
            if !mesh.simplices().is_empty() {
                assert_eq!(weights.is_some(), location.simplex().is_some(), "{}", at());
            }
            assert_eq!(found.is_nan(), weights.is_none(), "{}", at());
            let Some(weights) = weights else { continue };
            assert!((found - linear(q)).abs() <= 1e-10, "{}: {found} instead of {}, {weights:?}", at(), linear(q));
            assert!(weights.iter().all(|&(_, w)| (0.0..=1.0 + 1e-12).contains(&w)), "{}: {weights:?}", at());
            assert!((weights.iter().map(|&(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-12, "{}: {weights:?}", at());
            if let Some(v) = points.iter().position(|p| p == q) {
                assert_eq!(weights, [(v as u32, 1.0)], "{}", at());
            }
        }
    }
}

#[test]
fn linear_functions_are_reproduced_in_3d() {
    for (name, points) in inputs3() {
        check(name, &mesh3(&points), &points);
    }
}

#[test]
fn linear_functions_are_reproduced_in_2d() {
    for (name, points) in inputs2() {
        check(name, &mesh2(&points), &points);
    }
}

/// Halves a convex polygon by the bisector of two points: what is nearer to `a` remains.
fn nearer2(polygon: &[[f64; 2]], a: [f64; 2], b: [f64; 2]) -> Vec<[f64; 2]> {
    let side = |p: [f64; 2]| [0, 1].map(|i| (b[i] - a[i]) * (a[i] + b[i] - 2.0 * p[i])).iter().sum::<f64>();
    let mut result = Vec::new();
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (s, t) = (side(p), side(q));
        if s >= 0.0 {
            result.push(p);
        }
        if (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0) {
            result.push([0, 1].map(|i| p[i] + (q[i] - p[i]) * s / (s - t)));
        }
    }
    result
}

fn area(polygon: &[[f64; 2]]) -> f64 {
    let cross = |(i, p): (usize, &[f64; 2])| {
        let q = polygon[(i + 1) % polygon.len()];
        p[0] * q[1] - p[1] * q[0]
    };
    polygon.iter().enumerate().map(cross).sum::<f64>() / 2.0
}

/// Sibson's definition: the query's cell, and what of it was each vertex's before.
#[test]
fn sibson_weights_are_the_stolen_areas() {
    for (name, points) in inputs2() {
        let mesh = mesh2(&points);
        if !["uniform", "grid of 9²", "circle of integers", "disk", "clusters"].contains(&name) {
            continue;
        }
        let locator = Locator::new(&mesh, &points).unwrap();
        let values = vec![0.0; points.len()];
        let interpolator = Interpolator::new(&locator, &values).unwrap();
        let far = 1e3 * points.as_flattened().iter().fold(1.0f64, |m, x| m.max(x.abs()));
        let square = [[-far, -far], [far, -far], [far, far], [-far, far]];
        for q in queries(&points).into_iter().take(100) {
            let Some(weights) = interpolator.weights(Interpolation::Sibson, q).unwrap() else { continue };
            let cell = points.iter().filter(|&&p| p != q).fold(square.to_vec(), |cell, &p| nearer2(&cell, q, p));
            // Not the unbounded ones, nor those of vertices.
            if cell.as_flattened().iter().any(|x| x.abs() > 0.01 * far) || points.contains(&q) {
                continue;
            }
            for v in mesh.vertices() {
                let others = mesh.vertices().filter(|&w| w != v);
                let own = points[v as usize];
                let stolen = others.fold(cell.clone(), |cell, w| nearer2(&cell, own, points[w as usize]));
                let expected = area(&stolen) / area(&cell);
                let found = weights.iter().find(|&&(w, _)| w == v).map_or(0.0, |&(_, weight)| weight);
                assert!((found - expected).abs() < 1e-9, "{name} {q:?} {v}: {found}, not {expected}");
            }
        }
    }
}

/// A convex polyhedron as its faces, halved by the bisector of two points: what is nearer to `a`
/// remains.
fn nearer3(faces: &[Vec<[f64; 3]>], a: [f64; 3], b: [f64; 3]) -> Vec<Vec<[f64; 3]>> {
    let side = |p: [f64; 3]| [0, 1, 2].map(|i| (b[i] - a[i]) * (a[i] + b[i] - 2.0 * p[i])).iter().sum::<f64>();
    let mut result = Vec::new();
    let mut cut = Vec::new();
    for face in faces {
        let mut kept = Vec::new();
        for (i, &p) in face.iter().enumerate() {
            let q = face[(i + 1) % face.len()];
            let (s, t) = (side(p), side(q));
            if s >= 0.0 {
                kept.push(p);
            }
            if (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0) {
                let r = [0, 1, 2].map(|i| p[i] + (q[i] - p[i]) * s / (s - t));
                kept.push(r);
                cut.push(r);
            } else if s == 0.0 {
                cut.push(p);
            }
        }
        if kept.len() > 2 {
            result.push(kept);
        }
    }
    // The new face, around its middle.
    if cut.len() > 2 {
        let middle = [0, 1, 2].map(|i| cut.iter().map(|p| p[i]).sum::<f64>() / cut.len() as f64);
        let n = [0, 1, 2].map(|i| b[i] - a[i]);
        let axis = (0..3).min_by(|&i, &j| n[i].abs().total_cmp(&n[j].abs())).unwrap();
        let mut e = [0.0; 3];
        e[axis] = 1.0;
        let cross = |u: [f64; 3], v: [f64; 3]| {
            [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        };
        let x = cross(e, n);
        let y = cross(n, x);
        let norm = |u: [f64; 3]| (0..3).map(|i| u[i] * u[i]).sum::<f64>().sqrt();
        let dot = |u: [f64; 3], v: [f64; 3]| (0..3).map(|i| u[i] * v[i]).sum::<f64>();
        let angle = |p: &[f64; 3]| {
            let d = [0, 1, 2].map(|i| p[i] - middle[i]);
            (dot(d, y) / norm(y)).atan2(dot(d, x) / norm(x))
        };
        cut.sort_by(|p, q| angle(p).total_cmp(&angle(q)));
        result.push(cut);
    }
    result
}

fn volume(faces: &[Vec<[f64; 3]>], origin: [f64; 3]) -> f64 {
    let minus = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - origin[i]);
    let mut sum = 0.0;
    for face in faces {
        for i in 1..face.len() - 1 {
            let [u, v, w] = [face[0], face[i], face[i + 1]].map(minus);
            let det = u[0] * (v[1] * w[2] - v[2] * w[1])
                + u[1] * (v[2] * w[0] - v[0] * w[2])
                + u[2] * (v[0] * w[1] - v[1] * w[0]);
            sum += det.abs();
        }
    }
    sum / 6.0
}

#[test]
fn sibson_weights_are_the_stolen_volumes() {
    for (name, points) in inputs3() {
        if !["uniform", "grid of 5³", "shuffled grid", "ball"].contains(&name) {
            continue;
        }
        let points = &points[..points.len().min(125)];
        let mesh = mesh3(points);
        let locator = Locator::new(&mesh, points).unwrap();
        let values = vec![0.0; points.len()];
        let interpolator = Interpolator::new(&locator, &values).unwrap();
        let far = 1e3 * points.as_flattened().iter().fold(1.0f64, |m, x| m.max(x.abs()));
        let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { far } else { -far });
        let cube: Vec<Vec<[f64; 3]>> =
            [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
                .map(|face| face.map(corner).to_vec())
                .to_vec();
        let mut checked = 0;
        for q in queries(points).into_iter().take(80) {
            let Some(weights) = interpolator.weights(Interpolation::Sibson, q).unwrap() else { continue };
            if points.contains(&q) {
                continue;
            }
            let cell = points.iter().fold(cube.clone(), |cell, &p| nearer3(&cell, q, p));
            if cell.iter().flatten().flatten().any(|x| x.abs() > 0.01 * far) {
                continue;
            }
            let whole = volume(&cell, q);
            // Where the cell is long, brute force is no more exact.
            let tolerance =
                1e-9 + 1e-15 * cell.iter().flatten().flatten().fold(0.0f64, |m, x| m.max(x.abs())).powi(3) / whole;
            for v in mesh.vertices() {
                let own = points[v as usize];
                let others = mesh.vertices().filter(|&w| w != v);
                let stolen = others.fold(cell.clone(), |cell, w| nearer3(&cell, own, points[w as usize]));
                let expected = stolen.first().map_or(0.0, |face| volume(&stolen, face[0])) / whole;
                let found = weights.iter().find(|&&(w, _)| w == v).map_or(0.0, |&(_, weight)| weight);
                assert!((found - expected).abs() < tolerance, "{name} {q:?} {v}: {found}, not {expected}");
            }
            checked += 1;
        }
        assert!(checked > 10, "{name}");
    }
}

/// On a facet of the hull that many vertices share, Laplace's weights in 3D are Sibson's in 2D, and
/// all methods are continuous.
#[test]
fn on_the_hull_interpolation_is_the_limit_from_inside() {
    let points: Vec<[f64; 3]> = inputs3().into_iter().find(|(name, _)| *name == "shuffled grid").unwrap().1;
    let mesh = mesh3(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let values: Vec<f64> = points.iter().map(|[x, y, z]| x * x + y * y * y + x * y * z).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();

    let bottom: Vec<usize> = (0..points.len()).filter(|&i| points[i][2] == 0.0).collect();
    let points2: Vec<[f64; 2]> = bottom.iter().map(|&i| [points[i][0], points[i][1]]).collect();
    let values2: Vec<f64> = bottom.iter().map(|&i| values[i]).collect();
    let mesh2 = mesh2(&points2);
    let locator2 = Locator::new(&mesh2, &points2).unwrap();
    let interpolator2 = Interpolator::new(&locator2, &values2).unwrap();
    for [x, y] in queries(&points2) {
        if !(0.0..=3.0).contains(&x) || !(0.0..=3.0).contains(&y) {
            continue;
        }
        let flat = interpolator2.interpolate(Interpolation::Sibson, [x, y]).unwrap();
        let solid = interpolator.interpolate(Interpolation::Laplace, [x, y, 0.0]).unwrap();
        assert!((flat - solid).abs() < 1e-10, "{x} {y}: {flat} {solid}");
        for method in METHODS {
            let on = interpolator.interpolate(method, [x, y, 0.0]).unwrap();
            let near = interpolator.interpolate(method, [x, y, 1e-9]).unwrap();
            assert!((near - on).abs() < 1e-6, "{method:?} {x} {y}: {near} {on}");
        }
    }
}

#[test]
fn values_of_the_wrong_number_are_an_error() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mesh = mesh2(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let error = Interpolator::new(&locator, &[0.0; 2]).unwrap_err();
    assert_eq!(error, Error::ValueCount { values: 2, points: 3 });
    let values = [f64::NAN, 1.0, 2.0];
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let not_finite = interpolator.interpolate(Interpolation::Linear, [f64::INFINITY, 0.0]);
    assert_eq!(not_finite, Err(Error::NotFinite { index: 0, axis: 'x', value: "inf" }));
    // NaN stays where it has a weight.
    assert!(interpolator.interpolate(Interpolation::Sibson, [0.2, 0.2]).unwrap().is_nan());
    assert_eq!(interpolator.interpolate(Interpolation::Sibson, [0.5, 0.5]), Ok(1.5));
}

/// `benches/peers/linear.py` has made the file.
#[test]
fn linear_interpolation_equals_that_of_scipy() {
    let points = generate3d(Distribution3::Uniform, 2000, 1);
    let queries = generate3d(Distribution3::Uniform, 1000, 2);
    let mesh = gdel::delaunay3d(&points).unwrap();
    let locator = Locator::new(&mesh, &points).unwrap();
    let values: Vec<f64> = points.iter().map(|[x, y, z]| x * y + z).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let found = interpolator.interpolate_many(Interpolation::Linear, &queries).unwrap().values;
    let expected = include_str!("../data/derived/linear.txt").lines().map(|line| line.parse::<f64>().unwrap());
    assert_eq!(expected.clone().count(), found.len());
    for (query, (found, expected)) in queries.iter().zip(found.into_iter().zip(expected)) {
        assert_eq!(found.is_nan(), expected.is_nan(), "{query:?}");
        assert!(found.is_nan() || (found - expected).abs() <= 1e-12 * expected.abs(), "{query:?}: {found} {expected}");
    }
}
