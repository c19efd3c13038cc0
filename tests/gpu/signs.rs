//! Signs of predicates, by a kernel and by big integers, in 2D and 3D.

use crate::assemble::assemble;
use crate::oracle;
use bytemuck::Pod;
use gdel::internals::{
    gpu::{AdapterChoice, Binding, Gpu, Kernel, Readback, Recorder, Storage, shader::with_int64, workgroups},
    input::lattice::Width,
    predicates::Sign,
};
use num_bigint::BigInt;
use pollster::block_on;

/// A kernel that writes the signs of each case.
pub struct SignKernel {
    pub gpu: Gpu,
    kernel: Kernel,
}

impl SignKernel {
    /// Compiles a kernel that includes shaders and has these buffers: for any device, and for one with
    /// 64-bit integers, if this is one.
    pub fn all(width: Width, text: &str, variables: &[&'static str]) -> Vec<Self> {
        let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a GPU or lavapipe");
        let portable = assemble(text, width);
        let int64 = with_int64(&portable);
        assert_ne!(portable, int64);
        let has_int64 = gpu.device().features().contains(wgpu::Features::SHADER_INT64);
        let forms = if has_int64 { vec![portable, int64] } else { vec![portable] };
        let compiled = |wgsl: String| {
            let compile = || Ok(Kernel::from_wgsl(gpu.device(), "predicates", &wgsl, variables, &[]));
            let kernel = block_on(gpu.with_error_scope("test", compile)).unwrap();
            SignKernel { gpu: gpu.clone(), kernel }
        };
        forms.into_iter().map(compiled).collect()
    }

    /// The signs of so many cases, which these buffers hold.
    pub fn signs<T: Pod>(&self, inputs: &[Binding<'_>], cases: usize) -> Vec<T> {
        let gpu = &self.gpu;
        let signs = Storage::<T>::new(gpu, "signs", cases).unwrap();
        let bindings = self.kernel.bind(&[inputs, &[("signs", signs.buffer())]].concat());
        let mut recorder = Recorder::new(gpu, None);
        recorder.dispatch(&self.kernel, &bindings, workgroups(cases as u32));
        recorder.submit(gpu);
        block_on(Readback::default().read(gpu, &signs, 0, cases)).unwrap()
    }
}

/// The orientation of the first D + 1 positions.
pub fn exact_orientation<const D: usize>(positions: &[[i64; D]]) -> Sign {
    let points: Vec<_> = positions[..D + 1].iter().map(|p| p.map(BigInt::from)).collect();
    oracle::sign(&oracle::orientation(&points.iter().collect::<Vec<_>>()))
}

/// Whether the last of D + 2 positions is inside the circumsphere of the others, or the
/// circumcircle.
pub fn exact_in_circumsphere<const D: usize>(positions: &[[i64; D]]) -> Sign {
    let points: Vec<_> = positions.iter().map(|p| p.map(BigInt::from)).collect();
    oracle::sign(&oracle::in_circumsphere(&points.iter().collect::<Vec<_>>()))
}
