//! The last stages: the files of tiles, and what is across their borders.

use super::{
    Run, TileFormat,
    folder::{Index, KIND, read_error, remove, write_error},
    for_each_tile,
    steps::{core_file, last_file, load},
};
use crate::failure::Failure;
use gdel::{
    internals::{
        cpu::Incremental,
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
    },
    tiles::{Core, Link, Rim, Seam, Tiled},
};
use gdel_io::{Mesh, append_links, files::write_file, write_pvtu, write_tile, write_tile_vtu};
use serde::{Deserialize, Serialize};
use std::{
    fs::{self, File, OpenOptions},
    io::{BufReader, Read, Seek, SeekFrom, Write},
};

/// What is known of a piece that is written.
#[derive(Serialize, Deserialize)]
struct Counts {
    simplices: u64,
    duplicates: u64,
}

fn rim_file(tile: u32) -> String {
    format!("rim-{tile:05}")
}

fn counts_file(tile: u32) -> String {
    format!("counts-{tile:05}.json")
}

/// Writes the pieces of all tiles that have none yet.
pub(super) fn write<M: Mesh<D, N>, const D: usize, const N: usize>(
    run: &Run<D>,
    show: &(dyn Fn(f64) + Sync),
) -> Result<(), Failure>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    for_each_tile(run.state.tiles, run.state.workers, show, |tile| {
        // The counts are written last.
        if run.folder.work(&counts_file(tile)).exists() {
            return Ok(());
        }
        write_one::<M, D, N>(run, tile)
    })
}

fn write_one<M: Mesh<D, N>, const D: usize, const N: usize>(run: &Run<D>, tile: u32) -> Result<(), Failure>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let failure = |source| Failure::Points { path: run.folder.work(""), source };
    let shell = last_file(&run.folder, tile, run.state.steps + 1);
    let piece = read_core::<D, N>(run, tile)?.complete(load(run, &shell)?).map_err(failure)?;
    let format = run.state.order.format;
    write_file(&run.folder.work(&format.file(tile)), |to| match format {
        TileFormat::Npz => write_tile::<M, D, N>(to, &piece),
        TileFormat::Vtu => write_tile_vtu::<M, D, N>(to, &piece),
    })?;
    run.folder.write(&rim_file(tile), &piece.rim().to_bytes())?;
    let (simplices, duplicates) = (piece.part.simplices.len() as u64, piece.part.duplicates.len() as u64);
    run.folder.write_json(&run.folder.work(&counts_file(tile)), &Counts { simplices, duplicates })?;
    remove(&run.folder.work(&core_file(tile)))?;
    remove(&run.folder.work(&shell))
}

fn read_core<const D: usize, const N: usize>(run: &Run<D>, tile: u32) -> Result<Core<D, N>, Failure>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let path = run.folder.work(&core_file(tile));
    let file = File::open(&path).map_err(read_error(&path))?;
    let size = file.metadata().map_err(read_error(&path))?.len();
    let core = Core::read(&mut BufReader::with_capacity(1 << 20, file), size).map_err(read_error(&path))?;
    core.map_err(|error| run.folder.damaged(&core_file(tile), error))
}

/// Links the pieces, and gives their files their names.
pub(super) fn link<const D: usize>(run: &Run<D>, show: &(dyn Fn(f64) + Sync)) -> Result<Index, Failure>
where
    Dimension<D>: Incremental<D>,
{
    let (folder, state) = (&run.folder, &run.state);
    let mut links: Vec<Vec<Link>> = vec![Vec::new(); state.tiles as usize];
    let mut seam = Seam::default();
    for tile in 0..state.tiles {
        let name = rim_file(tile);
        let rim = Rim::<D>::from_bytes(&folder.read(&name)?).map_err(|error| folder.damaged(&name, error))?;
        for (from, link) in seam.add_rim(tile, &rim) {
            links[from as usize].push(link);
        }
        show(0.5 * f64::from(tile + 1) / f64::from(state.tiles));
    }
    if !seam.is_closed() {
        return Err(folder.damaged("", "pieces do not fit together"));
    }
    let mut index = Index {
        gdel: KIND.into(),
        dim: D as u8,
        dimension: run.plan.dimension(),
        points: state.points,
        duplicates: 0,
        simplices: 0,
        tiles: Vec::new(),
    };
    for (tile, mut links) in (0..).zip(links) {
        let name = state.order.format.file(tile);
        let (unfinished, finished) = (folder.work(&name), folder.finished(&name));
        if !finished.exists() {
            if state.order.format == TileFormat::Npz {
                links.sort_unstable_by_key(|link| link.place);
                append(run, tile, &links)?;
            }
            fs::rename(&unfinished, &finished).map_err(write_error(&finished))?;
        }
        let path = folder.work(&counts_file(tile));
        let counts: Counts = folder.read_json(&path)?.ok_or_else(|| folder.damaged(&counts_file(tile), "no counts"))?;
        index.simplices += counts.simplices;
        index.duplicates += counts.duplicates;
        index.tiles.push(name);
        show(0.5 + 0.5 * f64::from(tile + 1) / f64::from(state.tiles));
    }
    if state.order.format == TileFormat::Vtu {
        write_file(&folder.finished("mesh.pvtu"), |to| write_pvtu(to, &index.tiles))?;
    }
    Ok(index)
}

/// Appends its links to the file of a tile, of which the end is kept for a run that is interrupted meanwhile.
fn append<const D: usize>(run: &Run<D>, tile: u32, links: &[Link]) -> Result<(), Failure> {
    /// The directory of the archive is in so many bytes at its end, and begins where links are written.
    const END: u64 = 1 << 16;
    let path = run.folder.work(&run.state.order.format.file(tile));
    let mut file = OpenOptions::new().read(true).write(true).open(&path).map_err(read_error(&path))?;
    let kept = format!("end-{tile:05}");
    if run.folder.work(&kept).exists() {
        let bytes = run.folder.read(&kept)?;
        let (start, end) = bytes.split_first_chunk().ok_or_else(|| run.folder.damaged(&kept, "too short"))?;
        let start = u64::from_le_bytes(*start);
        let restored = file.set_len(start + end.len() as u64).and_then(|()| file.seek(SeekFrom::Start(start)));
        restored.and_then(|_| file.write_all(end)).map_err(write_error(&path))?;
    } else {
        let mut bytes = Vec::new();
        let start = file.metadata().map_err(read_error(&path))?.len().saturating_sub(END);
        bytes.extend(start.to_le_bytes());
        let found = file.seek(SeekFrom::Start(start)).and_then(|_| file.read_to_end(&mut bytes));
        found.map_err(read_error(&path))?;
        run.folder.write(&kept, &bytes)?;
    }
    append_links(&file, links).map_err(write_error(&path))
}
