//! The command line: what can be asked for, and how it ends.

#[cfg(feature = "gpu")]
mod adapters;
mod dimension;
mod generate;
mod progress;
mod report;
mod triangulate;
mod verify;

use clap::{Parser, Subcommand};
use gdel::internals::io::files::FileError;
use std::{io, panic, path::PathBuf, process::ExitCode};

/// Exact 3D and 2D Delaunay triangulation of point clouds.
#[derive(Parser)]
#[command(version, about, after_help = "Exit codes: 0 done, 1 bad input or output, 2 wrong usage.")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Triangulate(triangulate::Arguments),
    Generate(generate::Arguments),
    Verify(verify::Arguments),
    /// List the graphics devices of this machine
    #[cfg(feature = "gpu")]
    Adapters,
}

/// Why a command failed. The text is one line.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{}: {source}", path.display())]
    Points { path: PathBuf, source: gdel::Error },
    #[error("{}: not the Delaunay triangulation: {what}", path.display())]
    Mesh { path: PathBuf, what: String },
    #[error("standard output: {0}")]
    StandardOutput(#[from] io::Error),
}

/// Parses the arguments (clap exits with 2 when they are wrong) and runs the command.
pub(crate) fn main() -> ExitCode {
    let report = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !gdel::internals::io::panics_are_caught() {
            report(info);
        }
    }));
    let result = match Cli::parse().command {
        Command::Triangulate(arguments) => triangulate::run(&arguments),
        Command::Generate(arguments) => generate::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        #[cfg(feature = "gpu")]
        Command::Adapters => adapters::run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // Whoever read our output has seen enough: `gdel … | head -1` is no failure.
        Err(Failure::StandardOutput(error)) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("gdel: {failure}");
            ExitCode::FAILURE
        }
    }
}
