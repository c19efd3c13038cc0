//! How the host and a device exchange data in browsers.

use crate::error::Error;
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
pub(crate) fn wait(_: &wgpu::Device, _: bool, _: &wgpu::SubmissionIndex) -> Result<(), wgpu::PollError> {
    Ok(())
}

/// Copies the first bytes of a mapped buffer, which lies outside of the memory of WebAssembly.
pub(crate) fn copy(from: &wgpu::BufferView, to: &mut [u8]) {
    from.as_uint8array().subarray(0, to.len() as u32).copy_to(to);
}

/// Writes to a buffer, before the commands of the next submission.
pub(crate) fn write(queue: &wgpu::Queue, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
    queue.write_buffer(buffer, offset, bytes);
}

/// Calls `compile` for the kernels. Browsers compile them in threads of their own.
///
/// # Errors
///
/// Returns the errors of `compile`.
pub(crate) async fn compile<K>(kernels: Vec<K>, compile: impl AsyncFn(&[K]) -> Result<(), Error>) -> Result<(), Error> {
    compile(&kernels).await
}

/// Whether [`compile_beside`] does anything.
pub(crate) const COMPILES_BESIDE: bool = false;

/// Does nothing: a program may end while a driver compiles, and a driver that is unloaded then may crash.
pub(crate) fn compile_beside<K>(_: Vec<K>, _: impl AsyncFn(&[K]) -> Result<(), Error> + 'static) {}
