//! Meshes that the host reads before it splays them, or meanwhile, and those that the device makes of the stars that
//! splaying has changed.

use crate::{clouds, open, same};
use gdel::{
    Error, Mesh3, Points3, Progress,
    internals::{
        Options,
        d3::generate::{Distribution3, generate3d},
        gpu::{
            engine::GpuEngine,
            phase1::{Settings, WayToHost},
        },
    },
    stats::Phase,
};
use pollster::block_on;
use std::{
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
    thread::ThreadId,
};

/// The settings under which stars are gathered for splaying, and the device makes the arrays of the mesh.
fn gathering() -> Settings<3> {
    Settings { way_to_host: Some(WayToHost::MadeOnDevice), ..Settings::default() }
}

/// The settings under which a mesh is read while it is splayed, however small it is.
fn beside() -> Settings<3> {
    Settings { way_to_host: Some(WayToHost::ReadMeanwhile), ..Settings::default() }
}

fn run<'a>(engine: &mut GpuEngine<3>, points: impl Into<Points3<'a>>, settings: Settings<3>) -> Mesh3 {
    engine.set_settings(settings);
    block_on(engine.triangulate(points.into(), &Options::default())).expect("triangulates")
}

/// All ways in which a mesh comes to the host. Some of these inputs have splaying take more tetrahedra away
/// than it adds, others have it insert points, which takes more slots.
#[test]
fn every_way_to_the_host_gives_the_same_mesh() {
    let mut engine = open();
    let mut rounded = generate3d(Distribution3::Uniform, 500, 3);
    rounded.extend((0..40).map(|k| [f64::from(k % 7), f64::from(k % 5), f64::from(k % 3)].map(|x| x * 2f64.powi(-70))));
    let sphere: Vec<_> = generate3d(Distribution3::Sphere, 3_000, 1).iter().map(|p| p.map(|x| x as f32)).collect();
    let (uniform, thin) =
        (generate3d(Distribution3::Uniform, 6_000, 2), generate3d(Distribution3::ThinSphere, 4_000, 1));
    let grid = clouds::grid_64_with_duplicates(5_000);
    let inputs: [Points3<'_>; 5] =
        [(&rounded).into(), (&sphere).into(), (&uniform).into(), (&thin).into(), (&grid).into()];
    let mut has_more = false;
    for (i, points) in inputs.into_iter().enumerate() {
        for insert_all in [false, true] {
            let settings = Settings { insert_all, ..gathering() };
            let mesh = run(&mut engine, points, settings);
            assert_eq!(mesh.stats.fallback, None, "input {i}");
            let splay = mesh.stats.splay.expect("splaying worked");
            assert!(splay.gathers > 0, "input {i}: {splay:?}");
            has_more |= splay.inserted > 0;
            same(points, &mesh);
            let before = run(&mut engine, points, Settings { way_to_host: Some(WayToHost::ReadFirst), ..settings });
            assert_eq!(before.stats.splay.map(|splay| splay.gathers), Some(0), "input {i}");
            same(points, &before);
            let meanwhile = run(&mut engine, points, Settings { insert_all, ..beside() });
            assert!(meanwhile.stats.splay.is_some_and(|splay| splay.gathers > 0), "input {i}: {:?}", meanwhile.stats);
            same(points, &meanwhile);
        }
    }
    assert!(has_more, "splaying has inserted no points");
}

#[test]
fn tiny_inputs() {
    let mut engine = open();
    for n in (5..=50).step_by(3) {
        let inputs = [
            generate3d(Distribution3::Uniform, n, 7),
            clouds::shuffled(&clouds::grid(4), n as u64)[..n.max(20)].to_vec(),
        ];
        for settings in [gathering(), beside()] {
            inputs.iter().for_each(|points| same(points, &run(&mut engine, points, settings)));
        }
    }
}

/// Each array is a piece of its own, or comes in several.
#[test]
fn arrays_in_pieces() {
    let points = generate3d(Distribution3::Uniform, 20_000, 1);
    for settings in [gathering(), beside()] {
        let mut engine = open();
        let mesh = run(&mut engine, &points, settings);
        same(&points, &mesh);

        // A run that is cancelled before its pieces are read, or meanwhile.
        let stop = |progress: Progress| match progress.phase {
            Phase::Splay => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let options = Options { on_progress: Some(Arc::new(stop)), ..Options::default() };
        let result = block_on(engine.triangulate((&points).into(), &options));
        assert_eq!(result.map(|_| ()), Err(Error::Cancelled));
        same(&points, &run(&mut engine, &points, settings));
    }
    let points = generate3d(Distribution3::Uniform, 90_000, 1);
    same(&points, &run(&mut open(), &points, beside()));
}

/// Progress is reported in the calling thread, whichever thread splays.
#[test]
fn reports_come_in_the_calling_thread() {
    let points = generate3d(Distribution3::ThinSphere, 3_000, 9);
    let here: ThreadId = std::thread::current().id();
    let is_elsewhere = Arc::new(AtomicBool::new(false));
    let sink = Arc::clone(&is_elsewhere);
    let watch = move |_: Progress| {
        sink.fetch_or(std::thread::current().id() != here, Relaxed);
        ControlFlow::Continue(())
    };
    let options = Options { on_progress: Some(Arc::new(watch)), ..Options::default() };
    let mut engine = open();
    for settings in [gathering(), beside()] {
        engine.set_settings(settings);
        block_on(engine.triangulate((&points).into(), &options)).expect("triangulates");
    }
    assert!(!is_elsewhere.load(Relaxed));
}

/// A thread of the pool cannot wait for another one, which may be waiting for it.
#[test]
fn the_only_thread_of_a_pool_can_do_it() {
    let points = generate3d(Distribution3::ThinSphere, 3_000, 9);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    for settings in [gathering(), beside()] {
        let mesh = pool.install(|| run(&mut open(), &points, settings));
        assert_eq!(mesh.stats.fallback, None);
        same(&points, &mesh);
    }
}
