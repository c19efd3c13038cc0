//! The command `gdel`: its commands, and how they end.
#![forbid(unsafe_code)]

mod adapters;
mod alpha;
mod backend;
mod clip;
mod constrain;
mod contour;
#[cfg(feature = "decimate")]
mod decimate;
mod derive;
mod device_report;
mod dimension;
mod failure;
mod generate;
mod interpolate;
mod locate;
mod progress;
#[cfg(target_os = "linux")]
mod quiet;
mod report;
mod signals;
mod sphere;
mod surface;
mod tiles;
mod tin;
mod transport;
mod tree;
mod triangulate;
mod verify;
mod voronoi;
mod weights;

use clap::{CommandFactory, Parser, Subcommand, error::ErrorKind};
use failure::Failure;
use gdel_io::{files::FileError, printable};
use std::{
    env,
    ffi::OsString,
    io, panic,
    process::{self, ExitCode},
};

/// Exact 3D and 2D Delaunay triangulation of point clouds.
#[derive(Parser)]
#[command(
    name = "gdel",
    version,
    about = "Exact 3D and 2D Delaunay triangulation of point clouds",
    after_help = "Exit codes: 0 done, 1 bad input or output, 2 wrong usage."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Triangulate(triangulate::Arguments),
    Generate(generate::Arguments),
    Verify(verify::Arguments),
    Locate(locate::Arguments),
    Interpolate(interpolate::Arguments),
    Contour(contour::Arguments),
    Voronoi(voronoi::Arguments),
    Transport(transport::Arguments),
    Alpha(alpha::Arguments),
    Surface(surface::Arguments),
    Tin(tin::Arguments),
    Tree(tree::Arguments),
    Adapters(adapters::Arguments),
}

/// Parses the arguments and runs the command.
fn main() -> ExitCode {
    #[cfg(target_os = "linux")]
    quiet::restart();
    let report = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !gdel_io::panics_are_caught() {
            report(info);
        }
    }));
    signals::watch();
    let result = match parse().command {
        Command::Triangulate(arguments) => triangulate::run(&arguments),
        Command::Generate(arguments) => generate::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Locate(arguments) => locate::run(&arguments),
        Command::Interpolate(arguments) => interpolate::run(&arguments),
        Command::Contour(arguments) => contour::run(&arguments),
        Command::Voronoi(arguments) => voronoi::run(&arguments),
        Command::Transport(arguments) => transport::run(&arguments),
        Command::Alpha(arguments) => alpha::run(&arguments),
        Command::Surface(arguments) => surface::run(&arguments),
        Command::Tin(arguments) => tin::run(&arguments),
        Command::Tree(arguments) => tree::run(&arguments),
        Command::Adapters(arguments) => adapters::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // The reader of the output has closed it: `gdel … | head -1` is not a failure.
        Err(Failure::StandardOutput(error)) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(Failure::Usage(kind, what)) => Cli::command().error(kind, what).exit(),
        Err(Failure::File(error @ FileError::NoFormat)) => {
            Cli::command().error(ErrorKind::MissingRequiredArgument, error).exit()
        }
        Err(failure) => {
            eprintln!("gdel: {failure}");
            ExitCode::FAILURE
        }
    }
}

/// Parses the arguments; where they are wrong, the program says so and exits with 2.
fn parse() -> Cli {
    Cli::try_parse().unwrap_or_else(|error| {
        // The message quotes the arguments, which may be names of files that speak to the terminal.
        let is_clean = |argument: OsString| printable(&argument.to_string_lossy()) == argument.to_string_lossy();
        if error.use_stderr() && !env::args_os().all(is_clean) {
            let text = error.to_string();
            eprintln!("{}", text.trim_end().split('\n').map(printable).collect::<Vec<_>>().join("\n"));
            process::exit(error.exit_code());
        }
        error.exit()
    })
}
