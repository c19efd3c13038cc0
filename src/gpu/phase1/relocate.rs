//! Waiting points: along the history after the flips (§4.1), and their list without those that were
//! inserted.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Kernel, Recorder,
        dim::Dim,
        phase1::buffers::Buffers,
        waiting::{BoundWaitingList, WaitingList},
    },
    input::lattice::Width,
};

/// The kernels of relocation.
#[derive(Debug)]
pub(crate) struct Relocate {
    relocate: Kernel,
    list: WaitingList,
}

/// The bind groups of relocation.
#[derive(Debug)]
pub(crate) struct BoundRelocate {
    relocate: wgpu::BindGroup,
    list: BoundWaitingList,
}

impl BoundRelocate {
    /// Returns the bytes that it takes on the device beside the buffers that it shares.
    pub(crate) fn bytes(&self) -> u64 {
        self.list.bytes()
    }
}

impl Relocate {
    /// Compiles the kernels of `D` dimensions.
    pub(crate) fn new<const D: usize>(gpu: &Gpu, width: Width) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        let relocate = Kernel::new(gpu, Dimension::<D>::SHADERS.get("relocate"), width);
        Relocate { relocate, list: WaitingList::new(gpu) }
    }

    /// Binds the kernels to these buffers.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`](crate::gpu::Storage::new).
    pub(crate) fn bind<const D: usize>(&self, gpu: &Gpu, b: &Buffers<D>) -> Result<BoundRelocate, Error>
    where
        Dimension<D>: Dim<D>,
    {
        Ok(BoundRelocate {
            relocate: self.relocate.bind(gpu, &b.bindings()),
            // The scores are no longer needed when the list is compacted.
            list: self.list.bind(gpu, &b.control, &b.waiting, &b.scores)?,
        })
    }

    /// Records the walk along the history.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundRelocate, workgroups: u32) {
        recorder.stage("relocate");
        recorder.dispatch(&self.relocate, &bound.relocate, workgroups);
    }

    /// Records the compaction of the list, which has `entries` entries, those that do not wait
    /// included.
    pub(crate) fn record_compaction(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &BoundRelocate,
        entries: u32,
        workgroups: u32,
    ) {
        self.list.record(gpu, recorder, &bound.list, entries, workgroups);
    }
}
