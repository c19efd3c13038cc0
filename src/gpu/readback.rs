//! Reading results back, through staging buffers that are reused.

use crate::{
    error::Error,
    gpu::{
        Gpu, Storage,
        device::ErrorScope,
        room::{fitted, with_room},
    },
    platform::{self, gpu::Report},
};
use bytemuck::Pod;
use futures_channel::oneshot;
use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, PoisonError},
};

/// How large arrays are read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    /// The bytes of a piece.
    piece: u64,
    /// The number of pieces that are on their way at a time.
    ahead: usize,
}

impl Pace {
    /// As soon as possible.
    pub(crate) const ALONE: Pace = Pace { piece: platform::gpu::PIECE, ahead: 4 };

    /// In small pieces, so that other results do not wait for long in between.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) const BESIDE: Pace = Pace { piece: 8 << 20, ahead: 2 };
}

/// A pool of staging buffers. Clones share it.
///
/// A readback has two halves, so that the next batch of commands can run while the host waits:
/// [`Readback::copy`] records it, [`Readback::receive`] waits for it after the submission.
#[derive(Debug, Clone, Default)]
pub struct Readback {
    idle: Arc<Mutex<Vec<wgpu::Buffer>>>,
    count: usize,
    bytes: u64,
}

/// A readback that is recorded.
#[derive(Debug)]
#[must_use = "a readback does nothing until it is received"]
pub struct Pending<T> {
    /// A piece of each part of the array.
    staged: Vec<Staged>,
    len: usize,
    elements: std::marker::PhantomData<T>,
}

impl<T> Pending<T> {
    /// Returns the number of elements that are received.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Returns the same readback, limited to the first `len` elements.
    pub(crate) fn first(self, len: usize) -> Self {
        Pending { len: self.len.min(len), ..self }
    }

    /// Returns this readback followed by `other`, which a later submission may contain.
    pub(crate) fn then(mut self, other: Self) -> Self {
        self.len += other.len;
        self.staged.extend(other.staged);
        self
    }
}

/// A staging buffer that is about to be mapped.
#[derive(Debug)]
struct Staged {
    staging: wgpu::Buffer,
    /// The bytes that are mapped, from the start.
    bytes: u64,
    mapped: oneshot::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

/// The destination of the bytes of a buffer.
pub trait Target {
    /// Returns the number of bytes, a multiple of 4.
    fn bytes(&self) -> u64;

    /// Takes `len` bytes from the start of `piece`, which belong at byte `start`.
    fn take(&mut self, start: u64, len: u64, piece: &wgpu::BufferView);
}

/// The source of bytes.
pub trait Source {
    /// Returns the buffer that has byte `at`, the place there, and how many bytes follow in it at most.
    fn place(&self, at: u64) -> (&wgpu::Buffer, u64, u64);
}

/// The device reports accesses beyond the end.
impl Source for &wgpu::Buffer {
    fn place(&self, at: u64) -> (&wgpu::Buffer, u64, u64) {
        (self, at, u64::MAX)
    }
}

impl<T: Pod> Source for Storage<T> {
    fn place(&self, at: u64) -> (&wgpu::Buffer, u64, u64) {
        Storage::place(self, at)
    }
}

/// Reads buffers from their starts, each as far as its target goes. They come in pieces: one is copied
/// out of its staging buffer while others are on their way.
#[must_use = "what is on its way has to be taken"]
pub(crate) struct Reading<S, T> {
    reads: Vec<(S, T)>,
    pace: Pace,
    /// The read that the next piece belongs to, and the start of the piece there.
    next: (usize, u64),
    /// The pieces that are on their way.
    ahead: VecDeque<Piece>,
}

/// A piece that is on its way.
struct Piece {
    /// Awaited with the piece, because the answer of an error scope takes a while in browsers.
    report: Report,
    submission: wgpu::SubmissionIndex,
    staged: Staged,
    read: usize,
    start: u64,
    len: u64,
}

impl<S: Source, T: Target> Reading<S, T> {
    /// Creates the reading of each source into its target.
    pub(crate) fn new(reads: Vec<(S, T)>, pace: Pace) -> Self {
        Reading { reads, pace, next: (0, 0), ahead: VecDeque::new() }
    }

    /// Sends pieces on their way until there are as many as the pace allows. Returns how many these are, each in a
    /// submission of its own.
    pub(crate) fn send(&mut self, gpu: &Gpu, readback: &mut Readback) -> usize {
        let mut sent = 0;
        while self.ahead.len() < self.pace.ahead
            && let Some((read, start, len)) = self.next_piece(self.pace.piece)
            && let Some((source, _)) = self.reads.get(read)
        {
            sent += 1;
            readback.count += 1;
            let scope = ErrorScope::open(gpu, "readback");
            let mut encoder = gpu.device().create_command_encoder(&Default::default());
            let (source, offset, _) = source.place(start);
            let staged = readback.stage(gpu, &mut encoder, source, offset, len);
            let submission = gpu.queue().submit([encoder.finish()]);
            self.ahead.push_back(Piece { report: scope.close(), submission, staged, read, start, len });
        }
        sent
    }

    /// Returns the read, the start and the length of the next piece, of at most so many bytes.
    fn next_piece(&mut self, most: u64) -> Option<(usize, u64, u64)> {
        loop {
            let (read, start) = self.next;
            let (source, target) = self.reads.get(read)?;
            let left = target.bytes() - start;
            let len = if left > 0 { most.min(left).min(source.place(start).2) } else { 0 };
            if len > 0 {
                self.next.1 += len;
                return Some((read, start, len));
            }
            self.next = (read + 1, 0);
        }
    }

    /// Returns the targets.
    pub(crate) fn targets(self) -> impl Iterator<Item = T> {
        self.reads.into_iter().map(|(_, target)| target)
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl Readback {
    /// Returns a pool that shares the staging buffers of this one, and counts for itself.
    pub(crate) fn fork(&self) -> Self {
        Readback { idle: Arc::clone(&self.idle), count: 0, bytes: 0 }
    }

    /// Adds what a fork has counted.
    pub(crate) fn add(&mut self, fork: &Self) {
        self.count += fork.count;
        self.bytes += fork.bytes;
    }
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
        self.count += 1;
        // In 64 bits, which `usize` need not have.
        let bytes_of = |elements: usize| (elements as u64 * size_of::<T>() as u64).next_multiple_of(4);
        let offset = start as u64 * size_of::<T>() as u64;
        let (mut staged, mut done) = (Vec::new(), 0);
        loop {
            let (buffer, at, left) = source.place(offset + done);
            let bytes = (bytes_of(len) - done).min(left);
            staged.push(self.stage(gpu, encoder, buffer, at, bytes));
            done += bytes;
            if bytes == 0 || done == bytes_of(len) {
                break;
            }
        }
        Pending { staged, len, elements: std::marker::PhantomData }
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
        self.receive_into(gpu, submission, pending, Vec::new()).await
    }

    /// Waits for a readback as [`Readback::receive`] does. The result replaces the contents of `list`, in its
    /// memory if there is enough.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    pub(crate) async fn receive_into<T: Pod>(
        &mut self,
        gpu: &Gpu,
        submission: &wgpu::SubmissionIndex,
        pending: Pending<T>,
        list: Vec<T>,
    ) -> Result<Vec<T>, Error> {
        let mut result = list;
        if result.capacity() < with_room(pending.len) {
            result = bytemuck::zeroed_vec(with_room(pending.len));
        }
        result.resize(pending.len, T::zeroed());
        let mut target: &mut [u8] = bytemuck::cast_slice_mut(&mut result);
        let mut done = 0;
        for piece in pending.staged {
            let take = |view: &wgpu::BufferView| {
                let bytes = (target.bytes() - done).min(view.len() as u64);
                target.take(done, bytes, view);
                done += bytes;
            };
            self.unstage(gpu, submission, piece, take).await?;
        }
        Ok(result)
    }

    /// Reads elements in a submission of its own, for tests and for results at the end of a run.
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

    /// Reads buffers from their starts, each as far as its target goes, in pieces.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`] and [`Gpu::with_error_scope`].
    pub async fn read_into<S: Source, T: Target>(&mut self, gpu: &Gpu, reads: Vec<(S, T)>) -> Result<Vec<T>, Error> {
        self.read_at(gpu, reads, Pace::ALONE).await
    }

    /// Does the same at this pace.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::read_into`].
    pub(crate) async fn read_at<S: Source, T: Target>(
        &mut self,
        gpu: &Gpu,
        reads: Vec<(S, T)>,
        pace: Pace,
    ) -> Result<Vec<T>, Error> {
        let mut reading = Reading::new(reads, pace);
        loop {
            reading.send(gpu, self);
            if !self.take(gpu, &mut reading).await? {
                return Ok(reading.targets().collect());
            }
        }
    }

    /// Waits for the first piece that is on its way, and takes it. Returns whether there was one.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::read_into`].
    pub(crate) async fn take<S: Source, T: Target>(
        &mut self,
        gpu: &Gpu,
        reading: &mut Reading<S, T>,
    ) -> Result<bool, Error> {
        let Some(Piece { report, submission, staged, read, start, len }) = reading.ahead.pop_front() else {
            return Ok(false);
        };
        report.await?;
        let take = |view: &wgpu::BufferView| {
            if let Some((_, target)) = reading.reads.get_mut(read) {
                target.take(start, len, view);
            }
        };
        self.unstage(gpu, &submission, staged, take).await?;
        Ok(true)
    }

    /// Reads the first `len` elements of two large arrays in pieces, into the memory of `rooms` as far as it
    /// suffices.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`] and [`Gpu::with_error_scope`].
    pub(crate) async fn read_arrays<T: Pod>(
        &mut self,
        gpu: &Gpu,
        arrays: &[Storage<T>; 2],
        rooms: [Vec<T>; 2],
        len: usize,
    ) -> Result<[Vec<T>; 2], Error> {
        let mut lists = rooms.map(|room| fitted(room, len));
        let targets = lists.iter_mut().map(|list| bytemuck::cast_slice_mut::<T, u8>(list));
        self.read_into(gpu, arrays.iter().cloned().zip(targets).collect()).await?;
        Ok(lists)
    }

    /// Returns how many readbacks were recorded.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns how many bytes were read back.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Records the copy of bytes from `offset` on into a staging buffer.
    fn stage(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        source: &wgpu::Buffer,
        offset: u64,
        bytes: u64,
    ) -> Staged {
        let mapped_bytes = bytes.max(4);
        let staging = self.staging(gpu, mapped_bytes);
        if bytes > 0 {
            encoder.copy_buffer_to_buffer(source, offset, &staging, 0, bytes);
        }
        let (sender, mapped) = oneshot::channel();
        encoder.map_buffer_on_submit(&staging, wgpu::MapMode::Read, ..mapped_bytes, move |result| {
            // The receiver may be gone when a run was cancelled.
            let _ = sender.send(result);
        });
        self.bytes += bytes;
        Staged { staging, bytes: mapped_bytes, mapped }
    }

    /// Waits for the copy that `submission` contains, has `take` look at the bytes, and keeps the
    /// staging buffer for later readbacks.
    async fn unstage<R>(
        &mut self,
        gpu: &Gpu,
        submission: &wgpu::SubmissionIndex,
        staged: Staged,
        take: impl FnOnce(&wgpu::BufferView) -> R,
    ) -> Result<R, Error> {
        let (staging, view) = arrived(gpu, submission, staged).await?;
        let result = take(&view);
        self.keep(staging, view);
        Ok(result)
    }

    /// Keeps a staging buffer for later readbacks.
    fn keep(&self, staging: wgpu::Buffer, view: wgpu::BufferView) {
        drop(view);
        staging.unmap();
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(staging);
    }

    /// Returns the smallest idle staging buffer of at least so many bytes, or a new one, a little larger for next
    /// time.
    fn staging(&mut self, gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let fitting = (0..idle.len()).filter(|&i| idle[i].size() >= bytes).min_by_key(|&i| idle[i].size());
        match fitting {
            Some(i) => idle.swap_remove(i),
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

/// Waits for the copy that `submission` contains. Returns the staging buffer with the bytes. It is
/// not generic, so that results of all types share its code.
async fn arrived(
    gpu: &Gpu,
    submission: &wgpu::SubmissionIndex,
    Staged { staging, bytes, mut mapped }: Staged,
) -> Result<(wgpu::Buffer, wgpu::BufferView), Error> {
    let mut early = None;
    let is_mapped = || {
        early = mapped.try_recv().transpose();
        early.is_some()
    };
    let waited = platform::gpu::wait(gpu.device(), gpu.adapter().software, submission, is_mapped);
    waited.map_err(|e| gpu.failure(&e.to_string()))?;
    let mapped = match early {
        Some(mapped) => mapped,
        None => mapped.await,
    };
    match mapped {
        Ok(Ok(())) => {}
        Ok(Err(e)) => return Err(gpu.failure(&e.to_string())),
        Err(oneshot::Canceled) => return Err(gpu.failure("a readback was never carried out")),
    }
    let view = staging.get_mapped_range(..bytes).map_err(|e| gpu.failure(&e.to_string()))?;
    Ok((staging, view))
}

/// Memory of the host. Threads share the copy: in fresh memory, most of the time goes into page faults.
impl Target for &mut [u8] {
    fn bytes(&self) -> u64 {
        self.len() as u64
    }

    fn take(&mut self, start: u64, len: u64, piece: &wgpu::BufferView) {
        platform::gpu::copy(piece, &mut self[start as usize..(start + len) as usize]);
    }
}
