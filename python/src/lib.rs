//! The extension module of the Python package `gdel`: meshes in Rust's memory, which NumPy sees without a copy.
//!
//! What is not hot is written in Python, in `python/gdel`; nothing here is public there.

mod arrays;
mod compute;
mod constrained;
mod core;
#[cfg(target_os = "linux")]
mod cuda;
mod derived;
mod errors;
mod mesh;
mod queries;
mod tiles;
mod transport;
mod tree;
mod voronoi;

use pyo3::prelude::*;

/// Returns the GPUs of this machine as dictionaries.
#[pyfunction]
fn adapters(py: Python<'_>) -> PyResult<Vec<Bound<'_, pyo3::types::PyDict>>> {
    compute::note_gpu(py)?;
    let adapters = py.detach(gdel::adapters);
    let dictionary = |adapter: &gdel::AdapterSummary| {
        let dictionary = pyo3::types::PyDict::new(py);
        dictionary.set_item("name", &adapter.name)?;
        dictionary.set_item("backend", &adapter.backend)?;
        dictionary.set_item("driver", &adapter.driver)?;
        dictionary.set_item("software", adapter.software)?;
        Ok(dictionary)
    };
    adapters.iter().map(dictionary).collect()
}

/// The extension module.
#[pymodule(name = "_gdel", gil_used = false)]
fn gdel_module(module: &Bound<'_, PyModule>) -> PyResult<()> {
    compute::note_process();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("GpuError", module.py().get_type::<errors::GpuError>())?;
    module.add("CrossingError", module.py().get_type::<errors::CrossingError>())?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<tree::Tree>()?;
    #[cfg(target_os = "linux")]
    {
        module.add_class::<cuda::CudaMesh>()?;
        module.add_class::<cuda::CudaArray>()?;
        module.add_class::<cuda::MeshArray>()?;
        module.add_function(wrap_pyfunction!(cuda::triangulate_cuda, module)?)?;
    }
    module.add_function(wrap_pyfunction!(adapters, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::triangulate, module)?)?;
    module.add_function(wrap_pyfunction!(constrained::constrain, module)?)?;
    module.add_function(wrap_pyfunction!(constrained::tin, module)?)?;
    module.add_function(wrap_pyfunction!(transport::transport, module)?)?;
    for function in [
        wrap_pyfunction!(tiles::tiles_survey, module)?,
        wrap_pyfunction!(tiles::tiles_plan, module)?,
        wrap_pyfunction!(tiles::tiles_split, module)?,
        wrap_pyfunction!(tiles::tiles_begin, module)?,
        wrap_pyfunction!(tiles::tiles_step, module)?,
        wrap_pyfunction!(tiles::tiles_piece, module)?,
        wrap_pyfunction!(tiles::tiles_links, module)?,
    ] {
        module.add_function(function)?;
    }
    module.add_function(wrap_pyfunction!(mesh::restore, module)?)
}
