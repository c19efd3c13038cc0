//! Every way in which a run can end, and that the next one works.

use crate::{clouds, engine, same, triangulate};
use gdel::{
    Backend, Error, Mesh3, Progress, Triangulator,
    internals::{
        Options,
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        gpu::{
            AdapterChoice, Gpu,
            engine::GpuEngine,
            mutation::Mutation,
            phase1::{Budget, Settings},
        },
    },
    stats::{Fallback, Phase},
};
use pollster::block_on;
use std::{
    num::NonZeroUsize,
    ops::ControlFlow,
    sync::{Arc, Mutex},
};

/// The numbers of points from which on [`alone`] takes the GPU where nothing was measured.
const LEAST_3D: usize = 6_120;
const LEAST_2D: usize = 30_001;

/// Returns a triangulator whose choice does not depend on the machine: what one thread takes is not measured, and neither
/// is what software takes.
fn alone(engines: Triangulator) -> Triangulator {
    engines.threads(NonZeroUsize::MIN)
}

fn points() -> Vec<[f64; 3]> {
    generate3d(Distribution3::ThinSphere, 3_000, 9)
}

fn watched(on_progress: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static) -> Options {
    Options { on_progress: Some(Arc::new(on_progress)), ..Options::default() }
}

/// All that a run reports.
fn reports(run: impl FnOnce(&Options) -> Result<Mesh3, Error>) -> (Mesh3, Vec<Progress>) {
    let seen = Arc::new(Mutex::new(Vec::new()));
    let sink = Arc::clone(&seen);
    let options = watched(move |progress| {
        sink.lock().expect("no panic").push(progress);
        ControlFlow::Continue(())
    });
    let mesh = run(&options).expect("triangulates");
    let seen = seen.lock().expect("no panic").clone();
    (mesh, seen)
}

fn assert_monotone(reports: &[Progress]) {
    assert!(reports.is_sorted_by(|a, b| a.fraction <= b.fraction), "{reports:?}");
    assert!(reports[0].fraction >= 0.0 && reports[reports.len() - 1].fraction == 1.0, "{reports:?}");
}

#[test]
fn progress_goes_through_all_phases_and_never_back() {
    let points = points();
    let (mesh, reports) = reports(|options| block_on(engine().triangulate((&points).into(), options)));
    let mut phases: Vec<Phase> = reports.iter().map(|progress| progress.phase).collect();
    let rounds = phases.iter().filter(|&&phase| phase == Phase::Phase1).count();
    assert!(rounds >= mesh.stats.gpu.expect("used").rounds.len());
    phases.dedup();
    assert_eq!(phases, [Phase::Lattice, Phase::Phase1, Phase::Splay, Phase::Finish]);
    assert_monotone(&reports);
}

#[test]
fn progress_goes_on_where_the_cpu_engine_takes_over() {
    let flat: Vec<_> = points().iter().map(|&[x, y, _]| [x, y, 1.0]).collect();
    let (mesh, reports) = reports(|options| block_on(engine().triangulate((&flat).into(), options)));
    assert_eq!(mesh.stats.fallback, Some(Fallback::Coplanar));
    assert!(reports.iter().any(|progress| progress.phase == Phase::Sort));
    assert_monotone(&reports);
}

/// Cancels at every report of a phase, until a run has fewer of them. How many there are after the first one
/// depends on what the device did.
#[test]
fn a_run_can_be_cancelled_at_every_report() {
    let points = points();
    for phase in [Phase::Lattice, Phase::Phase1, Phase::Splay, Phase::Finish] {
        for nth in 1.. {
            let seen = Mutex::new(0);
            let options = watched(move |progress| {
                let mut seen = seen.lock().expect("no panic");
                *seen += usize::from(progress.phase == phase);
                if *seen == nth { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            match block_on(engine().triangulate((&points).into(), &options)) {
                Err(error) => assert_eq!(error, Error::Cancelled, "{phase} {nth}"),
                Ok(mesh) => {
                    assert!(nth > 1, "{phase} is not reported");
                    same(&points, &mesh);
                    break;
                }
            }
        }
    }
}

/// Runs until a phase begins for the `round`th time, then destroys the device.
fn lose_the_device(
    engines: &Triangulator,
    engine: Backend,
    points: &[[f64; 3]],
    phase: Phase,
    round: usize,
) -> Result<Mesh3, Error> {
    let device = block_on(engines.gpu()).expect("opens").device().clone();
    let seen = Mutex::new(0);
    let triangulator = engines.clone().backend(engine).on_progress(move |progress| {
        let mut seen = seen.lock().expect("no panic");
        *seen += usize::from(progress.phase == phase);
        if progress.phase == phase && *seen == round {
            device.destroy();
        }
        ControlFlow::Continue(())
    });
    triangulator.delaunay3d(points)
}

#[test]
fn a_device_lost_in_the_middle_is_an_error_and_the_next_run_opens_another() {
    let engines = Triangulator::new();
    let points = points();
    let all = engines.clone().backend(Backend::Gpu);
    for (phase, round) in [(Phase::Lattice, 1), (Phase::Phase1, 1), (Phase::Phase1, 3)] {
        let result = lose_the_device(&engines, Backend::Gpu, &points, phase, round);
        assert!(matches!(result, Err(Error::DeviceLost { .. })), "{phase} {round}: {result:?}");
        let mesh = all.delaunay3d(&points).expect("a new device");
        assert_eq!(mesh.stats.backend, Backend::Gpu);
        same(&points, &mesh);
    }
}

#[test]
fn auto_goes_on_without_the_device_that_it_lost() {
    let engines = alone(Triangulator::from_gpu(device()));
    let points = generate3d(Distribution3::Uniform, LEAST_3D, 3);
    let result = lose_the_device(&engines, Backend::Auto, &points, Phase::Phase1, 2).expect("the CPU engine goes on");
    assert!(
        matches!(result.stats.fallback, Some(Fallback::GpuFailed(Error::DeviceLost { .. }))),
        "{:?}",
        result.stats.fallback
    );
    same(&points, &result);
}

#[test]
fn auto_takes_the_gpu_where_it_pays() {
    let engines = alone(Triangulator::from_gpu(device()));
    let points = generate3d(Distribution3::Uniform, LEAST_3D, 4);
    let mesh = engines.delaunay3d(&points).expect("triangulates");
    assert_eq!((mesh.stats.backend, mesh.stats.fallback), (Backend::Gpu, None));
    let few = &points[..LEAST_3D - 1];
    let mesh = engines.delaunay3d(few).expect("triangulates");
    let why = Fallback::FewPoints { points: few.len(), least: LEAST_3D };
    assert_eq!((mesh.stats.backend, mesh.stats.fallback), (Backend::Cpu, Some(why)));
}

#[test]
fn auto_takes_the_gpu_in_2d_where_it_pays() {
    let engines = alone(Triangulator::from_gpu(device()));
    let points = generate2d(Distribution2::Uniform, LEAST_2D, 4);
    let auto = |points: &[[f64; 2]]| {
        let mesh = engines.delaunay2d(points).expect("triangulates");
        let expected = engines.clone().backend(Backend::Cpu).delaunay2d(points).expect("triangulates");
        assert_eq!(expected.stats.fallback, None);
        assert_eq!((mesh.canonical(), &mesh.hull), (expected.canonical(), &expected.hull));
        (mesh.stats.backend, mesh.stats.fallback)
    };
    assert_eq!(auto(&points), (Backend::Gpu, None));
    let few = &points[..LEAST_2D - 1];
    assert_eq!(auto(few), (Backend::Cpu, Some(Fallback::FewPoints { points: few.len(), least: LEAST_2D })));
    // The 3D engine, on the same device, is still there.
    let points = generate3d(Distribution3::Uniform, LEAST_3D, 4);
    let mesh = engines.delaunay3d(&points).expect("triangulates");
    assert_eq!((mesh.stats.backend, mesh.stats.fallback), (Backend::Gpu, None));
}

#[test]
fn auto_goes_on_in_2d_without_the_device_that_it_lost() {
    let engines = alone(Triangulator::from_gpu(device()));
    let device = block_on(engines.gpu()).expect("opens").device().clone();
    let points = generate2d(Distribution2::Uniform, LEAST_2D, 5);
    let rounds = Mutex::new(0);
    let watched = engines.clone().on_progress(move |progress| {
        let mut rounds = rounds.lock().expect("no panic");
        *rounds += usize::from(progress.phase == Phase::Phase1);
        if *rounds == 2 {
            device.destroy();
        }
        ControlFlow::Continue(())
    });
    let mesh = watched.delaunay2d(&points).expect("the CPU engine goes on");
    let why = mesh.stats.fallback;
    assert!(matches!(why, Some(Fallback::GpuFailed(Error::DeviceLost { .. }))), "{why:?}");
    // What replaces it was not asked for by name: it has to be hardware, and to pay.
    let mesh = engines.delaunay2d(&points).expect("triangulates");
    assert!(matches!(mesh.stats.fallback, Some(Fallback::Compiling { .. })), "{:?}", mesh.stats.fallback);
}

#[test]
fn a_device_that_passes_its_test_is_used() {
    let engines = Triangulator::new().self_test(true).backend(Backend::Gpu);
    let points = points();
    let mesh = engines.delaunay3d(&points).expect("the device computes what it should");
    assert_eq!((mesh.stats.backend, &mesh.stats.fallback), (Backend::Gpu, &None));
    same(&points, &mesh);
    let points = generate2d(Distribution2::Uniform, 3_000, 5);
    let mesh = engines.delaunay2d(&points).expect("the device computes what it should");
    assert_eq!(mesh.canonical(), gdel::delaunay2d(&points).expect("triangulates").canonical());
}

/// A device that is right, except that it turns one tetrahedron of every mesh over.
fn wrong_device() -> Gpu {
    let edit = |wgsl: String| {
        let wrong = "mesh_tetrahedra[number]=select(points,points.yxzw,number==7);";
        wgsl.replace("mesh_tetrahedra[number]=points;", wrong)
    };
    device().mutated(Some(Mutation { kernel: "d3/mesh_compact", edit: Arc::new(edit) }))
}

#[test]
fn a_wrong_mesh_is_left_to_the_cpu_and_its_device_is_not_used_again() {
    let engines = alone(Triangulator::from_gpu(wrong_device()));
    let points = generate3d(Distribution3::Uniform, LEAST_3D, 4);
    for _ in 0..2 {
        let mesh = engines.delaunay3d(&points).expect("the CPU engine goes on");
        let why = mesh.stats.fallback.as_ref();
        assert!(matches!(why, Some(Fallback::GpuFailed(Error::WrongResults { .. }))), "{why:?}");
        // The second time, nobody asks the device.
        assert_eq!(mesh.stats.wrong_meshes, 1);
        same(&points, &mesh);
    }
    let required = engines.clone().backend(Backend::Gpu);
    assert!(matches!(required.delaunay3d(&points), Err(Error::WrongResults { .. })));
    let plane = generate2d(Distribution2::Uniform, 100, 4);
    assert!(matches!(required.delaunay2d(&plane), Err(Error::WrongResults { .. })));
    // Until it is opened again.
    block_on(engines.close());
    assert_eq!(required.delaunay2d(&plane).expect("2D is right").stats.backend, Backend::Gpu);
    assert!(matches!(required.delaunay3d(&points), Err(Error::WrongResults { .. })));
    assert_eq!(engines.delaunay3d(&points).expect("the CPU engine goes on").stats.wrong_meshes, 2);
}

/// On machines with a hardware GPU this test shows nothing.
#[test]
fn auto_does_not_take_a_software_adapter() {
    let engines = alone(Triangulator::new());
    let points = clouds::grid(20);
    // Grids of 8,000 points: too few at first, and never enough for software.
    let many: Vec<_> =
        (0..4).flat_map(|k| points.iter().map(move |&[x, y, z]| [x, y, z + 20.0 * f64::from(k)])).collect();
    assert!(many.len() >= LEAST_3D);
    let mut why = Vec::new();
    for _ in 0..6 {
        let mesh = engines.delaunay3d(&many).expect("triangulates");
        why.push(mesh.stats.fallback);
    }
    assert_eq!(why[0], Some(Fallback::Compiling { points: many.len() }), "opening does not pay yet: {why:?}");
    if engine().gpu().adapter().software {
        let name = engine().gpu().adapter().name.clone();
        assert_eq!(why[5], Some(Fallback::SoftwareGpu(name)));
    }
}

#[test]
fn a_gpu_that_is_not_there() {
    let engines = Triangulator::new().adapter(AdapterChoice::Name("no such adapter".to_owned()));
    let points = points();
    let error = engines.clone().backend(Backend::Gpu).delaunay3d(&points).expect_err("there is none");
    assert!(matches!(error, Error::AdapterNotFound { .. }), "{error:?}");
    let many = generate3d(Distribution3::Uniform, 200_000, 3);
    let mesh = alone(engines).delaunay3d(&many).expect("triangulates");
    assert!(matches!(mesh.stats.fallback, Some(Fallback::NoGpu(_))), "{:?}", mesh.stats.fallback);
}

/// The tests' device.
fn device() -> Gpu {
    block_on(Gpu::open(&AdapterChoice::Default)).expect("a device")
}

/// A device of the tests' adapter whose buffers can have at most so many bytes.
fn device_with_small_buffers(bytes: u64) -> Gpu {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).expect("an adapter");
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits {
            max_storage_buffer_binding_size: bytes,
            max_buffer_size: bytes,
            ..wgpu::Limits::default()
        },
        ..Default::default()
    };
    let (device, queue) = block_on(adapter.request_device(&descriptor)).expect("a device");
    Gpu::from_device(device, queue)
}

/// A GPU engine on such a device.
fn with_small_buffers(bytes: u64) -> GpuEngine<3> {
    block_on(GpuEngine::new(device_with_small_buffers(bytes))).expect("the kernels compile")
}

#[test]
fn an_input_that_is_too_large_is_an_error_that_says_what_would_fit() {
    let mut engine = with_small_buffers(1 << 20);
    let points = generate3d(Distribution3::Uniform, 20_000, 3);
    let error = block_on(engine.triangulate((&points).into(), &Options::default())).expect_err("1 MiB is not enough");
    let Error::BufferTooLarge { bytes, limit, points: Some(fitting), .. } = error else { panic!("{error:?}") };
    assert!(bytes > limit.into() && limit == 1 << 20);
    assert!((1_000..20_000).contains(&fitting), "{fitting}");
    assert!(error.to_string().contains(&format!("{fitting} points")), "{error}");
    // That many do fit, and the engine can still be used.
    let fewer = &points[..fitting];
    let mesh = block_on(engine.triangulate(fewer.into(), &Options::default())).expect("fits");
    assert_eq!((mesh.stats.backend, &mesh.stats.fallback), (Backend::Gpu, &None));
    same(fewer, &mesh);
    let one_more = block_on(engine.triangulate(points[..fitting + 1].into(), &Options::default()));
    assert!(matches!(one_more, Err(Error::BufferTooLarge { .. })));
}

/// Two skew lines have a quadratic number of tetrahedra, so the buffers have to grow past what
/// there may be.
#[test]
fn a_triangulation_that_outgrows_the_device_is_an_error() {
    let mut engine = with_small_buffers(1 << 20);
    // Flips wait for each other here, and the CPU engine would take over.
    let default = Settings::<3>::default();
    let budget = Budget { spare_iterations: u32::MAX, ..default.budget };
    engine.set_settings(Settings { budget, ..default });
    let lines = clouds::two_skew_lines(400);
    let error = block_on(engine.triangulate((&lines).into(), &Options::default())).expect_err("1 MiB is not enough");
    let Error::BufferTooLarge { points: Some(fitting), .. } = error else { panic!("{error:?}") };
    assert!(fitting < lines.len());
    let fewer = clouds::two_skew_lines(40);
    same(&fewer, &block_on(engine.triangulate((&fewer).into(), &Options::default())).expect("fits"));
}

/// Every segment of one line makes a tetrahedron with every segment of the other, and every two
/// points of a moment curve are neighbours: many flips have to come before others can.
#[test]
fn flips_that_wait_for_each_other_are_left_to_the_cpu_early() {
    let inputs = [
        ("two skew lines", clouds::two_skew_lines(300)),
        ("moment curve", clouds::moment_curve(600)),
        ("circle and axis", clouds::circle_and_its_axis(300)),
    ];
    for (name, points) in inputs {
        let mesh = triangulate(&points);
        assert_eq!((mesh.stats.backend, &mesh.stats.fallback), (Backend::Cpu, &Some(Fallback::Flips)), "{name}");
        let gpu = mesh.stats.gpu.as_ref().expect("it tried");
        println!("{name}: {} iterations, {} flips", gpu.flip_iterations, gpu.flips_23 + gpu.flips_32);
        assert!(!gpu.rounds.is_empty() && gpu.readbacks > 0 && gpu.dispatches > 0 && gpu.bytes > 0);
        same(&points, &mesh);
    }
    // The engine can still be used.
    let cylinder = clouds::cylinder(600);
    let mesh = triangulate(&cylinder);
    assert_eq!((mesh.stats.backend, &mesh.stats.fallback), (Backend::Gpu, &None));
    same(&cylinder, &mesh);
}

/// Points in the planes of the hull keep no flips waiting. Of such inputs, the references of the kernels count
/// rounds and iterations.
#[test]
fn rasters_and_full_grids_are_not_left_to_the_cpu() {
    let inputs = [
        ("raster", clouds::raster(60, 1.0)),
        ("raster, unrounded", clouds::raster(60, 0.0)),
        ("terrain", clouds::terrain(60, 0.7, 0.0)),
        ("terrain, whole heights", clouds::terrain(60, 0.7, 1.0)),
        ("full grid", clouds::grid(16)),
        ("full grid, shuffled", clouds::shuffled(&clouds::grid(16), 1)),
        ("flat ground", clouds::flat_ground(2_000)),
    ];
    for (name, points) in inputs {
        let mesh = triangulate(&points);
        assert_eq!(mesh.stats.fallback, None, "{name}");
        same(&points, &mesh);
    }
}

#[test]
fn auto_goes_on_without_a_gpu_that_is_too_small() {
    let engines = Triangulator::from_gpu(device_with_small_buffers(1 << 20));
    let points = generate3d(Distribution3::Uniform, 24_000, 3);
    let mesh = engines.delaunay3d(&points).expect("the CPU engine goes on");
    assert!(matches!(mesh.stats.fallback, Some(Fallback::GpuFailed(Error::BufferTooLarge { .. }))));
    same(&points, &mesh);
}

/// The 2D engine shares the device with the 3D engine: neither is left with one that is gone.
#[test]
fn a_device_that_was_given_back_is_opened_anew_for_both_engines() {
    let engines = Triangulator::new().backend(Backend::Gpu);
    let cube = clouds::grid(3);
    let square: Vec<[f64; 2]> = (0..9).map(|i| [i % 3, i / 3].map(f64::from)).collect();
    for _ in 0..2 {
        let mesh = engines.delaunay3d(&cube).expect("opens a device");
        assert_eq!(mesh.stats.backend, Backend::Gpu);
        let mesh = engines.delaunay2d(&square).expect("has the device of the other");
        assert_eq!(mesh.stats.backend, Backend::Gpu);
        block_on(engines.close());
        let mesh = engines.delaunay2d(&square).expect("opens a device");
        assert_eq!(mesh.triangles.len(), 8);
        // Only the 2D engine is open now.
        block_on(engines.close());
    }
}

/// wgpu refuses what goes beyond a hundredth of the memory that the driver says there is.
#[test]
#[ignore = "needs a device with 140 GB and a driver that tells its budget of memory"]
fn a_device_whose_memory_is_exhausted_is_an_error_and_goes_on() {
    let descriptor = wgpu::InstanceDescriptor {
        memory_budget_thresholds: wgpu::MemoryBudgetThresholds {
            for_resource_creation: Some(1),
            for_device_loss: None,
        },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    let adapter = block_on(wgpu::Instance::new(descriptor).request_adapter(&Default::default())).expect("an adapter");
    let limits = adapter.limits();
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) = block_on(adapter.request_device(&descriptor)).expect("a device");
    let mut engine = block_on(GpuEngine::new(Gpu::from_device(device, queue))).expect("compiles");
    let (few, many) = (points(), generate3d(Distribution3::Uniform, 3_000_000, 9));
    for _ in 0..2 {
        let result = block_on(engine.triangulate((&many).into(), &Options::default()));
        assert!(matches!(result, Err(Error::OutOfDeviceMemory { .. })), "{:?}", result.map(|mesh| mesh.stats));
        let mesh = block_on(engine.triangulate((&few).into(), &Options::default())).expect("triangulates");
        assert_eq!(mesh.stats.fallback, None);
        same(&few, &mesh);
    }
}
