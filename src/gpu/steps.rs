//! Sequences of kernels, as tables.
//!
//! A table names each kernel once, with what is special about it. [`Steps`] are the kernels of a
//! table, [`BoundSteps`] the same with their bind groups, which are recorded again and again.

use crate::{
    dimension::Dimension,
    gpu::{
        Binding, Compiler, Kernel, Recorder,
        dim::Dim,
        shader::{self, Shaders},
    },
    input::lattice::Width,
};

/// A kernel in a table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    /// The name under which the profiler adds up its time.
    stage: &'static str,
    /// The name of its file.
    kernel: &'static str,
    workgroups: Workgroups,
    compiled: Compiled,
    /// Whether 2D does without it.
    only_3d: bool,
    /// Whether runs with arrays in parts do without it.
    only_whole: bool,
}

/// How many workgroups a kernel has.
#[derive(Debug, Clone, Copy)]
enum Workgroups {
    /// As many as the caller says when the sequence is recorded.
    Given,
    /// One, because it decides something for all others, or because its workgroup shares memory.
    One,
}

/// When a kernel is compiled.
#[derive(Debug, Clone, Copy)]
enum Compiled {
    /// Before the first run.
    AtOnce,
    /// When it is recorded for the first time, because few runs need it.
    OnDemand,
    /// While the first run goes on, which does without it.
    Deferred,
}

impl Step {
    /// Creates the step of a kernel that is compiled before the first run of either dimension, and whose
    /// workgroups are counted by the caller.
    pub(crate) const fn new(stage: &'static str, kernel: &'static str) -> Self {
        let (workgroups, compiled) = (Workgroups::Given, Compiled::AtOnce);
        Step { stage, kernel, workgroups, compiled, only_3d: false, only_whole: false }
    }

    /// Returns the same step with one workgroup.
    pub(crate) const fn in_one_workgroup(self) -> Self {
        Step { workgroups: Workgroups::One, ..self }
    }

    /// Returns the same step, which 2D does without.
    pub(crate) const fn only_3d(self) -> Self {
        Step { only_3d: true, ..self }
    }

    /// Returns the same step, which runs with arrays in parts do without.
    pub(crate) const fn only_whole(self) -> Self {
        Step { only_whole: true, ..self }
    }

    /// Returns the same step, whose kernel is compiled when it is recorded for the first time.
    pub(crate) const fn on_demand(self) -> Self {
        Step { compiled: Compiled::OnDemand, ..self }
    }

    /// Returns the same step, whose kernel is compiled while the first run goes on.
    pub(crate) const fn deferred(self) -> Self {
        Step { compiled: Compiled::Deferred, ..self }
    }

    fn kernel(&self, compiler: &Compiler<'_>, shaders: &Shaders, width: Width) -> Kernel {
        let shader = shaders.get(self.kernel);
        match self.compiled {
            Compiled::AtOnce => compiler.kernel(shader, width),
            Compiled::OnDemand => compiler.on_demand(shader, width),
            Compiled::Deferred => compiler.deferred(shader, width),
        }
    }
}

/// The kernels of a table.
#[derive(Debug)]
pub(crate) struct Steps(Vec<(Step, Kernel)>);

impl Steps {
    /// Creates the kernels that `D` dimensions have of a table.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width, table: &[Step]) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        let is_there = |step: &&Step| (D == 3 || !step.only_3d) && (compiler.parts().is_none() || !step.only_whole);
        let kernel = |&step: &Step| (step, step.kernel(compiler, Dimension::<D>::SHADERS, width));
        Steps(table.iter().filter(is_there).map(kernel).collect())
    }

    /// Creates the kernels of a table that are the same in all dimensions.
    pub(crate) fn common(compiler: &Compiler<'_>, table: &[Step]) -> Self {
        Steps(table.iter().map(|&step| (step, step.kernel(compiler, &shader::COMMON, Width::Narrow))).collect())
    }

    /// Binds the kernels to the buffers that have the names of their variables.
    pub(crate) fn bind(&self, buffers: &[Binding<'_>]) -> BoundSteps {
        let bind = |(step, kernel): &(Step, Kernel)| (*step, kernel.clone(), kernel.bind(buffers));
        BoundSteps(self.0.iter().map(bind).collect())
    }

    /// Returns whether there are kernels, and all of them are compiled by now.
    pub(crate) fn are_compiled(&self) -> bool {
        !self.0.is_empty() && self.0.iter().all(|(_, kernel)| kernel.is_compiled())
    }
}

/// The kernels of a table with their bind groups.
#[derive(Debug)]
pub(crate) struct BoundSteps(Vec<(Step, Kernel, wgpu::BindGroup)>);

impl BoundSteps {
    /// Records them in their order, with `workgroups` workgroups each unless the table says otherwise.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, workgroups: u32) {
        let mut stage = "";
        for (step, kernel, bindings) in &self.0 {
            if step.stage != stage {
                stage = step.stage;
                recorder.stage(stage);
            }
            let workgroups = match step.workgroups {
                Workgroups::Given => workgroups,
                Workgroups::One => 1,
            };
            recorder.dispatch(kernel, bindings, workgroups);
        }
    }
}
