//! Points in a plane, on a line or in one place: answers in their own dimension.

use crate::inputs::{mesh2, mesh3};
use gdel::{
    AlphaShape, Clip, Diagram, FaceClass, Interpolation, Interpolator, Location, Locator, Mesh, Outside, Points,
    SpanningTree, Voronoi,
    internals::{
        d2::generate::{Distribution2, generate2d},
        derived::{StolenMeasures, VoronoiShapes},
        geometry::Euclidean,
    },
};

const METHODS: [Interpolation; 3] = [Interpolation::Linear, Interpolation::Laplace, Interpolation::Sibson];

/// Four coplanar points and a query beside their plane.
#[test]
fn four_coplanar_points_have_answers() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mesh = mesh3(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let query = [0.1, 0.2, 0.3];
    assert_eq!(locator.locate(query), Ok(Location::Nowhere));
    assert_eq!(locator.nearest(query), Ok(Some(0)));
    assert_eq!(locator.nearest_many(&[query, [0.5, 0.5, 9.0], [2.0, 2.0, 0.0]]).unwrap(), [Some(0), Some(0), Some(3)]);
    assert_eq!(locator.nearest_k(query, 9).unwrap(), [0, 2, 1, 3]);
    let tree = SpanningTree::new(&mesh, &points).unwrap();
    assert_eq!((tree.edges.len(), tree.total_length()), (3, 3.0));
    let bounds = Points::F64(&points).bounds().unwrap();
    for clip in [Clip::Box(bounds), Clip::Hull] {
        let voronoi = Voronoi::new(&mesh, &points, clip).unwrap();
        assert_eq!(voronoi.volumes(), [0.25; 4], "{clip:?}");
        assert_eq!(voronoi.cell(0).neighbors(), [1, 2], "{clip:?}");
        assert_eq!(voronoi.centroids()[3], [0.75, 0.75, 0.0], "{clip:?}");
    }
    assert_eq!(Voronoi::new(&mesh, &points, Clip::None).unwrap().volumes(), [f64::INFINITY; 4]);
    // In a box with an inside, the cells have volumes.
    let solid = Voronoi::new(&mesh, &points, Clip::Box([[0.0, 0.0, -1.0], [1.0, 1.0, 1.0]])).unwrap();
    assert!(solid.volumes().iter().all(|volume| (volume - 0.5).abs() < 1e-14));
    let values = [1.0, 2.0, 4.0, 5.0];
    for method in METHODS {
        let interpolator = Interpolator::new(&locator, &values).unwrap();
        for (point, value) in points.iter().zip(values) {
            assert_eq!(interpolator.interpolate(method, *point), Ok(value), "{method:?}");
        }
        let found = interpolator.interpolate_many(method, &[[0.25, 0.5, 0.0], [0.5, 0.5, 1e-3], query]).unwrap();
        assert!((found.values[0] - 2.75).abs() < 1e-12, "{method:?}: {found:?}");
        assert!(found.values[1].is_nan() && found.outside == 2, "{method:?}: {found:?}");
        let at = |outside| Interpolator::new(&locator, &values).unwrap().outside(outside).interpolate(method, query);
        assert_eq!(at(Outside::Nearest), Ok(1.0), "{method:?}");
        assert!((at(Outside::Linear).unwrap() - 1.7).abs() < 1e-12, "{method:?}");
    }
}

/// Points of a plane that is turned without rounding, by integers whose rows have length 3.
fn turned([x, y]: [f64; 2]) -> [f64; 3] {
    [x + 2.0 * y + 5.0, 2.0 * x + y - 7.0, 2.0 * x - 2.0 * y + 1.0]
}

#[test]
fn a_turned_plane_has_the_answers_of_the_plane() {
    let integers = |p: &[f64; 2]| p.map(|x| (x * 1e4).round());
    let mut sets = vec![("grid", (0..64).map(|i| [f64::from(i % 8), f64::from(i / 8)]).collect::<Vec<_>>())];
    sets.extend(
        [Distribution2::Uniform, Distribution2::Circle, Distribution2::Clusters]
            .map(|kind| (kind.name(), generate2d(kind, 200, 3).iter().map(integers).collect())),
    );
    for (name, points) in sets {
        let solid: Vec<[f64; 3]> = points.iter().map(|&p| turned(p)).collect();
        let (mesh, flat) = (mesh2(&points), mesh3(&solid));
        assert_eq!((flat.dimension, flat.tetrahedra.len()), (2, 0));
        let (locator, of_flat) = (Locator::new(&mesh, &points).unwrap(), Locator::new(&flat, &solid).unwrap());
        let queries: Vec<[f64; 2]> =
            points.windows(2).map(|p| [0, 1].map(|a| p[0][a] * 0.25 + p[1][a] * 0.75)).collect();
        let solid_queries: Vec<[f64; 3]> = queries.iter().map(|&q| turned(q)).collect();
        let nearest = locator.nearest_many(&queries).unwrap();
        assert_eq!(of_flat.nearest_many(&solid_queries).unwrap(), nearest, "{name}");
        let beside: Vec<[f64; 3]> = solid_queries.iter().map(|q| [q[0] + 200.0, q[1] - 200.0, q[2] + 100.0]).collect();
        assert_eq!(of_flat.nearest_many(&beside).unwrap(), nearest, "{name}");
        let (tree, of_tree) = (SpanningTree::new(&mesh, &points).unwrap(), SpanningTree::new(&flat, &solid).unwrap());
        assert_eq!(tree.edges, of_tree.edges, "{name}");
        let values: Vec<f64> = points.iter().map(|[x, y]| x * y / 1e8).collect();
        for method in METHODS {
            let one = Interpolator::new(&locator, &values).unwrap().interpolate_many(method, &queries).unwrap();
            let other = Interpolator::new(&of_flat, &values).unwrap().interpolate_many(method, &solid_queries).unwrap();
            assert_eq!((one.outside, other.outside), (0, 0), "{name} {method:?}");
            // In a grid linear interpolation sees one triangle or another.
            let is_unique = method != Interpolation::Linear || !["grid", "circle"].contains(&name);
            for (a, b) in one.values.iter().zip(&other.values).filter(|_| is_unique) {
                assert!((a - b).abs() < 1e-9, "{name} {method:?}: {a} {b}");
            }
        }
        for clip in [false, true] {
            let one = Voronoi::new(&mesh, &points, if clip { Clip::Hull } else { Clip::None }).unwrap().volumes();
            let other = Voronoi::new(&flat, &solid, if clip { Clip::Hull } else { Clip::None }).unwrap();
            check_diagram(&other.diagram(), points.len());
            for (a, b) in one.iter().zip(other.volumes()) {
                assert!((9.0 * a - b).abs() <= 1e-6 * b || 9.0 * a == b, "{name} {clip}: {a} {b}");
            }
        }
    }
}

fn check_diagram<const D: usize>(diagram: &Diagram<D>, points: usize) {
    assert_eq!((diagram.cells.len(), diagram.volumes.len()), (points + 1, points));
    assert_eq!(diagram.facets.len(), diagram.neighbors.len());
    assert_eq!(diagram.areas.len(), diagram.neighbors.len());
    assert!(diagram.facets.indices.iter().all(|&v| (v as usize) < diagram.vertices.len()));
}

/// Three collinear points, whose cells in a box are stripes: what `d3-voronoi` was asked for.
#[test]
fn collinear_points_have_cells_in_a_box_and_on_their_line() {
    let points = [[100.0, 100.0], [200.0, 200.0], [300.0, 300.0]];
    let mesh = mesh2(&points);
    let volumes = |clip| Voronoi::new(&mesh, &points, clip).unwrap().volumes();
    let stripes = volumes(Clip::Box([[0.0, 0.0], [500.0, 500.0]]));
    assert_eq!(stripes, [45_000.0, 80_000.0, 125_000.0]);
    assert_eq!(volumes(Clip::Box([[100.0, 100.0], [300.0, 300.0]])), [5_000.0, 30_000.0, 5_000.0]);
    let length = 20_000f64.sqrt();
    let lengths = volumes(Clip::Hull);
    assert!(lengths.iter().zip([0.5, 1.0, 0.5]).all(|(l, part)| (l - part * length).abs() < 1e-10), "{lengths:?}");
    let unclipped = volumes(Clip::None);
    assert!(unclipped[0].is_infinite() && unclipped[2].is_infinite() && (unclipped[1] - length).abs() < 1e-10);
    check_diagram(&Voronoi::new(&mesh, &points, Clip::Hull).unwrap().diagram(), 3);
    let neighbors = Voronoi::new(&mesh, &points, Clip::Hull).unwrap().neighbors();
    assert_eq!((neighbors.of(0), neighbors.of(1)), (&[1][..], &[0, 2][..]));
    // Along an axis of space, and slanted in a plane of it.
    let solid = points.map(|[x, y]| [x, y, 3.0]);
    let bounds = Points::F64(&solid).bounds().unwrap();
    let of_solid = Voronoi::new(&mesh3(&solid), &solid, Clip::Box(bounds)).unwrap().volumes();
    assert_eq!(of_solid, [5_000.0, 30_000.0, 5_000.0]);
    let along = points.map(|[x, _]| [1.0, x, 3.0]);
    let bounds = Points::F64(&along).bounds().unwrap();
    assert_eq!(Voronoi::new(&mesh3(&along), &along, Clip::Box(bounds)).unwrap().volumes(), [50.0, 100.0, 50.0]);
    let within = Clip::Box([[1.0, 120.0, 3.0], [1.0, 240.0, 3.0]]);
    assert_eq!(Voronoi::new(&mesh3(&along), &along, within).unwrap().volumes(), [30.0, 90.0, 0.0]);
    let error = Voronoi::new(&mesh3(&along), &along, Clip::Box([[0.0; 3], [0.0, 9.0, 9.0]])).unwrap_err();
    assert_eq!(error, gdel::Error::EmptyBox { axis: 'x' });
}

fn check_line<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: StolenMeasures<D, N> + VoronoiShapes<D, N>,
{
    let points_ = Points::F64(points);
    let locator = Locator::new(mesh, points_).unwrap();
    let values: Vec<f64> = points.iter().map(|p| p.iter().sum::<f64>()).collect();
    let queries: Vec<[f64; D]> =
        points.windows(2).map(|p| std::array::from_fn(|a| (p[0][a] + p[1][a]) / 2.0)).collect();
    for method in METHODS {
        let interpolator = Interpolator::new(&locator, &values).unwrap();
        let found = interpolator.interpolate_many(method, Points::F64(&queries)).unwrap();
        assert_eq!(found.outside, 0);
        for (query, value) in queries.iter().zip(found.values) {
            assert!((value - query.iter().sum::<f64>()).abs() < 1e-10, "{query:?}: {value}");
        }
        for (point, value) in points.iter().zip(&values) {
            assert_eq!(interpolator.interpolate(method, *point).as_ref(), Ok(value));
        }
        let beside = points[0].map(|x| x + 0.5);
        assert!(interpolator.interpolate(method, [beside[0]; D].map(|x| x * 1e3)).unwrap().is_nan());
    }
    let tree = SpanningTree::new(mesh, points_).unwrap();
    assert_eq!(tree.edges.len(), points.len() - 1);
    let brute = |q: &[f64; D]| {
        let squared = |p: &[f64; D]| p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
        (0..points.len()).min_by(|&i, &j| squared(&points[i]).total_cmp(&squared(&points[j]))).map(|i| i as u32)
    };
    let far: Vec<[f64; D]> = points.iter().map(|p| std::array::from_fn(|a| p[a] + [0.3, -0.2, 0.7][a])).collect();
    let expected: Vec<_> = far.iter().map(brute).collect();
    assert_eq!(locator.nearest_many(Points::F64(&far)).unwrap(), expected);
}

#[test]
fn points_on_a_line_have_answers() {
    // In no order along the line.
    let places: Vec<f64> = (0..40).map(|i| f64::from(i * 17 % 41)).collect();
    check_line(
        &mesh2(&places.iter().map(|t| [3.0 * t, 5.0 - t]).collect::<Vec<_>>()),
        &places.iter().map(|t| [3.0 * t, 5.0 - t]).collect::<Vec<_>>(),
    );
    let solid: Vec<[f64; 3]> = places.iter().map(|t| [3.0 * t, 5.0 - t, 2.0 * t]).collect();
    check_line(&mesh3(&solid), &solid);
}

#[test]
fn equal_points_have_one_vertex_with_a_value() {
    let points = [[1.0, 2.0, 3.0]; 3];
    let mesh = mesh3(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    assert_eq!(locator.nearest_many(&[[9.0; 3], points[0]]).unwrap(), [Some(0); 2]);
    let interpolator = Interpolator::new(&locator, &[7.0, 8.0, 9.0]).unwrap();
    let found = interpolator.interpolate_many(Interpolation::Sibson, &[points[0], [1.0, 2.0, 3.1]]).unwrap();
    assert!(found.values[0] == 7.0 && found.values[1].is_nan() && found.outside == 1);
    let interpolator = interpolator.outside(Outside::Linear);
    assert_eq!(interpolator.interpolate(Interpolation::Linear, [0.0; 3]), Ok(7.0));
    let tree = SpanningTree::new(&mesh, &points).unwrap();
    assert_eq!((tree.edges, tree.lengths), (vec![[0, 1], [0, 2]], vec![0.0; 2]));
    let volumes = |clip| Voronoi::new(&mesh, &points, clip).unwrap().volumes();
    assert_eq!(volumes(Clip::Box([[0.0; 3], [4.0; 3]])), [64.0, 0.0, 0.0]);
    assert_eq!(volumes(Clip::Hull), [0.0; 3]);
    assert_eq!(volumes(Clip::Box([points[0]; 2])), [0.0; 3]);
    let none: [[f64; 3]; 0] = [];
    let empty = mesh3(&none);
    let locator = Locator::new(&empty, &none).unwrap();
    assert_eq!(locator.nearest([0.0; 3]), Ok(None));
    let interpolator = Interpolator::new(&locator, &[]).unwrap().outside(Outside::Nearest);
    assert!(interpolator.interpolate(Interpolation::Linear, [0.0; 3]).unwrap().is_nan());
}

/// Rounded within a plane, a query may be on the wrong side of an edge, or on a vertex.
#[test]
fn queries_next_to_vertices_of_a_slanted_plane() {
    let points: Vec<[f64; 3]> = (0..9).map(|i| [i % 3, i / 3, i % 3 - i / 3].map(f64::from)).collect();
    let mesh = mesh3(&points);
    let locator = Locator::new(&mesh, &points).unwrap();
    let values: Vec<f64> = points.iter().map(|p| p[0]).collect();
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    for (i, p) in points.iter().enumerate() {
        for signs in 0..27 {
            let ulps = [signs % 3 - 1, signs / 3 % 3 - 1, signs / 9 - 1].map(f64::from);
            let q: [f64; 3] = std::array::from_fn(|axis| p[axis] + ulps[axis] * 4.0 * f64::EPSILON);
            for method in METHODS {
                let found = interpolator.interpolate(method, q).unwrap();
                assert!(found.is_nan() || (found - values[i]).abs() < 1e-12, "{method:?} {q:?}: {found}");
            }
        }
    }
}

/// Points of a plane in space, slanted or not, have the alpha shapes that they have in 2D, with both sides.
#[test]
fn alpha_shapes_in_a_plane_are_those_of_2d() {
    let in_space: [fn([f64; 2]) -> [f64; 3]; 2] = [|[x, y]| [7.0, x, y], |[x, y]| [x, y, x + y]];
    let points: Vec<[f64; 2]> =
        generate2d(Distribution2::Uniform, 200, 5).iter().map(|p| p.map(|x| (x * 4096.0).round())).collect();
    let mesh = mesh2(&points);
    let plane = AlphaShape::new(&mesh, &points).unwrap();
    let solid: Vec<[f64; 3]> = points.iter().map(|&p| in_space[0](p)).collect();
    let flat_mesh = mesh3(&solid);
    let flat = AlphaShape::new(&flat_mesh, &solid).unwrap();
    for components in [1, 2, 5] {
        assert_eq!(plane.find_alpha(components), flat.find_alpha(components));
        assert_eq!(plane.auto_alpha(components).is_some(), flat.auto_alpha(components).is_some());
    }
    let auto = plane.auto_alpha(1).unwrap();
    for alpha in [0.0, 100.0, 150.0, 250.0, auto, 1000.0, f64::INFINITY] {
        let (one, other) = (plane.at(alpha).unwrap(), flat.at(alpha).unwrap());
        let mut triangles: Vec<[u32; 3]> = one.solid().map(|t| mesh.triangles[t]).collect();
        triangles.iter_mut().for_each(|triangle| triangle.sort_unstable());
        triangles.sort_unstable();
        let surface: Vec<[u32; 3]> = other.surface().collect();
        let doubled: Vec<[u32; 3]> = triangles.iter().flat_map(|&triangle| [triangle; 2]).collect();
        assert_eq!(gdel::internals::mesh::canonical(&surface), doubled, "{alpha}");
        check_closed(&surface);
        assert_eq!(other.components().1, one.components().1, "{alpha}");
        assert_eq!((other.solid().count(), other.components().0.len()), (0, 0));
        let classes = other.facets().filter(|(_, class)| *class == FaceClass::Singular).count();
        assert_eq!((classes, other.facets().count()), (triangles.len(), mesh.triangles.len()));
        // Edges of 2D that are part of the complex are so here, and so are vertices.
        let is_in = |class: FaceClass| class != FaceClass::Exterior;
        let mut edges: Vec<[u32; 2]> = one.facets().filter(|&(_, class)| is_in(class)).map(|(edge, _)| edge).collect();
        edges.iter_mut().for_each(|edge| edge.sort_unstable());
        edges.sort_unstable();
        let mut found: Vec<[u32; 2]> = other.edges().filter(|&(_, class)| is_in(class)).map(|(edge, _)| edge).collect();
        found.sort_unstable();
        assert_eq!(found, edges, "{alpha}");
        let singular = |classes: Vec<(u32, FaceClass)>| {
            classes.into_iter().filter(|&(_, class)| class == FaceClass::Singular).map(|(v, _)| v).collect::<Vec<_>>()
        };
        assert_eq!(singular(other.vertices().collect()), singular(one.vertices().collect()), "{alpha}");
    }
    let close = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-8 * a);
    assert!(close(&plane.critical_values(), &flat.critical_values()));
    // A slanted plane has other distances, but a hull and as many triangles.
    let solid: Vec<[f64; 3]> = points.iter().map(|&p| in_space[1](p)).collect();
    let mesh = mesh3(&solid);
    let shape = AlphaShape::new(&mesh, &solid).unwrap();
    let alpha = shape.auto_alpha(1).unwrap();
    let complex = shape.at(alpha).unwrap();
    assert_eq!(complex.components().1, 1);
    check_closed(&complex.surface().collect::<Vec<_>>());
    assert!(complex.vertices().all(|(_, class)| class == FaceClass::Regular));
}

/// The polygon of flat points is their hull: every triangle comes from both sides.
#[test]
fn the_hull_of_points_in_a_plane_is_their_polygon() {
    let points: Vec<[f64; 3]> =
        (0..25).map(|i| [f64::from(i % 5), f64::from(i / 5), 3.0]).chain([[0.0, 0.0, 3.0]]).collect();
    let mesh = mesh3(&points);
    assert!(mesh.hull.is_empty());
    let shape = AlphaShape::new(&mesh, &points).unwrap();
    let hull: Vec<[u32; 3]> = shape.at(f64::INFINITY).unwrap().surface().collect();
    assert_eq!(hull.len(), 2 * 32);
    check_closed(&hull);
    let area = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| points[v as usize]);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
    };
    assert_eq!(hull.iter().map(|&triangle| area(triangle)).sum::<f64>(), 0.0);
    assert_eq!(hull.iter().map(|&triangle| area(triangle).abs()).sum::<f64>(), 2.0 * 16.0);
    // All triangles of a grid have one radius but for rounding.
    assert!((shape.auto_alpha(1).unwrap() - 0.5f64.sqrt()).abs() < 1e-12);
}

/// Asserts that every edge has as many triangles in one direction as in the other.
fn check_closed(surface: &[[u32; 3]]) {
    let mut edges: Vec<[u32; 2]> = surface.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let mut reversed: Vec<[u32; 2]> = edges.iter().map(|&[v, w]| [w, v]).collect();
    edges.sort_unstable();
    reversed.sort_unstable();
    assert_eq!(edges, reversed);
}

#[test]
fn alpha_shapes_on_a_line_are_segments() {
    // In no order along the line: places 0, 2, 3, 7.
    let places = [7.0, 0.0, 3.0, 2.0, 3.0];
    let plane = places.map(|t| [2.0 * t, 5.0]);
    let mesh = mesh2(&plane);
    let shape = AlphaShape::new(&mesh, &plane).unwrap();
    // Half of the longest segment.
    assert_eq!(shape.find_alpha(1), Some(4.0));
    assert_eq!(shape.find_alpha(2), Some(4.0), "the last point has one segment");
    let complex = shape.at(2.0).unwrap();
    let mut surface: Vec<[u32; 2]> = complex.surface().collect();
    surface.sort_unstable();
    assert_eq!((surface, complex.components().1), (vec![[1, 3], [2, 3], [3, 1], [3, 2]], 1));
    let vertices: Vec<(u32, FaceClass)> = complex.vertices().collect();
    assert_eq!(vertices[0], (0, FaceClass::Singular));
    assert!(vertices[1..].iter().all(|&(_, class)| class == FaceClass::Regular));
    assert_eq!(shape.critical_values().len(), 3);
    let solid = places.map(|t| [2.0 * t, 5.0, 1.0]);
    let mesh = mesh3(&solid);
    let shape = AlphaShape::new(&mesh, &solid).unwrap();
    assert_eq!(shape.find_alpha(1), Some(4.0));
    let complex = shape.at(2.0).unwrap();
    assert_eq!((complex.surface().count(), complex.components().1), (0, 1));
    let mut edges: Vec<([u32; 2], FaceClass)> = complex.edges().collect();
    edges.sort_by_key(|&(edge, _)| edge);
    let singular = FaceClass::Singular;
    assert_eq!(edges, [([0, 2], FaceClass::Exterior), ([1, 3], singular), ([2, 3], singular)]);
    for points in [&[[1.0; 3]; 2][..], &[]] {
        let mesh = mesh3(points);
        let shape = AlphaShape::new(&mesh, points).unwrap();
        assert_eq!(shape.auto_alpha(1), None);
        let complex = shape.at(1.0).unwrap();
        assert_eq!((complex.surface().count(), complex.edges().count()), (0, 0));
        assert!(complex.vertices().all(|(_, class)| class == singular));
    }
}
