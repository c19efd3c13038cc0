//! Alpha shapes, against their definition in exact arithmetic.

use crate::{
    clouds,
    inputs::{inputs2, inputs3, mesh2, mesh3},
};
use gdel::{
    AlphaShape, Error, FaceClass, Interval, Mesh, Points,
    internals::{
        d3::generate::{Distribution3, generate3d},
        derived::AlphaEdges,
        geometry::{Euclidean, Geometry},
    },
};
use num_bigint::BigInt;
use std::{
    cmp::Ordering,
    collections::{BTreeMap, BTreeSet},
};

/// Returns `x`·2¹⁰⁷⁴.
fn integer(x: f64) -> BigInt {
    let exponent = (x.to_bits() >> 52 & 0x7ff) as i32;
    let fraction = (x.to_bits() & ((1 << 52) - 1)) as i64;
    let magnitude =
        if exponent == 0 { BigInt::from(fraction) } else { BigInt::from(fraction | 1 << 52) << (exponent - 1) };
    if x < 0.0 { -magnitude } else { magnitude }
}

pub fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    if rows.is_empty() {
        return BigInt::from(1);
    }
    let minor = |left_out: usize| {
        let others = rows.iter().enumerate().filter(|&(i, _)| i != left_out);
        determinant(&others.map(|(_, row)| row[1..].to_vec()).collect::<Vec<_>>())
    };
    let terms = rows.iter().enumerate().filter(|(_, row)| row[0] != BigInt::ZERO);
    terms.map(|(i, row)| if i % 2 == 0 { &row[0] * minor(i) } else { -&row[0] * minor(i) }).sum()
}

/// A fraction with a positive denominator.
#[derive(Debug, Clone)]
struct Fraction(BigInt, BigInt);

impl Fraction {
    fn compare(&self, other: &Fraction) -> Ordering {
        (&self.0 * &other.1).cmp(&(&other.0 * &self.1))
    }

    /// The root, of a number in units of 2⁻²¹⁴⁸.
    fn root(&self) -> f64 {
        // A quotient of 128 bits with an even exponent.
        let shift = 128 - (self.0.bits() as i64 - self.1.bits() as i64);
        let shift = shift + shift % 2;
        let quotient = if shift >= 0 { (&self.0 << shift) / &self.1 } else { &self.0 / (&self.1 << -shift) };
        let root = u128::try_from(quotient.sqrt()).unwrap() as f64;
        libm::ldexp(libm::ldexp(root, -537), -(shift / 2) as i32 - 537)
    }
}

/// The squared radius of the smallest sphere through points, and the barycentric coordinates of its
/// centre, by the bordered matrix of squared distances (Cayley and Menger).
struct Sphere<'a, const D: usize> {
    points: Vec<&'a [BigInt; D]>,
    /// The cofactors of the matrix's first row.
    cofactors: Vec<BigInt>,
    determinant: BigInt,
}

fn squared_distance<const D: usize>(a: &[BigInt; D], b: &[BigInt; D]) -> BigInt {
    (0..D).map(|i| (&a[i] - &b[i]) * (&a[i] - &b[i])).sum()
}

impl<'a, const D: usize> Sphere<'a, D> {
    fn new(points: Vec<&'a [BigInt; D]>) -> Self {
        let n = points.len() + 1;
        let entry = |i: usize, j: usize| match (i, j) {
            (0, 0) => BigInt::ZERO,
            (0, _) | (_, 0) => BigInt::from(1),
            _ => squared_distance(points[i - 1], points[j - 1]),
        };
        let rows: Vec<Vec<BigInt>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
        let cofactor = |j: usize| {
            let minor: Vec<Vec<BigInt>> = rows[1..]
                .iter()
                .map(|row| row.iter().enumerate().filter(|&(k, _)| k != j).map(|(_, x)| x.clone()).collect())
                .collect();
            if j.is_multiple_of(2) { determinant(&minor) } else { -determinant(&minor) }
        };
        let cofactors: Vec<BigInt> = (0..n).map(cofactor).collect();
        Sphere { points, determinant: determinant(&rows), cofactors }
    }

    fn squared_radius(&self) -> Fraction {
        let (numerator, denominator): (BigInt, BigInt) = (-&self.cofactors[0], &self.determinant * 2);
        if denominator < BigInt::ZERO { Fraction(-numerator, -denominator) } else { Fraction(numerator, denominator) }
    }

    fn contains(&self, p: &[BigInt; D]) -> bool {
        let power: BigInt = &self.cofactors[0]
            + self.points.iter().zip(&self.cofactors[1..]).map(|(q, c)| c * squared_distance(p, q)).sum::<BigInt>();
        power * &self.determinant < BigInt::ZERO
    }
}

/// What a face is in the filtration, by its definition, all radii squared.
struct Face {
    /// The radius of its smallest sphere if that is empty.
    own: Option<Fraction>,
    /// The least value of the faces with one more vertex; that of the simplex itself.
    regular: Fraction,
    /// The greatest radius of the simplices around it, if it is not on the hull.
    interior: Option<Fraction>,
}

impl Face {
    fn value(&self) -> &Fraction {
        self.own.as_ref().unwrap_or(&self.regular)
    }
}

/// The filtration: the faces by their ascending vertices.
struct Expected {
    /// The simplices; or the triangles or edges of points in a plane or on a line.
    cells: Vec<Vec<u32>>,
    /// The cells across facets.
    beside: Vec<Vec<usize>>,
    faces: BTreeMap<Vec<u32>, Face>,
    radii: Vec<Fraction>,
}

/// More than any radius.
fn never() -> Fraction {
    Fraction(BigInt::from(1) << 9100, BigInt::from(1))
}

fn faces_of(simplex: &[u32]) -> impl Iterator<Item = Vec<u32>> {
    let mut sorted = simplex.to_vec();
    sorted.sort_unstable();
    (1u32..1 << sorted.len())
        .map(move |mask| (0..sorted.len()).filter(|k| mask >> k & 1 == 1).map(|k| sorted[k]).collect())
}

/// Returns a cell without one of its vertices, sorted.
fn without(cell: &[u32], k: usize) -> Vec<u32> {
    let mut facet: Vec<u32> = (0..cell.len()).filter(|&l| l != k).map(|l| cell[l]).collect();
    facet.sort_unstable();
    facet
}

fn expected<const D: usize>(cells: Vec<Vec<u32>>, duplicate_of: &[u32], points: &[[f64; D]]) -> Expected {
    let is_full = cells.iter().all(|cell| cell.len() == D + 1);
    let exact: Vec<[BigInt; D]> = points.iter().map(|p| p.map(integer)).collect();
    let vertices: Vec<usize> = (0..points.len()).filter(|&v| duplicate_of[v] == gdel::NONE).collect();
    let sphere = |face: &[u32]| Sphere::new(face.iter().map(|&v| &exact[v as usize]).collect());
    let radii: Vec<Fraction> = cells.iter().map(|t| sphere(t).squared_radius()).collect();
    let mut of_facets: BTreeMap<Vec<u32>, Vec<usize>> = BTreeMap::new();
    for (t, cell) in cells.iter().enumerate() {
        (0..cell.len()).for_each(|k| of_facets.entry(without(cell, k)).or_default().push(t));
    }
    let mut around: BTreeMap<Vec<u32>, Vec<usize>> = BTreeMap::new();
    let mut on_hull = BTreeSet::new();
    let mut beside = vec![Vec::new(); cells.len()];
    for (t, cell) in cells.iter().enumerate() {
        for face in faces_of(cell) {
            around.entry(face).or_default().push(t);
        }
        if !is_full {
            on_hull.extend(faces_of(cell));
        }
        for facet in (0..cell.len()).map(|k| without(cell, k)) {
            beside[t].extend(of_facets[&facet].iter().filter(|&&other| other != t));
            if of_facets[&facet].len() == 1 {
                on_hull.extend(faces_of(&facet));
            }
        }
    }
    // The largest faces first: the others need their values.
    let mut order: Vec<Vec<u32>> = around.keys().cloned().collect();
    order.sort_by_key(|face| std::cmp::Reverse(face.len()));
    let mut faces: BTreeMap<Vec<u32>, Face> = BTreeMap::new();
    // The values of the faces with one more vertex.
    let mut regular: BTreeMap<Vec<u32>, Fraction> = BTreeMap::new();
    for face in order {
        let own = if face.len() == 1 {
            Some(Fraction(BigInt::ZERO, BigInt::from(1)))
        } else {
            let sphere = sphere(&face);
            let is_empty = face.len() == D + 1
                || !vertices.iter().any(|&v| !face.contains(&(v as u32)) && sphere.contains(&exact[v]));
            is_empty.then(|| sphere.squared_radius())
        };
        let greatest = || around[&face].iter().map(|&t| &radii[t]).max_by(|a, b| a.compare(b)).unwrap().clone();
        let interior = (!on_hull.contains(&face)).then(greatest);
        let largest = || if is_full { own.clone() } else { Some(never()) };
        let regular_here = regular.remove(&face).or_else(largest).unwrap();
        let face_here = Face { own, regular: regular_here, interior };
        for left_out in 0..face.len() {
            let below: Vec<u32> = (0..face.len()).filter(|&k| k != left_out).map(|k| face[k]).collect();
            let least = regular.entry(below).or_insert_with(|| face_here.value().clone());
            if face_here.value().compare(least).is_lt() {
                *least = face_here.value().clone();
            }
        }
        faces.insert(face, face_here);
    }
    Expected { cells, beside, faces, radii }
}

fn near(found: f64, expected: f64) -> bool {
    found == expected || (found - expected).abs() <= 1e-9 * expected
}

impl Expected {
    fn face(&self, vertices: &[u32]) -> &Face {
        let mut vertices = vertices.to_vec();
        vertices.sort_unstable();
        &self.faces[&vertices]
    }

    fn check_interval(&self, name: &str, vertices: &[u32], interval: Interval) {
        let face = self.face(vertices);
        let (value, regular) = (face.value().root(), face.regular.root());
        assert!(near(interval.singular, value), "{name} {vertices:?}: {interval:?} {value}");
        assert!(near(interval.regular, regular), "{name} {vertices:?}: {interval:?} {regular}");
        let interior = face.interior.as_ref().map_or(f64::INFINITY, Fraction::root);
        assert!(near(interval.interior, interior), "{name} {vertices:?}: {interval:?} {interior}");
    }

    fn class(&self, vertices: &[u32], alpha: &Fraction) -> FaceClass {
        let face = self.face(vertices);
        let is_in = |value: &Fraction| value.compare(alpha).is_le();
        if face.interior.as_ref().is_some_and(is_in) {
            FaceClass::Interior
        } else if is_in(&face.regular) {
            FaceClass::Regular
        } else if is_in(face.value()) {
            FaceClass::Singular
        } else {
            FaceClass::Exterior
        }
    }

    /// The critical radii, each once.
    fn critical(&self) -> Vec<Fraction> {
        let own = self.faces.iter().filter(|(face, _)| face.len() > 1).filter_map(|(_, face)| face.own.clone());
        let mut critical: Vec<Fraction> = own.collect();
        critical.sort_by(Fraction::compare);
        critical.dedup_by(|a, b| a.compare(b).is_eq());
        critical
    }
}

/// Components of cells across facets, by search.
fn count_components(beside: &[Vec<usize>], is_solid: &[bool]) -> usize {
    let mut seen = vec![false; is_solid.len()];
    let mut count = 0;
    for start in 0..is_solid.len() {
        if !is_solid[start] || seen[start] {
            continue;
        }
        count += 1;
        let mut pending = vec![start];
        seen[start] = true;
        while let Some(t) = pending.pop() {
            for &across in &beside[t] {
                if is_solid[across] && !std::mem::replace(&mut seen[across], true) {
                    pending.push(across);
                }
            }
        }
    }
    count
}

/// The edges of triangles, or the ends of edges, in both directions, balance.
fn assert_closed<const D: usize>(name: &str, surface: &[[u32; D]]) {
    let mut balance: BTreeMap<Vec<u32>, i32> = BTreeMap::new();
    for facet in surface {
        for k in 0..D {
            if D == 3 {
                let (a, b) = (facet[k], facet[(k + 1) % D]);
                *balance.entry(vec![a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
            } else {
                *balance.entry(vec![facet[k]]).or_default() += if k == 0 { 1 } else { -1 };
            }
        }
    }
    assert!(balance.values().all(|&balance| balance == 0), "{name}");
}

/// The facets of a mesh as they are in the simplices with the lower indices, sorted.
fn facets_of<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>) -> Vec<[u32; D]>
where
    Euclidean: Geometry<D, N>,
{
    let mut facets = Vec::new();
    for (t, (simplex, across)) in mesh.simplices().iter().zip(&*mesh.opposites()).enumerate() {
        for (k, corners) in <Euclidean as Geometry<D, N>>::FACETS.iter().enumerate() {
            if across[k] == gdel::NONE || t < across[k] as usize {
                facets.push(corners.map(|corner| simplex[corner]));
            }
        }
    }
    facets.sort_unstable();
    facets
}

/// The edges of a 3D mesh, which in 2D are facets.
type EdgesOf<'f, S> = &'f dyn Fn(&S, f64) -> Vec<(Vec<u32>, Interval, FaceClass)>;

/// The simplices; or the triangles or edges of points in a plane or on a line.
fn cells_of<const D: usize, const N: usize>(
    mesh: &impl Mesh<D, N>,
    shape: &AlphaShape<D, N>,
    edges_of: EdgesOf<'_, AlphaShape<D, N>>,
) -> Vec<Vec<u32>>
where
    Euclidean: AlphaEdges<D, N>,
{
    if !mesh.simplices().is_empty() {
        return mesh.simplices().iter().map(|simplex| simplex.to_vec()).collect();
    }
    match shape.facets().map(|(facet, _)| facet.to_vec()).collect::<Vec<_>>() {
        facets if facets.is_empty() => edges_of(shape, 1.0).into_iter().map(|(edge, ..)| edge).collect(),
        facets => facets,
    }
}

fn check<'m, const D: usize, const N: usize, M: Mesh<D, N>>(
    name: &str,
    mesh: &'m M,
    points: &'m [[f64; D]],
    edges_of: EdgesOf<'_, AlphaShape<D, N>>,
) where
    Euclidean: AlphaEdges<D, N>,
{
    let shape = AlphaShape::new(mesh, Points::F64(points)).unwrap();
    let is_flat = mesh.simplices().is_empty();
    let expected = expected(cells_of(mesh, &shape, edges_of), mesh.duplicate_of(), points);
    for (t, radius) in shape.simplices().enumerate() {
        assert!(near(radius, expected.radii[t].root()), "{name}: {radius}");
    }
    let mut facets: Vec<[u32; D]> = shape.facets().map(|(facet, _)| facet).collect();
    facets.sort_unstable();
    if !is_flat {
        assert_eq!(facets, facets_of(mesh), "{name}: as they are in the simplices with the lower indices");
    }
    let mut count = shape.simplices().len();
    for (facet, interval) in shape.facets() {
        count += 1;
        expected.check_interval(name, &facet, interval);
    }
    for (edge, interval, _) in edges_of(&shape, 1.0) {
        count += 1;
        expected.check_interval(name, &edge, interval);
    }
    for (v, interval) in shape.vertices() {
        if !expected.cells.is_empty() {
            count += 1;
            expected.check_interval(name, &[v], interval);
        }
    }
    assert_eq!(count, expected.faces.len(), "{name}");

    let critical = expected.critical();
    let found = shape.critical_values();
    assert_eq!(found.len(), critical.len(), "{name}");
    for (found, critical) in found.iter().zip(&critical) {
        let exact = critical.root();
        assert!(near(*found, exact) && *found >= exact, "{name}: {found} {exact}");
    }

    // Radii at which something changes, and those just before and after them.
    let mut alphas = vec![0.0, 1.0, 0.37, f64::INFINITY, f64::MAX];
    for critical in critical.iter().step_by(critical.len() / 8 + 1) {
        let root = critical.root();
        alphas.extend([root, root.next_up(), root.next_down(), root * 1.5, 2.0 * root, root / 2.0]);
    }
    for alpha in alphas {
        if alpha.is_nan() || alpha < 0.0 {
            continue;
        }
        let complex = shape.at(alpha).unwrap();
        let largest = || Fraction(BigInt::from(1) << 9000, BigInt::from(1));
        let squared =
            if alpha.is_infinite() { largest() } else { Fraction(integer(alpha) * integer(alpha), BigInt::from(1)) };
        let is_solid: Vec<bool> = expected.radii.iter().map(|radius| radius.compare(&squared).is_le()).collect();
        let solid: Vec<usize> = (0..is_solid.len()).filter(|&t| is_solid[t] && !is_flat).collect();
        assert_eq!(complex.solid().collect::<Vec<_>>(), solid, "{name} {alpha}");
        let surface: Vec<_> = complex.surface().collect();
        assert_closed(name, &surface);
        let (labels, components) = complex.components();
        assert_eq!(components, count_components(&expected.beside, &is_solid), "{name} {alpha}");
        assert!(labels.iter().zip(&is_solid).all(|(&label, &is_solid)| (label != gdel::NONE) == is_solid));
        let mut next = 0;
        for label in labels.into_iter().filter(|&label| label != gdel::NONE) {
            assert!(label <= next, "{name} {alpha}: in the order of the first simplices");
            next = next.max(label + 1);
        }
        for (facet, class) in complex.facets() {
            assert_eq!(class, expected.class(&facet, &squared), "{name} {alpha} {facet:?}");
        }
        for (edge, _, class) in edges_of(&shape, alpha) {
            assert_eq!(class, expected.class(&edge, &squared), "{name} {alpha} {edge:?}");
        }
        for (v, class) in complex.vertices() {
            if expected.cells.is_empty() {
                assert_eq!(class, FaceClass::Singular, "{name}");
            } else {
                assert_eq!(class, expected.class(&[v], &squared), "{name} {alpha} {v}");
            }
        }
    }

    check_smallest(name, mesh, &shape, &expected);
}

/// Checks the smallest alpha with all vertices and so many components.
fn check_smallest<const D: usize, const N: usize>(
    name: &str,
    mesh: &impl Mesh<D, N>,
    shape: &AlphaShape<D, N>,
    Expected { cells, beside, radii, .. }: &Expected,
) where
    Euclidean: AlphaEdges<D, N>,
{
    let mut sorted = radii.to_vec();
    sorted.sort_by(Fraction::compare);
    for components in [0, 1, 2, 5] {
        let best = sorted.iter().find(|&radius| {
            let is_solid: Vec<bool> = radii.iter().map(|other| other.compare(radius).is_le()).collect();
            let mut is_covered: Vec<bool> = mesh.duplicate_of().iter().map(|&d| d != gdel::NONE).collect();
            for (simplex, _) in cells.iter().zip(&is_solid).filter(|(_, is_solid)| **is_solid) {
                simplex.iter().for_each(|&v| is_covered[v as usize] = true);
            }
            is_covered.iter().all(|&is_covered| is_covered) && count_components(beside, &is_solid) <= components
        });
        let found = shape.find_alpha(components);
        assert_eq!(found.is_some(), best.is_some(), "{name} {components}");
        if let (Some(found), Some(best)) = (found, best) {
            let squared = |alpha: f64| Fraction(integer(alpha) * integer(alpha), BigInt::from(1));
            // Nothing between it and the exact radius.
            assert!(found.is_infinite() || squared(found).compare(best).is_ge(), "{name} {components}");
            assert!(squared(found.next_down()).compare(best).is_lt(), "{name} {components}");
        }
    }
}

fn check3(name: &str, points: &[[f64; 3]]) {
    let mesh = mesh3(points);
    check(name, &mesh, points, &|shape, alpha| {
        let complex = shape.at(alpha).unwrap();
        shape
            .edges()
            .zip(complex.edges())
            .map(|((edge, interval), (_, class))| (edge.to_vec(), interval, class))
            .collect()
    });
}

#[test]
fn the_filtration_in_3d_is_that_of_the_definition() {
    for (name, points) in inputs3() {
        check3(name, &points[..points.len().min(30)]);
    }
}

#[test]
fn the_filtration_in_2d_is_that_of_the_definition() {
    for (name, points) in inputs2() {
        let points = &points[..points.len().min(40)];
        let mesh = mesh2(points);
        check(name, &mesh, points, &|_, _| vec![]);
    }
}

/// On a sphere all radii are the same up to the last bits, in a grid whose coordinates are rounded
/// most of them.
#[test]
fn radii_that_differ_in_their_last_bits_are_told_apart() {
    let grid = clouds::grid(4).iter().map(|p| p.map(|x| x * 0.05)).collect();
    for (name, points) in [("sphere", generate3d(Distribution3::Sphere, 100, 1)), ("rounded grid", grid)] {
        let mesh = mesh3(&points);
        let shape = AlphaShape::new(&mesh, &points).unwrap();
        let exact: Vec<[BigInt; 3]> = points.iter().map(|p| p.map(integer)).collect();
        // Numbers of a thousand digits would take long.
        let zeros = exact.as_flattened().iter().filter_map(BigInt::trailing_zeros).min().unwrap();
        let exact: Vec<[BigInt; 3]> = exact.into_iter().map(|p| p.map(|x| x >> zeros)).collect();
        let squared_radius = |t: &[u32; 4]| {
            let Fraction(numerator, denominator) =
                Sphere::new(t.iter().map(|&v| &exact[v as usize]).collect()).squared_radius();
            Fraction(numerator << (2 * zeros), denominator)
        };
        let radii: Vec<Fraction> = mesh.tetrahedra.iter().map(squared_radius).collect();
        let cells = mesh.tetrahedra.iter().map(|cell| cell.to_vec()).collect();
        let beside = mesh
            .neighbors
            .iter()
            .map(|across| across.iter().filter(|&&t| t != gdel::NONE).map(|&t| t as usize).collect());
        let expected = Expected { cells, beside: beside.collect(), faces: BTreeMap::new(), radii };
        check_smallest(name, &mesh, &shape, &expected);
    }
}

#[test]
fn negative_radii_are_errors() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mesh = mesh2(&points);
    let shape = AlphaShape::new(&mesh, &points).unwrap();
    assert_eq!(shape.at(f64::NAN).unwrap_err(), Error::BadAlpha);
    assert_eq!(shape.at(-0.5).unwrap_err(), Error::BadAlpha);
    assert_eq!(shape.at(-0.0).unwrap().solid().count(), 0);
}

/// `benches/peers/alpha.cpp` has made the files: the smallest alpha with one component, and for
/// some radii how many vertices, edges, facets and simplices are exterior, singular, regular and
/// interior.
#[test]
fn alpha_complexes_equal_those_of_cgal() {
    for (distribution, file) in [
        (Distribution3::Uniform, include_str!("../data/derived/alpha_uniform.txt")),
        (Distribution3::Sphere, include_str!("../data/derived/alpha_sphere.txt")),
        (Distribution3::Grid, include_str!("../data/derived/alpha_grid.txt")),
    ] {
        let name = distribution.name();
        let points = generate3d(distribution, 1000, 1);
        let mesh = gdel::delaunay3d(&points).unwrap();
        let shape = AlphaShape::new(&mesh, &points).unwrap();
        let mut lines = file.lines();
        let optimal: f64 = lines.next().unwrap().strip_prefix("optimal ").unwrap().parse().unwrap();
        let alpha = shape.find_alpha(1).unwrap();
        assert!((alpha - optimal).abs() <= 1e-12 * optimal, "{name}: {alpha} {optimal}");
        for line in lines {
            let (radius, counts) = line.split_once(' ').unwrap();
            let expected: Vec<usize> = counts.split(' ').map(|count| count.parse().unwrap()).collect();
            let complex = shape.at(radius.parse().unwrap()).unwrap();
            let mut found = [0; 16];
            let mut add = |kind: usize, class: FaceClass| found[4 * kind + class as usize] += 1;
            complex.vertices().for_each(|(_, class)| add(0, class));
            complex.edges().for_each(|(_, class)| add(1, class));
            complex.facets().for_each(|(_, class)| add(2, class));
            let solid = complex.solid().count();
            (0..solid).for_each(|_| add(3, FaceClass::Interior));
            (solid..mesh.tetrahedra.len()).for_each(|_| add(3, FaceClass::Exterior));
            // On a grid, edges, facets and simplices depend on how ties are broken.
            let kinds = if name == "grid" { 4 } else { 16 };
            assert_eq!(found[..kinds], expected[..kinds], "{name} {radius}");
        }
    }
}

/// Returns the share of the hull's volume that the solid for a radius has.
fn filled(points: &[[f64; 3]], alpha: impl Fn(&AlphaShape) -> f64) -> f64 {
    let mesh = mesh3(points);
    let shape = AlphaShape::new(&mesh, points).unwrap();
    let volumes: Vec<f64> = mesh.volumes(points).collect();
    let solid: f64 = shape.at(alpha(&shape)).unwrap().solid().map(|t| volumes[t]).sum();
    solid / volumes.iter().sum::<f64>()
}

/// Points along a spiral on a sphere.
fn spiral(count: usize) -> Vec<[f64; 3]> {
    let point = |i: usize| {
        let (z, turn) = (1.0 - (2 * i + 1) as f64 / count as f64, 2.399963229728653 * i as f64);
        let r = (1.0 - z * z).sqrt();
        [r * turn.cos(), r * turn.sin(), z]
    };
    (0..count).map(point).collect()
}

#[test]
fn the_solid_of_a_sphere_is_its_ball_although_the_last_bits_of_the_radii_differ() {
    for count in [20, 500, 3000] {
        let points = spiral(count);
        let share = filled(&points, |shape| shape.auto_alpha(1).unwrap());
        assert!(share > 0.999_999, "{count}: {share}");
    }
}

#[test]
fn the_solid_of_a_grid_whose_corners_are_rounded_is_its_box() {
    let corner = |i: u32| [i % 6, i / 6 % 6, i / 36].map(|x| f64::from(x) * 0.1);
    let points: Vec<[f64; 3]> = (0..216).map(corner).collect();
    let share = filled(&points, |shape| shape.auto_alpha(1).unwrap());
    assert!((share - 1.0).abs() < 1e-12, "{share}");
}

#[test]
fn a_radius_typed_with_17_digits_takes_what_is_meant() {
    let points: Vec<[f64; 3]> = (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
    // The root of 3/4 is a little more.
    let typed: f64 = "0.86602540378443864".parse().unwrap();
    assert_eq!(filled(&points, |_| typed), 0.0);
    assert_eq!(filled(&points, |shape| shape.up_to_rounding(typed)), 1.0);
    assert_eq!(filled(&points, |shape| shape.up_to_rounding(0.86)), 0.0);
}

#[test]
fn radii_that_differ_by_more_than_rounding_are_not_taken() {
    let points = spiral(9);
    let mesh = mesh3(&points);
    let shape = AlphaShape::new(&mesh, &points).unwrap();
    let alpha = shape.auto_alpha(1).unwrap();
    assert!(alpha >= shape.find_alpha(1).unwrap() && alpha < 1.0 + 1e-12);
    assert_eq!(shape.up_to_rounding(f64::INFINITY), f64::INFINITY);
    assert_eq!(shape.up_to_rounding(0.0), 0.0);
}
