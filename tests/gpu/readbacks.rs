//! Waiting for results.

use gdel::{
    internals::gpu::{AdapterChoice, Gpu, wait},
    wgpu,
};
use pollster::block_on;
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

/// wgpu panicked where a wait for a submission timed out while another thread saw that the queue was empty. It took a GPU
/// a dozen runs of a million points, of which two threads read the results.
#[test]
fn threads_wait_for_their_own_submissions() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let buffer = |usage| {
        gpu.device().create_buffer(&wgpu::BufferDescriptor { label: None, size: 256, usage, mapped_at_creation: false })
    };
    let source = buffer(wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::STORAGE);
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                let staging = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
                for _ in 0..4000 {
                    let mut encoder = gpu.device().create_command_encoder(&Default::default());
                    encoder.copy_buffer_to_buffer(&source, 0, &staging, 0, 256);
                    let is_mapped = Arc::new(AtomicBool::new(false));
                    let mapped = Arc::clone(&is_mapped);
                    encoder.map_buffer_on_submit(&staging, wgpu::MapMode::Read, .., move |result| {
                        mapped.store(result.is_ok(), Ordering::Release);
                    });
                    let submission = gpu.queue().submit([encoder.finish()]);
                    let is_done = || is_mapped.load(Ordering::Acquire);
                    // As if it were no software device, which nobody polls.
                    wait(gpu.device(), false, &submission, is_done).expect("a submission");
                    // Another thread may be about to call it.
                    while !is_done() {
                        thread::yield_now();
                    }
                    staging.unmap();
                }
            });
        }
    });
}
