//! Exclusive prefix sums, reduce-then-scan: three dispatches, none of whose workgroups waits for another.

use bytemuck::{Pod, Zeroable};

use crate::{
    Error,
    gpu::{Gpu, Kernel, Recorder, Storage},
    input::lattice::Width,
};

/// The workgroups that share a scan, at most. `SCAN_GROUPS` in `shaders/shared/scan.wgsl`.
pub const GROUPS: usize = 1024;
/// The values that a workgroup takes at a time. `SCAN_STEP` in `shaders/shared/scan.wgsl`.
pub const STEP: usize = 1024;

/// What the kernels of a scan are told. Mirrors `ScanParams` in `shaders/shared/scan.wgsl`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ScanParams {
    /// The number of values, at most 2³⁰. A kernel may write it.
    pub count: u32,
}

/// The kernels of a scan.
#[derive(Debug)]
pub struct Scan {
    reduce: Kernel,
    sums: Kernel,
    parts: Kernel,
}

/// A scan of certain buffers, which can be recorded again and again.
#[derive(Debug)]
pub struct BoundScan {
    /// Entry [`GROUPS`] is the sum of all values.
    sums: Storage<u32>,
    bindings: [wgpu::BindGroup; 3],
    /// Those that have values.
    groups: u32,
}

impl Scan {
    /// The kernels.
    pub fn new(gpu: &Gpu) -> Self {
        let [reduce, sums, parts] =
            ["scan_reduce", "scan_sums", "scan_parts"].map(|name| Kernel::new(gpu, name, Width::Narrow, &[]));
        Scan { reduce, sums, parts }
    }

    /// Prepares a scan: `offsets[i]` becomes the sum, modulo 2³², of `values[..i]`, for the first `count` of `params`.
    ///
    /// # Errors
    ///
    /// As [`Storage::new`].
    pub fn bind(
        &self,
        gpu: &Gpu,
        params: &Storage<ScanParams>,
        values: &Storage<u32>,
        offsets: &Storage<u32>,
    ) -> Result<BoundScan, Error> {
        let sums = Storage::new(gpu, "scan sums", GROUPS + 1)?;
        let bindings = [
            self.reduce.bind(gpu, &[params.buffer(), values.buffer(), sums.buffer()]),
            self.sums.bind(gpu, &[params.buffer(), sums.buffer()]),
            self.parts.bind(gpu, &[params.buffer(), values.buffer(), sums.buffer(), offsets.buffer()]),
        ];
        let groups = values.len().div_ceil(STEP).clamp(1, GROUPS) as u32;
        Ok(BoundScan { sums, bindings, groups })
    }

    /// Records a scan.
    pub fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundScan) {
        let [reduce, sums, parts] = &bound.bindings;
        recorder.dispatch(&self.reduce, reduce, bound.groups);
        recorder.dispatch(&self.sums, sums, 1);
        recorder.dispatch(&self.parts, parts, bound.groups);
    }
}

impl BoundScan {
    /// The sums; entry [`GROUPS`] is that of all values.
    pub fn sums(&self) -> &Storage<u32> {
        &self.sums
    }
}
