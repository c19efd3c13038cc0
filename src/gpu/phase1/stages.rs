//! The stages of Phase 1.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu,
        phase1::{
            buffers::Buffers,
            finish::{BoundFinish, Finish, FinishStage},
            flip::{BoundFlip, Flip},
            insert::{BoundInsert, Insert},
            moved::Moved,
            relocate::{BoundRelocate, Relocate},
            removals::{BoundRemovals, Removals},
        },
    },
    input::lattice::Width,
};

/// The kernels of all stages.
#[derive(Debug)]
pub(crate) struct Stages {
    pub(crate) insert: Insert,
    pub(crate) flip: Flip,
    pub(crate) relocate: Relocate,
    pub(crate) removals: Removals,
    pub(crate) finish: FinishStage,
    pub(crate) moved: Moved,
}

/// Their bind groups.
#[derive(Debug)]
pub(crate) struct BoundStages<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    pub(crate) insert: BoundInsert,
    pub(crate) flip: BoundFlip,
    pub(crate) relocate: BoundRelocate,
    pub(crate) removals: BoundRemovals,
    pub(crate) finish: BoundFinish<D>,
}

impl Stages {
    /// Creates the kernels of `D` dimensions.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width) -> Self
    where
        Dimension<D>: Finish<D>,
    {
        Stages {
            insert: Insert::new::<D>(compiler, width),
            flip: Flip::new::<D>(compiler, width),
            relocate: Relocate::new::<D>(compiler, width),
            removals: Removals::new::<D>(compiler, width),
            finish: FinishStage::new::<D>(compiler, width),
            moved: Moved::new::<D>(compiler, width),
        }
    }

    /// Binds the kernels to these buffers.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`](crate::gpu::Storage::new).
    pub(crate) fn bind<const D: usize>(&self, gpu: &Gpu, b: &Buffers<D>) -> Result<BoundStages<D>, Error>
    where
        Dimension<D>: Finish<D>,
    {
        Ok(BoundStages {
            insert: self.insert.bind(gpu, b),
            flip: self.flip.bind(gpu, b),
            relocate: self.relocate.bind(gpu, b),
            removals: self.removals.bind(gpu, b),
            finish: self.finish.bind(gpu, b)?,
        })
    }
}
