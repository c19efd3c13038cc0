//! `gdel generate`: synthetic point clouds.

use super::{Failure, dimension::Dimension, progress::Progress};
use clap::{Args, CommandFactory, builder::PossibleValuesParser, error::ErrorKind};
use gdel::internals::{
    d2::generate::{Distribution2, generate2d},
    d3::generate::{Distribution, generate},
    io::files,
};
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
    /// Points of space, or of the plane with z = 0
    #[arg(long, value_enum, default_value_t = Dimension::Three)]
    dim: Dimension,
    /// The same seed gives the same points
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The file to write: .ply, .obj, .xyz, .csv, .npy, .f32 (rounded) or .f64
    #[arg(short, long = "output", value_name = "FILE")]
    output: PathBuf,
}

/// Those of both dimensions, each once.
fn names() -> PossibleValuesParser {
    let mut names = Distribution::ALL.map(Distribution::name).to_vec();
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
    let _progress = Progress::new("generating");
    let (name, count, seed) = (&arguments.kind, arguments.count as usize, arguments.seed);
    let points = match arguments.dim {
        Dimension::Three => Distribution::ALL.into_iter().find(|d| d.name() == name).map(|d| generate(d, count, seed)),
        Dimension::Two => Distribution2::ALL
            .into_iter()
            .find(|d| d.name() == name)
            .map(|d| generate2d(d, count, seed).into_iter().map(|[x, y]| [x, y, 0.0]).collect()),
    };
    let Some(points) = points else {
        let what = match arguments.dim {
            Dimension::Three => format!("{name} is a distribution in the plane: add --dim 2"),
            Dimension::Two => format!("{name} is no distribution in the plane"),
        };
        super::Cli::command().error(ErrorKind::InvalidValue, what).exit()
    };
    files::write_points(&arguments.output, (&points).into())?;
    Ok(())
}
