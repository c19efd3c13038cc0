//! Tiles, for schedulers: everything that goes from one task to another is bytes, and no task changes what it gets.

use crate::{
    arrays::{self, Input},
    errors::exception,
};
use gdel::{
    Error,
    internals::{
        Options,
        cpu::Incremental,
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
    },
    tiles::{Core, Link, Message, Piece, Plan, Rim, Seam, Survey, Tile, Tiled},
};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::{exceptions::PyValueError, prelude::*, types::PyBytes, types::PyDict};
use std::{num::NonZeroUsize, sync::Arc};

type Bytes<'py> = Bound<'py, PyBytes>;

/// Calls a function for the dimension of points, or of what bytes hold.
macro_rules! by_dimension {
    ($dimension:expr, $function:ident($($argument:expr),*)) => {
        match $dimension {
            2 => $function::<2, 3>($($argument),*),
            3 => $function::<3, 4>($($argument),*),
            other => Err(PyValueError::new_err(format!("points must have 2 or 3 coordinates, not {other}"))),
        }
    };
}

/// Surveys points, of which the first has the index `first` in the whole input.
#[pyfunction]
pub(crate) fn tiles_survey<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    first: u32,
    every: u32,
) -> PyResult<Bytes<'py>> {
    fn survey<const D: usize, const N: usize>(
        py: Python<'_>,
        input: &Input<'_>,
        first: u32,
        every: u32,
    ) -> PyResult<Vec<u8>>
    where
        Dimension<D>: Incremental<D>,
    {
        let points = input.points::<D>()?;
        let bytes = py.detach(|| Ok(Survey::new(points, first, every)?.to_bytes()));
        bytes.map_err(exception)
    }
    let input = Input::new(points)?;
    let bytes = by_dimension!(input.dimension(), survey(py, &input, first, every))?;
    Ok(PyBytes::new(py, &bytes))
}

/// Plans tiles by the surveys of all points. Returns the plan and the affine dimension of the points.
#[pyfunction]
pub(crate) fn tiles_plan<'py>(
    py: Python<'py>,
    surveys: Vec<Vec<u8>>,
    dimension: usize,
    tiles: u32,
) -> PyResult<(Bytes<'py>, u8)> {
    fn plan<const D: usize, const N: usize>(surveys: &[Vec<u8>], tiles: u32) -> PyResult<(Vec<u8>, u8)>
    where
        Dimension<D>: Incremental<D>,
    {
        let mut surveys = surveys.iter().map(|bytes| Survey::<D>::from_bytes(bytes));
        let none = Err(Error::BadMessage { reason: "there is no survey" });
        let mut all = surveys.next().unwrap_or(none).map_err(exception)?;
        for survey in surveys {
            all.merge(survey.map_err(exception)?);
        }
        let plan = Plan::new(all, tiles);
        Ok((plan.to_bytes(), plan.dimension()))
    }
    let (plan, affine) = by_dimension!(dimension, plan(&surveys, tiles))?;
    Ok((PyBytes::new(py, &plan), affine))
}

/// Splits points: returns for each tile its points and their indices.
#[pyfunction]
pub(crate) fn tiles_split<'py>(
    py: Python<'py>,
    plan: &[u8],
    points: &Bound<'py, PyAny>,
    first: u32,
) -> PyResult<Vec<(Bound<'py, PyAny>, Bound<'py, PyAny>)>> {
    fn split<'py, const D: usize, const N: usize>(
        py: Python<'py>,
        plan: &[u8],
        input: &Input<'_>,
        first: u32,
    ) -> PyResult<Vec<(Bound<'py, PyAny>, Bound<'py, PyAny>)>>
    where
        Dimension<D>: Incremental<D>,
    {
        let plan = Plan::<D>::from_bytes(plan).map_err(exception)?;
        let points = input.points::<D>()?;
        let parts = py.detach(|| plan.split(points, first));
        let arrays = |(points, indices): (Vec<[f64; D]>, Vec<u32>)| {
            Ok((arrays::rows(py, points)?.into_any(), indices.into_pyarray(py).into_any()))
        };
        parts.into_iter().map(arrays).collect()
    }
    let input = Input::new(points)?;
    by_dimension!(input.dimension(), split(py, plan, &input, first))
}

/// Creates a tile of its points and their indices, which ascend.
#[pyfunction]
pub(crate) fn tiles_begin<'py>(
    py: Python<'py>,
    plan: &[u8],
    number: u32,
    points: &Bound<'py, PyAny>,
    indices: PyReadonlyArray1<'py, u32>,
) -> PyResult<Bytes<'py>> {
    fn begin<const D: usize, const N: usize>(
        py: Python<'_>,
        plan: &[u8],
        number: u32,
        input: &Input<'_>,
        indices: Vec<u32>,
    ) -> PyResult<Vec<u8>>
    where
        Dimension<D>: Tiled<D, N>,
        Euclidean: Geometry<D, N>,
    {
        let points = input.points::<D>()?;
        let bytes = py.detach(|| {
            let tile = Tile::<D, N>::new(Plan::from_bytes(plan)?, number, points.iter().collect(), indices)?;
            Ok(tile.to_bytes())
        });
        bytes.map_err(exception)
    }
    let input = Input::new(points)?;
    let indices = indices.as_slice()?.to_vec();
    let bytes = by_dimension!(input.dimension(), begin(py, plan, number, &input, indices))?;
    Ok(PyBytes::new(py, &bytes))
}

/// What a step makes of a tile: the tile, messages with the numbers of their receivers, and after the second step the core.
type Stepped = (Vec<u8>, Vec<(u32, Vec<u8>)>, Option<Vec<u8>>);

/// The same, for Python.
type Taken<'py> = (Bytes<'py>, Vec<(u32, Bytes<'py>)>, Option<Bytes<'py>>);

/// Takes a step of a tile, which is its `step`-th, with messages and the numbers of their senders.
#[pyfunction]
pub(crate) fn tiles_step<'py>(
    py: Python<'py>,
    plan: &[u8],
    tile: &[u8],
    received: Vec<(u32, Vec<u8>)>,
    step: u32,
    threads: Option<usize>,
) -> PyResult<Taken<'py>> {
    fn take<const D: usize, const N: usize>(
        plan: &[u8],
        tile: &[u8],
        received: Vec<(u32, Vec<u8>)>,
        step: u32,
        options: Options,
    ) -> Result<Stepped, Error>
    where
        Dimension<D>: Tiled<D, N>,
        Euclidean: Geometry<D, N>,
    {
        let mut tile = Tile::<D, N>::with_options_from_bytes(Arc::new(Plan::from_bytes(plan)?), tile, options)?;
        let messages = received.iter().map(|(from, bytes)| Ok((*from, Message::from_bytes(bytes)?)));
        let sent = tile.step(messages.collect::<Result<_, Error>>()?)?;
        // What no other tile can change is not needed for further steps.
        let core = if step == 2 { Some(in_memory(&tile.take_core()?)) } else { None };
        tile.suspend();
        Ok((tile.to_bytes(), sent.into_iter().map(|(to, message)| (to, message.to_bytes())).collect(), core))
    }
    let options = Options { threads: threads.and_then(NonZeroUsize::new), ..Options::default() };
    let taken = py.detach(|| match dimension_of(plan) {
        2 => take::<2, 3>(plan, tile, received, step, options),
        _ => take::<3, 4>(plan, tile, received, step, options),
    });
    let (tile, sent, core) = taken.map_err(exception)?;
    let bytes = |bytes: &Vec<u8>| PyBytes::new(py, bytes);
    Ok((bytes(&tile), sent.iter().map(|(to, message)| (*to, bytes(message))).collect(), core.as_ref().map(bytes)))
}

/// Returns the dimension that bytes are of.
fn dimension_of(bytes: &[u8]) -> usize {
    bytes.get(4).copied().unwrap_or(0).into()
}

fn in_memory<const D: usize, const N: usize>(core: &Core<D, N>) -> Vec<u8>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let mut bytes = Vec::new();
    core.write(&mut bytes).unwrap_or_else(|error| unreachable!("memory takes all: {error}"));
    bytes
}

/// Returns the piece of a tile after all steps, as a dictionary of the arrays of its file; and its rim.
#[pyfunction]
pub(crate) fn tiles_piece<'py>(
    py: Python<'py>,
    plan: &[u8],
    tile: &[u8],
    core: &[u8],
    threads: Option<usize>,
) -> PyResult<(Bound<'py, PyDict>, Bytes<'py>)> {
    fn piece<'py, const D: usize, const N: usize>(
        py: Python<'py>,
        [plan, tile, mut core]: [&[u8]; 3],
        options: Options,
    ) -> PyResult<(Bound<'py, PyDict>, Bytes<'py>)>
    where
        Dimension<D>: Tiled<D, N>,
        Euclidean: Geometry<D, N>,
    {
        let complete = || -> Result<Piece<D, N>, Error> {
            let tile = Tile::with_options_from_bytes(Arc::new(Plan::from_bytes(plan)?), tile, options)?;
            let size = core.len() as u64;
            let broken = Error::BadMessage { reason: "a core cannot be read" };
            Core::read(&mut core, size).unwrap_or(Err(broken))?.complete(tile)
        };
        let piece = py.detach(complete).map_err(exception)?;
        let rim = PyBytes::new(py, &piece.rim().to_bytes());
        let Piece { points, indices, owners, part, .. } = piece;
        let result = PyDict::new(py);
        let names = if D == 2 { ["triangles", "halfedges"] } else { ["tetrahedra", "neighbors"] };
        result.set_item("points", arrays::rows(py, points)?)?;
        result.set_item("indices", indices.into_pyarray(py))?;
        result.set_item("tiles", owners.into_pyarray(py))?;
        result.set_item(names[0], arrays::rows(py, part.simplices)?)?;
        result.set_item(names[1], arrays::index_rows(py, part.neighbors)?)?;
        result.set_item("duplicates", arrays::rows(py, part.duplicates)?)?;
        Ok((result, rim))
    }
    let options = Options { threads: threads.and_then(NonZeroUsize::new), ..Options::default() };
    by_dimension!(dimension_of(plan), piece(py, [plan, tile, core], options))
}

/// Returns the links of all pieces, given their rims: for each an array of places, tiles and neighbours there.
#[pyfunction]
pub(crate) fn tiles_links(py: Python<'_>, rims: Vec<Vec<u8>>) -> PyResult<Vec<Bound<'_, PyAny>>> {
    fn links<const D: usize>(rims: &[Vec<u8>]) -> Result<Vec<Vec<Link>>, Error> {
        let mut seam = Seam::default();
        let mut links = vec![Vec::new(); rims.len()];
        for (tile, rim) in (0..).zip(rims) {
            for (from, link) in seam.add_rim(tile, &Rim::<D>::from_bytes(rim)?) {
                links[from as usize].push(link);
            }
        }
        links.iter_mut().for_each(|links: &mut Vec<Link>| links.sort_unstable_by_key(|link| link.place));
        if seam.is_closed() { Ok(links) } else { Err(Error::BrokenMesh { reason: "a piece of it is missing" }) }
    }
    let found = py.detach(|| match rims.first().map(|rim| dimension_of(rim)) {
        Some(2) => links::<2>(&rims),
        _ => links::<3>(&rims),
    });
    let rows = |links: Vec<Link>| links.iter().map(|link| [link.place, link.tile, link.entry]).collect();
    let array = |links: Vec<Link>| Ok(arrays::rows::<u32, 3>(py, rows(links))?.into_any());
    found.map_err(exception)?.into_iter().map(array).collect()
}
