//! What the device answers for its meshes, against the exact answers of the host.

use crate::inputs::{inputs2, inputs3, queries};
use gdel::{
    Backend, DeviceLocator, Error, Interpolation, Interpolator, Location, Locator, Mesh, Outputs, Points, Triangulator,
    internals::{
        cpu::MeshOf,
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        derived::StolenMeasures,
        dimension::Dimension,
        geometry::{Euclidean, circumsphere},
        gpu::{AdapterChoice, Gpu, Storage, device_mesh::MeshArrays, dim::Dim},
    },
    wgpu,
};
use pollster::block_on;

/// Returns a triangulator whose meshes are made by the host and taken to the device.
fn triangulator() -> Triangulator {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    on(&gpu)
}

fn on(gpu: &Gpu) -> Triangulator {
    // One thread puts the simplices in the same order each time: walks begin and end alike, and leave as many
    // queries to the host.
    let one = std::num::NonZeroUsize::MIN;
    Triangulator::from_device(gpu.device().clone(), gpu.queue().clone()).backend(Backend::Cpu).threads(one)
}

/// Compares locations with those of the host, from arrays, for one mesh. Returns how many queries
/// the host has answered.
macro_rules! check {
    ($name:expr, $mesh:expr, $points:expr, $queries:expr) => {{
        let (name, mesh, points, queries) = ($name, &$mesh, $points, $queries);
        let read = mesh.read(Outputs::ALL).unwrap();
        let locator = DeviceLocator::new(mesh, points).unwrap();
        let found = locator.locate_many(queries).unwrap();
        let expected = Locator::new(&read, points).unwrap().exact().locate_many(queries).unwrap();
        assert_eq!(found.len(), expected.len(), "{name}");
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            assert_eq!(found, expected, "{name}: query {i} {:?}", Points::from(queries).get(i));
        }
        locator.host_answers()
    }};
}

#[test]
fn locations_are_those_of_the_host_in_3d() {
    let triangulator = triangulator();
    for (name, points) in inputs3() {
        let mesh = triangulator.device().expect("opens").delaunay3d(&points).unwrap();
        let queries = queries(&points);
        let open = check!(name, mesh, &points, &queries);
        println!("{name}: {open} of {} by the host", queries.len());
    }
}

#[test]
fn locations_are_those_of_the_host_in_2d() {
    let triangulator = triangulator();
    for (name, points) in inputs2() {
        let mesh = triangulator.device().expect("opens").delaunay2d(&points).unwrap();
        let queries = queries(&points);
        let open = check!(name, mesh, &points, &queries);
        println!("{name}: {open} of {} by the host", queries.len());
    }
}

/// Coordinates in the precision of both points and queries, and many more of them than simplices to
/// start from, or batches.
#[test]
fn locations_of_many_queries_are_found_by_the_device() {
    let triangulator = triangulator();
    let points = generate3d(Distribution3::Uniform, 20_000, 3);
    let mesh = triangulator.device().expect("opens").delaunay3d(&points).unwrap();
    let around = |r: f64| 1.5 * r - 0.25;
    let queries: Vec<[f64; 3]> = generate3d(Distribution3::Uniform, 40_000, 4).iter().map(|q| q.map(around)).collect();
    assert_eq!(check!("doubles", mesh, &points, &queries), 0);
    let single: Vec<[f32; 3]> = queries.iter().map(|q| q.map(|x| x as f32)).collect();
    assert_eq!(check!("single queries", mesh, &points, &single), 0);

    let points: Vec<[f32; 3]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
    let mesh = triangulator.device().expect("opens").delaunay3d(&points).unwrap();
    assert_eq!(check!("single points", mesh, &points, &queries), 0);
    assert_eq!(check!("single", mesh, &points, &single), 0);

    for distribution in [Distribution3::Sphere, Distribution3::Gaussian, Distribution3::Grid] {
        let points = generate3d(distribution, 5_000, 3);
        let mesh = triangulator.device().expect("opens").delaunay3d(&points).unwrap();
        let queries = generate3d(distribution, 40_000, 4);
        let open = check!(distribution.name(), mesh, &points, &queries);
        assert!(open < 40, "{distribution:?}: the host has answered {open} queries");
    }
}

#[test]
fn locations_of_many_queries_are_found_by_the_device_in_2d() {
    let triangulator = triangulator();
    for distribution in Distribution2::ALL {
        let points = generate2d(distribution, 20_000, 3);
        let mesh = triangulator.device().expect("opens").delaunay2d(&points).unwrap();
        let queries = generate2d(distribution, 40_000, 4);
        let open = check!(distribution.name(), mesh, &points, &queries);
        println!("{distribution:?}: {open} of {} by the host", queries.len());
        // On two lines walks are so long that the device gives some up.
        let limit = if distribution == Distribution2::TwoLines { 4_000 } else { 100 };
        assert!(open < limit, "{distribution:?}: the host has answered {open} queries");
    }
}

/// More batches than are on their way at a time, some of which leave queries to the host.
#[test]
fn locations_of_several_batches() {
    const BATCH: usize = 1 << 20;
    let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [4.0, 4.0], [1.0, 1.5f32]];
    let mesh = triangulator().device().expect("opens").delaunay2d(&points).unwrap();
    let place = |i: usize| [(i % 977) as f32 / 200.0, (i % 1009) as f32 / 210.0];
    let mut queries = Vec::from_iter((0..4 * BATCH + 77).map(place));
    for i in [3, BATCH + 5, 4 * BATCH + 76] {
        queries[i] = [1e30, -1e20];
    }
    assert_eq!(check!("batches", mesh, &points, &queries), 3);
    queries[3 * BATCH + 1][1] = f32::NAN;
    let error = Error::NotFinite { index: 3 * BATCH + 1, axis: 'y', value: "NaN" };
    assert_eq!(DeviceLocator::new(&mesh, &points).unwrap().locate_many(&queries).unwrap_err(), error);
}

/// Queries and answers in buffers, with some that are left to the host.
#[test]
fn locations_in_buffers() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let points: Vec<[f32; 3]> =
        generate3d(Distribution3::Uniform, 1_000, 3).iter().map(|p| p.map(|x| x as f32)).collect();
    let mesh = on(&gpu).device().expect("opens").delaunay3d(&points).unwrap();
    let mut queries = points[..300].to_vec();
    queries.extend([[1e10, 0.5, 0.5], [0.25, 0.5, 0.75], [-1e30, 1e-30, 0.0]]);
    let locator = DeviceLocator::new(&mesh, &points).unwrap();
    let expected = locator.locate_many(&queries).unwrap();
    assert_eq!(locator.host_answers(), 2);
    assert!(
        matches!(expected.get(0), Location::Inside(t) if mesh.read(Outputs::ALL).unwrap().tetrahedra[t].contains(&0))
    );

    let locate = |queries: &[[f32; 3]]| {
        let buffer = Storage::with_contents(&gpu, "queries", queries.as_flattened()).unwrap();
        locator.locate_buffer(buffer.buffer())
    };
    let answers = locate(&queries).unwrap();
    assert_eq!(read(&gpu, &answers), expected.words());
    assert_eq!(read(&gpu, &locate(&queries[300..302]).unwrap()), expected.words()[300..302]);
    let nearest = |queries: &[[f32; 3]]| {
        let buffer = Storage::with_contents(&gpu, "queries", queries.as_flattened()).unwrap();
        locator.nearest_buffer(buffer.buffer())
    };
    let expected: Vec<i32> = locator.nearest_many(&queries).unwrap().iter().map(|v| v.unwrap() as i32).collect();
    assert_eq!(expected[..300], Vec::from_iter(0..300));
    assert_eq!(read(&gpu, &nearest(&queries).unwrap()), expected);
    queries[5][1] = f32::NEG_INFINITY;
    queries[7][0] = f32::NAN;
    let error = Error::NotFinite { index: 5, axis: 'y', value: "-inf" };
    assert_eq!(locate(&queries).unwrap_err(), error);
    assert_eq!(nearest(&queries).unwrap_err(), error);
    assert_eq!(locator.locate_many(&queries).unwrap_err(), error);

    let buffer = Storage::with_contents(&gpu, "queries", &[0.0f32; 4]).unwrap();
    let error = Error::NotWholePoints { length: 4, dimension: 3 };
    assert_eq!(locator.locate_buffer(buffer.buffer()).unwrap_err(), error);
    let unusable = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 12,
        usage: wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    assert!(matches!(locator.locate_buffer(&unusable), Err(Error::Gpu { .. })));
}

fn read(gpu: &Gpu, buffer: &wgpu::Buffer) -> Vec<i32> {
    let mut words = vec![0i32; buffer.size() as usize / 4];
    let target: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
    block_on(gdel::internals::gpu::Readback::default().read_into(gpu, vec![(buffer, target)])).unwrap();
    words
}

#[test]
fn meshes_without_simplices_contain_nothing() {
    let triangulator = triangulator();
    for points in [vec![], vec![[1.0, 2.0]], vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]] {
        let mesh = triangulator.device().expect("opens").delaunay2d(&points).unwrap();
        let locator = DeviceLocator::new(&mesh, &points).unwrap();
        assert_eq!(locator.locate_many(&[[0.0, 0.0f32]]).unwrap().get(0), Location::Nowhere);
        assert!(matches!(locator.locate_many(&[[0.0, f64::NAN]]), Err(Error::NotFinite { index: 0, axis: 'y', .. })));
        assert!(locator.locate_many(Points::F64(&[])).unwrap().is_empty());
    }
}

#[test]
fn what_are_not_the_points_of_the_mesh_is_an_error() {
    let triangulator = triangulator();
    let points = generate2d(Distribution2::Uniform, 300, 3);
    let mesh = triangulator.device().expect("opens").delaunay2d(&points).unwrap();
    let few = DeviceLocator::new(&mesh, &points[..2]).unwrap_err();
    assert_eq!(few, Error::PointCount { points: 2, expected: 300 });
    let mut bad = points.clone();
    bad[2] = [0.0, f64::INFINITY];
    let infinite = DeviceLocator::new(&mesh, &bad).unwrap_err();
    assert_eq!(infinite, Error::NotFinite { index: 2, axis: 'y', value: "inf" });
    // Others as many: any answer or error will do.
    let others: Vec<_> = points.iter().rev().copied().collect();
    let _ = DeviceLocator::new(&mesh, &others).unwrap().locate_many(&points);
}

/// Compares interpolated values with those of the host in double precision.
macro_rules! check_values {
    ($name:expr, $mesh:expr, $points:expr, $queries:expr) => {{
        let (name, mesh, points, queries) = ($name, &$mesh, $points, $queries);
        let values: Vec<f32> = (0..points.len()).map(|i| (i % 97) as f32 - 40.0).collect();
        let double: Vec<f64> = values.iter().map(|&value| value.into()).collect();
        let read = mesh.read(Outputs::ALL).unwrap();
        let found = DeviceLocator::new(mesh, points).unwrap().interpolate_many(&values, queries).unwrap();
        let on_host = Locator::new(&read, points).unwrap().exact();
        let expected = Interpolator::new(&on_host, &double).unwrap();
        let expected = expected.interpolate_many(Interpolation::Linear, queries).unwrap().values;
        assert_eq!(found.len(), expected.len(), "{name}");
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            let is_same = found.is_nan() && expected.is_nan() || (f64::from(*found) - expected).abs() < 2e-4;
            assert!(is_same, "{name}: query {i} {:?}: {found}, not {expected}", queries[i]);
        }
    }};
}

#[test]
fn linear_interpolation_is_that_of_the_host() {
    let triangulator = triangulator();
    for (name, points) in inputs3() {
        let mesh = triangulator.device().expect("opens").delaunay3d(&points).unwrap();
        check_values!(name, mesh, &points, &queries(&points));
    }
    for (name, points) in inputs2() {
        let mesh = triangulator.device().expect("opens").delaunay2d(&points).unwrap();
        check_values!(name, mesh, &points, &queries(&points));
    }
}

/// At the points the values are exact, and what is not a number does not spread.
#[test]
fn values_at_vertices_and_beside_what_is_no_number() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let points: Vec<[f32; 2]> =
        generate2d(Distribution2::Uniform, 500, 3).iter().map(|p| p.map(|x| x as f32)).collect();
    let mesh = on(&gpu).device().expect("opens").delaunay2d(&points).unwrap();
    let locator = DeviceLocator::new(&mesh, &points).unwrap();
    let mut values: Vec<f32> = (0..points.len()).map(|i| 1.0 / (1.0 + i as f32)).collect();
    assert_eq!(locator.interpolate_many(&values, &points).unwrap(), values);
    values[7] = f32::INFINITY;
    assert_eq!(locator.interpolate_many(&values, &points).unwrap(), values);

    let upload = |values: &[f32]| Storage::with_contents(&gpu, "values", values).unwrap();
    let (queries, of_points) = (upload(points.as_flattened()), upload(&values));
    let found = locator.interpolate_buffer(of_points.buffer(), queries.buffer()).unwrap();
    let bits: Vec<i32> = values.iter().map(|value| value.to_bits() as i32).collect();
    assert_eq!(read(&gpu, &found), bits);

    let error = Error::ValueCount { values: 9, points: 500 };
    assert_eq!(locator.interpolate_many(&values[..9], &points).unwrap_err(), error);
    assert_eq!(locator.interpolate_buffer(upload(&values[..9]).buffer(), queries.buffer()).unwrap_err(), error);
}

/// Compares which simplices of a mesh another one also has with what their vertices say. Returns how many these are.
fn check_survivors<const N: usize>(gpu: &Gpu, found: &wgpu::Buffer, simplices: [&[[u32; N]]; 2]) -> usize {
    let key = |simplex: &[u32; N]| {
        let mut key = *simplex;
        key.sort_unstable();
        key
    };
    let [before, after] = simplices;
    let places: std::collections::HashMap<_, _> = before.iter().map(key).zip(0..).collect();
    let expected: Vec<i32> = after.iter().map(|simplex| places.get(&key(simplex)).copied().unwrap_or(-1)).collect();
    // Empty arrays have buffers of 16 bytes.
    assert_eq!(read(gpu, found)[..after.len()], expected);
    expected.iter().filter(|&&survivor| survivor >= 0).count()
}

/// Moves every seventh point.
fn moved<const D: usize>(points: &[[f64; D]]) -> Vec<[f64; D]> {
    let next = points.iter().cycle().skip(1);
    let mix = |(i, (a, b)): (usize, (&[f64; D], &[f64; D]))| {
        if i % 7 == 0 { std::array::from_fn(|k| a[k] + 0.01 * (b[k] - a[k])) } else { *a }
    };
    points.iter().zip(next).enumerate().map(mix).collect()
}

#[test]
fn survivors_are_the_simplices_with_the_same_vertices() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let device = on(&gpu).device().expect("opens");
    let (mut survived, mut gone) = (0, 0);
    for (name, points) in inputs3() {
        let [before, after] = [points.clone(), moved(&points)].map(|points| device.delaunay3d(&points).unwrap());
        let meshes = [&before, &after].map(|mesh| mesh.read(Outputs::SIMPLICES).unwrap());
        let found = after.survivors(before.simplices()).unwrap();
        let count = check_survivors(&gpu, &found, [&meshes[0].tetrahedra, &meshes[1].tetrahedra]);
        println!("{name}: {count} of {}", meshes[1].tetrahedra.len());
        (survived, gone) = (survived + count, gone + meshes[1].tetrahedra.len() - count);
    }
    for (name, points) in inputs2() {
        let [before, after] = [points.clone(), moved(&points)].map(|points| device.delaunay2d(&points).unwrap());
        let meshes = [&before, &after].map(|mesh| mesh.read(Outputs::SIMPLICES).unwrap());
        let found = after.survivors(before.simplices()).unwrap();
        let count = check_survivors(&gpu, &found, [&meshes[0].triangles, &meshes[1].triangles]);
        println!("{name}: {count} of {}", meshes[1].triangles.len());
        (survived, gone) = (survived + count, gone + meshes[1].triangles.len() - count);
    }
    assert!(survived > 1000 && gone > 1000, "{survived} survived, {gone} are gone");
}

#[test]
fn nothing_survives_of_a_mesh_without_simplices() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let device = on(&gpu).device().expect("opens");
    let around = [[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    let [flat, full] =
        [0.0, 1.0].map(|height| around.map(|[x, y, z]| [f64::from(x), f64::from(y), height * f64::from(z)]));
    let [before, after] = [flat, full].map(|points| device.delaunay3d(&points).unwrap());
    assert_eq!((before.simplex_count(), after.simplex_count()), (0, 8));
    assert_eq!(read(&gpu, &after.survivors(before.simplices()).unwrap()), [-1; 8]);
    let [line, full] = [0.0, 1.0].map(|height| around.map(|[x, y, _]| [f64::from(x), height * f64::from(y)]));
    let [before, after] = [line, full].map(|points| device.delaunay2d(&points).unwrap());
    assert_eq!((before.simplex_count(), after.simplex_count()), (0, 4));
    assert_eq!(read(&gpu, &after.survivors(before.simplices()).unwrap()), [-1; 4]);
}

/// Compares nearest vertices, edges and neighbours with those of the host. Returns how many queries
/// the host has answered.
macro_rules! check_nearest {
    ($name:expr, $mesh:expr, $points:expr, $queries:expr) => {{
        let (name, mesh, points, queries) = ($name, &$mesh, $points, $queries);
        let read = mesh.read(Outputs::ALL).unwrap();
        let edges = mesh.edges().unwrap();
        assert!(edges.read_edges().unwrap().into_iter().eq(read.edges()), "{name}");
        assert_eq!(edges.read_vertex_neighbors().unwrap(), read.vertex_neighbors(), "{name}");
        let locator = DeviceLocator::new(mesh, points).unwrap();
        let found = locator.nearest_many(queries).unwrap();
        let expected = Locator::new(&read, points).unwrap().nearest_many(queries).unwrap();
        for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "{name}: query {i} {:?}", queries[i]);
        }
        locator.host_answers()
    }};
}

#[test]
fn nearest_vertices_and_edges_are_those_of_the_host() {
    let triangulator = triangulator();
    for (name, points) in inputs3() {
        let mesh = triangulator.device().expect("opens").delaunay3d(&points).unwrap();
        check_nearest!(name, mesh, &points, &queries(&points));
    }
    for (name, points) in inputs2() {
        let mesh = triangulator.device().expect("opens").delaunay2d(&points).unwrap();
        check_nearest!(name, mesh, &points, &queries(&points));
    }
}

#[test]
fn nearest_vertices_of_many_queries_are_found_by_the_device() {
    let triangulator = triangulator();
    for distribution in [Distribution3::Uniform, Distribution3::Gaussian, Distribution3::Grid] {
        let points = generate3d(distribution, 10_000, 3);
        let mesh = triangulator.device().expect("opens").delaunay3d(&points).unwrap();
        let open = check_nearest!(distribution.name(), mesh, &points, &generate3d(distribution, 20_000, 4));
        assert!(open < 20, "{distribution:?}: the host has answered {open} queries");
    }
    let points = generate2d(Distribution2::Uniform, 20_000, 3);
    let mesh = triangulator.device().expect("opens").delaunay2d(&points).unwrap();
    assert_eq!(check_nearest!("2D", mesh, &points, &generate2d(Distribution2::Uniform, 20_000, 4)), 0);
}

/// Compares circumscribed spheres with those of the host in double precision, from an array and
/// from a buffer. Returns how many the host has computed.
fn check_spheres<const D: usize, const N: usize>(
    gpu: &Gpu,
    name: &str,
    locator: &DeviceLocator<'_, D, N>,
    simplices: &[[u32; N]],
    points: &[[f64; D]],
) -> usize
where
    Dimension<D>: Dim<D> + MeshArrays<D>,
    MeshOf<D>: Mesh<D, N>,
    Euclidean: StolenMeasures<D, N>,
{
    let found = locator.circumspheres().unwrap();
    let open = locator.host_answers();
    assert_eq!(found.len(), simplices.len(), "{name}");
    for (i, (sphere, simplex)) in found.iter().zip(simplices).enumerate() {
        let (center, radius) = circumsphere(&simplex.map(|v| points[v as usize]));
        let tolerance = radius / f64::from(1 << 19) + f64::from(f32::MIN_POSITIVE);
        for (&found, expected) in sphere.iter().zip(center.into_iter().chain([radius])) {
            // Without the range of the exponents of `f32`.
            let is_beyond =
                expected.abs() > 0.999 * f64::from(f32::MAX) && f64::from(found) == expected.signum() * f64::INFINITY;
            let is_near = (f64::from(found) - expected).abs() <= tolerance;
            assert!(is_beyond || is_near, "{name}: {i}: {sphere:?}, not {center:?} and {radius:e}");
        }
    }
    let words = read(gpu, &locator.circumspheres_buffer().unwrap());
    let expected: Vec<i32> = found.as_flattened().iter().map(|x| x.to_bits() as i32).collect();
    assert_eq!(&words[..expected.len()], expected, "{name}");
    assert_eq!(locator.host_answers(), 2 * open, "{name}");
    open
}

/// Points near a plane: most of the tetrahedra are nearly flat.
fn near_a_plane(height: f64) -> Vec<[f64; 3]> {
    let at = |i: u32| [f64::from(i % 8), f64::from(i / 8), height * f64::from(i * i % 11)];
    (0..64).map(at).collect()
}

#[test]
fn circumspheres_are_those_of_the_host() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let triangulator = on(&gpu);
    let uniform = generate3d(Distribution3::Uniform, 5_000, 3);
    let far: Vec<[f64; 3]> = uniform.iter().map(|p| p.map(|x| (x * 1e9).round() * 1e-3 - 7e8)).collect();
    let mut inputs = inputs3();
    inputs.extend([
        ("many", uniform),
        ("far from the origin", far),
        ("sphere", generate3d(Distribution3::Sphere, 2_000, 3)),
        ("near a plane", near_a_plane(f64::EPSILON * 4096.0)),
        ("nearer than the lattice", near_a_plane(1e-17)),
    ]);
    for (name, points) in inputs {
        let mesh = triangulator.device().expect("opens").delaunay3d(&points).unwrap();
        let read = mesh.read(Outputs::SIMPLICES).unwrap();
        let locator = DeviceLocator::new(&mesh, &points).unwrap();
        let open = check_spheres(&gpu, name, &locator, &read.tetrahedra, &points);
        println!("{name}: {open} of {} by the host", read.tetrahedra.len());
        match name {
            "many" | "far from the origin" | "grid of 5³" | "near a plane" => assert_eq!(open, 0, "{name}"),
            "nearer than the lattice" => assert!(open > 0, "{name}"),
            _ => {}
        }
    }
}

#[test]
fn circumscribed_circles_are_those_of_the_host() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let triangulator = on(&gpu);
    let near_a_line =
        |height: f64| (0..60).map(|i| [f64::from(i), height * f64::from(i * i % 7)]).collect::<Vec<[f64; 2]>>();
    let mut inputs = inputs2();
    inputs.extend([
        ("many", generate2d(Distribution2::Uniform, 5_000, 3)),
        ("near a line", near_a_line(f64::EPSILON * 4096.0)),
        ("nearer than the lattice", near_a_line(1e-17)),
    ]);
    for (name, points) in inputs {
        let mesh = triangulator.device().expect("opens").delaunay2d(&points).unwrap();
        let read = mesh.read(Outputs::SIMPLICES).unwrap();
        let locator = DeviceLocator::new(&mesh, &points).unwrap();
        let open = check_spheres(&gpu, name, &locator, &read.triangles, &points);
        println!("{name}: {open} of {} by the host", read.triangles.len());
        match name {
            "many" | "grid of 9²" | "near a line" => assert_eq!(open, 0, "{name}"),
            "nearer than the lattice" => assert!(open > 0, "{name}"),
            _ => {}
        }
    }
}

/// Executors move futures between threads.
#[test]
fn futures_can_be_sent() {
    fn assert_send(_: impl Send) {}
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
    let mesh = triangulator().device().expect("opens").delaunay2d(&points).unwrap();
    let locator = DeviceLocator::new(&mesh, &points).unwrap();
    assert_send(DeviceLocator::new_async(&mesh, &points));
    assert_send(locator.locate_many_async(&points));
    assert_send(locator.nearest_many_async(&points));
    assert_send(locator.interpolate_many_async(&[0.0; 3], &points));
    assert_send(locator.circumspheres_async());
    assert_send(mesh.edges_async());
}
