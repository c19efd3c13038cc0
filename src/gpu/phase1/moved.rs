//! A mesh whose points have moved, in place of the first rounds: its simplices in slots, and what
//! of them is not positively oriented or not locally Delaunay any more.

use crate::{
    dimension::Dimension,
    gpu::{Binding, Compiler, Gpu, Kernel, Recorder, dim::Dim, phase1::buffers::Buffers},
    input::lattice::Width,
};

/// The kernels. They are compiled when a mesh is updated for the first time.
#[derive(Debug)]
pub(crate) struct Moved([Kernel; 4]);

/// Their names, in the order in which they run.
const KERNELS: [&str; 4] = ["moved_mesh", "moved_ghosts", "moved_signs", "moved_facets"];

impl Moved {
    /// Creates the kernels of `D` dimensions.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        Moved(KERNELS.map(|name| compiler.on_demand(Dimension::<D>::SHADERS.get(name), width)))
    }

    /// Records all of them for the mesh that has these buffers.
    pub(crate) fn record<const D: usize>(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        b: &Buffers<D>,
        mesh: [Binding<'_>; 2],
        workgroups: u32,
    ) where
        Dimension<D>: Dim<D>,
    {
        let mut buffers = b.bindings();
        buffers.extend(mesh);
        recorder.stage("moved mesh");
        for kernel in &self.0 {
            recorder.dispatch(kernel, &kernel.bind(gpu, &buffers), workgroups);
        }
    }
}
