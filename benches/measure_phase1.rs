//! Times Phase 1 in 3D:
//! `cargo bench --features cli --bench measure_phase1 -- [KIND|FILE] [POINTS] [ADAPTER] [REPEATS]`,
//! on coordinates rounded to `f32`.
//!
//! The variables PICK (0–3), INSERT_ALL (0, 1), SORT (0, 1), MIN_ACTIVE, SLOTS_PER_ACTIVE,
//! WORKGROUPS, FEW, START (the points that the CPU engine triangulates first), ROUNDS, BATCHES, HISTORY,
//! TAIL (points per block of the tail), PART (the mebibytes of a part of large arrays) and SEED change the settings. Prints a line of JSON: medians over the repeats, after a second of runs
//! to warm up, since a device raises its clock slowly; and the stages of one more run, which is
//! slower because each dispatch is timed.

use gdel::Points;
use gdel::internals::d3::generate::{Distribution3, generate3d};
use gdel::internals::gpu::start::first_simplex;
use gdel::internals::gpu::{AdapterChoice, Gpu, Profiler};
use gdel::internals::input::lattice::Lattice;
use gdel::internals::io::files::read_points;
use gdel::internals::{
    gpu::layout::Pick,
    gpu::phase1::{Input, Phase1, Phase1Output, Settings},
};
use pollster::block_on;
use std::path::Path;

fn milliseconds(time: std::time::Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // `cargo bench` adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let argument = |i: usize, default: &str| arguments.get(i).cloned().unwrap_or(default.to_owned());
    let kind = argument(0, "uniform");
    let count: usize = argument(1, "100000").parse()?;
    let adapter = argument(2, "");
    let repeats: usize = argument(3, "5").parse()?;
    let option = |name: &str, default: u32| -> u32 {
        std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
    };
    let defaults = Settings::default();
    let settings = Settings {
        pick: Pick::ALL[option("PICK", 0) as usize % Pick::ALL.len()],
        insert_all: option("INSERT_ALL", 0) != 0,
        min_active: option("MIN_ACTIVE", defaults.min_active),
        slots_per_active: option("SLOTS_PER_ACTIVE", defaults.slots_per_active),
        workgroups: option("WORKGROUPS", defaults.workgroups),
        sort: option("SORT", 1) != 0,
        few: option("FEW", defaults.few),
        start_points: std::env::var("START").ok().and_then(|value| value.parse().ok()),
        rounds: option("ROUNDS", defaults.rounds),
        batches: option("BATCHES", defaults.batches),
        history: option("HISTORY", defaults.history),
        points_per_tail_block: option("TAIL", defaults.points_per_tail_block),
        part_bytes: std::env::var("PART").ok().and_then(|value| value.parse().ok()).map(|part: u64| part << 20),
        ..defaults
    };

    let choice = if adapter.is_empty() { AdapterChoice::Default } else { AdapterChoice::Name(adapter) };
    let gpu = block_on(Gpu::open(&choice))?;
    let doubles: Vec<[f64; 3]> = match Distribution3::ALL.into_iter().find(|d| d.name() == kind) {
        Some(distribution) => generate3d(distribution, count, option("SEED", 1).into()),
        None => Points::from(&read_points(Path::new(&kind))?.points).iter().collect(),
    };
    let points: Vec<[f32; 3]> = doubles.into_iter().map(|p| p.map(|x| x as f32)).collect();
    let clock = std::time::Instant::now();
    let lattice = Lattice::fit((&points).into());
    let position = |i: usize| lattice.coordinates(points[i].map(f64::from)).map(|c| c.value);
    let start = first_simplex(lattice.width(), points.len(), position).ok_or("the points are coplanar")?;
    let lattice_ms = clock.elapsed().as_secs_f64() * 1e3;
    let input = Input { points: (&points).into(), lattice: &lattice, start, starts_later: false, is_uploaded: false };

    let clock = std::time::Instant::now();
    let mut phase1 = block_on(Phase1::in_parts(&gpu, lattice.width(), settings.parts(&gpu, count)))?;
    let pipelines_ms = clock.elapsed().as_secs_f64() * 1e3;
    block_on(phase1.finish_compiling(&gpu))?;
    let mut runs: Vec<Phase1Output<3>> = Vec::new();
    let warm_up = std::time::Instant::now();
    while runs.is_empty() || warm_up.elapsed().as_secs_f64() < 1.0 {
        runs = vec![block_on(phase1.run(&gpu, input, &settings, None))?];
    }
    for _ in 0..repeats.max(1) {
        runs.push(block_on(phase1.run(&gpu, input, &settings, None))?);
    }
    let mut stages = Vec::new();
    if let Some(mut profiler) = Profiler::new(&gpu)? {
        block_on(phase1.run(&gpu, input, &settings, Some(&mut profiler)))?;
        let last = gpu.queue().submit([]);
        stages = block_on(profiler.milliseconds(&gpu, &last))?.to_vec();
    }
    runs.remove(0);
    runs.sort_by_key(|run| run.stats.time);
    let all: Vec<String> = runs.iter().map(|r| format!("{:.2}", milliseconds(r.stats.time))).collect();
    let Phase1Output { stats, result, merged } = &runs[runs.len() / 2];
    let counters = &stats.counters;
    let each_round: Vec<String> = stats
        .rounds
        .iter()
        .map(|r| format!("[{},{},{},{},{:.2}]", r.inserted, r.active, r.flips, r.iterations, milliseconds(r.time)))
        .collect();
    let stages: Vec<String> = stages.iter().map(|(name, ms)| format!("\"{name}\":{ms:.3}")).collect();
    println!(
        "{{\"input\":\"{kind}\",\"points\":{},\"adapter\":\"{}\",\"width\":\"{:?}\",\"ms\":{:.2},\"all_ms\":[{}],\
         \"mesh_readback_ms\":{:.2},\"lattice_ms\":{lattice_ms:.1},\"pipelines_ms\":{pipelines_ms:.0},\"rounds\":{},\
         \"each_round\":[{}],\"flip_iterations\":{},\"few_done\":{},\"visits\":{},\"flips_23\":{},\"flips_32\":{},\"exact\":{},\"tets\":{},\"failed\":{},\
         \"merged\":{},\"uncertain\":{},\"readbacks\":{},\"stalls\":{},\"dispatches\":{},\"gpu_bytes\":{},\"stages_ms\":{{{}}}}}",
        points.len(),
        gpu.adapter().name,
        lattice.width(),
        milliseconds(stats.time),
        all.join(","),
        milliseconds(stats.readback_time),
        stats.rounds.iter().filter(|round| round.inserted > 0).count(),
        each_round.join(","),
        counters.iterations,
        counters.few_done,
        counters.visits,
        counters.flips_23,
        counters.flips_32,
        counters.exact,
        result.tets.len(),
        result.failed.len(),
        merged.len(),
        result.uncertain.len(),
        stats.readbacks,
        stats.stalls,
        stats.dispatches,
        stats.bytes,
        stages.join(",")
    );
    Ok(())
}
