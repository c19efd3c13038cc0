//! Triangulates points in 3D, walks through the mesh, and proves that it is the Delaunay
//! triangulation.
//!
//! `cargo run --release --example triangulate_3d`

use gdel::{delaunay3d, verify3d};

fn main() -> Result<(), gdel::Error> {
    // A 10 × 10 × 10 grid: full of ties, which are broken by index.
    let points: Vec<[f32; 3]> = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|x| x as f32)).collect();
    let mesh = delaunay3d(&points)?;
    println!("{} points, {} tetrahedra, {} hull triangles", points.len(), mesh.tetrahedra.len(), mesh.hull.len());
    println!("{} edges, {} facets", mesh.edges().count(), mesh.facets().count());

    // Each tetrahedron has four vertices, which are indices of points, and up to four neighbours.
    let first = mesh.tetrahedra[0];
    let neighbors: Vec<_> = (0..4).filter_map(|k| mesh.neighbor(0, k)).collect();
    println!("tetrahedron 0 has vertices {first:?} and neighbours {neighbors:?}");

    // The tetrahedra around each vertex are found for all vertices at once.
    let stars = mesh.stars();
    let busiest = mesh.vertices().max_by_key(|&v| stars.of(v).len()).expect("there are points");
    println!("vertex {busiest} has {} tetrahedra", stars.of(busiest).len());

    println!("computed by {} in {:.1?}", mesh.stats.backend, mesh.stats.total_time());
    assert!(verify3d(&points, &mesh)?.passed());
    println!("verified");
    Ok(())
}
