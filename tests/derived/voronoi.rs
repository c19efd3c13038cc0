//! Voronoi diagrams: against brute force by half-planes and half-spaces, and what holds for every
//! diagram.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3};
use gdel::{
    Cell, Clip, Error, Locator, Mesh, Points, Voronoi,
    internals::{
        derived::VoronoiShapes,
        geometry::{Euclidean, Geometry},
    },
};

fn bounds<const D: usize>(points: &[[f64; D]]) -> [[f64; D]; 2] {
    let all = |f: fn(f64, f64) -> f64| {
        points.iter().copied().reduce(|p, q| std::array::from_fn(|i| f(p[i], q[i]))).unwrap_or([0.0; D])
    };
    [all(f64::min), all(f64::max)]
}

/// Boxes around the points, and one that cuts through them.
fn boxes<const D: usize>(points: &[[f64; D]]) -> Vec<[[f64; D]; 2]> {
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
        if mesh.duplicate_of()[i] != gdel::NONE || mesh.simplices().is_empty() {
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
    let has_cells = !mesh.simplices().is_empty();
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
