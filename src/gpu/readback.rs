//! Reading results back, through staging buffers that are reused.

use bytemuck::Pod;
use futures_channel::oneshot;

use crate::error::Error;
use crate::gpu::{Gpu, Storage};
#[cfg(not(target_arch = "wasm32"))]
use crate::parallel::{Threads, for_chunks};

/// A pool of staging buffers.
///
/// A readback has two halves, so that the next batch of commands can run while the host waits:
/// [`Readback::copy`] records it, [`Readback::receive`] waits for it after the submission.
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
    /// The bytes that are mapped, from the start: the elements, and what lies behind them in
    /// `staging`, up to [`with_room`].
    mapped_bytes: u64,
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
        // In 64 bits, which `usize` need not have.
        let bytes_of = |elements: usize| (elements as u64 * size_of::<T>() as u64).next_multiple_of(4).max(4);
        let bytes = bytes_of(len);
        let bytes_with_room = bytes_of(with_room(len));
        let staging = self.staging(gpu, bytes, bytes_with_room);
        let mapped_bytes = bytes_with_room.min(staging.size());
        if len > 0 {
            let offset = start as u64 * size_of::<T>() as u64;
            encoder.copy_buffer_to_buffer(source.buffer(), offset, &staging, 0, bytes);
        }
        let (sender, mapped) = oneshot::channel();
        encoder.map_buffer_on_submit(&staging, wgpu::MapMode::Read, ..mapped_bytes, move |result| {
            // The receiver may be gone when a run was cancelled.
            let _ = sender.send(result);
        });
        self.count += 1;
        Pending { staging, len, mapped_bytes, mapped, elements: std::marker::PhantomData }
    }

    /// Waits for a readback that `submission` contains, and for no later one.
    ///
    /// # Errors
    ///
    /// Returns [`Error::DeviceLost`], or [`Error::Gpu`] when the device reports something else.
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
            let view = pending.staging.get_mapped_range(..pending.mapped_bytes);
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
    /// Returns the errors of [`Readback::receive`].
    pub async fn read<T: Pod>(
        &mut self,
        gpu: &Gpu,
        source: &Storage<T>,
        start: usize,
        len: usize,
    ) -> Result<Vec<T>, Error> {
        let (submission, pending) = gpu
            .with_error_scope("readback", || {
                let mut encoder = gpu.device().create_command_encoder(&Default::default());
                let pending = self.copy(gpu, &mut encoder, source, start, len);
                Ok((gpu.queue().submit([encoder.finish()]), pending))
            })
            .await?;
        self.receive(gpu, &submission, pending).await
    }

    /// Returns how many readbacks were recorded.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the smallest idle staging buffer of as many bytes, or a new one of at least
    /// `wanted`, a little larger for next time.
    fn staging(&mut self, gpu: &Gpu, bytes: u64, wanted: u64) -> wgpu::Buffer {
        let fitting =
            (0..self.idle.len()).filter(|&i| self.idle[i].size() >= bytes).min_by_key(|&i| self.idle[i].size());
        match fitting {
            Some(i) => self.idle.swap_remove(i),
            None => gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("staging"),
                size: wanted
                    .next_multiple_of((wanted.next_power_of_two() / 8).max(4))
                    .min(gpu.device().limits().max_buffer_size)
                    .max(bytes),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
        }
    }
}

/// Returns how many elements are given room when `len` are read, so that Phase 2 need not move the
/// whole to add a few tetrahedra.
fn with_room(len: usize) -> usize {
    len + len / 64
}

/// Copies `len` elements from the bytes of a mapped buffer. Most of the time goes into page faults
/// of fresh memory, so threads share the work.
#[cfg(not(target_arch = "wasm32"))]
fn copied<T: Pod>(view: &wgpu::BufferView, len: usize) -> Vec<T> {
    let mut result = bytemuck::zeroed_vec(with_room(len));
    result.truncate(len);
    let target: &mut [u8] = bytemuck::cast_slice_mut(&mut result);
    let bytes = &view[..target.len()];
    for_chunks(Threads::All, target, |start, chunk| {
        chunk.copy_from_slice(&bytes[start..start + chunk.len()]);
    });
    result
}

/// Copies `len` elements from the bytes of a mapped buffer, which lie outside of the memory of
/// wasm: to look at them as a slice would copy them once more. The room is copied along, since to
/// fill it, and the rest, with zeros before takes as long as to copy.
#[cfg(target_arch = "wasm32")]
fn copied<T: Pod>(view: &wgpu::BufferView, len: usize) -> Vec<T> {
    let bytes = view.as_uint8array();
    let words = js_sys::Uint32Array::new_with_byte_offset_and_length(
        &bytes.buffer(),
        bytes.byte_offset(),
        bytes.byte_length() / 4,
    );
    let cast = bytemuck::allocation::try_cast_vec(words.to_vec());
    let mut result: Vec<T> = cast.unwrap_or_else(|(_, words)| bytemuck::allocation::pod_collect_to_vec(&words));
    result.truncate(len);
    result
}
