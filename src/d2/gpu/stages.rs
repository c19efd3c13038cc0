//! The stages of Phase 1 in 2D.

use crate::{
    Error,
    d2::gpu::finish::{self, BoundFinish, Finish, NearMesh},
    gpu::{
        Gpu, Kernel, Readback, Recorder, Storage,
        dim::Dimension,
        layout::Counters,
        phase1::{Buffers, FlipPlan, Stages},
        shader,
        waiting::{BoundWaitingList, WaitingList},
    },
    input::lattice::Width,
};

/// The kernels.
#[derive(Debug)]
pub struct Kernels {
    locate: Kernel,
    pick_score: Kernel,
    pick_point: Kernel,
    split: Kernel,
    relocate_split: Kernel,
    flip_check: Kernel,
    flip_commit: Kernel,
    flip_link: Kernel,
    clear_votes: Kernel,
    relocate: Kernel,
    waiting: WaitingList,
    finish: Finish,
}

/// The bind groups.
#[derive(Debug)]
pub struct Bound {
    locate: wgpu::BindGroup,
    pick_score: wgpu::BindGroup,
    pick_point: wgpu::BindGroup,
    split: wgpu::BindGroup,
    relocate_split: wgpu::BindGroup,
    flip_check: wgpu::BindGroup,
    flip_commit: wgpu::BindGroup,
    flip_link: wgpu::BindGroup,
    clear_votes: wgpu::BindGroup,
    relocate: wgpu::BindGroup,
    waiting: BoundWaitingList,
    finish: BoundFinish,
}

impl Stages<2> for Dimension<2> {
    type Kernels = Kernels;
    type Bound = Bound;
    type Result = NearMesh;

    fn compile(gpu: &Gpu, width: Width) -> Kernels {
        let kernel = |name| Kernel::new(gpu, shader::D2.get(name), width);
        Kernels {
            locate: kernel("locate"),
            pick_score: kernel("pick_score"),
            pick_point: kernel("pick_point"),
            split: kernel("split"),
            relocate_split: kernel("relocate_split"),
            flip_check: kernel("flip_check"),
            flip_commit: kernel("flip_commit"),
            flip_link: kernel("flip_link"),
            clear_votes: kernel("clear_votes"),
            relocate: kernel("relocate"),
            waiting: WaitingList::new(gpu),
            finish: Finish::new(gpu, width),
        }
    }

    fn bind(kernels: &Kernels, gpu: &Gpu, b: &Buffers<2>) -> Result<Bound, Error> {
        let buffers = b.bindings();
        Ok(Bound {
            locate: kernels.locate.bind(gpu, &buffers),
            pick_score: kernels.pick_score.bind(gpu, &buffers),
            pick_point: kernels.pick_point.bind(gpu, &buffers),
            split: kernels.split.bind(gpu, &buffers),
            relocate_split: kernels.relocate_split.bind(gpu, &buffers),
            flip_check: kernels.flip_check.bind(gpu, &buffers),
            flip_commit: kernels.flip_commit.bind(gpu, &buffers),
            flip_link: kernels.flip_link.bind(gpu, &buffers),
            clear_votes: kernels.clear_votes.bind(gpu, &buffers),
            relocate: kernels.relocate.bind(gpu, &buffers),
            waiting: kernels.waiting.bind(gpu, &b.control, &b.waiting, &b.scores)?,
            finish: kernels.finish.bind(gpu, b)?,
        })
    }

    fn bound_bytes(bound: &Bound) -> u64 {
        bound.waiting.bytes()
    }

    fn record_first(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("locate");
        recorder.dispatch(&kernels.locate, &bound.locate, workgroups);
    }

    fn record_insertion(
        kernels: &Kernels,
        recorder: &mut Recorder<'_>,
        bound: &Bound,
        b: &Buffers<2>,
        workgroups: u32,
    ) {
        recorder.encoder().clear_buffer(b.messages.buffer(), 0, None);
        recorder.stage("pick");
        recorder.dispatch(&kernels.pick_score, &bound.pick_score, workgroups);
        recorder.dispatch(&kernels.pick_point, &bound.pick_point, workgroups);
        recorder.stage("split");
        recorder.dispatch(&kernels.split, &bound.split, workgroups);
        recorder.stage("relocate after splits");
        recorder.dispatch(&kernels.relocate_split, &bound.relocate_split, workgroups);
    }

    fn record_flips(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, plan: FlipPlan, workgroups: u32) {
        for _ in 0..plan.iterations {
            recorder.stage("flip: check");
            recorder.dispatch(&kernels.flip_check, &bound.flip_check, workgroups);
            recorder.stage("flip: commit");
            recorder.dispatch(&kernels.flip_commit, &bound.flip_commit, workgroups);
            recorder.stage("flip: link");
            recorder.dispatch(&kernels.flip_link, &bound.flip_link, workgroups);
        }
    }

    fn record_clear_votes(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("clear votes");
        recorder.dispatch(&kernels.clear_votes, &bound.clear_votes, workgroups);
    }

    fn record_relocation(kernels: &Kernels, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("relocate");
        recorder.dispatch(&kernels.relocate, &bound.relocate, workgroups);
    }

    fn record_compaction(
        kernels: &Kernels,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Bound,
        entries: u32,
        workgroups: u32,
    ) {
        kernels.waiting.record(gpu, recorder, &bound.waiting, entries, workgroups);
    }

    fn record_grow(_kernels: &Kernels, _recorder: &mut Recorder<'_>, _bound: &Bound, _workgroups: u32) {}

    fn record_finish(
        kernels: &Kernels,
        _gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Bound,
        _blocks: u32,
        workgroups: u32,
    ) {
        kernels.finish.record(recorder, &bound.finish, workgroups);
    }

    fn sums(bound: &Bound) -> &Storage<u32> {
        &bound.finish.sums
    }

    async fn read_result(
        gpu: &Gpu,
        readback: &mut Readback,
        b: &Buffers<2>,
        bound: &Bound,
        finite: usize,
        counters: &Counters,
    ) -> Result<(NearMesh, Vec<u32>), Error> {
        finish::read_result(gpu, readback, b, &bound.finish, finite, counters).await
    }
}
