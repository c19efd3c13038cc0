//! Follows a front that moves over a square: points are inserted where linear interpolation errs, and
//! removed where it would do without them.
//!
//!     cargo run --release --example adaptive

use gdel::{Backend, Error, Triangulator};

const TOLERANCE: f64 = 0.05;

fn main() -> Result<(), Error> {
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    let mut points: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i % 10), f64::from(i / 10)].map(|x| x / 9.0)).collect();
    let first = points.len() as u32;
    let mut mesh = triangulator.delaunay2d(&points)?;
    let (mut changes, mut from_scratch) = (0, 0);
    for step in 0..5 {
        let value = |[x, y]: [f64; 2]| (20.0 * (x + 0.3 * y - 0.2 * f64::from(step))).tanh();
        // What the neighbours say as well as the point itself does is not needed.
        let neighbors = mesh.vertex_neighbors();
        let mut kept = vec![false; points.len()];
        let mut removed = Vec::new();
        for v in mesh.vertices().filter(|&v| v >= first) {
            let around = neighbors.of(v);
            let mean = around.iter().map(|&w| value(points[w as usize])).sum::<f64>() / around.len() as f64;
            // Two neighbours are never removed together.
            if (value(points[v as usize]) - mean).abs() < TOLERANCE / 4.0 && !kept[v as usize] {
                removed.push(v);
                around.iter().for_each(|&w| kept[w as usize] = true);
            }
        }
        // In pieces, so that each pays.
        let mut done = 0;
        let mut note = |mesh: &gdel::Mesh2| {
            changes += 1;
            from_scratch += u32::from(mesh.stats.update.is_some_and(|update| update.restarted.is_some()));
        };
        for piece in removed.chunks(4) {
            triangulator.remove(&mut mesh, &points, piece)?;
            note(&mesh);
        }
        for _ in 0..6 {
            let middle = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|v| points[v as usize]);
                [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0]
            };
            let error = |t: &[u32; 3]| {
                let mean = t.iter().map(|&v| value(points[v as usize])).sum::<f64>() / 3.0;
                (value(middle(t)) - mean).abs()
            };
            let new: Vec<_> = mesh.triangles.iter().filter(|t| error(t) > TOLERANCE).map(middle).collect();
            for piece in new.chunks(8) {
                triangulator.insert(&mut mesh, &mut points, piece)?;
                note(&mesh);
                done += piece.len();
            }
        }
        println!("step {step}: {} removed, {done} inserted, {} triangles", removed.len(), mesh.triangles.len());
    }
    // The indices of removed points are dropped.
    let kept = mesh.compact();
    let points: Vec<_> = kept.iter().map(|&i| points[i as usize]).collect();
    println!("{} points are left; {from_scratch} of {changes} changes were from scratch", points.len());
    assert!(changes > 20 && from_scratch == 0);
    assert_eq!(mesh.canonical(), gdel::delaunay2d(&points)?.canonical());
    Ok(())
}
