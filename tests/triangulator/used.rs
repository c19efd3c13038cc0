//! Meshes in the memory of others that nobody needs any more.

use crate::{clouds, d2, engine, same};
use gdel::{
    Backend, Error, Mesh2, Mesh3, Triangulator,
    internals::{
        Options,
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
    },
};
use pollster::block_on;

#[test]
fn a_mesh_is_the_same_whatever_was_there() {
    let small = generate3d(Distribution3::Uniform, 300, 1);
    let large = generate3d(Distribution3::ThinSphere, 4_000, 2);
    let grid = clouds::grid(8);
    let plane = vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]];
    let mut mesh = Mesh3::default();
    for points in [&small, &large, &small, &plane, &grid, &large] {
        block_on(engine().triangulate_into(points.into(), &Options::default(), &mut mesh)).expect("triangulates");
        assert_eq!(mesh.stats.fallback.is_some(), points.len() == plane.len(), "{:?}", mesh.stats);
        same(points, &mesh);
    }
}

#[test]
fn and_in_the_plane() {
    let mut mesh = Mesh2::default();
    for count in [300, 20_000, 300, 3, 20_000] {
        let points = generate2d(Distribution2::Uniform, count, count as u64);
        block_on(d2::engine().triangulate_into((&points).into(), &Options::default(), &mut mesh))
            .expect("triangulates");
        assert_eq!(mesh.stats.fallback, None, "{count} points");
        d2::same((&points).into(), &mesh);
    }
}

#[test]
fn nothing_is_left_after_an_error() {
    let points = generate3d(Distribution3::Uniform, 300, 1);
    for backend in [Backend::Cpu, Backend::Gpu] {
        let triangulator = Triangulator::new().backend(backend);
        let mut mesh = triangulator.delaunay3d(&points).expect("triangulates");
        let result = triangulator.delaunay3d_into(&[[f64::NAN; 3]], &mut mesh);
        assert!(matches!(result, Err(Error::NotFinite { index: 0, .. })), "{result:?}");
        assert_eq!(mesh.canonical(), Mesh3::default().canonical());
        triangulator.delaunay3d_into(&points, &mut mesh).expect("goes on");
        same(&points, &mesh);
    }
}
