//! Triangulates points in 2D and computes the Voronoi cell of one of them.
//!
//! `cargo run --release --example triangulate_2d`

use gdel::delaunay2d;

fn main() -> Result<(), gdel::Error> {
    // A sunflower: every point has about the same room.
    let golden_angle = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    let points: Vec<[f64; 2]> = (0..2000)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * golden_angle).sin_cos();
            [f64::from(i).sqrt() * cos, f64::from(i).sqrt() * sin]
        })
        .collect();
    let mesh = delaunay2d(&points)?;
    println!("{} triangles, {} edges, {} on the hull", mesh.triangles.len(), mesh.edges().count(), mesh.hull.len());

    let length = |[a, b]: [u32; 2]| {
        let [[ax, ay], [bx, by]] = [a, b].map(|v| points[v as usize]);
        (ax - bx).hypot(ay - by)
    };
    let longest = mesh.edges().max_by(|&e, &f| length(e).total_cmp(&length(f))).expect("there are edges");
    println!("the longest edge is {longest:?}, {:.3} long", length(longest));

    // The corners of a Voronoi cell are the circumcentres of the triangles around its point, which
    // turn counter-clockwise.
    let stars = mesh.stars();
    let cell: Vec<[f64; 2]> = stars.of(100).iter().map(|&t| mesh.circumcenter(&points, t as usize)).collect();
    let twice_area: f64 = (0..cell.len())
        .map(|i| {
            let [[ax, ay], [bx, by]] = [cell[i], cell[(i + 1) % cell.len()]];
            ax * by - bx * ay
        })
        .sum();
    println!("the Voronoi cell of point 100 has {} corners and area {:.3}", cell.len(), twice_area / 2.0);
    // A disc of radius √n holds n points, so each has about π.
    assert!((twice_area / 2.0 - std::f64::consts::PI).abs() < 0.1);
    Ok(())
}
