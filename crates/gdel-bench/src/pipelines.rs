//! What a first run waits for.

use crate::{
    input::Adapter,
    row::{Row, microseconds, timed},
};
use clap::Args;
use gdel::internals::{
    dimension::Dimension,
    gpu::{
        Compiler,
        phase1::{Finish, Phase1},
        shader::{self, Shaders},
    },
    input::lattice::Width,
};
use pollster::block_on;
use serde_json::{Map, json};
use std::error::Error;

/// Time opening the device and compiling the kernels.
///
/// These are the kernels that a first run needs, and all. Drivers keep on disk what they compiled (`__GL_SHADER_DISK_CACHE=0` turns that off for NVIDIA's).
#[derive(Args)]
pub struct Arguments {
    /// The dimension
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(2..=3))]
    dim: u8,
    /// The kernels for coordinates of 31 bits, instead of 62
    #[arg(long)]
    narrow: bool,
    /// Compile each kernel by itself before
    #[arg(long)]
    each: bool,
    #[command(flatten)]
    adapter: Adapter,
}

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    match arguments.dim {
        2 => measure::<2>(arguments, &shader::D2),
        _ => measure::<3>(arguments, &shader::D3),
    }
}

fn measure<const D: usize>(arguments: &Arguments, shaders: &Shaders) -> Result<(), Box<dyn Error>>
where
    Dimension<D>: Finish<D>,
{
    let width = if arguments.narrow { Width::Narrow } else { Width::Wide };
    let (open, gpu) = timed(|| arguments.adapter.open());
    let gpu = gpu?;
    let mut kernels = Map::new();
    if arguments.each {
        for shader in shaders.iter() {
            let kernel = Compiler::new(&gpu).on_demand(shader, width);
            kernels.insert(shader.name().to_owned(), json!(microseconds(timed(|| _ = kernel.pipeline()).0)));
        }
    }
    let (needed, phase1) = timed(|| block_on(Phase1::<D>::new(&gpu, width)));
    let phase1 = phase1?;
    let (deferred, compiled) = timed(|| block_on(phase1.finish_compiling(&gpu)));
    compiled?;
    Row::new()
        .with("adapter", gpu.adapter().name.as_str())
        .with("dimension", D)
        .with("width", format!("{width:?}"))
        .with("open_ms", microseconds(open))
        .with("ms", microseconds(needed))
        .with("all_kernels_ms", microseconds(needed + deferred))
        .with("kernels_ms", kernels)
        .print();
    Ok(())
}
