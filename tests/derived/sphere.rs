//! Points on a sphere: what d3-geo-voronoi says, and what holds for every sphere.

use crate::inputs::mesh3;
use gdel::{
    Error, Sphere,
    internals::d3::generate::{Distribution3, generate3d},
    on_sphere,
};
use std::f64::consts::PI;

/// Twenty places all over the sphere.
fn places(scale: f64) -> Vec<[f64; 2]> {
    (0..20).map(f64::from).map(|i| [i * 73.25 % 360.0 - 180.0, i * 41.5 % 170.0 - 85.0].map(|x| x * scale)).collect()
}

/// Asserts that no point is inside the circumcircle of a triangle, that triangles close up, and that
/// all cells together cover the sphere.
fn check(name: &str, points: &[[f64; 3]], sphere: &Sphere<'_>) {
    let centers = sphere.centers();
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let vertices = (0..points.len()).filter(|&i| sphere.duplicate_of()[i] == gdel::NONE).count();
    if vertices > 2 {
        assert_eq!(sphere.triangles().len(), 2 * vertices - 4, "{name}");
    }
    for (t, triangle) in sphere.triangles().iter().enumerate() {
        let height = dot(points[triangle[0] as usize], centers[t]);
        assert!(points.iter().all(|&p| dot(p, centers[t]) <= height + 1e-12), "{name} {t}");
        for (k, &across) in sphere.neighbors()[t].iter().enumerate() {
            assert!(sphere.neighbors()[across as usize].contains(&(t as u32)), "{name} {t} {k}");
        }
    }
    let total: f64 = sphere.areas().iter().sum();
    assert!(points.is_empty() || (total - 4.0 * PI).abs() < 1e-9, "{name}: {total}");
}

#[test]
fn spheres_equal_those_of_d3_geo_voronoi() {
    let all = [
        0.404502545,
        0.669464306,
        0.994116156,
        0.924627037,
        0.457187881,
        0.521734175,
        0.715096014,
        0.622311590,
        0.224214365,
        0.479623269,
        0.697253129,
        0.633459223,
        0.239044957,
        0.465313082,
        0.706555531,
        0.784835705,
        0.404072227,
        0.712495040,
        1.004599644,
        0.905864738,
    ];
    // On less than a half of the sphere, the cells of the points on the hull reach around it.
    let half = [
        3.023609635,
        0.117151670,
        0.069338394,
        0.068912477,
        2.186661921,
        0.201097524,
        0.048315015,
        0.047809298,
        0.220310928,
        2.006410252,
        0.191716975,
        0.047842919,
        0.224051851,
        0.243226534,
        0.187413086,
        1.570915409,
        0.760508928,
        0.326488780,
        0.069403240,
        0.955185777,
    ];
    for (scale, expected) in [(1.0, all), (0.25, half)] {
        let points = on_sphere(&places(scale)).unwrap();
        let mesh = mesh3(&points);
        let sphere = Sphere::new(&mesh, &points).unwrap();
        check("d3", &points, &sphere);
        assert_eq!(sphere.triangles().len(), 36);
        for (area, expected) in sphere.areas().iter().zip(expected) {
            // They have an error of 10⁻⁸.
            assert!((area - expected).abs() < 1e-7, "{area} {expected}");
        }
    }
    let points = on_sphere(&places(1.0)).unwrap();
    let mesh = mesh3(&points);
    let queries = on_sphere(&[[0.0, 0.0], [100.0, 50.0], [-170.0, -80.0], [30.0, -20.0]]).unwrap();
    let nearest = Sphere::new(&mesh, &points).unwrap().nearest_many(&queries).unwrap();
    assert_eq!(nearest, [2, 4, 0, 18].map(Some));
}

#[test]
fn few_points_share_the_sphere() {
    let octahedron = [[0.0, 0.0], [90.0, 0.0], [180.0, 0.0], [-90.0, 0.0], [0.0, 90.0], [0.0, -90.0]];
    let equator = [[0.0, 0.0], [72.0, 0.0], [144.0, 0.0], [-144.0, 0.0], [-72.0, 0.0]];
    let antipodes = [[10.0, 20.0], [-170.0, -20.0]];
    let meridian = [[0.0, 90.0], [0.0, -90.0], [0.0, 0.0], [180.0, 0.0]];
    for (name, places) in [
        ("octahedron", &octahedron[..]),
        ("half an octahedron", &[octahedron[0], octahedron[1], octahedron[4]]),
        ("equator", &equator),
        ("meridian", &meridian),
        ("antipodes", &antipodes),
        ("one", &antipodes[..1]),
        ("two", &equator[..2]),
        ("none", &[]),
    ] {
        let points = on_sphere(places).unwrap();
        let mesh = mesh3(&points);
        let sphere = Sphere::new(&mesh, &points).unwrap();
        check(name, &points, &sphere);
        let share = 4.0 * PI / places.len() as f64;
        assert!(sphere.areas().iter().all(|area| (area - share).abs() < 1e-12), "{name} {:?}", sphere.areas());
        let own: Vec<Option<u32>> = (0..places.len() as u32).map(Some).collect();
        assert_eq!(sphere.nearest_many(&points).unwrap(), own, "{name}");
    }
}

#[test]
fn equal_places_are_equal_points() {
    let points = on_sphere(&[
        [180.0, 10.0],
        [-180.0, 10.0],
        [540.0, 10.0],
        [12.0, 90.0],
        [77.0, 90.0],
        [33.0, 21.0],
        [-147.0, -21.0f64],
    ])
    .unwrap();
    assert!(points[0] == points[1] && points[1] == points[2] && points[3] == points[4]);
    assert_eq!(points[5].map(|x| -x), points[6]);
    let error = on_sphere(&[[0.0, f64::NAN]]).unwrap_err();
    assert_eq!(error, Error::NotFinite { index: 0, axis: 'y', value: "NaN" });
}

#[test]
fn many_points_have_the_hull_of_the_mesh() {
    for distribution in [Distribution3::Sphere, Distribution3::Ball] {
        let unit = |p: &[f64; 3]| {
            let norm = p.iter().map(|x| (x - 0.5).powi(2)).sum::<f64>().sqrt();
            p.map(|x| (x - 0.5) / norm)
        };
        let points: Vec<[f64; 3]> = generate3d(distribution, 400, 7).iter().map(unit).collect();
        let mesh = mesh3(&points);
        let sphere = Sphere::new(&mesh, &points).unwrap();
        check(distribution.name(), &points, &sphere);
        assert_eq!(gdel::internals::mesh::canonical(sphere.triangles()), gdel::internals::mesh::canonical(&mesh.hull));
        let queries: Vec<[f64; 3]> = generate3d(Distribution3::Ball, 300, 8).iter().map(unit).collect();
        let located = sphere.locate_many(&queries).unwrap();
        let nearest = sphere.nearest_many(&queries).unwrap();
        // A linear function of space.
        let values: Vec<f64> = points.iter().map(|p| p[0] - 2.0 * p[1] + 0.5 * p[2]).collect();
        let found = sphere.interpolate_many(&values, &queries).unwrap().values;
        let distance = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>();
        for (i, &query) in queries.iter().enumerate() {
            let triangle = sphere.triangles()[located[i].unwrap()];
            let [a, b, c] = triangle.map(|v| points[v as usize]);
            for [p, q] in [[a, b], [b, c], [c, a]] {
                assert!(gdel::orient3d([0.0; 3], p, q, query) >= 0);
            }
            // Where the ray to the query meets the plane of the triangle.
            let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| p[k] - q[k]);
            let (u, v) = (minus(b, a), minus(c, a));
            let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            let along = |p: [f64; 3]| (0..3).map(|k| normal[k] * p[k]).sum::<f64>();
            let expected = (query[0] - 2.0 * query[1] + 0.5 * query[2]) * along(a) / along(query);
            assert!((found[i] - expected).abs() < 1e-11, "{} {expected}", found[i]);
            let best = (0..400u32)
                .min_by(|&a, &b| distance(points[a as usize], query).total_cmp(&distance(points[b as usize], query)));
            assert_eq!(nearest[i], best);
        }
    }
}

#[test]
fn queries_outside_the_hull_of_a_half_have_no_triangle() {
    let points = on_sphere(&places(0.25)).unwrap();
    let mesh = mesh3(&points);
    let sphere = Sphere::new(&mesh, &points).unwrap();
    let queries = on_sphere(&[[0.0, 0.0], [180.0, 0.0], [0.0, 60.0]]).unwrap();
    let located = sphere.locate_many(&queries).unwrap();
    assert_eq!(located.iter().map(Option::is_some).collect::<Vec<_>>(), [true, false, false]);
    let found = sphere.interpolate_many(&[3.0; 20], &queries).unwrap();
    assert_eq!(found.outside, 2);
    let found = found.values;
    assert!((found[0] - 3.0).abs() < 1e-14 && found[1].is_nan() && found[2].is_nan());
    assert!(sphere.nearest_many(&queries).unwrap().iter().all(Option::is_some));
}

#[test]
fn of_points_as_near_as_each_other_the_lowest_is_nearest() {
    // The corners of a cube, whose lowest on the upper side is not next to all others there.
    let corners = [[-1, -1, 1], [1, 1, 1], [1, -1, 1], [-1, 1, 1], [1, 1, -1], [-1, -1, -1], [1, -1, -1], [-1, 1, -1]];
    let unit = 1.0 / 3f64.sqrt();
    let points = corners.map(|p| p.map(|x: i32| f64::from(x) * unit));
    let mesh = mesh3(&points);
    let sphere = Sphere::new(&mesh, &points).unwrap();
    // After a query next to each corner.
    for point in points {
        let queries = [point, [0.0, 0.0, 1.0], point, [1.0, 0.0, 0.0], point, [0.0, 0.0, -1.0]];
        let nearest = sphere.nearest_many(&queries).unwrap();
        assert_eq!([nearest[1], nearest[3], nearest[5]], [0, 1, 4].map(Some));
    }
}

#[test]
fn the_hull_goes_around_points_of_a_half_sphere() {
    let hull = |places: &[[f64; 2]]| {
        let points = on_sphere(places).unwrap();
        let mesh = mesh3(&points);
        let sphere = Sphere::new(&mesh, &points).unwrap();
        let outer = (0..sphere.triangles().len()).filter(|&t| sphere.is_outer(t)).count();
        (sphere.hull(), outer)
    };
    // What d3-geo-voronoi was asked for: four of five points, the lowest first.
    assert_eq!(hull(&[[10.0, 0.0], [10.0, 10.0], [3.0, 5.0], [-2.0, 5.0], [0.0, 0.0]]), (vec![0, 1, 3, 4], 2));
    assert_eq!(hull(&[[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]]), (vec![0, 1, 2], 1));
    assert_eq!(hull(&places(1.0)), (vec![], 0));
    // A circle of latitude, and the equator.
    let circle = |latitude: f64| (0..5).map(|i| [f64::from(i) * 72.0, latitude]).collect::<Vec<_>>();
    let (around, outer) = hull(&circle(60.0));
    assert_eq!((around, outer), (vec![0, 1, 2, 3, 4], 3));
    assert_eq!(hull(&circle(0.0)), (vec![], 0));
    assert_eq!(hull(&circle(0.0)[..2]), (vec![], 0));
}

/// The area of a polygon on the sphere that is less than a half, as the sum of triangles from its first corner.
fn polygon_area(corners: &[[f64; 3]]) -> f64 {
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let cross =
        |p: [f64; 3], q: [f64; 3]| [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let triangle = |a, b, c| 2.0 * f64::atan2(dot(a, cross(b, c)), 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
    corners[1..].windows(2).map(|pair| triangle(corners[0], pair[0], pair[1])).sum()
}

#[test]
fn polygons_have_the_areas_of_cells() {
    let antipodes = [[10.0, 20.0], [-170.0, -20.0]];
    let octant = [[0.0, 0.0], [90.0, 0.0], [0.0, 90.0]];
    let equator: Vec<[f64; 2]> = (0..6).map(|i| [f64::from(i) * 60.0, 0.0]).collect();
    for sites in
        [&places(1.0)[..], &places(0.25), &places(0.01), &antipodes, &[[0.0, 0.0], [10.0, 0.0]], &octant, &equator]
    {
        let points = on_sphere(sites).unwrap();
        let mesh = mesh3(&points);
        let sphere = Sphere::new(&mesh, &points).unwrap();
        let (corners, cells) = sphere.polygons();
        assert_eq!(cells.len(), points.len());
        for (v, area) in (0..).zip(sphere.areas()) {
            let polygon: Vec<[f64; 3]> = cells.of(v).iter().map(|&c| corners[c as usize]).collect();
            for (i, p) in polygon.iter().enumerate() {
                let q = polygon[(i + 1) % polygon.len()];
                let cos: f64 = (0..3).map(|k| p[k] * q[k]).sum();
                assert!(cos > -1e-7, "{sites:?} {v}: an edge is longer than a quarter");
            }
            // From the site, as cells may be halves.
            let around: Vec<[f64; 3]> =
                std::iter::once(points[v as usize]).chain(polygon.iter().copied()).chain([polygon[0]]).collect();
            let found = polygon_area(&around);
            assert!((found - area).abs() < 1e-7, "{sites:?} {v}: {found} {area}");
        }
    }
    let points = on_sphere(&[[0.0, 0.0], [10.0, 0.0]]).unwrap();
    let mesh = mesh3(&points);
    let (corners, cells) = Sphere::new(&mesh, &points).unwrap().polygons();
    // The meridian half-way between both.
    for place in gdel::lon_lat(&corners).unwrap() {
        assert!([5.0, -175.0].iter().any(|lon| (place[0] - lon).abs() < 1e-12) || place[1].abs() > 90.0 - 1e-12);
    }
    assert_eq!((cells.of(0), cells.of(1)), (&[0, 1, 2, 3][..], &[0, 3, 2, 1][..]));
    let mesh = mesh3(&points[..1]);
    let (corners, cells) = Sphere::new(&mesh, &points[..1]).unwrap().polygons();
    assert_eq!((corners.len(), cells.of(0).len()), (0, 0));
}

#[test]
fn places_are_found_again() {
    let all = [[0.0, 0.0], [90.0, 0.0], [180.0, 0.0], [-90.0, 0.0], [0.0, 90.0], [0.0, -90.0]];
    assert_eq!(gdel::lon_lat(&on_sphere(&all).unwrap()).unwrap(), all);
    for (place, found) in places(1.0).iter().zip(gdel::lon_lat(&on_sphere(&places(1.0)).unwrap()).unwrap()) {
        // −180° is 180°.
        let difference = (place[0] - found[0]) % 360.0;
        assert!(difference.abs() < 1e-12 && (place[1] - found[1]).abs() < 1e-12, "{place:?} {found:?}");
    }
}

#[test]
fn queries_on_the_border_of_a_half_are_inside() {
    let sites: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i) * 10.0, f64::from(i * i % 7) * 9.0 - 20.0]).collect();
    let points = on_sphere(&sites).unwrap();
    let mesh = mesh3(&points);
    let sphere = Sphere::new(&mesh, &points).unwrap();
    let hull = sphere.hull();
    let mut queries = points.clone();
    for (i, &v) in hull.iter().enumerate() {
        let [p, q] = [v, hull[(i + 1) % hull.len()]].map(|v| points[v as usize]);
        for k in 1..40 {
            let part = f64::from(k) / 40.0;
            queries.push([0, 1, 2].map(|a| p[a] * (1.0 - part) + q[a] * part));
        }
    }
    assert!(sphere.locate_many(&queries).unwrap().iter().all(Option::is_some));
    let values: Vec<f64> = points.iter().map(|p| p[2]).collect();
    let found = sphere.interpolate_many(&values, &queries).unwrap().values;
    for (value, found) in values.iter().zip(&found) {
        assert!((value - found).abs() < 1e-14);
    }
    assert!(found.iter().all(|value| value.is_finite()));
    let beyond: Vec<[f64; 3]> = hull.iter().map(|&v| points[v as usize]).map(|[x, y, z]| [x, y, z * 1.1]).collect();
    assert!(sphere.locate_many(&beyond).unwrap().iter().any(Option::is_none));
}

#[test]
fn a_hull_makes_the_same_sphere() {
    let points = on_sphere(&places(1.0)).unwrap();
    let mesh = mesh3(&points);
    let sphere = Sphere::from_hull(mesh.hull.clone(), mesh.duplicate_of.clone(), &points).unwrap();
    assert_eq!(sphere.triangles(), mesh.hull);
    assert_eq!(sphere.areas().len(), 20);
    let broken = |hull: Vec<[u32; 3]>, points: &[[f64; 3]]| {
        Sphere::from_hull(hull, mesh.duplicate_of.clone(), points).unwrap_err()
    };
    assert_eq!(broken(vec![[0, 1, 99]], &points), Error::BrokenMesh { reason: "a vertex does not exist" });
    assert_eq!(broken(mesh.hull[1..].to_vec(), &points), Error::BrokenMesh { reason: "the hull is not closed" });
    assert_eq!(broken(mesh.hull.clone(), &points[1..]), Error::PointCount { points: 19, expected: 20 });
}
