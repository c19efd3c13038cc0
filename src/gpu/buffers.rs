//! Typed storage buffers.

use std::marker::PhantomData;

use bytemuck::Pod;

use crate::error::Error;
use crate::gpu::{Binding, Gpu, Parts};
use crate::platform;

/// A storage buffer of `T`, which kernels see as `array<T>`.
///
/// It can be copied from and to. Its contents are zero until they are written.
#[derive(Debug, Clone)]
pub struct Storage<T> {
    buffer: wgpu::Buffer,
    /// The buffers of an array in parts, after the first.
    more: Vec<wgpu::Buffer>,
    label: &'static str,
    len: usize,
    elements: PhantomData<T>,
}

/// The name of an array in shaders, its first buffer, and the others.
pub(crate) type Named<'a> = (&'static str, &'a wgpu::Buffer, &'a [wgpu::Buffer]);

/// Appends the bindings of these arrays.
pub(crate) fn append_bindings<'a>(bindings: &mut Vec<Binding<'a>>, arrays: &[Named<'a>]) {
    for &(name, first, more) in arrays {
        bindings.push((name, first));
        bindings.extend(more.iter().map(|buffer| (name, buffer)));
    }
}

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

    /// Creates an array that is in parts, if they are given, and otherwise in one buffer.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`] if there are too few parts, and those of [`Storage::new`].
    pub(crate) fn in_parts(gpu: &Gpu, label: &'static str, len: usize, parts: Option<Parts>) -> Result<Self, Error> {
        let Some(parts) = parts else { return Self::new(gpu, label, len) };
        let per_part = usize::try_from(parts.bytes()).unwrap_or(usize::MAX) / size_of::<T>();
        if len.div_ceil(per_part) as u64 > parts.limit() / parts.bytes() {
            let bytes = len as u128 * size_of::<T>() as u128;
            return Err(Error::BufferTooLarge { label, bytes, limit: parts.limit(), points: None });
        }
        let mut storage = Self::new(gpu, label, len.min(per_part))?;
        while storage.len < len {
            let part = Self::new(gpu, label, (len - storage.len).min(per_part))?;
            storage.len += part.len;
            storage.more.push(part.buffer);
        }
        Ok(storage)
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
        // Mapping the buffer at its creation would fill it with zeros first.
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
        let buffer = gpu.device().create_buffer(&descriptor);
        Ok(Storage { buffer, more: Vec::new(), label, len, elements: PhantomData })
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
        self.record_copy(encoder, 0, &larger, 0, self.bytes());
        *self = larger;
        Ok(())
    }

    /// Writes `contents` at element `start`, before the commands of the next submission.
    pub fn write(&self, gpu: &Gpu, start: usize, contents: &[T]) {
        let mut at = (start * size_of::<T>()) as u64;
        let mut bytes: &[u8] = bytemuck::cast_slice(contents);
        while !bytes.is_empty() {
            let (buffer, offset, left) = self.place(at);
            let (part, rest) = bytes.split_at(bytes.len().min(left as usize));
            platform::gpu::write(gpu.queue(), buffer, offset, part);
            (at, bytes) = (at + part.len() as u64, rest);
        }
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
        self.buffers().map(wgpu::Buffer::size).sum()
    }

    /// Returns the same buffer as elements of another type.
    pub fn cast<U: Pod>(&self) -> Storage<U> {
        let len = self.len * size_of::<T>() / size_of::<U>();
        let (buffer, more) = (self.buffer.clone(), self.more.clone());
        Storage { buffer, more, label: self.label, len, elements: PhantomData }
    }

    /// Returns the buffer, or the first one of an array in parts.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Returns the buffers of the parts, or the only one.
    pub(crate) fn buffers(&self) -> impl Iterator<Item = &wgpu::Buffer> {
        std::iter::once(&self.buffer).chain(&self.more)
    }

    /// Returns the name that the array has in shaders, with the buffers of the parts, or the only one,
    /// for [`append_bindings`].
    pub(crate) fn named(&self, name: &'static str) -> Named<'_> {
        (name, &self.buffer, &self.more)
    }

    /// Returns the buffer that has byte `at`, the place there, and how many bytes follow in it.
    pub(crate) fn place(&self, mut at: u64) -> (&wgpu::Buffer, u64, u64) {
        let mut buffer = &self.buffer;
        for next in &self.more {
            if at < buffer.size() {
                break;
            }
            at -= buffer.size();
            buffer = next;
        }
        (buffer, at, buffer.size() - at)
    }

    /// Records that all elements are set to zero.
    pub(crate) fn record_clear(&self, encoder: &mut wgpu::CommandEncoder) {
        self.buffers().for_each(|buffer| encoder.clear_buffer(buffer, 0, None));
    }

    /// Records a copy of so many bytes, from byte `from` of this array to byte `to` of `target`.
    pub(crate) fn record_copy(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        from: u64,
        target: &Storage<T>,
        to: u64,
        bytes: u64,
    ) {
        let mut done = 0;
        while done < bytes {
            let (source, source_at, source_left) = self.place(from + done);
            let (destination, at, left) = target.place(to + done);
            let copied = (bytes - done).min(source_left).min(left);
            encoder.copy_buffer_to_buffer(source, source_at, destination, at, copied);
            done += copied;
        }
    }
}
