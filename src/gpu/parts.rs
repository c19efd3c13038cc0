//! Arrays in parts, for more points than fit the buffers that a kernel can bind.
//!
//! An array with 16 bytes per slot exceeds the 2 GiB of one binding from 15.8 million points on.
//! Then each large array consists of several buffers, and runs use kernels that choose the part by
//! the index, which `build/parts.rs` generates from the others. How many parts there can be depends on
//! how many buffers the device binds.

use crate::gpu::shader::{MAX_BUFFERS, PART_UNIT, PARTS};

/// How large the parts of large arrays are. WebAssembly, which has no memory for so many points, has only the kernels for
/// whole arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parts {
    /// In units of [`PART_UNIT`] bytes.
    units: u32,
    /// How many parts an array has, at most.
    count: u32,
}

impl Parts {
    /// Returns parts of no more than so many bytes, for a device with these limits; `None` if that is too little, or
    /// the device can bind too few buffers.
    pub fn with_bytes(limits: &wgpu::Limits, bytes: u64) -> Option<Self> {
        let units = u32::try_from(bytes / PART_UNIT).unwrap_or(u32::MAX);
        let count = buffers(limits) / MAX_BUFFERS;
        (count > 1 && units > 0).then_some(Parts { units, count })
    }

    /// Returns how many parts an array has, at most.
    pub(crate) fn count(self) -> u32 {
        self.count
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
        u64::from(self.count) * self.bytes()
    }
}

/// Returns how many storage buffers a kernel can bind on a device with these limits, and no more than
/// arrays in parts need.
fn buffers(limits: &wgpu::Limits) -> u32 {
    let and_others = limits.max_buffers_and_acceleration_structures_per_shader_stage;
    limits.max_storage_buffers_per_shader_stage.min(and_others).min(MAX_BUFFERS * PARTS)
}

/// Returns the limits to request of an adapter with these `limits`: the defaults of WebGPU, and the buffers
/// that arrays in parts need.
pub(crate) fn limits(limits: &wgpu::Limits) -> wgpu::Limits {
    let defaults = wgpu::Limits::default();
    wgpu::Limits {
        max_storage_buffers_per_shader_stage: buffers(limits),
        max_buffers_and_acceleration_structures_per_shader_stage: buffers(limits)
            .max(defaults.max_buffers_and_acceleration_structures_per_shader_stage),
        ..defaults
    }
}
