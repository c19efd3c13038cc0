//! What is derived from a mesh some of whose points were removed is what is derived from the mesh of the
//! others.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3, queries};
use gdel::{
    AlphaShape, Backend, Clip, Editable, Interpolation, Interpolator, Location, Locator, Mesh2, Mesh3, Points, Points2,
    Points3, SpanningTree, Triangulator, Voronoi,
};

/// Numbers are the same, except for roundings: those of the order in which a mesh is looked at.
fn near(found: &[f64], expected: &[f64]) -> bool {
    let is_near =
        |(&x, &y): (&f64, &f64)| x == y || (x.is_nan() && y.is_nan()) || (x - y).abs() <= 1e-9 * x.abs().max(y.abs());
    found.len() == expected.len() && found.iter().zip(expected).all(is_near)
}

macro_rules! check {
    ($name:ident, $inputs:ident, $of:ident, $mesh:ident, $points:ident, $D:literal) => {
        #[test]
        fn $name() {
            for (name, points) in $inputs() {
                // Roundings of the coordinates are as large as the cells.
                let is_rough = name == "clusters" || name == "grids at 1e-9";
                let removed: Vec<u32> = (0..points.len() as u32).step_by(7).collect();
                let mut mesh: $mesh = $of(&points);
                remove(&mut mesh, $points::from(&points), &removed);
                let mut compact = mesh.clone();
                let kept = compact.compact();
                let left: Vec<[f64; $D]> = kept.iter().map(|&i| points[i as usize]).collect();
                let queries = queries(&points);
                let queries = Points::F64(&queries);
                // The simplices have the same order.
                let name_of = |v: u32| kept[v as usize];
                assert_eq!(mesh.duplicate_of.len(), points.len(), "{name}");

                let locator = Locator::new(&mesh, &points).unwrap();
                let other = Locator::new(&compact, &left).unwrap();
                let inside = |location: Location| match location {
                    Location::Inside(t) => Some(t),
                    _ => None,
                };
                let locations = locator.locate_many(queries).unwrap().into_iter().map(inside);
                assert!(locations.eq(other.locate_many(queries).unwrap().into_iter().map(inside)), "{name}");
                let expected: Vec<_> = other.nearest_many(queries).unwrap().iter().map(|v| v.map(name_of)).collect();
                assert_eq!(locator.nearest_many(queries).unwrap(), expected, "{name}");
                for q in queries.iter().take(20) {
                    let expected: Vec<_> = other.nearest_k(q, 5).unwrap().into_iter().map(name_of).collect();
                    assert_eq!(locator.nearest_k(q, 5).unwrap(), expected, "{name}");
                }

                let all: Vec<f64> = (0..points.len()).map(|i| (i as f64).sin()).collect();
                let values: Vec<f64> = kept.iter().map(|&i| all[i as usize]).collect();
                let interpolator = Interpolator::new(&locator, &all).unwrap();
                let expected = Interpolator::new(&other, &values).unwrap();
                for method in [Interpolation::Linear, Interpolation::Sibson] {
                    let [found, expected] = [&interpolator, &expected]
                        .map(|interpolator| interpolator.interpolate_many(method, queries).unwrap().values);
                    assert!(is_rough || near(&found, &expected), "{name}");
                }

                let of_kept = |all: Vec<f64>| kept.iter().map(|&i| all[i as usize]).collect::<Vec<_>>();
                for clip in [Clip::None, Clip::Hull] {
                    let voronoi = Voronoi::new(&mesh, &points, clip).unwrap();
                    let expected = Voronoi::new(&compact, &left, clip).unwrap();
                    assert!(is_rough || near(&of_kept(voronoi.volumes()), &expected.volumes()), "{name}");
                    assert!(removed.iter().all(|&i| voronoi.cell(i).is_empty()), "{name}");
                    let relaxed = voronoi.relaxed();
                    assert!(removed.iter().all(|&i| relaxed[i as usize] == points[i as usize]), "{name}");
                }

                let shape = AlphaShape::new(&mesh, &points).unwrap();
                let expected = AlphaShape::new(&compact, &left).unwrap();
                assert!(near(&shape.critical_values(), &expected.critical_values()), "{name}");
                let alpha = |shape: &AlphaShape<$D, { $D + 1 }>| Vec::from_iter(shape.find_alpha(1));
                assert!(near(&alpha(&shape), &alpha(&expected)), "{name}");
                let mut vertices: Vec<_> = shape.vertices().map(|(v, _)| v).collect();
                vertices.sort_unstable();
                let mut expected: Vec<_> = expected.vertices().map(|(v, _)| name_of(v)).collect();
                expected.sort_unstable();
                assert_eq!(vertices, expected, "{name}");

                let tree = SpanningTree::new(&mesh, &points).unwrap();
                let expected = SpanningTree::new(&compact, &left).unwrap();
                let edges: Vec<_> = expected.edges.iter().map(|edge| edge.map(name_of)).collect();
                assert_eq!((&tree.edges, &tree.lengths), (&edges, &expected.lengths), "{name}");
                for count in [1, 5] {
                    let labels = tree.clusters(count);
                    let of_kept: Vec<_> = kept.iter().map(|&i| labels[i as usize]).collect();
                    assert_eq!(of_kept, expected.clusters(count), "{name}");
                    assert!(removed.iter().all(|&i| labels[i as usize] == u32::MAX), "{name}");
                }

                let stars = mesh.stars();
                assert!(removed.iter().all(|&i| stars.of(i).is_empty() && mesh.vertex_neighbors().of(i).is_empty()));
            }
        }
    };
}
check!(of_tetrahedra, inputs3, mesh3, Mesh3, Points3, 3);
check!(of_triangles, inputs2, mesh2, Mesh2, Points2, 2);

fn remove<const D: usize>(mesh: &mut impl Editable<D>, points: Points<'_, D>, indices: &[u32]) {
    Triangulator::new().backend(Backend::Cpu).remove(mesh, points, indices).expect("removes");
}
