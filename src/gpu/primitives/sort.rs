//! Radix sort of key and value pairs by their keys, stable.
//!
//! Least significant digit first, eight bits a pass. A pass counts the digits of each tile, scans
//! the counts, and sends every pair to its place: three dispatches, none of whose workgroups waits
//! for another.

use bytemuck::{Pod, Zeroable};

use crate::{
    error::Error,
    gpu::{
        Compiler, Gpu, Kernel, MAX_WORKGROUPS, Recorder, Storage,
        shader::{self, assert_layout, constants::primitives as constants},
    },
    input::lattice::Width,
};

/// The number of pairs in a tile.
pub const TILE: usize = constants::RADIX_TILE as usize;
/// The number of values of a digit.
const DIGITS: usize = constants::RADIX_DIGITS as usize;
/// The maximum number of tiles for which one invocation per digit is enough.
pub const FEW: u32 = constants::RADIX_FEW;
const DIGIT_BITS: u32 = DIGITS.trailing_zeros();

/// The parameters of the kernels of a pass.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct SortParams {
    /// The number of pairs.
    pub count: u32,
    /// Where the digit begins in the key.
    pub shift: u32,
}
assert_layout!(SortParams);

/// The kernels of a sort.
#[derive(Debug)]
pub struct Sort {
    count: Kernel,
    scan: Kernel,
    scatter: Kernel,
}

/// A sort of certain buffers, which can be recorded again and again.
#[derive(Debug)]
pub struct BoundSort {
    passes: Vec<[wgpu::BindGroup; 3]>,
    tiles: u32,
}

impl Sort {
    /// Creates the kernels.
    pub fn new(compiler: &Compiler<'_>) -> Self {
        let kernel = |name| compiler.kernel(shader::COMMON.get(name), Width::Narrow);
        let [count, scan, scatter] = ["sort_count", "sort_scan", "sort_scatter"].map(kernel);
        Sort { count, scan, scatter }
    }

    /// Prepares a sort of all `pairs` (key, value) by the lowest `bits` of their keys. `scratch`
    /// has the same length; the two may change places, so that afterwards the sorted pairs are in
    /// `pairs`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub fn bind(
        &self,
        gpu: &Gpu,
        pairs: &mut Storage<[u32; 2]>,
        scratch: &mut Storage<[u32; 2]>,
        bits: u32,
    ) -> Result<BoundSort, Error> {
        let tiles = pairs.len().div_ceil(TILE);
        let counts = Storage::<u32>::new(gpu, "digit counts", tiles * DIGITS)?;
        let totals = Storage::<u32>::new(gpu, "digit totals", DIGITS)?;
        let mut passes = Vec::new();
        for pass in 0..bits.div_ceil(DIGIT_BITS) {
            let contents = SortParams { count: pairs.len() as u32, shift: pass * DIGIT_BITS };
            let params = Storage::with_contents(gpu, "sort parameters", &[contents])?;
            let buffers = [
                ("params", params.buffer()),
                ("pairs", pairs.buffer()),
                ("counts", counts.buffer()),
                ("totals", totals.buffer()),
                ("sorted", scratch.buffer()),
            ];
            passes.push([&self.count, &self.scan, &self.scatter].map(|kernel| kernel.bind(&buffers)));
            std::mem::swap(pairs, scratch);
        }
        Ok(BoundSort { passes, tiles: tiles as u32 })
    }

    /// Records a sort.
    pub fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundSort) {
        let workgroups = bound.tiles.clamp(1, MAX_WORKGROUPS);
        for [count, scan, scatter] in &bound.passes {
            recorder.dispatch(&self.count, count, workgroups);
            recorder.dispatch(&self.scan, scan, if bound.tiles <= FEW { 1 } else { DIGITS as u32 });
            recorder.dispatch(&self.scatter, scatter, workgroups);
        }
    }
}
