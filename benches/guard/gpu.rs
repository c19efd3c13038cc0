//! Counts what the GPU backend does on small inputs, for `scripts/guard.sh`, which compares it with
//! `figures.json`: a line for each count, its name and a number.
//!
//! A bench of the crate itself, since counts do not depend on optimisation: `cargo test --bench
//! gpu_counts` links it with what is compiled for the tests anyway.

use gdel::{
    Error,
    internals::{
        Options,
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        gpu::{AdapterChoice, Gpu, engine::GpuEngine},
    },
    stats::Stats,
};
use pollster::block_on;

const POINTS: usize = 10_000;

fn print(input: &str, stats: &Stats) {
    assert_eq!(stats.fallback, None, "{input}");
    let gpu = stats.gpu.as_ref().expect("the GPU backend was requested");
    assert!(gpu.adapter.contains("llvmpipe"), "the figures are those of lavapipe, not of {}", gpu.adapter);
    let counts = [
        ("rounds", gpu.rounds.len() as u64),
        ("flip iterations", gpu.flip_iterations),
        ("flips", gpu.flips_22 + gpu.flips_23 + gpu.flips_32),
        ("exact tests", gpu.exact_tests),
        ("failed vertices", gpu.failed_vertices),
        ("dispatches", gpu.dispatches),
        ("submits", gpu.submits),
        ("readbacks", gpu.readbacks),
        ("stalls", gpu.stalls),
        ("bytes", gpu.bytes),
    ];
    for (name, count) in counts {
        println!("gpu {input}, {name}: {count}");
    }
}

fn main() -> Result<(), Error> {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default))?;
    let mut engine = block_on(GpuEngine::<3>::new(gpu.clone()))?;
    // Both widths, with what a first run does without.
    block_on(engine.triangulate((&generate3d(Distribution3::Grid, 100, 1)).into(), &Options::default()))?;
    block_on(engine.finish_compiling())?;
    let grid = |side: u32| -> Vec<[f64; 3]> {
        (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side.pow(2)].map(f64::from)).collect()
    };
    let inputs = [
        ("uniform", generate3d(Distribution3::Uniform, POINTS, 1)),
        ("grid", grid(22)),
        ("sphere", generate3d(Distribution3::Sphere, POINTS, 1)),
    ];
    for (name, points) in inputs {
        let mesh = block_on(engine.triangulate((&points).into(), &Options::default()))?;
        print(&format!("3D {name}"), &mesh.stats);
    }

    let mut engine = block_on(GpuEngine::<2>::new(gpu))?;
    let grid: Vec<[f64; 2]> = (0..100u32.pow(2)).map(|i| [i % 100, i / 100].map(f64::from)).collect();
    let inputs = [
        ("uniform", generate2d(Distribution2::Uniform, POINTS, 1)),
        ("grid", grid),
        ("circle", generate2d(Distribution2::Circle, POINTS, 1)),
        ("clusters", generate2d(Distribution2::Clusters, POINTS, 1)),
    ];
    for (name, points) in inputs {
        let mesh = block_on(engine.triangulate((&points).into(), &Options::default()))?;
        print(&format!("2D {name}"), &mesh.stats);
    }
    Ok(())
}
