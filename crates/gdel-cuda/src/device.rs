//! One GPU as CUDA and Vulkan know it.

use crate::{error::failed, staging::Staging};
use ash::{khr, vk};
use cudarc::driver::{
    CudaContext, DriverError,
    sys::{CUstream, is_culib_present},
};
use gdel::{Error, internals::gpu::Gpu, wgpu};
use pollster::block_on;
use std::sync::{Arc, Mutex, PoisonError};
use wgpu::hal::api::Vulkan;

/// A GPU that is open in both interfaces.
#[derive(Debug)]
pub(crate) struct Device {
    /// That of the process, which PyTorch and others use, too.
    pub(crate) context: Arc<CudaContext>,
    pub(crate) gpu: Gpu,
    pub(crate) staging: Mutex<Staging>,
}

impl Device {
    /// Opens the GPU of this number among those of CUDA.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NoAdapter`] where there is no CUDA, no such GPU, or no Vulkan on it.
    pub(crate) fn open(ordinal: usize) -> Result<Self, Error> {
        let unavailable = |reason: String| Error::NoAdapter { reason };
        make_sure_of_cuda()?;
        let of_cuda = |error: DriverError| unavailable(format!("GPU {ordinal} of CUDA: {error}"));
        let context = CudaContext::new(ordinal).map_err(of_cuda)?;
        let wanted = context.uuid().map_err(of_cuda)?.bytes.map(|byte| byte as u8);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        let adapter = adapters.iter().find(|adapter| uuid(adapter) == Some(wanted)).ok_or_else(|| {
            unavailable(format!(
                "Vulkan does not know GPU {ordinal} of CUDA: its driver for Vulkan has to be installed"
            ))
        })?;
        let gpu = block_on(Gpu::on(adapter))?;
        // SAFETY: the device is only asked.
        let shares = unsafe { gpu.device().as_hal::<Vulkan>() }
            .is_some_and(|device| device.enabled_device_extensions().contains(&khr::external_memory_fd::NAME));
        if !shares {
            return Err(unavailable(format!("the Vulkan driver of GPU {ordinal} does not share memory")));
        }
        let staging = Mutex::new(Staging::new(&context, &gpu)?);
        Ok(Device { context, gpu, staging })
    }

    /// Copies the first bytes of a buffer to an address in CUDA memory, as work of a stream. Waits until they are there.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Gpu`].
    ///
    /// # Safety
    ///
    /// So many bytes have to be there, and whoever uses them otherwise must have told this stream.
    pub(crate) unsafe fn copy(&self, from: &wgpu::Buffer, bytes: u64, to: u64, stream: CUstream) -> Result<(), Error> {
        let staging = self.staging.lock().unwrap_or_else(PoisonError::into_inner);
        self.context.bind_to_thread().map_err(failed)?;
        // SAFETY: the caller promises it, and nobody else uses the memory as long as it is locked.
        unsafe { staging.copy(&self.gpu, from, bytes, to, stream) }
    }

    /// Returns the number of the GPU among those of CUDA.
    pub(crate) fn ordinal(&self) -> usize {
        self.context.ordinal()
    }
}

/// Makes sure that CUDA's functions can be called.
fn make_sure_of_cuda() -> Result<(), Error> {
    // SAFETY: the driver's library has no requirements on who loads it.
    if unsafe { is_culib_present() } {
        return Ok(());
    }
    Err(Error::NoAdapter { reason: "CUDA's driver, libcuda.so, cannot be loaded".to_owned() })
}

/// Returns the identity of a GPU, which does not depend on the interface.
fn uuid(adapter: &wgpu::Adapter) -> Option<[u8; vk::UUID_SIZE]> {
    // SAFETY: the adapter is only asked, and lives as long as its handles are used.
    let adapter = unsafe { adapter.as_hal::<Vulkan>() }?;
    let mut id = vk::PhysicalDeviceIDProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut id);
    let instance = adapter.shared_instance().raw_instance();
    // SAFETY: the handle is one of this instance, whose version wgpu has made sure to be 1.1 or later.
    unsafe { instance.get_physical_device_properties2(adapter.raw_physical_device(), &mut properties) };
    Some(id.device_uuid)
}

/// Returns on which of CUDA's GPUs an address is.
///
/// # Errors
///
/// Returns [`Error::NoAdapter`] where there is no CUDA, and [`Error::Gpu`] for addresses that it does not know.
#[cfg(feature = "python")]
pub(crate) fn ordinal_of(address: u64) -> Result<usize, Error> {
    use cudarc::driver::sys::{CUpointer_attribute, cuPointerGetAttribute};
    make_sure_of_cuda()?;
    let mut ordinal = 0i32;
    let attribute = CUpointer_attribute::CU_POINTER_ATTRIBUTE_DEVICE_ORDINAL;
    // SAFETY: the attribute is a number of this type.
    unsafe { cuPointerGetAttribute((&raw mut ordinal).cast(), attribute, address) }.result().map_err(failed)?;
    usize::try_from(ordinal).map_err(|_| Error::Gpu { reason: format!("{address:#x} is not an address of CUDA") })
}
