//! Answers for many queries.

use crate::{
    arrays::{self, Input, PyCsr},
    compute,
    core::{Core, Data, Derives},
    mesh::check_values,
};
use gdel::{
    Csr, Duplicates, Error, Interpolation, Interpolator, Locator, NONE, Outside, Points, internals::geometry::Euclidean,
};
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::{exceptions::PyValueError, prelude::*};

/// Returns the simplex that contains each query.
pub(crate) fn locate<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    queries: &Input<'_>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyArray1<i32>>>
where
    Euclidean: Derives<D, N>,
{
    indices(data, py, (input, queries), threads, |locator, queries| {
        let places = locator.locate_many(queries)?;
        Ok(places.into_iter().map(|place| place.simplex().map_or(NONE, |t| t as u32)).collect())
    })
}

/// Returns the vertex nearest to each query.
pub(crate) fn nearest<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    queries: &Input<'_>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyArray1<i32>>>
where
    Euclidean: Derives<D, N>,
{
    indices(data, py, (input, queries), threads, |locator, queries| {
        let found = locator.nearest_many(queries)?;
        Ok(found.into_iter().map(|vertex| vertex.unwrap_or(NONE)).collect())
    })
}

/// Returns an index for each query, −1 where `find` has none.
fn indices<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    (input, queries): (&Input<'_>, &Input<'_>),
    threads: Option<usize>,
    find: impl Fn(&Locator<'_, D, N>, Points<'_, D>) -> Result<Vec<u32>, Error> + Send + Sync,
) -> PyResult<Bound<'py, PyArray1<i32>>>
where
    Euclidean: Derives<D, N>,
{
    let (points, queries) = (input.points::<D>()?, queries.points::<D>()?);
    let found = compute::answer(py, threads, queries, NONE, |queries| find(data.locator(points)?, queries))?;
    Ok(arrays::list(py, found))
}

/// Returns the `k` vertices nearest to each query.
pub(crate) fn nearest_k<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    queries: &Input<'_>,
    k: usize,
    threads: Option<usize>,
) -> PyResult<PyCsr<'py>>
where
    Euclidean: Derives<D, N>,
{
    let (points, queries) = (input.points::<D>()?, queries.points::<D>()?);
    let found = compute::run(py, threads, || {
        let locator = data.locator(points)?;
        let mut lists = Csr::default();
        for query in queries.iter() {
            if query.iter().all(|x| x.is_finite()) {
                lists.indices.extend(locator.nearest_k(query, k)?);
            }
            lists.offsets.push(lists.indices.len());
        }
        Ok(lists)
    })?;
    Ok(arrays::csr(py, found))
}

/// How values are interpolated.
pub(crate) struct Method {
    interpolation: Interpolation,
    outside: Outside,
    duplicates: Duplicates,
}

/// Reads what to do with the values of equal points.
fn duplicates_of(name: &str) -> PyResult<Duplicates> {
    match name {
        "first" => Ok(Duplicates::First),
        "mean" => Ok(Duplicates::Mean),
        "error" => Ok(Duplicates::Error),
        _ => Err(PyValueError::new_err(format!("duplicates must be 'first', 'mean' or 'error', not {name:?}"))),
    }
}

impl Method {
    /// Reads names; `fill` is the value outside that `"fill"` stands for.
    pub(crate) fn new(interpolation: &str, outside: &str, fill: f64, duplicates: &str) -> PyResult<Self> {
        let wrong = |what: &str, names: &str, name: &str| {
            Err(PyValueError::new_err(format!("{what} must be {names}, not {name:?}")))
        };
        let interpolation = match interpolation {
            "linear" => Interpolation::Linear,
            "laplace" => Interpolation::Laplace,
            "sibson" => Interpolation::Sibson,
            "sibson-c1" => Interpolation::SibsonC1,
            "clough-tocher" => Interpolation::CloughTocher,
            name => return wrong("method", "'linear', 'laplace', 'sibson', 'sibson-c1' or 'clough-tocher'", name),
        };
        let outside = match outside {
            "fill" => Outside::Value(fill),
            "nearest" => Outside::Nearest,
            "linear" => Outside::Linear,
            name => return wrong("outside", "'fill', 'nearest' or 'linear'", name),
        };
        Ok(Method { interpolation, outside, duplicates: duplicates_of(duplicates)? })
    }
}

/// Returns the gradient of the values at each point.
pub(crate) fn gradients<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    values: &[f64],
    duplicates: &str,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyArray2<f64>>>
where
    Euclidean: Derives<D, N>,
{
    let points = input.points::<D>()?;
    check_values(values.len(), points.len())?;
    let duplicates = duplicates_of(duplicates)?;
    let found = compute::run(py, threads, || {
        let interpolator = Interpolator::new(data.locator(points)?, values)?.duplicates(duplicates)?;
        Ok(interpolator.gradients().to_vec())
    })?;
    arrays::rows(py, found)
}

/// The values at points, with their gradients and which simplices count, if these are given.
#[derive(Clone, Copy)]
pub(crate) struct Values<'a> {
    pub(crate) values: &'a [f64],
    pub(crate) gradients: Option<&'a [f64]>,
    pub(crate) inside: Option<&'a [bool]>,
}

/// Returns the interpolated value at each query.
pub(crate) fn interpolate<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    Values { values, gradients, inside }: Values<'_>,
    queries: &Input<'_>,
    method: &Method,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyArray1<f64>>>
where
    Euclidean: Derives<D, N>,
{
    let (points, queries) = (input.points::<D>()?, queries.points::<D>()?);
    check_values(values.len(), points.len())?;
    // The values of duplicates are looked at once.
    let interpolator = compute::run(py, threads, || {
        let interpolator = Interpolator::new(data.locator(points)?, values)?.outside(method.outside);
        let interpolator = interpolator.duplicates(method.duplicates)?;
        let interpolator = if let Some(inside) = inside { interpolator.inside(inside)? } else { interpolator };
        match gradients {
            None => Ok(interpolator),
            Some(gradients) => interpolator.with_gradients(gradients.as_chunks().0),
        }
    })?;
    let missing = if let Outside::Value(value) = method.outside { value } else { f64::NAN };
    let found = compute::answer(py, threads, queries, missing, |queries| {
        Ok(interpolator.interpolate_many(method.interpolation, queries)?.values)
    })?;
    Ok(found.into_pyarray(py))
}
