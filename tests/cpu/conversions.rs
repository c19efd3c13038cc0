//! Points of other crates, serialisation, and what the types promise.

use gdel::{Backend, Error, Triangulator};

#[cfg(feature = "glam")]
#[test]
fn points_of_glam() {
    let points = [glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y, glam::Vec3::Z];
    assert_eq!(gdel::delaunay3d(&points).unwrap().tetrahedra.len(), 1);
    let points = vec![glam::DVec2::ZERO, glam::DVec2::X, glam::DVec2::Y];
    assert_eq!(gdel::delaunay2d(&points).unwrap().hull, [0, 1, 2]);
}

#[cfg(feature = "nalgebra")]
#[test]
fn points_of_nalgebra() {
    use nalgebra::{Point2, Vector3};
    let points = [Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z()].map(|v: Vector3<f64>| v);
    assert_eq!(gdel::delaunay3d(&points).unwrap().tetrahedra.len(), 1);
    let points = vec![Point2::new(0.0f32, 0.0), Point2::new(1.0, 0.0), Point2::new(0.0, 1.0)];
    assert_eq!(gdel::delaunay2d(&points).unwrap().hull, [0, 1, 2]);
}

#[cfg(feature = "ndarray")]
#[test]
fn points_of_ndarray() {
    use gdel::Points;
    use ndarray::{Array2, Axis, Slice, arr2};
    let points = arr2(&[[0.0, 0.0, 9.0], [1.0, 0.0, 9.0], [0.0, 1.0, 9.0]]);
    let mesh = gdel::delaunay3d(Points::try_from(&points).unwrap()).unwrap();
    assert_eq!(mesh.dimension, 2);
    assert_eq!(Points::<3>::try_from(points.view()).unwrap().len(), 3);
    let error = Points::<2>::try_from(&points).unwrap_err();
    assert_eq!(error, Error::ArrayShape { rows: 3, columns: 3, dimension: 2 });
    // Two of three columns are not contiguous.
    let columns = points.slice_axis(Axis(1), Slice::from(..2));
    assert_eq!(Points::<2>::try_from(columns).unwrap_err(), Error::ArrayLayout);
    let copy = columns.as_standard_layout();
    assert_eq!(gdel::delaunay2d(Points::try_from(&copy).unwrap()).unwrap().hull, [0, 1, 2]);
    assert!(Points::<2>::try_from(&Array2::<f32>::zeros((0, 2))).unwrap().is_empty());
}

#[cfg(feature = "mint")]
#[test]
fn points_of_mint() {
    let points = [[0.0f32, 0.0], [1.0, 0.0], [0.0, 1.0]].map(mint::Point2::from);
    assert_eq!(gdel::delaunay2d(&gdel::from_mint2(points)).unwrap().hull, [0, 1, 2]);
    let points = [[0.0f64, 0.0, 0.0], [1.0, 0.0, 0.0]].map(mint::Point3::from);
    assert_eq!(gdel::from_mint3(points), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
}

/// A mesh comes back as it was, but for its statistics; these have stable keys.
#[cfg(feature = "serde")]
#[test]
fn meshes_and_statistics_as_json() {
    use gdel::{Mesh3, stats::Stats};
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
    let mesh = gdel::delaunay3d(&points).unwrap();
    let json = serde_json::to_string(&mesh).unwrap();
    let back: Mesh3 = serde_json::from_str(&json).unwrap();
    assert_eq!((&back.tetrahedra, &back.neighbors, &back.hull), (&mesh.tetrahedra, &mesh.neighbors, &mesh.hull));
    assert_eq!((&back.duplicate_of, back.dimension), (&mesh.duplicate_of, mesh.dimension));
    assert_eq!(back.stats, Stats::default());

    let stats = serde_json::to_value(&mesh.stats).unwrap();
    assert_eq!(stats["backend"], "cpu");
    assert_eq!(stats["fallback"]["reason"], if cfg!(feature = "gpu") { "few-points" } else { "no-gpu" });
    let total: f64 = ["sort", "insert", "finish"].map(|phase| stats["seconds"][phase].as_f64().unwrap()).iter().sum();
    assert!((total - mesh.stats.total_time().as_secs_f64()).abs() < 1e-6);
    assert_eq!(stats.get("trace"), None);
}

/// Executors move futures between threads.
#[test]
fn futures_and_meshes_can_be_sent() {
    fn assert_send(_: impl Send) {}
    fn assert_sync<T: Send + Sync + Clone + 'static>() {}
    let triangulator = Triangulator::new();
    assert_send(triangulator.delaunay3d_async(&[[0.0f64; 3]; 1]));
    assert_send(triangulator.delaunay2d_async(&[[0.0f64; 2]; 1]));
    assert_sync::<Triangulator>();
    assert_sync::<gdel::Mesh3>();
    assert_sync::<gdel::Mesh2>();
    assert_sync::<Error>();
}

/// Without the feature, the GPU is an error that says what to do, and no choice of the automatic
/// backend.
#[cfg(not(feature = "gpu"))]
#[test]
fn a_gpu_that_is_not_compiled_in() {
    use gdel::stats::Fallback;
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
    let error = Triangulator::new().backend(Backend::Gpu).delaunay2d(&points).unwrap_err();
    assert_eq!(error.to_string(), "the GPU cannot be used: gdel was built without the feature `gpu`");
    let mesh = gdel::delaunay2d(&points).unwrap();
    assert_eq!(mesh.stats.fallback, Some(Fallback::NoGpu(error)));
}

#[test]
fn asynchronous_methods_give_the_same_mesh() {
    let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0f64]];
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    let mesh = pollster::block_on(triangulator.delaunay2d_async(&points)).unwrap();
    assert_eq!(mesh.triangles, triangulator.delaunay2d(&points).unwrap().triangles);
    assert_eq!(mesh.stats.fallback, None);
}
