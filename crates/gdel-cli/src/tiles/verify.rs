//! The proof that a mesh in tiles is a Delaunay triangulation, with a few tiles in memory at a time.

use super::{
    folder::{Folder, read_error},
    for_each_tile, workers,
};
use crate::{failure::Failure, progress::Progress};
use gdel::{
    internals::{
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
    },
    tiles::{Link, Piece, Proof, Provable},
    verify::Report,
};
use gdel_io::{Mesh, files::FileError, read_tile, read_tile_vtu};
use std::{
    fs::{self, File},
    io::BufReader,
    path::Path,
    thread,
};

/// Proves the mesh in a folder.
pub(crate) fn prove<M: Mesh<D, N>, const D: usize, const N: usize>(path: &Path) -> Result<Report, Failure>
where
    Dimension<D>: Provable<D, N>,
    Euclidean: Geometry<D, N>,
{
    let (folder, index) = Folder::open(path)?;
    if usize::from(index.dim) != D {
        let what = format!("this mesh is of dimension {0}: add `--dim {0}`", index.dim);
        return Err(Failure::Folder { path: path.into(), what });
    }
    let progress = Progress::new("verifying");
    let show = progress.reporter();
    let proof = Proof::default();
    let (tiles, workers) = (index.tiles.len() as u32, workers(thread::available_parallelism().ok()));
    for_each_tile(tiles, workers, &|fraction| show("verifying", fraction), |tile| {
        let path = folder.finished(&index.tiles[tile as usize]);
        let (piece, links) = read::<M, D, N>(&path)?;
        let added = proof.add(tile, &piece, links.as_deref());
        added.map_err(|source| Failure::Points { path, source })
    })?;
    let report = proof.finish();
    if report.passed() && report.counts.points as u64 != index.points {
        let what = format!("the tiles have {} points, not {}", report.counts.points, index.points);
        return Err(Failure::Mesh { path: path.into(), what });
    }
    Ok(report)
}

/// Reads the file of a tile, and its links if the format has any.
fn read<M: Mesh<D, N>, const D: usize, const N: usize>(
    path: &Path,
) -> Result<(Piece<D, N>, Option<Vec<Link>>), Failure> {
    let in_file = |source| FileError::Format { path: path.into(), source };
    if path.extension().is_some_and(|extension| extension == "vtu") {
        return Ok((read_tile_vtu::<M, D, N>(&fs::read(path).map_err(read_error(path))?).map_err(in_file)?, None));
    }
    let (piece, links) =
        read_tile::<M, D, N>(File::open(path).map(BufReader::new).map_err(read_error(path))?).map_err(in_file)?;
    Ok((piece, Some(links)))
}
