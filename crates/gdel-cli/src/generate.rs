//! `gdel generate`: random point clouds.

use super::{dimension::Dimension, failure::Failure, progress::Progress};
use clap::{Args, builder::PossibleValuesParser, error::ErrorKind};
use gdel::internals::{
    d2::generate::{Distribution2, generate2d},
    d3::generate::{Distribution3, generate3d},
};
use gdel_io::files::PointOutput;
use std::path::PathBuf;

/// Write a random point cloud.
#[derive(Args)]
pub(super) struct Arguments {
    /// How the points are distributed
    #[arg(value_parser = names())]
    kind: String,
    /// How many points
    #[arg(value_name = "N")]
    count: u32,
    /// The dimension of the points; 2D points have two columns in text, CSV, NumPy and .node files,
    /// else z = 0
    #[arg(long, value_enum, default_value_t = Dimension::Three)]
    dim: Dimension,
    /// The same seed gives the same points
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The file to write: .ply, .obj, .xyz, .csv, .npy, .node, .f32 (rounded to single precision)
    /// or .f64
    #[arg(short, long = "output", value_name = "FILE")]
    output: PathBuf,
    /// Replace the file if it exists
    #[arg(short, long)]
    force: bool,
}

/// Returns the names of the distributions of both dimensions, each once.
fn names() -> PossibleValuesParser {
    let mut names = Distribution3::ALL.map(Distribution3::name).to_vec();
    names.extend(
        Distribution2::ALL
            .map(Distribution2::name)
            .iter()
            .filter(|&name| !names.contains(name))
            .copied()
            .collect::<Vec<_>>(),
    );
    PossibleValuesParser::new(names)
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let output = PointOutput::new(&arguments.output)?;
    output.check(arguments.force)?;
    let _progress = Progress::new("generating");
    let (name, count, seed) = (&arguments.kind, arguments.count as usize, arguments.seed);
    match arguments.dim {
        Dimension::Three => match Distribution3::ALL.into_iter().find(|d| d.name() == name) {
            Some(distribution) => output.write((&generate3d(distribution, count, seed)).into())?,
            None => {
                let what = format!("{name} is a distribution in 2D: add --dim 2");
                return Err(Failure::Usage(ErrorKind::InvalidValue, what));
            }
        },
        Dimension::Two => match Distribution2::ALL.into_iter().find(|d| d.name() == name) {
            Some(distribution) => output.write((&generate2d(distribution, count, seed)).into())?,
            None => {
                let known = Distribution2::ALL.map(Distribution2::name).join(", ");
                let what = format!("{name} is a distribution in 3D; those in 2D are {known}");
                return Err(Failure::Usage(ErrorKind::InvalidValue, what));
            }
        },
    }
    Ok(())
}
