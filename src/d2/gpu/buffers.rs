//! The buffers of a run in the plane.

use crate::d2::gpu::layout::{EdgeFlip, blocks};
use crate::{
    Error,
    gpu::{
        Binding, Gpu, Recorder, Storage,
        layout::{Active, BLOCK, COUNTER_WORDS, PARAM_WORDS, Status, Waiting},
        points::DevicePoints,
    },
};

/// The buffers that the stages share; [`layout`](crate::d2::gpu::layout) explains them.
///
/// A point takes about 280 bytes beside those of its coordinates and their sorting: 2 slots of 96 bytes each, 2 nodes of
/// the history of 24, and some words.
#[derive(Debug, Clone)]
pub struct Buffers {
    /// Parameters and counters.
    pub control: Storage<u32>,
    /// The vertices, and the interior point; the order; what stands for what.
    pub points: DevicePoints,
    /// The vertices of each slot, and 0.
    pub triangles: Storage<[u32; 4]>,
    /// The neighbours of each slot, and 0.
    pub neighbors: Storage<[u32; 4]>,
    /// The status of each slot; half-edges of the answer in the end.
    pub status: Storage<Status>,
    /// Both halves of the active list; questions in the end.
    pub active: Storage<Active>,
    /// Messages of a flip iteration; scores and points while they are picked; triangles of the answer in the end.
    pub messages: Storage<[u32; 4]>,
    /// The flips of a round.
    pub history: Storage<EdgeFlip>,
    /// The list of waiting points; the hull's edges in the end.
    pub waiting: Storage<Waiting>,
    /// Scores of the waiting points.
    pub scores: Storage<u32>,
    /// Whether each slot has a triangle of the answer.
    pub marks: Storage<u32>,
    /// The number of each slot's triangle in the answer.
    pub offsets: Storage<u32>,
}

impl Buffers {
    /// Buffers for these points.
    ///
    /// # Errors
    ///
    /// [`Error::BufferTooLarge`].
    pub fn new(gpu: &Gpu, points: DevicePoints, history: u32) -> Result<Self, Error> {
        let count = points.pairs.len();
        let slots = (blocks(count as u32) * BLOCK) as usize;
        Ok(Buffers {
            control: Storage::new(gpu, "control", PARAM_WORDS + COUNTER_WORDS)?,
            triangles: Storage::new(gpu, "triangles", slots)?,
            neighbors: Storage::new(gpu, "neighbours", slots)?,
            status: Storage::new(gpu, "status", slots)?,
            active: Storage::new(gpu, "active list", 2 * slots)?,
            messages: Storage::new(gpu, "messages", slots)?,
            history: Storage::new(gpu, "history", history as usize)?,
            waiting: Storage::new(gpu, "waiting points", count)?,
            scores: Storage::new(gpu, "scores", count)?,
            marks: Storage::new(gpu, "marks", slots)?,
            offsets: Storage::new(gpu, "offsets", slots)?,
            points,
        })
    }

    /// Records that what must be zero in the beginning is: slots without triangles, and their status.
    pub fn record_clear(&self, recorder: &mut Recorder<'_>) {
        let encoder = recorder.encoder();
        encoder.clear_buffer(self.triangles.buffer(), 0, None);
        encoder.clear_buffer(self.status.buffer(), 0, None);
    }

    /// Returns the buffers under the names that they have in shaders: several, where a buffer is put to more than one use.
    pub fn bindings(&self) -> Vec<Binding<'_>> {
        vec![
            ("control", self.control.buffer()),
            ("vertices", self.points.vertices.buffer()),
            ("pairs", self.points.pairs.buffer()),
            ("counts", self.points.counts.buffer()),
            ("simplices", self.triangles.buffer()),
            ("neighbors", self.neighbors.buffer()),
            ("status", self.status.buffer()),
            ("actives", self.active.buffer()),
            ("messages", self.messages.buffer()),
            ("picks", self.messages.buffer()),
            ("mesh_triangles", self.messages.buffer()),
            ("halfedges", self.status.buffer()),
            ("uncertain_tests", self.active.buffer()),
            ("history", self.history.buffer()),
            ("waiting", self.waiting.buffer()),
            ("hull", self.waiting.buffer()),
            ("scores", self.scores.buffer()),
            ("marks", self.marks.buffer()),
            ("offsets", self.offsets.buffer()),
        ]
    }

    /// The bytes that they take, but for the points.
    pub fn bytes(&self) -> u64 {
        let slots = self.triangles.bytes() + self.neighbors.bytes() + self.status.bytes() + self.active.bytes();
        let more = self.messages.bytes() + self.marks.bytes() + self.offsets.bytes();
        slots + more + self.control.bytes() + self.history.bytes() + self.waiting.bytes() + self.scores.bytes()
    }
}
