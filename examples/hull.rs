//! Computes the convex hull of points in 3D: its vertices, area and volume.
//!
//! `cargo run --release --example hull`

use gdel::delaunay3d;

type Vector = [f64; 3];

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn main() -> Result<(), gdel::Error> {
    // A cube of side 2 with points inside, on its faces and on its edges; some of them twice.
    let grid = (0..125).map(|i| [i % 5, i / 5 % 5, i / 25].map(|x| f64::from(x) / 2.0));
    let points: Vec<Vector> = grid.clone().chain(grid.step_by(7)).collect();
    let mesh = delaunay3d(&points)?;
    if mesh.dimension < 3 {
        println!("the points span only {} dimensions, so their hull has no volume", mesh.dimension);
        return Ok(());
    }
    let (mut area, mut volume) = (0.0, 0.0);
    for triangle in &mesh.hull {
        // Counter-clockwise as seen from outside, so the normal points outwards.
        let [a, b, c] = triangle.map(|v| points[v as usize]);
        let normal = cross(minus(b, a), minus(c, a));
        area += dot(normal, normal).sqrt() / 2.0;
        volume += dot(a, normal) / 6.0;
    }
    println!("{} triangles, {} vertices", mesh.hull.len(), mesh.hull_vertices().len());
    println!("{} points are duplicates", mesh.duplicate_count());
    println!("area {area}, volume {volume}");
    assert!((area - 24.0).abs() < 1e-9 && (volume - 8.0).abs() < 1e-9);
    Ok(())
}
