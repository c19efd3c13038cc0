//! How the host and a device exchange data in browsers.

use crate::error::Error;
use futures_channel::oneshot;
use std::pin::Pin;

/// What an error scope reports.
pub(crate) type Report = Pin<Box<dyn Future<Output = Result<(), Error>>>>;

/// Returns `report`, which takes browsers a while.
pub(crate) fn report(report: impl Future<Output = Result<(), Error>> + 'static) -> Report {
    Box::pin(report)
}

/// The bytes of a piece of a large array that is read: so few that a copy never holds up the calling thread for long.
pub(crate) const PIECE: u64 = 8 << 20;

/// How many points the rounds insert that are submitted together: browsers take a millisecond to hand over counters, in which
/// a fast device inserts about as many.
pub(crate) const INSERTED_TOGETHER: u32 = 1 << 16;

/// Does nothing: browsers report by themselves what the device has carried out.
///
/// # Errors
///
/// Returns none.
pub fn wait(
    _: &wgpu::Device,
    _: bool,
    _: &wgpu::SubmissionIndex,
    _: impl FnMut() -> bool,
) -> Result<(), wgpu::PollError> {
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

/// What the engines take where nothing was measured, in 3D and in 2D: nanoseconds per point of the CPU engine; milliseconds
/// and nanoseconds per point of the GPU engine. Measured in Chromium on one NVIDIA H200 and the Xeon beside it (2026-11-28),
/// but for the milliseconds, which are 15 in 3D there: other devices take longer.
pub(crate) const PRIORS: [(f64, [f64; 2]); 2] = [(4200.0, [24.4, 130.0]), (900.0, [24.0, 90.0])];

/// The milliseconds that it takes to compile the kernels, in 3D and in 2D, in the same place.
pub(crate) const OPENING: [f64; 2] = [1000.0, 600.0];

/// Work that goes on beside other work.
#[derive(Debug)]
pub(crate) struct Task<T> {
    result: oneshot::Receiver<T>,
    early: Option<T>,
}

impl<T: 'static> Task<T> {
    /// Begins the work.
    pub(crate) async fn begin(work: impl Future<Output = T> + 'static) -> Self {
        let (sender, result) = oneshot::channel();
        wasm_bindgen_futures::spawn_local(async move {
            // Nobody may wait for it any more.
            _ = sender.send(work.await);
        });
        Task { result, early: None }
    }

    /// Returns whether the result is there.
    pub(crate) fn is_done(&mut self) -> bool {
        if self.early.is_none() {
            self.early = self.result.try_recv().ok().flatten();
        }
        self.early.is_some()
    }

    /// Waits for the result.
    pub(crate) async fn result(self) -> T {
        match self.early {
            Some(result) => result,
            None => self.result.await.expect("the work is never dropped before it is done"),
        }
    }
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
