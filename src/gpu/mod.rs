//! The GPU engine's foundation: device, shaders, buffers, recording, readback and timing.
//!
//! Everything here works natively (Vulkan, Metal, DirectX 12) and in browsers (WebGPU) alike, within the limits that
//! every WebGPU device has: 8 storage buffers a stage, 256 invocations and 16 KiB of workgroup memory, 65,535
//! workgroups per dimension. Only larger buffers are asked for.
//!
//! * [`Gpu`] is a device with its queue, the caller's or one made on demand.
//! * [`shader`] has the WGSL of `shaders/`; [`Kernel`] is one compute pipeline made of it.
//! * [`Recorder`] encodes many dispatches in one compute pass, and [`Profiler`] times its stages.
//! * [`Storage`] is a typed storage buffer; [`Readback`] brings results to the host through reused staging buffers.
//! * [`stages`] has the host half of each stage.
//! * [`vertex`] is the form in which points reach the GPU.
//! * [`reference`] has the kernels' references, which compute the same on the CPU.

mod buffers;
mod device;
pub mod dim;
pub mod engine;
pub(crate) mod iterations;
mod kernel;
pub mod layout;
pub mod phase1;
pub mod points;
pub mod primitives;
mod profiler;
mod readback;
mod recorder;
pub mod shader;
pub mod start;
pub mod waiting;

pub use buffers::Storage;
pub use device::{AdapterChoice, AdapterSummary, Gpu, adapters};
pub use kernel::{Binding, Kernel};
pub use profiler::Profiler;
pub use readback::{Pending, Readback};
pub use recorder::Recorder;

/// The number of invocations in a workgroup.
pub const WORKGROUP: u32 = shader::constants::primitives::WORKGROUP;

/// The most workgroups that a dispatch may have in one dimension on every WebGPU device.
pub const MAX_WORKGROUPS: u32 = 65_535;

/// The workgroups for `items` invocations, for a kernel that strides over the grid: never more than a dispatch may
/// have, and at least one, so that an empty input needs no special case.
pub fn workgroups(items: u32) -> u32 {
    items.div_ceil(WORKGROUP).clamp(1, MAX_WORKGROUPS)
}
