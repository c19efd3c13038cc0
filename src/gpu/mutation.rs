//! Wrong devices, for tests: one on which a shader is another than it should be.

use crate::{
    gpu::{Gpu, Kernel, shader::Shader},
    input::lattice::Width,
};
use std::{fmt, sync::Arc};

/// A shader, and what becomes of its WGSL.
#[derive(Clone)]
pub struct Mutation {
    /// The name of the shader.
    pub kernel: &'static str,
    /// Returns the WGSL in place of that of the shader.
    pub edit: Arc<dyn Fn(String) -> String + Send + Sync>,
}

impl fmt::Debug for Mutation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Mutation").field("kernel", &self.kernel).finish_non_exhaustive()
    }
}

impl Gpu {
    /// Returns the same device with a shader changed, or with none. All other kernels are compiled once for all devices
    /// that are made of one.
    pub fn mutated(&self, mutation: Option<Mutation>) -> Gpu {
        let mut gpu = self.clone();
        gpu.mutation = Some(mutation);
        gpu
    }

    /// Returns the kernel of a shader, if the device was made by [`Gpu::mutated`].
    pub(crate) fn mutated_kernel(&self, shader: &'static Shader, width: Width) -> Option<Kernel> {
        let mutation = self.mutation.as_ref()?;
        let new = || Kernel::new(self.device(), shader, width, None);
        Some(match mutation {
            Some(Mutation { kernel, edit }) if *kernel == shader.name() => new().edited(&**edit),
            _ => self.kept_kernel(shader.name(), width, new),
        })
    }
}
