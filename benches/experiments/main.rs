//! Repeats the paper's experiments:
//! `cargo bench --features cli --bench experiments -- NAME [OPTIONS]`, `--help` for both.
//!
//! Each prints tables in Markdown, and writes them as JSON and its charts as SVG. To add one: a
//! file with a function from [`Context`] to [`Outcome`], and a line in [`EXPERIMENTS`].

mod charts;
mod context;
mod crossing;
mod figure6;
mod figure7;
mod figure8;
mod figure9;
mod outcome;
mod section54;

use clap::Parser;
use context::Context;
use outcome::Outcome;
use std::{error::Error, path::PathBuf, process::ExitCode};

/// What an experiment is called, shows, and does.
struct Experiment {
    name: &'static str,
    about: &'static str,
    run: fn(&Context) -> Result<Outcome, Box<dyn Error>>,
}

const EXPERIMENTS: &[Experiment] = &[
    Experiment { name: "figure6", about: "time by distribution and size, and of models", run: figure6::run },
    Experiment { name: "figure7", about: "where the time goes", run: figure7::run },
    Experiment { name: "figure8", about: "stars built and pulled by splaying", run: figure8::run },
    Experiment { name: "figure9", about: "InsFlip against InsAll", run: figure9::run },
    Experiment { name: "section5.4", about: "which point to insert", run: section54::run },
    Experiment { name: "crossing", about: "from which size on the GPU pays (not in the paper)", run: crossing::run },
];

/// Repeats the paper's experiments.
#[derive(Parser)]
#[command(after_help = list())]
struct Arguments {
    /// Which experiment, or `all`
    #[arg(value_parser = names())]
    experiment: String,
    /// Sizes of the synthetic inputs, in points
    #[arg(long, value_delimiter = ',')]
    sizes: Option<Vec<usize>>,
    /// Files with the points of models, such as .cache/dragon.ply (scripts/fetch-dragon.sh)
    #[arg(long, value_delimiter = ',', default_value = "tests/data/bunny.ply")]
    models: Vec<PathBuf>,
    /// The GPU: its number in `gdel adapters`, or a part of its name
    #[arg(long)]
    adapter: Option<String>,
    /// Timed runs, of which the median counts, after one that does not
    #[arg(long, default_value_t = 5)]
    repeat: usize,
    /// Seed of the synthetic inputs
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The program of CGAL, as benches/compare.py builds it; left out where it is not there
    #[arg(long, default_value = ".cache/bench/cgal")]
    cgal: PathBuf,
    /// What `cargo bench` adds
    #[arg(long, hide = true)]
    bench: bool,
    /// The folder for JSON and SVG
    #[arg(long, default_value = "target/experiments")]
    output: PathBuf,
}

fn list() -> String {
    let lines = EXPERIMENTS.iter().map(|e| format!("  {:12}{}\n", e.name, e.about));
    format!("Experiments:\n{}", lines.collect::<String>())
}

fn names() -> clap::builder::PossibleValuesParser {
    EXPERIMENTS.iter().map(|e| e.name).chain(["all"]).collect::<Vec<_>>().into()
}

fn main() -> ExitCode {
    match run(Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("experiments: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: Arguments) -> Result<(), Box<dyn Error>> {
    let Arguments { experiment, sizes, models, adapter, repeat, seed, cgal, output, bench: _ } = arguments;
    let context = Context::new(sizes, models, adapter, repeat, seed, cgal)?;
    println!("{}\n", context.setting());
    for chosen in EXPERIMENTS.iter().filter(|e| experiment == "all" || experiment == e.name) {
        let outcome = (chosen.run)(&context)?;
        println!("## {}: {}\n\n{outcome}", chosen.name, chosen.about);
        outcome.write(&output, chosen.name, &context.setting())?;
    }
    Ok(())
}
