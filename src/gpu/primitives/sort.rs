//! Radix sort of key and value pairs by their keys, stable.
//!
//! Least significant digit first, eight bits a pass. A pass counts the digits of each tile, scans the counts, and sends
//! every pair to its place: three dispatches, none of whose workgroups waits for another.

use bytemuck::{Pod, Zeroable};

use crate::{
    Error,
    gpu::{Gpu, Kernel, MAX_WORKGROUPS, Recorder, Storage},
    input::lattice::Width,
};

/// The pairs of a tile. `RADIX_TILE` in `shaders/shared/radix.wgsl`.
pub const TILE: usize = 2048;
/// The values of a digit. `RADIX_DIGITS` in `shaders/shared/radix.wgsl`.
const DIGITS: usize = 256;
/// A thread a digit is enough for so many tiles. `RADIX_FEW` in `shaders/shared/radix.wgsl`.
pub const FEW: u32 = 8;
const DIGIT_BITS: u32 = DIGITS.trailing_zeros();

/// What the kernels of a pass are told. Mirrors `SortParams` in `shaders/shared/radix.wgsl`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct SortParams {
    /// The number of pairs.
    pub count: u32,
    /// Where the digit begins in the key.
    pub shift: u32,
}

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
    /// The kernels.
    pub fn new(gpu: &Gpu) -> Self {
        let [count, scan, scatter] =
            ["sort_count", "sort_scan", "sort_scatter"].map(|name| Kernel::new(gpu, name, Width::Narrow, &[]));
        Sort { count, scan, scatter }
    }

    /// Prepares a sort of all `pairs` (key, value) by the lowest `bits` of their keys. `scratch` has the same length; the
    /// two may change places, so that afterwards the sorted pairs are in `pairs`.
    ///
    /// # Errors
    ///
    /// As [`Storage::new`].
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
            passes.push([
                self.count.bind(gpu, &[params.buffer(), pairs.buffer(), counts.buffer()]),
                self.scan.bind(gpu, &[params.buffer(), counts.buffer(), totals.buffer()]),
                self.scatter
                    .bind(gpu, &[params.buffer(), pairs.buffer(), counts.buffer(), totals.buffer(), scratch.buffer()]),
            ]);
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
