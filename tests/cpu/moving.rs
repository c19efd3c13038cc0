//! A mesh that follows its points is the one of a run from scratch.

use crate::motions;
use gdel::{Backend, Editable, Error, Mesh2, Mesh3, Points2, Points3, Triangulator, stats::Restart};
use std::ops::ControlFlow;

fn cpu() -> Triangulator {
    Triangulator::new().backend(Backend::Cpu)
}

/// The simplices, the hull, the duplicates and the dimension: all that points determine.
type Answer = (Vec<Vec<u32>>, Vec<Vec<u32>>, Vec<u32>, u8);

/// A dimension's meshes.
trait Case<const D: usize>: Editable<D> + Clone {
    fn scratch(points: &[[f64; D]]) -> Self;
    fn go_to(&mut self, triangulator: &Triangulator, points: &[[f64; D]]) -> Result<(), Error>;
    fn answer(&self) -> Answer;
    fn restarted(&self) -> Option<Restart>;
}

impl Case<3> for Mesh3 {
    fn scratch(points: &[[f64; 3]]) -> Self {
        cpu().delaunay3d(points).expect("triangulates")
    }

    fn go_to(&mut self, triangulator: &Triangulator, points: &[[f64; 3]]) -> Result<(), Error> {
        triangulator.update(self, Points3::from(points))
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

    fn restarted(&self) -> Option<Restart> {
        self.stats.update.expect("the mesh was updated").restarted
    }
}

impl Case<2> for Mesh2 {
    fn scratch(points: &[[f64; 2]]) -> Self {
        cpu().delaunay2d(points).expect("triangulates")
    }

    fn go_to(&mut self, triangulator: &Triangulator, points: &[[f64; 2]]) -> Result<(), Error> {
        triangulator.update(self, Points2::from(points))
    }

    fn answer(&self) -> Answer {
        let simplices = self.canonical().into_iter().map(Vec::from).collect();
        (simplices, vec![self.hull.clone()], self.duplicate_of.clone(), self.dimension)
    }

    fn restarted(&self) -> Option<Restart> {
        self.stats.update.expect("the mesh was updated").restarted
    }
}

/// Moves the points of a mesh, which becomes that of a run from scratch.
fn step<const D: usize, M: Case<D>>(mesh: &mut M, to: &[[f64; D]]) {
    mesh.go_to(&cpu(), to).expect("follows");
    assert_eq!(mesh.restarted(), Some(Restart::NotResident));
    assert!(mesh.answer() == M::scratch(to).answer(), "not that of a run from scratch");
}

/// Moves points step by step.
fn follow<const D: usize, M: Case<D>>(steps: impl IntoIterator<Item = Vec<[f64; D]>>) {
    let mut steps = steps.into_iter();
    let mut mesh = M::scratch(&steps.next().expect("there is a step"));
    steps.for_each(|to| step(&mut mesh, &to));
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
    a_grid_that_trembles,
    points_that_swap_places,
    points_that_become_equal,
    points_that_become_flat_and_round_again,
    duplicates_that_part,
    far_away_and_back,
    cancellation_leaves_the_mesh,
    other_points_leave_the_mesh,
    meshes_that_are_none,
    few_points,
);

fn displacements_of_all_sizes<const D: usize, M: Case<D>>() {
    for share in motions::DISPLACEMENTS {
        follow::<D, M>(motions::displaced(300, share));
    }
}

fn a_grid_that_trembles<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::trembling_grid());
}

fn points_that_swap_places<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::swapping());
}

fn points_that_become_equal<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::meeting());
}

fn points_that_become_flat_and_round_again<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::flattening());
}

fn duplicates_that_part<const D: usize, M: Case<D>>() {
    follow::<D, M>(motions::parting());
    follow::<D, M>(motions::leaving());
    follow::<D, M>(motions::changing_sides());
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

/// Nothing depends on what the mesh was before.
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
