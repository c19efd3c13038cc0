//! Flipping: check, commit, link (§3.1, §4.2).

use crate::{
    dimension::Dimension,
    gpu::{Compiler, Gpu, Kernel, Recorder, dim::Dim, phase1::buffers::Buffers},
    input::lattice::Width,
};

/// The kernels of flipping.
#[derive(Debug)]
pub(crate) struct Flip {
    check: Kernel,
    /// In a dimension of which the check leaves open what the filter does.
    check_exact: Option<Kernel>,
    commit: Kernel,
    link: Kernel,
    clear_votes: Kernel,
    /// In a dimension in which a flip beside an inverted simplex may have to wait for another one.
    again: Option<Kernel>,
    /// In a dimension that takes iterations of few simplices in one workgroup. It has all of the
    /// exact arithmetic and is by far the slowest to compile.
    few: Option<Kernel>,
}

/// The bind groups of flipping.
#[derive(Debug)]
pub(crate) struct BoundFlip {
    check: wgpu::BindGroup,
    check_exact: Option<wgpu::BindGroup>,
    commit: wgpu::BindGroup,
    link: wgpu::BindGroup,
    clear_votes: wgpu::BindGroup,
    again: Option<wgpu::BindGroup>,
    few: Option<wgpu::BindGroup>,
}

/// The flip iterations to record.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FlipPlan {
    /// How many.
    pub(crate) iterations: u32,
    /// What the filter leaves open is decided in every so many iterations, or in the last one of fewer.
    pub(crate) exact_every: u32,
    /// Whether iterations of few simplices are done in one workgroup.
    pub(crate) takes_few: bool,
}

impl Flip {
    /// Creates the kernels of `D` dimensions.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        let kernel = |name| compiler.kernel(Dimension::<D>::SHADERS.get(name), width);
        let optional = |name| Dimension::<D>::SHADERS.find(name).map(|shader| compiler.kernel(shader, width));
        let again = Dimension::<D>::SHADERS.find("moved_again");
        let few = Dimension::<D>::SHADERS.find("flip_few").filter(|_| compiler.parts().is_none());
        Flip {
            check: kernel("flip_check"),
            check_exact: optional("flip_check_exact"),
            commit: kernel("flip_commit"),
            link: kernel("flip_link"),
            clear_votes: compiler.on_demand(Dimension::<D>::SHADERS.get("clear_votes"), width),
            again: again.map(|shader| compiler.on_demand(shader, width)),
            few: few.map(|shader| compiler.deferred(shader, width)),
        }
    }

    /// Binds the kernels to these buffers.
    pub(crate) fn bind<const D: usize>(&self, gpu: &Gpu, b: &Buffers<D>) -> BoundFlip
    where
        Dimension<D>: Dim<D>,
    {
        let buffers = b.bindings();
        BoundFlip {
            check: self.check.bind(gpu, &buffers),
            check_exact: self.check_exact.as_ref().map(|kernel| kernel.bind(gpu, &buffers)),
            commit: self.commit.bind(gpu, &buffers),
            link: self.link.bind(gpu, &buffers),
            clear_votes: self.clear_votes.bind(gpu, &buffers),
            again: self.again.as_ref().map(|kernel| kernel.bind(gpu, &buffers)),
            few: self.few.as_ref().map(|kernel| kernel.bind(gpu, &buffers)),
        }
    }

    /// Returns whether iterations of few simplices can be done in one workgroup by now.
    pub(crate) fn takes_few(&self) -> bool {
        self.few.as_ref().is_some_and(Kernel::is_compiled)
    }

    /// Records flip iterations, a dispatch per pass, then, if the plan says so, those of few
    /// simplices in one dispatch.
    /// Those that find too few active simplices do nothing.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, bound: &BoundFlip, plan: FlipPlan, workgroups: u32) {
        let check_exact = self.check_exact.as_ref().zip(bound.check_exact.as_ref());
        for i in 1..=plan.iterations {
            recorder.stage("flip: check");
            recorder.dispatch(&self.check, &bound.check, workgroups);
            let is_last = i == plan.iterations && i < plan.exact_every;
            let is_exact = i.is_multiple_of(plan.exact_every) || is_last;
            if let Some((kernel, bindings)) = check_exact.filter(|_| is_exact) {
                recorder.stage("flip: check exactly");
                recorder.dispatch(kernel, bindings, workgroups);
            }
            recorder.stage("flip: commit");
            recorder.dispatch(&self.commit, &bound.commit, workgroups);
            recorder.stage("flip: link");
            recorder.dispatch(&self.link, &bound.link, workgroups);
        }
        if let Some((kernel, bindings)) = self.few.as_ref().zip(bound.few.as_ref()).filter(|_| plan.takes_few) {
            recorder.stage("flip: few");
            recorder.dispatch(kernel, bindings, 1);
        }
    }

    /// Records that what could not be flipped is to be checked again, in a dimension that may need it.
    pub(crate) fn record_again(&self, recorder: &mut Recorder<'_>, bound: &BoundFlip, workgroups: u32) {
        if let Some((kernel, bindings)) = self.again.as_ref().zip(bound.again.as_ref()) {
            recorder.stage("flip: again");
            recorder.dispatch(kernel, bindings, workgroups);
        }
    }

    /// Records that bids start from the lowest number again.
    pub(crate) fn record_clear_votes(&self, recorder: &mut Recorder<'_>, bound: &BoundFlip, workgroups: u32) {
        recorder.stage("clear votes");
        recorder.dispatch(&self.clear_votes, &bound.clear_votes, workgroups);
    }
}
