//! The steps of tiles, of which a few are in memory.

use super::{
    Run, State,
    folder::{Folder, remove},
    for_each_tile,
};
use crate::failure::Failure;
use gdel::{
    Error,
    internals::{
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
    },
    tiles::{Tile, Tiled},
};
use gdel_io::files::write_file;
use std::sync::Arc;

/// Returns the name of the file of a tile after a step.
pub(super) fn tile_file(tile: u32, step: u32) -> String {
    format!("tile-{tile:05}-{step:03}")
}

/// Returns the name of the file with the core of a tile.
pub(super) fn core_file(tile: u32) -> String {
    format!("core-{tile:05}")
}

/// Returns the name of the file with what a tile has sent in a step.
pub(super) fn outbox(tile: u32, step: u32) -> String {
    format!("sent-{tile:05}-{step:03}")
}

/// Returns the name of the file of a tile after its last step before `step`.
pub(super) fn last_file(folder: &Folder, tile: u32, step: u32) -> String {
    let mut names = (0..step).rev().map(|step| tile_file(tile, step));
    names.find(|name| folder.work(name).exists()).unwrap_or_else(|| tile_file(tile, 0))
}

/// Reads a tile.
pub(super) fn load<const D: usize, const N: usize>(run: &Run<D>, name: &str) -> Result<Tile<D, N>, Failure>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let bytes = run.folder.read(name)?;
    let tile = Tile::with_options_from_bytes(Arc::clone(&run.plan), &bytes, run.options.clone());
    tile.map_err(|error| run.folder.damaged(name, error))
}

/// Takes all steps that are left.
pub(super) fn take<const D: usize, const N: usize>(run: &mut Run<D>, show: &(dyn Fn(f64) + Sync)) -> Result<(), Failure>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    while !run.state.is_quiet {
        let step = run.state.steps + 1;
        // All is triangulated in the second step, and little in later ones, of which nobody knows the number.
        let (before, share) = match step {
            1 => (0.0, 0.1),
            2 => (0.1, 0.6),
            _ => (1.0 - 0.3 * 0.5f64.powi(step as i32 - 3), 0.15 * 0.5f64.powi(step as i32 - 3)),
        };
        let State { tiles, workers, .. } = run.state;
        for_each_tile(tiles, workers, &|fraction| show(before + share * fraction), |tile| {
            if run.folder.work(&outbox(tile, step)).exists() {
                return Ok(());
            }
            take_one::<D, N>(run, tile, step)
        })?;
        let mut is_quiet = step > 1;
        for tile in 0..tiles {
            let places = run.folder.receivers(&outbox(tile, step))?;
            is_quiet &= places.is_empty();
            run.state.sent += places.iter().map(|place| place.points).sum::<u64>();
        }
        (run.state.steps, run.state.is_quiet) = (step, is_quiet);
        run.save()?;
        (0..tiles).try_for_each(|tile| remove(&run.folder.work(&outbox(tile, step - 1))))?;
    }
    Ok(())
}

/// Takes a step of one tile.
fn take_one<const D: usize, const N: usize>(run: &Run<D>, tile: u32, step: u32) -> Result<(), Failure>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let folder = &run.folder;
    let mut received = Vec::new();
    for from in 0..run.state.tiles {
        let name = outbox(from, step - 1);
        for place in folder.receivers(&name)?.into_iter().filter(|place| place.to == u64::from(tile)) {
            received.push((from, folder.receive(&name, place)?));
        }
    }
    // A tile that receives nothing stays as it is.
    if step > 2 && received.is_empty() {
        return folder.send::<D>(&outbox(tile, step), &[]);
    }
    let name = last_file(folder, tile, step);
    let mut whole = load::<D, N>(run, &name)?;
    let failure = |error| match error {
        Error::BadMessage { .. } => folder.damaged(&name, error),
        source => Failure::Points { path: folder.work(""), source },
    };
    // Most of the work is in the second step.
    let sent = match run.devices.of(tile).filter(|_| step == 2) {
        Some(triangulator) => {
            let sent = whole.step_on(triangulator, received).map_err(failure)?;
            run.devices.note(whole.stats());
            sent
        }
        None => whole.step(received).map_err(failure)?,
    };
    // What no other tile can change is not needed for further steps.
    if step == 2 {
        let core = whole.take_core().map_err(failure)?;
        write_file(&folder.work(&core_file(tile)), |to| core.write(to))?;
    }
    whole.suspend();
    folder.write(&tile_file(tile, step), &whole.to_bytes())?;
    folder.send(&outbox(tile, step), &sent)?;
    remove(&folder.work(&name))
}
