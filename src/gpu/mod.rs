//! The GPU engine's foundation: device, shaders, buffers, recording, readback and timing.
//!
//! Everything here works natively (Vulkan, Metal, DirectX 12) and in browsers (WebGPU) alike,
//! within the limits that every WebGPU device has: 8 storage buffers per stage, 256 invocations and
//! 16 KiB of workgroup memory, 65,535 workgroups per dimension. Only larger buffers are requested, and
//! natively more of them, for [`Parts`].
//!
//! * [`Gpu`] is a device with its queue, the caller's or one opened on demand.
//! * [`shader`] has the WGSL of `shaders/`; [`Kernel`] is one compute pipeline made of it.
//! * [`Recorder`] encodes many dispatches in one compute pass, and [`Profiler`] times its stages.
//! * [`Storage`] is a typed storage buffer; [`Readback`] brings results to the host through reused
//!   staging buffers.
//! * [`dim`] has what differs between the dimensions; [`phase1`] and [`engine`] are generic over
//!   them.

#[cfg(not(target_arch = "wasm32"))]
mod blocking;
mod buffers;
mod compiler;
mod device;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) mod device_edges;
pub mod device_mesh;
pub mod dim;
pub mod engine;
pub mod host;
mod kernel;
pub mod layout;
pub(crate) mod mesh_check;
pub mod message;
pub mod mutation;
pub(crate) mod parts;
pub mod phase1;
pub mod points;
pub mod primitives;
mod profiler;
pub(crate) mod progress;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) mod queries;
pub(crate) mod readback;
mod recorder;
pub(crate) mod room;
pub mod self_test;
pub mod shader;
pub mod start;
pub(crate) mod steps;
#[cfg(not(target_arch = "wasm32"))]
mod survivors;
pub mod update;
pub(crate) mod vertex_simplices;

pub use buffers::Storage;
pub(crate) use buffers::append_bindings;
pub use compiler::Compiler;
pub(crate) use compiler::compile_all;
pub use device::{AdapterChoice, AdapterSummary, Gpu, adapters};
pub use kernel::{Binding, Kernel};
pub use parts::Parts;
pub use profiler::Profiler;
pub use readback::{Pending, Readback};
pub use recorder::Recorder;
pub(crate) use room::{Room, Rooms};

/// The number of invocations in a workgroup.
pub const WORKGROUP: u32 = shader::constants::primitives::WORKGROUP;

/// The maximum number of workgroups that a dispatch may have in one dimension on every WebGPU
/// device.
pub const MAX_WORKGROUPS: u32 = 65_535;

/// Returns the workgroups for `items` invocations, for a kernel that strides over the grid: never
/// more than a dispatch may have, and at least one, so that an empty input needs no special case.
pub fn workgroups(items: u32) -> u32 {
    items.div_ceil(WORKGROUP).clamp(1, MAX_WORKGROUPS)
}
