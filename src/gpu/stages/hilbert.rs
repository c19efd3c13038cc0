//! Places of the points along the Hilbert curve (§4.3).

use crate::{
    gpu::{Gpu, Kernel, Recorder, Storage, workgroups},
    lattice::Width,
};

/// The bits of a key: ten an axis.
pub const KEY_BITS: u32 = 30;

/// The kernel that computes keys.
#[derive(Debug)]
pub struct Hilbert {
    keys: Kernel,
}

impl Hilbert {
    /// The kernel for points of this width.
    pub fn new(gpu: &Gpu, width: Width) -> Self {
        Hilbert { keys: Kernel::new(gpu, "hilbert_keys", width, &[]) }
    }

    /// Records the computation of `pairs`, key and number of each of the first points in `vertices`.
    pub fn record(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        vertices: &Storage<[i32; 4]>,
        pairs: &Storage<[u32; 2]>,
    ) {
        let bindings = self.keys.bind(gpu, &[vertices.buffer(), pairs.buffer()]);
        recorder.dispatch(&self.keys, &bindings, workgroups(pairs.len() as u32));
    }
}
