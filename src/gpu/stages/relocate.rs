//! Waiting points: along the history after the flips (§4.1), and their list without those that were inserted.

use super::scan::{BoundScan, Scan, ScanParams};
use crate::{
    Error,
    gpu::{Gpu, Kernel, Recorder, Storage, layout::Waiting, phase1::Buffers},
    lattice::Width,
};

/// The kernels of relocation.
#[derive(Debug)]
pub struct Relocate {
    relocate: Kernel,
    mark: Kernel,
    compact: Kernel,
    scan: Scan,
}

/// The bind groups of relocation, and what compaction needs.
#[derive(Debug)]
pub struct BoundRelocate {
    relocate: wgpu::BindGroup,
    mark: wgpu::BindGroup,
    compact: wgpu::BindGroup,
    scan: BoundScan,
    params: Storage<ScanParams>,
    compacted: Storage<Waiting>,
    bytes: u64,
}

impl BoundRelocate {
    /// The bytes that it takes on the device beside the buffers that it shares.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl Relocate {
    /// The kernels.
    pub fn new(gpu: &Gpu, width: Width) -> Self {
        let kernel = |name| Kernel::new(gpu, name, width, &[]);
        Relocate {
            relocate: kernel("relocate"),
            mark: kernel("waiting_mark"),
            compact: kernel("waiting_compact"),
            scan: Scan::new(gpu),
        }
    }

    /// The bind groups for these buffers.
    ///
    /// # Errors
    ///
    /// As [`Storage::new`].
    pub fn bind(&self, gpu: &Gpu, b: &Buffers) -> Result<BoundRelocate, Error> {
        let (control, waiting) = (b.control.buffer(), b.waiting.buffer());
        let params = Storage::new(gpu, "scan parameters", 1)?;
        let compacted = Storage::new(gpu, "compacted list", b.waiting.len())?;
        let offsets = Storage::new(gpu, "offsets", b.waiting.len())?;
        // The scores are of no use any more when the list is compacted.
        let marks = &b.scores;
        Ok(BoundRelocate {
            relocate: self
                .relocate
                .bind(gpu, &[control, b.points.vertices.buffer(), b.status.buffer(), b.history.buffer(), waiting]),
            mark: self.mark.bind(gpu, &[control, waiting, marks.buffer()]),
            compact: self.compact.bind(gpu, &[control, waiting, offsets.buffer(), compacted.buffer()]),
            scan: self.scan.bind(gpu, &params, marks, &offsets)?,
            bytes: compacted.bytes() + offsets.bytes(),
            params,
            compacted,
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
        b: &Buffers,
        entries: u32,
        workgroups: u32,
    ) {
        bound.params.write(gpu, 0, &[ScanParams { count: entries }]);
        recorder.stage("compact");
        recorder.dispatch(&self.mark, &bound.mark, workgroups);
        self.scan.record(recorder, &bound.scan);
        recorder.dispatch(&self.compact, &bound.compact, workgroups);
        let bytes = u64::from(entries) * size_of::<Waiting>() as u64;
        recorder.encoder().copy_buffer_to_buffer(bound.compacted.buffer(), 0, b.waiting.buffer(), 0, bytes);
    }
}
