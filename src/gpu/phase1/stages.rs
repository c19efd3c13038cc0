//! What the dimensions supply for Phase 1: kernels, their bind groups, and what is read back in the end.

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

/// The flip iterations to record.
#[derive(Debug, Clone, Copy)]
pub struct FlipPlan {
    /// How many.
    pub iterations: u32,
    /// 3D only: what the filter leaves open is decided in every so many iterations, and in the last one.
    pub exact_every: u32,
    /// 3D only: whether there may be so many active tetrahedra in one that the next ones are found by compaction (§4.2).
    pub compacts: bool,
}

/// The kernels of Phase 1 in `D` dimensions, and what the host records of them.
///
/// The functions named `record_…` record commands for `workgroups` workgroups per dispatch.
#[expect(async_fn_in_trait, reason = "only this crate implements it, and no caller is generic over threads")]
pub trait Stages<const D: usize>: Dim<D>
where
    Dimension<D>: Dim<D>,
{
    /// The kernels.
    type Kernels: Debug;
    /// Their bind groups, and buffers that only one stage needs.
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
    fn bind(kernels: &Self::Kernels, gpu: &Gpu, buffers: &Buffers<D>) -> Result<Self::Bound, Error>;

    /// Returns the bytes that `bound` takes on the device beside the buffers that the stages share.
    fn bound_bytes(bound: &Self::Bound) -> u64;

    /// Records the first simplices, and which of them each point lies in.
    fn record_first(kernels: &Self::Kernels, recorder: &mut Recorder<'_>, bound: &Self::Bound, workgroups: u32);

    /// Records an insertion round.
    fn record_insertion(
        kernels: &Self::Kernels,
        recorder: &mut Recorder<'_>,
        bound: &Self::Bound,
        buffers: &Buffers<D>,
        workgroups: u32,
    );

    /// Records flip iterations. Those that find too few active simplices do nothing.
    fn record_flips(
        kernels: &Self::Kernels,
        recorder: &mut Recorder<'_>,
        bound: &Self::Bound,
        plan: FlipPlan,
        workgroups: u32,
    );

    /// Records that flip iterations are counted from the start again.
    fn record_clear_votes(kernels: &Self::Kernels, recorder: &mut Recorder<'_>, bound: &Self::Bound, workgroups: u32);

    /// Records the walk of the waiting points along the history.
    fn record_relocation(kernels: &Self::Kernels, recorder: &mut Recorder<'_>, bound: &Self::Bound, workgroups: u32);

    /// Records the compaction of the list of waiting points, which has `entries` entries, those that do not wait included.
    fn record_compaction(
        kernels: &Self::Kernels,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Self::Bound,
        entries: u32,
        workgroups: u32,
    );

    /// Records that the slots of new blocks are free. 2D, in which slots never run out, has nothing to record.
    fn record_grow(kernels: &Self::Kernels, recorder: &mut Recorder<'_>, bound: &Self::Bound, workgroups: u32);

    /// Records the end of Phase 1, of `blocks` blocks: the mesh without gaps, and what is open about it.
    fn record_finish(
        kernels: &Self::Kernels,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Self::Bound,
        blocks: u32,
        workgroups: u32,
    );

    /// Returns the sums of a scan in the end; their entry [`GROUPS`](crate::gpu::primitives::scan::GROUPS) is the number of
    /// finite simplices.
    fn sums(bound: &Self::Bound) -> &Storage<u32>;

    /// Reads the mesh back, of which `finite` simplices are finite, and, if any point was merged, which one stands for each
    /// ([`DevicePoints::merged_into`](crate::gpu::points::DevicePoints::merged_into)). Takes two submissions, so that the
    /// host can take the first part while the device sends the second.
    ///
    /// # Errors
    ///
    /// Those of [`Gpu::with_error_scope`] and [`Readback::receive`].
    async fn read_result(
        gpu: &Gpu,
        readback: &mut Readback,
        buffers: &Buffers<D>,
        bound: &Self::Bound,
        finite: usize,
        counters: &Counters,
    ) -> Result<(Self::Result, Vec<u32>), Error>;
}
