//! The engine `gpu` gives the same set of tetrahedra as the engine `cpu`.
#![cfg(feature = "gpu")]

#[path = "../shared/clouds.rs"]
mod clouds;
mod d2;
mod d2_trouble;
mod d3;
#[path = "../shared/degenerate.rs"]
mod degenerate;
mod editing;
#[path = "../shared/motions.rs"]
mod motions;
mod moving;
mod outcomes;
mod reading;
mod resident;
mod statistics;
mod tiles;
mod used;

use gdel::{
    Backend, Mesh3, Outputs, Points3,
    internals::{
        Options, cpu,
        gpu::{AdapterChoice, Gpu, engine::GpuEngine},
    },
    verify3d,
};
use pollster::block_on;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

static ENGINE: LazyLock<Mutex<GpuEngine<3>>> = LazyLock::new(|| Mutex::new(open()));

fn open() -> GpuEngine<3> {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a Vulkan driver: scripts/setup.sh");
    block_on(GpuEngine::new(gpu)).expect("the kernels compile")
}

/// The engine that the tests share.
fn engine() -> MutexGuard<'static, GpuEngine<3>> {
    ENGINE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn triangulate<'a>(points: impl Into<Points3<'a>>) -> Mesh3 {
    block_on(engine().triangulate(points.into(), &Options::default())).expect("triangulates")
}

/// Both engines agree, and the GPU's did the work.
fn agree<'a>(points: impl Into<Points3<'a>>) {
    let points = points.into();
    let mesh = triangulate(points);
    assert_eq!(mesh.stats.fallback, None);
    assert_eq!(mesh.stats.backend, Backend::Gpu);
    same(points, &mesh);
    // The same where splaying sees only what it asks for, and the device makes the arrays.
    let resident = block_on(engine().triangulate_resident(points, &Options::default())).expect("triangulates");
    assert_eq!(resident.stats().fallback, None);
    assert!(resident.stats().splay.is_some_and(|splay| splay.gathers > 0), "{:?}", resident.stats());
    same(points, &resident.read(Outputs::ALL).expect("reads"));
}

/// The mesh is the CPU engine's, and the verifier passes.
fn same<'a>(points: impl Into<Points3<'a>>, mesh: &Mesh3) {
    let points = points.into();
    let expected = cpu::delaunay::<3>(points, &Options::default()).expect("triangulates");
    assert_eq!(mesh.dimension, expected.dimension);
    assert_eq!(mesh.duplicate_of, expected.duplicate_of);
    // Not by assert_eq, which would print them all.
    assert!(mesh.canonical() == expected.canonical(), "the engines disagree");
    let report = verify3d(points, mesh).expect("verifies");
    assert!(report.passed(), "{report}");
}
