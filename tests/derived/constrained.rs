//! Answers of meshes with constraints, in which neither a visibility walk nor one to nearer vertices need end where it should.

use crate::{
    inputs::{inputs2, queries},
    interpolate, locate, nearest,
};
use gdel::{
    AlphaShape, Backend, Clip, Constrained2, Constraints, Contours, Diagram, Error, Fill, Interpolation, Interpolator,
    Locator, Mesh2, NONE, Outside, SpanningTree, Surface, SurfaceOptions, Triangulator, Voronoi,
    internals::geometry::{Euclidean, Geometry},
};
use rand::RngExt;
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};

fn constrained(points: &[[f64; 2]], constraints: &Constraints) -> Result<Constrained2, Error> {
    Triangulator::new().backend(Backend::Cpu).constrained2d(points, constraints)
}

/// Returns point sets, each with a mesh that has as many of some random segments as do not cross.
fn meshes() -> Vec<(&'static str, Vec<[f64; 2]>, Constrained2)> {
    let random = &mut Pcg64Mcg::seed_from_u64(1);
    let mut meshes = Vec::new();
    for (name, points) in inputs2().into_iter().filter(|(_, points)| points.len() > 3) {
        let mut segments = Vec::new();
        let mut found = constrained(&points, &Constraints::new()).unwrap();
        for _ in 0..25 {
            segments.push([0; 2].map(|_: u32| random.random_range(0..points.len() as u32)));
            match constrained(&points, &Constraints::new().edges(&segments)) {
                Ok(more) => found = more,
                Err(_) => drop(segments.pop()),
            }
        }
        meshes.push((name, points, found));
    }
    assert!(meshes.iter().filter(|(.., found)| found.mesh.constraints.len() > 5).count() > 10);
    meshes
}

/// A hundred spokes from a small circle to a large one, each of which is an eighth of a turn ahead of the one on the small circle: triangles of
/// which each is behind the next, for a query in the middle.
fn swirl() -> (Vec<[f64; 2]>, Mesh2) {
    let n = 100;
    let at = |radius: f64, i: u32| {
        let turn = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
        [radius * libm::cos(turn), radius * libm::sin(turn)]
    };
    let points: Vec<_> = (0..n).map(|i| at(1.0, i)).chain((0..n).map(|i| at(2.0, i))).collect();
    let spokes: Vec<_> = (0..n).map(|i| [i, n + (i + n / 8) % n]).collect();
    let mesh = constrained(&points, &Constraints::new().edges(&spokes)).unwrap().mesh;
    (points, mesh)
}

#[test]
fn the_triangle_that_contains_a_query() {
    for (name, points, found) in meshes() {
        locate::check(name, &found.mesh, &points);
    }
    let (points, mesh) = swirl();
    locate::check("swirl", &mesh, &points);
    let locator = Locator::new(&mesh, &points).unwrap();
    assert_eq!(locator.locate_many(&[[0.0; 2]; 3]).unwrap()[1], locator.locate([0.0; 2]).unwrap());
}

#[test]
fn nearest_vertices() {
    for (name, points, found) in meshes() {
        nearest::check(name, &found.mesh, &points);
    }
    let (points, mesh) = swirl();
    nearest::check("swirl", &mesh, &points);
}

#[test]
fn linear_functions_are_reproduced() {
    for (name, points, found) in meshes() {
        interpolate::check(name, &found.mesh, &points);
    }
    let (points, mesh) = swirl();
    interpolate::check("swirl", &mesh, &points);
}

fn side(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i8 {
    <Euclidean as Geometry<2, 3>>::side(&[a, b], c)
}

/// All natural neighbours can be seen from the query: no value crosses a constraint.
#[test]
fn values_do_not_cross_constraints() {
    for (name, points, Constrained2 { mesh, .. }) in meshes() {
        let locator = Locator::new(&mesh, &points).unwrap().exact();
        let values = vec![0.0; points.len()];
        let interpolator = Interpolator::new(&locator, &values).unwrap();
        for q in queries(&points) {
            for method in [Interpolation::Laplace, Interpolation::Sibson] {
                for (v, _) in interpolator.weights(method, q).unwrap().unwrap_or_default() {
                    let p = points[v as usize];
                    let crosses = |&[a, b]: &[u32; 2]| {
                        let [a, b] = [a, b].map(|v| points[v as usize]);
                        side(a, b, p) * side(a, b, q) < 0 && side(p, q, a) * side(p, q, b) < 0
                    };
                    assert!(!mesh.constraints.iter().any(crosses), "{name} {method:?}: {q:?} and {p:?}");
                }
            }
        }
    }
}

/// A step along a breakline: what is beside it has the values of its own side, and on it they are linear.
#[test]
fn values_are_linear_along_a_breakline_and_continuous_across() {
    let mut points: Vec<[f64; 2]> = (0..81).map(|i| [i % 9, i / 9].map(|x| f64::from(x - 4))).collect();
    points.retain(|[x, _]| *x != 0.0);
    points.extend([[0.0, -4.0], [0.0, 4.0]]);
    let breakline = [points.len() as u32 - 2, points.len() as u32 - 1];
    let mesh = constrained(&points, &Constraints::new().edges(&[breakline])).unwrap().mesh;
    let locator = Locator::new(&mesh, &points).unwrap();
    // The left side is 1, and the right side rises.
    let values: Vec<f64> = points.iter().map(|&[x, y]| if x < 0.0 { 1.0 } else { 2.0 + x + y / 4.0 }).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    for method in [Interpolation::Linear, Interpolation::Laplace, Interpolation::Sibson] {
        let at = |x: f64, y: f64| interpolator.interpolate(method, [x, y]).unwrap();
        for y in [-3.7, -1.0, 0.0, 0.3, 3.9] {
            assert!((at(0.0, y) - (2.0 + y / 4.0)).abs() < 1e-12, "{method:?}");
            for x in [-1e-9, 1e-9] {
                assert!((at(x, y) - at(0.0, y)).abs() < 1e-6, "{method:?}: {x}, {y}");
            }
            for x in [0.1, 0.5, 1.5, 3.0] {
                assert!((at(x, y) - (2.0 + x + y / 4.0)).abs() < 1e-12, "{method:?}");
            }
        }
    }
}

/// What exists for meshes without constraints only says so.
#[test]
fn smooth_interpolation_and_what_needs_delaunay_neighbours_is_refused() {
    let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0], [2.0, 0.25]];
    let mesh = constrained(&points, &Constraints::new().edges(&[[0, 2]])).unwrap().mesh;
    let locator = Locator::new(&mesh, &points).unwrap();
    let interpolator = Interpolator::new(&locator, &[1.0; 5]).unwrap();
    let refused = Some(Error::ConstrainedMesh);
    for method in [Interpolation::SibsonC1, Interpolation::CloughTocher] {
        assert_eq!(interpolator.interpolate(method, [1.0, 0.5]).err(), refused);
    }
    assert_eq!(SpanningTree::new(&mesh, &points).err(), refused);
    assert_eq!(AlphaShape::new(&mesh, &points).err(), refused);
    assert_eq!(Surface::new(&mesh, &points, &SurfaceOptions::default()).err(), refused);
    assert_eq!(Voronoi::new(&mesh, &points, Clip::Hull).err(), refused);
}

/// Returns a ring of points around a hole, in a slanted frame, with constraints of both.
fn frame() -> (Vec<[f64; 2]>, Constrained2) {
    let turned = |x: f64, y: f64| [0.8 * x - 0.6 * y + 0.1, 0.6 * x + 0.8 * y + 0.1];
    let square = |r: f64| [turned(-r, -r), turned(r, -r), turned(r, r), turned(-r, r)];
    let points = [square(3.0), square(1.0), square(5.0)].concat();
    let rings = Constraints::new().ring(&[0, 1, 2, 3]).ring(&[4, 5, 6, 7]).fill(Fill::EvenOdd);
    let found = constrained(&points, &rings).unwrap();
    (points, found)
}

#[test]
fn there_are_values_inside_of_boundaries_and_on_them() {
    let (points, found) = frame();
    let locator = Locator::new(&found.mesh, &points).unwrap();
    let values: Vec<f64> = points.iter().map(|[x, y]| 2.0 * x - y).collect();
    let all = Interpolator::new(&locator, &values).unwrap();
    assert!((all.interpolate(Interpolation::Linear, [0.1, 0.1]).unwrap() - 0.1).abs() < 1e-12);
    for method in [Interpolation::Linear, Interpolation::Laplace, Interpolation::Sibson] {
        let inside = Interpolator::new(&locator, &values).unwrap().inside(&found.inside).unwrap();
        // Rounding moves most of these off the edge.
        let ends = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]];
        let on_boundary: Vec<[f64; 2]> = (0..100)
            .flat_map(|i| {
                let share = f64::from(i) / 99.0;
                let between =
                    |v: usize, w: usize, axis: usize| points[v][axis] + share * (points[w][axis] - points[v][axis]);
                ends.map(|[v, w]| [0, 1].map(|axis| between(v, w, axis)))
            })
            .collect();
        let on = inside.interpolate_many(method, &on_boundary).unwrap();
        assert_eq!(on.outside, 0, "{method:?}");
        for ([x, y], value) in on_boundary.iter().zip(on.values) {
            assert!((value - (2.0 * x - y)).abs() < 1e-12, "{method:?}");
        }
        // In the hole, and between the boundary and the hull.
        let out = [[0.1, 0.1], [0.1, 4.5], [0.1, 40.0]];
        let found = inside.interpolate_many(method, &out).unwrap();
        assert!(found.outside == 3 && found.values.iter().all(|value| value.is_nan()), "{method:?}");
        let constant = inside.outside(Outside::Value(7.0));
        assert_eq!(constant.interpolate_many(method, &out).unwrap().values, [7.0; 3], "{method:?}");
        let nearest = constant.outside(Outside::Nearest);
        let values_of = |q| values[locator.nearest(q).unwrap().unwrap() as usize];
        assert_eq!(nearest.interpolate_many(method, &out).unwrap().values, out.map(values_of), "{method:?}");
        let linear = nearest.outside(Outside::Linear).interpolate_many(method, &out).unwrap();
        for ([x, y], value) in out.iter().zip(linear.values) {
            assert!((value - (2.0 * x - y)).abs() < 1e-10, "{method:?}");
        }
    }
    let wrong = Interpolator::new(&locator, &values).unwrap().inside(&[true]).err();
    assert_eq!(wrong, Some(Error::ValueCount { values: 1, points: found.mesh.triangles.len() }));
}

#[test]
fn contours_end_at_boundaries() {
    let (points, found) = frame();
    let values: Vec<f64> = points.iter().map(|&[x, y]| 0.8 * x + 0.6 * y).collect();
    // The level line through the middle of the frame, as long as the frame, and without the hole.
    let length = |mesh: &Mesh2| {
        let contour = Contours::new(mesh, &points, &values).unwrap().at(0.14);
        let ends = contour.facets.iter().map(|facet| facet.map(|v| contour.vertices[v as usize]));
        ends.map(|[[a, b], [c, d]]| (c - a).hypot(d - b)).sum::<f64>()
    };
    assert!((length(&found.mesh) - 10.0).abs() < 1e-12);
    assert!((length(&found.inside_mesh()) - 4.0).abs() < 1e-12);
}

/// Returns how far a place is from being in a cell, at most, in units of the cell's extent: not more than 0 within.
fn distance_to(diagram: &Diagram<2>, v: usize, site: [f64; 2], x: [f64; 2]) -> f64 {
    let minus = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let facets = diagram.cells[v]..diagram.cells[v + 1];
    let outside = facets.map(|f| {
        let [p, q] = [0, 1].map(|k| minus(diagram.vertices[diagram.facets.of(f as u32)[k] as usize], site));
        let x = minus(x, site);
        let reach = [p, q, x].iter().map(|a| a[0].hypot(a[1])).fold(0.0, f64::max);
        let sides = [cross(p, x), cross(x, q), cross(minus(q, p), minus(x, p))];
        sides.map(|side| -side / (reach * reach)).into_iter().fold(0.0, f64::max)
    });
    outside.fold(f64::INFINITY, f64::min)
}

/// Every place is in the cell of the nearest vertex that it can see, and the cells fill what is inside.
fn check_bounded(name: &str, points: &[[f64; 2]], found: &Constrained2) {
    let diagram = found.bounded_voronoi(points).unwrap();
    let mesh = &found.mesh;
    let largest = points.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if mesh.triangles.is_empty() || !(1e-100..1e100).contains(&largest) {
        return;
    }
    let corners = |t: usize| mesh.triangles[t].map(|v| points[v as usize]);
    let area = |[a, b, c]: [[f64; 2]; 3]| ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
    let all: f64 = (0..mesh.triangles.len()).map(|t| area(corners(t)).abs()).sum();
    let inside: f64 = (0..mesh.triangles.len()).filter(|&t| found.inside[t]).map(|t| area(corners(t)).abs()).sum();
    let sum: f64 = diagram.volumes.iter().sum();
    assert!((sum - inside).abs() <= 1e-9 * all, "{name}: {sum} of {inside}");
    let locator = Locator::new(mesh, points).unwrap().exact();
    let crosses = |x: [f64; 2], p: [f64; 2], [a, b]: [[f64; 2]; 2]| {
        side(a, b, p) * side(a, b, x) < 0 && side(p, x, a) * side(p, x, b) < 0
    };
    let is_wall = |&(t, k): &(usize, usize)| {
        let halfedge = mesh.halfedges[t][k];
        halfedge == NONE || mesh.is_constrained(mesh.edge(t, k)) || !found.inside[halfedge as usize / 3]
    };
    let edges = (0..mesh.triangles.len()).filter(|&t| found.inside[t]).flat_map(|t| [0, 1, 2].map(|k| (t, k)));
    let walls: Vec<_> = edges.filter(is_wall).map(|(t, k)| mesh.edge(t, k).map(|v| points[v as usize])).collect();
    let mut looked_at = 0;
    for x in queries(points) {
        let Some(t) = locator.locate(x).unwrap().simplex().filter(|&t| found.inside[t]) else { continue };
        let vertices = (0..points.len()).filter(|&v| mesh.duplicate_of[v] == NONE);
        let visible = vertices.filter(|&v| !walls.iter().any(|&wall| crosses(x, points[v], wall)));
        let squared = |v: usize| (points[v][0] - x[0]).powi(2) + (points[v][1] - x[1]).powi(2);
        let nearest = visible.min_by(|&v, &w| squared(v).total_cmp(&squared(w))).unwrap();
        looked_at += 1;
        if points[nearest] != x {
            let distance = distance_to(&diagram, nearest, points[nearest], x);
            assert!(distance <= 1e-7, "{name}: {x:?} in {t} is not in the cell of {nearest}: {distance}");
        }
    }
    assert!(looked_at > 10, "{name}");
}

#[test]
fn bounded_cells() {
    for (name, points, found) in meshes() {
        check_bounded(name, &points, &found);
    }
    let (points, found) = frame();
    check_bounded("frame", &points, &found);
    let triangles = found.inside_triangles().count();
    assert!(triangles < found.mesh.triangles.len());
    let (points, mut found) = (swirl().0, Constrained2::default());
    found.mesh = swirl().1;
    found.inside = vec![true; found.mesh.triangles.len()];
    check_bounded("swirl", &points, &found);
    found.inside.pop();
    assert!(matches!(found.bounded_voronoi(&points), Err(Error::BrokenMesh { .. })));
    assert!(matches!(found.bounded_voronoi(&points[1..]), Err(Error::PointCount { .. })));
}

/// Without constraints, cells are those that are clipped to the hull.
#[test]
fn bounded_cells_without_constraints_are_those_within_the_hull() {
    for (name, points) in inputs2() {
        let found = constrained(&points, &Constraints::new()).unwrap();
        let bounded = found.bounded_voronoi(&points).unwrap();
        let clipped = Voronoi::new(&found.mesh, &points, Clip::Hull).unwrap().diagram();
        for (i, (a, b)) in bounded.volumes.iter().zip(&clipped.volumes).enumerate() {
            assert!(a == b || (a - b).abs() <= 1e-7 * a.max(*b) + f64::MIN_POSITIVE, "{name} {i}: {a} and {b}");
        }
    }
}

#[test]
fn cells_end_at_walls_but_not_at_those_of_their_own_site() {
    // A wall along the middle of a square, from side to side, with a site in its middle.
    let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 2.0], [2.0, 2.0], [4.0, 2.0], [2.0, 1.5f64]];
    let found = constrained(&points, &Constraints::new().edges(&[[4, 6]])).unwrap();
    let cells = found.bounded_voronoi(&points).unwrap();
    let neighbors = |v: usize| cells.neighbors[cells.cells[v]..cells.cells[v + 1]].to_vec();
    // The site below the wall does not reach beyond it, and the one on the wall has both sides.
    assert!(!neighbors(7).contains(&2) && !neighbors(7).contains(&3));
    assert!([2, 3, 7].iter().all(|v| neighbors(5).contains(v)));
    assert!(!neighbors(5).contains(&NONE));
    assert!((cells.volumes.iter().sum::<f64>() - 16.0).abs() < 1e-12);
    let centroid = cells.centroids[2];
    assert!(centroid[0] > 2.5 && centroid[1] > 2.5);
}
