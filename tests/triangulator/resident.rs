//! Meshes that stay on the device.

use crate::same;
use gdel::{
    Backend, Error, Mesh2, Mesh3, Outputs, Triangulator,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        gpu::{AdapterChoice, Gpu},
    },
    stats::{Fallback, Phase, Stats},
    wgpu,
};
use pollster::block_on;

fn device() -> Gpu {
    block_on(Gpu::open(&AdapterChoice::Default)).expect("a device")
}

fn on(gpu: &Gpu) -> Triangulator {
    Triangulator::from_device(gpu.device().clone(), gpu.queue().clone()).backend(Backend::Gpu)
}

#[test]
fn a_mesh_on_the_device_is_that_of_the_host() {
    let triangulator = on(&device());
    for distribution in [Distribution3::Uniform, Distribution3::Sphere, Distribution3::Grid] {
        let points = generate3d(distribution, 2_000, 5);
        let mesh = triangulator.device().expect("opens").delaunay3d(&points).expect("triangulates");
        assert_eq!((mesh.stats().fallback.as_ref(), mesh.stats().backend), (None, Backend::Gpu));
        let read = mesh.read(Outputs::ALL).expect("reads");
        same(&points, &read);
        assert_eq!(mesh.simplex_count(), read.tetrahedra.len());
        assert_eq!(mesh.hull_count(), read.hull.len());
        assert_eq!(mesh.point_count(), points.len());
        assert_eq!(mesh.dimension(), 3);
        assert_eq!(mesh.read_vertex_simplex().expect("reads"), read.vertex_tetrahedron());
        let bytes = |of: &Mesh3| of.stats.gpu.as_ref().expect("the GPU was used").bytes_read;
        let words = 8 * read.tetrahedra.len() + 3 * read.hull.len();
        let run = mesh.stats().gpu.as_ref().expect("the GPU was used").bytes_read;
        assert_eq!(bytes(&read) - run, 4 * words as u64);
    }
}

#[test]
fn a_mesh_on_the_device_is_that_of_the_host_in_2d() {
    let triangulator = on(&device());
    for distribution in [Distribution2::Uniform, Distribution2::Circle, Distribution2::Grid] {
        let points = generate2d(distribution, 2_000, 5);
        let mesh = triangulator.device().expect("opens").delaunay2d(&points).expect("triangulates");
        assert_eq!((mesh.stats().fallback.as_ref(), mesh.stats().backend), (None, Backend::Gpu));
        let read = mesh.read(Outputs::ALL).expect("reads");
        let expected = triangulator.delaunay2d(&points).expect("triangulates");
        assert!(read.canonical() == expected.canonical() && read.hull == expected.hull);
        let report = gdel::verify2d(&points, &read).expect("verifies");
        assert!(report.passed(), "{report}");
        assert_eq!((mesh.simplex_count(), mesh.hull_count()), (read.triangles.len(), read.hull.len()));
        assert_eq!(mesh.read_vertex_simplex().expect("reads"), read.vertex_triangle());
        // The mesh did not go through the host, of which it takes 24 bytes per triangle.
        let bytes = |of: &Stats| of.gpu.as_ref().expect("the GPU was used").bytes_read;
        let words = 6 * read.triangles.len() + read.hull.len();
        assert_eq!(bytes(&read.stats) - bytes(mesh.stats()), 4 * words as u64);
        assert!(bytes(mesh.stats()) < bytes(&expected.stats), "{distribution:?}: {:?}", mesh.stats());
    }
}

/// Rounding leaves signs open that the true coordinates decide otherwise, or puts points at one place:
/// the host flips, and takes the mesh to the device.
#[test]
fn what_the_host_has_flipped_is_on_the_device_in_2d() {
    let triangulator = on(&device());
    let mut points = generate2d(Distribution2::Uniform, 500, 7);
    // Closer to each other than the points of the lattice.
    points.extend([[1e-25, 2e-25], [3e-25, 1e-25], [2e-25, 5e-25]]);
    let mesh = triangulator.device().expect("opens").delaunay2d(&points).expect("triangulates");
    assert_eq!((mesh.stats().fallback.as_ref(), mesh.stats().backend), (None, Backend::Gpu));
    assert!(mesh.stats().phases.iter().any(|&(phase, _)| phase == Phase::Flip), "{:?}", mesh.stats().phases);
    let read = mesh.read(Outputs::ALL).expect("reads");
    let expected = triangulator.clone().backend(Backend::Cpu).delaunay2d(&points).expect("triangulates");
    assert!(read.canonical() == expected.canonical() && read.hull == expected.hull);
}

#[test]
fn only_what_is_asked_for_is_read() {
    let triangulator = on(&device());
    let mut points = generate3d(Distribution3::Uniform, 500, 3);
    points.extend_from_within(..10);
    let mesh = triangulator.device().expect("opens").delaunay3d(&points).expect("triangulates");
    let all = mesh.read(Outputs::ALL).expect("reads");
    for outputs in [Outputs::NONE, Outputs::SIMPLICES, Outputs::NEIGHBORS, Outputs::HULL | Outputs::SIMPLICES] {
        let read = mesh.read(outputs).expect("reads");
        let has = |output, array: &[u32]| assert_eq!(!array.is_empty(), outputs.contains(output), "{outputs:?}");
        has(Outputs::SIMPLICES, read.tetrahedra.as_flattened());
        has(Outputs::HULL, read.hull.as_flattened());
        assert_eq!(!read.neighbors.is_empty(), outputs.contains(Outputs::NEIGHBORS));
        assert!(read.tetrahedra.is_empty() || read.tetrahedra == all.tetrahedra);
        assert!(read.neighbors.is_empty() || read.neighbors == all.neighbors);
        assert!(read.hull.is_empty() || read.hull == all.hull);
        assert_eq!(read.duplicate_of, all.duplicate_of);
        assert_eq!(read.duplicate_count(), 10);
    }
}

#[test]
fn arrays_are_reused() {
    let triangulator = on(&device());
    let large = triangulator
        .device()
        .expect("opens")
        .delaunay3d(&generate3d(Distribution3::Uniform, 1_000, 3))
        .expect("triangulates");
    let small = triangulator
        .device()
        .expect("opens")
        .delaunay3d(&generate3d(Distribution3::Uniform, 500, 4))
        .expect("triangulates");
    let mut mesh = Mesh3::default();
    large.read_into(Outputs::ALL, &mut mesh).expect("reads");
    let memory = |mesh: &Mesh3| (mesh.tetrahedra.as_ptr(), mesh.neighbors.as_ptr(), mesh.hull.as_ptr());
    let before = memory(&mesh);
    for one in [&small, &large] {
        one.read_into(Outputs::ALL, &mut mesh).expect("reads");
        let fresh = one.read(Outputs::ALL).expect("reads");
        assert!(mesh.tetrahedra == fresh.tetrahedra && mesh.neighbors == fresh.neighbors && mesh.hull == fresh.hull);
        assert_eq!(mesh.duplicate_of, fresh.duplicate_of);
        assert_eq!(memory(&mesh), before);
    }
    large.read_into(Outputs::HULL, &mut mesh).expect("reads");
    assert!(mesh.tetrahedra.is_empty() && mesh.neighbors.is_empty() && !mesh.hull.is_empty());
    assert_eq!(memory(&mesh), before);
}

#[test]
fn a_mesh_outlives_later_runs_and_its_triangulator() {
    let triangulator = on(&device());
    let inputs: Vec<_> = (0..3).map(|seed| generate3d(Distribution3::Uniform, 800, seed)).collect();
    let meshes: Vec<_> =
        inputs.iter().map(|p| triangulator.device().expect("opens").delaunay3d(p).expect("triangulates")).collect();
    drop(triangulator);
    for (points, mesh) in inputs.iter().zip(&meshes) {
        same(points, &mesh.read(Outputs::ALL).expect("reads"));
    }
}

/// Points that the GPU cannot triangulate, and those of a backend that is not asked to.
#[test]
fn what_the_cpu_has_made_is_on_the_device_too() {
    let triangulator = on(&device());
    let flat = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0f64]];
    let mesh = triangulator.device().expect("opens").delaunay3d(&flat).expect("triangulates");
    assert_eq!(mesh.stats().fallback, Some(Fallback::Coplanar));
    assert_eq!((mesh.dimension(), mesh.simplex_count(), mesh.hull_count(), mesh.point_count()), (2, 0, 0, 4));
    same(&flat, &mesh.read(Outputs::ALL).expect("reads"));
    assert_eq!(mesh.read_vertex_simplex().expect("reads"), [gdel::NONE; 4]);

    let line = [[2.0, 0.0], [0.0, 0.0], [1.0, 0.0f64]];
    let mesh = triangulator.device().expect("opens").delaunay2d(&line).expect("triangulates");
    assert_eq!((mesh.dimension(), mesh.simplex_count(), mesh.hull_count()), (1, 0, 3));
    assert_eq!(mesh.read(Outputs::ALL).expect("reads").hull, [1, 2, 0]);

    let empty = triangulator.device().expect("opens").delaunay3d(&Vec::<[f64; 3]>::new()).expect("triangulates");
    assert_eq!((empty.point_count(), empty.read(Outputs::ALL).expect("reads").dimension), (0, 0));

    // The device is opened for the mesh, and once.
    let points = generate3d(Distribution3::Uniform, 300, 1);
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    for _ in 0..2 {
        let mesh = triangulator.device().expect("opens").delaunay3d(&points).expect("triangulates");
        assert_eq!(mesh.stats().backend, Backend::Cpu);
        same(&points, &mesh.read(Outputs::ALL).expect("reads"));
    }
}

#[test]
fn points_in_a_buffer_of_the_device() {
    let gpu = device();
    let triangulator = on(&gpu);
    let points: Vec<[f32; 3]> =
        generate3d(Distribution3::Uniform, 700, 2).iter().map(|p| p.map(|x| x as f32)).collect();
    let buffer = |bytes: &[u8], usage| {
        let descriptor = wgpu::BufferDescriptor {
            label: None,
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        let buffer = gpu.device().create_buffer(&descriptor);
        gpu.queue().write_buffer(&buffer, 0, bytes);
        buffer
    };
    let source = buffer(bytemuck::cast_slice(&points), wgpu::BufferUsages::COPY_SRC);
    let mesh = triangulator.device().expect("opens").delaunay3d_from_buffer(&source).expect("triangulates");
    same(&points, &mesh.read(Outputs::ALL).expect("reads"));

    let flat: Vec<[f32; 2]> = points.iter().map(|&[x, y, _]| [x, y]).collect();
    let source = buffer(bytemuck::cast_slice(&flat), wgpu::BufferUsages::COPY_SRC);
    let mesh = triangulator.device().expect("opens").delaunay2d_from_buffer(&source).expect("triangulates");
    let expected: Mesh2 = triangulator.delaunay2d(&flat).expect("triangulates");
    assert!(mesh.read(Outputs::ALL).expect("reads").canonical() == expected.canonical());

    let error = triangulator
        .device()
        .expect("opens")
        .delaunay3d_from_buffer(&buffer(&[0; 16], wgpu::BufferUsages::COPY_SRC))
        .expect_err("16");
    assert_eq!(error, Error::NotWholePoints { length: 4, dimension: 3 });
    let error = triangulator
        .device()
        .expect("opens")
        .delaunay3d_from_buffer(&buffer(&[0; 48], wgpu::BufferUsages::STORAGE))
        .expect_err("usage");
    assert!(matches!(error, Error::Gpu { .. }), "{error:?}");
    // The triangulator can still be used.
    same(&points, &triangulator.delaunay3d(&points).expect("triangulates"));
}

#[test]
fn reading_after_the_loss_of_the_device_is_an_error() {
    let gpu = device();
    let triangulator = Triangulator::from_gpu(gpu.clone()).backend(Backend::Gpu);
    let points = generate3d(Distribution3::Uniform, 200, 1);
    let mesh = triangulator.device().expect("opens").delaunay3d(&points).expect("triangulates");
    gpu.device().destroy();
    assert!(matches!(mesh.read(Outputs::ALL), Err(Error::DeviceLost { .. })));
    assert!(matches!(mesh.read_vertex_simplex(), Err(Error::DeviceLost { .. })));
    assert!(matches!(
        triangulator.device().and_then(|device| device.delaunay3d(&points)),
        Err(Error::DeviceLost { .. })
    ));
    // The next run opens another device.
    let again = triangulator.device().expect("opens").delaunay3d(&points).expect("triangulates");
    same(&points, &again.read(Outputs::ALL).expect("reads"));

    // The caller's handlers are left alone, so there it is an error of the GPU.
    let gpu = device();
    let mesh = on(&gpu).device().expect("opens").delaunay3d(&points).expect("triangulates");
    gpu.device().destroy();
    assert!(matches!(mesh.read(Outputs::ALL), Err(Error::Gpu { .. } | Error::DeviceLost { .. })));
}

#[test]
fn an_adapter_for_the_callers_device_is_an_error() {
    let points = generate3d(Distribution3::Uniform, 10, 8);
    let triangulator = on(&device()).adapter(AdapterChoice::Default);
    assert_eq!(triangulator.device().expect_err("a contradiction"), Error::AdapterOfDevice);
    for backend in [Backend::Gpu, Backend::Auto, Backend::Cpu] {
        assert_eq!(triangulator.clone().backend(backend).delaunay3d(&points).expect_err("too"), Error::AdapterOfDevice);
    }
}
