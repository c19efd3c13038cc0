//! Point location: the simplex with the first vertices of all that contain the query, or a facet of
//! the hull that sees it.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3, queries};
use gdel::{
    Error, Location, Locator, Mesh, Points,
    internals::geometry::{Euclidean, Geometry},
};

/// Returns on which side of the facet opposite vertex `k` a point is: 1 inside.
fn side<const D: usize, const N: usize>(simplex: &[[f64; D]; N], k: usize, p: [f64; D]) -> i8
where
    Euclidean: Geometry<D, N>,
{
    Euclidean::side(&<Euclidean as Geometry<D, N>>::FACETS[k].map(|corner| simplex[corner]), p)
}

pub fn check<const D: usize, const N: usize>(name: &str, mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: Geometry<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap().exact();
    let queries = queries(points);
    let located = locator.locate_many(Points::F64(&queries)).unwrap();
    assert_eq!(located.len(), queries.len());
    let corners = |t: usize| mesh.simplices()[t].map(|v| points[v as usize]);
    let sorted = |t: usize| {
        let mut vertices = mesh.simplices()[t];
        vertices.sort_unstable();
        vertices
    };
    for (&q, &location) in queries.iter().zip(&located) {
        assert_eq!(locator.locate(q).unwrap(), location, "{name}: {q:?}");
        let contains = |&t: &usize| (0..N).all(|k| side(&corners(t), k, q) >= 0);
        let expected = (0..mesh.simplices().len()).filter(contains).min_by_key(|&t| sorted(t));
        match location {
            Location::Inside(t) => assert_eq!(Some(t), expected, "{name}: {q:?}"),
            Location::Outside { simplex, facet } => {
                assert_eq!(expected, None, "{name}: {q:?}");
                let k = (0..N).find(|&k| <Euclidean as Geometry<D, N>>::FACET_NUMBERS[k] == facet).unwrap();
                assert_eq!(mesh.opposites()[simplex][k], gdel::NONE, "{name}: {q:?}");
                assert_eq!(side(&corners(simplex), k, q), -1, "{name}: {q:?}");
            }
            Location::Nowhere => assert!(mesh.simplices().is_empty(), "{name}: {q:?}"),
        }
    }
}

#[test]
fn the_simplex_that_contains_a_query_in_3d() {
    for (name, points) in inputs3() {
        check(name, &mesh3(&points), &points);
    }
}

#[test]
fn the_simplex_that_contains_a_query_in_2d() {
    for (name, points) in inputs2() {
        check(name, &mesh2(&points), &points);
    }
}

#[test]
fn a_vertex_of_all_triangles_is_located_in_linear_time() {
    let n = 100_000;
    let circle = (0..n).map(|i| f64::from(i) / f64::from(n) * std::f64::consts::TAU);
    let points: Vec<_> = circle.map(|t| [libm::cos(t), libm::sin(t)]).chain([[0.0; 2]]).collect();
    let mesh = mesh2(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let t = locator.locate([0.0; 2]).unwrap().simplex().unwrap();
    assert!(mesh.triangles[t].contains(&0) && mesh.triangles[t].contains(&(n as u32)));
}

#[test]
fn single_precision_and_double_precision_give_the_same() {
    let points: Vec<[f32; 3]> = inputs3()[0].1.iter().map(|p| p.map(|x| x as f32)).collect();
    let double: Vec<[f64; 3]> = points.iter().map(|p| p.map(f64::from)).collect();
    let mesh = mesh3(&double);
    let single = Locator::new(&mesh, &points).unwrap().locate_many(&points).unwrap();
    assert_eq!(single, Locator::new(&mesh, &double).unwrap().locate_many(&double).unwrap());
}

#[test]
fn bad_input_is_an_error() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mesh = mesh2(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let not_finite = |index| Error::NotFinite { index, axis: 'y', value: "NaN" };
    assert_eq!(locator.locate([0.0, f64::NAN]), Err(not_finite(0)));
    assert_eq!(locator.locate_many(&[[0.0, 0.0], [0.0, f64::NAN]]), Err(not_finite(1)));
    assert_eq!(locator.locate_many(Points::F64(&[])), Ok(vec![]));
    assert_eq!(locator.nearest([0.0, f64::NAN]), Err(not_finite(0)));
    assert_eq!(locator.nearest_many(&[[0.0, f64::NAN]]), Err(not_finite(0)));
    assert_eq!(locator.nearest_k([0.0, f64::NAN], 1), Err(not_finite(0)));

    let few = Locator::new(&mesh, &points[..2]).unwrap_err();
    assert_eq!(few, Error::PointCount { points: 2, expected: 3 });
    let infinite = Locator::new(&mesh, &[[0.0, 0.0], [1.0, 0.0], [0.0, f64::INFINITY]]).unwrap_err();
    assert_eq!(infinite, Error::NotFinite { index: 2, axis: 'y', value: "inf" });
}

#[test]
fn meshes_that_are_none_neither_panic_nor_hang() {
    let points = inputs2()[0].1.clone();
    let mut mesh = mesh2(&points);
    mesh.triangles[5][1] = points.len() as u32;
    assert!(matches!(Locator::new(&mesh, &points), Err(Error::BrokenMesh { .. })));
    let mut mesh = mesh2(&points);
    mesh.halfedges[5][1] = 3 * mesh.triangles.len() as u32;
    assert!(matches!(Locator::new(&mesh, &points), Err(Error::BrokenMesh { .. })));
    let mut mesh = mesh2(&points);
    mesh.halfedges.pop();
    assert!(matches!(Locator::new(&mesh, &points), Err(Error::BrokenMesh { .. })));

    // Right in its arrays, but of other points: any answer or error will do.
    let mesh = mesh2(&points);
    let others: Vec<_> = points.iter().rev().copied().collect();
    let locator = Locator::new(&mesh, &others).unwrap();
    for &p in &points {
        let _ = locator.locate(p);
        let _ = locator.nearest(p);
        let _ = locator.nearest_k(p, 10);
    }
}
