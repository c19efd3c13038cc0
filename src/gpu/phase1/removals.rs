//! Removing facets that could not be flipped, with those beside them: find, commit, link (multi-face removal, de
//! Cougny and Shephard 1995). At the end of the rounds, after which fewer vertices have failed.

use crate::{
    dimension::Dimension,
    gpu::{Compiler, Gpu, Kernel, Recorder, dim::Dim, phase1::buffers::Buffers},
    input::lattice::Width,
};

/// The kernels, in a dimension in which flipping gets stuck.
#[derive(Debug)]
pub(crate) struct Removals(Option<[Kernel; 3]>);

/// Their bind groups.
#[derive(Debug)]
pub(crate) struct BoundRemovals(Option<[wgpu::BindGroup; 3]>);

impl Removals {
    /// Creates the kernels of `D` dimensions. Runs can do without them.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        let names = ["removals_find", "removals_commit", "removals_link"];
        let has_them = compiler.parts().is_none() && Dimension::<D>::SHADERS.find(names[0]).is_some();
        Removals(has_them.then(|| names.map(|name| compiler.deferred(Dimension::<D>::SHADERS.get(name), width))))
    }

    /// Binds the kernels to these buffers.
    pub(crate) fn bind<const D: usize>(&self, gpu: &Gpu, b: &Buffers<D>) -> BoundRemovals
    where
        Dimension<D>: Dim<D>,
    {
        // At the end, nobody needs the history any more.
        let mut buffers = b.bindings();
        buffers.push(("removals", b.history.buffer()));
        BoundRemovals(self.0.as_ref().map(|kernels| kernels.each_ref().map(|kernel| kernel.bind(gpu, &buffers))))
    }

    /// Returns whether the kernels are there by now.
    pub(crate) fn are_compiled(&self) -> bool {
        self.0.as_ref().is_some_and(|kernels| kernels.iter().all(Kernel::is_compiled))
    }

    /// Records the removals.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundRemovals, workgroups: u32) {
        recorder.stage("remove facets");
        for (kernel, bindings) in self.0.iter().flatten().zip(bound.0.iter().flatten()) {
            recorder.dispatch(kernel, bindings, workgroups);
        }
    }
}
