//! The kernels of Phase 1 for points of one width, and what is kept from run to run.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Kernel, Parts, Readback, compile_all,
        phase1::{finish::Finish, memory::Kept, stages::Stages},
        points::PointStage,
    },
    input::lattice::Width,
    platform,
};

/// The kernels of Phase 1, for points of one width, and the buffers of the last run, which serve
/// the next one if that has as many points of the same precision.
#[derive(Debug)]
pub struct Phase1<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    pub(crate) points: PointStage<D>,
    pub(crate) stages: Stages,
    pub(crate) outputs: <Dimension<D> as Finish<D>>::Outputs,
    pub(crate) readback: Readback,
    pub(crate) kept: Kept<D>,
    /// The parts of the large arrays, if they are in parts.
    pub(crate) parts: Option<Parts>,
    /// The kernels that the first run does not wait for.
    deferred: Vec<Kernel>,
}

impl<const D: usize> Phase1<D>
where
    Dimension<D>: Finish<D>,
{
    /// Compiles the kernels that a run needs. Natively another thread begins with those that the first run does
    /// without; [`Phase1::finish_compiling`] waits for them.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Compiler::finish`].
    pub async fn new(gpu: &Gpu, width: Width) -> Result<Self, Error> {
        Self::in_parts(gpu, width, None).await
    }

    /// Compiles the kernels as [`Phase1::new`] does, for large arrays in these parts, or each in one
    /// buffer.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1::new`].
    pub async fn in_parts(gpu: &Gpu, width: Width, parts: Option<Parts>) -> Result<Self, Error> {
        let (phase1, compiler) = Self::uncompiled(gpu, width, parts);
        let device = gpu.clone();
        platform::gpu::compile_beside(phase1.deferred.clone(), async move |kernels| {
            compile_all(&device, kernels).await
        });
        compiler.finish().await?;
        Ok(phase1)
    }

    /// Compiles the kernels that a run needs, and no others: the state in which a first run may be, for tests.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1::new`].
    pub async fn of_first_run(gpu: &Gpu, width: Width) -> Result<Self, Error> {
        let (phase1, compiler) = Self::uncompiled(gpu, width, None);
        compiler.finish().await?;
        Ok(phase1)
    }

    fn uncompiled(gpu: &Gpu, width: Width, parts: Option<Parts>) -> (Self, Compiler<'_>) {
        let compiler = Compiler::in_parts(gpu, parts);
        let phase1 = Phase1 {
            points: PointStage::new(&compiler),
            stages: Stages::new::<D>(&compiler, width),
            outputs: Dimension::<D>::outputs(&compiler),
            readback: Readback::default(),
            kept: Kept::default(),
            parts,
            deferred: compiler.take_deferred(),
        };
        (phase1, compiler)
    }

    /// Returns when the kernels are compiled that the first run does without, too.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Compiler::finish`].
    pub async fn finish_compiling(&self, gpu: &Gpu) -> Result<(), Error> {
        match self.deferred.iter().all(Kernel::is_compiled) {
            true => Ok(()),
            false => compile_all(gpu, &self.deferred).await,
        }
    }

    /// Gives the memory of the last run back.
    pub fn release(&mut self) {
        self.readback = Readback::default();
        self.kept = Kept::default();
    }
}
