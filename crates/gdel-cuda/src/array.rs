//! The arrays of meshes.

use crate::{device::Device, error::failed};
use cudarc::driver::{CudaSlice, DevicePtr, sys::CUstream};
use gdel::{Error, wgpu};
use std::{fmt, ptr, sync::Arc};

/// An array of a mesh on the GPU, in memory of Vulkan: rows of `i32`.
#[derive(Debug, Clone)]
pub struct MeshArray {
    device: Arc<Device>,
    buffer: wgpu::Buffer,
    rows: usize,
    columns: usize,
}

impl MeshArray {
    pub(crate) fn new(device: &Arc<Device>, buffer: &wgpu::Buffer, rows: usize, columns: usize) -> Self {
        MeshArray { device: device.clone(), buffer: buffer.clone(), rows, columns }
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the number of columns; 1 for a list.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Copies the array into CUDA memory, on the GPU. Waits until it is there.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfDeviceMemory`], and [`Error::Gpu`] for other failures.
    pub fn to_cuda(&self) -> Result<CudaArray, Error> {
        let stream = self.device.context.default_stream();
        // SAFETY: all of it is written before anybody sees it.
        let slice = unsafe { stream.alloc::<i32>((self.rows * self.columns).max(1)) }.map_err(failed)?;
        let address = slice.device_ptr(&stream).0;
        // SAFETY: it has just been allocated, on this stream.
        unsafe { self.copy_to(address, ptr::null_mut()) }?;
        let memory = Memory { _slice: slice, address, device: self.device.clone() };
        Ok(CudaArray { memory: Arc::new(memory), rows: self.rows, columns: self.columns })
    }

    /// Copies the array to an address in CUDA memory, on the GPU, as work of a stream; null is the default stream. Waits
    /// until it is there.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Gpu`].
    ///
    /// # Safety
    ///
    /// There have to be as many `i32` as rows times columns, and whoever uses them otherwise must have told this stream.
    pub unsafe fn copy_to(&self, address: u64, stream: CUstream) -> Result<(), Error> {
        let bytes = (size_of::<i32>() * self.rows * self.columns) as u64;
        // SAFETY: the caller promises it.
        unsafe { self.device.copy(&self.buffer, bytes, address, stream) }
    }
}

/// An array in CUDA memory: rows of `i32`.
///
/// Clones are the same memory, which is freed with the last of them.
#[derive(Clone)]
pub struct CudaArray {
    memory: Arc<Memory>,
    rows: usize,
    columns: usize,
}

struct Memory {
    _slice: CudaSlice<i32>,
    address: u64,
    device: Arc<Device>,
}

impl CudaArray {
    /// Returns the address in CUDA memory.
    pub fn address(&self) -> u64 {
        self.memory.address
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the number of columns; 1 for a list.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns the number of the GPU among those of CUDA.
    pub fn ordinal(&self) -> usize {
        self.memory.device.ordinal()
    }
}

impl fmt::Debug for CudaArray {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let CudaArray { rows, columns, .. } = self;
        f.debug_struct("CudaArray").field("address", &self.address()).field("shape", &[rows, columns]).finish()
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // Whatever was started on any stream may still read it. Where CUDA has failed, nothing runs.
        let _ = self.device.context.synchronize();
    }
}
