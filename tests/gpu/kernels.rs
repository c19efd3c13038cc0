//! What the tests that run kernel by kernel share, in 2D and 3D.

use crate::states::{self, Own};
use bytemuck::Pod;
use gdel::{
    NONE,
    internals::{
        dimension::Dimension,
        gpu::{
            AdapterChoice, Binding, Compiler, Gpu, Kernel, Recorder, Storage,
            dim::Dim,
            layout::Params,
            phase1::{Buffers, Sizes},
            points::{DevicePoints, InputCounts},
            shader::Shader,
        },
        input::lattice::Width,
    },
    wgpu,
};
use gdel_reference::{self as reference, State};
use pollster::block_on;
use rand::{SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg32;
use std::{
    cell::RefCell,
    collections::{BTreeSet, HashMap},
};

/// The GPU and the kernels that were run on it.
pub struct Kernels {
    pub gpu: Gpu,
    pub width: Width,
    compiled: RefCell<HashMap<&'static str, Kernel>>,
}

impl Kernels {
    pub fn new(width: Width) -> Self {
        let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
        Kernels { gpu, width, compiled: RefCell::default() }
    }

    /// Runs a kernel on these buffers.
    pub fn run(&self, shader: &'static Shader, buffers: &[Binding<'_>]) {
        let mut compiled = self.compiled.borrow_mut();
        let kernel =
            compiled.entry(shader.name()).or_insert_with(|| Compiler::new(&self.gpu).kernel(shader, self.width));
        let bindings = kernel.bind(buffers);
        let mut recorder = Recorder::new(&self.gpu, None);
        recorder.dispatch(kernel, &bindings, 3);
        recorder.submit(&self.gpu);
    }
}

/// The buffers of a dimension on the device, where its kernels run one by one.
pub struct Device<const D: usize>
where
    Dimension<D>: Own<D>,
{
    pub kernels: Kernels,
    pub buffers: Buffers<D>,
    /// What only some kernels are bound to.
    more: Vec<(&'static str, wgpu::Buffer)>,
}

impl<const D: usize> Device<D>
where
    Dimension<D>: Own<D>,
{
    /// Creates the buffers for the points of `state`.
    pub fn new(width: Width, state: &State<D>) -> Self {
        let kernels = Kernels::new(width);
        let gpu = &kernels.gpu;
        let count = state.params.infinite as usize;
        let pairs: Vec<[u32; 2]> = state.points[..count].iter().map(|v| [0, v.index]).collect();
        let mut words = Vec::new();
        for v in &state.points {
            Dimension::<D>::append_vertex(&mut words, width, v.position, v.index, false);
        }
        let points = DevicePoints {
            vertices: Storage::with_contents(gpu, "vertices", &words).unwrap(),
            pairs: Storage::with_contents(gpu, "pairs", &pairs).unwrap(),
            merged_into: Storage::new(gpu, "merged", count).unwrap(),
            vertex_of: Storage::new(gpu, "vertices of points", count).unwrap(),
            counts: Storage::with_contents(gpu, "counts", &[InputCounts::default()]).unwrap(),
        };
        let Params { blocks, history, start_points, .. } = state.params;
        let sizes = Sizes { blocks, history, start_points: start_points as usize, parts: None };
        let buffers = Buffers::new(gpu, points, sizes).unwrap();
        Device { kernels, buffers, more: Vec::new() }
    }

    /// Binds kernels to these buffers, too.
    pub fn with(mut self, more: &[(&'static str, &wgpu::Buffer)]) -> Self {
        self.more.extend(more.iter().map(|&(name, buffer)| (name, buffer.clone())));
        self
    }

    pub fn upload(&self, state: &State<D>) {
        states::upload(&self.kernels.gpu, &self.buffers, state);
    }

    pub fn download(&self, like: &State<D>) -> State<D> {
        states::download(&self.kernels.gpu, &self.buffers, like)
    }

    pub fn read<T: Pod>(&self, storage: &Storage<T>) -> Vec<T> {
        states::read(&self.kernels.gpu, storage)
    }

    pub fn run(&self, name: &str) {
        let mut buffers = self.buffers.bindings();
        buffers.extend(self.more.iter().map(|(name, buffer)| (*name, buffer)));
        self.kernels.run(Dimension::<D>::SHADERS.get(name), &buffers);
    }

    /// Runs a kernel on `state`'s buffers, and its reference on `state`. Returns the device's
    /// buffers.
    pub fn both(&self, name: &str, state: &mut State<D>, reference: impl Fn(&mut State<D>)) -> State<D> {
        self.upload(state);
        self.run(name);
        reference(state);
        let device = self.download(state);
        assert_eq!(device.counters, state.counters, "{name}");
        device
    }

    /// Makes the simplices of the start, and locates the points.
    pub fn start(&self, state: &mut State<D>) {
        let gpu = &self.kernels.gpu;
        let b = &self.buffers;
        // Vertices are points in their order.
        let vertices: Vec<u32> = (0..state.params.infinite).collect();
        b.points.vertex_of.write(gpu, 0, &vertices);
        b.points.merged_into.write(gpu, 0, &vec![NONE; vertices.len()]);
        b.start.points.write(gpu, 0, &state.start.points);
        b.start.simplices.write(gpu, 0, &state.start.simplices);
        self.upload(state);
        self.run("start_vertices");
        let count = state.start.points.len();
        assert_eq!(self.read(&b.start.vertices)[..count], state.start_vertices);
        let near = self.read(&b.start.near);
        for (&v, &[_, simplex]) in state.start_vertices.iter().zip(&state.start.points) {
            let slot = near[(v / state.params.start_stride) as usize];
            assert!(slot > state.start_slot(simplex), "the last one of a stretch is kept");
        }
        // The host sets these two.
        state.counters.active_len[0] = state.params.start_simplices;
        state.counters.inserted = state.params.start_points;
        self.equal("start_mesh", state, reference::start_mesh);
        self.equal("locate", state, reference::locate);
    }

    /// Scores the waiting points. Where the list of them is compacted, it may be in any order, and
    /// so are the scores.
    pub fn pick_score(&self, state: &mut State<D>)
    where
        Dimension<D>: reference::kernels::Kernels<D>,
    {
        let before = (state.waiting.clone(), state.counters.entries_before);
        let mut device = self.both("pick_score", state, reference::pick_score);
        if before.1 != 0 {
            assert_eq!(before.0.len() as u32, before.1);
            let sorted = |state: &State<D>| {
                let scores = state.scores.iter().copied();
                state.waiting.iter().map(|entry| [entry.point, entry.tet]).zip(scores).collect::<BTreeSet<_>>()
            };
            assert_eq!(sorted(&device), sorted(state), "pick_score");
            (device.waiting, device.scores) = (state.waiting.clone(), state.scores.clone());
        }
        states::assert_equal(&device, state, "pick_score");
    }

    /// Runs a kernel and its reference, whose results are the same to the last bit.
    pub fn equal(&self, name: &str, state: &mut State<D>, reference: impl Fn(&mut State<D>)) {
        let device = self.both(name, state, reference);
        states::assert_equal(&device, state, name);
    }
}

/// Returns the simplices in a half of the active list.
pub fn listed<const D: usize>(state: &State<D>, half: usize) -> BTreeSet<u32>
where
    Dimension<D>: Own<D>,
{
    state.active[half][..state.counters.active_len[half] as usize].iter().map(|a| a.tet).collect()
}

/// Returns so many of these positions, in no order; on a wide lattice they become the high words of
/// coordinates.
pub fn shuffled<const D: usize>(width: Width, mut positions: Vec<[i64; D]>, count: usize) -> Vec<[i64; D]> {
    positions.shuffle(&mut Pcg32::seed_from_u64(4));
    positions.truncate(count);
    if width == Width::Wide {
        positions.iter_mut().for_each(|q| *q = q.map(|x| x << 31 | 5));
    }
    positions
}
