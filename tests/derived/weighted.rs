//! Answers of meshes of weighted points: location, the least power distance, and power diagrams.

use crate::{
    inputs::{inputs2, inputs3, mesh2, mesh3, queries},
    locate,
    nearest::integer,
    voronoi::{bounds, boxes},
};
use gdel::{
    Backend, Cell, Clip, Editable, Error, Interpolator, Locator, Mesh, Mesh2, Mesh3, NONE, Points, Triangulator,
    Voronoi,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        derived::VoronoiShapes,
        geometry::{Euclidean, Geometry},
    },
};
use num_bigint::BigInt;
use rand::RngExt;
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};

/// What meshes of both dimensions say of their points.
pub trait Weighted<const D: usize, const N: usize>: Mesh<D, N> + Sized {
    fn regular(points: &[[f64; D]], weights: &[f64]) -> Self;
    fn hidden(&self) -> &[u32];
    fn is_spanned(&self) -> bool;
}

impl Weighted<3, 4> for Mesh3 {
    fn regular(points: &[[f64; 3]], weights: &[f64]) -> Self {
        Triangulator::new().regular3d(points, weights).unwrap()
    }

    fn hidden(&self) -> &[u32] {
        &self.hidden
    }

    fn is_spanned(&self) -> bool {
        self.dimension == 3
    }
}

impl Weighted<2, 3> for Mesh2 {
    fn regular(points: &[[f64; 2]], weights: &[f64]) -> Self {
        Triangulator::new().regular2d(points, weights).unwrap()
    }

    fn hidden(&self) -> &[u32] {
        &self.hidden
    }

    fn is_spanned(&self) -> bool {
        self.dimension == 2
    }
}

const KINDS: [&str; 6] = ["small", "few", "large", "flattening", "absurd", "negative"];

/// Weights of several kinds, with names.
fn weights<const D: usize>(points: &[[f64; D]], seed: u64) -> Vec<(&'static str, Vec<f64>)> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let [low, high] = bounds(points);
    let size = (0..D).map(|i| high[i] / 2.0 - low[i] / 2.0).fold(0.0, f64::max);
    // A power of two near the square of the spacing, as far as there is one.
    let unit = 2f64.powi(2 * (size.clamp(1e-150, 1e150).log2() as i32) - 6);
    let mut all = |weight: &mut dyn FnMut(&mut Pcg64Mcg, &[f64; D]) -> f64| -> Vec<f64> {
        points.iter().map(|p| weight(&mut random, p)).collect()
    };
    let square = |p: &[f64; D]| p.iter().map(|x| x * x).sum::<f64>();
    vec![
        ("small", all(&mut |random, _| 0.1 * unit * random.random::<f64>())),
        ("few", all(&mut |random, _| unit * f64::from(random.random_range(-1..3)))),
        // Most are hidden.
        ("large", all(&mut |random, _| 100.0 * unit * random.random::<f64>())),
        // Lifted to a plane, or nearly.
        ("flattening", all(&mut |_, p| square(p).min(1e300))),
        ("absurd", all(&mut |random, _| if random.random_range(0..9) == 0 { 1e300 } else { 1e-300 })),
        ("negative", all(&mut |random, _| -1e6 * unit * random.random::<f64>())),
    ]
}

/// Calls `check` with all inputs of a dimension and all kinds of weights.
fn for_all<M: Weighted<D, N>, const D: usize, const N: usize>(
    inputs: Vec<(&'static str, Vec<[f64; D]>)>,
    kinds: &[&str],
    check: impl Fn(&str, &M, &[[f64; D]], &[f64]),
) {
    for (seed, (name, points)) in (0..).zip(inputs) {
        for (kind, weights) in weights(&points, seed).into_iter().filter(|(kind, _)| kinds.contains(kind)) {
            check(&format!("{name}, {kind}"), &M::regular(&points, &weights), &points, &weights);
        }
    }
}

/// Checks nearest vertices against all power distances in big integers.
fn check_nearest<M: Weighted<D, N>, const D: usize, const N: usize>(
    name: &str,
    mesh: &M,
    points: &[[f64; D]],
    weights: &[f64],
) where
    Euclidean: Geometry<D, N>,
{
    let locator = Locator::new(mesh, Points::F64(points)).unwrap();
    let queries: Vec<_> = queries(points).into_iter().step_by(19).collect();
    let exact: Vec<[BigInt; D]> = points.iter().map(|p| p.map(integer)).collect();
    let exact_weights: Vec<BigInt> = weights.iter().map(|&w| integer(w) << 1074).collect();
    let is_vertex = |i: &usize| mesh.duplicate_of()[*i] == NONE && !mesh.hidden().contains(&(*i as u32));
    let nearest = locator.nearest_many(Points::F64(&queries)).unwrap();
    for (&q, &nearest) in queries.iter().zip(&nearest) {
        let exact_q = q.map(integer);
        let distance = |i: usize| -> BigInt {
            exact[i].iter().zip(&exact_q).map(|(x, y)| (x - y) * (x - y)).sum::<BigInt>() - &exact_weights[i]
        };
        let mut expected: Vec<(BigInt, u32)> =
            (0..points.len()).filter(is_vertex).map(|i| (distance(i), i as u32)).collect();
        expected.sort();
        assert_eq!(locator.nearest(q).unwrap(), nearest, "{name}: {q:?}");
        if !mesh.is_spanned() {
            // The mesh does not say which points are hidden. A vertex has the least distance nevertheless.
            let least = expected.first().map(|(least, _)| least);
            assert_eq!(nearest.map(|v| distance(v as usize)).as_ref(), least, "{name}: {q:?}");
            let all = locator.nearest_k(q, points.len()).unwrap();
            let distances: Vec<_> = all.iter().map(|&v| (distance(v as usize), v)).collect();
            assert!(distances.is_sorted() && all.first() == nearest.as_ref(), "{name}: {q:?}");
            continue;
        }
        let expected: Vec<u32> = expected.into_iter().map(|(_, i)| i).collect();
        assert_eq!(nearest, expected.first().copied(), "{name}: {q:?}");
        for k in [0, 1, 7, points.len() + 1] {
            assert_eq!(locator.nearest_k(q, k).unwrap(), expected[..k.min(expected.len())], "{name}: {q:?}");
        }
    }
}

#[test]
fn the_least_power_distances_in_3d() {
    for_all::<Mesh3, 3, 4>(inputs3(), &["few", "large", "flattening", "absurd"], check_nearest);
}

#[test]
fn the_least_power_distances_in_2d() {
    for_all::<Mesh2, 2, 3>(inputs2(), &["few", "large", "flattening", "absurd"], check_nearest);
}

#[test]
fn the_simplex_that_contains_a_query_in_3d() {
    let some = inputs3().into_iter().step_by(3).collect();
    for_all::<Mesh3, 3, 4>(some, &["few"], |name, mesh, points, _| locate::check(name, mesh, points));
}

#[test]
fn the_simplex_that_contains_a_query_in_2d() {
    let some = inputs2().into_iter().step_by(3).collect();
    for_all::<Mesh2, 2, 3>(some, &["few"], |name, mesh, points, _| locate::check(name, mesh, points));
}

/// Checks what holds for every cell: facets are in the radical planes, and neighbours are mutual.
fn check_cells<M: Weighted<D, N>, const D: usize, const N: usize>(
    name: &str,
    mesh: &M,
    points: &[[f64; D]],
    weights: &[f64],
    cells: &[Cell<D>],
    [low, high]: [[f64; D]; 2],
) {
    let size = (0..D).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    for (i, cell) in cells.iter().enumerate() {
        if mesh.duplicate_of()[i] != NONE || mesh.hidden().contains(&(i as u32)) {
            assert!(cell.is_empty() && cell.volume == 0.0 && cell.neighbors().is_empty(), "{name} {i}");
        }
        assert!(cell.volume >= 0.0, "{name} {i}: {}", cell.volume);
        let squared = |p: [f64; D], q: [f64; D]| (0..D).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>();
        for (f, &neighbor) in cell.neighbors.iter().enumerate().filter(|&(_, &neighbor)| neighbor != NONE) {
            let j = neighbor as usize;
            assert!(
                cells[i].volume.min(cells[j].volume) <= 1e-9 * size.powi(D as i32)
                    || cell.areas[f] < 1e-6 * size.powi(D as i32 - 1)
                    || cells[j].neighbors.contains(&(i as u32)),
                "{name}: {i} {j}, {cell:?}, {:?}",
                cells[j]
            );
            for &v in cell.facets.of(f as u32) {
                let corner = cell.vertices[v as usize];
                let [own, other] = [i, j].map(|k| squared(points[k], corner) - weights[k]);
                let scale = squared(points[i], corner).max(size * size).max(weights[i].abs()).max(weights[j].abs());
                assert!((own - other).abs() <= 1e-9 * scale, "{name}: {corner:?} {own} {other}");
            }
        }
    }
}

fn check_diagram<M: Weighted<D, N>, const D: usize, const N: usize>(
    name: &str,
    mesh: &M,
    points: &[[f64; D]],
    weights: &[f64],
) where
    Euclidean: VoronoiShapes<D, N>,
{
    let diagram = |clip| Voronoi::new(mesh, Points::F64(points), clip).unwrap();
    if ["huge", "tiny", "large,", "small,"].iter().any(|kind| name.starts_with(kind)) {
        // Volumes overflow and underflow; what is left is that nothing else happens.
        diagram(Clip::None).diagram();
        diagram(Clip::Hull).diagram();
        return;
    }
    for bounds in boxes(points) {
        let voronoi = diagram(Clip::Box(bounds));
        let cells = voronoi.map_cells(|_, cell| cell.clone());
        check_cells(name, mesh, points, weights, &cells, bounds);
        let sum: f64 = cells.iter().map(|cell| cell.volume).sum();
        let whole: f64 = (0..D).map(|i| bounds[1][i] - bounds[0][i]).product();
        assert!((sum - whole).abs() <= 1e-9 * whole, "{name} {bounds:?}: {sum}, not {whole}");
        for cell in &cells {
            assert!(cell.is_bounded, "{name}");
            assert_eq!(cell.volume == 0.0, cell.centroid[0].is_nan(), "{name} {bounds:?} {cell:?}");
            let slack = |k: usize| 1e-9 * (bounds[1][k] - bounds[0][k]);
            let within =
                |k: usize| bounds[0][k] - slack(k) <= cell.centroid[k] && cell.centroid[k] <= bounds[1][k] + slack(k);
            assert!(cell.volume <= 1e-9 * whole || (0..D).all(within), "{name} {bounds:?} {cell:?}");
        }
    }
    if mesh.simplices().is_empty() {
        return;
    }
    let hull = diagram(Clip::Hull);
    let corners = |simplex: &[u32; N]| simplex.map(|v| points[v as usize]);
    let measure = |simplex: &[u32; N]| {
        let corners = corners(simplex);
        let edges: [[f64; D]; D] = std::array::from_fn(|i| std::array::from_fn(|k| corners[i + 1][k] - corners[0][k]));
        Euclidean::determinant(&edges) / if D == 2 { 2.0 } else { 6.0 }
    };
    let whole: f64 = mesh.simplices().iter().map(measure).sum();
    let sum: f64 = hull.volumes().iter().sum();
    let [low, high] = bounds(points);
    let bulk = (0..D).map(|i| high[i] - low[i]).fold(0.0, f64::max).powi(D as i32);
    assert!((sum - whole).abs() <= 1e-9 * whole + 1e-13 * bulk, "{name}: {sum} {whole}");
    check_cells(name, mesh, points, weights, &hull.map_cells(|_, cell| cell.clone()), [low, high]);
    // Unbounded cells are those of the hull's vertices.
    let all = diagram(Clip::None);
    let mut on_hull = vec![false; points.len()];
    for (simplex, opposites) in mesh.simplices().iter().zip(&*mesh.opposites()) {
        for k in (0..N).filter(|&k| opposites[k] == NONE) {
            (0..N).filter(|&l| l != k).for_each(|l| on_hull[simplex[l] as usize] = true);
        }
    }
    for (i, (cell, on_hull)) in all.map_cells(|_, cell| cell.clone()).iter().zip(&on_hull).enumerate() {
        // Because of ties, all of a cell may be within a place or a ray.
        if !cell.is_empty() {
            assert_eq!((cell.is_bounded, cell.volume.is_finite()), (!on_hull, !on_hull), "{name} {i}");
        }
        assert!(cell.simplices.iter().zip(&cell.vertices).all(|(&t, p)| all.vertices()[t as usize] == *p), "{name}");
    }
}

#[test]
fn cells_in_3d() {
    for_all::<Mesh3, 3, 4>(inputs3(), &KINDS, check_diagram);
}

#[test]
fn cells_in_2d() {
    for_all::<Mesh2, 2, 3>(inputs2(), &KINDS, check_diagram);
}

/// Cuts a convex polygon in space, and keeps x·normal ≤ offset.
fn cut(polygon: &[[f64; 3]], normal: [f64; 3], offset: f64) -> Vec<[f64; 3]> {
    let value = |p: &[f64; 3]| (0..3).map(|k| p[k] * normal[k]).sum::<f64>() - offset;
    let mut kept = Vec::new();
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (s, t) = (value(p), value(q));
        if s <= 0.0 {
            kept.push(*p);
        }
        if (s <= 0.0) != (t <= 0.0) {
            kept.push(std::array::from_fn(|k| p[k] + s / (s - t) * (q[k] - p[k])));
        }
    }
    kept
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the volume of what of a box is in all half-spaces x·normal ≤ offset: each facet is what the others leave of
/// a large square in its plane.
fn volume_of(all: &[([f64; 3], f64)]) -> f64 {
    let is_same = |&(a, s): &([f64; 3], f64), &(b, t): &([f64; 3], f64)| {
        let along = (0..3).find(|&k| b[k] != 0.0).unwrap();
        a[along] * b[along] > 0.0 && (0..3).all(|k| a[k] * b[along] == b[k] * a[along]) && s * b[along] == t * a[along]
    };
    let mut half_spaces: Vec<([f64; 3], f64)> = Vec::new();
    for half_space in all {
        if !half_spaces.iter().any(|other| is_same(half_space, other)) {
            half_spaces.push(*half_space);
        }
    }
    let mut volume = 0.0;
    for (i, &(normal, offset)) in half_spaces.iter().enumerate() {
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        let unit = normal.map(|x| x / length);
        let axis = (0..3).min_by(|&i, &j| unit[i].abs().total_cmp(&unit[j].abs())).unwrap();
        let mut other = [0.0; 3];
        other[axis] = 1.0;
        let u = cross(unit, other);
        let norm = u.iter().map(|x| x * x).sum::<f64>().sqrt();
        let u = u.map(|x| x / norm);
        let v = cross(unit, u);
        let corner = |a: f64, b: f64| std::array::from_fn(|k| unit[k] * offset / length + 1e3 * (a * u[k] + b * v[k]));
        let mut facet = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        for (j, &(normal, offset)) in half_spaces.iter().enumerate() {
            if j != i {
                facet = cut(&facet, normal, offset);
            }
        }
        for pair in facet.get(1..).unwrap_or_default().windows(2) {
            let [a, b]: [[f64; 3]; 2] = [0, 1].map(|j| std::array::from_fn(|k| pair[j][k] - facet[0][k]));
            let area: f64 = cross(a, b).iter().zip(unit).map(|(x, y)| x * y).sum::<f64>() / 2.0;
            volume += area * offset / length / 3.0;
        }
    }
    volume
}

/// Returns what the half-spaces towards all other sites leave of a box, which begins at the origin.
fn brute_force(sites: &[[f64; 3]], weights: &[f64], i: usize, size: [f64; 3]) -> f64 {
    let mut half_spaces = Vec::new();
    for axis in 0..3 {
        let mut normal = [0.0; 3];
        normal[axis] = 1.0;
        half_spaces.extend([(normal, size[axis]), (normal.map(|x| -x), 0.0)]);
    }
    let square = |p: [f64; 3]| p.iter().map(|x| x * x).sum::<f64>();
    for j in (0..sites.len()).filter(|&j| j != i) {
        let normal = std::array::from_fn(|k| 2.0 * (sites[j][k] - sites[i][k]));
        half_spaces.push((normal, square(sites[j]) - square(sites[i]) + weights[i] - weights[j]));
    }
    volume_of(&half_spaces)
}

/// Points of small grids, with weights of which many lift several to the same plane: each cell is what the half-spaces
/// leave, and the cells fill the hull.
#[test]
fn cells_of_small_grids() {
    for seed in 0..400 {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let side = random.random_range(2..5);
        let is_flat = seed % 2 == 0;
        let mut points: Vec<[f64; 3]> = (0..random.random_range(4..16))
            .map(|_| std::array::from_fn(|_| f64::from(random.random_range(0..side))))
            .map(|[x, y, z]| [x, y, if is_flat { 0.0 } else { z }])
            .collect();
        points.sort_by(|p, q| p.partial_cmp(q).unwrap());
        points.dedup();
        let steps = random.random_range(1..9);
        let weights: Vec<f64> = points.iter().map(|_| f64::from(random.random_range(0..steps)) * 0.5).collect();
        if is_flat {
            check_grid::<Mesh2, 2, 3>(&points, &weights, side.into());
        } else {
            check_grid::<Mesh3, 3, 4>(&points, &weights, side.into());
        }
    }
}

fn check_grid<M: Weighted<D, N>, const D: usize, const N: usize>(points: &[[f64; 3]], weights: &[f64], side: f64)
where
    Euclidean: VoronoiShapes<D, N>,
{
    let sites: Vec<[f64; D]> = points.iter().map(|p| std::array::from_fn(|k| p[k])).collect();
    let volumes = |weights: &[f64], clip| {
        let mesh = M::regular(&sites, weights);
        let voronoi = Voronoi::new(&mesh, Points::F64(&sites), clip).unwrap();
        (mesh.is_spanned(), voronoi.volumes())
    };
    let (is_spanned, of_box) = volumes(weights, Clip::Box([[0.0; D], [side; D]]));
    if !is_spanned {
        return;
    }
    let size = if D == 2 { [side, side, 1.0] } else { [side; 3] };
    for (i, volume) in of_box.into_iter().enumerate() {
        let expected = brute_force(points, weights, i, size);
        assert!((volume - expected).abs() < 1e-9, "{i}: {volume}, not {expected}, {points:?} {weights:?}");
    }
    let sum = |weights: &[f64]| volumes(weights, Clip::Hull).1.iter().sum::<f64>();
    let (sum, expected) = (sum(weights), sum(&vec![0.0; points.len()]));
    assert!((sum - expected).abs() < 1e-9, "{sum}, not {expected}, {points:?} {weights:?}");
}

/// The cells are what the half-spaces towards all other points leave of the box. In 2D, the box has a height of 1.
#[test]
fn cells_are_what_all_half_spaces_leave() {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let mut hidden = 0;
    for round in 0..60 {
        let largest = [0.02, 0.3, 3.0][round % 3];
        let points: Vec<[f64; 3]> = (0..14).map(|_| std::array::from_fn(|_| random.random())).collect();
        let weights: Vec<f64> = points.iter().map(|_| largest * (random.random::<f64>() - 0.5)).collect();
        let flat: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
        let (space, plane) = (Mesh3::regular(&points, &weights), Mesh2::regular(&flat, &weights));
        hidden += space.hidden.len() + plane.hidden.len();
        let volumes = Voronoi::new(&space, &points, Clip::Box([[0.0; 3], [1.0; 3]])).unwrap().volumes();
        let areas = Voronoi::new(&plane, &flat, Clip::Box([[0.0; 2], [1.0; 2]])).unwrap().volumes();
        for i in 0..points.len() {
            for (sites, found) in
                [(points.clone(), volumes[i]), (flat.iter().map(|p| [p[0], p[1], 0.5]).collect(), areas[i])]
            {
                let expected = brute_force(&sites, &weights, i, [1.0; 3]);
                assert!((found - expected).abs() < 1e-9, "{round} {i}: {found}, not {expected}");
            }
        }
    }
    assert!(hidden > 100, "{hidden}");
}

/// An affine function of the coordinates, added to the weights, moves the diagram by half of its slope.
#[test]
fn affine_functions_move_the_diagram() {
    let points = generate3d(Distribution3::Uniform, 200, 3);
    let flat = generate2d(Distribution2::Uniform, 200, 3);
    let mut random = Pcg64Mcg::seed_from_u64(2);
    let weights: Vec<f64> = points.iter().map(|_| 0.05 * random.random::<f64>()).collect();
    let slope = [3.0, -17.5, 8.25];
    fn moved<const D: usize>(points: &[[f64; D]], weights: &[f64], slope: [f64; 3]) -> Vec<f64> {
        let added = |p: &[f64; D]| p.iter().zip(slope).map(|(x, s)| x * s).sum::<f64>() + 100.0;
        points.iter().zip(weights).map(|(p, w)| w + added(p)).collect()
    }
    fn check<M: Weighted<D, N>, const D: usize, const N: usize>(points: &[[f64; D]], weights: &[f64], slope: [f64; 3])
    where
        Euclidean: VoronoiShapes<D, N>,
    {
        let by: [f64; D] = std::array::from_fn(|k| -0.5 * slope[k]);
        let (mesh, other) = (M::regular(points, weights), M::regular(points, &moved(points, weights, slope)));
        assert!(!mesh.hidden().is_empty() && mesh.hidden() == other.hidden());
        let cells = |mesh: &M, corner: [f64; D]| {
            let clip = Clip::Box([corner, corner.map(|x| x + 1.0)]);
            let voronoi = Voronoi::new(mesh, Points::F64(points), clip).unwrap();
            (voronoi.volumes(), voronoi.centroids(), voronoi.neighbors())
        };
        let ((volumes, centroids, neighbors), others) = (cells(&mesh, [0.0; D]), cells(&other, by));
        assert_eq!(neighbors, others.2);
        for i in 0..points.len() {
            assert!((volumes[i] - others.0[i]).abs() < 1e-11);
            // The centre of mass of a small cell is not as certain.
            let far = |k: usize| (centroids[i][k] + by[k] - others.1[i][k]).abs() > 1e-6;
            assert!(volumes[i] < 1e-6 || !(0..D).any(far), "{i}");
        }
    }
    check::<Mesh3, 3, 4>(&points, &weights, slope);
    check::<Mesh2, 2, 3>(&flat, &weights, slope);
}

/// Weights that are all equal are no weights. Nor do they change anything in a mesh that has them.
#[test]
fn equal_weights_change_nothing() {
    let points = generate3d(Distribution3::Uniform, 300, 9);
    let plain = mesh3(&points);
    let mut mesh = plain.clone();
    mesh.weights = vec![0.25; points.len()];
    let queries = queries(&points);
    let [a, b] = [&plain, &mesh].map(|mesh| Locator::new(mesh, &points).unwrap());
    assert_eq!(a.locate_many(&queries), b.locate_many(&queries));
    assert_eq!(a.nearest_many(&queries), b.nearest_many(&queries));
    for clip in [Clip::None, Clip::Hull, Clip::Box([[0.0; 3], [1.0; 3]])] {
        let [a, b] = [&plain, &mesh].map(|mesh| Voronoi::new(mesh, &points, clip).unwrap());
        assert_eq!(a.neighbors(), b.neighbors());
        for (a, b) in a.volumes().iter().zip(b.volumes()) {
            assert!(*a == b || (a - b).abs() < 1e-12, "{a} {b}");
        }
    }
    // On a grid, the cells of the two have exactly the same facets.
    let grid: Vec<[f64; 2]> = (0..81).map(|i| [i % 9, i / 9].map(f64::from)).collect();
    let plain = mesh2(&grid);
    let mut mesh = plain.clone();
    mesh.weights = vec![-7.0; grid.len()];
    let [a, b] = [&plain, &mesh].map(|mesh| Voronoi::new(mesh, &grid, Clip::None).unwrap().diagram());
    assert_eq!((a.vertices, a.facets, a.neighbors), (b.vertices, b.facets, b.neighbors));
    assert_eq!((a.areas, a.volumes), (b.areas, b.volumes));
}

/// The corners hide all others but one, whose ball is larger than the square.
#[test]
fn hidden_points_have_no_cells() {
    let mut points = generate2d(Distribution2::Uniform, 500, 1);
    points.extend([[-9.0, -9.0], [30.0, -9.0], [-9.0, 30.0], [0.5, 0.5]]);
    let mut weights = vec![0.0; 500];
    weights.extend([1e6, 1e6, 1e6, 1e6 + 300.0]);
    let mesh = Mesh2::regular(&points, &weights);
    assert_eq!(mesh.hidden.len(), 500);
    let voronoi = Voronoi::new(&mesh, &points, Clip::Box([[0.0; 2], [1.0; 2]])).unwrap();
    assert!(voronoi.volumes()[..503].iter().all(|&area| area == 0.0));
    assert!((voronoi.volumes()[503] - 1.0).abs() < 1e-12);
    assert!(voronoi.cell(7).is_empty() && voronoi.neighbors().of(7).is_empty());
    assert_eq!(voronoi.relaxed()[..503], points[..503]);
    let locator = Locator::new(&mesh, &points).unwrap();
    assert!(locator.nearest_many(&points[..500]).unwrap().iter().all(|&v| v == Some(503)));
    assert_eq!(locator.nearest_k([0.5, 0.5], 600).unwrap().len(), 4);
}

/// A site may be outside its own cell, and the cell of a vertex of the hull outside the hull.
#[test]
fn sites_outside_their_cells() {
    let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0], [0.75, 1.0]];
    let weights = [0.0, 0.0, 0.0, 0.0, 2.0];
    let mesh = Mesh2::regular(&points, &weights);
    assert!(mesh.hidden.is_empty());
    let square = Voronoi::new(&mesh, &points, Clip::Hull).unwrap();
    let areas = square.volumes();
    // The bisectors of the left corners are beyond them.
    assert_eq!((areas[0], areas[2]), (0.0, 0.0));
    assert!(square.cell(0).is_empty() && square.cell(2).is_empty());
    assert!((areas.iter().sum::<f64>() - 4.0).abs() < 1e-14 && areas[1] > 0.0 && areas[3] > 0.0);
    assert_eq!(Locator::new(&mesh, &points).unwrap().nearest(points[0]), Ok(Some(4)));
    let corners = [[-4.0, 1.0], [1.0, -4.0], [6.0, 1.0], [1.0, 6.0]];
    let diamond = Voronoi::new(&mesh, &points, Clip::Convex(&corners)).unwrap();
    assert!((diamond.volumes().iter().sum::<f64>() - 50.0).abs() < 1e-12);
    assert!(diamond.volumes().iter().all(|&area| area > 0.0));

    // A heavy corner of a cube takes all of it.
    let cube: Vec<[f64; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
    let mut weights = [0.0; 8];
    weights[5] = 8.0;
    let mesh = Mesh3::regular(&cube, &weights);
    let volumes = Voronoi::new(&mesh, &cube, Clip::Hull).unwrap().volumes();
    assert!((volumes[5] - 1.0).abs() < 1e-14 && volumes.iter().filter(|&&volume| volume == 0.0).count() == 7);
}

/// The vertices of a diagram have the same power distance to the vertices of their simplices.
#[test]
fn vertices_are_power_centres() {
    let mut random = Pcg64Mcg::seed_from_u64(8);
    for scale in [1e-200, 1e-9, 1.0, 1e70] {
        let points: Vec<[f64; 3]> =
            generate3d(Distribution3::Uniform, 300, 2).iter().map(|p| p.map(|x| x * scale)).collect();
        let weights: Vec<f64> = points.iter().map(|_| 0.02 * random.random::<f64>() * scale * scale).collect();
        let mesh = Mesh3::regular(&points, &weights);
        let voronoi = Voronoi::new(&mesh, &points, Clip::None).unwrap();
        for (simplex, vertex) in mesh.tetrahedra.iter().zip(voronoi.vertices()) {
            let squared = |v: u32| -> f64 {
                let p = points[v as usize];
                (0..3).map(|k| ((p[k] - vertex[k]) / scale).powi(2)).sum()
            };
            let power = |v: u32| squared(v) - weights[v as usize] / scale / scale;
            let first = power(simplex[0]);
            let tolerance = 1e-10 * (1.0 + squared(simplex[0]));
            assert!(simplex.iter().all(|&v| (power(v) - first).abs() < tolerance), "{scale}: {simplex:?} {vertex:?}");
        }
    }
}

/// Points of a line and of a plane have power diagrams in their own dimension.
#[test]
fn flat_points_have_power_diagrams() {
    let line = [[0.0, 0.0], [2.0, 4.0], [1.0, 2.0], [4.0, 8.0]];
    // The bisector of the second and the last one is at 3.25 in x. The third one is hidden.
    let mesh = Mesh2::regular(&line, &[0.0, 0.0, -20.0, -5.0]);
    let voronoi = Voronoi::new(&mesh, &line, Clip::Hull).unwrap();
    let root = 5f64.sqrt();
    let expected = [root, root * 2.25, 0.0, root * 0.75];
    let lengths = voronoi.volumes();
    assert!(lengths.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-13), "{lengths:?}, not {expected:?}");
    assert_eq!((voronoi.cell(1).neighbors(), voronoi.cell(2).neighbors()), (vec![0, 3], vec![]));
    let solid = Voronoi::new(&mesh, &line, Clip::Box([[0.0, -1.0], [4.0, 9.0]])).unwrap();
    assert!((solid.volumes().iter().sum::<f64>() - 40.0).abs() < 1e-12 && solid.volumes()[2] == 0.0);
    let locator = Locator::new(&mesh, &line).unwrap();
    assert_eq!(locator.nearest_many(&[[1.0, 2.0], [9.0, 9.0]]).unwrap(), [Some(0), Some(3)]);
    assert_eq!(locator.nearest_k([1.1, 2.0], 9).unwrap(), [1, 0, 3]);

    // A plane that is turned without rounding.
    let turned = |[x, y]: [f64; 2]| [x + 2.0 * y + 5.0, 2.0 * x + y - 7.0, 2.0 * x - 2.0 * y + 1.0];
    let mut random = Pcg64Mcg::seed_from_u64(4);
    let plane: Vec<[f64; 2]> =
        (0..60).map(|_| std::array::from_fn(|_| f64::from(random.random_range(0..40)))).collect();
    let space: Vec<[f64; 3]> = plane.iter().map(|&p| turned(p)).collect();
    let weights: Vec<f64> = plane.iter().map(|_| 9.0 * f64::from(random.random_range(0..100))).collect();
    // The plane's lengths are a third.
    let in_plane: Vec<f64> = weights.iter().map(|w| w / 9.0).collect();
    let (flat, mesh) = (Mesh2::regular(&plane, &in_plane), Mesh3::regular(&space, &weights));
    assert!(flat.hidden.len() > 10 && mesh.dimension == 2 && mesh.hidden.is_empty());
    let [areas, expected] = [
        Voronoi::new(&mesh, &space, Clip::Hull).unwrap().volumes(),
        Voronoi::new(&flat, &plane, Clip::Hull).unwrap().volumes(),
    ];
    for (i, (area, expected)) in areas.iter().zip(expected).enumerate() {
        assert!((area - 9.0 * expected).abs() < 1e-9, "{i}: {area}, not {}", 9.0 * expected);
    }
    let (a, b) = (Locator::new(&mesh, &space).unwrap(), Locator::new(&flat, &plane).unwrap());
    for q in queries(&plane).into_iter().step_by(5) {
        // In both the same points are hidden, as only integers are compared.
        assert_eq!(a.nearest(turned(q)), b.nearest(q), "{q:?}");
    }
}

/// What exists for Delaunay triangulations only says so, and so do weights that are none.
#[test]
fn what_is_not_possible() {
    let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [1.0, 1.0]];
    let mut mesh = Mesh2::regular(&points, &[0.0, 0.0, 0.0, 1.0]);
    let locator = Locator::new(&mesh, &points).unwrap();
    assert_eq!(Interpolator::new(&locator, &[0.0; 4]).err(), Some(Error::WeightedMesh));
    mesh.weights.pop();
    assert!(matches!(Locator::new(&mesh, &points), Err(Error::BrokenMesh { .. })));
    mesh.weights.push(f64::NAN);
    assert_eq!(Locator::new(&mesh, &points).err(), Some(Error::BadWeight { index: 3 }));
    assert_eq!(Voronoi::new(&mesh, &points, Clip::Hull).err(), Some(Error::BadWeight { index: 3 }));
}

/// Steps of weights from none to such that hide many, and back.
fn check_updates<M: Weighted<D, N> + Editable<D>, const D: usize, const N: usize>(
    points: &[[f64; D]],
    canonical: impl Fn(&M) -> Vec<[u32; N]>,
) {
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    let mut random = Pcg64Mcg::seed_from_u64(4);
    let mut mesh = M::regular(points, &vec![0.0; points.len()]);
    let mut weights = vec![0.0; points.len()];
    let mut hidden = Vec::new();
    for step in 0..100 {
        let size = if step % 10 == 9 { 0.0 } else { 0.02 * f64::from(step % 10) };
        weights.iter_mut().for_each(|w| *w = size * random.random::<f64>());
        triangulator.update_weights(&mut mesh, Points::F64(points), &weights).unwrap();
        let scratch = M::regular(points, &weights);
        assert_eq!(canonical(&mesh), canonical(&scratch), "{step}");
        assert_eq!((mesh.hidden(), mesh.weights()), (scratch.hidden(), scratch.weights()), "{step}");
        hidden.push(mesh.hidden().len());
    }
    assert!(hidden.iter().any(|&count| count > points.len() / 10) && hidden[9] == 0, "{hidden:?}");
    // The points move as well, with their weights or with others.
    let mut moved = points.to_vec();
    for step in 0..4 {
        moved.iter_mut().flatten().for_each(|x| *x += 0.01 * random.random::<f64>());
        if step % 2 == 0 {
            weights.iter_mut().for_each(|w| *w = 0.05 * random.random::<f64>());
            triangulator.update_weights(&mut mesh, Points::F64(&moved), &weights).unwrap();
        } else {
            triangulator.update(&mut mesh, Points::F64(&moved)).unwrap();
        }
        let scratch = M::regular(&moved, &weights);
        assert_eq!((canonical(&mesh), mesh.hidden()), (canonical(&scratch), scratch.hidden()), "{step}");
        assert_eq!(mesh.weights(), weights);
    }
    let before = canonical(&mesh);
    moved[2][0] = f64::NAN;
    let error = triangulator.update(&mut mesh, Points::F64(&moved)).unwrap_err();
    assert!(matches!(error, Error::NotFinite { index: 2, .. }), "{error}");
    assert_eq!(canonical(&mesh), before);
    weights[3] = f64::NAN;
    let error = triangulator.update_weights(&mut mesh, Points::F64(points), &weights).unwrap_err();
    assert_eq!((error, canonical(&mesh)), (Error::BadWeight { index: 3 }, before));
    let error = triangulator.update_weights(&mut mesh, Points::F64(&points[1..]), &weights[1..]).unwrap_err();
    assert_eq!(error, Error::PointCount { points: points.len() - 1, expected: points.len() });
}

#[test]
fn a_hundred_steps_of_weights_are_those_of_runs_from_scratch() {
    check_updates::<Mesh3, 3, 4>(&generate3d(Distribution3::Uniform, 300, 2), Mesh3::canonical);
    check_updates::<Mesh2, 2, 3>(&generate2d(Distribution2::Uniform, 300, 2), Mesh2::canonical);
}
