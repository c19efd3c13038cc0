//! Times the GPU backend in 2D:
//! `cargo bench --bench measure_2d -- [DISTRIBUTION] [POINTS] [ADAPTER] [REPEATS]`.
//!
//! The distributions are those of `gdel generate --dim 2`, and `full-grid`, all points of a square
//! grid.
//!
//! The variables SINGLE (1: coordinates rounded to `f32`), PICK (0–3), INSERT_ALL (0, 1), SORT (0,
//! 1), MIN_ACTIVE, WORKGROUPS, START and SEED change input and settings (the paper's Figure 12). Prints a
//! line of JSON: medians over the repeats, after one run to warm up, of the whole run and its
//! phases, points in host memory to mesh in host memory; then the same for the CPU engine (once;
//! CPU=0 leaves it out) and whether both agree; and the stages of one more run on the device, which
//! is slower because each dispatch is timed.

use gdel::internals::cpu::delaunay_in_order;
use gdel::internals::d2::generate::{Distribution2, generate2d};
use gdel::internals::gpu::{AdapterChoice, Gpu, Profiler};
use gdel::internals::gpu::{
    engine::GpuEngine,
    layout::Pick,
    phase1::{Input, Phase1, Settings},
    start::first_simplex,
};
use gdel::internals::input::lattice::Lattice;
use gdel::internals::input::order::Order;
use gdel::{Points2, internals::Options};
use pollster::block_on;
use std::time::Instant;

/// Returns the points of a distribution by its name, and all points of a square grid as
/// `full-grid`.
fn points(kind: &str, count: usize, seed: u64) -> Result<Vec<[f64; 2]>, String> {
    if kind == "full-grid" {
        let side = (count as f64).sqrt().ceil() as usize;
        return Ok((0..count).map(|i| [i % side, i / side].map(|x| x as f64)).collect());
    }
    let distribution = Distribution2::ALL.into_iter().find(|d| d.name() == kind);
    Ok(generate2d(distribution.ok_or(format!("no distribution is called {kind:?}"))?, count, seed))
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // `cargo bench` adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let argument = |i: usize, default: &str| arguments.get(i).cloned().unwrap_or(default.to_owned());
    let kind = argument(0, "uniform");
    let count: usize = argument(1, "100000").parse()?;
    let adapter = argument(2, "");
    let repeats = argument(3, "5").parse::<usize>()?.max(1);
    let option = |name: &str, default: u32| -> u32 {
        std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
    };
    let defaults = Settings::default();
    let settings = Settings {
        pick: Pick::ALL[option("PICK", 0) as usize % Pick::ALL.len()],
        insert_all: option("INSERT_ALL", 0) != 0,
        sort: option("SORT", 1) != 0,
        min_active: option("MIN_ACTIVE", defaults.min_active),
        workgroups: option("WORKGROUPS", defaults.workgroups),
        start_points: std::env::var("START").ok().and_then(|value| value.parse().ok()),
        ..defaults
    };
    let doubles = points(&kind, count, option("SEED", 1).into())?;
    let singles: Vec<[f32; 2]> = doubles.iter().map(|p| p.map(|x| x as f32)).collect();
    let single = option("SINGLE", 0) != 0;
    let input: Points2<'_> = if single { (&singles).into() } else { (&doubles).into() };

    let choice = if adapter.is_empty() { AdapterChoice::Default } else { AdapterChoice::Name(adapter) };
    let gpu = block_on(Gpu::open(&choice))?;
    let clock = Instant::now();
    let mut engine = block_on(GpuEngine::new(gpu.clone()))?;
    engine.set_settings(settings);
    let pipelines_ms = clock.elapsed().as_secs_f64() * 1e3;
    let options = Options::default();
    let mut meshes = Vec::new();
    let mut whole = Vec::new();
    for _ in 0..repeats + 1 {
        let clock = Instant::now();
        let mesh = block_on(engine.triangulate(input, &options))?;
        whole.push(clock.elapsed().as_secs_f64() * 1e3);
        meshes.push(mesh.stats.clone());
        if meshes.len() == repeats + 1 && option("CPU", 1) != 0 {
            let clock = Instant::now();
            let expected = delaunay_in_order::<2>(input, &options, Order::default())?;
            eprintln!(
                "{{\"cpu_ms\":{:.1},\"same\":{}}}",
                clock.elapsed().as_secs_f64() * 1e3,
                expected.canonical() == mesh.canonical() && expected.hull == mesh.hull
            );
        }
    }
    whole.remove(0);
    let stats = meshes.pop().unwrap_or_default();
    let phases = stats.phases.iter().map(|&(phase, _)| {
        let of = |stats: &gdel::stats::Stats| stats.time_of(phase).as_secs_f64() * 1e3;
        let mut all: Vec<f64> = meshes[1..].iter().chain([&stats]).map(of).collect();
        format!("\"{phase}\":{:.2}", median(&mut all))
    });
    let phases: Vec<String> = phases.collect();

    let lattice = Lattice::fit(input);
    let position = |i: usize| lattice.coordinates(input.get(i)).map(|c| c.value);
    let start = first_simplex(lattice.width(), count, position).ok_or("the points are collinear")?;
    let device_input = Input { points: input, lattice: &lattice, start, starts_later: false, is_uploaded: false };
    let mut phase1 = block_on(Phase1::new(&gpu, lattice.width()))?;
    let mut stages = Vec::new();
    let mut output = block_on(phase1.run(&gpu, device_input, &settings, None))?;
    if let Some(mut profiler) = Profiler::new(&gpu)? {
        output = block_on(phase1.run(&gpu, device_input, &settings, Some(&mut profiler)))?;
        let last = gpu.queue().submit([]);
        stages = block_on(profiler.milliseconds(&gpu, &last))?.to_vec();
    }
    let stages: Vec<String> = stages.iter().map(|(name, ms)| format!("\"{name}\":{ms:.3}")).collect();
    let all: Vec<String> = whole.iter().map(|ms| format!("{ms:.2}")).collect();
    let (device, counters) = (&output.stats, &output.stats.counters);
    println!(
        "{{\"input\":\"{kind}\",\"points\":{count},\"single\":{single},\"adapter\":\"{}\",\"width\":\"{:?}\",\"ms\":{:.2},\
         \"all_ms\":[{}],\"phases_ms\":{{{}}},\"pipelines_ms\":{pipelines_ms:.0},\"fallback\":{:?},\"rounds\":{},\
         \"flip_iterations\":{},\"visits\":{},\"flips\":{},\"exact\":{},\"hull\":{},\"merged\":{},\"questions\":{},\"readbacks\":{},\
         \"dispatches\":{},\"gpu_bytes\":{},\"stages_ms\":{{{}}}}}",
        gpu.adapter().name,
        lattice.width(),
        median(&mut whole),
        all.join(","),
        phases.join(","),
        stats.fallback.map_or(String::new(), |why| why.to_string()),
        device.rounds.len(),
        counters.iterations,
        counters.visits,
        counters.flips_22,
        counters.exact,
        counters.hull,
        output.merged.len(),
        counters.uncertain,
        device.readbacks,
        device.dispatches,
        device.bytes,
        stages.join(",")
    );
    Ok(())
}
