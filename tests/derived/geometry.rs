//! Topology and geometry of simplices, on degenerate meshes too.

use crate::inputs::{inputs2, inputs3, mesh2, mesh3};
use gdel::{Csr, Mesh};
use std::collections::BTreeSet;

fn check_topology<const D: usize, const N: usize>(
    name: &str,
    mesh: &impl Mesh<D, N>,
    neighbors: &Csr,
    vertex_simplex: &[u32],
) {
    let points = mesh.duplicate_of().len();
    assert_eq!((neighbors.len(), neighbors.is_empty(), vertex_simplex.len()), (points, points == 0, points), "{name}");
    for v in 0..points as u32 {
        let star: Vec<_> = (0..mesh.simplices().len()).filter(|&t| mesh.simplices()[t].contains(&v)).collect();
        let around: BTreeSet<u32> = star.iter().flat_map(|&t| mesh.simplices()[t]).filter(|&w| w != v).collect();
        assert_eq!(neighbors.of(v), around.into_iter().collect::<Vec<_>>(), "{name}");
        assert_eq!(vertex_simplex[v as usize], star.first().map_or(gdel::NONE, |&t| t as u32), "{name}");
    }
    // What is opposite a vertex has the other vertices.
    for (t, (simplex, opposites)) in mesh.simplices().iter().zip(&*mesh.opposites()).enumerate() {
        for (k, &u) in opposites.iter().enumerate() {
            if u != gdel::NONE {
                let other = mesh.simplices()[u as usize];
                assert!((0..N).all(|l| other.contains(&simplex[l]) == (l != k)), "{name}");
                assert!(mesh.opposites()[u as usize].contains(&(t as u32)), "{name}");
            }
        }
    }
}

#[test]
fn topology_in_3d() {
    for (name, points) in inputs3() {
        let mesh = mesh3(&points);
        check_topology(name, &mesh, &mesh.vertex_neighbors(), &mesh.vertex_tetrahedron());
        assert_eq!(mesh.vertex_neighbors().indices.len(), 2 * mesh.edges().count(), "{name}");
    }
}

#[test]
fn topology_in_2d() {
    for (name, points) in inputs2() {
        let mesh = mesh2(&points);
        check_topology(name, &mesh, &mesh.vertex_neighbors(), &mesh.vertex_triangle());
        assert_eq!(mesh.vertex_neighbors().indices.len(), 2 * mesh.edges().count(), "{name}");
    }
}

fn distance<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    // Scaled, as the squares of the largest coordinates overflow.
    let largest = (0..D).fold(0.0, |m: f64, i| m.max((a[i] - b[i]).abs()));
    if largest == 0.0 { 0.0 } else { largest * (0..D).map(|i| ((a[i] - b[i]) / largest).powi(2)).sum::<f64>().sqrt() }
}

/// The centre is at the distance of the radius from all vertices, as far as the bounds promise and
/// the rounding of its coordinates allows.
fn check_center<const D: usize, const N: usize>(name: &str, corners: [[f64; D]; N], center: [f64; D], radius: f64) {
    if !radius.is_finite() {
        assert!(name == "huge", "{name}: {corners:?}");
        return;
    }
    let rounding = center.iter().fold(0.0, |m: f64, x| m.max(x.abs())) * f64::EPSILON;
    for corner in corners {
        let error = (distance(corner, center) - radius).abs();
        assert!(error <= radius * 4e-11 + 4.0 * rounding, "{name}: {corners:?} {center:?} {radius} {error}");
    }
}

#[test]
fn circumcenters_are_at_the_same_distance_from_all_vertices() {
    for (name, points) in inputs3() {
        let mesh = mesh3(&points);
        let centers = mesh.circumcenters(&points).zip(mesh.circumradii(&points));
        for (t, (center, radius)) in centers.enumerate() {
            check_center(name, mesh.tetrahedra[t].map(|v| points[v as usize]), center, radius);
            assert!(center == mesh.circumcenter(&points, t) || !radius.is_finite());
        }
    }
    for (name, points) in inputs2() {
        let mesh = mesh2(&points);
        let centers = mesh.circumcenters(&points).zip(mesh.circumradii(&points));
        for (t, (center, radius)) in centers.enumerate() {
            check_center(name, mesh.triangles[t].map(|v| points[v as usize]), center, radius);
            assert!(center == mesh.circumcenter(&points, t) || !radius.is_finite());
        }
    }
}

#[test]
fn volumes_and_areas_fill_the_hull() {
    for name in ["grid of 5³", "uniform", "shuffled grid"] {
        let points = inputs3().into_iter().find(|(n, _)| *n == name).unwrap().1;
        let mesh = mesh3(&points);
        // The divergence theorem over the hull.
        let hull = mesh.hull.iter().map(|f| f.map(|v| points[v as usize])).map(|[a, b, c]| {
            (a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0
        });
        let (hull, sum) = (hull.sum::<f64>(), mesh.volumes(&points).sum::<f64>());
        assert!((hull - sum).abs() < 1e-12 * hull, "{name}: {hull} {sum}");
    }
    let points = inputs2().into_iter().find(|(n, _)| *n == "grid of 9²").unwrap().1;
    assert_eq!(mesh2(&points).areas(&points).sum::<f64>(), 64.0);
}

#[test]
fn angles_and_qualities_of_known_simplices() {
    let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
    // The corner of a cube: right angles at its three edges.
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mesh = mesh3(&points);
    let angles = mesh.dihedral_angles(&points).next().unwrap();
    let edges = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]].map(|e| e.map(|k| mesh.tetrahedra[0][k]));
    for (angle, edge) in angles.into_iter().zip(edges) {
        let expected = if edge.contains(&0) { 90.0 } else { 3f64.sqrt().recip().acos().to_degrees() };
        assert!(near(angle.to_degrees() / 90.0, expected / 90.0), "{edge:?} {angle}");
    }
    // The inradius is 1 / (3 + √3), the circumradius √3/2.
    let expected = 3.0 / (3.0 + 3f64.sqrt()) / (3f64.sqrt() / 2.0);
    assert!(near(mesh.radius_ratios(&points).next().unwrap(), expected));

    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 3f64.sqrt()]];
    let mesh = mesh2(&points);
    for (angle, &v) in mesh.angles(&points).next().unwrap().iter().zip(&mesh.triangles[0]) {
        assert!(near(angle.to_degrees() / 90.0, [90.0, 60.0, 30.0][v as usize] / 90.0));
    }
    let regular = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75f64.sqrt()]];
    assert!(near(mesh2(&regular).radius_ratios(&regular).next().unwrap(), 1.0));
}
