//! A mesh whose points come and go is the one of a run from scratch on those that are left.

use crate::{clouds, degenerate, motions};
use gdel::{
    Backend, Error, Mesh2, Mesh3, Moving, Points2, Points3, Triangulator,
    internals::{
        Options,
        cpu::{
            edit::{Again, edit},
            update::Limits,
        },
    },
    stats::{Restart, UpdateStats},
    verify2d, verify3d,
};
use rand::RngExt;
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};
use std::{
    num::NonZeroUsize,
    ops::ControlFlow,
    sync::atomic::{AtomicUsize, Ordering},
};

fn cpu() -> Triangulator {
    Triangulator::new().backend(Backend::Cpu)
}

/// The simplices, the hull, the duplicates and the dimension: all that points determine.
#[derive(Debug, PartialEq, Clone)]
struct Answer {
    simplices: Vec<Vec<u32>>,
    hull: Vec<Vec<u32>>,
    duplicate_of: Vec<i32>,
    dimension: u8,
}

/// A dimension's meshes.
trait Case<const D: usize>: Moving + Clone {
    fn scratch(points: &[[f64; D]]) -> Self;
    /// Inserts the points that the mesh does not have, whether that pays or not, or removes some.
    fn attempt(&mut self, points: &[[f64; D]], removed: &[u32], options: &Options) -> Result<Option<Again>, Error>;
    fn insert(&mut self, triangulator: &Triangulator, points: &[[f64; D]]) -> Result<(), Error>;
    fn remove(&mut self, triangulator: &Triangulator, points: &[[f64; D]], indices: &[u32]) -> Result<(), Error>;
    fn go_to(&mut self, points: &[[f64; D]]) -> Result<(), Error>;
    fn pack(&mut self) -> Vec<u32>;
    fn answer(&self) -> Answer;
    fn update(&self) -> UpdateStats;
    fn prove(&self, points: &[[f64; D]]);
}

macro_rules! case {
    ($D:literal, $N:literal, $mesh:ident, $points:ident, $delaunay:ident, $verify:ident, $hull:expr) => {
        impl Case<$D> for $mesh {
            fn scratch(points: &[[f64; $D]]) -> Self {
                cpu().$delaunay(points).expect("triangulates")
            }

            fn attempt(
                &mut self,
                points: &[[f64; $D]],
                removed: &[u32],
                options: &Options,
            ) -> Result<Option<Again>, Error> {
                edit::<$D, $N>(self, points.into(), removed, options, Limits::NONE)
            }

            fn insert(&mut self, triangulator: &Triangulator, points: &[[f64; $D]]) -> Result<(), Error> {
                triangulator.insert(self, $points::from(points))
            }

            fn remove(
                &mut self,
                triangulator: &Triangulator,
                points: &[[f64; $D]],
                indices: &[u32],
            ) -> Result<(), Error> {
                triangulator.remove(self, $points::from(points), indices)
            }

            fn go_to(&mut self, points: &[[f64; $D]]) -> Result<(), Error> {
                cpu().update(self, $points::from(points))
            }

            fn pack(&mut self) -> Vec<u32> {
                self.compact()
            }

            fn answer(&self) -> Answer {
                let simplices = self.canonical().into_iter().map(Vec::from).collect();
                let hull = $hull(self);
                Answer { simplices, hull, duplicate_of: self.duplicate_of.clone(), dimension: self.dimension }
            }

            fn update(&self) -> UpdateStats {
                self.stats.update.expect("the mesh was changed")
            }

            fn prove(&self, points: &[[f64; $D]]) {
                let report = $verify(points, self).expect("verifies");
                assert!(report.passed(), "{report}");
            }
        }
    };
}
case!(3, 4, Mesh3, Points3, delaunay3d, verify3d, |mesh: &Mesh3| {
    let rotated = |t: &[u32; 3]| {
        let lowest = (0..3).min_by_key(|&k| t[k]).unwrap();
        (0..3).map(|k| t[(lowest + k) % 3]).collect()
    };
    let mut hull: Vec<Vec<u32>> = mesh.hull.iter().map(rotated).collect();
    hull.sort();
    hull
});
case!(2, 3, Mesh2, Points2, delaunay2d, verify2d, |mesh: &Mesh2| vec![mesh.hull.clone()]);

/// A mesh and its points, which come and go.
#[derive(Clone)]
struct Model<const D: usize, M> {
    points: Vec<[f64; D]>,
    is_unused: Vec<bool>,
    mesh: M,
    /// How many changes were made without a run from scratch.
    repaired: usize,
}

impl<const D: usize, M: Case<D>> Model<D, M> {
    fn new(points: Vec<[f64; D]>) -> Self {
        let (mesh, is_unused) = (M::scratch(&points), vec![false; points.len()]);
        Model { points, is_unused, mesh, repaired: 0 }
    }

    /// The answer of a run from scratch on the points that are left.
    fn expected(&self) -> Answer {
        let names: Vec<u32> = (0..self.points.len() as u32).filter(|&i| !self.is_unused[i as usize]).collect();
        let points: Vec<_> = names.iter().map(|&i| self.points[i as usize]).collect();
        let mut answer = M::scratch(&points).answer();
        let name = |v: &mut u32| *v = names[*v as usize];
        answer.simplices.iter_mut().flatten().for_each(name);
        answer.hull.iter_mut().flatten().for_each(name);
        let mut duplicate_of: Vec<i32> = (0..self.points.len() as i32).collect();
        for (&name, &first) in names.iter().zip(&answer.duplicate_of) {
            duplicate_of[name as usize] = if first < 0 { first } else { names[first as usize] as i32 };
        }
        answer.duplicate_of = duplicate_of;
        answer
    }

    /// Changes the mesh by both ways, the one that pays and the other.
    fn change(&mut self, removed: &[u32]) {
        let expected = self.expected();
        let mut repaired = self.mesh.clone();
        let again = repaired.attempt(&self.points, removed, &Options::default()).expect("works");
        match removed {
            [] => self.mesh.insert(&cpu(), &self.points),
            removed => self.mesh.remove(&cpu(), &self.points, removed),
        }
        .expect("works");
        assert!(self.mesh.answer() == expected, "not that of a run from scratch: {:?}", self.mesh.update());
        self.mesh.prove(&self.points);
        match again {
            Some(again) => {
                let why = again.update.restarted.expect("there is a reason");
                // There are no other reasons to fail.
                assert_eq!(why, Restart::Degenerate, "{:?}", self.points.len());
            }
            None => {
                assert_eq!(repaired.answer(), expected);
                repaired.prove(&self.points);
                self.repaired += 1;
                self.mesh = repaired;
            }
        }
    }

    fn insert(&mut self, new: impl IntoIterator<Item = [f64; D]>) {
        self.points.extend(new);
        self.is_unused.resize(self.points.len(), false);
        self.change(&[]);
    }

    fn remove(&mut self, indices: impl IntoIterator<Item = u32>) {
        let indices: Vec<u32> = indices.into_iter().collect();
        indices.iter().for_each(|&i| self.is_unused[i as usize] = true);
        self.change(&indices);
    }

    /// The points that are left.
    fn used(&self) -> Vec<u32> {
        (0..self.points.len() as u32).filter(|&i| !self.is_unused[i as usize]).collect()
    }

    /// So many of them at random.
    fn some(&self, count: usize, random: &mut Pcg64Mcg) -> Vec<u32> {
        let mut used = self.used();
        (0..count.min(used.len())).map(|_| used.swap_remove(random.random_range(0..used.len()))).collect()
    }
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
    each_vertex_of_some_points,
    a_hundred_changes_without_drift,
    degenerate_points_come_and_go,
);

/// Points of all kinds.
fn inputs<const D: usize>() -> Vec<Vec<[f64; D]>> {
    let side = if D == 3 { 4 } else { 8 };
    vec![
        motions::uniform(60, 1),
        motions::grid(side),
        motions::sphere(60, 2),
        motions::with_duplicates(60, 25, 3),
        motions::with_duplicates(60, 4, 3),
    ]
}

fn each_vertex_of_some_points<const D: usize, M: Case<D>>() {
    for points in inputs::<D>() {
        let model = Model::<D, M>::new(points);
        for v in 0..model.points.len() as u32 {
            let mut model = model.clone();
            model.remove([v]);
            assert_eq!(model.repaired, 1);
            // It comes back with another index.
            model.insert([model.points[v as usize]]);
            assert_eq!(model.repaired, 2);
        }
    }
}

fn a_hundred_changes_without_drift<const D: usize, M: Case<D>>() {
    let mut random = Pcg64Mcg::seed_from_u64(4);
    for points in inputs::<D>() {
        let mut model = Model::<D, M>::new(points.clone());
        for i in 0..100 {
            let count = random.random_range(1..4);
            if i % 2 == 0 {
                let removed = model.some(count, &mut random);
                model.remove(removed);
            } else {
                let new: Vec<_> = (0..count).map(|_| points[random.random_range(0..points.len())]).collect();
                model.insert(new);
            }
        }
        assert!(model.repaired > 90, "{}", model.repaired);
    }
}

fn degenerate_points_come_and_go<const D: usize, M: Case<D>>() {
    for seed in degenerate::cases(60) {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let points = degenerate::points::<D>(&mut random, 40);
        let first = random.random_range(0..=points.len());
        let mut model = Model::<D, M>::new(points[..first].to_vec());
        let mut rest = points[first..].iter().copied();
        while model.points.len() < points.len() {
            model.insert(rest.by_ref().take(random.random_range(1..4)).collect::<Vec<_>>());
            let removed = model.some(random.random_range(0..3), &mut random);
            model.remove(removed);
        }
        while !model.used().is_empty() {
            let removed = model.some(random.random_range(1..4), &mut random);
            model.remove(removed);
        }
    }
}
