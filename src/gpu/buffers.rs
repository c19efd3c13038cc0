//! Typed storage buffers.

use std::marker::PhantomData;

use bytemuck::Pod;

use crate::error::Error;
use crate::gpu::Gpu;
#[cfg(not(target_arch = "wasm32"))]
use crate::parallel::{Threads, for_parts};

/// A storage buffer of `T`, which kernels see as `array<T>`.
///
/// It can be copied from and to. Its contents are zero until they are written.
#[derive(Debug, Clone)]
pub struct Storage<T> {
    buffer: wgpu::Buffer,
    label: &'static str,
    len: usize,
    elements: PhantomData<T>,
}

/// Of more bytes than these, several threads write a part each.
#[cfg(not(target_arch = "wasm32"))]
const MANY_BYTES: usize = 1 << 20;
/// The bytes that are written at a time.
#[cfg(not(target_arch = "wasm32"))]
const PART: usize = 1 << 12;

/// The size of a buffer without elements.
const EMPTY_BYTES: u128 = 16;

const USAGES: wgpu::BufferUsages =
    wgpu::BufferUsages::STORAGE.union(wgpu::BufferUsages::COPY_SRC).union(wgpu::BufferUsages::COPY_DST);

impl<T: Pod> Storage<T> {
    /// Creates a buffer of `len` elements; of 16 bytes when `len` is 0, because an empty buffer
    /// cannot be bound, and no element in a shader is larger.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`] if the device cannot bind that much.
    /// [`Gpu::with_error_scope`] reports a lack of memory.
    pub fn new(gpu: &Gpu, label: &'static str, len: usize) -> Result<Self, Error> {
        Self::create(gpu, label, len, USAGES)
    }

    /// Creates a buffer that can also be drawn from, for an array that the caller gets.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub(crate) fn for_caller(gpu: &Gpu, label: &'static str, len: usize) -> Result<Self, Error> {
        Self::create(gpu, label, len, USAGES | wgpu::BufferUsages::INDEX | wgpu::BufferUsages::VERTEX)
    }

    /// Creates a buffer that timestamps are written to.
    pub(crate) fn for_queries(gpu: &Gpu, label: &'static str, len: usize) -> Result<Self, Error> {
        Self::create(gpu, label, len, USAGES | wgpu::BufferUsages::QUERY_RESOLVE)
    }

    /// Creates a buffer that holds `contents`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub fn with_contents(gpu: &Gpu, label: &'static str, contents: &[T]) -> Result<Self, Error> {
        if contents.is_empty() {
            return Self::new(gpu, label, 0);
        }
        // A buffer that is mapped at its creation would be filled with zeros before.
        let storage = Self::new(gpu, label, contents.len())?;
        storage.write(gpu, 0, contents);
        Ok(storage)
    }

    fn create(gpu: &Gpu, label: &'static str, len: usize, usage: wgpu::BufferUsages) -> Result<Self, Error> {
        let limit = gpu.max_storage_bytes();
        // In 128 bits no length overflows. Sizes are multiples of 4, as copies need.
        let bytes = match len {
            0 => EMPTY_BYTES,
            _ => (len as u128 * size_of::<T>() as u128).next_multiple_of(4),
        };
        let size = u64::try_from(bytes).ok().filter(|&size| size <= limit).ok_or(Error::BufferTooLarge {
            label,
            bytes,
            limit,
            points: None,
        })?;
        let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        Ok(Storage { buffer: gpu.device().create_buffer(&descriptor), label, len, elements: PhantomData })
    }

    /// Makes room for `len` elements: at least half as many again as there are now, if the device
    /// can bind them, so that growing step by step costs no more than a constant number of copies
    /// of each element. The first elements are copied by a command in `encoder`; bind groups of the
    /// old buffer must be created again.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`]; the buffer is unchanged then.
    pub fn grow(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, len: usize) -> Result<(), Error> {
        if len <= self.len {
            return Ok(());
        }
        let bindable = usize::try_from(gpu.max_storage_bytes()).unwrap_or(usize::MAX) / size_of::<T>().max(1);
        let amortised = self.len.saturating_add(self.len / 2).min(bindable);
        let larger = Self::new(gpu, self.label, len.max(amortised))?;
        encoder.copy_buffer_to_buffer(&self.buffer, 0, &larger.buffer, 0, self.buffer.size());
        *self = larger;
        Ok(())
    }

    /// Writes `contents` at element `start`, before the commands of the next submission.
    pub fn write(&self, gpu: &Gpu, start: usize, contents: &[T]) {
        let offset = (start * size_of::<T>()) as u64;
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        #[cfg(not(target_arch = "wasm32"))]
        if bytes.len() > MANY_BYTES {
            // Most of the time goes into page faults, since the memory that the device reads is
            // fresh each time, so threads share the work.
            let size = std::num::NonZero::new(bytes.len() as u64);
            let view = size.and_then(|size| gpu.queue().write_buffer_with(&self.buffer, offset, size));
            // Without a view, the size or the place are wrong, and the device has reported that.
            if let Some(mut view) = view {
                let (parts, rest) = bytes.as_chunks::<PART>();
                let (targets, mut target_of_rest) = view.slice(..).into_chunks::<PART>();
                target_of_rest.copy_from_slice(rest);
                let mut copies: Vec<_> = targets.into_iter().zip(parts).map(Some).collect();
                for_parts(Threads::All, &mut copies, |_, copies| {
                    copies.iter_mut().filter_map(Option::take).for_each(|(target, part)| target.write(*part));
                });
            }
            return;
        }
        gpu.queue().write_buffer(&self.buffer, offset, bytes);
    }

    /// Returns the number of elements.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Returns the size on the device, in bytes.
    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }

    /// Returns the same buffer as elements of another type.
    pub fn cast<U: Pod>(&self) -> Storage<U> {
        let len = self.len * size_of::<T>() / size_of::<U>();
        Storage { buffer: self.buffer.clone(), label: self.label, len, elements: PhantomData }
    }

    /// Returns the buffer.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }
}
