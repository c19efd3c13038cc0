//! Reading results back, through staging buffers that are used again.

use bytemuck::Pod;
use futures_channel::oneshot;

use super::{Gpu, Storage};
use crate::Error;

/// A pool of staging buffers.
///
/// A readback has two halves, so that the next batch of commands can run while the host waits: [`Readback::copy`]
/// records it, [`Readback::receive`] waits for it after the submission.
#[derive(Debug, Default)]
pub struct Readback {
    idle: Vec<wgpu::Buffer>,
    count: usize,
}

/// A readback that is recorded.
#[derive(Debug)]
#[must_use = "a readback does nothing until it is received"]
pub struct Pending<T> {
    staging: wgpu::Buffer,
    len: usize,
    mapped: oneshot::Receiver<Result<(), wgpu::BufferAsyncError>>,
    elements: std::marker::PhantomData<T>,
}

impl Readback {
    /// Records the copy of `len` elements of `source`, from element `start`, into a staging buffer.
    pub fn copy<T: Pod>(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        source: &Storage<T>,
        start: usize,
        len: usize,
    ) -> Pending<T> {
        let bytes = ((len * size_of::<T>()) as u64).next_multiple_of(4).max(4);
        let staging = self.staging(gpu, bytes);
        if len > 0 {
            let offset = (start * size_of::<T>()) as u64;
            encoder.copy_buffer_to_buffer(source.buffer(), offset, &staging, 0, bytes);
        }
        let (sender, mapped) = oneshot::channel();
        encoder.map_buffer_on_submit(&staging, wgpu::MapMode::Read, ..bytes, move |result| {
            // The receiver may be gone when a run was cancelled.
            let _ = sender.send(result);
        });
        self.count += 1;
        Pending { staging, len, mapped, elements: std::marker::PhantomData }
    }

    /// Waits for a readback that `submission` contains, and for no later one.
    ///
    /// # Errors
    ///
    /// [`Error::DeviceLost`], or [`Error::Gpu`] when the device reports something else.
    pub async fn receive<T: Pod>(
        &mut self,
        gpu: &Gpu,
        submission: &wgpu::SubmissionIndex,
        pending: Pending<T>,
    ) -> Result<Vec<T>, Error> {
        // Browsers call back by themselves and ignore this.
        let wait = wgpu::PollType::Wait { submission_index: Some(submission.clone()), timeout: None };
        gpu.device().poll(wait).map_err(|e| gpu.failure(&e.to_string()))?;
        match pending.mapped.await {
            Ok(Ok(())) => {}
            Ok(Err(e)) => return Err(gpu.failure(&e.to_string())),
            Err(oneshot::Canceled) => return Err(gpu.failure("a readback was never carried out")),
        }
        let result = if pending.len == 0 {
            Vec::new()
        } else {
            let bytes = (pending.len * size_of::<T>()) as u64;
            let view = pending.staging.get_mapped_range(..bytes.next_multiple_of(4));
            let view = view.map_err(|e| gpu.failure(&e.to_string()))?;
            copied(&view, pending.len)
        };
        pending.staging.unmap();
        self.idle.push(pending.staging);
        Ok(result)
    }

    /// Reads elements now: a submission of its own, for tests and for results at the end of a run.
    ///
    /// # Errors
    ///
    /// As [`Readback::receive`].
    pub async fn read<T: Pod>(
        &mut self,
        gpu: &Gpu,
        source: &Storage<T>,
        start: usize,
        len: usize,
    ) -> Result<Vec<T>, Error> {
        let (submission, pending) = gpu
            .catching("readback", || {
                let mut encoder = gpu.device().create_command_encoder(&Default::default());
                let pending = self.copy(gpu, &mut encoder, source, start, len);
                Ok((gpu.queue().submit([encoder.finish()]), pending))
            })
            .await?;
        self.receive(gpu, &submission, pending).await
    }

    /// How many readbacks were recorded.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The smallest idle staging buffer that is large enough, or a new one, a little larger for next time.
    fn staging(&mut self, gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
        let fitting =
            (0..self.idle.len()).filter(|&i| self.idle[i].size() >= bytes).min_by_key(|&i| self.idle[i].size());
        match fitting {
            Some(i) => self.idle.swap_remove(i),
            None => gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("staging"),
                size: bytes
                    .next_multiple_of((bytes.next_power_of_two() / 8).max(4))
                    .min(gpu.device().limits().max_buffer_size)
                    .max(bytes),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
        }
    }
}

/// `len` elements from the bytes of a mapped buffer. Pages of fresh memory are what takes long here, so threads share them.
#[cfg(not(target_arch = "wasm32"))]
fn copied<T: Pod>(view: &wgpu::BufferView, len: usize) -> Vec<T> {
    let mut result: Vec<T> = bytemuck::zeroed_vec(len);
    let target: &mut [u8] = bytemuck::cast_slice_mut(&mut result);
    let bytes = &view[..target.len()];
    crate::parallel::for_chunks(crate::parallel::available(), target, |start, chunk| {
        chunk.copy_from_slice(&bytes[start..start + chunk.len()]);
    });
    result
}

/// `len` elements from the bytes of a mapped buffer, which lie outside of the memory of wasm: to look at them as a slice
/// would copy them once more.
#[cfg(target_arch = "wasm32")]
fn copied<T: Pod>(view: &wgpu::BufferView, len: usize) -> Vec<T> {
    let mut result: Vec<T> = bytemuck::zeroed_vec(len);
    let target: &mut [u8] = bytemuck::cast_slice_mut(&mut result);
    view.as_uint8array().subarray(0, target.len() as u32).copy_to(target);
    result
}
