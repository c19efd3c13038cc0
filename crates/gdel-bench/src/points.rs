//! Points for other programs.

use crate::input::{Source, Space};
use clap::Args;
use gdel::internals::dimension::Dimension;
use std::{error::Error, path::PathBuf};

/// Write the points of an input as raw little-endian coordinates in double precision.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    source: Source,
    /// Where to write
    #[arg(short, long)]
    output: PathBuf,
}

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    match arguments.source.dim {
        2 => in_dimension::<2>(arguments),
        _ => in_dimension::<3>(arguments),
    }
}

fn in_dimension<const D: usize>(arguments: &Arguments) -> Result<(), Box<dyn Error>>
where
    Dimension<D>: Space<D>,
{
    for cloud in arguments.source.clouds::<D>() {
        let bytes: Vec<u8> = cloud?.points().iter().flatten().flat_map(f64::to_le_bytes).collect();
        std::fs::write(&arguments.output, bytes)?;
    }
    Ok(())
}
