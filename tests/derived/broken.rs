//! What is no mesh, or no mesh of these points: an error, or any answer, but neither a panic nor an
//! endless loop.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3, queries};
use gdel::{
    AlphaShape, Clip, Error, Interpolation, Interpolator, Locator, Mesh, Points, SpanningTree, Surface, SurfaceOptions,
    Voronoi,
    internals::{
        derived::{AlphaEdges, StolenMeasures, SurfaceMesh, VoronoiShapes},
        geometry::Euclidean,
    },
};

/// Returns the errors of all that is derived from a mesh and its points.
fn errors<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]]) -> [Option<Error>; 5]
where
    Euclidean: SurfaceMesh<D, N> + AlphaEdges<D, N> + VoronoiShapes<D, N>,
{
    let points = Points::F64(points);
    [
        Locator::new(mesh, points).err(),
        Voronoi::new(mesh, points, Clip::None).err(),
        AlphaShape::new(mesh, points).err(),
        SpanningTree::new(mesh, points).err(),
        Surface::new(mesh, points, &SurfaceOptions::default()).err(),
    ]
}

fn check_errors<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: SurfaceMesh<D, N> + AlphaEdges<D, N> + VoronoiShapes<D, N>,
{
    let count = points.len();
    assert_eq!(errors(mesh, points), [None, None, None, None, None]);
    let few = Some(Error::PointCount { points: count - 1, expected: count });
    assert!(errors(mesh, &points[1..]).iter().all(|error| *error == few));
    let mut infinite = points.to_vec();
    infinite[2][1] = f64::NEG_INFINITY;
    let not_finite = Some(Error::NotFinite { index: 2, axis: 'y', value: "-inf" });
    assert!(errors(mesh, &infinite).iter().all(|error| *error == not_finite));
}

#[test]
fn points_that_are_not_those_of_the_mesh_are_errors() {
    let (_, points) = inputs3().swap_remove(0);
    let mesh = mesh3(&points);
    check_errors(&mesh, &points);
    let is_broken = |error: &Option<Error>| matches!(error, Some(Error::BrokenMesh { .. }));
    let mut broken = mesh.clone();
    broken.tetrahedra[5][1] = points.len() as u32;
    assert!(errors(&broken, &points).iter().all(is_broken));
    let mut broken = mesh.clone();
    broken.neighbors[5][1] = mesh.tetrahedra.len() as u32;
    assert!(errors(&broken, &points).iter().all(is_broken));
    let mut broken = mesh;
    broken.duplicate_of[3] = points.len() as u32;
    assert!(errors(&broken, &points).iter().all(is_broken));

    let (_, points) = inputs2().swap_remove(0);
    check_errors(&mesh2(&points), &points);
}

/// Asks everything of a mesh that is right in its arrays alone.
fn ask_everything<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]])
where
    Euclidean: SurfaceMesh<D, N> + AlphaEdges<D, N> + VoronoiShapes<D, N> + StolenMeasures<D, N>,
{
    let queries = queries(points);
    let points = Points::F64(points);
    let locator = Locator::new(mesh, points).unwrap();
    let values = vec![1.0; points.len()];
    let interpolator = Interpolator::new(&locator, &values).unwrap();
    for &query in queries.iter().step_by(7) {
        let _ = locator.locate(query);
        let _ = locator.nearest(query);
        let _ = locator.nearest_k(query, 10);
        for method in [Interpolation::Linear, Interpolation::Laplace, Interpolation::Sibson] {
            let _ = interpolator.interpolate(method, query);
        }
    }
    let bounds = points.bounds().unwrap();
    for clip in [Clip::None, Clip::Hull, Clip::Box(bounds)] {
        if let Ok(voronoi) = Voronoi::new(mesh, points, clip) {
            assert_eq!(voronoi.diagram().volumes.len(), points.len());
        }
    }
    let shape = AlphaShape::new(mesh, points).unwrap();
    shape.critical_values();
    for alpha in [0.0, 0.1, f64::INFINITY].into_iter().chain(shape.find_alpha(1)) {
        let complex = shape.at(alpha).unwrap();
        complex.components();
        // Flat points have both sides of triangles, or of edges, in place of a solid.
        let most =
            if mesh.simplices().is_empty() { 2 * complex.facets().count() } else { (D + 1) * complex.solid().count() };
        assert!(complex.surface().count() <= most);
    }
    let tree = SpanningTree::new(mesh, points).unwrap();
    assert_eq!(tree.clusters(3).len(), points.len());
    let surface = Surface::new(mesh, points, &SurfaceOptions::default()).unwrap();
    assert_eq!(surface.sides().len(), points.len());
}

/// Simplices of such meshes are flat and inverted, and overlap.
#[test]
fn meshes_of_other_points_neither_panic_nor_hang() {
    for (name, points) in inputs3() {
        if ["uniform", "grid of 5³", "sphere", "doubled grid", "coplanar"].contains(&name) {
            let mesh = mesh3(&points);
            let reversed: Vec<_> = points.iter().rev().copied().collect();
            ask_everything(&mesh, &reversed);
            ask_everything(&mesh, &vec![points[0]; points.len()]);
            let flat: Vec<_> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
            ask_everything(&mesh, &flat);
        }
    }
    for (name, points) in inputs2() {
        if ["uniform", "grid of 9²", "wheel", "collinear"].contains(&name) {
            let mesh = mesh2(&points);
            let reversed: Vec<_> = points.iter().rev().copied().collect();
            ask_everything(&mesh, &reversed);
            ask_everything(&mesh, &vec![points[0]; points.len()]);
            let flat: Vec<_> = points.iter().map(|p| [p[0], 0.0]).collect();
            ask_everything(&mesh, &flat);
        }
    }
}

/// Neighbours that are not those of the simplices, and duplicates in a circle.
#[test]
fn arrays_that_contradict_each_other_neither_panic_nor_hang() {
    let (_, points) = inputs3().swap_remove(0);
    let mut mesh = mesh3(&points);
    let count = mesh.tetrahedra.len() as u32;
    for (t, neighbors) in mesh.neighbors.iter_mut().enumerate() {
        neighbors[t % 4] = (7 * t as u32 + 3) % count;
    }
    ask_everything(&mesh, &points);
    let mut mesh = mesh3(&points);
    mesh.neighbors.iter_mut().for_each(|neighbors| *neighbors = [gdel::NONE; 4]);
    ask_everything(&mesh, &points);
    let mut mesh = mesh3(&points);
    (0..10).for_each(|i| mesh.duplicate_of[i] = ((i + 1) % 10) as u32);
    ask_everything(&mesh, &points);
    let mut mesh = mesh3(&points);
    mesh.tetrahedra.iter_mut().for_each(|tetrahedron| *tetrahedron = [tetrahedron[0]; 4]);
    ask_everything(&mesh, &points);

    let (_, points) = inputs2().swap_remove(0);
    let mut mesh = mesh2(&points);
    let count = 3 * mesh.triangles.len() as u32;
    for (t, halfedges) in mesh.halfedges.iter_mut().enumerate() {
        halfedges[t % 3] = (7 * t as u32 + 3) % count;
    }
    ask_everything(&mesh, &points);
    let mut mesh = mesh2(&points);
    mesh.triangles.iter_mut().for_each(|triangle| *triangle = [triangle[0]; 3]);
    ask_everything(&mesh, &points);
}
