//! The stages before Phase 1 and the predicates on the GPU, by the device's own clock.
//!
//! `cargo bench --bench gpu_stages -- [points…]`; 100,000 and 1,000,000 points by default. Medians
//! of five runs after one to warm up.

use std::time::Instant;

#[path = "../tests/gpu/assemble.rs"]
mod assemble;

use assemble::assemble;
use gdel::{
    Points, Points3,
    internals::{
        d3::gpu::vertex,
        gpu::{
            AdapterChoice, Compiler, Gpu, Kernel, Profiler, Readback, Recorder, Storage,
            points::{PointInput, PointStage},
            workgroups,
        },
        input::lattice::{Lattice, Width},
    },
};
use pollster::block_on;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const RUNS: usize = 5;

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn random_points(n: usize) -> Vec<[f64; 3]> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    (0..n).map(|_| std::array::from_fn(|_| rng.random())).collect()
}

/// Returns milliseconds per stage, and for all with the host's part.
fn points(gpu: &Gpu, stage: &PointStage<3>, points: Points3<'_>) {
    let mut stages: Vec<(&str, Vec<f64>)> = Vec::new();
    let mut note = |name, ms| match stages.iter_mut().find(|(stage, _)| *stage == name) {
        Some((_, times)) => times.push(ms),
        None => stages.push((name, vec![ms])),
    };
    let mut kept = None;
    for run in 0..=RUNS {
        let mut profiler = Profiler::new(gpu).expect("the bench needs timestamps").expect("the bench needs timestamps");
        let mut readback = Readback::default();
        let start = Instant::now();
        let lattice = Lattice::fit(points);
        let fitted = start.elapsed().as_secs_f64() * 1e3;
        let mut recorder = Recorder::new(gpu, Some(&mut profiler));
        let input = PointInput { points, lattice: &lattice, sort: true, is_uploaded: false };
        let device = stage.record(gpu, &mut recorder, &mut kept, input).expect("the points fit");
        let pending = readback.copy(gpu, recorder.encoder(), &device.counts, 0, 1);
        let recorded = start.elapsed().as_secs_f64() * 1e3;
        let submission = recorder.submit(gpu);
        let counts = block_on(readback.receive(gpu, &submission, pending)).expect("the device works");
        let all = start.elapsed().as_secs_f64() * 1e3;
        assert_eq!(counts[0].merged, 0);
        let times = block_on(profiler.milliseconds(gpu, &submission)).expect("the device works").to_vec();
        if run > 0 {
            note("fit (host)", fitted);
            note("upload (host)", recorded - fitted);
            times.iter().for_each(|&(name, ms)| note(name, ms));
            note("all, wall", all);
        }
    }
    let form = if matches!(points, Points::F32(_)) { "f32" } else { "f64" };
    let columns: Vec<String> = stages.into_iter().map(|(name, t)| format!("{name} {:.3}", median(t))).collect();
    println!("{:>9} points {form}: ms: {}", points.len(), columns.join(", "));
}

/// Returns nanoseconds of device time per test.
fn predicate(gpu: &Gpu, width: Width, name: &str, arguments: &str) {
    const VERTICES: usize = 1 << 16;
    const TESTS: usize = 1 << 22;
    let wgsl = format!(
        "//!include d3/predicates
//!include d3/filter
@group(0) @binding(0) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(1) var<storage, read_write> signs: array<i32>;
@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {{
    for (var i = id.x; i < {TESTS}; i += groups.x * 256) {{
        let v = i & {};
        signs[i] = {name}({arguments});
    }}
}}",
        VERTICES - 1
    );
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let mut words = Vec::new();
    for index in 0..VERTICES as u32 + 8 {
        let position = std::array::from_fn(|_| rng.random_range(0..1i64 << width.bits()));
        vertex::append_words(&mut words, width, position, index, false);
    }
    let (kernel, bindings) = block_on(gpu.with_error_scope("bench", || {
        let vertices = Storage::with_contents(gpu, "vertices", &words)?;
        let signs = Storage::<i32>::new(gpu, "signs", TESTS)?;
        let kernel = Kernel::from_wgsl(gpu, name, &assemble(&wgsl, width), &["vertices", "signs"], &[]);
        let bindings = kernel.bind(gpu, &[("vertices", vertices.buffer()), ("signs", signs.buffer())]);
        Ok((kernel, bindings))
    }))
    .expect("the kernel is valid");
    let times = (0..=RUNS).map(|_| {
        let mut profiler = Profiler::new(gpu).expect("the bench needs timestamps").expect("the bench needs timestamps");
        let mut recorder = Recorder::new(gpu, Some(&mut profiler));
        recorder.stage("test");
        recorder.dispatch(&kernel, &bindings, workgroups(TESTS as u32));
        let submission = recorder.submit(gpu);
        block_on(profiler.milliseconds(gpu, &submission)).expect("the device works")[0].1
    });
    println!("{width:?} {name}: {:.3} ns", median(times.skip(1).collect()) * 1e6 / TESTS as f64);
}

fn main() {
    let sizes: Vec<usize> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the bench needs a GPU");
    println!("{:?}", gpu.adapter());
    let stage = PointStage::new(&Compiler::new(&gpu));
    for &n in if sizes.is_empty() { &[100_000, 1_000_000][..] } else { &sizes } {
        let doubles = random_points(n);
        let singles: Vec<[f32; 3]> = doubles.iter().map(|p| p.map(|x| x as f32)).collect();
        points(&gpu, &stage, (&doubles).into());
        points(&gpu, &stage, (&singles).into());
    }
    for width in [Width::Narrow, Width::Wide] {
        let vertices = |load: &str, n: usize| (0..n).map(|k| format!("{load}(v + {k})")).collect::<Vec<_>>().join(", ");
        for (name, load, n) in [
            ("orient3d_filter", "load_high", 4),
            ("insphere_filter", "load_high", 5),
            ("orient3d", "load_vertex", 4),
            ("insphere", "load_vertex", 5),
        ] {
            predicate(&gpu, width, name, &vertices(load, n));
        }
    }
}
