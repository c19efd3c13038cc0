//! The end of Phase 1, in which the dimensions differ.

use std::fmt::Debug;

use crate::{
    Error,
    gpu::{
        Gpu, Readback, Recorder, Storage,
        dim::{Dim, Dimension},
        layout::Counters,
        phase1::buffers::Buffers,
    },
    input::lattice::Width,
};

/// How Phase 1 ends in `D` dimensions: the mesh without gaps, and what is open about it.
#[expect(async_fn_in_trait, reason = "only this crate implements it, and no caller is generic over threads")]
pub trait Finish<const D: usize>: Dim<D>
where
    Dimension<D>: Dim<D>,
{
    /// The kernels.
    type Kernels: Debug;
    /// Their bind groups, and the buffers that only they need.
    type Bound: Debug;
    /// What Phase 1 leaves: the mesh, and what is to be repaired or checked of it.
    type Result: Debug + Clone + PartialEq;

    /// Compiles the kernels.
    fn compile(gpu: &Gpu, width: Width) -> Self::Kernels;

    /// Binds the kernels to these buffers.
    ///
    /// # Errors
    ///
    /// Those of [`Storage::new`].
    fn bind(kernels: &Self::Kernels, gpu: &Gpu, b: &Buffers<D>) -> Result<Self::Bound, Error>;

    /// Returns the bytes that `bound` takes on the device beside the buffers that the stages share.
    fn bound_bytes(bound: &Self::Bound) -> u64;

    /// Records the end of Phase 1, of `blocks` blocks.
    fn record(
        kernels: &Self::Kernels,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Self::Bound,
        blocks: u32,
        workgroups: u32,
    );

    /// Returns the sums of a scan; their entry [`GROUPS`](crate::gpu::primitives::scan::GROUPS) is
    /// the number of finite simplices.
    fn sums(bound: &Self::Bound) -> &Storage<u32>;

    /// Reads the mesh back, of which `finite` simplices are finite, and, if any point was merged,
    /// which one stands for each
    /// ([`DevicePoints::merged_into`](crate::gpu::points::DevicePoints::merged_into)). Takes two
    /// submissions, so that the host can take the first part while the device sends the second.
    ///
    /// # Errors
    ///
    /// Those of [`Gpu::with_error_scope`] and [`Readback::receive`].
    async fn read_result(
        gpu: &Gpu,
        readback: &mut Readback,
        b: &Buffers<D>,
        bound: &Self::Bound,
        finite: usize,
        counters: &Counters,
    ) -> Result<(Self::Result, Vec<u32>), Error>;
}
