//! The first stages: what has to be known of all points, and which tile each belongs to.

use super::{
    Order, Run,
    folder::{read_error, remove, write_error},
    steps::{outbox, tile_file},
};
use crate::failure::Failure;
use gdel::{
    Error, Points,
    internals::{
        cpu::Incremental,
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
    },
    tiles::{Survey, Tile, Tiled},
};
use gdel_io::{PointBuf, files::Input};
use std::{
    fs::{self, OpenOptions},
    io::Write,
    sync::Arc,
};

/// So many points are read at a time.
const PIECE: usize = 1 << 21;

/// Bytes of memory per point of a tile while it is triangulated.
const PER_POINT: u64 = 500;

/// Of at least so many points one is known to all tiles, …
const EVERY: u64 = 1000;
/// … and about so many points are, if there are as many.
const COMMON: u64 = 256;

/// Returns the number of tiles for so many points and so much memory.
pub(super) fn tiles(points: u64, memory: u64) -> u32 {
    points.saturating_mul(PER_POINT).div_ceil(memory.max(1)).clamp(1, 1 << 16) as u32
}

/// Surveys the points of all inputs. Returns how many there are, too.
pub(super) fn survey<const D: usize>(
    inputs: &[Input],
    order: &Order,
    show: &(dyn Fn(f64) + Sync),
) -> Result<(Survey<D>, u64), Failure>
where
    Dimension<D>: Incremental<D>,
{
    // The number of points is not known yet, but most formats have 12 bytes or more for each.
    let size: u64 = order.inputs.iter().map(|(_, size, _)| size).sum();
    let every = (size / 12 / COMMON).clamp(1, EVERY) as u32;
    let mut survey: Option<Survey<D>> = None;
    let points = read_all::<D>(inputs, show, size / 12, |points, first, shift| {
        let more = Survey::new(points, first, every).map_err(|error| moved(error, shift));
        match (&mut survey, more) {
            (_, Err(error)) => return Err(error),
            (Some(survey), Ok(more)) => survey.merge(more),
            (none, Ok(more)) => *none = Some(more),
        }
        Ok(Ok(()))
    })?;
    let none = Survey::new(Points::F64(&[]), 0, 1).map_err(|source| points_failure(&inputs[0], source))?;
    Ok((survey.unwrap_or(none), points))
}

/// Reads the points of all inputs, and hands pieces to `take`, each with the index of its first point and the number of
/// points in earlier files. Returns the number of points.
fn read_all<const D: usize>(
    inputs: &[Input],
    show: &(dyn Fn(f64) + Sync),
    expected: u64,
    mut take: impl FnMut(Points<'_, D>, u32, usize) -> Result<Result<(), Failure>, Error>,
) -> Result<u64, Failure> {
    let mut count: u64 = 0;
    for input in inputs {
        let before = count;
        input.read_in_pieces::<D, Failure>(PIECE, &mut |points: PointBuf<D>| {
            let end = count + points.len() as u64;
            if end > u64::from(u32::MAX) - 1 {
                let (points, limit) = (end as usize, u32::MAX as usize - 1);
                return Err(points_failure(input, Error::TooManyPoints { points, limit }));
            }
            let taken = take(Points::from(&points), count as u32, before as usize);
            taken.map_err(|source| points_failure(input, source))??;
            count = end;
            show((count as f64 / expected.max(count) as f64).min(1.0));
            Ok(())
        })?;
    }
    Ok(count)
}

fn points_failure(input: &Input, source: Error) -> Failure {
    Failure::Points { path: input.path().into(), source }
}

/// Counts the points of an error from the beginning of their file.
fn moved(error: Error, before: usize) -> Error {
    match error {
        Error::NotFinite { index, axis, value } => Error::NotFinite { index: index - before, axis, value },
        error => error,
    }
}

/// Splits the points of all inputs, and writes the tiles.
pub(super) fn split<const D: usize, const N: usize>(
    run: &Run<D>,
    inputs: &[Input],
    show: &(dyn Fn(f64) + Sync),
) -> Result<(), Failure>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let own = |tile: u32| run.folder.work(&format!("own-{tile:05}"));
    let row = 4 + 8 * D;
    read_all::<D>(inputs, &|fraction| show(0.7 * fraction), run.state.points, |points, first, _| {
        let parts = (0..).zip(run.plan.split(points, first));
        let append = |(tile, (points, indices)): (u32, (Vec<[f64; D]>, Vec<u32>))| {
            let mut bytes = Vec::with_capacity(row * points.len());
            for (p, index) in points.iter().zip(&indices) {
                bytes.extend(index.to_le_bytes());
                p.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            }
            let path = own(tile);
            let file = OpenOptions::new().create(true).append(true).open(&path);
            file.and_then(|mut file| file.write_all(&bytes)).map_err(write_error(&path))
        };
        Ok(parts.filter(|(_, (points, _))| !points.is_empty()).try_for_each(append))
    })?;
    for tile in 0..run.state.tiles {
        let path = own(tile);
        let bytes = if path.exists() { fs::read(&path).map_err(read_error(&path))? } else { Vec::new() };
        let number = |row: &[u8], at: usize| f64::from_le_bytes(*row[at..].first_chunk().unwrap_or(&[0; 8]));
        let rows = || bytes.chunks_exact(row);
        let points = rows().map(|row| std::array::from_fn(|k| number(row, 4 + 8 * k))).collect();
        let indices = rows().map(|row| u32::from_le_bytes(*row.first_chunk().unwrap_or(&[0; 4]))).collect();
        drop(bytes);
        let name = tile_file(tile, 0);
        let bad = |error| run.folder.damaged(&name, error);
        let whole = Tile::<D, N>::with_options(Arc::clone(&run.plan), tile, points, indices, run.options.clone());
        run.folder.write(&name, &whole.map_err(bad)?.to_bytes())?;
        run.folder.send::<D>(&outbox(tile, 0), &[])?;
        remove(&path)?;
        show(0.7 + 0.3 * f64::from(tile + 1) / f64::from(run.state.tiles));
    }
    Ok(())
}
