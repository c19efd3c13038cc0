//! Compute pipelines.

use crate::gpu::{Gpu, shader::Shader};
use crate::input::lattice::Width;

/// A buffer under the name that it has in shaders.
pub type Binding<'a> = (&'static str, &'a wgpu::Buffer);

/// A compute pipeline with one bind group.
#[derive(Debug, Clone)]
pub struct Kernel {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    label: String,
    /// The storage buffers and their bindings.
    variables: Vec<(&'static str, u32)>,
}

impl Kernel {
    /// Compiles a shader.
    pub fn new(gpu: &Gpu, shader: &Shader, width: Width) -> Self {
        Kernel::create(gpu, shader.name(), &shader.wgsl(width), shader.variables().to_vec(), &[])
    }

    /// Compiles WGSL that is not one of this crate's shaders, and whose entry point is `main`.
    /// `variables` are the names of its storage buffers, by binding, and `constants` the values of
    /// its `override` declarations.
    pub fn from_wgsl(
        gpu: &Gpu,
        label: &str,
        wgsl: &str,
        variables: &[&'static str],
        constants: &[(&str, f64)],
    ) -> Self {
        Kernel::create(gpu, label, wgsl, variables.iter().copied().zip(0..).collect(), constants)
    }

    fn create(
        gpu: &Gpu,
        label: &str,
        wgsl: &str,
        variables: Vec<(&'static str, u32)>,
        constants: &[(&str, f64)],
    ) -> Self {
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
        Kernel { pipeline, layout, label: label.to_owned(), variables }
    }

    /// Binds each variable of the shader to the buffer of the same name. There may be buffers that
    /// the shader does not use.
    ///
    /// # Panics
    ///
    /// Panics if there is not exactly one buffer for a variable: a mistake in this crate.
    pub fn bind(&self, gpu: &Gpu, buffers: &[Binding<'_>]) -> wgpu::BindGroup {
        let entry = |&(variable, binding): &(&str, u32)| {
            let mut named = buffers.iter().filter(|(name, _)| *name == variable);
            let (Some((_, buffer)), None) = (named.next(), named.next()) else {
                panic!("kernel {}: not exactly one buffer is named {variable}", self.label);
            };
            wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }
        };
        gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &self.variables.iter().map(entry).collect::<Vec<_>>(),
        })
    }

    /// Returns the pipeline.
    pub fn pipeline(&self) -> &wgpu::ComputePipeline {
        &self.pipeline
    }
}
