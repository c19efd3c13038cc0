//! Times the compilation of the kernels: `cargo bench --features cli --bench measure_pipelines --
//! [2|3] [narrow|wide] [each]`.
//!
//! Prints a line of JSON: the milliseconds from the device to Phase 1 that can run, the kernels
//! compiled on all cores, and to the end of those that a first run does without; with `each`, also the milliseconds of each kernel by itself. Drivers keep
//! what they compiled on disk, so that only the first run after a change compiles
//! (`__GL_SHADER_DISK_CACHE=0` turns that off for NVIDIA's).

use gdel::internals::{
    dimension::Dimension,
    gpu::{
        AdapterChoice, Compiler, Gpu,
        phase1::{Finish, Phase1},
        shader::{self, Shaders},
    },
    input::lattice::Width,
};
use pollster::block_on;
use std::{error::Error, time::Instant};

fn milliseconds<R>(work: impl FnOnce() -> R) -> (f64, R) {
    let clock = Instant::now();
    let result = work();
    (1e3 * clock.elapsed().as_secs_f64(), result)
}

fn measure<const D: usize>(shaders: &Shaders, width: Width, each: bool) -> Result<serde_json::Value, Box<dyn Error>>
where
    Dimension<D>: Finish<D>,
{
    let (open, gpu) = milliseconds(|| block_on(Gpu::open(&AdapterChoice::Default)));
    let gpu = gpu?;
    let mut kernels: Vec<_> = each
        .then(|| shaders.iter())
        .into_iter()
        .flatten()
        .map(|shader| {
            let kernel = Compiler::new(&gpu).on_demand(shader, width);
            (shader.name(), milliseconds(|| _ = kernel.pipeline()).0)
        })
        .collect();
    kernels.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (all, phase1) = milliseconds(|| block_on(Phase1::<D>::new(&gpu, width)));
    let phase1 = phase1?;
    let (deferred, result) = milliseconds(|| block_on(phase1.finish_compiling(&gpu)));
    result?;
    Ok(serde_json::json!({
        "dimension": D, "width": format!("{width:?}"), "adapter": gpu.adapter().name, "open_ms": open,
        "each_ms": kernels, "needed_ms": all, "all_ms": all + deferred,
    }))
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let has = |argument: &str| arguments.iter().any(|a| a == argument);
    let (width, each) = (if has("narrow") { Width::Narrow } else { Width::Wide }, has("each"));
    let line = if has("2") { measure::<2>(&shader::D2, width, each)? } else { measure::<3>(&shader::D3, width, each)? };
    println!("{line}");
    Ok(())
}
