//! Measures gdel. Each command prints a line of JSON per measurement, which says what was measured, on what, and
//! when: `benches/results/` keeps such lines, and `scripts/benchmarks.mjs` makes `BENCHMARKS.md` of them.
//!
//! A device that was idle raises its clock during the first second of work, so commands that use one warm it up.

mod answers;
mod input;
mod moved;
mod phase1;
mod pipelines;
mod points;
mod queries;
mod row;
mod run;
mod surface;
mod tiles;

use clap::Parser;
use std::{error::Error, process::ExitCode};

/// Measure gdel: a line of JSON for each measurement.
#[derive(Parser)]
#[command(max_term_width = 100)]
enum Command {
    Run(run::Arguments),
    Moved(moved::Arguments),
    Phase1(phase1::Arguments),
    Pipelines(pipelines::Arguments),
    Queries(queries::Arguments),
    Answers(answers::Arguments),
    Points(points::Arguments),
    Surface(surface::Arguments),
    Tiles(tiles::Arguments),
}

fn main() -> ExitCode {
    let measured: Result<(), Box<dyn Error>> = match Command::parse() {
        Command::Run(arguments) => run::run(&arguments),
        Command::Moved(arguments) => moved::run(&arguments),
        Command::Phase1(arguments) => phase1::run(&arguments),
        Command::Pipelines(arguments) => pipelines::run(&arguments),
        Command::Queries(arguments) => queries::run(&arguments),
        Command::Answers(arguments) => answers::run(&arguments),
        Command::Points(arguments) => points::run(&arguments),
        Command::Surface(arguments) => surface::run(&arguments),
        Command::Tiles(arguments) => tiles::run(&arguments),
    };
    match measured {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("gdel-bench: {error}");
            ExitCode::FAILURE
        }
    }
}
