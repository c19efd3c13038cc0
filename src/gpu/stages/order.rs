//! Points along the Hilbert curve (§4.3), and those that share their coordinates.

use super::hilbert::{Hilbert, KEY_BITS};
use super::sort::Sort;
use crate::{
    Error,
    gpu::{Gpu, Kernel, Recorder, Storage, phase1::Buffers, vertex},
    lattice::Width,
};

/// The kernels that bring points into order.
#[derive(Debug)]
pub struct Order {
    hilbert: Hilbert,
    sort: Sort,
    gather: Kernel,
    set_aside: Kernel,
}

impl Order {
    /// The kernels.
    pub fn new(gpu: &Gpu, width: Width) -> Self {
        let constants = [("STRIDE", vertex::stride(width) as f64)];
        Order {
            hilbert: Hilbert::new(gpu, width),
            sort: Sort::new(gpu),
            gather: Kernel::new(gpu, "gather", width, &constants),
            set_aside: Kernel::new(gpu, "set_aside", width, &constants),
        }
    }

    /// Records the sorting of `unsorted` into `buffers.vertices`. Returns key and input place of each vertex.
    ///
    /// # Errors
    ///
    /// As [`Storage::new`].
    pub fn record(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        buffers: &Buffers,
        unsorted: &Storage<[i32; 4]>,
        workgroups: u32,
    ) -> Result<Storage<[u32; 2]>, Error> {
        let mut pairs = Storage::new(gpu, "keys and points", buffers.waiting.len())?;
        let mut scratch = Storage::new(gpu, "keys and points", buffers.waiting.len())?;
        recorder.stage("sort");
        self.hilbert.record(gpu, recorder, unsorted, &pairs);
        let sort = self.sort.bind(gpu, &mut pairs, &mut scratch, KEY_BITS)?;
        self.sort.record(recorder, &sort);
        let (control, vertices) = (buffers.control.buffer(), buffers.vertices.buffer());
        let gather = self.gather.bind(gpu, &[control, pairs.buffer(), unsorted.buffer(), vertices]);
        recorder.dispatch(&self.gather, &gather, workgroups);
        let set_aside = self.set_aside.bind(gpu, &[control, pairs.buffer(), vertices, buffers.same.buffer()]);
        recorder.dispatch(&self.set_aside, &set_aside, workgroups);
        Ok(pairs)
    }
}
