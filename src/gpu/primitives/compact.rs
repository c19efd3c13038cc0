//! Stream compaction: the numbers of the marked entries, in order.

use crate::{
    error::Error,
    gpu::{
        Compiler, Gpu, Recorder, Storage, append_bindings,
        primitives::scan::{BoundScan, Scan, ScanParams},
        steps::{BoundSteps, Step, Steps},
        workgroups,
    },
};

/// The kernels of a compaction.
#[derive(Debug)]
pub struct Compact {
    scan: Scan,
    scatter: Steps,
}

/// A compaction of certain buffers, which can be recorded again and again.
#[derive(Debug)]
pub struct BoundCompact {
    scan: BoundScan,
    scatter: BoundSteps,
    workgroups: u32,
}

impl Compact {
    /// Creates the kernels.
    pub fn new(compiler: &Compiler<'_>) -> Self {
        Compact { scan: Scan::new(compiler), scatter: Steps::common(compiler, &[Step::new("compact", "compact")]) }
    }

    /// Prepares a compaction: `kept` becomes the numbers, ascending, of the entries of `marks` that
    /// are 1 and not 0.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub fn bind(
        &self,
        gpu: &Gpu,
        params: &Storage<ScanParams>,
        marks: &Storage<u32>,
        kept: &Storage<u32>,
    ) -> Result<BoundCompact, Error> {
        let offsets = Storage::new(gpu, "compaction offsets", marks.len())?;
        let scan = self.scan.bind(gpu, params, marks, &offsets)?;
        let mut buffers = vec![("params", params.buffer()), ("offsets", offsets.buffer()), ("kept", kept.buffer())];
        append_bindings(&mut buffers, &[marks.named("marks")]);
        let scatter = self.scatter.bind(&buffers);
        Ok(BoundCompact { scan, scatter, workgroups: workgroups(marks.len() as u32) })
    }
}

impl BoundCompact {
    /// Records the compaction.
    pub fn record(&self, recorder: &mut Recorder<'_>) {
        self.scan.record(recorder);
        self.scatter.record(recorder, self.workgroups);
    }

    /// Returns the scan's sums; entry [`GROUPS`](crate::gpu::primitives::scan::GROUPS) is the
    /// number of entries kept.
    pub fn sums(&self) -> &Storage<u32> {
        self.scan.sums()
    }
}
