//! Waiting points along the history after the flips (§4.1).

use crate::{
    dimension::Dimension,
    gpu::{Compiler, Gpu, Kernel, Recorder, dim::Dim, phase1::buffers::Buffers},
    input::lattice::Width,
};

/// The kernel of relocation.
#[derive(Debug)]
pub(crate) struct Relocate(Kernel);

/// Its bind group.
#[derive(Debug)]
pub(crate) struct BoundRelocate(wgpu::BindGroup);

impl Relocate {
    /// Creates the kernel of `D` dimensions.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        Relocate(compiler.kernel(Dimension::<D>::SHADERS.get("relocate"), width))
    }

    /// Binds the kernel to these buffers.
    pub(crate) fn bind<const D: usize>(&self, gpu: &Gpu, b: &Buffers<D>) -> BoundRelocate
    where
        Dimension<D>: Dim<D>,
    {
        BoundRelocate(self.0.bind(gpu, &b.bindings()))
    }

    /// Records the walk along the history.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundRelocate, workgroups: u32) {
        recorder.stage("relocate");
        recorder.dispatch(&self.0, &bound.0, workgroups);
    }
}
