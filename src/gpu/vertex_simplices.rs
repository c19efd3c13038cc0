//! A simplex of each point, found on the device.

use crate::{
    dimension::Dimension,
    gpu::{Compiler, Gpu, Kernel, Recorder, device_mesh::DeviceArrays, dim::Dim},
    input::lattice::Width,
};

/// The kernels that find the lowest simplex of each point.
#[derive(Debug)]
pub(crate) struct VertexSimplices {
    clear: Kernel,
    minimum: Kernel,
}

impl VertexSimplices {
    /// Creates the kernels.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        let kernel = |name| compiler.kernel(Dimension::<D>::SHADERS.get(name), Width::Narrow);
        VertexSimplices { clear: kernel("vertex_clear"), minimum: kernel("vertex_simplex") }
    }

    /// Records the search for the lowest simplex of each point of `arrays`.
    pub(crate) fn record(&self, gpu: &Gpu, recorder: &mut Recorder<'_>, arrays: &DeviceArrays) {
        let buffers = [("corners", arrays.simplices.buffer()), ("vertex_simplices", arrays.vertex_simplices.buffer())];
        recorder.dispatch(&self.clear, &self.clear.bind(&buffers), gpu.workgroups(arrays.vertex_simplices.len()));
        if !arrays.simplices.is_empty() {
            recorder.dispatch(&self.minimum, &self.minimum.bind(&buffers), gpu.workgroups(arrays.simplices.len()));
        }
    }
}
