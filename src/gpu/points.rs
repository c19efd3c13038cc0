//! From points in host memory to vertices on the device: upload, duplicates, lattice, and order
//! along the Hilbert curve (§4.3).
//!
//! 1. The coordinates' bits are uploaded as they are; the device puts them on the lattice.
//! 2. A hash table merges the points at the same place of the lattice; the lowest number stands for
//!    all. They are exact duplicates, or were rounded to the same place.
//! 3. Every point gets its place along the Hilbert curve as key, those that another stands for the
//!    last one.
//! 4. The keys are sorted; ties stay in the order of the input.
//! 5. The vertices are written in that order.
//!
//! So vertex *v* is point `pairs[v][1]`, and the points that others stand for are behind all
//! vertices.

use bytemuck::{Pod, Zeroable};

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Parts, Recorder, Storage, append_bindings,
        dim::Dim,
        primitives::sort::{BoundSort, Sort},
        shader::{assert_layout, constants::common as constants},
        steps::{BoundSteps, Step, Steps},
        workgroups,
    },
    input::{
        lattice::{Lattice, Width},
        points::Points,
    },
};

/// The parameters of the kernels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct InputParams {
    /// The number of points.
    pub count: u32,
    /// The lattice's *k*: coordinates are multiplied by 2ᵏ.
    pub exponent: i32,
    /// 1 for `f64` input, 0 for `f32`.
    pub doubles: u32,
    /// Bit *a* is set where the points do not all agree on axis *a*.
    pub varies: u32,
    /// The lowest 32 bits of what is taken off.
    pub origin_low: [u32; 3],
    /// The size of the hash table, a power of two, less one.
    pub table_mask: u32,
    /// The next 32 bits of what is taken off.
    pub origin_high: [u32; 3],
    /// The bits of a lattice coordinate.
    pub width: u32,
    /// The coordinates of a point: 2 or 3.
    pub dimension: u32,
    /// Zero.
    pub unused: [u32; 3],
}
assert_layout!(InputParams);

impl InputParams {
    /// Returns the parameters of points on a lattice, without the size of the table.
    pub fn new<const D: usize>(points: Points<'_, D>, lattice: &Lattice<D>) -> Self {
        let along: [_; 3] = std::array::from_fn(|axis| lattice.origin().get(axis).copied().flatten());
        let origin = along.map(|origin| origin.unwrap_or(0));
        InputParams {
            count: points.len() as u32,
            exponent: lattice.exponent(),
            doubles: u32::from(bits_of(points).1),
            varies: (0..3).map(|axis| u32::from(along[axis].is_some()) << axis).sum(),
            origin_low: origin.map(|origin| origin as u32),
            table_mask: 0,
            origin_high: origin.map(|origin| (origin >> 32) as u32),
            width: lattice.width().bits(),
            dimension: D as u32,
            unused: [0; 3],
        }
    }

    /// Returns the width of the lattice.
    pub fn width(&self) -> Width {
        if self.width == Width::Narrow.bits() { Width::Narrow } else { Width::Wide }
    }

    /// Returns the number of points and of the words of their coordinates, and the width of the lattice.
    fn form(&self) -> (usize, usize, Width) {
        let points = self.count as usize;
        (points, points * self.dimension as usize * (1 + self.doubles as usize), self.width())
    }
}

/// The counters of the kernels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct InputCounts {
    /// Points at the same place of the lattice as one of a lower number.
    pub merged: u32,
    /// Those of them that have the same coordinates too.
    pub duplicates: u32,
    /// Points with a coordinate that was rounded to the lattice.
    pub rounded: u32,
    /// Zero.
    pub unused: u32,
}
assert_layout!(InputCounts);
// Some kernels see the words of the structure.
const _: () = {
    assert!(std::mem::offset_of!(InputCounts, merged) == 4 * constants::COUNT_MERGED as usize);
    assert!(std::mem::offset_of!(InputCounts, rounded) == 4 * constants::COUNT_ROUNDED as usize);
};

/// Merges the points at the same place, and gives each its key.
const KEY: &[Step] = &[Step::new("merge", "points_merge"), Step::new("keys", "points_keys")];
/// Writes the vertices in the order of the keys.
const GATHER: &[Step] = &[Step::new("gather", "points_gather")];

/// The bits of a sort key: 30 for the place along the curve, and the largest for points that others
/// stand for.
const KEY_BITS: u32 = 32;

/// The kernels, for points of `D` coordinates.
#[derive(Debug)]
pub struct PointStage<const D: usize> {
    key: Steps,
    sort: Sort,
    gather: Steps,
    /// The parts of the large arrays, if they are in parts.
    parts: Option<Parts>,
}

/// The points on the device. Valid when the recorded commands have run.
#[derive(Debug, Clone)]
pub struct DevicePoints {
    /// The vertices, as [`Dim::append_vertex`] lays them out, in the order of `pairs`. There is
    /// room for one more, the vertex at infinity.
    pub vertices: Storage<i32>,
    /// Sort key and point of each vertex.
    pub pairs: Storage<[u32; 2]>,
    /// For each point the one that stands for it, or [`NONE`](crate::NONE) if it is a vertex itself.
    pub merged_into: Storage<u32>,
    /// For each point its place in the order.
    pub vertex_of: Storage<u32>,
    /// One element.
    pub counts: Storage<InputCounts>,
}

/// The buffers of the stage, with its bind groups, for points of one number and form.
#[derive(Debug)]
pub struct PointBuffers {
    /// Points, words of input, width.
    form: (usize, usize, Width),
    params: Storage<InputParams>,
    input: Storage<u32>,
    table: Storage<u32>,
    device: DevicePoints,
    key: BoundSteps,
    sort: BoundSort,
    gather: BoundSteps,
    bytes: u64,
}

impl<const D: usize> PointStage<D>
where
    Dimension<D>: Dim<D>,
{
    /// Creates the kernels.
    pub fn new(compiler: &Compiler<'_>) -> Self {
        PointStage {
            key: Steps::new::<D>(compiler, Width::Narrow, KEY),
            sort: Sort::new(compiler),
            gather: Steps::new::<D>(compiler, Width::Narrow, GATHER),
            parts: compiler.parts(),
        }
    }

    /// Records what makes vertices of the points that are uploaded to the buffers: along the Hilbert curve if they
    /// are to be sorted, else in the order of the points.
    pub fn record(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        buffers: &PointBuffers,
        params: InputParams,
        sorts: bool,
    ) -> DevicePoints {
        let groups = workgroups(params.count);
        let params = InputParams { table_mask: buffers.table.len() as u32 - 1, ..params };
        buffers.params.write(gpu, 0, &[params]);
        let encoder = recorder.encoder();
        encoder.clear_buffer(buffers.table.buffer(), 0, None);
        encoder.clear_buffer(buffers.device.counts.buffer(), 0, None);
        buffers.key.record(recorder, groups);
        if sorts {
            recorder.stage("sort");
            self.sort.record(recorder, &buffers.sort);
        }
        buffers.gather.record(recorder, groups);
        buffers.device.clone()
    }

    /// Creates the buffers for points of this form.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManyPoints`] beyond 2³⁰, and those of [`Storage::new`].
    pub fn buffers(&self, gpu: &Gpu, params: &InputParams) -> Result<PointBuffers, Error> {
        const LIMIT: usize = 1 << 30;
        let form = params.form();
        let (n, words, width) = form;
        if n > LIMIT {
            return Err(Error::TooManyPoints { points: n, limit: LIMIT });
        }
        let params = Storage::new(gpu, "point parameters", 1)?;
        let input = Storage::<u32>::in_parts(gpu, "input points", words, self.parts)?;
        let table = Storage::<u32>::new(gpu, "table of points", (2 * n.max(1)).next_power_of_two())?;
        let slots = Storage::<u32>::new(gpu, "slots of points", n)?;
        let mut pairs = Storage::new(gpu, "sort pairs", n)?;
        let mut scratch = Storage::new(gpu, "sort scratch", n)?;
        let merged_into = Storage::new(gpu, "merged points", n)?;
        let counts = Storage::new(gpu, "point counts", 1)?;
        let vertex_words = Dimension::<D>::vertex_words(width);
        let vertices = Storage::in_parts(gpu, "vertices", (n + 1) * vertex_words, self.parts)?;
        let mut buffers = vec![
            ("params", params.buffer()),
            ("table", table.buffer()),
            // No kernel reads the table once the vertices are known.
            ("slots", slots.buffer()),
            ("vertex_of", slots.buffer()),
            ("pairs", pairs.buffer()),
            ("merged_into", merged_into.buffer()),
            ("counts", counts.buffer()),
        ];
        append_bindings(&mut buffers, &[input.named("input"), vertices.named("vertices")]);
        let [key, gather] = [&self.key, &self.gather].map(|steps| steps.bind(&buffers));
        // An even number of passes: the pairs end up where they were.
        let sort = self.sort.bind(gpu, &mut pairs, &mut scratch, KEY_BITS)?;
        let bytes = params.bytes()
            + input.bytes()
            + table.bytes()
            + slots.bytes()
            + 2 * pairs.bytes()
            + merged_into.bytes()
            + vertices.bytes();
        let device = DevicePoints { vertices, pairs, merged_into, vertex_of: slots, counts };
        Ok(PointBuffers { form, params, input, table, device, key, sort, gather, bytes })
    }
}

/// Returns the bits of coordinates, and whether they are of type `f64`.
pub(crate) fn bits_of<const D: usize>(points: Points<'_, D>) -> (&[u32], bool) {
    match points {
        Points::F32(p) => (bytemuck::cast_slice(p), false),
        Points::F64(p) => (bytemuck::cast_slice(p), true),
    }
}

impl PointBuffers {
    /// Returns whether they are for points of this form.
    pub(crate) fn fits(&self, params: &InputParams) -> bool {
        self.form == params.form()
    }

    /// Returns where the bits of the coordinates go.
    pub(crate) fn input(&self) -> &Storage<u32> {
        &self.input
    }

    /// Uploads the points.
    pub fn upload<const D: usize>(&self, gpu: &Gpu, points: Points<'_, D>) {
        self.input.write(gpu, 0, bits_of(points).0);
    }

    /// Returns the bytes that they take on the device.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}
