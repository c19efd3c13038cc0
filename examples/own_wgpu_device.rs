//! Triangulates on a device that the program has opened itself, as a renderer would.
//!
//! `cargo run --release --example own_wgpu_device`

use gdel::{Backend, Triangulator, wgpu};
use pollster::block_on;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let limits = adapter.limits();
    let (device, queue) = block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        label: Some("renderer"),
        // WebGPU's default limits suffice; larger buffers allow larger inputs.
        required_limits: wgpu::Limits {
            max_buffer_size: limits.max_buffer_size,
            max_storage_buffer_binding_size: limits.max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        },
        ..Default::default()
    }))?;

    // Both share the device with the rest of the program.
    let triangulator = Triangulator::from_device(device.clone(), queue.clone()).backend(Backend::Gpu);
    let points: Vec<[f32; 3]> =
        (0..20_000u32).map(|i| [3, 5, 7].map(|k| (i.wrapping_mul(i) % (10_007 + k)) as f32)).collect();
    let mesh = triangulator.delaunay3d(&points)?;

    let gpu = mesh.stats.gpu.as_ref().ok_or("the points are coplanar")?;
    println!("{} tetrahedra by {} ({})", mesh.tetrahedra.len(), mesh.stats.backend, gpu.adapter);
    println!("{} rounds, {} MiB of GPU memory", gpu.rounds.len(), gpu.bytes >> 20);
    for (phase, time) in &mesh.stats.phases {
        println!("{phase:8} {time:.1?}");
    }
    Ok(())
}
