//! Compute pipelines.

use crate::{
    gpu::{
        Parts,
        shader::{PART_STRIDE, Shader, Variable, with_int64},
    },
    input::lattice::Width,
};
use std::sync::{Arc, OnceLock};

/// The size of the placeholder for an absent part: no element in a shader is larger.
const EMPTY_BYTES: u64 = 48;

/// A buffer under the name that it has in shaders.
pub type Binding<'a> = (&'static str, &'a wgpu::Buffer);

/// A storage buffer of a shader, or a part of one.
#[derive(Debug, Clone, Copy)]
struct Bound {
    name: &'static str,
    binding: u32,
    /// Which part it is.
    part: usize,
    /// Whether it is the last one.
    is_last: bool,
    read_only: bool,
}

/// Returns the storage buffers of a shader, with each part of those that are in parts.
fn bound(shader: &'static Shader, parts: Option<Parts>) -> Vec<Bound> {
    let whole = |&(name, binding, read_only): &Variable| Bound { name, binding, part: 0, is_last: true, read_only };
    if let Some(parts) = parts {
        let of_variable = |variable: &Variable| {
            let count = if shader.has_in_parts(variable.0) { parts.count() } else { 1 };
            let whole = whole(variable);
            (0..count).map(move |k| Bound {
                binding: whole.binding + k * PART_STRIDE,
                part: k as usize,
                is_last: k + 1 == count,
                ..whole
            })
        };
        return shader.variables().iter().flat_map(of_variable).collect();
    }
    shader.variables().iter().map(whole).collect()
}

/// A compute pipeline with one bind group.
#[derive(Debug, Clone)]
pub struct Kernel {
    label: String,
    variables: Vec<Bound>,
    layout: wgpu::BindGroupLayout,
    device: wgpu::Device,
    /// What the pipeline is compiled from when it is first used; `None` if it was compiled at once.
    shader: Option<(&'static Shader, Width)>,
    /// The size of the parts of its large arrays, if these are in parts.
    parts: Option<Parts>,
    pipeline: Arc<OnceLock<wgpu::ComputePipeline>>,
}

impl Kernel {
    /// Creates the kernel of a shader, whose pipeline is not compiled yet.
    pub(crate) fn new(device: &wgpu::Device, shader: &'static Shader, width: Width, parts: Option<Parts>) -> Self {
        let variables = bound(shader, parts);
        let entry = |&Bound { binding, read_only, .. }: &Bound| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(shader.name()),
            entries: &variables.iter().map(entry).collect::<Vec<_>>(),
        });
        Kernel {
            label: shader.name().to_owned(),
            variables,
            layout,
            device: device.clone(),
            shader: Some((shader, width)),
            parts,
            pipeline: Arc::default(),
        }
    }

    /// Compiles WGSL that is not one of this crate's shaders, and whose entry point is `main`.
    /// `variables` are the names of its storage buffers, by binding, and `constants` the values of
    /// its `override` declarations.
    pub fn from_wgsl(
        device: &wgpu::Device,
        label: &str,
        wgsl: &str,
        variables: &[&'static str],
        constants: &[(&str, f64)],
    ) -> Self {
        let pipeline = compile(device, label, wgsl, None, constants);
        Kernel {
            label: label.to_owned(),
            variables: variables
                .iter()
                .zip(0..)
                .map(|(&name, binding)| Bound { name, binding, part: 0, is_last: true, read_only: false })
                .collect(),
            layout: pipeline.get_bind_group_layout(0),
            device: device.clone(),
            shader: None,
            parts: None,
            pipeline: Arc::new(OnceLock::from(pipeline)),
        }
    }

    /// Binds each variable of the shader to the buffer of the same name, where it is in parts to the
    /// buffers in their order. There may be buffers that the shader does not use.
    ///
    /// # Panics
    ///
    /// Panics if there is no buffer for a variable, or there are too many: a mistake in this crate.
    pub fn bind(&self, buffers: &[Binding<'_>]) -> wgpu::BindGroup {
        let of_variable = |&Bound { name, part, is_last, .. }: &Bound| {
            let mut named = buffers.iter().filter(|(other, _)| *other == name).skip(part);
            let buffer = named.next().map(|&(_, buffer)| buffer);
            let is_complete = (part > 0 || buffer.is_some()) && !(is_last && named.next().is_some());
            assert!(is_complete, "kernel {}: not exactly one buffer is named {name}", self.label);
            buffer
        };
        let found: Vec<Option<&wgpu::Buffer>> = self.variables.iter().map(of_variable).collect();
        // Placeholders for absent parts; never read.
        let missing = found.iter().filter(|buffer| buffer.is_none()).count();
        let descriptor = wgpu::BufferDescriptor {
            label: Some("absent part"),
            size: EMPTY_BYTES,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        };
        let missing: Vec<wgpu::Buffer> = (0..missing).map(|_| self.device.create_buffer(&descriptor)).collect();
        let mut missing = missing.iter();
        let buffers = found.into_iter().map(|buffer| buffer.or_else(|| missing.next()));
        let entries = self.variables.iter().zip(buffers).map(|(variable, buffer)| wgpu::BindGroupEntry {
            binding: variable.binding,
            resource: buffer.expect("there is one for each that is missing").as_entire_binding(),
        });
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &entries.collect::<Vec<_>>(),
        })
    }

    /// Returns whether the pipeline is compiled.
    pub fn is_compiled(&self) -> bool {
        self.pipeline.get().is_some()
    }

    /// Returns the pipeline, and compiles it if that was not done yet. Waits if another thread is
    /// compiling it.
    pub fn pipeline(&self) -> &wgpu::ComputePipeline {
        self.pipeline.get_or_init(|| {
            let (shader, width) = self.shader.expect("what is not a shader was compiled at once");
            if let Some(parts) = self.parts
                && let Some(wgsl) = shader.wgsl_in_parts(width, parts.count())
            {
                return self.compile(&wgsl, &[("PART", f64::from(parts.units()))]);
            }
            self.compile(&shader.wgsl(width), &[])
        })
    }

    /// Compiles the kernel from what `edit` makes of its WGSL.
    pub(crate) fn edited(self, edit: &dyn Fn(String) -> String) -> Self {
        if let Some((shader, width)) = self.shader {
            self.pipeline.get_or_init(|| self.compile(&edit(shader.wgsl(width)), &[]));
        }
        self
    }

    fn compile(&self, wgsl: &str, constants: &[(&str, f64)]) -> wgpu::ComputePipeline {
        let wgsl = match self.device.features().contains(wgpu::Features::SHADER_INT64) {
            true => &*with_int64(wgsl),
            false => wgsl,
        };
        compile(&self.device, &self.label, wgsl, Some(&self.layout), constants)
    }
}

/// Compiles a pipeline, with the layout of its WGSL if none is given.
fn compile(
    device: &wgpu::Device,
    label: &str,
    wgsl: &str,
    layout: Option<&wgpu::BindGroupLayout>,
    constants: &[(&str, f64)],
) -> wgpu::ComputePipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    });
    let layout = layout.map(|layout| {
        device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(layout)],
            ..Default::default()
        })
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(label),
        layout: layout.as_ref(),
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants,
            // No kernel reads workgroup memory that it has not written.
            zero_initialize_workgroup_memory: false,
        },
        cache: None,
    })
}
