//! Creating kernels, and compiling them together.

use crate::{
    error::Error,
    gpu::{Gpu, Kernel, Parts, shader::Shader},
    input::lattice::Width,
    platform,
};
use std::cell::RefCell;

/// Creates kernels and compiles them together.
#[derive(Debug)]
pub struct Compiler<'a> {
    gpu: &'a Gpu,
    /// Those to be compiled.
    kernels: RefCell<Vec<Kernel>>,
    /// Those that the first run does not wait for.
    deferred: RefCell<Vec<Kernel>>,
    /// Whether the device keeps the kernels.
    kept: bool,
    /// The parts of large arrays, if these are in parts.
    parts: Option<Parts>,
}

impl<'a> Compiler<'a> {
    /// Starts without any kernels.
    pub fn new(gpu: &'a Gpu) -> Self {
        Self::in_parts(gpu, None)
    }

    /// Starts without any kernels. The large arrays of those that it creates are in parts, if these
    /// are given.
    pub(crate) fn in_parts(gpu: &'a Gpu, parts: Option<Parts>) -> Self {
        Compiler { gpu, kernels: RefCell::default(), deferred: RefCell::default(), kept: false, parts }
    }

    /// Returns the parts of large arrays, if these are in parts.
    pub(crate) fn parts(&self) -> Option<Parts> {
        self.parts
    }

    /// Starts without any kernels. The device keeps them, so that they are compiled only once.
    pub fn keeping(gpu: &'a Gpu) -> Self {
        Compiler { kept: true, ..Compiler::new(gpu) }
    }

    /// Creates the kernel of a shader. It is compiled by [`Compiler::finish`], or when it is used
    /// before.
    pub fn kernel(&self, shader: &'static Shader, width: Width) -> Kernel {
        let kernel = self.on_demand(shader, width);
        self.kernels.borrow_mut().push(kernel.clone());
        kernel
    }

    /// Creates the kernel of a shader that the first run does not wait for: runs do without it until
    /// [`Kernel::is_compiled`]. [`Compiler::take_deferred`] returns these kernels.
    pub fn deferred(&self, shader: &'static Shader, width: Width) -> Kernel {
        let kernel = self.on_demand(shader, width);
        self.deferred.borrow_mut().push(kernel.clone());
        kernel
    }

    /// Creates the kernel of a shader that few runs need. It is compiled when it is used.
    pub fn on_demand(&self, shader: &'static Shader, width: Width) -> Kernel {
        if let Some(kernel) = self.gpu.mutated_kernel(shader, width) {
            return kernel;
        }
        let new = || Kernel::new(self.gpu.device(), shader, width, self.parts);
        match self.kept {
            true => self.gpu.kept_kernel(shader.name(), width, new),
            false => new(),
        }
    }

    /// Returns the kernels that the first run does not wait for.
    pub fn take_deferred(&self) -> Vec<Kernel> {
        self.deferred.take()
    }

    /// Compiles the kernels that runs need, where there are threads on all of them.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`].
    pub async fn finish(self) -> Result<(), Error> {
        let Compiler { gpu, kernels, .. } = self;
        platform::gpu::compile(kernels.into_inner(), async |kernels| compile_all(gpu, kernels).await).await
    }
}

/// Compiles the kernels that are not compiled yet, in the calling thread.
///
/// # Errors
///
/// Returns the errors of [`Gpu::with_error_scope`].
pub(crate) async fn compile_all(gpu: &Gpu, kernels: &[Kernel]) -> Result<(), Error> {
    gpu.with_error_scope("pipelines", || {
        kernels.iter().for_each(|kernel| _ = kernel.pipeline());
        Ok(())
    })
    .await
}
