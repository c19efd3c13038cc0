//! Alpha complexes of balls, against their definition in exact arithmetic, and against those of points.

use crate::{
    alpha::determinant,
    inputs::{inputs2, inputs3, mesh2, mesh3},
    weighted::Weighted,
};
use gdel::{
    AlphaShape, BallComplex, Constraints, Error, FaceClass, Mesh, Mesh2, Mesh3, NONE, Points, Triangulator,
    internals::{
        derived::SingularEdges,
        geometry::{Euclidean, Geometry},
    },
};
use num_bigint::BigInt;
use rand::RngExt;
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};
use std::collections::{BTreeMap, BTreeSet};

/// A point and its weight, as integers with the same unit and its square.
type Ball<const D: usize> = ([BigInt; D], BigInt);

/// Returns the sign of the determinant of the matrix of the products of the edges of a face, bordered by two vectors and
/// a number.
fn bordered<const D: usize>(face: &[&Ball<D>], column: impl Fn(usize) -> BigInt, last: BigInt) -> i32 {
    let edge = |i: usize, axis: usize| &face[i + 1].0[axis] - &face[0].0[axis];
    let product = |i: usize, j: usize| (0..D).map(|axis| edge(i, axis) * edge(j, axis)).sum::<BigInt>();
    let edges = face.len() - 1;
    let mut rows: Vec<Vec<BigInt>> =
        (0..edges).map(|i| (0..edges).map(|j| product(i, j)).chain([column(i)]).collect()).collect();
    rows.push((0..edges).map(|j| lifted(face[0], face[j + 1])).chain([last]).collect());
    let determinant = determinant(&rows);
    i32::from(determinant > BigInt::ZERO) - i32::from(determinant < BigInt::ZERO)
}

/// Returns |q − p|² less the difference of the weights.
fn lifted<const D: usize>(p: &Ball<D>, q: &Ball<D>) -> BigInt {
    (0..D).map(|axis| (&q.0[axis] - &p.0[axis]).pow(2)).sum::<BigInt>() - (&q.1 - &p.1)
}

/// Returns whether a face belongs to the complex of a squared radius by itself.
fn is_own<const D: usize>(face: &[&Ball<D>], others: &[Ball<D>], squared: &BigInt) -> bool {
    let number = |i: usize| lifted(face[0], face[i + 1]);
    if bordered(face, number, 4 * (&face[0].1 + squared)) < 0 {
        return false;
    }
    others.iter().all(|q| {
        let product = |i: usize| {
            let terms = (0..D).map(|axis| (&face[i + 1].0[axis] - &face[0].0[axis]) * (&q.0[axis] - &face[0].0[axis]));
            terms.sum()
        };
        bordered(face, product, lifted(face[0], q)) >= 0
    })
}

/// Checks a complex of a mesh whose simplices, or what is in their place, are `cells`.
fn check<const D: usize, const N: usize>(
    complex: &BallComplex<D, N>,
    cells: &[Vec<u32>],
    is_flat: bool,
    balls: &[Ball<D>],
    alpha: &BigInt,
    name: &str,
) {
    let squared = alpha * alpha;
    let mut simplices_of: BTreeMap<Vec<u32>, BTreeSet<usize>> = BTreeMap::new();
    for (t, cell) in cells.iter().enumerate() {
        for subset in 1..1u32 << cell.len() {
            let mut face: Vec<u32> = (0..cell.len()).filter(|i| subset >> i & 1 == 1).map(|i| cell[i]).collect();
            face.sort_unstable();
            simplices_of.entry(face).or_default().insert(t);
        }
    }
    let is_own = |face: &Vec<u32>| {
        let corners: Vec<&Ball<D>> = face.iter().map(|&v| &balls[v as usize]).collect();
        let others: Vec<Ball<D>> =
            (0..balls.len() as u32).filter(|v| !face.contains(v)).map(|v| balls[v as usize].clone()).collect();
        is_own(&corners, &others, &squared)
    };
    let own: Vec<&Vec<u32>> = simplices_of.keys().filter(|face| is_own(face)).collect();
    let is_subset = |face: &[u32], of: &[u32]| face.iter().all(|v| of.contains(v));
    let is_part = |face: &[u32]| own.iter().any(|of| is_subset(face, of));
    let is_solid = |t: usize| is_part(&cells[t]);
    let on_hull: Vec<&Vec<u32>> = simplices_of
        .iter()
        .filter(|(face, of)| face.len() == cells[0].len() - 1 && of.len() == 1)
        .map(|(f, _)| f)
        .collect();
    let class = |face: &[u32]| {
        let mut sorted = face.to_vec();
        sorted.sort_unstable();
        let around = &simplices_of[&sorted];
        let is_within =
            !is_flat && !on_hull.iter().any(|hull| is_subset(face, hull)) && around.iter().all(|&t| is_solid(t));
        match is_part(face) {
            _ if is_within => FaceClass::Interior,
            true if own.iter().any(|of| of.len() > face.len() && is_subset(face, of)) => FaceClass::Regular,
            true => FaceClass::Singular,
            false => FaceClass::Exterior,
        }
    };
    let solid: Vec<usize> = (0..cells.len()).filter(|&t| !is_flat && is_solid(t)).collect();
    assert!(complex.solid().eq(solid), "{name}");
    let count = |len: usize| simplices_of.keys().filter(|face| face.len() == len).count();
    let facets = complex.facets();
    assert_eq!(facets.len(), count(D), "{name}");
    for &(facet, found) in facets {
        assert_eq!(found, class(&facet), "{name}: facet {facet:?}");
    }
    assert_eq!(complex.edges().len(), count(2), "{name}");
    assert!(complex.edges().is_sorted_by(|a, b| a.0 < b.0));
    for &(edge, found) in complex.edges() {
        assert!(edge[0] < edge[1]);
        assert_eq!(found, class(&edge), "{name}: edge {edge:?}");
    }
    assert_eq!(complex.vertices().len(), count(1), "{name}");
    for &(vertex, found) in complex.vertices() {
        assert_eq!(found, class(&[vertex]), "{name}: vertex {vertex}");
    }
    // Components by repeated search.
    let (labels, components) = complex.components();
    let mut roots: Vec<u32> = (0..labels.len() as u32).collect();
    for _ in 0..labels.len() {
        for (edge, _) in complex.edges().iter().filter(|(edge, _)| is_part(edge)) {
            let [a, b] = edge.map(|v| v as usize);
            let low = roots[a].min(roots[b]);
            (roots[a], roots[b]) = (low, low);
        }
    }
    let parts: Vec<u32> = complex.vertices().iter().map(|&(v, _)| v).filter(|&v| is_part(&[v])).collect();
    let mut firsts: Vec<u32> = parts.iter().map(|&v| roots[v as usize]).collect();
    firsts.sort_unstable();
    firsts.dedup();
    assert_eq!(components, firsts.len(), "{name}");
    for (v, &label) in (0..).zip(&labels) {
        let expected = if parts.contains(&v) { firsts.binary_search(&roots[v as usize]).unwrap() as u32 } else { NONE };
        assert_eq!(label, expected, "{name}: point {v}");
    }
}

/// Returns points with small integers as coordinates, and weights.
fn random<const D: usize>(seed: u64) -> (Vec<[f64; D]>, Vec<f64>) {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let size = [3, 5, 40][seed as usize % 3];
    let count = random.random_range(D + 2..14 + 2 * (seed as usize % 4));
    let most = [1, 4, 30][seed as usize / 3 % 3];
    let points = (0..count).map(|_| std::array::from_fn(|_| f64::from(random.random_range(0..size)))).collect();
    let weights = (0..count).map(|_| f64::from(random.random_range(-1..=most))).collect();
    (points, weights)
}

fn balls<const D: usize>(points: &[[f64; D]], weights: &[f64]) -> Vec<Ball<D>> {
    let integer = |x: f64| BigInt::from(x as i64);
    points.iter().zip(weights).map(|(p, &w)| (p.map(integer), integer(w))).collect()
}

fn small_complexes<M: Weighted<D, N>, const D: usize, const N: usize>()
where
    Euclidean: Geometry<D, N>,
{
    let (mut hidden, mut parts) = (0, [0; 4]);
    for seed in 0..150 {
        let (points, weights) = random::<D>(seed);
        let mesh = M::regular(&points, &weights);
        if !mesh.is_spanned() {
            continue;
        }
        hidden += mesh.hidden().len();
        let cells: Vec<Vec<u32>> = mesh.simplices().iter().map(|simplex| simplex.to_vec()).collect();
        for alpha in [0, 1, 2, 5] {
            let complex = BallComplex::new(&mesh, Points::F64(&points), &weights, f64::from(alpha)).unwrap();
            check(&complex, &cells, false, &balls(&points, &weights), &alpha.into(), &format!("{seed}, {alpha}"));
            complex.edges().iter().for_each(|&(_, class)| parts[class as usize] += 1);
        }
    }
    assert!(hidden > 40 && parts.iter().all(|&count| count > 300), "{hidden}, {parts:?}");
}

#[test]
fn small_complexes_in_3d() {
    small_complexes::<Mesh3, 3, 4>();
}

#[test]
fn small_complexes_in_2d() {
    small_complexes::<Mesh2, 2, 3>();
}

/// Points of a slanted plane, and of a line, have the complexes of their triangles and edges.
#[test]
fn flat_points() {
    for seed in 0..60 {
        let (flat, weights) = random::<2>(seed);
        let mesh = Mesh2::regular(&flat, &weights);
        if mesh.dimension < 2 {
            continue;
        }
        // A parallelogram of squares: lengths are not those of the plane, so that its own mesh counts.
        let slanted: Vec<[f64; 3]> = flat.iter().map(|&[x, y]| [x, y, x + y]).collect();
        let upright: Vec<[f64; 3]> = flat.iter().map(|&[x, y]| [x, 7.0, y]).collect();
        for points in [slanted, upright] {
            let mesh = Mesh3::regular(&points, &weights);
            for alpha in [0, 1, 3] {
                let complex = BallComplex::new(&mesh, &points, &weights, f64::from(alpha)).unwrap();
                let cells: Vec<Vec<u32>> = complex.facets().iter().map(|(facet, _)| facet.to_vec()).collect();
                check(&complex, &cells, true, &balls(&points, &weights), &alpha.into(), &format!("{seed}, {alpha}"));
                let parts = complex.facets().iter().filter(|(_, class)| class.is_part()).count();
                assert_eq!(complex.surface().len(), 2 * parts);
            }
        }
        let line: Vec<[f64; 3]> = flat.iter().map(|&[x, y]| [x + 5.0 * y, 2.0 * (x + 5.0 * y), 3.0]).collect();
        let mesh = Mesh3::regular(&line, &weights);
        let in_plane: Vec<[f64; 2]> = line.iter().map(|&[x, y, _]| [x, y]).collect();
        let plane = BallComplex::new(&Mesh2::regular(&in_plane, &weights), &in_plane, &weights, 2.0).unwrap();
        let complex = BallComplex::new(&mesh, &line, &weights, 2.0).unwrap();
        let cells: Vec<Vec<u32>> = complex.edges().iter().map(|(edge, _)| edge.to_vec()).collect();
        if !cells.is_empty() {
            check(&complex, &cells, true, &balls(&line, &weights), &2.into(), &format!("line {seed}"));
        }
        assert_eq!((plane.edges(), plane.vertices()), (complex.edges(), complex.vertices()));
        assert_eq!((complex.facets().len(), plane.facets().len()), (0, cells.len()));
    }
    let one = Mesh3::regular(&[[1.0; 3]; 2], &[4.0, -1.0]);
    let complex = BallComplex::new(&one, &[[1.0; 3]; 2], &[4.0, -1.0], 0.0).unwrap();
    assert_eq!(complex.vertices(), [(0, FaceClass::Singular)]);
    assert_eq!(complex.components(), (vec![0, NONE], 1));
    let none = BallComplex::new(&Mesh3::regular(&[], &[]), &[] as &[[f64; 3]], &[], 0.0).unwrap();
    assert_eq!((none.vertices().len(), none.components().1), (0, 0));
}

/// Without weights, and with equal ones, the complex is that of the points.
fn equal<M: Mesh<D, N>, const D: usize, const N: usize>(
    inputs: Vec<(&str, Vec<[f64; D]>)>,
    mesh_of: impl Fn(&[[f64; D]]) -> M,
) where
    Euclidean: SingularEdges<D, N>,
{
    for (name, points) in inputs {
        let mesh = mesh_of(&points);
        let shape = AlphaShape::new(&mesh, Points::F64(&points)).unwrap();
        let radii: Vec<f64> = shape.simplices().collect();
        for alpha in [0.0, radii.get(radii.len() / 2).copied().unwrap_or(1.0), f64::INFINITY] {
            let expected = shape.at(alpha).unwrap();
            let complex = BallComplex::new(&mesh, Points::F64(&points), &[], alpha).unwrap();
            assert!(complex.solid().eq(expected.solid()), "{name}, {alpha}");
            let sorted = |mut faces: Vec<([u32; D], FaceClass)>| {
                faces.iter_mut().for_each(|(face, _)| face.sort_unstable());
                faces.sort_unstable_by_key(|&(face, _)| face);
                faces
            };
            assert_eq!(sorted(complex.facets().to_vec()), sorted(expected.facets().collect()), "{name}, {alpha}");
            assert!(complex.vertices().iter().copied().eq(expected.vertices()), "{name}, {alpha}");
            let mut singular: Vec<[u32; 2]> = Euclidean::singular_edges(&expected);
            singular.iter_mut().for_each(|edge| edge.sort_unstable());
            singular.sort_unstable();
            let found =
                complex.edges().iter().filter(|(_, class)| *class == FaceClass::Singular).map(|&(edge, _)| edge);
            assert!(found.eq(singular), "{name}, {alpha}");
            let mut surfaces = [complex.surface().to_vec(), expected.surface().collect()];
            surfaces.iter_mut().for_each(|surface| surface.sort_unstable());
            assert_eq!(surfaces[0].len(), surfaces[1].len(), "{name}, {alpha}");
        }
    }
}

#[test]
fn without_weights_in_3d() {
    equal::<Mesh3, 3, 4>(inputs3(), mesh3);
}

#[test]
fn without_weights_in_2d() {
    equal::<Mesh2, 2, 3>(inputs2(), mesh2);
}

/// Balls of a grid that touch exactly: all edges, nothing larger, and one component.
#[test]
fn balls_that_touch() {
    let points: Vec<[f64; 3]> = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect();
    let counts = |weight: f64| {
        let weights = [weight; 1000];
        let mesh = Triangulator::new().regular3d(&points, &weights).unwrap();
        let complex = BallComplex::new(&mesh, &points, &weights, 0.0).unwrap();
        let parts = complex.edges().iter().filter(|(_, class)| class.is_part()).count();
        (parts, complex.facets().iter().filter(|(_, class)| class.is_part()).count(), complex.components().1)
    };
    assert_eq!(counts(0.25), (3 * 900, 0, 1));
    assert_eq!(counts(0.25f64.next_down()), (0, 0, 1000));
    // Half of the square's diagonal, where four meet in its middle.
    assert_eq!(counts(0.5f64.next_down()), (3 * 900, 0, 1));
    let [squares, diagonals] = [3 * 9 * 9 * 10; 2];
    assert_eq!(counts(0.5), (3 * 900 + diagonals, 2 * squares, 1));
}

#[test]
fn scales_do_not_matter() {
    for scale in [2f64.powi(-400), 2f64.powi(200)] {
        let (points, weights) = random::<3>(8);
        let scaled: Vec<[f64; 3]> = points.iter().map(|p| p.map(|x| x * scale)).collect();
        let weights_scaled: Vec<f64> = weights.iter().map(|w| w * scale * scale).collect();
        let mesh = Mesh3::regular(&points, &weights);
        let other = Mesh3::regular(&scaled, &weights_scaled);
        let [a, b] = [
            BallComplex::new(&mesh, &points, &weights, 2.0).unwrap(),
            BallComplex::new(&other, &scaled, &weights_scaled, 2.0 * scale).unwrap(),
        ];
        assert_eq!((a.edges(), a.vertices()), (b.edges(), b.vertices()));
    }
}

#[test]
fn what_is_not_possible() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
    let weights = [1.0, 0.0, 0.0];
    let mesh = Triangulator::new().regular2d(&points, &weights).unwrap();
    for alpha in [-1.0, f64::NAN] {
        assert_eq!(BallComplex::new(&mesh, &points, &weights, alpha).unwrap_err(), Error::BadAlpha);
    }
    let error = |points: &[[f64; 2]], weights: &[f64]| BallComplex::new(&mesh, points, weights, 1.0).unwrap_err();
    assert!(matches!(error(&points[..2], &weights), Error::PointCount { .. }));
    assert!(matches!(error(&points, &weights[..2]), Error::ValueCount { values: 2, points: 3 }));
    assert!(matches!(error(&points, &[0.0, f64::NAN, 0.0]), Error::BadWeight { index: 1 }));
    for other in [&[][..], &[1.0; 3], &[0.0, 1.0, 0.0]] {
        assert!(matches!(error(&points, other), Error::BrokenMesh { .. }));
    }
    let constrained = Triangulator::new().constrained2d(&points, &Constraints::new().edges(&[[0, 1]])).unwrap();
    assert_eq!(BallComplex::new(&constrained.mesh, &points, &[], 1.0).unwrap_err(), Error::ConstrainedMesh);
}
