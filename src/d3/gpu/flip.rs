//! Flipping: check, commit, link (§3.1, §4.2).

use crate::{
    gpu::{
        Gpu, Kernel, Recorder,
        phase1::{Buffers, FlipPlan},
        shader,
    },
    input::lattice::Width,
};

/// The kernels of flipping.
#[derive(Debug)]
pub struct Flip {
    check: Kernel,
    check_exact: Kernel,
    commit: Kernel,
    link: Kernel,
    compact: Kernel,
    clear_votes: Kernel,
}

/// The bind groups of flipping.
#[derive(Debug)]
pub struct BoundFlip {
    check: wgpu::BindGroup,
    check_exact: wgpu::BindGroup,
    commit: wgpu::BindGroup,
    link: wgpu::BindGroup,
    compact: wgpu::BindGroup,
    clear_votes: wgpu::BindGroup,
}

impl Flip {
    /// The kernels.
    pub fn new(gpu: &Gpu, width: Width) -> Self {
        let kernel = |name| Kernel::new(gpu, shader::D3.get(name), width);
        Flip {
            check: kernel("flip_check"),
            check_exact: kernel("flip_check_exact"),
            commit: kernel("flip_commit"),
            link: kernel("flip_link"),
            compact: kernel("flip_compact"),
            clear_votes: kernel("clear_votes"),
        }
    }

    /// The bind groups for these buffers.
    pub fn bind(&self, gpu: &Gpu, b: &Buffers<3>) -> BoundFlip {
        let buffers = b.bindings();
        BoundFlip {
            check: self.check.bind(gpu, &buffers),
            check_exact: self.check_exact.bind(gpu, &buffers),
            commit: self.commit.bind(gpu, &buffers),
            link: self.link.bind(gpu, &buffers),
            compact: self.compact.bind(gpu, &buffers),
            clear_votes: self.clear_votes.bind(gpu, &buffers),
        }
    }

    /// Records flip iterations. Those that find too few active tetrahedra do nothing.
    pub fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundFlip, plan: FlipPlan, workgroups: u32) {
        let FlipPlan { iterations, exact_every, compacts } = plan;
        for i in 1..=iterations {
            recorder.stage("flip: check");
            recorder.dispatch(&self.check, &bound.check, workgroups);
            if i.is_multiple_of(exact_every) || i == iterations {
                recorder.stage("flip: check exactly");
                recorder.dispatch(&self.check_exact, &bound.check_exact, workgroups);
            }
            recorder.stage("flip: commit");
            recorder.dispatch(&self.commit, &bound.commit, workgroups);
            recorder.stage("flip: link");
            recorder.dispatch(&self.link, &bound.link, workgroups);
            if compacts {
                recorder.stage("flip: compact");
                recorder.dispatch(&self.compact, &bound.compact, workgroups);
            }
        }
    }

    /// Records that flip iterations are counted from the start again.
    pub fn record_clear_votes(&self, recorder: &mut Recorder<'_>, bound: &BoundFlip, workgroups: u32) {
        recorder.stage("clear votes");
        recorder.dispatch(&self.clear_votes, &bound.clear_votes, workgroups);
    }
}
