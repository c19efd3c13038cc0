//! Memory that both interfaces see, through which arrays go from one to the other.

use crate::error::failed;
use ash::{khr, vk};
use cudarc::driver::{
    CudaContext, DevicePtr, MappedBuffer,
    result::{memcpy_dtod_async, stream::synchronize},
    sys::CUstream,
};
use gdel::{Error, internals::gpu::Gpu, wgpu};
use std::{
    fs::File,
    os::fd::{FromRawFd, OwnedFd},
    sync::Arc,
};
use wgpu::hal::{api::Vulkan, vulkan};

/// The size in bytes. A piece of this size takes about as long to be copied as to be waited for.
const SIZE: u64 = 64 << 20;

/// Memory that both interfaces see.
#[derive(Debug)]
pub(crate) struct Staging {
    /// As CUDA sees it. It goes first.
    _mapped: MappedBuffer,
    address: u64,
    /// As Vulkan sees it, which owns it.
    buffer: wgpu::Buffer,
}

// SAFETY: the handles of CUDA's driver may be used on any thread, and cudarc makes their context current there.
unsafe impl Send for Staging {}

impl Staging {
    /// Allocates the memory.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfDeviceMemory`], and [`Error::Gpu`] for other failures.
    pub(crate) fn new(context: &Arc<CudaContext>, gpu: &Gpu) -> Result<Self, Error> {
        let (buffer, file, allocated) = exportable(gpu.device(), SIZE)?;
        // SAFETY: so much was allocated.
        let memory = unsafe { context.import_external_memory(File::from(file), allocated) }.map_err(failed)?;
        let mapped = memory.map_range(0..SIZE as usize).map_err(failed)?;
        let address = mapped.device_ptr(&context.default_stream()).0;
        Ok(Staging { _mapped: mapped, address, buffer })
    }

    /// Copies the first bytes of a buffer to an address in CUDA memory, as work of a stream. Waits until they are there.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Gpu`].
    ///
    /// # Safety
    ///
    /// So many bytes have to be there, and whoever uses them otherwise must have told this stream. CUDA's context has to
    /// be current, and nobody else may use this memory meanwhile.
    pub(crate) unsafe fn copy(
        &self,
        gpu: &Gpu,
        from: &wgpu::Buffer,
        bytes: u64,
        to: u64,
        stream: CUstream,
    ) -> Result<(), Error> {
        for start in (0..bytes).step_by(SIZE as usize) {
            let size = SIZE.min(bytes - start);
            let copied = pollster::block_on(gpu.with_error_scope("arrays for CUDA", || {
                let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                encoder.copy_buffer_to_buffer(from, start, &self.buffer, 0, size);
                Ok(gpu.queue().submit([encoder.finish()]))
            }))?;
            let wait = wgpu::PollType::Wait { submission_index: Some(copied), timeout: None };
            gpu.device().poll(wait).map_err(|error| Error::Gpu { reason: error.to_string() })?;
            // SAFETY: Vulkan has written so many bytes, and writes others only when these have been read.
            unsafe {
                memcpy_dtod_async(to + start, self.address, size as usize, stream).map_err(failed)?;
                synchronize(stream).map_err(failed)?;
            }
        }
        Ok(())
    }
}

/// Creates a buffer whose memory can be opened by another interface. Returns it with the file that stands for its
/// memory, and how many bytes this has.
///
/// # Errors
///
/// Returns [`Error::OutOfDeviceMemory`], and [`Error::Gpu`] for other failures.
fn exportable(device: &wgpu::Device, size: u64) -> Result<(wgpu::Buffer, OwnedFd, u64), Error> {
    const KIND: vk::ExternalMemoryHandleTypeFlags = vk::ExternalMemoryHandleTypeFlags::OPAQUE_FD;
    let failed = |error: vk::Result| match error {
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => Error::OutOfDeviceMemory { label: "memory shared with CUDA" },
        error => Error::Gpu { reason: format!("Vulkan: {error}") },
    };
    // SAFETY: the device lives longer than this function, and nothing of it is destroyed.
    let hal = unsafe { device.as_hal::<Vulkan>() }.ok_or(Error::Gpu { reason: "not a Vulkan device".to_owned() })?;
    let (raw, instance) = (hal.raw_device(), hal.shared_instance().raw_instance());
    let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let mut external = vk::ExternalMemoryBufferCreateInfo::default().handle_types(KIND);
    let info = vk::BufferCreateInfo::default().size(size).usage(usage).push_next(&mut external);
    // SAFETY: the structures are valid, and the extension is enabled, as `Device::open` has made sure.
    let buffer = unsafe { raw.create_buffer(&info, None) }.map_err(failed)?;
    // SAFETY: the buffer is one of this device.
    let needed = unsafe { raw.get_buffer_memory_requirements(buffer) };
    // SAFETY: the handle is that of the device.
    let memories = unsafe { instance.get_physical_device_memory_properties(hal.raw_physical_device()) };
    let is_suitable = |i: &u32| {
        let kind = memories.memory_types[*i as usize];
        needed.memory_type_bits >> i & 1 == 1 && kind.property_flags.contains(vk::MemoryPropertyFlags::DEVICE_LOCAL)
    };
    let memory = (0..memories.memory_type_count).find(is_suitable).ok_or(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
    let memory = memory.and_then(|kind| {
        let mut export = vk::ExportMemoryAllocateInfo::default().handle_types(KIND);
        let info = vk::MemoryAllocateInfo::default().allocation_size(needed.size).memory_type_index(kind);
        // SAFETY: the structures are valid.
        unsafe { raw.allocate_memory(&info.push_next(&mut export), None) }
    });
    // SAFETY: nobody else has the buffer.
    let memory = memory.inspect_err(|_| unsafe { raw.destroy_buffer(buffer, None) }).map_err(failed)?;
    let file = (|| {
        // SAFETY: the memory is that of the buffer, which has none yet, and as large as it needs.
        unsafe { raw.bind_buffer_memory(buffer, memory, 0) }?;
        let info = vk::MemoryGetFdInfoKHR::default().memory(memory).handle_type(KIND);
        // SAFETY: the memory was allocated for this kind of handle.
        let file = unsafe { khr::external_memory_fd::Device::new(instance, raw).get_memory_fd(&info) }?;
        // SAFETY: the file is new, and belongs to whoever asked for it.
        Ok(unsafe { OwnedFd::from_raw_fd(file) })
    })();
    // SAFETY: nobody else has the buffer and its memory.
    let free = |_: &vk::Result| unsafe {
        raw.destroy_buffer(buffer, None);
        raw.free_memory(memory, None);
    };
    let file = file.inspect_err(free).map_err(failed)?;
    // SAFETY: both belong to the buffer of wgpu from here on, which frees them. All of it is written before it is read.
    let buffer = unsafe { vulkan::Buffer::from_raw_managed(buffer, memory, 0, needed.size) };
    let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    let descriptor =
        wgpu::BufferDescriptor { label: Some("memory shared with CUDA"), size, usage, mapped_at_creation: false };
    drop(hal);
    // SAFETY: the buffer is one of this device, and has these usages and this size.
    Ok((unsafe { device.create_buffer_from_hal::<Vulkan>(buffer, &descriptor) }, file, needed.size))
}
