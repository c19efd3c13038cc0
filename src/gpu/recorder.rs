//! Recording: many dispatches in one compute pass and one submission, or in several where a device takes long for them.

use crate::gpu::{Gpu, Kernel, Profiler};

/// Records commands, and submits them.
pub struct Recorder<'a> {
    encoder: wgpu::CommandEncoder,
    pass: Option<wgpu::ComputePass<'static>>,
    profiler: Option<&'a mut Profiler>,
    dispatches: usize,
    /// Those that are submitted already.
    submitted: usize,
}

impl<'a> Recorder<'a> {
    /// Starts recording. With a profiler each stage is a compute pass of its own, because browsers
    /// write timestamps only at the ends of passes; without one all stages share a pass.
    pub fn new(gpu: &Gpu, profiler: Option<&'a mut Profiler>) -> Self {
        Recorder { encoder: encoder(gpu), pass: None, profiler, dispatches: 0, submitted: 0 }
    }

    /// Times the dispatches from here on under `name`.
    pub fn stage(&mut self, name: &'static str) {
        if let Some(profiler) = &mut self.profiler {
            self.pass = None;
            let timestamp_writes = profiler.begin(name);
            let descriptor = wgpu::ComputePassDescriptor { label: Some(name), timestamp_writes };
            self.pass = Some(self.encoder.begin_compute_pass(&descriptor).forget_lifetime());
        }
    }

    /// Runs `kernel` in a grid of `workgroups` in one dimension.
    pub fn dispatch(&mut self, kernel: &Kernel, bindings: &wgpu::BindGroup, workgroups: u32) {
        let encoder = &mut self.encoder;
        let pass = self.pass.get_or_insert_with(|| encoder.begin_compute_pass(&Default::default()).forget_lifetime());
        pass.set_pipeline(kernel.pipeline());
        pass.set_bind_group(0, bindings, &[]);
        pass.dispatch_workgroups(workgroups, 1, 1);
        self.dispatches += 1;
    }

    /// Returns the encoder, for copies; this ends the compute pass.
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.pass = None;
        &mut self.encoder
    }

    /// Returns the number of dispatches so far.
    pub fn dispatches(&self) -> usize {
        self.dispatches
    }

    /// Submits what was recorded if these are so many dispatches, and goes on in another submission, so that the device
    /// can do something else in between. What is profiled stays together.
    pub fn split(&mut self, gpu: &Gpu, dispatches: usize) {
        if self.profiler.is_none() && self.dispatches - self.submitted >= dispatches {
            self.pass = None;
            let recorded = std::mem::replace(&mut self.encoder, encoder(gpu));
            gpu.queue().submit([recorded.finish()]);
            self.submitted = self.dispatches;
        }
    }

    /// Submits what was recorded.
    pub fn submit(mut self, gpu: &Gpu) -> wgpu::SubmissionIndex {
        self.pass = None;
        if let Some(profiler) = &mut self.profiler {
            profiler.resolve(gpu, &mut self.encoder);
        }
        gpu.queue().submit([self.encoder.finish()])
    }
}

fn encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("gdel") })
}
