//! Contours and isosurfaces: what d3-tricontour says, and what holds for all of them.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3};
use gdel::{Contour, Contours, Error, Mesh};
use std::collections::HashMap;

/// Eighty points without ties, and values that have a saddle.
fn saddle() -> (Vec<[f64; 2]>, Vec<f64>) {
    let row = |i: u32| {
        let x = f64::from(i * 73 % 127) + f64::from(i * i * 31 % 101) / 128.0;
        let y = f64::from(i * i * 57 % 113) + f64::from(i * 19 % 89) / 128.0;
        let value = ((x - 60.0) * (x - 60.0) - (y - 50.0) * (y - 50.0)) / 64.0 + f64::from(i * 29 % 17);
        ([x, y], value)
    };
    (0..80).map(row).unzip()
}

/// The area to the left of the lines.
fn area(contour: &Contour<2>) -> f64 {
    let corner = |v: u32| [0, 1].map(|axis| contour.vertices[v as usize][axis] - contour.vertices[0][axis]);
    let twice = |&[a, b]: &[u32; 2]| corner(a)[0] * corner(b)[1] - corner(a)[1] * corner(b)[0];
    contour.facets.iter().map(twice).sum::<f64>() / 2.0
}

/// The volume behind the triangles.
fn volume(contour: &Contour<3>) -> f64 {
    let six = |facet: &[u32; 3]| {
        // Relative to one of them, as coordinates may be far from the origin.
        let origin = contour.vertices[0];
        let relative = |p: [f64; 3]| [0, 1, 2].map(|axis| p[axis] - origin[axis]);
        let [a, b, c] = facet.map(|v| relative(contour.vertices[v as usize]));
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    contour.facets.iter().map(six).sum::<f64>() / 6.0
}

/// Asserts that every facet's boundary is met by others in the opposite direction, and that no facet
/// has a vertex twice.
fn assert_closed<const D: usize>(name: &str, contour: &Contour<D>) {
    let mut balance: HashMap<Vec<u32>, i32> = HashMap::new();
    for facet in &contour.facets {
        for i in 0..D {
            assert_ne!(facet[i], facet[(i + 1) % D], "{name}");
            match D {
                2 => *balance.entry(vec![facet[i]]).or_default() += if i == 0 { -1 } else { 1 },
                _ => {
                    let [from, to] = [facet[i], facet[(i + 1) % D]];
                    *balance.entry(vec![from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
                }
            }
        }
    }
    assert!(balance.values().all(|&sum| sum == 0), "{name}");
}

#[test]
fn contours_equal_those_of_d3_tricontour() {
    let (points, values) = saddle();
    let mesh = mesh2(&points);
    let contours = Contours::new(&mesh, &points, &values).unwrap();
    // The level, the rings, their vertices and the area.
    let expected = [
        (-30.0, 2, 31, 12824.294480103847),
        (-10.0, 1, 51, 10672.40480817139),
        (0.0, 1, 56, 9006.23016318471),
        (7.5, 1, 57, 7367.147309039612),
        (20.0, 3, 45, 4323.980351120512),
        (60.0, 1, 10, 56.74921793000567),
    ];
    for (level, rings, vertices, expected) in expected {
        let contour = contours.closed_at(level);
        assert_closed("d3", &contour);
        let lines = contour.lines();
        assert_eq!((lines.len(), contour.facets.len()), (rings, vertices), "{level}");
        assert!((0..lines.len() as u32).all(|line| lines.of(line).first() == lines.of(line).last()));
        assert!((area(&contour) - expected).abs() < 1e-9 * expected, "{level}: {} {expected}", area(&contour));
    }
}

/// Integers from 0 to 4: many vertices, edges and facets have the values of levels.
fn coarse<const D: usize>(points: &[[f64; D]]) -> Vec<f64> {
    (0..points.len() as u32).map(|i| f64::from(i * 7919 % 31 % 5)).collect()
}

/// The measure of where linear interpolation is at least the level, by cutting each simplex many times.
fn measure_above<const D: usize, const N: usize>(
    mesh: &impl Mesh<D, N>,
    points: &[[f64; D]],
    values: &[f64],
    level: f64,
    volume: impl Fn(&[[f64; D]; N]) -> f64,
) -> f64 {
    let mut sum = 0.0;
    for simplex in mesh.simplices() {
        let [corners, heights] = [simplex.map(|v| points[v as usize]), simplex.map(|v| [values[v as usize]; D])];
        let mut heights = heights.map(|row| row[0] - level);
        heights.sort_by(f64::total_cmp);
        // The share of a simplex in which a linear function is positive: a sum over its positive values
        // (the divided difference of a truncated power).
        let positive: Vec<f64> = heights.iter().copied().filter(|&h| h >= 0.0).collect();
        let negative: Vec<f64> = heights.iter().copied().filter(|&h| h < 0.0).collect();
        let share = match (positive.len(), negative.len()) {
            (0, _) => 0.0,
            (_, 0) => 1.0,
            (1, _) => negative.iter().map(|h| positive[0] / (positive[0] - h)).product(),
            (_, 1) => 1.0 - positive.iter().map(|h| negative[0] / (negative[0] - h)).product::<f64>(),
            _ => {
                let ([a, b], [c, d]) = ([positive[0], positive[1]], [negative[0], negative[1]]);
                // The prism with the vertices a and b, cut along both: two tetrahedra and one more.
                let cut = |high: f64, low: f64| high / (high - low);
                let (ac, ad, bc, bd) = (cut(a, c), cut(a, d), cut(b, c), cut(b, d));
                ac * ad + bc * bd * (1.0 - ad) + (1.0 - ac) * bc * ad
            }
        };
        sum += share * volume(&corners);
    }
    sum
}

#[test]
fn closed_contours_enclose_what_is_above() {
    for (name, points) in inputs2() {
        let (mesh, values) = (mesh2(&points), coarse(&points));
        let contours = Contours::new(&mesh, &points, &values).unwrap();
        for level in [-1.0, 0.0, 0.5, 1.0, 2.25, 3.0, 4.0, 5.0] {
            let contour = contours.closed_at(level);
            assert_closed(name, &contour);
            let triangle =
                |&[a, b, c]: &[[f64; 2]; 3]| ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
            let all: f64 = measure_above(&mesh, &points, &values, -1.0, triangle);
            let expected = measure_above(&mesh, &points, &values, level, triangle);
            if (1e-200..1e200).contains(&all) {
                assert!((area(&contour) - expected).abs() <= 1e-7 * all, "{name} {level}: {expected}");
            }
        }
    }
}

#[test]
fn closed_isosurfaces_enclose_what_is_above() {
    for (name, points) in inputs3() {
        let (mesh, values) = (mesh3(&points), coarse(&points));
        let contours = Contours::new(&mesh, &points, &values).unwrap();
        for level in [-1.0, 0.0, 0.5, 1.0, 2.25, 3.0, 4.0, 5.0] {
            let contour = contours.closed_at(level);
            assert_closed(name, &contour);
            let tetrahedron = |corners: &[[f64; 3]; 4]| {
                let [u, v, w] = [1, 2, 3].map(|k: usize| [0, 1, 2].map(|axis| corners[k][axis] - corners[0][axis]));
                (u[0] * (v[1] * w[2] - v[2] * w[1])
                    + u[1] * (v[2] * w[0] - v[0] * w[2])
                    + u[2] * (v[0] * w[1] - v[1] * w[0]))
                    / 6.0
            };
            let all: f64 = measure_above(&mesh, &points, &values, -1.0, tetrahedron);
            let expected = measure_above(&mesh, &points, &values, level, tetrahedron);
            if (1e-200..1e200).contains(&all) {
                assert!(
                    (volume(&contour) - expected).abs() <= 1e-6 * all,
                    "{name} {level}: {} {expected}",
                    volume(&contour)
                );
            }
        }
    }
}

#[test]
fn isosurfaces_of_a_radius_are_spheres() {
    let points = crate::clouds::grid(13);
    let radius = |p: &[f64; 3]| p.iter().map(|x| (x - 6.0).powi(2)).sum::<f64>().sqrt();
    let values: Vec<f64> = points.iter().map(|p| -radius(p)).collect();
    let mesh = mesh3(&points);
    let sphere = Contours::new(&mesh, &points, &values).unwrap().at(-4.5);
    assert_closed("sphere", &sphere);
    let expected = 4.0 / 3.0 * std::f64::consts::PI * 4.5f64.powi(3);
    assert!((volume(&sphere) / expected - 1.0).abs() < 0.05, "{}", volume(&sphere));
    let edges = sphere.facets.len() * 3 / 2;
    assert_eq!(sphere.vertices.len() + sphere.facets.len() - edges, 2);
}

#[test]
fn open_contours_end_at_the_hull_and_at_holes() {
    let points: Vec<[f64; 2]> = (0..49).map(|i| [f64::from(i % 7), f64::from(i / 7)]).collect();
    let mut values: Vec<f64> = points.iter().map(|p| p[0]).collect();
    let mesh = mesh2(&points);
    let straight = Contours::new(&mesh, &points, &values).unwrap().at(2.5);
    assert_eq!(straight.lines().len(), 1);
    // Higher values are on the left.
    let [first, last] =
        [0, 1].map(|end| straight.vertices[straight.lines().of(0)[end * (straight.lines().of(0).len() - 1)] as usize]);
    assert_eq!((first, last), ([2.5, 6.0], [2.5, 0.0]));
    values[24] = f64::NAN;
    values[23] = f64::INFINITY;
    let broken = Contours::new(&mesh, &points, &values).unwrap();
    assert_eq!(broken.at(2.5).lines().len(), 2);
    assert_closed("hole", &broken.closed_at(2.5));
}

#[test]
fn values_at_the_level_leave_no_facets_without_an_extent() {
    // A plateau, a peak that only touches the level, and a ridge at the level.
    let points: Vec<[f64; 2]> = (0..25).map(|i| [f64::from(i % 5), f64::from(i / 5)]).collect();
    let mesh = mesh2(&points);
    let mut values = vec![0.0; 25];
    values[12] = 1.0;
    assert!(Contours::new(&mesh, &points, &values).unwrap().at(1.0).facets.is_empty());
    values[13] = 1.0;
    assert!(Contours::new(&mesh, &points, &values).unwrap().at(1.0).facets.is_empty());
    values = vec![1.0; 25];
    let all = Contours::new(&mesh, &points, &values).unwrap();
    assert!(all.at(1.0).facets.is_empty());
    assert_eq!(all.closed_at(1.0).facets.len(), 16);
    assert!(all.closed_at(f64::NAN).facets.is_empty());
}

#[test]
fn contours_need_a_value_per_point() {
    let (points, values) = saddle();
    let mesh = mesh2(&points);
    let error = Contours::new(&mesh, &points, &values[1..]).unwrap_err();
    assert_eq!(error, Error::ValueCount { values: 79, points: 80 });
}
