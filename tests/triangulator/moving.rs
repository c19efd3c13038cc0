//! A mesh that follows its points on the device is the one of a run from scratch.

use crate::{motions, same};
use gdel::{
    Backend, DeviceMesh3, Error, Outputs, Points2, Points3, Triangulator,
    internals::{
        Options,
        gpu::{
            phase1::{Budget, Settings},
            update::Limits,
        },
    },
    stats::{Restart, UpdateStats},
};
use pollster::block_on;
use std::ops::ControlFlow;

/// Moves the points of a mesh on the device from step to step, whether that pays or not. Returns
/// what was done at each.
type Follow<const D: usize> = fn(motions::Steps<D>) -> Vec<UpdateStats>;

macro_rules! follow {
    ($name:ident, $D:literal, $points:ident, $engine:expr, $same:path) => {
        fn $name(steps: motions::Steps<$D>) -> Vec<UpdateStats> {
            let mut engine = $engine;
            let default = Settings::<$D>::default();
            let budget = Budget { limits: Limits::NONE, ..default.budget };
            engine.set_settings(Settings { budget, ..default });
            let mut steps = steps.into_iter();
            let points = steps.next().expect("there is a step");
            let options = Options::default();
            let mut mesh = block_on(engine.triangulate_resident((&points).into(), &options)).expect("triangulates");
            let step = |points: Vec<[f64; $D]>| {
                mesh = block_on(engine.update_resident(&mesh, (&points).into(), &options)).expect("updates");
                let update = mesh.stats().update.expect("the mesh was updated");
                println!("{update:?}");
                $same($points::from(&points), &mesh.read(Outputs::ALL).expect("reads"));
                update
            };
            let updates = steps.map(step).collect();
            engine.set_settings(Settings::default());
            updates
        }
    };
}
follow!(follow3, 3, Points3, crate::engine(), crate::same);
follow!(follow2, 2, Points2, crate::d2::engine(), crate::d2::same);

/// The steps were all repairs.
fn repaired(updates: &[UpdateStats]) {
    assert!(updates.iter().all(|update| update.restarted.is_none()), "{updates:?}");
}

macro_rules! both {
    ($($name:ident),* $(,)?) => {
        mod d3 {
            $(#[test] fn $name() { super::$name(super::follow3); })*
        }
        mod d2 {
            $(#[test] fn $name() { super::$name(super::follow2); })*
        }
    };
}
both!(
    displacements_of_all_sizes,
    twenty_steps_without_drift,
    motions_of_grids_spheres_and_clusters,
    points_that_jump,
    points_that_become_equal,
    points_that_become_flat_and_round_again,
    duplicates_that_part,
);

fn displacements_of_all_sizes<const D: usize>(follow: Follow<D>) {
    for n in [300, 2000] {
        for share in motions::DISPLACEMENTS {
            let updates = follow(motions::displaced(n, share));
            // In 2D, flips do not free a vertex that has left its star.
            if share <= if D == 3 { 0.01 } else { 1e-6 } {
                repaired(&updates);
            }
        }
    }
}

fn twenty_steps_without_drift<const D: usize>(follow: Follow<D>) {
    let updates = follow(motions::drifting(800, 0.01, 20));
    // What is not locally Delaunay depends on the points alone, other than the flips that repair it.
    assert!(updates.iter().map(|update| update.not_locally_delaunay).sum::<usize>() > 100);
    if D == 3 {
        repaired(&updates);
    }
}

fn motions_of_grids_spheres_and_clusters<const D: usize>(follow: Follow<D>) {
    follow(motions::rotating_grid());
    follow(motions::trembling_grid());
    follow(motions::breathing_sphere());
    follow(motions::dissolving_sphere());
    follow(motions::passing_clusters().into_iter().step_by(4).collect());
}

fn points_that_jump<const D: usize>(follow: Follow<D>) {
    follow(motions::swapping());
    follow(motions::jumping());
    follow(motions::far_and_back());
}

fn points_that_become_equal<const D: usize>(follow: Follow<D>) {
    let updates = follow(motions::meeting());
    assert_eq!(updates[0].restarted, Some(Restart::Coincident));
    repaired(&updates[1..2]);
    if D == 3 {
        assert_eq!((updates[2].inserted, updates[2].restarted), (3, None));
    }
}

fn points_that_become_flat_and_round_again<const D: usize>(follow: Follow<D>) {
    let updates = follow(motions::flattening());
    assert_eq!(updates.iter().map(|update| update.restarted).collect::<Vec<_>>(), [Some(Restart::Degenerate); 3]);
}

fn duplicates_that_part<const D: usize>(follow: Follow<D>) {
    let updates = follow(motions::parting());
    assert_eq!((updates[0].inserted, updates[0].restarted), (30, None));
    assert_eq!(updates[2].restarted, Some(Restart::Parted));
    let left = follow(motions::leaving())[0];
    assert!(D == 2 || (left.inserted, left.restarted) == (1, None), "{left:?}");
    assert_eq!(follow(motions::changing_sides())[0].restarted, Some(Restart::Coincident));
}

/// Two pyramids over a star of five points, which goes round its axis twice: no tetrahedron is
/// inverted, and every facet is locally Delaunay.
#[test]
fn tetrahedra_that_go_round_twice_are_noticed() {
    let around = |turns: f64| {
        let angle = |i: u32| std::f64::consts::TAU * turns * f64::from(i) / 5.0;
        let rim = (0..5).map(angle).map(|a| [libm::cos(a), libm::sin(a), 0.0]);
        rim.chain([[0.0, 0.0, 0.1], [0.0, 0.0, -0.1]]).collect::<Vec<_>>()
    };
    let updates = follow3(vec![around(1.0), around(2.0)]);
    assert!(updates[0].restarted.is_some());
}

/// The same in the plane, around a point.
#[test]
fn triangles_that_go_round_twice_are_noticed() {
    let around = |turns: f64| {
        let angle = |i: u32| std::f64::consts::TAU * turns * f64::from(i) / 5.0;
        let rim = (0..5).map(angle).map(|a| [libm::cos(a), libm::sin(a)]);
        rim.chain([[0.0, 0.0]]).collect::<Vec<_>>()
    };
    let updates = follow2(vec![around(1.0), around(2.0)]);
    assert_eq!((updates[0].inverted, updates[0].restarted), (0, Some(Restart::Stuck)));
}

/// Each step leaves some vertices to splaying, which gave up most of such steps once.
#[test]
fn steps_of_many_points_are_repairs() {
    let updates = follow3(motions::drifting(12_000, 0.01, 5));
    repaired(&updates);
}

/// After a step that was too far, the next one is prepared for being so, too. After two of them, only
/// every fourth looks at the mesh.
macro_rules! begins_anew_until_steps_are_short {
    ($name:ident, $D:literal, $triangulate:ident, $points:ident, $same:path) => {
        #[test]
        fn $name() {
            let mut points = motions::uniform::<$D>(2000, 14);
            let triangulator = Triangulator::new().backend(Backend::Gpu);
            let mut mesh = triangulator.device().expect("opens").$triangulate(&points).expect("triangulates");
            let (near, far) = (1e-3, 0.5);
            let steps = [near, far, near, far, far, near, near, near, near, far, far, far, far, far, near, near];
            let mut begun_anew = 0;
            for (seed, share) in (1..).zip(steps) {
                points = motions::jitter(&points, share, seed);
                triangulator.update(&mut mesh, &points).expect("updates");
                let update = mesh.stats().update.expect("the mesh was updated");
                let looks = begun_anew < 2 || begun_anew == 4;
                assert_eq!(update.restarted.is_some(), share == far || !looks, "{seed}: {update:?}");
                assert_eq!(update.not_locally_delaunay > 0, looks, "{seed}: {update:?}");
                begun_anew = if update.restarted.is_some() { begun_anew + 1 } else { 0 };
                assert_eq!(mesh.stats().fallback, None);
                $same($points::from(&points), &mesh.read(Outputs::ALL).expect("reads"));
            }
        }
    };
}
begins_anew_until_steps_are_short!(begins_anew_until_steps_are_short3, 3, delaunay3d, Points3, same);
begins_anew_until_steps_are_short!(begins_anew_until_steps_are_short2, 2, delaunay2d, Points2, crate::d2::same);

fn resident(points: &[[f64; 3]]) -> (Triangulator, DeviceMesh3) {
    let triangulator = Triangulator::new().backend(Backend::Gpu);
    let mesh = triangulator.device().expect("opens").delaunay3d(points).expect("triangulates");
    (triangulator, mesh)
}

#[test]
fn cancellation_and_bad_input_leave_the_mesh() {
    let points = motions::uniform::<3>(500, 12);
    let (triangulator, mut mesh) = resident(&points);
    let to = motions::jitter(&points, 0.01, 1);
    for end in 0.. {
        let reports = std::sync::atomic::AtomicUsize::new(0);
        let cancel = move |_| match reports.fetch_add(1, std::sync::atomic::Ordering::Relaxed) {
            i if i >= end => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        match triangulator.clone().on_progress(cancel).update(&mut mesh, &to) {
            Err(Error::Cancelled) => same(&points, &mesh.read(Outputs::ALL).expect("reads")),
            result => {
                result.expect("updates");
                assert!(end > 2, "it cannot be cancelled");
                break;
            }
        }
    }
    same(&to, &mesh.read(Outputs::ALL).expect("reads"));
    let fewer = triangulator.update(&mut mesh, &points[1..]);
    assert_eq!(fewer, Err(Error::PointCount { points: 499, expected: 500 }));
    let mut not_finite = points.clone();
    not_finite[3][1] = f64::NAN;
    let result = triangulator.update(&mut mesh, &not_finite);
    assert!(matches!(result, Err(Error::NotFinite { index: 3, axis: 'y', .. })));
    same(&to, &mesh.read(Outputs::ALL).expect("reads"));
}

#[test]
fn a_mesh_of_another_device_is_made_anew() {
    let points = motions::uniform::<3>(300, 13);
    let (_, mut mesh) = resident(&points);
    let other = Triangulator::new().backend(Backend::Gpu);
    let to = motions::jitter(&points, 0.01, 1);
    let mut follow = |triangulator: &Triangulator| {
        triangulator.update(&mut mesh, &to).expect("updates");
        same(&to, &mesh.read(Outputs::ALL).expect("reads"));
        mesh.stats().update.expect("the mesh was updated").restarted
    };
    assert_eq!(follow(&other), Some(Restart::NotResident));
    assert_eq!(follow(&other), None);
    assert_eq!(follow(&other.clone().backend(Backend::Cpu)), Some(Restart::NotResident));
}
