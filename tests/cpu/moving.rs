//! A mesh that follows its points is the one of a run from scratch.

use crate::motions;
use gdel::{
    Backend, Error, Mesh2, Mesh3, Moving, Points2, Points3, Triangulator,
    internals::{
        Options,
        cpu::update::{Limits, update},
    },
    stats::{Restart, UpdateStats},
};
use std::{num::NonZeroUsize, ops::ControlFlow};

fn cpu() -> Triangulator {
    Triangulator::new().backend(Backend::Cpu)
}

/// The simplices, the hull, the duplicates and the dimension: all that points determine.
type Answer = (Vec<Vec<u32>>, Vec<Vec<u32>>, Vec<i32>, u8);

/// A dimension's meshes.
trait Case<const D: usize>: Moving + Clone {
    fn scratch(points: &[[f64; D]]) -> Self;
    fn go_to(&mut self, triangulator: &Triangulator, points: &[[f64; D]]) -> Result<(), Error>;
    /// Repairs the mesh, whether that pays or not.
    fn repair(&self, points: &[[f64; D]], threads: Option<NonZeroUsize>) -> (Option<Self>, UpdateStats);
    fn answer(&self) -> Answer;
    fn update(&self) -> UpdateStats;
}

impl Case<3> for Mesh3 {
    fn scratch(points: &[[f64; 3]]) -> Self {
        cpu().delaunay3d(points).expect("triangulates")
    }

    fn go_to(&mut self, triangulator: &Triangulator, points: &[[f64; 3]]) -> Result<(), Error> {
        triangulator.update(self, Points3::from(points))
    }

    fn repair(&self, points: &[[f64; 3]], threads: Option<NonZeroUsize>) -> (Option<Self>, UpdateStats) {
        let options = Options { threads, ..Options::default() };
        update::<3>(self, points.into(), &options, Limits::NONE).expect("repairs")
    }

    fn answer(&self) -> Answer {
        let simplices = self.canonical().into_iter().map(Vec::from).collect();
        let rotated = |&t: &[u32; 3]| {
            let lowest = (0..3).min_by_key(|&k| t[k]).unwrap();
            (0..3).map(|k| t[(lowest + k) % 3]).collect()
        };
        let mut hull: Vec<Vec<u32>> = self.hull.iter().map(rotated).collect();
        hull.sort();
        (simplices, hull, self.duplicate_of.clone(), self.dimension)
    }

    fn update(&self) -> UpdateStats {
        self.stats.update.expect("the mesh was updated")
    }
}

impl Case<2> for Mesh2 {
    fn scratch(points: &[[f64; 2]]) -> Self {
        cpu().delaunay2d(points).expect("triangulates")
    }

    fn go_to(&mut self, triangulator: &Triangulator, points: &[[f64; 2]]) -> Result<(), Error> {
        triangulator.update(self, Points2::from(points))
    }

    fn repair(&self, points: &[[f64; 2]], threads: Option<NonZeroUsize>) -> (Option<Self>, UpdateStats) {
        let options = Options { threads, ..Options::default() };
        update::<2>(self, points.into(), &options, Limits::NONE).expect("repairs")
    }

    fn answer(&self) -> Answer {
        let simplices = self.canonical().into_iter().map(Vec::from).collect();
        (simplices, vec![self.hull.clone()], self.duplicate_of.clone(), self.dimension)
    }

    fn update(&self) -> UpdateStats {
        self.stats.update.expect("the mesh was updated")
    }
}

/// Moves the points of a mesh. The result is that of a run from scratch, also where the mesh is
/// repaired although that does not pay. Returns what the repair did.
fn step<const D: usize, M: Case<D>>(mesh: &mut M, to: &[[f64; D]]) -> UpdateStats {
    let expected = M::scratch(to).answer();
    let (repaired, repair) = mesh.repair(to, None);
    mesh.go_to(&cpu(), to).expect("follows");
    let update = mesh.update();
    assert!(mesh.answer() == expected, "not that of a run from scratch: {update:?}");
    if let Some(repaired) = repaired {
        assert!(repaired.answer() == expected, "not that of a run from scratch: {repair:?}");
        *mesh = repaired;
    } else {
        assert!(update.restarted.is_some());
    }
    repair
}

/// Moves points step by step.
fn follow<const D: usize, M: Case<D>>(steps: impl IntoIterator<Item = Vec<[f64; D]>>) -> Vec<UpdateStats> {
    let mut steps = steps.into_iter();
    let mut mesh = M::scratch(&steps.next().expect("there is a step"));
    steps.map(|to| step(&mut mesh, &to)).collect()
}

/// The steps were all repairs.
fn repaired(updates: &[UpdateStats]) {
    assert!(updates.iter().all(|update| update.restarted.is_none()), "{updates:?}");
}

macro_rules! both {
    ($($(#[$attribute:meta])* $name:ident),* $(,)?) => {
        mod d3 {
            $($(#[$attribute])* #[test] fn $name() { super::$name::<3, gdel::Mesh3>(); })*
        }
        mod d2 {
            $($(#[$attribute])* #[test] fn $name() { super::$name::<2, gdel::Mesh2>(); })*
        }
    };
}
both!(
    displacements_of_all_sizes,
    a_hundred_steps_without_drift,
    a_grid_that_rotates,
    a_grid_that_trembles,
    a_sphere_that_breathes,
    a_sphere_whose_points_move,
    clusters_that_pass_through_each_other,
    points_that_swap_places,
    a_point_that_jumps_across_the_hull,
    points_that_become_equal,
    points_that_become_flat_and_round_again,
    duplicates_that_part,
    duplicates_of_which_the_first_leaves,
    a_duplicate_that_moves_onto_another_point,
    far_away_and_back,
    cancellation_leaves_the_mesh,
    other_points_leave_the_mesh,
    any_number_of_threads,
    what_does_not_pay_is_not_repaired,
    meshes_that_are_none,
    few_points,
);

fn displacements_of_all_sizes<const D: usize, M: Case<D>>() {
    for n in [300, 2000] {
        for share in motions::DISPLACEMENTS {
            let updates = follow::<D, M>(motions::displaced(n, share));
            // Where next to nothing happens, nothing is begun anew.
            if share <= 1e-3 {
                repaired(&updates);
            }
        }
    }
}

fn a_hundred_steps_without_drift<const D: usize, M: Case<D>>() {
    let updates = follow::<D, M>(motions::drifting(500, 0.01, 100));
    assert!(updates.iter().map(|update| update.flips).sum::<u64>() > 1000);
    repaired(&updates);
}

fn a_grid_that_rotates<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::rotating_grid());
}

fn a_grid_that_trembles<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::trembling_grid());
}

fn a_sphere_that_breathes<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::breathing_sphere());
}

fn a_sphere_whose_points_move<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::dissolving_sphere());
}

fn clusters_that_pass_through_each_other<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::passing_clusters());
}

fn points_that_swap_places<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::swapping());
}

fn a_point_that_jumps_across_the_hull<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::jumping());
}

fn points_that_become_equal<const D: usize, M: Case<D>>() {
    let updates = follow::<D, M>(motions::meeting());
    assert!(updates[0].restarted.is_some());
    // What has not moved is no work, and the points part again.
    repaired(&updates[1..]);
    assert_eq!(updates[2].inserted, 3);
}

fn points_that_become_flat_and_round_again<const D: usize, M: Case<D>>() {
    let updates = follow::<D, M>(motions::flattening());
    assert!(updates[0].restarted.is_some());
    assert_eq!(updates[1].restarted, Some(Restart::Degenerate));
}

fn duplicates_that_part<const D: usize, M: Case<D>>() {
    let updates = follow::<D, M>(motions::parting());
    assert_eq!((updates[0].inserted, updates[0].restarted), (30, None));
    assert_eq!(updates[2].restarted, Some(Restart::Parted));
}

fn duplicates_of_which_the_first_leaves<const D: usize, M: Case<D>>() {
    let updates = follow::<D, M>(motions::leaving());
    assert_eq!(updates[0].inserted, 1);
}

fn a_duplicate_that_moves_onto_another_point<const D: usize, M: Case<D>>() {
    let updates = follow::<D, M>(motions::changing_sides());
    assert_eq!(updates[0].restarted, Some(Restart::Coincident));
}

fn far_away_and_back<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::far_and_back());
}

fn cancellation_leaves_the_mesh<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(2000, 12);
    let mut mesh = M::scratch(&points);
    let before = mesh.answer();
    for share in [0.0, 0.01, 10.0] {
        let to = motions::jitter(&points, share, 1);
        for end in 0.. {
            let reports = std::sync::atomic::AtomicUsize::new(0);
            let cancel = move |_| match reports.fetch_add(1, std::sync::atomic::Ordering::Relaxed) {
                i if i >= end => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            };
            let mut copy = mesh.clone();
            match copy.go_to(&cpu().on_progress(cancel), &to) {
                Err(Error::Cancelled) => assert!(copy.answer() == before, "the mesh has changed"),
                result => {
                    result.expect("follows");
                    assert!(end > 2, "it cannot be cancelled");
                    break;
                }
            }
        }
    }
    step(&mut mesh, &motions::jitter(&points, 0.01, 1));
}

fn other_points_leave_the_mesh<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(20, 13);
    let mut mesh = M::scratch(&points);
    let before = mesh.answer();
    let fewer = mesh.go_to(&cpu(), &points[1..]);
    assert_eq!(fewer, Err(Error::PointCount { points: 19, expected: 20 }));
    let mut not_finite = points.clone();
    not_finite[3][1] = f64::NAN;
    assert!(matches!(mesh.go_to(&cpu(), &not_finite), Err(Error::NotFinite { index: 3, axis: 'y', .. })));
    assert!(mesh.answer() == before);
}

/// Where too much has moved, the mesh is not even looked at as a whole.
fn what_does_not_pay_is_not_repaired<const D: usize, M: Case<D>>() {
    for (n, share) in [(300, 10.0), (5000, 0.5)] {
        let points = motions::uniform::<D>(n, 18);
        let mut mesh = M::scratch(&points);
        mesh.go_to(&cpu(), &motions::jitter(&points, share, 1)).expect("follows");
        assert_eq!((mesh.update().restarted, mesh.update().flips), (Some(Restart::Inverted), 0));
        mesh.go_to(&cpu(), &motions::jitter(&points, share, 1)).expect("follows");
        assert_eq!((mesh.update().restarted, mesh.update().flips), (None, 0));
    }
}

fn any_number_of_threads<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(10_000, 14);
    let to = motions::jitter(&points, 0.003, 1);
    let expected = M::scratch(&to).answer();
    let mesh = M::scratch(&points);
    for threads in [1, 2, 3, 8] {
        let threads = NonZeroUsize::new(threads);
        let (repaired, update) = mesh.repair(&to, threads);
        assert_eq!(update.restarted, None);
        assert!(repaired.is_some_and(|mesh| mesh.answer() == expected), "{threads:?}");
        let mut mesh = mesh.clone();
        mesh.go_to(&cpu().threads(threads.unwrap()), &to).expect("follows");
        assert!(mesh.answer() == expected, "{threads:?}");
        assert_eq!(mesh.update().restarted == Some(Restart::Threads), threads.unwrap().get() == 8);
    }
}

/// Meshes that were never Delaunay triangulations are no reason to panic.
fn meshes_that_are_none<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(50, 15);
    let mut empty = M::scratch(&[]);
    step(&mut empty, &[]);
    // The mesh of other points.
    let mut other = M::scratch(&motions::uniform::<D>(50, 16));
    step(&mut other, &points);
    // One that is inside out.
    let mirrored: Vec<_> = points.iter().map(|p| p.map(|x| -x)).collect();
    let mut mirrored = M::scratch(&mirrored);
    step(&mut mirrored, &points);
}

fn few_points<const D: usize, M: Case<D>>() {
    for n in 0..12 {
        for seed in 0..10 {
            let steps = (0..4).map(|i| motions::uniform::<D>(n, 4 * seed + i));
            follow::<D, M>(steps.collect::<Vec<_>>());
        }
    }
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
    let mut mesh = Mesh3::scratch(&around(1.0));
    assert_eq!(mesh.tetrahedra.len(), 5);
    let update = step(&mut mesh, &around(2.0));
    assert!(update.restarted.is_some());
}

/// The same in the plane, around a point.
#[test]
fn triangles_that_go_round_twice_are_noticed() {
    let around = |turns: f64| {
        let angle = |i: u32| std::f64::consts::TAU * turns * f64::from(i) / 5.0;
        let rim = (0..5).map(angle).map(|a| [libm::cos(a), libm::sin(a)]);
        rim.chain([[0.0, 0.0]]).collect::<Vec<_>>()
    };
    let mut mesh = Mesh2::scratch(&around(1.0));
    assert_eq!(mesh.triangles.len(), 5);
    let update = step(&mut mesh, &around(2.0));
    assert_eq!((update.inverted, update.restarted), (0, Some(Restart::Stuck)));
}

#[test]
fn meshes_whose_arrays_do_not_fit_are_triangulated_from_scratch() {
    let points = motions::uniform::<3>(50, 17);
    let good = Mesh3::scratch(&points);
    let broken: [fn(&mut Mesh3); 9] = [
        |mesh| mesh.tetrahedra[3][1] = 1000,
        |mesh| mesh.tetrahedra[3][1] = mesh.tetrahedra[3][0],
        |mesh| mesh.tetrahedra[3].swap(0, 1),
        |mesh| mesh.neighbors[3][0] = 1 << 30,
        |mesh| mesh.neighbors[3][0] = -7,
        |mesh| mesh.neighbors[3].swap(0, 1),
        |mesh| mesh.tetrahedra.truncate(9),
        |mesh| mesh.tetrahedra.clear(),
        |mesh| mesh.duplicate_of[4] = 9,
    ];
    for (i, change) in broken.into_iter().enumerate() {
        let mut mesh = good.clone();
        change(&mut mesh);
        let update = step(&mut mesh, &points);
        assert!(
            matches!(update.restarted, Some(Restart::Broken | Restart::Parted | Restart::Degenerate)),
            "{i}: {update:?}"
        );
    }
    let points = motions::uniform::<2>(50, 17);
    let good = Mesh2::scratch(&points);
    let broken: [fn(&mut Mesh2); 9] = [
        |mesh| mesh.triangles[3][1] = 1000,
        |mesh| mesh.triangles[3][1] = mesh.triangles[3][0],
        |mesh| mesh.triangles[3].swap(0, 1),
        |mesh| mesh.halfedges[3][0] = 1 << 30,
        |mesh| mesh.halfedges[3][0] = -7,
        |mesh| mesh.halfedges[3].swap(0, 1),
        |mesh| mesh.triangles.truncate(9),
        |mesh| mesh.hull.swap(0, 1),
        |mesh| mesh.duplicate_of[4] = 9,
    ];
    for (i, change) in broken.into_iter().enumerate() {
        let mut mesh = good.clone();
        change(&mut mesh);
        let update = step(&mut mesh, &points);
        assert!(
            matches!(update.restarted, Some(Restart::Broken | Restart::Parted | Restart::Degenerate)),
            "{i}: {update:?}"
        );
    }
}
