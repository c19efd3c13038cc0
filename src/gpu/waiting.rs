//! The list of waiting points, without those that were inserted.

use crate::gpu::primitives::scan::{BoundScan, Scan, ScanParams};
use crate::{
    error::Error,
    gpu::{Gpu, Kernel, Recorder, Storage, layout::Waiting, shader},
    input::lattice::Width,
};

/// The kernels.
#[derive(Debug)]
pub struct WaitingList {
    mark: Kernel,
    compact: Kernel,
    scan: Scan,
}

/// The bind groups for a certain list, and what its compaction needs.
#[derive(Debug)]
pub struct BoundWaitingList {
    list: Storage<Waiting>,
    mark: wgpu::BindGroup,
    compact: wgpu::BindGroup,
    scan: BoundScan,
    params: Storage<ScanParams>,
    compacted: Storage<Waiting>,
    bytes: u64,
}

impl BoundWaitingList {
    /// Returns the bytes that it takes on the device beside the buffers that it shares.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl WaitingList {
    /// Compiles the kernels.
    pub fn new(gpu: &Gpu) -> Self {
        let [mark, compact] =
            ["waiting_mark", "waiting_compact"].map(|name| Kernel::new(gpu, shader::COMMON.get(name), Width::Narrow));
        WaitingList { mark, compact, scan: Scan::new(gpu) }
    }

    /// Binds the kernels to these buffers. What `marks` holds is lost when the list is compacted.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub fn bind(
        &self,
        gpu: &Gpu,
        control: &Storage<u32>,
        list: &Storage<Waiting>,
        marks: &Storage<u32>,
    ) -> Result<BoundWaitingList, Error> {
        let params = Storage::new(gpu, "scan parameters", 1)?;
        let compacted = Storage::new(gpu, "compacted list", list.len())?;
        let offsets = Storage::new(gpu, "offsets", list.len())?;
        let buffers = [
            ("control", control.buffer()),
            ("waiting", list.buffer()),
            ("marks", marks.buffer()),
            ("offsets", offsets.buffer()),
            ("compacted", compacted.buffer()),
        ];
        Ok(BoundWaitingList {
            list: list.clone(),
            mark: self.mark.bind(gpu, &buffers),
            compact: self.compact.bind(gpu, &buffers),
            scan: self.scan.bind(gpu, &params, marks, &offsets)?,
            bytes: compacted.bytes() + offsets.bytes(),
            params,
            compacted,
        })
    }

    /// Records the compaction of the list, which has `entries` entries, those that do not wait
    /// included.
    pub fn record(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &BoundWaitingList,
        entries: u32,
        workgroups: u32,
    ) {
        bound.params.write(gpu, 0, &[ScanParams { count: entries }]);
        recorder.stage("compact");
        recorder.dispatch(&self.mark, &bound.mark, workgroups);
        self.scan.record(recorder, &bound.scan);
        recorder.dispatch(&self.compact, &bound.compact, workgroups);
        let bytes = u64::from(entries) * size_of::<Waiting>() as u64;
        recorder.encoder().copy_buffer_to_buffer(bound.compacted.buffer(), 0, bound.list.buffer(), 0, bytes);
    }
}
