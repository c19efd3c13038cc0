//! Times queries of a 3D mesh on the device:
//! `cargo bench --bench measure_queries -- [POINTS] [QUERIES] [ADAPTER] [REPEATS]`.
//!
//! Points and queries are uniform and unsorted, in single precision. Prints a line of JSON with the
//! medians over the repeats, after one run to warm up, in milliseconds: `create` is the locator,
//! `arrays` queries and answers in host memory, `resident` queries and answers in buffers of the
//! device, `circumspheres` those of all tetrahedra in a buffer of the device, and `host` the same
//! queries answered by the CPU from a mesh on the host, once (CPU=0 leaves it out). Asserts that the
//! answers are the same.

use gdel::{
    DeviceLocator, Locator, Outputs, Points, Triangulator,
    internals::{
        d3::generate::{Distribution3, generate3d},
        gpu::{AdapterChoice, Gpu, Storage},
    },
};
use pollster::block_on;
use std::time::Instant;

/// Returns the median time of some runs in milliseconds, after one to warm up.
fn median<R>(repeats: usize, mut run: impl FnMut() -> R) -> f64 {
    drop(run());
    let mut times: Vec<f64> = (0..repeats)
        .map(|_| {
            let start = Instant::now();
            let result = run();
            let time = start.elapsed().as_secs_f64() * 1e3;
            drop(result);
            time
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // `cargo bench` adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let argument = |i: usize, default: &str| arguments.get(i).cloned().unwrap_or(default.to_owned());
    let count: usize = argument(0, "1000000").parse()?;
    let asked: usize = argument(1, "10000000").parse()?;
    let adapter = argument(2, "");
    let repeats = argument(3, "5").parse::<usize>()?.max(1);
    let choice = if adapter.is_empty() { AdapterChoice::Default } else { AdapterChoice::Name(adapter) };
    let gpu = block_on(Gpu::open(&choice))?;
    let single = |count, seed| -> Vec<[f32; 3]> {
        generate3d(Distribution3::Uniform, count, seed).iter().map(|p| p.map(|x| x as f32)).collect()
    };
    let (points, queries) = (single(count, 1), single(asked, 2));
    let triangulator = Triangulator::from_device(gpu.device().clone(), gpu.queue().clone());
    let mesh = triangulator.delaunay3d_on_device(&points)?;

    let create = median(repeats, || DeviceLocator::new(&mesh, &points).map(|_| ()).unwrap());
    let locator = DeviceLocator::new(&mesh, &points)?;
    let arrays = median(repeats, || locator.locate_many(&queries).unwrap());
    let buffer = Storage::with_contents(&gpu, "queries", queries.as_flattened())?;
    let resident = median(repeats, || locator.locate_buffer(buffer.buffer()).unwrap());
    let circumspheres = median(repeats, || locator.circumspheres_buffer().unwrap());
    let mut host = f64::NAN;
    if std::env::var("CPU").as_deref() != Ok("0") {
        let read = mesh.read(Outputs::ALL)?;
        let on_host = Locator::new(&read, &points)?;
        let start = Instant::now();
        let expected = on_host.locate_many(Points::F32(&queries))?;
        host = start.elapsed().as_secs_f64() * 1e3;
        assert!(locator.locate_many(&queries)?.iter().eq(expected), "the answers are not those of the host");
    }
    println!(
        "{{\"adapter\":{:?},\"points\":{count},\"queries\":{asked},\"host_answers\":{},\"milliseconds\":{{\"create\":{create:.2},\
         \"arrays\":{arrays:.2},\"resident\":{resident:.2},\"circumspheres\":{circumspheres:.2},\"host\":{host:.0}}}}}",
        gpu.adapter().name,
        locator.host_answers()
    );
    Ok(())
}
