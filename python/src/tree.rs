//! Minimum spanning trees.

use crate::arrays;
use gdel::SpanningTree;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

/// A minimum spanning tree.
#[pyclass(frozen, module = "gdel._gdel")]
pub(crate) struct Tree(pub(crate) SpanningTree);

#[pymethods]
impl Tree {
    /// The edges.
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i32>>> {
        arrays::index_rows(py, self.0.edges.clone())
    }

    /// Their lengths.
    fn lengths<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.lengths)
    }

    /// The cluster of each point, of so many.
    fn clusters<'py>(&self, py: Python<'py>, count: usize) -> Bound<'py, PyArray1<i32>> {
        arrays::list(py, py.detach(|| self.0.clusters(count)))
    }

    /// The cluster of each point, of those that are farther apart than a distance.
    fn clusters_within<'py>(&self, py: Python<'py>, distance: f64) -> Bound<'py, PyArray1<i32>> {
        arrays::list(py, py.detach(|| self.0.clusters_within(distance)))
    }
}
