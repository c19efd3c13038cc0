//! Waiting points: along the history after the flips (§4.1), and their list without those that were inserted.

use crate::gpu::waiting::{BoundWaitingList, WaitingList};
use crate::{
    Error,
    gpu::{Gpu, Kernel, Recorder, phase1::Buffers, shader},
    input::lattice::Width,
};

/// The kernels of relocation.
#[derive(Debug)]
pub struct Relocate {
    relocate: Kernel,
    list: WaitingList,
}

/// The bind groups of relocation.
#[derive(Debug)]
pub struct BoundRelocate {
    relocate: wgpu::BindGroup,
    list: BoundWaitingList,
}

impl BoundRelocate {
    /// The bytes that it takes on the device beside the buffers that it shares.
    pub fn bytes(&self) -> u64 {
        self.list.bytes()
    }
}

impl Relocate {
    /// The kernels.
    pub fn new(gpu: &Gpu, width: Width) -> Self {
        Relocate { relocate: Kernel::new(gpu, shader::D3.get("relocate"), width), list: WaitingList::new(gpu) }
    }

    /// The bind groups for these buffers.
    ///
    /// # Errors
    ///
    /// As [`Storage::new`](crate::gpu::Storage::new).
    pub fn bind(&self, gpu: &Gpu, b: &Buffers<3>) -> Result<BoundRelocate, Error> {
        Ok(BoundRelocate {
            relocate: self.relocate.bind(gpu, &b.bindings()),
            // The scores are of no use any more when the list is compacted.
            list: self.list.bind(gpu, &b.control, &b.waiting, &b.scores)?,
        })
    }

    /// Records the walk along the history.
    pub fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundRelocate, workgroups: u32) {
        recorder.stage("relocate");
        recorder.dispatch(&self.relocate, &bound.relocate, workgroups);
    }

    /// Records the compaction of the list, which has `entries` entries, those that do not wait included.
    pub fn record_compaction(
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
