//! Times the GPU backend in 3D:
//! `cargo bench --features cli --bench measure_3d -- [KIND|FILE] [POINTS] [ADAPTER] [REPEATS]`.
//!
//! The variable SINGLE (1) rounds the coordinates to `f32`, SEED chooses others, RESIDENT (1) leaves
//! the mesh on the device, REUSE (1) writes it into the same vectors each time, START is the number
//! of points that the CPU engine triangulates first, PICK (0–3) says how tetrahedra pick their points,
//! BESIDE (1 or 0) has the mesh read while it is splayed, or before, PART the mebibytes of a part of
//! large arrays, which otherwise are in parts where they have to be. Prints a line of JSON: medians over the repeats
//! of the whole run and its phases, points in host memory to mesh in host memory. Before, it runs
//! for a second to warm up: a device raises its clock slowly.

use gdel::internals::d3::generate::{Distribution3, generate3d};
use gdel::internals::gpu::{AdapterChoice, Gpu, engine::GpuEngine, layout::Pick, phase1::Settings};
use gdel::internals::io::files::read_points;
use gdel::{Mesh3, Points, Points3, internals::Options};
use pollster::block_on;
use std::{path::Path, time::Instant};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // `cargo bench` adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let argument = |i: usize, default: &str| arguments.get(i).cloned().unwrap_or(default.to_owned());
    let (kind, count, adapter) = (argument(0, "uniform"), argument(1, "100000").parse::<usize>()?, argument(2, ""));
    let repeats: usize = argument(3, "5").parse()?;
    let option = |name: &str, default: u64| -> u64 {
        std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
    };
    let single = option("SINGLE", 0) != 0;
    let doubles: Vec<[f64; 3]> = match Distribution3::ALL.into_iter().find(|d| d.name() == kind) {
        Some(distribution) => generate3d(distribution, count, option("SEED", 1)),
        None => Points::from(&read_points(Path::new(&kind))?.points).iter().collect(),
    };
    let singles: Vec<[f32; 3]> = doubles.iter().map(|p| p.map(|x| x as f32)).collect();
    let points: Points3<'_> = if single { (&singles).into() } else { (&doubles).into() };

    let choice = if adapter.is_empty() { AdapterChoice::Default } else { AdapterChoice::Name(adapter) };
    let gpu = block_on(Gpu::open(&choice))?;
    let name = gpu.adapter().name.clone();
    let mut engine = block_on(GpuEngine::new(gpu))?;
    let start_points = std::env::var("START").ok().and_then(|value| value.parse().ok());
    let (resident, reuse) = (option("RESIDENT", 0) != 0, option("REUSE", 0) != 0);
    let sparse = option("SPARSE", 0) != 0;
    let part_bytes = std::env::var("PART").ok().and_then(|value| value.parse::<u64>().ok()).map(|part| part << 20);
    let reads_beside = std::env::var("BESIDE").ok().map(|value| value == "1");
    let pick = Pick::ALL[option("PICK", 0) as usize % Pick::ALL.len()];
    engine.set_settings(Settings { start_points, sparse, part_bytes, reads_beside, pick, ..Settings::default() });
    // The kernels of narrow coordinates are compiled by the first run that needs them.
    block_on(engine.triangulate(points, &Options::default()))?;
    block_on(engine.finish_compiling())?;
    let mut kept = Mesh3::default();
    let mut run = || -> Result<_, gdel::Error> {
        if resident {
            let clock = Instant::now();
            let mesh = block_on(engine.triangulate_on_device(points, &Options::default()))?;
            return Ok((1e3 * clock.elapsed().as_secs_f64(), mesh.simplex_count(), mesh.stats().clone()));
        }
        if !reuse {
            kept = Mesh3::default();
        }
        let clock = Instant::now();
        block_on(engine.triangulate_into(points, &Options::default(), &mut kept))?;
        Ok((1e3 * clock.elapsed().as_secs_f64(), kept.tetrahedra.len(), kept.stats.clone()))
    };
    let warm_up = Instant::now();
    while warm_up.elapsed().as_secs_f64() < 1.0 {
        run()?;
    }
    let mut runs = (0..repeats.max(1)).map(|_| run()).collect::<Result<Vec<_>, _>>()?;
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (ms, tetrahedra, stats) = &runs[runs.len() / 2];
    let phases: serde_json::Map<_, _> =
        stats.phases.iter().map(|&(phase, time)| (phase.to_string(), (1e3 * time.as_secs_f64()).into())).collect();
    let gpu = stats.gpu.as_ref().map(|gpu| {
        serde_json::json!({
            "rounds": gpu.rounds.len(), "flip_iterations": gpu.flip_iterations, "dispatches": gpu.dispatches,
            "readbacks": gpu.readbacks, "stalls": gpu.stalls, "failed_vertices": gpu.failed_vertices,
        })
    });
    let line = serde_json::json!({
        "input": kind, "points": points.len(), "single": single, "adapter": name, "ms": ms,
        "all_ms": runs.iter().map(|run| run.0).collect::<Vec<_>>(), "phases_ms": phases, "tetrahedra": tetrahedra,
        "gpu": gpu,
        "splay": stats.splay, "fallback": stats.fallback,
    });
    println!("{line}");
    Ok(())
}
