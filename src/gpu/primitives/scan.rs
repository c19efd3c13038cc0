//! Exclusive prefix sums, reduce-then-scan: three dispatches, none of whose workgroups waits for
//! another.

use bytemuck::{Pod, Zeroable};

use crate::{
    error::Error,
    gpu::{
        Compiler, Gpu, Recorder, Storage, append_bindings,
        shader::{assert_layout, constants::primitives as constants},
        steps::{BoundSteps, Step, Steps},
    },
};

/// The maximum number of workgroups that share a scan.
pub const GROUPS: usize = constants::SCAN_GROUPS as usize;
/// The number of values that a workgroup scans at a time.
pub const STEP: usize = constants::SCAN_STEP as usize;

/// The parameters of the kernels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ScanParams {
    /// The number of values, at most 2³⁰. A kernel may write it.
    pub count: u32,
}
assert_layout!(ScanParams);

/// The kernels of a scan.
#[derive(Debug)]
pub struct Scan(Steps);

const STEPS: &[Step] = &[
    Step::new("scan", "scan_reduce"),
    Step::new("scan", "scan_sums").in_one_workgroup(),
    Step::new("scan", "scan_parts"),
];

/// A scan of certain buffers, which can be recorded again and again.
#[derive(Debug)]
pub struct BoundScan {
    /// Entry [`GROUPS`] is the sum of all values.
    sums: Storage<u32>,
    steps: BoundSteps,
    /// The number of workgroups with values.
    groups: u32,
}

impl Scan {
    /// Creates the kernels.
    pub fn new(compiler: &Compiler<'_>) -> Self {
        Scan(Steps::common(compiler, STEPS))
    }

    /// Prepares a scan: `offsets[i]` becomes the sum, modulo 2³², of `values[..i]`, for the first
    /// `count` of `params`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub fn bind(
        &self,
        gpu: &Gpu,
        params: &Storage<ScanParams>,
        values: &Storage<u32>,
        offsets: &Storage<u32>,
    ) -> Result<BoundScan, Error> {
        let sums = Storage::new(gpu, "scan sums", GROUPS + 1)?;
        let mut buffers = vec![("params", params.buffer()), ("sums", sums.buffer())];
        append_bindings(&mut buffers, &[values.named("values"), offsets.named("offsets")]);
        let groups = values.len().div_ceil(STEP).clamp(1, GROUPS) as u32;
        Ok(BoundScan { steps: self.0.bind(&buffers), sums, groups })
    }
}

impl BoundScan {
    /// Records the scan.
    pub fn record(&self, recorder: &mut Recorder<'_>) {
        self.steps.record(recorder, self.groups);
    }

    /// Returns the sums; entry [`GROUPS`] is that of all values.
    pub fn sums(&self) -> &Storage<u32> {
        &self.sums
    }
}
