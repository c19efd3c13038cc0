//! How the host and a device exchange data in browsers.

use crate::{
    error::Error,
    gpu::{Gpu, Kernel, compile_all, readback::Target},
};
use std::pin::Pin;

/// What an error scope reports.
pub(crate) type Report<'a> = Pin<Box<dyn Future<Output = Result<(), Error>> + 'a>>;

/// The bytes of a piece of a large array that is read: so few that a copy never holds up the calling thread for long.
pub(crate) const PIECE: u64 = 8 << 20;

/// Does nothing: browsers report by themselves what the device has carried out.
///
/// # Errors
///
/// Returns none.
pub(crate) fn wait(_: &Gpu, _: &wgpu::SubmissionIndex) -> Result<(), Error> {
    Ok(())
}

/// Copies the first bytes of a mapped buffer, which lies outside of the memory of WebAssembly.
pub(crate) fn copy(from: &wgpu::BufferView, to: &mut [u8]) {
    from.as_uint8array().subarray(0, to.len() as u32).copy_to(to);
}

/// Writes to a buffer, before the commands of the next submission.
pub(crate) fn write(gpu: &Gpu, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
    gpu.queue().write_buffer(buffer, offset, bytes);
}

/// Compiles kernels. Browsers compile them in threads of their own.
///
/// # Errors
///
/// Returns the errors of [`Gpu::with_error_scope`].
pub(crate) async fn compile(gpu: &Gpu, kernels: Vec<Kernel>) -> Result<(), Error> {
    compile_all(gpu, &kernels).await
}

/// Whether [`compile_beside`] does anything.
pub(crate) const COMPILES_BESIDE: bool = false;

/// Does nothing: a program may end while a driver compiles, and a driver that is unloaded then may crash.
pub(crate) fn compile_beside(_: &Gpu, _: &[Kernel]) {}

/// Memory outside of that of WebAssembly: the bytes get there with one copy.
impl Target for js_sys::Uint8Array {
    fn bytes(&self) -> u64 {
        self.byte_length().into()
    }

    fn take(&mut self, start: u64, len: u64, piece: &wgpu::BufferView) {
        self.set(&piece.as_uint8array().subarray(0, len as u32), start as u32);
    }
}
