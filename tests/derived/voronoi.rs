//! Voronoi diagrams: against brute force by half-planes and half-spaces, and what holds for every
//! diagram.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3};
use gdel::{
    Cell, Clip, Error, Locator, Mesh, Points, Voronoi,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        derived::VoronoiShapes,
        geometry::{Euclidean, Geometry},
    },
};

pub fn bounds<const D: usize>(points: &[[f64; D]]) -> [[f64; D]; 2] {
    let all = |f: fn(f64, f64) -> f64| {
        points.iter().copied().reduce(|p, q| std::array::from_fn(|i| f(p[i], q[i]))).unwrap_or([0.0; D])
    };
    [all(f64::min), all(f64::max)]
}

/// Boxes around the points, and one that cuts through them.
pub fn boxes<const D: usize>(points: &[[f64; D]]) -> Vec<[[f64; D]; 2]> {
    let [low, high] = bounds(points);
    let grown = |by: f64| {
        let by: [f64; D] = std::array::from_fn(|i| by * (high[i] - low[i]));
        [std::array::from_fn(|i| low[i] - by[i]), std::array::from_fn(|i| high[i] + by[i])]
    };
    let all = [grown(0.0), grown(0.5), grown(30.0), grown(-0.25)];
    all.into_iter().filter(|[low, high]| (0..D).all(|i| low[i] < high[i] && (high[i] - low[i]).is_finite())).collect()
}

/// What holds for every cell: facets are bounded by the bisectors, and neighbours are mutual.
fn check_cells<const D: usize, const N: usize>(
    name: &str,
    mesh: &impl Mesh<D, N>,
    points: &[[f64; D]],
    cells: &[Cell<D>],
    size: f64,
) {
    for (i, cell) in cells.iter().enumerate() {
        let at = || format!("{name} {i}");
        assert_eq!(cell.facets.len(), cell.neighbors.len(), "{}", at());
        assert_eq!(cell.facets.len(), cell.areas.len(), "{}", at());
        assert_eq!(cell.vertices.len(), cell.simplices.len(), "{}", at());
        if mesh.duplicate_of()[i] != gdel::NONE {
            assert!(cell.is_empty() && cell.volume == 0.0, "{}", at());
        }
        assert!(cell.volume >= 0.0, "{}: {}", at(), cell.volume);
        let distance = |p: [f64; D], q: [f64; D]| (0..D).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
        if D == 2 {
            // Each edge begins where the one before ends; of an unbounded cell, the first one comes
            // from infinity.
            let ends = |f: usize| {
                let ends = cell.facets.of((f % cell.facets.len()) as u32);
                [ends[0], ends[ends.len() - 1]].map(|v| cell.vertices[v as usize])
            };
            for f in 0..cell.facets.len().saturating_sub(usize::from(!cell.is_bounded)) {
                let ([_, end], [start, _]) = (ends(f), ends(f + 1));
                assert!(distance(end, start) <= 1e-9 * distance(points[i], end).max(size), "{} {f}", at());
            }
        }
        for (f, &neighbor) in cell.neighbors.iter().enumerate() {
            let corners = cell.facets.of(f as u32).iter().map(|&v| cell.vertices[v as usize]);
            if neighbor == gdel::NONE {
                continue;
            }
            assert!(
                cells[neighbor as usize].volume == 0.0
                    || cell.areas[f] < 1e-6 * size.powi(D as i32 - 1)
                    || cells[neighbor as usize].neighbors.contains(&(i as u32)),
                "{} {neighbor}",
                at()
            );
            for corner in corners {
                let [own, other] = [points[i], points[neighbor as usize]].map(|p| distance(p, corner));
                assert!((own - other).abs() <= 1e-9 * own.max(size), "{}: {corner:?} {own} {other}", at());
            }
        }
    }
}

fn check<const D: usize, const N: usize>(name: &str, mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: VoronoiShapes<D, N>,
{
    let diagram = |clip| Voronoi::new(mesh, Points::F64(points), clip).unwrap();
    let [low, high] = bounds(points);
    let size = (0..D).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    if ["huge", "tiny", "large", "small"].contains(&name) {
        // Volumes overflow and underflow; what is left is that nothing else happens.
        diagram(Clip::None).diagram();
        diagram(Clip::Hull).diagram();
        return;
    }
    let has_cells = !points.is_empty();
    for bounds in boxes(points) {
        let voronoi = diagram(Clip::Box(bounds));
        let cells = voronoi.map_cells(|_, cell| cell.clone());
        check_cells(name, mesh, points, &cells, size);
        let sum: f64 = voronoi.volumes().iter().sum();
        let whole: f64 = (0..D).map(|i| bounds[1][i] - bounds[0][i]).product();
        let expected = if has_cells { whole } else { 0.0 };
        assert!((sum - expected).abs() <= 1e-9 * whole, "{name} {bounds:?}: {sum}, not {expected}");
        // Every cell's facets enclose it, and have its area towards the outside.
        for (cell, centroid) in cells.iter().zip(voronoi.centroids()) {
            assert!(cell.is_bounded);
            assert_eq!(cell.is_empty() || cell.volume == 0.0, centroid[0].is_nan(), "{name} {bounds:?} {cell:?}");
            if cell.volume > 1e-9 * whole {
                let within =
                    |k: usize| bounds[0][k] - 1e-9 * size <= centroid[k] && centroid[k] <= bounds[1][k] + 1e-9 * size;
                assert!((0..D).all(within), "{name} {centroid:?}");
            }
        }
    }
    // What flat points have within their own dimension is another matter.
    if mesh.simplices().is_empty() {
        return;
    }
    let hull = diagram(Clip::Hull);
    let sum: f64 = hull.volumes().iter().sum();
    let whole: f64 = mesh
        .simplices()
        .iter()
        .map(|simplex| {
            let corners = simplex.map(|v| points[v as usize]);
            let edges: [[f64; D]; D] =
                std::array::from_fn(|i| std::array::from_fn(|k| corners[i + 1][k] - corners[0][k]));
            Euclidean::determinant(&edges) / if D == 2 { 2.0 } else { 6.0 }
        })
        .sum();
    let bulk = size.powi(D as i32);
    assert!((sum - whole).abs() <= 1e-9 * whole + 1e-14 * bulk, "{name}: {sum} {whole}");
    check_cells(name, mesh, points, &hull.map_cells(|_, cell| cell.clone()), size);

    let all = diagram(Clip::None);
    let cells = all.map_cells(|_, cell| cell.clone());
    let mut on_hull = vec![false; points.len()];
    for (simplex, opposites) in mesh.simplices().iter().zip(&*mesh.opposites()) {
        for k in (0..N).filter(|&k| opposites[k] == gdel::NONE) {
            (0..N).filter(|&l| l != k).for_each(|l| on_hull[simplex[l] as usize] = true);
        }
    }
    for (i, (cell, on_hull)) in cells.iter().zip(&on_hull).enumerate() {
        assert_eq!(cell.is_bounded, !on_hull, "{name}");
        assert_eq!(cell.volume.is_infinite(), *on_hull, "{name}");
        assert!(cell.simplices.iter().zip(&cell.vertices).all(|(&t, p)| all.vertices()[t as usize] == *p), "{name}");
        assert_eq!(cell.areas.iter().any(|a| a.is_infinite()), *on_hull, "{name}");
        // Unbounded cells share their unbounded facets.
        for (&area, &neighbor) in cell.areas.iter().zip(&cell.neighbors) {
            assert!(area.is_finite() || on_hull == &true && !cells[neighbor as usize].is_bounded, "{name}");
            assert!(cells[neighbor as usize].neighbors.contains(&(i as u32)), "{name}");
        }
    }

    // The arrays have the same.
    for clip in [Clip::None, Clip::Hull] {
        let voronoi = diagram(clip);
        let arrays = voronoi.diagram();
        assert_eq!(arrays.cells.len(), points.len() + 1, "{name}");
        assert_eq!(arrays.volumes, voronoi.volumes(), "{name}");
        let neighbors = voronoi.neighbors();
        for (i, cell) in voronoi.map_cells(|_, cell| cell.clone()).into_iter().enumerate() {
            let facets = arrays.cells[i]..arrays.cells[i + 1];
            assert_eq!(arrays.neighbors[facets.clone()], cell.neighbors, "{name}");
            assert_eq!(arrays.areas[facets.clone()], cell.areas, "{name}");
            assert_eq!(neighbors.of(i as u32), cell.neighbors(), "{name}");
            for (k, f) in facets.enumerate() {
                let corners = arrays.facets.of(f as u32).iter().map(|&v| arrays.vertices[v as usize]);
                assert!(corners.eq(cell.facets.of(k as u32).iter().map(|&v| cell.vertices[v as usize])), "{name}");
            }
        }
    }
}

#[test]
fn cells_in_3d() {
    for (name, points) in inputs3() {
        check(name, &mesh3(&points), &points);
    }
}

#[test]
fn cells_in_2d() {
    for (name, points) in inputs2() {
        check(name, &mesh2(&points), &points);
    }
}

/// The nearest vertex decides in which cell a place is, so the share of places near a vertex is the
/// volume of its cell; and exactly, whether a facet exists decides whether two vertices are nearest
/// to some place.
#[test]
fn volumes_are_shares_of_the_box() {
    let points = inputs3().into_iter().find(|(name, _)| *name == "uniform").unwrap().1;
    let mesh = mesh3(&points);
    let voronoi = Voronoi::new(&mesh, &points, Clip::Box([[0.0; 3], [1.0; 3]])).unwrap();
    let volumes = voronoi.volumes();
    let side = 64;
    let locator = Locator::new(&mesh, &points).unwrap();
    let places: Vec<[f64; 3]> = (0..side * side * side)
        .map(|i| [i % side, i / side % side, i / side / side].map(|k| (f64::from(k) + 0.5) / f64::from(side)))
        .collect();
    let mut shares = vec![0.0; points.len()];
    for nearest in locator.nearest_many(&places).unwrap() {
        shares[nearest.unwrap() as usize] += 1.0 / places.len() as f64;
    }
    for (share, volume) in shares.iter().zip(&volumes) {
        assert!((share - volume).abs() < 0.1 * volume + 2e-4, "{share} {volume}");
    }
}

#[test]
fn the_cells_of_a_grid_are_cubes_without_facets_of_no_area() {
    let points = inputs3().into_iter().find(|(name, _)| *name == "shuffled grid").unwrap().1;
    let mesh = mesh3(&points);
    let voronoi = Voronoi::new(&mesh, &points, Clip::Box([[-0.5; 3], [3.5; 3]])).unwrap();
    for (i, cell) in voronoi.map_cells(|_, cell| cell.clone()).iter().enumerate() {
        assert_eq!(cell.facets.len(), 6);
        assert!((cell.volume - 1.0).abs() < 1e-15);
        assert!(cell.areas.iter().all(|area| (area - 1.0).abs() < 1e-15));
        assert!((0..3).all(|k| (cell.centroid[k] - points[i][k]).abs() < 1e-15));
    }
    let all = Voronoi::new(&mesh, &points, Clip::None).unwrap();
    for (i, cell) in all.map_cells(|_, cell| cell.neighbors()).iter().enumerate() {
        let near: Vec<u32> = (0..64)
            .filter(|&j: &u32| (0..3).map(|k| (points[i][k] - points[j as usize][k]).abs()).sum::<f64>() == 1.0)
            .collect();
        assert_eq!(cell, &near);
    }
}

/// A grid that is turned has nearly flat tetrahedra at its hull, whose circumcentres are as far as rounding lets them be.
#[test]
fn volumes_of_cells_that_reach_far_are_positive() {
    let [sin, cos] = [0.6f64.sin(), 0.6f64.cos()];
    let turned = |[x, y, z]: [f64; 3]| {
        [cos * x - sin * y, 0.6 * (sin * x + cos * y) - 0.8 * z, 0.8 * (sin * x + cos * y) + 0.6 * z]
    };
    let grid = (0..216).map(|i| [i % 6, i / 6 % 6, i / 36].map(f64::from));
    let points: Vec<[f64; 3]> = grid.clone().map(turned).collect();
    let mesh = mesh3(&points);
    let cells = Voronoi::new(&mesh, &points, Clip::None).unwrap().map_cells(|_, cell| (cell.volume, cell.is_bounded));
    assert!(cells.iter().any(|&(volume, is_bounded)| is_bounded && volume > 1e6), "no cell reaches far");
    for ((volume, is_bounded), at) in cells.into_iter().zip(grid) {
        let is_inner = at.iter().all(|&x| x > 0.0 && x < 5.0);
        assert!(volume > 0.0 && (is_bounded || volume.is_infinite()), "{at:?}: {volume}");
        assert!(!is_inner || (volume - 1.0).abs() < 1e-9, "{at:?}: {volume}");
    }
}

#[test]
fn boxes_without_an_inside_are_errors() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mesh = mesh2(&points);
    let error = |low, high| Voronoi::new(&mesh, &points, Clip::Box([low, high])).unwrap_err();
    assert_eq!(error([0.0, 0.0], [1.0, 0.0]), Error::EmptyBox { axis: 'y' });
    assert_eq!(error([f64::NAN, 0.0], [1.0, 1.0]), Error::EmptyBox { axis: 'x' });
    assert_eq!(error([0.0, 0.0], [1.0, f64::INFINITY]), Error::EmptyBox { axis: 'y' });
    // A box that has nothing to do with the points.
    let far = Voronoi::new(&mesh, &points, Clip::Box([[7.0, 7.0], [9.0, 9.0]])).unwrap();
    assert!((far.volumes().iter().sum::<f64>() - 4.0).abs() < 1e-12);
    assert!(far.volumes().contains(&0.0));
}

#[test]
fn relaxation_moves_points_to_centres_and_leaves_the_others() {
    let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0], [1.0, 1.0], [1.0, 1.0]];
    let mesh = mesh2(&points);
    let relaxed = Voronoi::new(&mesh, &points, Clip::None).unwrap().relaxed();
    assert_eq!(relaxed[..4], points[..4]);
    assert_eq!(relaxed[4], relaxed[5]);
    let relaxed = Voronoi::new(&mesh, &points, Clip::Hull).unwrap().relaxed();
    assert!(relaxed[0][0] > 0.0 && relaxed[0][1] > 0.0);
}

/// What does not depend on the unit: each volume in units of the box.
fn shares<const D: usize, const N: usize>(
    mesh: &impl Mesh<D, N>,
    points: &[[f64; D]],
    clip: Clip<'_, D>,
    unit: f64,
) -> Vec<f64>
where
    Euclidean: VoronoiShapes<D, N>,
{
    let volumes = Voronoi::new(mesh, Points::F64(points), clip).unwrap().volumes();
    volumes.iter().map(|volume| (0..D).fold(*volume, |volume, _| volume / unit)).collect()
}

#[test]
fn volumes_are_right_at_absurd_scales() {
    let base = generate2d(Distribution2::Uniform, 40, 3);
    let mesh = mesh2(&base);
    for exponent in [-500, -300, -120, 120, 300, 500] {
        let unit = 2f64.powi(exponent);
        let scaled: Vec<[f64; 2]> = base.iter().map(|p| p.map(|x| x * unit)).collect();
        for hull in [true, false] {
            let clip = |unit: f64| if hull { Clip::Hull } else { Clip::Box([[-unit; 2], [2.0 * unit; 2]]) };
            let (one, other) = (shares(&mesh, &base, clip(1.0), 1.0), shares(&mesh, &scaled, clip(unit), unit));
            for (a, b) in one.iter().zip(other) {
                assert!((a - b).abs() <= 1e-12 * a, "{exponent} {a} {b}");
            }
        }
    }
    let base = generate3d(Distribution3::Uniform, 12, 4);
    let mesh = mesh3(&base);
    for (unit, expected) in [(1e140, f64::INFINITY), (1e300, f64::INFINITY), (1e-170, 5e-324), (1e-300, 5e-324)] {
        let scaled: Vec<[f64; 3]> = base.iter().map(|p| p.map(|x| x * unit)).collect();
        let voronoi = Voronoi::new(&mesh, &scaled, Clip::Box([[0.0; 3], [unit; 3]])).unwrap();
        assert!(voronoi.volumes().iter().all(|&volume| volume == expected), "{unit}");
        let original = Voronoi::new(&mesh, &base, Clip::Box([[0.0; 3], [1.0; 3]])).unwrap();
        for (p, q) in original.centroids().as_flattened().iter().zip(voronoi.centroids().as_flattened()) {
            assert!((p - q / unit).abs() < 1e-12, "{unit}: {p} {q}");
        }
        assert_eq!(voronoi.neighbors(), original.neighbors());
    }
}

#[test]
fn areas_of_points_some_ulps_apart_are_right() {
    // Fifty points of a lattice 14 wide, and the same as the last bits of numbers near 1.
    let lattice: Vec<[f64; 2]> = (0..50).map(|i| [f64::from(i * 37 % 15), f64::from(i * i * 11 % 15)]).collect();
    let mesh = mesh2(&lattice);
    let expected = Voronoi::new(&mesh, &lattice, Clip::Box([[0.0; 2], [14.0; 2]])).unwrap().volumes();
    for base in [1.0, 1000.0, 1e15] {
        let ulp = f64::EPSILON * 2f64.powi(libm::ilogb(base));
        let near: Vec<[f64; 2]> = lattice.iter().map(|p| p.map(|x| base + x * ulp)).collect();
        let bounds = [[base; 2], [base + 14.0 * ulp; 2]];
        let areas = shares(&mesh, &near, Clip::Box(bounds), ulp);
        for (a, b) in expected.iter().zip(areas) {
            assert!((a - b).abs() <= 1e-12 * a, "{base}: {a} {b}");
        }
    }
}

#[test]
fn cells_are_clipped_to_convex_polygons_and_polyhedra() {
    let points = generate2d(Distribution2::Uniform, 200, 5);
    let mesh = mesh2(&points);
    let total = |corners: &[[f64; 2]]| -> f64 {
        Voronoi::new(&mesh, &points, Clip::Convex(corners)).unwrap().volumes().iter().sum()
    };
    // A diamond, one that has a corner twice and one in the middle of a side, and one that is far away.
    assert!((total(&[[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]]) - 0.5).abs() < 1e-14);
    assert!((total(&[[0.5, 0.0], [0.0, 0.5], [0.5, 1.0], [1.0, 0.5], [0.5, 0.0], [0.25, 0.25]]) - 0.5).abs() < 1e-14);
    assert!((total(&[[9.0, 9.0], [12.0, 9.0], [9.0, 11.0]]) - 3.0).abs() < 1e-12);
    let square = [[-1.0, -1.0], [2.0, -1.0], [2.0, 2.0], [-1.0, 2.0]];
    let [as_polygon, as_box] = [Clip::Convex(&square), Clip::Box([[-1.0; 2], [2.0; 2]])]
        .map(|clip| Voronoi::new(&mesh, &points, clip).unwrap().map_cells(|_, cell| cell.clone()));
    for (a, b) in as_polygon.iter().zip(&as_box) {
        assert!((a.volume - b.volume).abs() < 1e-14);
        assert_eq!(a.neighbors(), b.neighbors());
    }

    let points = generate3d(Distribution3::Ball, 200, 6);
    let mesh = mesh3(&points);
    let octahedron: Vec<[f64; 3]> =
        (0..6).map(|i| std::array::from_fn(|axis| if axis == i / 2 { [-0.5, 1.5][i % 2] } else { 0.5 })).collect();
    let voronoi = Voronoi::new(&mesh, &points, Clip::Convex(&octahedron)).unwrap();
    assert!((voronoi.volumes().iter().sum::<f64>() - 4.0 / 3.0).abs() < 1e-12);
    // The eight corners of a cube: each side once, though the hull has two triangles there.
    let cube: Vec<[f64; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
    let [as_shape, as_box] = [Clip::Convex(&cube), Clip::Box([[0.0; 3], [1.0; 3]])]
        .map(|clip| Voronoi::new(&mesh, &points, clip).unwrap().map_cells(|_, cell| cell.clone()));
    for (a, b) in as_shape.iter().zip(&as_box) {
        assert!((a.volume - b.volume).abs() < 1e-14);
        assert_eq!(a.facets.len(), b.facets.len());
    }
}

#[test]
fn shapes_that_are_not_convex_are_errors() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mesh = mesh2(&points);
    let error = |corners: &[[f64; 2]]| Voronoi::new(&mesh, &points, Clip::Convex(corners)).unwrap_err().to_string();
    assert!(error(&[[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]]).ends_with("convex shapes"));
    assert!(error(&[[0.0, 0.0], [4.0, 0.0], [2.0, 0.0]]).ends_with("with an inside"));
    assert!(error(&[]).ends_with("with an inside"));
    assert!(error(&[[0.0, 0.0], [4.0, f64::NAN], [2.0, 2.0]]).ends_with("finite"));
}
