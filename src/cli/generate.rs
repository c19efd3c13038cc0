//! `gdel generate`: synthetic point clouds.

use super::{Failure, progress::Progress};
use clap::{Args, builder::PossibleValuesParser, builder::TypedValueParser};
use gdel::{
    generate::{Distribution, generate},
    io::files,
};
use std::path::PathBuf;

/// Write a random point cloud.
#[derive(Args)]
pub(super) struct Arguments {
    /// How the points are distributed
    #[arg(value_parser = distribution())]
    kind: Distribution,
    /// How many points
    #[arg(value_name = "N")]
    count: u32,
    /// The same seed gives the same points
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The file to write: .ply, .obj, .xyz, .csv, .npy, .f32 (rounded) or .f64
    #[arg(short, long = "output", value_name = "FILE")]
    output: PathBuf,
}

fn distribution() -> impl TypedValueParser<Value = Distribution> {
    let names = PossibleValuesParser::new(Distribution::ALL.map(Distribution::name));
    names.try_map(|name| Distribution::ALL.into_iter().find(|d| d.name() == name).ok_or("unknown distribution"))
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let _progress = Progress::new("generating");
    let points = generate(arguments.kind, arguments.count as usize, arguments.seed);
    files::write_points(&arguments.output, (&points).into())?;
    Ok(())
}
