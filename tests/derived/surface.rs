//! Closed surfaces, checked without the library: by counting, and against shapes of known volume.

use crate::{
    clouds,
    inputs::{inputs2, inputs3, mesh2, mesh3},
};
use gdel::{
    Error, Mesh, Points, Side, Surface, SurfaceOptions,
    internals::{
        d3::generate::{Distribution3, generate3d},
        derived::SurfaceMesh,
        geometry::Euclidean,
    },
};
use std::{
    collections::{BTreeMap, BTreeSet},
    f64::consts::{PI, TAU},
};

fn surface3(points: &[[f64; 3]]) -> Surface {
    checked(&mesh3(points), points, &as_they_are())
}

/// Options with which points are neither dropped nor moved.
fn as_they_are<const D: usize>() -> SurfaceOptions<'static, D> {
    let mut options = SurfaceOptions::default();
    (options.drop_isolated, options.smooth) = (false, Some(0));
    options
}

/// Finds the surface, and checks what holds for every surface.
fn checked<const D: usize, const N: usize>(
    mesh: &impl Mesh<D, N>,
    points: &[[f64; D]],
    options: &SurfaceOptions<'_, D>,
) -> Surface<D, N>
where
    Euclidean: SurfaceMesh<D, N>,
{
    let surface = Surface::new(mesh, Points::F64(points), options).unwrap();
    check(mesh, points, &surface);
    surface
}

/// The ridges of a facet with their directions: edges in 3D; vertices, where edges end or start, in 2D.
fn ridges<const D: usize>(facet: &[u32; D]) -> Vec<(Vec<u32>, i32)> {
    if D == 2 {
        return vec![(vec![facet[0]], -1), (vec![facet[1]], 1)];
    }
    let edges = [[facet[0], facet[1]], [facet[1], facet[2]], [facet[2], facet[0]]];
    edges.map(|[a, b]| (vec![a.min(b), a.max(b)], if a < b { 1 } else { -1 })).into()
}

fn determinant(rows: &[Vec<f64>]) -> f64 {
    match rows {
        [a, b] => a[0] * b[1] - a[1] * b[0],
        [a, b, c] => {
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        }
        _ => unreachable!("two or three rows"),
    }
}

/// The largest distance along an axis.
fn largest<const D: usize>(points: &[[f64; D]], from: [f64; D]) -> f64 {
    let distances = points.iter().flat_map(|p| (0..D).map(|axis| (p[axis] - from[axis]).abs()).collect::<Vec<_>>());
    distances.fold(0.0, f64::max)
}

fn sorted<const K: usize>(mut list: [u32; K]) -> [u32; K] {
    list.sort_unstable();
    list
}

/// Counts ridges and facets, compares with the boundary of the solid, and adds up the volume.
fn check<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]], surface: &Surface<D, N>) {
    let (vertices, facets, sources) = (surface.vertices(), surface.facets(), surface.sources());
    assert_eq!(vertices.len(), sources.len());
    assert!(sources.is_sorted());
    let is_point = |&v: &u32| sources[v as usize] != u32::MAX;
    assert!((0..).zip(vertices).all(|(v, p)| !is_point(&v) || *p == points[sources[v as usize] as usize]));

    let mut around: BTreeMap<Vec<u32>, Vec<i32>> = BTreeMap::new();
    for (ridge, direction) in facets.iter().flat_map(ridges) {
        around.entry(ridge).or_default().push(direction);
    }
    assert!(around.values().all(|directions| directions.len() == 2 && directions[0] + directions[1] == 0));
    assert!(surface.is_closed());
    // No facet twice; every vertex has facets, which are one cycle.
    assert_eq!(facets.iter().map(|&facet| sorted(facet)).collect::<BTreeSet<_>>().len(), facets.len());
    let mut links: Vec<Vec<[u32; 2]>> = vec![Vec::new(); vertices.len()];
    for facet in facets {
        for (i, &v) in facet.iter().enumerate() {
            links[v as usize].push([facet[(i + 1) % D], facet[(i + 2) % D]]);
        }
    }
    for link in links {
        if D == 2 {
            assert_eq!(link.len(), 2);
            continue;
        }
        let next: BTreeMap<u32, u32> = link.iter().map(|&[a, b]| (a, b)).collect();
        let mut at = link[0][0];
        let length = (1..=link.len()).find(|_| {
            at = next[&at];
            at == link[0][0]
        });
        assert_eq!((length, next.len()), (Some(link.len()), link.len()));
    }

    // The solid consists of simplices of the mesh, and its boundary is the surface.
    let all: BTreeSet<[u32; N]> = mesh.simplices().iter().map(|&simplex| sorted(simplex)).collect();
    let mut boundary: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
    let mut volume = 0.0;
    for simplex in surface.solid() {
        assert!(all.contains(&sorted(*simplex)));
        for k in 0..N {
            let facet: Vec<u32> = sorted(*simplex).into_iter().filter(|&v| v != simplex[k]).collect();
            *boundary.entry(facet).or_default() += 1;
        }
        let origin = points[simplex[0] as usize];
        let edge = |&v: &u32| (0..D).map(|axis| points[v as usize][axis] - origin[axis]).collect::<Vec<f64>>();
        volume += determinant(&simplex[1..].iter().map(edge).collect::<Vec<_>>());
    }
    let expected: BTreeSet<Vec<u32>> = boundary.into_iter().filter(|&(_, count)| count == 1).map(|(f, _)| f).collect();
    let whole = || facets.iter().filter(|facet| facet.iter().all(is_point));
    let found: BTreeSet<Vec<u32>> = whole().map(|f| sorted(f.map(|v| sources[v as usize])).to_vec()).collect();
    assert_eq!(found.len(), whole().count());
    assert!(found.is_subset(&expected));
    if found.len() == facets.len() {
        assert_eq!(found, expected);
    }
    let volume = volume / if D == 3 { 6.0 } else { 2.0 };
    if volume.is_normal() && volume < 1e100 {
        assert!((surface.volume() - volume).abs() <= 1e-9 * volume, "{} {volume}", surface.volume());
        // Also by the divergence theorem, which cancels.
        let middle = vertices[0];
        let relative = |&v: &u32| (0..D).map(|axis| vertices[v as usize][axis] - middle[axis]).collect::<Vec<f64>>();
        let terms: Vec<f64> = facets.iter().map(|f| determinant(&f.iter().map(relative).collect::<Vec<_>>())).collect();
        let sum = terms.iter().sum::<f64>() / if D == 3 { 6.0 } else { 2.0 };
        let size: f64 = terms.iter().map(|term| term.abs()).sum();
        let extent = terms.len() as f64 * f64::EPSILON * largest(vertices, middle).powi(D as i32);
        assert!((sum - volume).abs() <= 1e-9 * (volume + size) + extent, "{sum} {volume}");
    }

    // Points of the solid are on the surface or inside.
    let used: BTreeSet<u32> = sources.iter().copied().collect();
    let solid: BTreeSet<u32> = surface.solid().as_flattened().iter().copied().collect();
    for (i, &side) in (0..).zip(surface.sides()) {
        let vertex = Some(mesh.duplicate_of()[i as usize]).filter(|&d| d != gdel::NONE).unwrap_or(i);
        let expected = match (used.contains(&vertex), solid.contains(&vertex)) {
            (true, _) => Side::On,
            (_, true) => Side::Inside,
            _ => Side::Outside,
        };
        assert_eq!(side, expected);
    }
}

/// Random points of [0, 1)³, for shapes.
pub(crate) fn random(n: usize, seed: u64) -> Vec<[f64; 3]> {
    generate3d(Distribution3::Uniform, n, seed)
}

pub(crate) fn sphere(n: usize, radius: f64) -> Vec<[f64; 3]> {
    generate3d(Distribution3::Sphere, n, 5).iter().map(|p| p.map(|x| radius * x)).collect()
}

/// Random points of a torus with radii 1 and 0.4, of equal density.
pub(crate) fn torus(n: usize) -> Vec<[f64; 3]> {
    let points = random(3 * n, 7).into_iter().map(|[u, v, w]| (TAU * u, TAU * v, w));
    let kept = points.filter(|&(_, v, w)| w * 1.4 < 1.0 + 0.4 * libm::cos(v));
    kept.map(|(u, v, _)| {
        let r = 1.0 + 0.4 * libm::cos(v);
        [r * libm::cos(u), r * libm::sin(u), 0.4 * libm::sin(v)]
    })
    .take(n)
    .collect()
}

/// Points of the faces of a box, on a grid of `step`.
pub(crate) fn grid_box(low: [f64; 3], counts: [u32; 3], step: f64) -> Vec<[f64; 3]> {
    let [nx, ny, nz] = counts;
    (0..=nx)
        .flat_map(|x| (0..=ny).flat_map(move |y| (0..=nz).map(move |z| [x, y, z])))
        .filter(|p| p.iter().zip(counts).any(|(&i, n)| i == 0 || i == n))
        .map(|p| [0, 1, 2].map(|axis| low[axis] + step * f64::from(p[axis])))
        .collect()
}

/// Moves each point by a random vector of about this length.
pub(crate) fn noisy(points: &[[f64; 3]], amount: f64) -> Vec<[f64; 3]> {
    let by = generate3d(Distribution3::Gaussian, points.len(), 11);
    points.iter().zip(by).map(|(p, by)| [0, 1, 2].map(|axis| p[axis] + amount * by[axis])).collect()
}

#[track_caller]
fn assert_volume(surface: &Surface, expected: f64, tolerance: f64) {
    let volume = surface.volume();
    assert!((volume / expected - 1.0).abs() < tolerance, "{volume} instead of {expected}");
}

#[test]
fn a_sphere() {
    for n in [30, 500, 5000] {
        let surface = surface3(&sphere(n, 2.0));
        assert_eq!((surface.components(), surface.genus(), surface.facets().len()), (1, 0, 2 * n - 4), "{n}");
        assert_volume(&surface, 4.0 / 3.0 * PI * 8.0, 20.0 / n as f64);
    }
}

#[test]
fn a_torus() {
    let surface = surface3(&torus(15_000));
    assert_eq!((surface.components(), surface.genus()), (1, 1));
    assert!((29_900..=30_000).contains(&surface.facets().len()), "{}", surface.facets().len());
    assert_volume(&surface, 2.0 * PI * PI * 0.16, 0.005);
}

#[test]
fn a_thin_plate() {
    let points = random(15_000, 3).into_iter().enumerate().map(|(i, [x, y, w])| {
        // The sides have a twelfth of the points.
        match i % 24 {
            0 => [x, (w < 0.5) as u8 as f64, 0.05 * y],
            1 => [(w < 0.5) as u8 as f64, x, 0.05 * y],
            _ => [x, y, if w < 0.5 { 0.0 } else { 0.05 }],
        }
    });
    let surface = surface3(&points.collect::<Vec<_>>());
    assert_eq!((surface.components(), surface.genus()), (1, 0));
    assert_volume(&surface, 0.05, 0.01);
}

#[test]
fn the_bunny() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/bunny.ply");
    let cloud = gdel_io::files::read_points(std::path::Path::new(path)).expect("the bunny");
    let points: Vec<[f64; 3]> = Points::from(&cloud).iter().collect();
    let surface = surface3(&points);
    assert_eq!((surface.components(), surface.genus(), surface.vertices().len()), (1, 0, 35_933));
    assert_volume(&surface, 0.000755, 0.001);
    // An eighth of the points.
    let sparse: Vec<_> = points.into_iter().step_by(8).collect();
    let surface = surface3(&sparse);
    assert_eq!((surface.components(), surface.genus()), (1, 0));
    assert_volume(&surface, 0.000755, 0.02);
}

#[test]
fn moderate_noise() {
    // A spacing of points is 0.08, and of the torus's 0.03.
    let surface = surface3(&noisy(&sphere(2000, 1.0), 0.01));
    assert_eq!((surface.components(), surface.genus()), (1, 0));
    assert_volume(&surface, 4.0 / 3.0 * PI, 0.03);
    let surface = surface3(&noisy(&torus(15_000), 0.004));
    assert_eq!((surface.components(), surface.genus()), (1, 1));
    assert_volume(&surface, 2.0 * PI * PI * 0.16, 0.02);
}

#[test]
fn inputs_of_all_kinds_have_closed_surfaces() {
    for (name, points) in inputs3() {
        println!("{name}");
        let surface = surface3(&points);
        assert!(surface.volume() >= 0.0 && surface.area() >= 0.0);
    }
    for (name, points) in inputs2() {
        println!("{name}");
        let surface = checked(&mesh2(&points), &points, &as_they_are());
        assert_eq!(surface.genus(), 0);
    }
}

#[test]
fn too_few_and_flat_points_have_no_solid() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [2.0, 5.0, 0.0]];
    let twins = [[1.0, 2.0, 3.0]; 6];
    let few = (0..5).map(|count| &points[..count]).chain([&twins[..]]);
    for points in few {
        let count = points.len();
        let surface = surface3(points);
        assert_eq!((surface.facets(), surface.vertices(), surface.solid()), (&[][..], &[][..], &[][..]));
        assert_eq!((surface.volume(), surface.area(), surface.components(), surface.genus()), (0.0, 0.0, 0, 0));
        assert_eq!(surface.sides(), vec![Side::Outside; count]);
    }
    let points = [[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]];
    assert!(checked(&mesh2(&points), &points, &as_they_are()).facets().is_empty());
    // Four points are the smallest solid.
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(surface3(&points).facets().len(), 4);
}

#[test]
fn boxes_that_touch() {
    let one = grid_box([0.0; 3], [8, 6, 4], 0.5);
    let surface = surface3(&one);
    assert_eq!((surface.components(), surface.genus()), (1, 0));
    assert_volume(&surface, 24.0, 1e-12);
    // In a face, which is not seen from outside; in an edge; in a corner.
    let contacts = [([4.0, 0.0, 0.0], 1), ([4.0, 3.0, 0.0], 2), ([4.0, 3.0, 2.0], 2)];
    for (at, components) in contacts {
        let surface = surface3(&[one.clone(), grid_box(at, [8, 6, 4], 0.5)].concat());
        assert_eq!((surface.components(), surface.genus()), (components, 0), "{at:?}");
        assert_volume(&surface, 48.0, 0.01);
    }
}

#[test]
fn coarse_boxes_have_edges_and_no_noise() {
    let boxes = [grid_box([0.0; 3], [8, 6, 4], 0.5), grid_box([6.0, 0.0, 0.0], [8, 6, 4], 0.5)].concat();
    let surface = Surface::new(&mesh3(&boxes), &boxes, &SurfaceOptions::default()).unwrap();
    assert_eq!((surface.noise(), surface.components(), surface.genus()), (0.0, 2, 0));
    assert_volume(&surface, 48.0, 0.02);
}

#[test]
fn a_sphere_inside_another_is_a_cavity() {
    let surface = surface3(&[sphere(3000, 2.0), sphere(1000, 1.0)].concat());
    assert_eq!((surface.components(), surface.genus()), (2, 0));
    assert_volume(&surface, 4.0 / 3.0 * PI * 7.0, 0.005);
}

#[test]
fn specks_are_dropped() {
    let far = sphere(60, 0.2).into_iter().map(|[x, y, z]| [x + 5.0, y, z]);
    let points: Vec<_> = sphere(2000, 2.0).into_iter().chain(far).collect();
    let surface = surface3(&points);
    assert_eq!((surface.components(), surface.dropped()), (1, [1, 0]));
    assert!(surface.sides()[..2000].iter().all(|&side| side == Side::On));
    assert!(surface.sides()[2000..].iter().all(|&side| side == Side::Outside));
    let mut options = as_they_are();
    options.min_part = 0.0;
    let surface = checked(&mesh3(&points), &points, &options);
    assert_eq!((surface.components(), surface.dropped()), (2, [0, 0]));
    for bad in [-0.5, 1.5, f64::NAN] {
        options.min_part = bad;
        let error = Surface::new(&mesh3(&points), &points, &options).unwrap_err();
        assert_eq!(error, Error::BadOption { option: "min_part", range: "a number from 0 to 1" });
    }
}

#[test]
fn curves_in_the_plane() {
    // A ring between two circles, and a disk far away; unordered.
    let circle = |n: usize, [x, y]: [f64; 2], r: f64| {
        (0..n).map(move |i| 7 * i % n).map(move |i| {
            let angle = TAU * i as f64 / n as f64;
            [x + r * libm::cos(angle), y + r * libm::sin(angle)]
        })
    };
    let points: Vec<_> =
        circle(200, [0.0; 2], 2.0).chain(circle(100, [0.1, 0.0], 1.0)).chain(circle(50, [4.0, 1.0], 0.7)).collect();
    let surface = checked(&mesh2(&points), &points, &as_they_are());
    assert_eq!((surface.components(), surface.facets().len()), (3, 350));
    assert!((surface.volume() / (PI * 3.49) - 1.0).abs() < 0.01, "{}", surface.volume());
    assert!((surface.area() / (TAU * 3.7) - 1.0).abs() < 0.01, "{}", surface.area());
}

/// The facets by the coordinates of their corners.
fn in_space(surface: &Surface) -> Vec<[[u64; 3]; 3]> {
    let corners = |facet: &[u32; 3]| {
        let mut corners = facet.map(|v| surface.vertices()[v as usize].map(f64::to_bits));
        corners.sort_unstable();
        corners
    };
    let mut facets: Vec<_> = surface.facets().iter().map(corners).collect();
    facets.sort_unstable();
    facets
}

#[test]
fn the_order_of_points_and_duplicates_do_not_matter() {
    for points in [noisy(&torus(3000), 0.01), sphere(500, 1.0), random(300, 1)] {
        let surface = surface3(&points);
        let shuffled = clouds::shuffled(&points, 4);
        let other = surface3(&shuffled);
        assert_eq!(in_space(&surface), in_space(&other));
        assert_eq!((surface.volume(), surface.dropped()), (other.volume(), other.dropped()));
        // Three of ten are duplicates.
        let doubled = [&points[..], &points[..points.len() * 3 / 7]].concat();
        let doubled = clouds::shuffled(&doubled, 5);
        assert_eq!(in_space(&surface), in_space(&surface3(&doubled)));
    }
}

#[test]
fn scale_does_not_matter() {
    let points = noisy(&torus(1000), 0.01);
    let surface = surface3(&points);
    for factor in [libm::ldexp(1.0, -300), libm::ldexp(1.0, 300)] {
        let other = surface3(&points.iter().map(|p| p.map(|x| factor * x)).collect::<Vec<_>>());
        assert_eq!((surface.facets(), surface.sides()), (other.facets(), other.sides()));
        assert_eq!(surface.volume() * factor.powi(2) * factor, other.volume());
    }
    let singles: Vec<[f32; 3]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
    let doubles: Vec<[f64; 3]> = singles.iter().map(|p| p.map(f64::from)).collect();
    let single = Surface::new(&gdel::delaunay3d(&singles).unwrap(), &singles, &as_they_are()).unwrap();
    assert_eq!(in_space(&single), in_space(&surface3(&doubles)));
}

#[test]
fn noise_is_noticed_and_smoothed() {
    let clean = torus(15_000);
    let default = SurfaceOptions::<3>::default();
    let surface = checked(&mesh3(&clean), &clean, &default);
    assert!(surface.noise() < 0.02 && surface.moved_points().is_none(), "{}", surface.noise());
    // A third of the distance between points, with which the cut alone is empty or in pieces.
    let points = noisy(&clean, 0.01);
    let mut options = SurfaceOptions::default();
    options.drop_isolated = false;
    let surface = Surface::new(&mesh3(&points), &points, &options).unwrap();
    let moved = surface.moved_points().expect("there is noise");
    assert!(surface.noise() > 0.1, "{}", surface.noise());
    check(&mesh3(moved), moved, &surface);
    assert_eq!((surface.components(), surface.genus()), (1, 1));
    assert_volume(&surface, 2.0 * PI * PI * 0.16, 0.02);
    let distance = |p: &[f64; 3]| (libm::hypot(libm::hypot(p[0], p[1]) - 1.0, p[2]) - 0.4).abs();
    let mean = |points: &[[f64; 3]]| points.iter().map(distance).sum::<f64>() / points.len() as f64;
    assert!(mean(moved) < 0.5 * mean(&points), "{} {}", mean(moved), mean(&points));
}

#[test]
fn coordinates_that_are_rounded_have_a_surface() {
    // Nearly flat tetrahedra on the faces have circumspheres of any size.
    let rounded = |x: f64| libm::rint(500.0 * x) / 500.0;
    let half = random(8000, 3).into_iter().map(|[u, v, w]| {
        let (sine, cosine) = (libm::sin(TAU * u), libm::cos(TAU * u));
        let z = 2.0 * v - 1.0;
        let r = 0.3 * (1.0 - z * z).sqrt();
        if w < 0.3 { [r * cosine, r * sine, 0.3 * z + 0.7f64.copysign(z)] } else { [0.3 * cosine, 0.3 * sine, 0.7 * z] }
    });
    let points: Vec<_> = half.map(|p| p.map(rounded)).collect();
    let surface = surface3(&points);
    assert_eq!((surface.components(), surface.genus()), (1, 0));
    assert_volume(&surface, PI * 0.09 * 1.4 + 4.0 / 3.0 * PI * 0.027, 0.01);
}

#[test]
fn sparse_points_of_thin_rings_are_no_noise() {
    // Two rings through each other, as a chain: of 40 neighbours some are on the other side of their ring.
    let ring = |shift: f64, is_turned: bool| {
        torus(500).into_iter().map(move |[x, y, z]| {
            let r = libm::hypot(x, y);
            let (x, y, r) = (x / r, y / r, 1.0 + 0.75 * (r - 1.0));
            if is_turned { [r * x + shift, 0.75 * z, r * y] } else { [r * x + shift, r * y, 0.75 * z] }
        })
    };
    let points: Vec<_> = ring(-0.5, false).chain(ring(0.5, true)).collect();
    let surface = Surface::new(&mesh3(&points), &points, &SurfaceOptions::default()).unwrap();
    assert!(surface.moved_points().is_none(), "{}", surface.noise());
    assert_eq!((surface.components(), surface.genus()), (2, 2));
    assert_volume(&surface, 2.0 * 2.0 * PI * PI * 0.09, 0.1);
}

/// Asserts that every edge has one triangle in each direction.
#[track_caller]
fn assert_closed(surface: &Surface) {
    let mut directions: BTreeMap<[u32; 2], [usize; 2]> = BTreeMap::new();
    for &[a, b, c] in surface.facets() {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            assert_ne!(a, b);
            directions.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
        }
    }
    assert!(directions.values().all(|&count| count == [1, 1]));
}

#[test]
fn degenerate_inputs_have_closed_surfaces() {
    let grid = |n: u32, at: f64| (0..n * n * n).map(move |i| [i % n, i / n % n, i / n / n].map(|x| at + f64::from(x)));
    // Points that fill a volume lie on no surface; whatever is found is closed.
    let solid_grid: Vec<_> = grid(9, 0.0).collect();
    for options in [SurfaceOptions::default(), as_they_are()] {
        assert_closed(&Surface::new(&mesh3(&solid_grid), &solid_grid, &options).unwrap());
    }
    let ball = sphere(2000, 1.0);
    let doubled: Vec<_> = ball.iter().chain(&ball[..857]).copied().collect();
    let boxes = [grid_box([0.0; 3], [8, 6, 4], 0.5), grid_box([4.0, 0.0, 0.0], [8, 6, 4], 0.5)].concat();
    let inner: Vec<_> = torus(3000).into_iter().chain(sphere(4000, 3.0)).collect();
    // Name, points, volume, components, genus.
    let cases = [
        ("duplicates", doubled, 4.0 / 3.0 * PI, 1, 0),
        ("touching boxes", boxes, 48.0, 1, 0),
        ("a scan in another", inner, 4.0 / 3.0 * PI * 27.0 - 2.0 * PI * PI * 0.16, 2, 1),
    ];
    for (name, points, volume, components, genus) in cases {
        for options in [SurfaceOptions::default(), as_they_are()] {
            let surface = Surface::new(&mesh3(&points), &points, &options).unwrap();
            println!("{name}: {} {} {}", surface.volume(), surface.components(), surface.genus());
            assert_closed(&surface);
            assert_eq!((surface.components(), surface.genus()), (components, genus), "{name}");
            assert_volume(&surface, volume, 0.02);
        }
    }
}

#[test]
fn isolated_points_are_dropped() {
    let mut points = torus(4000);
    points.extend(random(40, 9).iter().map(|p| p.map(|x| 4.0 * x - 2.0)));
    points.push(points[0]);
    let surface = Surface::new(&mesh3(&points), &points, &SurfaceOptions::default()).unwrap();
    assert!((30..=40).contains(&surface.isolated()), "{}", surface.isolated());
    assert!(surface.is_closed() && surface.moved_points().is_none());
    assert_eq!((surface.components(), surface.genus()), (1, 1));
    assert_volume(&surface, 2.0 * PI * PI * 0.16, 0.03);
    assert!(surface.sides()[..4000].iter().filter(|&&side| side == Side::On).count() > 3980);
    assert_eq!(surface.sides()[4040], surface.sides()[0]);
    assert!(surface.sides()[4000..4040].iter().filter(|&&side| side == Side::Outside).count() >= surface.isolated());
}

#[test]
fn outliers_that_are_near_each_other_are_dropped() {
    let clean = torus(15_000);
    let volume = surface3(&clean).volume();
    for percent in [1, 5] {
        let outliers = random(150 * percent, 9);
        let mut points = clean.clone();
        points.extend(outliers.iter().map(|p| p.map(|x| 4.0 * x - 2.0)));
        let surface = Surface::new(&mesh3(&points), &points, &SurfaceOptions::default()).unwrap();
        println!("{percent} %: {} of {} dropped, {}", surface.isolated(), outliers.len(), surface.volume() / volume);
        assert_closed(&surface);
        assert!(surface.isolated() > outliers.len() * 8 / 10);
        assert_eq!((surface.components(), surface.genus()), (1, 1));
        assert_volume(&surface, volume, 0.02);
        assert!(surface.sides()[..15_000].iter().filter(|&&side| side == Side::On).count() > 14_800);
    }
}

#[test]
fn scans_that_become_sparse_keep_their_points() {
    // A sphere with fewer and fewer points towards one pole, where they are eight times as far apart.
    let is_seen = |&(i, p): &(usize, [f64; 3])| {
        let up = (1.0 + p[2]) / 2.0;
        i % (1 + (63.0 * up * up) as usize) == 0
    };
    let points: Vec<_> = sphere(20_000, 1.0).into_iter().enumerate().filter(is_seen).map(|(_, p)| p).collect();
    let surface = Surface::new(&mesh3(&points), &points, &SurfaceOptions::default()).unwrap();
    assert_eq!((surface.isolated(), surface.components(), surface.genus()), (0, 1, 0));
    assert_volume(&surface, 4.0 / 3.0 * PI, 0.05);
}
