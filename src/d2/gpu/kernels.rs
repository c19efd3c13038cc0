//! The kernels of the plane, and their bind groups.

use crate::d2::gpu::buffers::Buffers;
use crate::{
    Error,
    gpu::{
        Gpu, Kernel, Recorder, Storage,
        primitives::scan::{BoundScan, GROUPS, Scan, ScanParams},
        shader,
        waiting::{BoundWaitingList, WaitingList},
    },
    input::lattice::Width,
};

/// The kernels.
#[derive(Debug)]
pub(crate) struct Kernels {
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
    mesh_mark: Kernel,
    mesh_compact: Kernel,
    scan: Scan,
    waiting: WaitingList,
}

/// Their bind groups.
#[derive(Debug)]
pub(crate) struct Bound {
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
    mesh_mark: wgpu::BindGroup,
    mesh_compact: wgpu::BindGroup,
    scan: BoundScan,
    waiting: BoundWaitingList,
}

impl Bound {
    /// Its entry [`Bound::COUNT`] is the number of triangles of the answer.
    pub(crate) fn sums(&self) -> &Storage<u32> {
        self.scan.sums()
    }

    /// Where in [`Bound::sums`] the number of triangles is.
    pub(crate) const COUNT: usize = GROUPS;

    /// The bytes that they take on the device beside the buffers that they share.
    pub(crate) fn bytes(&self) -> u64 {
        self.waiting.bytes()
    }
}

impl Kernels {
    /// Compiles them.
    pub(crate) fn new(gpu: &Gpu, width: Width) -> Self {
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
            mesh_mark: kernel("mesh_mark"),
            mesh_compact: kernel("mesh_compact"),
            scan: Scan::new(gpu),
            waiting: WaitingList::new(gpu),
        }
    }

    /// The bind groups for these buffers.
    ///
    /// # Errors
    ///
    /// As [`Storage::new`].
    pub(crate) fn bind(&self, gpu: &Gpu, b: &Buffers) -> Result<Bound, Error> {
        let buffers = b.bindings();
        let count = ScanParams { count: b.triangles.len() as u32 };
        let scan_params = Storage::with_contents(gpu, "scan parameters", &[count])?;
        Ok(Bound {
            locate: self.locate.bind(gpu, &buffers),
            pick_score: self.pick_score.bind(gpu, &buffers),
            pick_point: self.pick_point.bind(gpu, &buffers),
            split: self.split.bind(gpu, &buffers),
            relocate_split: self.relocate_split.bind(gpu, &buffers),
            flip_check: self.flip_check.bind(gpu, &buffers),
            flip_commit: self.flip_commit.bind(gpu, &buffers),
            flip_link: self.flip_link.bind(gpu, &buffers),
            clear_votes: self.clear_votes.bind(gpu, &buffers),
            relocate: self.relocate.bind(gpu, &buffers),
            mesh_mark: self.mesh_mark.bind(gpu, &buffers),
            mesh_compact: self.mesh_compact.bind(gpu, &buffers),
            scan: self.scan.bind(gpu, &scan_params, &b.marks, &b.offsets)?,
            waiting: self.waiting.bind(gpu, &b.control, &b.waiting, &b.scores)?,
        })
    }

    /// Records the first triangles.
    pub(crate) fn record_first(&self, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("locate");
        recorder.dispatch(&self.locate, &bound.locate, workgroups);
    }

    /// Records an insertion round.
    pub(crate) fn record_insertion(&self, recorder: &mut Recorder<'_>, bound: &Bound, b: &Buffers, workgroups: u32) {
        recorder.encoder().clear_buffer(b.messages.buffer(), 0, None);
        recorder.stage("pick");
        recorder.dispatch(&self.pick_score, &bound.pick_score, workgroups);
        recorder.dispatch(&self.pick_point, &bound.pick_point, workgroups);
        recorder.stage("split");
        recorder.dispatch(&self.split, &bound.split, workgroups);
        recorder.stage("relocate after splits");
        recorder.dispatch(&self.relocate_split, &bound.relocate_split, workgroups);
    }

    /// Records flip iterations. Those that find too few active triangles do nothing.
    pub(crate) fn record_flips(&self, recorder: &mut Recorder<'_>, bound: &Bound, iterations: u32, workgroups: u32) {
        for _ in 0..iterations {
            recorder.stage("flip: check");
            recorder.dispatch(&self.flip_check, &bound.flip_check, workgroups);
            recorder.stage("flip: commit");
            recorder.dispatch(&self.flip_commit, &bound.flip_commit, workgroups);
            recorder.stage("flip: link");
            recorder.dispatch(&self.flip_link, &bound.flip_link, workgroups);
        }
    }

    /// Records that flip iterations are counted from the start again.
    pub(crate) fn record_clear_votes(&self, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("clear votes");
        recorder.dispatch(&self.clear_votes, &bound.clear_votes, workgroups);
    }

    /// Records the walk along the history.
    pub(crate) fn record_relocation(&self, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("relocate");
        recorder.dispatch(&self.relocate, &bound.relocate, workgroups);
    }

    /// Records the compaction of the list of waiting points, which has `entries` entries.
    pub(crate) fn record_compaction(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Bound,
        entries: u32,
        workgroups: u32,
    ) {
        self.waiting.record(gpu, recorder, &bound.waiting, entries, workgroups);
    }

    /// Records what makes the answer.
    pub(crate) fn record_mesh(&self, recorder: &mut Recorder<'_>, bound: &Bound, workgroups: u32) {
        recorder.stage("mark mesh");
        recorder.dispatch(&self.mesh_mark, &bound.mesh_mark, workgroups);
        recorder.stage("compact mesh");
        self.scan.record(recorder, &bound.scan);
        recorder.dispatch(&self.mesh_compact, &bound.mesh_compact, workgroups);
    }
}
