//! Triangulates points that a kernel has made, and counts the lengths of the tetrahedra's edges in
//! another kernel: neither the points nor the mesh are read by this program.
//!
//! `cargo run --release --example resident_mesh`

use gdel::{Backend, Triangulator, wgpu};
use pollster::block_on;
use std::{error::Error, sync::mpsc};

const POINTS: u32 = 20_000;
const BINS: usize = 12;

const WGSL: &str = "
@group(0) @binding(0) var<storage, read_write> points: array<f32>;
@group(0) @binding(1) var<storage, read> tetrahedra: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> bins: array<atomic<u32>>;

@compute @workgroup_size(64)
fn make_points(@builtin(global_invocation_id) id: vec3u) {
    var state = id.x * 747796405u + 2891336453u;
    for (var axis = 0u; axis < 3 && 3 * id.x + 2 < arrayLength(&points); axis++) {
        state = state * 747796405u + 2891336453u;
        let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
        points[3 * id.x + axis] = f32(word >> 8) / 16777216.0;
    }
}

fn point(v: u32) -> vec3f {
    return vec3f(points[3 * v], points[3 * v + 1], points[3 * v + 2]);
}

@compute @workgroup_size(64)
fn count_lengths(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&tetrahedra) {
        return;
    }
    let t = tetrahedra[id.x];
    for (var i = 0u; i < 3; i++) {
        for (var j = i + 1; j < 4; j++) {
            let length = distance(point(t[i]), point(t[j]));
            atomicAdd(&bins[min(u32(100 * length), arrayLength(&bins) - 1)], 1);
        }
    }
}
";

fn main() -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(WGSL.into()),
    });
    let buffer = |size: usize, usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size as u64,
            usage: usage | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    };
    let run = |entry: &str, buffers: &[(u32, &wgpu::Buffer)], workgroups: u32| {
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        });
        let entries: Vec<_> = (buffers.iter())
            .map(|&(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let layout = &pipeline.get_bind_group_layout(0);
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries });
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.dispatch_workgroups(workgroups, 1, 1);
        drop(pass);
        queue.submit([encoder.finish()]);
    };

    let points = buffer(12 * POINTS as usize, wgpu::BufferUsages::STORAGE);
    run("make_points", &[(0, &points)], POINTS.div_ceil(64));
    let triangulator = Triangulator::from_device(device.clone(), queue.clone()).backend(Backend::Gpu);
    let mesh = triangulator.device()?.delaunay3d_from_buffer(&points)?;
    let bins = buffer(4 * BINS, wgpu::BufferUsages::STORAGE);
    let count = mesh.simplex_count();
    run("count_lengths", &[(0, &points), (1, mesh.simplices()), (2, &bins)], (count as u32).div_ceil(64));

    let read = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bins.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(&bins, 0, &read, 0, bins.size());
    queue.submit([encoder.finish()]);
    let (sender, mapped) = mpsc::channel();
    read.map_async(wgpu::MapMode::Read, .., move |result| _ = sender.send(result));
    device.poll(wgpu::PollType::wait_indefinitely())?;
    mapped.recv()??;
    let view = read.get_mapped_range(..)?;
    let lengths: Vec<u32> =
        view.chunks(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect();
    for (bin, edges) in lengths.iter().enumerate() {
        println!("{:.2} {edges:7} {}", 0.01 * bin as f64, "#".repeat(*edges as usize * 200 / (6 * count)));
    }
    assert_eq!(lengths.iter().sum::<u32>() as usize, 6 * count, "every tetrahedron has six edges");
    Ok(())
}
