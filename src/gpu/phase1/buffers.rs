//! The buffers of Phase 1 on the device.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Binding, Gpu, Parts, Recorder, Storage, append_bindings,
        dim::{Dim, Flip, OwnBuffers},
        layout::{Active, BLOCK, FREE_START, PARAM_WORDS, Status, Waiting},
        points::DevicePoints,
    },
};

/// The words of a slot: the vertices of a tetrahedron, or those of a triangle and 0.
pub type Slot = [u32; 4];

/// The buffers that the stages share; [`layout`](crate::gpu::layout) explains them.
///
/// Besides its coordinates and their sorting, a point takes about 1,050 bytes in 3D: 8.5 slots of 96
/// bytes each, 4 nodes of the history of 48, and some words. In 2D it takes about 250 bytes: 2
/// slots of 88 bytes each, 2 nodes of the history of 24, and some words.
#[derive(Debug, Clone)]
pub struct Buffers<const D: usize>
where
    Dimension<D>: Dim<D>,
{
    /// Parameters and counters, and in 3D the free slots of each block.
    pub control: Storage<u32>,
    /// The vertices, and the interior point; the order; what is merged into what.
    pub points: DevicePoints,
    /// The vertices of each slot.
    pub simplices: Storage<Slot>,
    /// The neighbours of each slot.
    pub neighbors: Storage<Slot>,
    /// The status of each slot.
    pub status: Storage<Status>,
    /// Both halves of the active list.
    pub active: Storage<Active>,
    /// Messages of a flip iteration; scores and points while they are picked.
    pub messages: Storage<Slot>,
    /// The flips of a round.
    pub history: Storage<Flip<D>>,
    /// The points that wait to be inserted.
    pub waiting: WaitingBuffers,
    /// What Phase 1 starts with.
    pub start: StartBuffers,
    /// The order of the simplices in the mesh, at the end.
    pub numbering: NumberingBuffers,
    /// The buffers that only this dimension has.
    pub own: <Dimension<D> as Dim<D>>::OwnBuffers,
}

/// The points that wait to be inserted.
#[derive(Debug, Clone)]
pub struct WaitingBuffers {
    /// Both halves of the list.
    pub list: Storage<Waiting>,
    /// The score of each entry.
    pub scores: Storage<u32>,
}

/// The triangulation of some of the points, as [`StartMesh`](crate::gpu::start::StartMesh) has it.
#[derive(Debug, Clone)]
pub struct StartBuffers {
    /// The points, each with one of its simplices.
    pub points: Storage<[u32; 2]>,
    /// The simplices: corners and neighbours.
    pub simplices: Storage<[Slot; 2]>,
    /// The vertices that the points are.
    pub vertices: Storage<u32>,
    /// For each stretch of vertices the slot of a simplex nearby, plus 1, or 0.
    pub near: Storage<u32>,
}

/// The order of the simplices in the mesh.
#[derive(Debug, Clone)]
pub struct NumberingBuffers {
    /// 1 for each slot with a simplex of the mesh, and 0 for the others.
    pub marks: Storage<u32>,
    /// The number of each slot's simplex.
    pub numbers: Storage<u32>,
}

/// How large the buffers of a run are, beside what follows from the number of its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// The blocks of slots.
    pub blocks: u32,
    /// The nodes of the history.
    pub history: u32,
    /// The points that the CPU engine triangulates first, at most.
    pub start_points: usize,
    /// The parts of the large arrays, if they are in parts.
    pub parts: Option<Parts>,
}

/// Returns the bytes of the largest of the buffers: with 16 bytes per slot, several have this size,
/// and no other is larger.
pub(crate) fn largest_bytes(blocks: u32) -> u128 {
    u128::from(blocks) * u128::from(BLOCK) * size_of::<Slot>() as u128
}

/// Returns the slots of so many blocks.
fn slots(blocks: u32) -> usize {
    blocks as usize * BLOCK as usize
}

impl<const D: usize> Buffers<D>
where
    Dimension<D>: Dim<D>,
{
    /// Creates buffers for these points, of these sizes.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`].
    pub fn new(gpu: &Gpu, points: DevicePoints, sizes: Sizes) -> Result<Self, Error> {
        let Sizes { blocks, history, start_points, parts } = sizes;
        let count = points.pairs.len();
        let slots = slots(blocks);
        Ok(Buffers {
            control: Storage::new(gpu, "control", FREE_START + blocks as usize)?,
            simplices: Storage::in_parts(gpu, Dimension::<D>::SIMPLICES, slots, parts)?,
            neighbors: Storage::in_parts(gpu, "neighbours", slots, parts)?,
            status: Storage::in_parts(gpu, "status", slots, parts)?,
            active: Storage::in_parts(gpu, "active list", 2 * slots, parts)?,
            messages: Storage::in_parts(gpu, "messages", slots, parts)?,
            history: Storage::in_parts(gpu, "history", history as usize, parts)?,
            waiting: WaitingBuffers {
                list: Storage::new(gpu, "waiting points", 2 * count)?,
                scores: Storage::new(gpu, "scores", count)?,
            },
            start: StartBuffers::new(gpu, start_points, Dimension::<D>::SLOTS_PER_POINT as usize)?,
            numbering: NumberingBuffers::new(gpu, slots, parts)?,
            own: OwnBuffers::new(gpu, count, blocks, parts)?,
            points,
        })
    }

    /// Returns larger buffers with the same contents, for `blocks` blocks. New slots are zero; the
    /// caller frees them.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`].
    pub fn with_blocks(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        blocks: u32,
        parts: Option<Parts>,
    ) -> Result<Self, Error> {
        let slots = slots(blocks);
        let old_half = self.active.bytes() / 2;
        let mut larger = self.clone();
        larger.control = Storage::new(gpu, "control", FREE_START + blocks as usize)?;
        larger.messages = Storage::in_parts(gpu, "messages", slots, parts)?;
        larger.simplices = Storage::in_parts(gpu, Dimension::<D>::SIMPLICES, slots, parts)?;
        larger.neighbors = Storage::in_parts(gpu, "neighbours", slots, parts)?;
        larger.status = Storage::in_parts(gpu, "status", slots, parts)?;
        larger.active = Storage::in_parts(gpu, "active list", 2 * slots, parts)?;
        larger.numbering = NumberingBuffers::new(gpu, slots, parts)?;
        let encoder = recorder.encoder();
        // All but the parameters, which the host writes anew.
        let counters = (PARAM_WORDS * size_of::<u32>()) as u64;
        self.control.record_copy(encoder, counters, &larger.control, counters, self.control.bytes() - counters);
        self.simplices.record_copy(encoder, 0, &larger.simplices, 0, self.simplices.bytes());
        self.neighbors.record_copy(encoder, 0, &larger.neighbors, 0, self.neighbors.bytes());
        self.status.record_copy(encoder, 0, &larger.status, 0, self.status.bytes());
        self.active.record_copy(encoder, 0, &larger.active, 0, old_half);
        self.active.record_copy(encoder, old_half, &larger.active, larger.active.bytes() / 2, old_half);
        larger.own = self.own.with_blocks(gpu, encoder, blocks, parts)?;
        Ok(larger)
    }

    /// Records that buffers are cleared that a run expects to be zero: slots, their status, and those that
    /// the dimension adds.
    pub fn record_clear(&self, recorder: &mut Recorder<'_>) {
        let encoder = recorder.encoder();
        self.simplices.record_clear(encoder);
        self.status.record_clear(encoder);
        self.start.near.record_clear(encoder);
        self.own.record_clear(encoder);
    }

    /// Returns the buffers under the names that they have in shaders: several, where a buffer is
    /// put to more than one use.
    pub fn bindings(&self) -> Vec<Binding<'_>> {
        let mut bindings = self.own.bindings();
        bindings.extend([
            ("control", self.control.buffer()),
            ("pairs", self.points.pairs.buffer()),
            ("counts", self.points.counts.buffer()),
            ("merged_into", self.points.merged_into.buffer()),
            ("vertex_of", self.points.vertex_of.buffer()),
            ("waiting", self.waiting.list.buffer()),
            ("scores", self.waiting.scores.buffer()),
            ("start_points", self.start.points.buffer()),
            ("start_simplices", self.start.simplices.buffer()),
            ("start_vertices", self.start.vertices.buffer()),
            ("start_near", self.start.near.buffer()),
        ]);
        append_bindings(
            &mut bindings,
            &[
                self.points.vertices.named("vertices"),
                self.numbering.marks.named("marks"),
                self.numbering.numbers.named("numbers"),
                self.simplices.named("simplices"),
                self.neighbors.named("neighbors"),
                self.status.named("status"),
                self.active.named("actives"),
                // Scores and points are picked before there are messages, and messages pass between commit and
                // link, after the list of entries that the check leaves undecided. Each has an element per slot.
                self.messages.named("messages"),
                self.messages.named("picks"),
                self.history.named("history"),
                // Facets are removed when nobody needs the history any more.
                self.history.named("removals"),
            ],
        );
        bindings
    }

    /// Returns the blocks of slots that there are.
    pub fn blocks(&self) -> u32 {
        self.simplices.len() as u32 / BLOCK
    }

    /// Returns the bytes that they take, without the points.
    pub fn bytes(&self) -> u64 {
        let Buffers {
            control,
            points: _,
            simplices,
            neighbors,
            status,
            active,
            messages,
            history,
            waiting,
            start,
            numbering,
            own,
        } = self;
        let StartBuffers { points: start_points, simplices: start_simplices, vertices, near } = start;
        let NumberingBuffers { marks, numbers } = numbering;
        let words = control.bytes() + waiting.list.bytes() + waiting.scores.bytes();
        let slots = simplices.bytes() + neighbors.bytes() + status.bytes() + active.bytes() + messages.bytes();
        let mesh = marks.bytes() + numbers.bytes();
        let start = start_points.bytes() + start_simplices.bytes() + vertices.bytes() + near.bytes();
        words + slots + mesh + history.bytes() + start + own.bytes()
    }
}

impl StartBuffers {
    fn new(gpu: &Gpu, points: usize, slots_per_point: usize) -> Result<Self, Error> {
        Ok(StartBuffers {
            points: Storage::new(gpu, "points of the start", points)?,
            simplices: Storage::new(gpu, "simplices of the start", points * slots_per_point)?,
            vertices: Storage::new(gpu, "vertices of the start", points)?,
            near: Storage::new(gpu, "simplices near vertices", points)?,
        })
    }
}

impl NumberingBuffers {
    fn new(gpu: &Gpu, slots: usize, parts: Option<Parts>) -> Result<Self, Error> {
        Ok(NumberingBuffers {
            marks: Storage::in_parts(gpu, "marks", slots, parts)?,
            numbers: Storage::in_parts(gpu, "numbers of simplices", slots, parts)?,
        })
    }
}
