//! Queries on the border of the hull, which rounding has put outside, and values outside the hull.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3, queries};
use gdel::{
    Clip, Duplicates, Error, Interpolation, Interpolator, Location, Locator, Mesh, Outside, Points, Voronoi,
    internals::{
        d3::generate::{Distribution3, generate3d},
        derived::StolenMeasures,
        geometry::{Euclidean, Geometry},
    },
};

const METHODS: [Interpolation; 3] = [Interpolation::Linear, Interpolation::Laplace, Interpolation::Sibson];

/// Three stations and a query on an edge: 0.03 and 0.01 are rounded, and so outside by 10⁻¹⁸.
#[test]
fn a_query_on_an_edge_that_is_outside_by_1e_18_has_a_value() {
    let points = [[0.0, 0.0], [0.3, 0.1], [0.0, 1.0]];
    let mesh = mesh2(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let values = [1.0, 3.0, 5.0];
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    let query = [0.03, 0.01];
    assert_eq!(locator.locate(query), Ok(Location::Inside(0)));
    for method in METHODS {
        let found = interpolator.interpolate_many(method, &[query, [0.03, 0.009]]).unwrap();
        assert!((found.values[0] - 1.2).abs() < 1e-14 && found.values[1].is_nan(), "{method:?}: {found:?}");
        assert_eq!(found.outside, 1, "{method:?}");
        assert_eq!(interpolator.interpolate(method, query).unwrap(), found.values[0], "{method:?}");
    }
    let exact = Locator::new(&mesh, &points).unwrap().exact();
    assert_eq!(exact.locate(query).unwrap().simplex(), None);
    let found = Interpolator::new(&exact, &values).unwrap().interpolate_many(Interpolation::Linear, &[query]).unwrap();
    assert!(found.values[0].is_nan());
    assert_eq!(found.outside, 1);
}

/// A grid turned by some angles: what is on its border is not there exactly.
#[test]
fn a_turned_grid_has_values_all_along_its_border() {
    for degrees in [30.0, 1.0, 45.0, 77.7] {
        let (sin, cos) = libm::sincos(f64::to_radians(degrees));
        let turned = |[x, y]: [f64; 2]| [x * cos - y * sin, x * sin + y * cos];
        let solid = |[x, y, z]: [f64; 3]| {
            let [x, z] = turned([x, z]);
            let [x, y] = turned([x, y]);
            [x, y, z]
        };
        let grid: Vec<[f64; 3]> = (0..216u32).map(|i| [i % 6, i / 6 % 6, i / 36].map(f64::from)).collect();
        let border = (0..160u32).map(|i| (i % 40, i as usize / 40)).map(|(i, side)| {
            let along = f64::from(i) * 0.125;
            [[along, 0.0], [5.0, along], [along, 5.0], [0.0, along]][side]
        });
        let border: Vec<[f64; 2]> = border.collect();
        let points2: Vec<[f64; 2]> = grid[..36].iter().map(|&[x, y, _]| turned([x, y])).collect();
        let queries2: Vec<[f64; 2]> = border.iter().map(|&q| turned(q)).collect();
        check_border(&mesh2(&points2), &points2, &queries2);
        let points3: Vec<[f64; 3]> = grid.iter().map(|&p| solid(p)).collect();
        let queries3: Vec<[f64; 3]> = border.iter().map(|&[x, y]| solid([x, 0.0, y])).collect();
        check_border(&mesh3(&points3), &points3, &queries3);
        // In single precision, points and queries.
        let single = |points: &[[f64; 3]]| points.iter().map(|p| p.map(|x| x as f32)).collect::<Vec<_>>();
        let (points, queries) = (single(&points3), single(&queries3));
        let mesh = gdel::delaunay3d(&points).unwrap();
        let located = Locator::new(&mesh, &points).unwrap().locate_many(&queries).unwrap();
        assert!(located.iter().all(|location| location.simplex().is_some()), "{degrees}");
    }
}

fn check_border<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]], queries: &[[f64; D]])
where
    Euclidean: StolenMeasures<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap();
    let linear = |p: &[f64; D]| p.iter().zip([0.5, -0.25, 0.125]).map(|(x, a)| x * a).sum::<f64>();
    let values: Vec<f64> = points.iter().map(linear).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    for method in METHODS {
        let found = interpolator.interpolate_many(method, Points::F64(queries)).unwrap();
        assert_eq!(found.outside, 0, "{method:?}");
        for (query, value) in queries.iter().zip(found.values) {
            assert!((value - linear(query)).abs() < 1e-10, "{method:?} {query:?}: {value}");
        }
    }
}

/// What counts as inside is what the definition says: the box around the query meets the hull.
fn check_definition<const D: usize, const N: usize>(name: &str, mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: Geometry<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap();
    let exact = Locator::new(mesh, Points::F64(points)).unwrap().exact();
    let largest: [f64; D] = std::array::from_fn(|axis| points.iter().fold(0.0f64, |m, p| m.max(p[axis].abs())));
    let facets: Vec<[[f64; D]; D]> = (mesh.opposites().iter().zip(mesh.simplices()))
        .flat_map(|(across, simplex)| {
            let facets = <Euclidean as Geometry<D, N>>::FACETS;
            let on_hull = (0..N).filter(|&k| across[k] == gdel::NONE).collect::<Vec<_>>();
            on_hull.into_iter().map(move |k| facets[k].map(|corner| points[simplex[corner] as usize]))
        })
        .collect();
    for q in queries(points) {
        let found = locator.locate(q).unwrap();
        if exact.locate(q).unwrap().simplex().is_some() || mesh.simplices().is_empty() {
            assert_eq!(found, exact.locate(q).unwrap(), "{name}: {q:?}");
            continue;
        }
        let reach: [f64; D] = largest.map(|x| x * 2f64.powi(-50));
        let corners = (0..1 << D).map(|bits: usize| {
            std::array::from_fn(|a| if bits >> a & 1 == 0 { q[a] - reach[a] } else { q[a] + reach[a] })
        });
        let corners: Vec<[f64; D]> = corners.collect();
        let is_apart = facets.iter().any(|facet| corners.iter().all(|&c| Euclidean::side(facet, c) < 0));
        let is_in = corners.iter().any(|&corner| exact.locate(corner).unwrap().simplex().is_some());
        assert!(!(is_apart && found.simplex().is_some()), "{name}: {q:?} is farther away than {reach:?}");
        assert!(!(is_in && found.simplex().is_none()), "{name}: {q:?} is within {reach:?}");
    }
}

#[test]
fn what_counts_as_inside_is_within_the_rounding_of_coordinates() {
    for (name, points) in inputs3() {
        check_definition(name, &mesh3(&points), &points);
    }
    for (name, points) in inputs2() {
        check_definition(name, &mesh2(&points), &points);
    }
}

/// Points on a line but for rounding: the hull is thinner than the rounding of coordinates.
#[test]
fn stations_on_a_line_but_for_rounding_have_values_between_them() {
    let points: Vec<[f64; 2]> = (0..50).map(f64::from).map(|i| [i * 0.1, i * 0.3 / 7.0]).collect();
    let mesh = mesh2(&points);
    assert!(!mesh.triangles.is_empty());
    let locator = Locator::new(&mesh, &points).unwrap();
    let values: Vec<f64> = (0..50).map(f64::from).collect();
    let queries: Vec<[f64; 2]> = (0..490).map(f64::from).map(|i| [i * 0.01, i * 0.03 / 7.0]).collect();
    for method in METHODS {
        let found = Interpolator::new(&locator, &values).unwrap().interpolate_many(method, &queries).unwrap();
        assert_eq!(found.outside, 0, "{method:?}");
        for (i, value) in (0..490).map(f64::from).zip(&found.values) {
            assert!((value - i * 0.1).abs() < 1e-10, "{method:?} {i}: {value}");
        }
    }
}

/// Linear functions go on outside, as the nearest vertex and a constant do by their definition.
fn check_outside<const D: usize, const N: usize>(name: &str, mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: StolenMeasures<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap();
    let largest = points.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE);
    let linear = |p: &[f64; D]| p.iter().zip([0.5, -0.25, 0.125]).map(|(x, a)| x / largest * a).sum::<f64>() + 0.25;
    let values: Vec<f64> = points.iter().map(linear).collect();
    let queries: Vec<[f64; D]> = queries(points).into_iter().step_by(3).collect();
    let located = locator.locate_many(Points::F64(&queries)).unwrap();
    let nearest = locator.nearest_many(Points::F64(&queries)).unwrap();
    let at = |outside| {
        let interpolator = Interpolator::new(&locator, &values).unwrap().outside(outside);
        interpolator.interpolate_many(Interpolation::Linear, Points::F64(&queries)).unwrap()
    };
    let (nan, constant) = (at(Outside::default()), at(Outside::Value(-7.5)));
    let (near, beyond) = (at(Outside::Nearest), at(Outside::Linear));
    let outside = located.iter().filter(|location| location.simplex().is_none()).count();
    assert!([&nan, &constant, &near, &beyond].iter().all(|found| found.outside == outside), "{name}");
    for (i, q) in queries.iter().enumerate() {
        if located[i].simplex().is_some() {
            let all = [&nan, &constant, &near, &beyond].map(|found| found.values[i].to_bits());
            assert!(all.iter().all(|&bits| bits == all[0]), "{name}: {q:?}");
            continue;
        }
        assert!(nan.values[i].is_nan() && constant.values[i] == -7.5, "{name}: {q:?}");
        if let Some(vertex) = nearest[i] {
            assert_eq!(near.values[i], values[vertex as usize], "{name}: {q:?}");
            let reach = q.iter().fold(1.0f64, |m, x| m.max((x / largest).abs()));
            let difference = (beyond.values[i] - linear(q)).abs();
            assert!(difference <= 1e-9 * reach, "{name}: {q:?}: {} instead of {}", beyond.values[i], linear(q));
        }
    }
}

#[test]
fn values_outside_the_hull_are_those_that_were_asked_for() {
    let ordinary = |name: &&str| {
        ["uniform", "ball", "grid of 5³", "grid of 9²", "disk", "large", "small", "one triangle", "one tetrahedron"]
            .contains(name)
    };
    for (name, points) in inputs3().into_iter().filter(|(name, _)| ordinary(name)) {
        check_outside(name, &mesh3(&points), &points);
    }
    for (name, points) in inputs2().into_iter().filter(|(name, _)| ordinary(name)) {
        check_outside(name, &mesh2(&points), &points);
    }
}

/// The nearest place of the hull is found however far the facet is that sees the query first.
#[test]
fn values_outside_are_continuous_across_the_hull() {
    let points = generate3d(Distribution3::Uniform, 300, 5);
    let mesh = mesh3(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let values: Vec<f64> = points.iter().map(|[x, y, z]| x * y + z * z).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap().outside(Outside::Linear);
    for (t, across) in mesh.neighbors.iter().enumerate() {
        for k in (0..4).filter(|&k| across[k] == gdel::NONE) {
            let corners = mesh.facet(t, k).map(|v| points[v as usize]);
            let middle: [f64; 3] = std::array::from_fn(|a| corners.iter().map(|p| p[a]).sum::<f64>() / 3.0);
            let out: [f64; 3] = std::array::from_fn(|a| middle[a] + 1e-9 * (middle[a] - 0.5));
            let [on, out] = [middle, out].map(|q| interpolator.interpolate(Interpolation::Linear, q).unwrap());
            assert!((on - out).abs() < 1e-7, "{middle:?}: {on} {out}");
        }
    }
}

#[test]
fn duplicates_have_the_value_that_was_asked_for() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]];
    let values = [1.0, 1.0, 1.0, 9.0];
    let mesh = mesh2(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let at = |duplicates, values: &[f64]| {
        let interpolator = Interpolator::new(&locator, values)?.duplicates(duplicates)?;
        interpolator.interpolate(Interpolation::Sibson, [0.0, 0.0])
    };
    assert_eq!(at(Duplicates::First, &values), Ok(1.0));
    assert_eq!(at(Duplicates::Mean, &values), Ok(5.0));
    assert_eq!(at(Duplicates::Error, &values), Err(Error::DuplicateValues { first: 0, other: 3 }));
    assert_eq!(at(Duplicates::Error, &[1.0, 1.0, 1.0, 1.0]), Ok(1.0));
    assert_eq!(at(Duplicates::Error, &[0.0, 1.0, 1.0, -0.0]), Ok(0.0));
    // The cells do not ask for values.
    assert_eq!(Voronoi::new(&mesh, &points, Clip::Hull).unwrap().volumes()[3], 0.0);
}
