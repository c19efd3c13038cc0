//! The buffers of Phase 1 on the device.

use crate::{
    Error,
    gpu::{
        Binding, Gpu, Recorder, Storage,
        layout::{Active, BLOCK, COUNTER_WORDS, FlipNode, PARAM_WORDS, Status, Waiting},
        points::DevicePoints,
    },
};

/// The buffers that the stages share; [`layout`](crate::gpu::layout) explains them.
///
/// A point takes about 950 bytes: 8.5 slots of 80 bytes each, 4 nodes of the history of 48, and some words a point.
#[derive(Debug, Clone)]
pub struct Buffers {
    /// Parameters and counters.
    pub control: Storage<u32>,
    /// The vertices, and the interior point; the order; what stands for what.
    pub points: DevicePoints,
    /// The vertices of each slot.
    pub tets: Storage<[u32; 4]>,
    /// The neighbours of each slot.
    pub neighbors: Storage<[u32; 4]>,
    /// The status of each slot.
    pub status: Storage<Status>,
    /// Both halves of the active list.
    pub active: Storage<Active>,
    /// The free slots of each block.
    pub free: Storage<u32>,
    /// Messages of a flip iteration; scores and points while they are picked.
    pub messages: Storage<[u32; 4]>,
    /// The flips of a round.
    pub history: Storage<FlipNode>,
    /// The list of waiting points.
    pub waiting: Storage<Waiting>,
    /// Scores of the waiting points.
    pub scores: Storage<u32>,
    /// Whether each vertex failed.
    pub failed: Storage<u32>,
}

/// The bytes of the largest of the buffers: with 16 bytes a slot, several have this size, and no other is larger.
pub(crate) fn largest_bytes(blocks: u32) -> u128 {
    u128::from(blocks) * u128::from(BLOCK) * size_of::<[u32; 4]>() as u128
}

impl Buffers {
    /// Buffers for these points.
    ///
    /// # Errors
    ///
    /// [`Error::BufferTooLarge`].
    pub fn new(gpu: &Gpu, points: DevicePoints, blocks: u32, history: u32) -> Result<Self, Error> {
        let count = points.pairs.len();
        let slots = blocks as usize * BLOCK as usize;
        Ok(Buffers {
            control: Storage::new(gpu, "control", PARAM_WORDS + COUNTER_WORDS)?,
            tets: Storage::new(gpu, "tetrahedra", slots)?,
            neighbors: Storage::new(gpu, "neighbours", slots)?,
            status: Storage::new(gpu, "status", slots)?,
            active: Storage::new(gpu, "active list", 2 * slots)?,
            free: Storage::new(gpu, "free slots", blocks as usize)?,
            messages: Storage::new(gpu, "messages", slots)?,
            history: Storage::new(gpu, "history", history as usize)?,
            waiting: Storage::new(gpu, "waiting points", count)?,
            scores: Storage::new(gpu, "scores", count)?,
            failed: Storage::new(gpu, "failed vertices", count)?,
            points,
        })
    }

    /// Larger buffers with the same contents, for `blocks` blocks. New slots are zero; the caller frees them.
    ///
    /// # Errors
    ///
    /// [`Error::BufferTooLarge`].
    pub fn with_blocks(&self, gpu: &Gpu, recorder: &mut Recorder<'_>, blocks: u32) -> Result<Self, Error> {
        let slots = blocks as usize * BLOCK as usize;
        let old_half = self.active.bytes() / 2;
        let mut larger = self.clone();
        larger.messages = Storage::new(gpu, "messages", slots)?;
        larger.tets = Storage::new(gpu, "tetrahedra", slots)?;
        larger.neighbors = Storage::new(gpu, "neighbours", slots)?;
        larger.status = Storage::new(gpu, "status", slots)?;
        larger.active = Storage::new(gpu, "active list", 2 * slots)?;
        larger.free = Storage::new(gpu, "free slots", blocks as usize)?;
        let encoder = recorder.encoder();
        let mut copy = |from: &wgpu::Buffer, at: u64, to: &wgpu::Buffer, start: u64, bytes: u64| {
            encoder.copy_buffer_to_buffer(from, at, to, start, bytes);
        };
        copy(self.tets.buffer(), 0, larger.tets.buffer(), 0, self.tets.bytes());
        copy(self.neighbors.buffer(), 0, larger.neighbors.buffer(), 0, self.neighbors.bytes());
        copy(self.status.buffer(), 0, larger.status.buffer(), 0, self.status.bytes());
        copy(self.free.buffer(), 0, larger.free.buffer(), 0, self.free.bytes());
        copy(self.active.buffer(), 0, larger.active.buffer(), 0, old_half);
        copy(self.active.buffer(), old_half, larger.active.buffer(), larger.active.bytes() / 2, old_half);
        Ok(larger)
    }

    /// Records that what must be zero in the beginning is: slots without tetrahedra, their status, no failed vertices.
    pub fn record_clear(&self, recorder: &mut Recorder<'_>) {
        let encoder = recorder.encoder();
        encoder.clear_buffer(self.tets.buffer(), 0, None);
        encoder.clear_buffer(self.status.buffer(), 0, None);
        encoder.clear_buffer(self.failed.buffer(), 0, None);
    }

    /// Returns the buffers under the names that they have in shaders: several, where a buffer is put to more than one use.
    pub fn bindings(&self) -> Vec<Binding<'_>> {
        vec![
            ("control", self.control.buffer()),
            ("vertices", self.points.vertices.buffer()),
            ("pairs", self.points.pairs.buffer()),
            ("counts", self.points.counts.buffer()),
            ("simplices", self.tets.buffer()),
            ("neighbors", self.neighbors.buffer()),
            ("status", self.status.buffer()),
            ("actives", self.active.buffer()),
            ("free", self.free.buffer()),
            ("messages", self.messages.buffer()),
            ("picks", self.messages.buffer()),
            ("undecided_entries", self.messages.buffer()),
            ("history", self.history.buffer()),
            ("waiting", self.waiting.buffer()),
            ("scores", self.scores.buffer()),
            ("failed", self.failed.buffer()),
        ]
    }

    /// The bytes that they take, but for the points.
    pub fn bytes(&self) -> u64 {
        let Buffers {
            control,
            points: _,
            tets,
            neighbors,
            status,
            active,
            free,
            messages,
            history,
            waiting,
            scores,
            failed,
        } = self;
        let words = control.bytes() + free.bytes() + waiting.bytes() + scores.bytes() + failed.bytes();
        let slots = tets.bytes() + neighbors.bytes() + status.bytes() + active.bytes() + messages.bytes();
        words + slots + history.bytes()
    }
}
