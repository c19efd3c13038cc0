//! Insertion: the first tetrahedra, picking, splitting, and the points inside (§3.1).

use crate::{
    gpu::{Gpu, Kernel, Recorder, phase1::Buffers, shader},
    input::lattice::Width,
};

/// The kernels of insertion.
#[derive(Debug)]
pub struct Insert {
    locate: Kernel,
    pick_score: Kernel,
    pick_point: Kernel,
    split: Kernel,
    relocate_split: Kernel,
}

/// The bind groups of insertion.
#[derive(Debug)]
pub struct BoundInsert {
    locate: wgpu::BindGroup,
    pick_score: wgpu::BindGroup,
    pick_point: wgpu::BindGroup,
    split: wgpu::BindGroup,
    relocate_split: wgpu::BindGroup,
}

impl Insert {
    /// The kernels.
    pub fn new(gpu: &Gpu, width: Width) -> Self {
        let kernel = |name| Kernel::new(gpu, shader::D3.get(name), width);
        Insert {
            locate: kernel("locate"),
            pick_score: kernel("pick_score"),
            pick_point: kernel("pick_point"),
            split: kernel("split"),
            relocate_split: kernel("relocate_split"),
        }
    }

    /// The bind groups for these buffers.
    pub fn bind(&self, gpu: &Gpu, b: &Buffers<3>) -> BoundInsert {
        let buffers = b.bindings();
        BoundInsert {
            locate: self.locate.bind(gpu, &buffers),
            pick_score: self.pick_score.bind(gpu, &buffers),
            pick_point: self.pick_point.bind(gpu, &buffers),
            split: self.split.bind(gpu, &buffers),
            relocate_split: self.relocate_split.bind(gpu, &buffers),
        }
    }

    /// Records the first tetrahedra.
    pub fn record_first(&self, recorder: &mut Recorder<'_>, bound: &BoundInsert, workgroups: u32) {
        recorder.stage("locate");
        recorder.dispatch(&self.locate, &bound.locate, workgroups);
    }

    /// Records an insertion round.
    pub fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundInsert, b: &Buffers<3>, workgroups: u32) {
        recorder.encoder().clear_buffer(b.messages.buffer(), 0, None);
        recorder.stage("pick");
        recorder.dispatch(&self.pick_score, &bound.pick_score, workgroups);
        recorder.dispatch(&self.pick_point, &bound.pick_point, workgroups);
        recorder.stage("split");
        recorder.dispatch(&self.split, &bound.split, workgroups);
        recorder.stage("relocate after splits");
        recorder.dispatch(&self.relocate_split, &bound.relocate_split, workgroups);
    }
}
