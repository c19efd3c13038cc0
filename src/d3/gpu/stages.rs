//! The stages of Phase 1 in 3D.

use crate::{
    Error,
    d3::gpu::{
        finish::{self, BoundFinish, Finish, NearMesh},
        flip::{BoundFlip, Flip},
        insert::{BoundInsert, Insert},
        relocate::{BoundRelocate, Relocate},
    },
    gpu::{
        Gpu, Kernel, Readback, Recorder, Storage,
        dim::Dimension,
        layout::Counters,
        phase1::{Buffers, FlipPlan, Stages},
        shader,
    },
    input::lattice::Width,
};

/// The kernels.
#[derive(Debug)]
pub struct Kernels {
    insert: Insert,
    flip: Flip,
    relocate: Relocate,
    finish: Finish,
    fill_free: Kernel,
}

/// The bind groups.
#[derive(Debug)]
pub struct Bound {
    insert: BoundInsert,
    flip: BoundFlip,
    relocate: BoundRelocate,
    finish: BoundFinish,
    fill_free: wgpu::BindGroup,
}

impl Stages<3> for Dimension<3> {
    type Kernels = Kernels;
    type Bound = Bound;
    type Result = NearMesh;

    fn compile(gpu: &Gpu, width: Width) -> Kernels {
        Kernels {
            insert: Insert::new(gpu, width),
            flip: Flip::new(gpu, width),
            relocate: Relocate::new(gpu, width),
            finish: Finish::new(gpu, width),
            fill_free: Kernel::new(gpu, shader::D3.get("fill_free"), width),
        }
    }

    fn bind(kernels: &Kernels, gpu: &Gpu, b: &Buffers<3>) -> Result<Bound, Error> {
        Ok(Bound {
            insert: kernels.insert.bind(gpu, b),
            flip: kernels.flip.bind(gpu, b),
            relocate: kernels.relocate.bind(gpu, b)?,
            finish: kernels.finish.bind(gpu, b)?,
            fill_free: kernels.fill_free.bind(gpu, &b.bindings()),
        })
    }

    fn bound_bytes(bound: &Bound) -> u64 {
        bound.relocate.bytes() + bound.finish.bytes()
    }

    fn record_first(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("locate");
        recorder.dispatch(&kernels.fill_free, &bound.fill_free, workgroups);
        kernels.insert.record_first(recorder, &bound.insert, workgroups);
    }

    fn record_insertion(
        kernels: &Kernels,
        recorder: &mut Recorder<'_>,
        bound: &Bound,
        b: &Buffers<3>,
        workgroups: u32,
    ) {
        kernels.insert.record(recorder, &bound.insert, b, workgroups);
    }

    fn record_flips(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, plan: FlipPlan, workgroups: u32) {
        kernels.flip.record(recorder, &bound.flip, plan, workgroups);
    }

    fn record_clear_votes(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        kernels.flip.record_clear_votes(recorder, &bound.flip, workgroups);
    }

    fn record_relocation(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        kernels.relocate.record(recorder, &bound.relocate, workgroups);
    }

    fn record_compaction(
        kernels: &Kernels,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Bound,
        entries: u32,
        workgroups: u32,
    ) {
        kernels.relocate.record_compaction(gpu, recorder, &bound.relocate, entries, workgroups);
    }

    fn record_grow(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("grow");
        recorder.dispatch(&kernels.fill_free, &bound.fill_free, workgroups);
    }

    fn record_finish(
        kernels: &Kernels,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Bound,
        blocks: u32,
        workgroups: u32,
    ) {
        kernels.finish.record(gpu, recorder, &bound.finish, blocks, workgroups);
    }

    fn sums(bound: &Bound) -> &Storage<u32> {
        &bound.finish.sums
    }

    async fn read_result(
        gpu: &Gpu,
        readback: &mut Readback,
        b: &Buffers<3>,
        bound: &Bound,
        finite: usize,
        counters: &Counters,
    ) -> Result<(NearMesh, Vec<u32>), Error> {
        finish::read_result(gpu, readback, b, &bound.finish, finite, counters).await
    }
}
