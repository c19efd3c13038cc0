//! The GPU host layer: devices, errors, buffers, recording, readback and timing.

use gdel::{
    Error,
    internals::gpu::{AdapterChoice, Gpu, Kernel, Profiler, Readback, Recorder, Storage, adapters, workgroups},
};
use pollster::block_on;

const DOUBLE: &str = "
@group(0) @binding(0) var<storage, read_write> values: array<u32>;
override FACTOR: u32 = 2;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&values); i += groups.x * 256) {
        values[i] *= FACTOR;
    }
}
";

fn open() -> Gpu {
    block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a GPU or lavapipe")
}

#[test]
fn many_dispatches_in_one_submission_and_a_readback() {
    let gpu = open();
    let input: Vec<u32> = (0..100_000).collect();
    let (values, kernel, bindings) = block_on(gpu.with_error_scope("test", || {
        let values = Storage::with_contents(&gpu, "values", &input)?;
        let kernel = Kernel::from_wgsl(gpu.device(), "double", DOUBLE, &["values"], &[("FACTOR", 3.0)]);
        let bindings = kernel.bind(&[("values", values.buffer())]);
        Ok((values, kernel, bindings))
    }))
    .unwrap();
    let mut profiler = Profiler::new(&gpu).unwrap();
    let mut readback = Readback::default();
    let mut recorder = Recorder::new(&gpu, profiler.as_mut());
    for stage in ["first", "second", "first"] {
        recorder.stage(stage);
        recorder.dispatch(&kernel, &bindings, workgroups(1000));
    }
    assert_eq!(recorder.dispatches(), 3);
    let pending = readback.copy(&gpu, recorder.encoder(), &values, 10, 50_000);
    let submission = recorder.submit(&gpu);
    let result = block_on(readback.receive(&gpu, &submission, pending)).unwrap();
    assert_eq!(result, (10..50_010).map(|i| 27 * i).collect::<Vec<u32>>());
    assert_eq!(readback.count(), 1);
    if let Some(profiler) = &mut profiler {
        let times = block_on(profiler.milliseconds(&gpu, &submission)).unwrap();
        assert_eq!(times.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["first", "second"]);
        assert!(times.iter().all(|(_, ms)| ms.is_finite() && *ms >= 0.0), "{times:?}");
    }
}

/// A readback can be awaited while a later submission is still running.
#[test]
fn a_readback_sees_its_own_submission_only() {
    let gpu = open();
    let values = Storage::with_contents(&gpu, "values", &[1u32; 1000]).unwrap();
    let kernel = Kernel::from_wgsl(gpu.device(), "double", DOUBLE, &["values"], &[]);
    let bindings = kernel.bind(&[("values", values.buffer())]);
    let mut readback = Readback::default();
    let mut inflight = Vec::new();
    for _ in 0..5 {
        let mut recorder = Recorder::new(&gpu, None);
        recorder.dispatch(&kernel, &bindings, 1);
        let pending = readback.copy(&gpu, recorder.encoder(), &values, 0, 1000);
        inflight.push((recorder.submit(&gpu), pending));
    }
    for (i, (submission, pending)) in inflight.into_iter().enumerate() {
        assert_eq!(block_on(readback.receive(&gpu, &submission, pending)).unwrap(), vec![2u32 << i; 1000]);
    }
}

/// More pieces than are on their way at a time, of several buffers, one of them empty.
#[test]
fn large_buffers_are_read_piece_by_piece() {
    let gpu = open();
    let words: Vec<u32> = (0..25_000_000).collect();
    let large = Storage::with_contents(&gpu, "large", &words).unwrap();
    let small = Storage::with_contents(&gpu, "small", &[7u32, 8, 9]).unwrap();
    let (mut all, mut some, mut none, mut few) = (vec![0u32; words.len()], vec![0u32; 9_000_000], [0u32; 0], [0u32; 2]);
    let mut readback = Readback::default();
    let targets: [&mut [u32]; 4] = [&mut all, &mut none, &mut few, &mut some];
    let buffers = [&large, &small, &small, &large].map(Storage::buffer);
    let reads = buffers.into_iter().zip(targets.map(|target| -> &mut [u8] { bytemuck::cast_slice_mut(target) }));
    block_on(readback.read_into(&gpu, reads.collect())).unwrap();
    assert!(all == words && some == words[..some.len()]);
    assert_eq!(few, [7, 8]);
    assert_eq!(readback.bytes(), 4 * (25_000_000 + 9_000_000 + 2));
}

#[test]
fn buffers_grow_and_keep_their_contents() {
    let gpu = open();
    let contents: Vec<u32> = (0..1000).collect();
    let mut values = Storage::with_contents(&gpu, "values", &contents).unwrap();
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    values.grow(&gpu, &mut encoder, 500).unwrap();
    assert_eq!(values.len(), 1000);
    values.grow(&gpu, &mut encoder, 1001).unwrap();
    assert_eq!(values.len(), 1500);
    gpu.queue().submit([encoder.finish()]);
    values.write(&gpu, 1499, &[7]);
    let all = block_on(Readback::default().read(&gpu, &values, 0, 1500)).unwrap();
    assert_eq!(all[..1000], contents);
    assert!(all[1000..1499].iter().all(|&v| v == 0));
    assert_eq!(all[1499], 7);
}

#[test]
fn empty_buffers_can_be_bound_and_read() {
    let gpu = open();
    let values = Storage::<u32>::with_contents(&gpu, "values", &[]).unwrap();
    assert!(values.is_empty() && values.bytes() == 16);
    let kernel = Kernel::from_wgsl(gpu.device(), "double", DOUBLE, &["values"], &[]);
    kernel.bind(&[("values", values.buffer())]);
    assert!(block_on(Readback::default().read(&gpu, &values, 0, 0)).unwrap().is_empty());
}

#[test]
fn a_buffer_that_cannot_be_bound_is_a_typed_error() {
    let gpu = open();
    let len = usize::try_from(gpu.max_storage_bytes()).unwrap() / 16 + 1;
    let error = Storage::<[u32; 4]>::new(&gpu, "tetrahedra", len).unwrap_err();
    let Error::BufferTooLarge { label: "tetrahedra", bytes, limit, points: None } = error else { panic!("{error}") };
    assert_eq!((bytes, limit), (16 * len as u128, gpu.max_storage_bytes()));
    assert!(matches!(Storage::<[u32; 4]>::new(&gpu, "all", usize::MAX), Err(Error::BufferTooLarge { .. })));
}

#[test]
fn adapters_are_found_by_index_and_name() {
    let all = block_on(adapters());
    assert!(!all.is_empty(), "the tests need a GPU or lavapipe");
    for (i, adapter) in all.iter().enumerate() {
        assert_eq!(block_on(Gpu::open(&AdapterChoice::Index(i))).unwrap().adapter().name, adapter.name);
    }
    let name = all[0].name.to_uppercase();
    assert_eq!(block_on(Gpu::open(&AdapterChoice::Name(name))).unwrap().adapter().name, all[0].name);
    let error = block_on(Gpu::open(&AdapterChoice::Name("no such".into()))).unwrap_err();
    let available = all.iter().map(|a| a.name.clone()).collect();
    assert_eq!(error, Error::AdapterNotFound { wanted: "no such".into(), available });
    let error = block_on(Gpu::open(&AdapterChoice::Index(99))).unwrap_err();
    assert!(matches!(error, Error::AdapterNotFound { .. }));
}

#[test]
fn only_large_buffers_and_more_of_them_are_asked_for() {
    let limits = open().device().limits();
    let defaults = wgpu::Limits::default();
    // Arrays in parts take so many.
    assert_eq!(limits.max_storage_buffers_per_shader_stage, 32);
    assert_eq!(limits.max_compute_invocations_per_workgroup, defaults.max_compute_invocations_per_workgroup);
    assert_eq!(limits.max_compute_workgroup_storage_size, defaults.max_compute_workgroup_storage_size);
    assert_eq!(limits.max_compute_workgroups_per_dimension, gdel::internals::gpu::MAX_WORKGROUPS);
}

#[test]
fn the_callers_device_is_used() {
    let own = open();
    let gpu = Gpu::from_device(own.device().clone(), own.queue().clone());
    assert_eq!(gpu.adapter().name, own.adapter().name);
    let values = Storage::with_contents(&gpu, "values", &[5u32]).unwrap();
    assert_eq!(block_on(Readback::default().read(&gpu, &values, 0, 1)).unwrap(), [5]);
}

#[test]
fn a_lost_device_is_a_typed_error() {
    let gpu = open();
    let values = Storage::with_contents(&gpu, "values", &[5u32]).unwrap();
    gpu.device().destroy();
    let error = block_on(Readback::default().read(&gpu, &values, 0, 1)).unwrap_err();
    assert!(matches!(error, Error::DeviceLost { .. }), "{error:?}");
}

#[test]
fn mistakes_are_reported_and_do_not_panic() {
    let gpu = open();
    let error = block_on(gpu.with_error_scope("test", || {
        Kernel::from_wgsl(gpu.device(), "broken", "@compute @workgroup_size(1) fn main() { undefined(); }", &[], &[]);
        Ok(())
    }))
    .unwrap_err();
    assert!(matches!(&error, Error::Gpu { reason } if reason.contains("undefined")), "{error:?}");
}
