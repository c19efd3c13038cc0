//! Insertion: the first simplices, the list of waiting points, picking, splitting, and the points
//! inside (§3.1).

use crate::{
    dimension::Dimension,
    gpu::{Compiler, Gpu, Kernel, Recorder, dim::Dim, phase1::buffers::Buffers},
    input::lattice::Width,
};

/// The kernels of insertion.
#[derive(Debug)]
pub(crate) struct Insert {
    /// In a dimension with lists of free slots.
    fill_free: Option<Kernel>,
    start_vertices: Kernel,
    start_mesh: Kernel,
    locate: Kernel,
    begin_round: Kernel,
    pick_score: Kernel,
    pick_point: Kernel,
    split: Kernel,
    relocate_split: Kernel,
}

/// The bind groups of insertion.
#[derive(Debug)]
pub(crate) struct BoundInsert {
    fill_free: Option<wgpu::BindGroup>,
    start_vertices: wgpu::BindGroup,
    start_mesh: wgpu::BindGroup,
    locate: wgpu::BindGroup,
    begin_round: wgpu::BindGroup,
    pick_score: wgpu::BindGroup,
    pick_point: wgpu::BindGroup,
    split: wgpu::BindGroup,
    relocate_split: wgpu::BindGroup,
}

impl Insert {
    /// Creates the kernels of `D` dimensions.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        let kernel = |name| compiler.kernel(Dimension::<D>::SHADERS.get(name), width);
        Insert {
            fill_free: Dimension::<D>::SHADERS.find("fill_free").map(|shader| compiler.kernel(shader, width)),
            start_vertices: kernel("start_vertices"),
            start_mesh: kernel("start_mesh"),
            locate: kernel("locate"),
            begin_round: kernel("begin_round"),
            pick_score: kernel("pick_score"),
            pick_point: kernel("pick_point"),
            split: kernel("split"),
            relocate_split: kernel("relocate_split"),
        }
    }

    /// Binds the kernels to these buffers.
    pub(crate) fn bind<const D: usize>(&self, gpu: &Gpu, b: &Buffers<D>) -> BoundInsert
    where
        Dimension<D>: Dim<D>,
    {
        let buffers = b.bindings();
        BoundInsert {
            fill_free: self.fill_free.as_ref().map(|kernel| kernel.bind(gpu, &buffers)),
            start_vertices: self.start_vertices.bind(gpu, &buffers),
            start_mesh: self.start_mesh.bind(gpu, &buffers),
            locate: self.locate.bind(gpu, &buffers),
            begin_round: self.begin_round.bind(gpu, &buffers),
            pick_score: self.pick_score.bind(gpu, &buffers),
            pick_point: self.pick_point.bind(gpu, &buffers),
            split: self.split.bind(gpu, &buffers),
            relocate_split: self.relocate_split.bind(gpu, &buffers),
        }
    }

    /// Records that the slots of new blocks are free.
    pub(crate) fn record_fill_free(
        &self,
        recorder: &mut Recorder<'_>,
        bound: &BoundInsert,
        stage: &'static str,
        workgroups: u32,
    ) {
        if let (Some(kernel), Some(bindings)) = (&self.fill_free, &bound.fill_free) {
            recorder.stage(stage);
            recorder.dispatch(kernel, bindings, workgroups);
        }
    }

    /// Records the simplices of the start, and which of them each point lies in.
    pub(crate) fn record_first(&self, recorder: &mut Recorder<'_>, bound: &BoundInsert, workgroups: u32) {
        self.record_fill_free(recorder, bound, "start", workgroups);
        recorder.stage("start");
        recorder.dispatch(&self.start_vertices, &bound.start_vertices, workgroups);
        recorder.dispatch(&self.start_mesh, &bound.start_mesh, workgroups);
        recorder.stage("locate");
        recorder.dispatch(&self.locate, &bound.locate, workgroups);
    }

    /// Records the beginning of a round.
    pub(crate) fn record_begin(&self, recorder: &mut Recorder<'_>, bound: &BoundInsert) {
        recorder.stage("begin round");
        recorder.dispatch(&self.begin_round, &bound.begin_round, 1);
    }

    /// Records an insertion round.
    pub(crate) fn record<const D: usize>(
        &self,
        recorder: &mut Recorder<'_>,
        bound: &BoundInsert,
        b: &Buffers<D>,
        workgroups: u32,
    ) where
        Dimension<D>: Dim<D>,
    {
        b.messages.record_clear(recorder.encoder());
        self.record_begin(recorder, bound);
        recorder.stage("pick");
        recorder.dispatch(&self.pick_score, &bound.pick_score, workgroups);
        recorder.dispatch(&self.pick_point, &bound.pick_point, workgroups);
        recorder.stage("split");
        recorder.dispatch(&self.split, &bound.split, workgroups);
        recorder.stage("relocate after splits");
        recorder.dispatch(&self.relocate_split, &bound.relocate_split, workgroups);
    }
}
