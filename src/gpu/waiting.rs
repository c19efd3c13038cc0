//! The list of waiting points, without those that were inserted.

use crate::gpu::primitives::scan::{BoundScan, Scan, ScanParams};
use crate::{
    error::Error,
    gpu::{Compiler, Gpu, Kernel, Recorder, Storage, layout::Waiting, shader},
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
    mark: wgpu::BindGroup,
    compact: wgpu::BindGroup,
    scan: BoundScan,
    params: Storage<ScanParams>,
    bytes: u64,
}

impl BoundWaitingList {
    /// Returns the parameters of the scan: the number of entries of the list that is compacted, or
    /// 0, as the kernel says that begins a round.
    pub fn params(&self) -> &Storage<ScanParams> {
        &self.params
    }

    /// Returns the bytes that it takes on the device beside the buffers that it shares.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl WaitingList {
    /// Creates the kernels.
    pub fn new(compiler: &Compiler<'_>) -> Self {
        let [mark, compact] =
            ["waiting_mark", "waiting_compact"].map(|name| compiler.kernel(shader::COMMON.get(name), Width::Narrow));
        WaitingList { mark, compact, scan: Scan::new(compiler) }
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
        let offsets = Storage::new(gpu, "offsets", marks.len())?;
        let buffers = [
            ("control", control.buffer()),
            ("waiting", list.buffer()),
            ("marks", marks.buffer()),
            ("offsets", offsets.buffer()),
        ];
        Ok(BoundWaitingList {
            mark: self.mark.bind(gpu, &buffers),
            compact: self.compact.bind(gpu, &buffers),
            scan: self.scan.bind(gpu, &params, marks, &offsets)?,
            bytes: offsets.bytes(),
            params,
        })
    }

    /// Records the compaction of the list from one of its halves into the other, which the device
    /// carries out where it pays.
    pub fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundWaitingList, workgroups: u32) {
        recorder.stage("compact");
        recorder.dispatch(&self.mark, &bound.mark, workgroups);
        self.scan.record(recorder, &bound.scan);
        recorder.dispatch(&self.compact, &bound.compact, workgroups);
    }
}
