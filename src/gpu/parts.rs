//! Arrays in parts, for more points than fit the buffers that a kernel can bind.
//!
//! An array with 16 bytes per slot exceeds the 2 GiB of one binding from 15.8 million points on.
//! Then each large array consists of several buffers, and runs use kernels that choose the part by
//! the index: `build/parts.rs` makes these of the others, of which they differ in nothing else.

use crate::gpu::Gpu;
#[cfg(not(target_arch = "wasm32"))]
use crate::gpu::shader::{BUFFERS_IN_PARTS, PART_UNIT, PARTS};

/// How large the parts of large arrays are. In WebAssembly, which has no memory for so many points,
/// there are none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parts {
    /// In units of [`PART_UNIT`] bytes.
    units: u32,
    #[cfg(target_arch = "wasm32")]
    never: std::convert::Infallible,
}

#[cfg(not(target_arch = "wasm32"))]
impl Parts {
    /// Returns parts as large as the device can bind; `None` if it can bind too few buffers.
    pub fn of(gpu: &Gpu) -> Option<Self> {
        Self::with_bytes(gpu, gpu.max_storage_bytes())
    }

    /// Returns parts of no more than so many bytes; `None` if that is too little, or the device can
    /// bind too few buffers.
    pub fn with_bytes(gpu: &Gpu, bytes: u64) -> Option<Self> {
        let units = u32::try_from(bytes / PART_UNIT).unwrap_or(u32::MAX);
        let binds = gpu.device().limits().max_storage_buffers_per_shader_stage >= BUFFERS_IN_PARTS;
        (binds && units > 0).then_some(Parts { units })
    }

    /// Returns the size of a part, in units.
    pub(crate) fn units(self) -> u32 {
        self.units
    }

    /// Returns the size of a part, in bytes.
    pub(crate) fn bytes(self) -> u64 {
        u64::from(self.units) * PART_UNIT
    }

    /// Returns the size of the largest array, in bytes.
    pub(crate) fn limit(self) -> u64 {
        u64::from(PARTS) * self.bytes()
    }
}

#[cfg(target_arch = "wasm32")]
impl Parts {
    pub(crate) fn bytes(self) -> u64 {
        match self.never {}
    }

    pub(crate) fn limit(self) -> u64 {
        match self.never {}
    }
}

/// Returns the size of the largest array that can be in parts, in bytes.
pub(crate) fn limit(gpu: &Gpu, parts: Option<Parts>) -> u64 {
    parts.map_or_else(|| gpu.max_storage_bytes(), Parts::limit)
}
