//! Compute pipelines.

use crate::gpu::{Gpu, shader};
use crate::input::lattice::Width;

/// A compute pipeline with one bind group.
#[derive(Debug, Clone)]
pub struct Kernel {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    label: String,
}

impl Kernel {
    /// The kernel `shaders/{name}.wgsl`, whose entry point is `main`. `constants` set its `override` declarations.
    pub fn new(gpu: &Gpu, name: &str, width: Width, constants: &[(&str, f64)]) -> Self {
        Kernel::from_wgsl(gpu, name, &shader::assemble(name, width), constants)
    }

    /// A kernel of assembled WGSL.
    pub fn from_wgsl(gpu: &Gpu, label: &str, wgsl: &str, constants: &[(&str, f64)]) -> Self {
        let module = gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(wgsl.into()),
        });
        let pipeline = gpu.device().create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                // No kernel reads workgroup memory that it has not written.
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        });
        let layout = pipeline.get_bind_group_layout(0);
        Kernel { pipeline, layout, label: label.to_owned() }
    }

    /// Buffers for this kernel: number *i* at `@group(0) @binding(i)`.
    pub fn bind(&self, gpu: &Gpu, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &entries,
        })
    }

    /// The pipeline.
    pub fn pipeline(&self) -> &wgpu::ComputePipeline {
        &self.pipeline
    }
}
