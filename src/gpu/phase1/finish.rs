//! The end of Phase 1: the mesh without gaps, what is open about it, and the one large readback.

use std::fmt::Debug;

use bytemuck::Pod;

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Binding, Compiler, Gpu, Pending, Readback, Recorder, Storage,
        dim::{Corners, Dim},
        host::Work,
        layout::Counters,
        phase1::buffers::Buffers,
    },
};

/// How Phase 1 ends in `D` dimensions.
#[expect(async_fn_in_trait, reason = "only this crate implements it, and no caller is generic over threads")]
pub trait Finish<const D: usize>: Work<D>
where
    Dimension<D>: Work<D>,
{
    /// The names of the buffers of the rounds that the end writes over.
    type Aliases: Aliases<D>;
    /// The readbacks beside those of the simplices and their neighbours.
    type Reading;
    /// The mesh, and what is to be repaired or checked of it.
    type Result: Debug + Clone + PartialEq;
    /// The kernels that make the arrays of the caller's mesh.
    type Outputs: Debug;

    /// Creates the kernels that make the arrays of the caller's mesh.
    fn outputs(compiler: &Compiler<'_>) -> Self::Outputs;

    /// Returns the number of simplices that the mesh has, of which `finite` are finite.
    fn mesh_len(finite: usize, counters: &Counters) -> usize;

    /// Records the readbacks of all but the simplices and their neighbours.
    fn copy(copies: &mut Copies<'_>, b: &Buffers<D>, aliases: &Self::Aliases, counters: &Counters) -> Self::Reading;

    /// Receives these readbacks and returns the result with the simplices, of which `finite` are finite, and
    /// their neighbours.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    async fn receive(
        copied: &mut Copied<'_>,
        reading: Self::Reading,
        arrays: [Vec<Corners<D>>; 2],
        finite: usize,
    ) -> Result<Self::Result, Error>;
}

/// Buffers of the rounds under the names that they have at the end.
pub trait Aliases<const D: usize>: Debug
where
    Dimension<D>: Dim<D>,
{
    /// Returns the second lives of these buffers.
    fn new(b: &Buffers<D>) -> Self;

    /// Returns the simplices of the mesh, and their neighbours.
    fn arrays(&self) -> [Storage<Corners<D>>; 2];

    /// Returns the buffers under the names that they have in shaders.
    fn bindings(&self) -> Vec<Binding<'_>>;
}

/// Records readbacks in one submission.
pub struct Copies<'a> {
    pub(crate) readback: &'a mut Readback,
    pub(crate) gpu: &'a Gpu,
    pub(crate) recorder: Recorder<'a>,
}

impl Copies<'_> {
    /// Records the readback of the first `len` elements of `source`.
    pub fn copy<T: Pod>(&mut self, source: &Storage<T>, len: usize) -> Pending<T> {
        self.copy_from(source, 0, len)
    }

    /// Records the readback of `len` elements of `source`, from element `start`.
    pub(crate) fn copy_from<T: Pod>(&mut self, source: &Storage<T>, start: usize, len: usize) -> Pending<T> {
        self.readback.copy(self.gpu, self.recorder.encoder(), source, start, len)
    }
}

/// Receives the readbacks of one submission.
pub struct Copied<'a> {
    pub(crate) readback: &'a mut Readback,
    pub(crate) gpu: &'a Gpu,
    pub(crate) submission: wgpu::SubmissionIndex,
}

impl Copied<'_> {
    /// Waits for a readback.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    pub fn receive<T: Pod>(&mut self, pending: Pending<T>) -> impl Future<Output = Result<Vec<T>, Error>> {
        self.readback.receive(self.gpu, &self.submission, pending)
    }

    /// Waits for a readback, as [`Readback::receive_into`] does.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    pub fn receive_into<T: Pod>(
        &mut self,
        pending: Pending<T>,
        list: Vec<T>,
    ) -> impl Future<Output = Result<Vec<T>, Error>> {
        self.readback.receive_into(self.gpu, &self.submission, pending, list)
    }
}
