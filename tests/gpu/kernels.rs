//! What the tests that run kernel by kernel share, in 2D and 3D.

use std::cell::RefCell;
use std::collections::HashMap;

use bytemuck::Pod;
use gdel::internals::gpu::layout::{Counters, Params};
use gdel::internals::gpu::layout::{FREE_START, PARAM_WORDS};
use gdel::internals::gpu::{AdapterChoice, Binding, Gpu, Kernel, Readback, Recorder, Storage, shader::Shader};
use gdel::internals::input::lattice::Width;
use pollster::block_on;
use rand::{SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg32;

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
        let kernel = compiled.entry(shader.name()).or_insert_with(|| Kernel::new(&self.gpu, shader, self.width));
        let bindings = kernel.bind(&self.gpu, buffers);
        let mut recorder = Recorder::new(&self.gpu, None);
        recorder.dispatch(kernel, &bindings, 3);
        recorder.submit(&self.gpu);
    }

    pub fn read<T: Pod>(&self, storage: &Storage<T>) -> Vec<T> {
        block_on(Readback::default().read(&self.gpu, storage, 0, storage.len())).unwrap()
    }

    pub fn write_control(&self, control: &Storage<u32>, params: &Params, counters: &Counters) {
        control.write(&self.gpu, 0, bytemuck::cast_slice(&[*params]));
        control.write(&self.gpu, PARAM_WORDS, bytemuck::cast_slice(&[*counters]));
    }

    pub fn read_counters(&self, control: &Storage<u32>) -> Counters {
        *bytemuck::from_bytes(bytemuck::cast_slice(&self.read(control)[PARAM_WORDS..FREE_START]))
    }
}

/// So many of these positions, in no order; on a wide lattice they become the high words of coordinates.
pub fn shuffled<const D: usize>(width: Width, mut positions: Vec<[i64; D]>, count: usize) -> Vec<[i64; D]> {
    positions.shuffle(&mut Pcg32::seed_from_u64(4));
    positions.truncate(count);
    if width == Width::Wide {
        positions.iter_mut().for_each(|q| *q = q.map(|x| x << 31 | 5));
    }
    positions
}
