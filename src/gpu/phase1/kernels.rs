//! The kernels of Phase 1 for points of one width, and what is kept from run to run.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Readback,
        phase1::{finish::Finish, memory::Kept, stages::Stages},
        points::PointStage,
    },
    input::lattice::Width,
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
}

impl<const D: usize> Phase1<D>
where
    Dimension<D>: Finish<D>,
{
    /// Compiles the kernels.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Compiler::finish`].
    pub async fn new(gpu: &Gpu, width: Width) -> Result<Self, Error> {
        let compiler = Compiler::new(gpu);
        let phase1 = Phase1 {
            points: PointStage::new(&compiler),
            stages: Stages::new::<D>(&compiler, width),
            outputs: Dimension::<D>::outputs(&compiler),
            readback: Readback::default(),
            kept: Kept::default(),
        };
        compiler.finish().await?;
        Ok(phase1)
    }

    /// Gives the buffers of the last run back.
    pub fn release(&mut self) {
        self.readback = Readback::default();
        self.kept = Kept::default();
    }
}
