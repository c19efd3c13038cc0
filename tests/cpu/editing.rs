//! A mesh whose points come and go is the one of a run from scratch on those that are left.

use crate::{clouds, degenerate, motions};
use gdel::{
    Backend, Editable, Error, Mesh2, Mesh3, NONE, Points2, Points3, Triangulator,
    internals::{
        Options,
        cpu::edit::{Again, edit},
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
    duplicate_of: Vec<u32>,
    dimension: u8,
}

/// A dimension's meshes.
trait Case<const D: usize>: Editable<D> + Clone {
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
                edit::<$D, $N>(self, points.into(), removed, options, f64::INFINITY)
            }

            fn insert(&mut self, triangulator: &Triangulator, points: &[[f64; $D]]) -> Result<(), Error> {
                let known = self.duplicate_of.len().min(points.len());
                let mut before = points[..known].to_vec();
                let inserted = triangulator.insert(self, &mut before, &points[known..]);
                let expected = if inserted.is_ok() { points.len() } else { known };
                assert_eq!(before.len(), expected);
                inserted.map(|inserted| assert_eq!(inserted, known as u32..points.len() as u32))
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
        let mut duplicate_of: Vec<u32> = (0..self.points.len() as u32).collect();
        for (&name, &first) in names.iter().zip(&answer.duplicate_of) {
            duplicate_of[name as usize] = if first == NONE { first } else { names[first as usize] };
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
                let why = again.why;
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
    small_changes_are_repairs,
    many_changes_are_not,
    from_nothing_and_back,
    all_at_once,
    duplicates_take_the_place_of_others,
    new_points_anywhere,
    removal_until_the_points_are_flat,
    large_stars,
    wide_and_narrow_lattices,
    updates_leave_unused_points_out,
    compaction_drops_what_is_unused,
    errors_leave_the_mesh,
    cancellation_leaves_the_mesh,
    any_number_of_threads,
    meshes_that_are_none,
);

/// Points of all kinds.
fn inputs<const D: usize>() -> Vec<Vec<[f64; D]>> {
    let side = if D == 3 { 4 } else { 8 };
    vec![
        motions::uniform(60, 1),
        motions::grid(side),
        motions::sphere(60, 2),
        motions::with_duplicates(60, 25, 3),
        motions::with_duplicates(60, 8, 3),
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

/// A few changes of a mesh that is not tiny are never a run from scratch.
fn small_changes_are_repairs<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(1000, 5);
    let mut mesh = M::scratch(&points[..900]);
    for n in (901..=1000).step_by(11) {
        mesh.insert(&cpu(), &points[..n]).expect("inserts");
        assert_eq!((mesh.update().restarted, mesh.update().on_host), (None, false));
        assert!(mesh.update().inserted > 0);
        mesh.remove(&cpu(), &points[..n], &[n as u32 - 1, n as u32 - 200]).expect("removes");
        assert_eq!((mesh.update().restarted, mesh.update().removed), (None, 2));
    }
}

/// Many changes are a run from scratch, which says so.
fn many_changes_are_not<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(1000, 6);
    let mut model = Model::<D, M>::new(points[..700].to_vec());
    let mut mesh = model.mesh.clone();
    mesh.insert(&cpu(), &points).expect("inserts");
    assert_eq!(mesh.update().restarted, Some(Restart::Points));
    model.insert(points[700..].to_vec());
    let odd: Vec<u32> = (0..1000).filter(|i| i % 2 == 1).collect();
    let mut mesh = model.mesh.clone();
    mesh.remove(&cpu(), &points, &odd).expect("removes");
    assert_eq!(mesh.update().restarted, Some(Restart::Points));
    model.remove(odd);
    assert_eq!(model.repaired, 2);
}

fn from_nothing_and_back<const D: usize, M: Case<D>>() {
    let mut model = Model::<D, M>::new(Vec::new());
    model.remove([]);
    model.insert([]);
    assert_eq!(model.repaired, 2, "nothing is done without a run from scratch");
    for p in motions::uniform::<D>(12, 7) {
        model.insert([p]);
    }
    // The first simplex is one from scratch.
    assert_eq!(model.repaired, 2 + 12 - (D + 1));
    for i in 0..12 {
        model.remove([i]);
    }
    assert_eq!(model.repaired, 2 + 2 * (12 - (D + 1)));
    assert_eq!(model.mesh.answer().duplicate_of, (0..12).collect::<Vec<_>>());
    model.insert(motions::uniform::<D>(5, 8));
    model.remove(12..17);
    model.insert(motions::grid::<D>(3));
}

fn all_at_once<const D: usize, M: Case<D>>() {
    let mut model = Model::<D, M>::new(motions::grid::<D>(3));
    let count = model.points.len() as u32;
    model.remove(0..count);
    model.insert(motions::grid::<D>(3));
    model.remove(count..2 * count);
}

/// Each point of a simplex whose points are there three times, and the points between them.
fn duplicates_take_the_place_of_others<const D: usize, M: Case<D>>() {
    let mut sites = motions::uniform::<D>(20, 9);
    sites.extend_from_within(..);
    sites.extend_from_within(..20);
    let mut model = Model::<D, M>::new(sites);
    // The lowest of those that are left stands for them.
    model.remove([3]);
    assert_eq!(model.mesh.answer().duplicate_of[43], 23);
    // One that stands for nobody, then two of which one does.
    model.remove([45]);
    model.remove([47, 7]);
    assert_eq!(model.mesh.answer().duplicate_of[27], NONE);
    model.insert([model.points[3], model.points[7], model.points[7], model.points[45]]);
    assert_eq!(model.mesh.answer().duplicate_of[60..], [23, 27, 27, 5]);
    // All of them.
    model.remove([23, 43, 60]);
    model.insert([model.points[3], model.points[3]]);
    assert_eq!(model.mesh.answer().duplicate_of[64..], [NONE, 64]);
    assert_eq!(model.repaired, 6);
}

/// New points that lie outside, inside, on the hull, in a vertex and on an edge of a cube.
fn new_points_anywhere<const D: usize, M: Case<D>>() {
    let corners = motions::grid::<D>(2);
    let mut model = Model::<D, M>::new(corners);
    let at = |x: f64, rest: f64| std::array::from_fn(|axis| if axis == 0 { x } else { rest });
    for p in [at(0.5, 0.5), at(0.5, 1.0), at(1.0, 1.0), at(0.25, 0.0), at(2.0, 1.0), at(-7.0, 0.5), at(1e6, -1e9)] {
        model.insert([p]);
    }
    assert_eq!(model.repaired, 7);
}

/// The hull is peeled until what is left is flat.
fn removal_until_the_points_are_flat<const D: usize, M: Case<D>>() {
    // A plane, or a line, with two points off it.
    let mut points = motions::grid::<D>(3);
    points.iter_mut().for_each(|p| p[D - 1] = 1.0);
    points.push([0.0; D]);
    points.push([2.0; D]);
    let count = points.len() as u32;
    let mut model = Model::<D, M>::new(points);
    model.remove([count - 1]);
    assert_eq!(model.repaired, 1);
    model.remove([count - 2]);
    assert_eq!(model.repaired, 1);
    assert_eq!(usize::from(model.mesh.answer().dimension), D - 1);
    // A duplicate needs no mesh at all.
    model.remove([count - 3]);
    assert_eq!(model.repaired, 2);
    model.insert([[0.5; D]]);
    assert_eq!(usize::from(model.mesh.answer().dimension), D);
}

/// Vertices with so many neighbours that their star is most of the mesh.
fn large_stars<const D: usize, M: Case<D>>() {
    let mut points = motions::sphere::<D>(600, 10);
    points.push([0.0; D]);
    points.push([0.25; D]);
    let mut model = Model::<D, M>::new(points);
    model.remove([600]);
    model.remove([601]);
    model.insert([[0.0; D]]);
    model.insert([[50.0; D]]);
    model.remove([603]);
    assert_eq!(model.repaired, 5);
}

fn wide_and_narrow_lattices<const D: usize, M: Case<D>>() {
    let grid = motions::grid::<D>(4);
    let mut model = Model::<D, M>::new(grid.clone());
    // A point far away, and one between: what was exact in 31 bits is not any more.
    model.insert([[1e12; D], [0.1; D]]);
    let count = grid.len() as u32;
    model.remove([count]);
    model.remove([count + 1, 5]);
    model.insert(motions::scaled(&grid, 1e-30));
    assert_eq!(model.repaired, 4);
}

fn updates_leave_unused_points_out<const D: usize, M: Case<D>>() {
    for (points, share) in [(motions::uniform::<D>(300, 11), 1e-3), (motions::uniform::<D>(300, 11), 10.0)] {
        let mut model = Model::<D, M>::new(points);
        model.remove([3, 70, 299, 0]);
        model.points = motions::jitter(&model.points, share, 12);
        model.mesh.go_to(&model.points).expect("follows");
        assert_eq!(model.mesh.answer(), model.expected());
        model.mesh.prove(&model.points);
        model.insert([[0.5; D], [0.5; D]]);
        // The new duplicate parts; nobody minds where the others are.
        model.points[301] = [0.25; D];
        model.points[3] = model.points[100];
        model.points[70] = model.points[301];
        model.mesh.go_to(&model.points).expect("follows");
        assert_eq!(model.mesh.answer(), model.expected());
        // Flat, and back.
        let points = model.points.clone();
        model.points.iter_mut().for_each(|p| p[D - 1] = 1.0);
        model.mesh.go_to(&model.points).expect("follows");
        assert_eq!(model.mesh.answer(), model.expected());
        model.points = points;
        model.mesh.go_to(&model.points).expect("follows");
        assert_eq!(model.mesh.answer(), model.expected());
    }
}

fn compaction_drops_what_is_unused<const D: usize, M: Case<D>>() {
    for points in inputs::<D>() {
        let mut model = Model::<D, M>::new(points);
        assert_eq!(model.mesh.clone().pack(), model.used());
        model.remove([0, 3, 17, 40, 41]);
        let kept = model.mesh.pack();
        assert_eq!(kept, model.used());
        let points: Vec<_> = kept.iter().map(|&i| model.points[i as usize]).collect();
        let expected = M::scratch(&points).answer();
        assert_eq!(model.mesh.answer(), expected);
        let mut model = Model { is_unused: vec![false; points.len()], points, ..model };
        model.remove([1]);
        model.insert([[0.375; D]]);
    }
    let mut flat = Model::<D, M>::new(vec![[1.0; D], [3.0; D], [1.0; D], [2.0; D], [2.0; D]]);
    flat.remove([0, 3]);
    assert_eq!(flat.mesh.pack(), [1, 2, 4]);
    assert_eq!(flat.mesh.answer(), M::scratch(&[[3.0; D], [1.0; D], [2.0; D]]).answer());
}

fn errors_leave_the_mesh<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(20, 13);
    let mut model = Model::<D, M>::new(points.clone());
    model.remove([4]);
    let before = model.mesh.answer();
    let mut mesh = model.mesh;
    let bad = |index: u32, reason: &'static str| Err(Error::BadIndex { index, reason });
    assert_eq!(mesh.remove(&cpu(), &points, &[3, 20]), bad(20, "there is no such point"));
    assert_eq!(mesh.remove(&cpu(), &points, &[u32::MAX]), bad(u32::MAX, "there is no such point"));
    assert_eq!(mesh.remove(&cpu(), &points, &[3, 5, 3]), bad(3, "it is given twice"));
    assert_eq!(mesh.remove(&cpu(), &points, &[3, 4]), bad(4, "it was removed before"));
    let count = |points| Err(Error::PointCount { points, expected: 20 });
    assert_eq!(mesh.remove(&cpu(), &points[1..], &[3]), count(19));
    assert_eq!(mesh.remove(&cpu(), &[&points[..], &points[..1]].concat(), &[3]), count(21));
    assert_eq!(mesh.insert(&cpu(), &points[..7]), count(7));
    let mut not_finite = points.clone();
    not_finite.push([f64::NAN; D]);
    assert!(matches!(mesh.insert(&cpu(), &not_finite), Err(Error::NotFinite { index: 20, axis: 'x', .. })));
    // The coordinates of unused points, too, are numbers.
    let mut not_finite = points.clone();
    not_finite[4] = [f64::INFINITY; D];
    assert!(matches!(mesh.remove(&cpu(), &not_finite, &[1]), Err(Error::NotFinite { index: 4, .. })));
    assert_eq!(mesh.answer(), before);
    // They need not be the ones that they were.
    let mut other = points.clone();
    other[4] = [7.0; D];
    mesh.remove(&cpu(), &other, &[1]).expect("removes");
    assert_eq!(mesh.update().restarted, None);
}

fn cancellation_leaves_the_mesh<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(2000, 14);
    let model = Model::<D, M>::new(points[..1500].to_vec());
    let before = model.mesh.answer();
    for count in [1501, 1580, 2000] {
        for end in 0.. {
            let reports = AtomicUsize::new(0);
            let cancel = move |_| match reports.fetch_add(1, Ordering::Relaxed) {
                i if i >= end => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            };
            let mut mesh = model.mesh.clone();
            match mesh.insert(&cpu().on_progress(cancel), &points[..count]) {
                Err(Error::Cancelled) => assert!(mesh.answer() == before, "the mesh has changed"),
                result => {
                    result.expect("inserts");
                    assert!(end > 2, "it cannot be cancelled");
                    break;
                }
            }
        }
    }
}

fn any_number_of_threads<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(10_000, 15);
    let before = M::scratch(&points[..9_990]);
    let expected = M::scratch(&points).answer();
    for threads in [1, 2, 8].map(|threads| NonZeroUsize::new(threads).unwrap()) {
        let mut mesh = before.clone();
        mesh.insert(&cpu().threads(threads), &points).expect("inserts");
        assert_eq!(mesh.update().restarted, None);
        assert!(mesh.answer() == expected, "{threads} threads");
    }
}

/// Meshes that were never Delaunay triangulations are no reason to panic, or to go on for ever.
fn meshes_that_are_none<const D: usize, M: Case<D>>() {
    let points = motions::uniform::<D>(60, 16);
    let others = [
        motions::uniform::<D>(50, 17),
        // One that is inside out, and one that is folded.
        points[..50].iter().map(|p| p.map(|x| -x)).collect(),
        motions::jitter(&points[..50], 0.3, 1),
        motions::jitter(&points[..50], 3.0, 1),
    ];
    for other in others {
        let mesh = M::scratch(&other);
        for i in 0..50 {
            let mut copy = mesh.clone();
            copy.insert(&cpu(), &points).expect("inserts");
            let mut copy = mesh.clone();
            copy.remove(&cpu(), &points[..50], &[i, (i + 1) % 50]).expect("removes");
        }
    }
}

/// Meshes whose arrays do not fit each other are triangulated from scratch, if that is noticed.
#[test]
fn broken_meshes_are_no_reason_to_panic() {
    let points = motions::uniform::<3>(60, 18);
    let good = Mesh3::scratch(&points[..50]);
    let broken: [fn(&mut Mesh3, usize); 11] = [
        |mesh, t| mesh.tetrahedra[t][1] = 1000,
        |mesh, t| mesh.tetrahedra[t][1] = u32::MAX,
        |mesh, t| mesh.tetrahedra[t][1] = mesh.tetrahedra[t][0],
        |mesh, t| mesh.tetrahedra[t].swap(0, 1),
        |mesh, t| mesh.neighbors[t][0] = 1 << 30,
        |mesh, t| mesh.neighbors[t][0] = NONE - 6,
        |mesh, t| mesh.neighbors[t].swap(0, 1),
        |mesh, t| mesh.tetrahedra.truncate(t),
        |mesh, t| mesh.neighbors.truncate(t),
        |mesh, _| mesh.hull.clear(),
        |mesh, _| mesh.duplicate_of[4] = 9,
    ];
    let mut noticed = 0;
    for change in broken {
        for t in 0..good.tetrahedra.len() {
            let mut mesh = good.clone();
            change(&mut mesh, t);
            mesh.insert(&cpu(), &points).expect("inserts");
            noticed += usize::from(mesh.update().restarted == Some(Restart::Broken));
            let mut mesh = good.clone();
            change(&mut mesh, t);
            let last = mesh.duplicate_of.len() as u32 - 1;
            mesh.remove(&cpu(), &points[..50], &[t as u32 % last]).expect("removes");
            noticed += usize::from(mesh.update().restarted == Some(Restart::Broken));
        }
    }
    assert!(noticed > 500, "{noticed}");
    let points = motions::uniform::<2>(60, 18);
    let good = Mesh2::scratch(&points[..50]);
    let broken: [fn(&mut Mesh2, usize); 12] = [
        |mesh, t| mesh.triangles[t][1] = 1000,
        |mesh, t| mesh.triangles[t][1] = u32::MAX,
        |mesh, t| mesh.triangles[t][1] = mesh.triangles[t][0],
        |mesh, t| mesh.triangles[t].swap(0, 1),
        |mesh, t| mesh.halfedges[t][0] = 1 << 30,
        |mesh, t| mesh.halfedges[t][0] = NONE - 6,
        |mesh, t| mesh.halfedges[t].swap(0, 1),
        |mesh, t| mesh.triangles.truncate(t),
        |mesh, t| mesh.halfedges.truncate(t),
        |mesh, _| mesh.hull.clear(),
        |mesh, _| mesh.hull.swap(0, 1),
        |mesh, _| mesh.duplicate_of[4] = 9,
    ];
    let mut noticed = 0;
    for change in broken {
        for t in 0..good.triangles.len() {
            let mut mesh = good.clone();
            change(&mut mesh, t);
            mesh.insert(&cpu(), &points).expect("inserts");
            noticed += usize::from(mesh.update().restarted == Some(Restart::Broken));
            let mut mesh = good.clone();
            change(&mut mesh, t);
            mesh.remove(&cpu(), &points[..50], &[t as u32 % 49]).expect("removes");
            noticed += usize::from(mesh.update().restarted == Some(Restart::Broken));
        }
    }
    assert!(noticed > 200, "{noticed}");
}

/// The verifier proves the mesh of the points that are used, and says how many are not.
#[test]
fn the_verifier_knows_unused_points() {
    let points = motions::uniform::<3>(30, 19);
    let mut mesh = Mesh3::scratch(&points);
    mesh.remove(&cpu(), &points, &[3, 4]).expect("removes");
    let counts = verify3d(&points, &mesh).expect("verifies").counts;
    assert_eq!((counts.points, counts.distinct_points, counts.unused_points, counts.vertices), (30, 28, 2, 28));
    // One that is used after all.
    let mut wrong = mesh.clone();
    wrong.duplicate_of[3] = NONE;
    assert!(!verify3d(&points, &wrong).expect("verifies").passed());
    // One that is used in spite of that.
    let mut wrong = mesh.clone();
    wrong.duplicate_of[5] = 5;
    let report = verify3d(&points, &wrong).expect("verifies");
    let (_, defect, _) = report.failures().next().expect("a vertex is unused");
    assert!(defect.to_string().contains("unused"), "{defect}");
    assert_eq!((mesh.unused_count(), mesh.duplicate_count(), mesh.vertices().count()), (2, 0, 28));
    assert!(mesh.is_unused(3) && !mesh.is_duplicate(3) && mesh.representative(3) == 3);
}

/// Clouds with as many ties, poles and slivers as there are.
#[test]
fn clouds_of_all_kinds() {
    let clouds = [
        clouds::two_skew_lines(20),
        clouds::raster(8, 0.0),
        clouds::raster(8, 1.0),
        clouds::moment_curve(40),
        clouds::cylinder(100),
        clouds::circle_and_its_axis(30),
        clouds::clusters_at_1e_9_spacing(100),
        clouds::grids_at_1e_9_spacing(3),
        clouds::flat_ground(60),
    ];
    let mut random = Pcg64Mcg::seed_from_u64(20);
    for points in clouds {
        let mut model = Model::<3, Mesh3>::new(points.clone());
        for _ in 0..20 {
            let removed = model.some(2, &mut random);
            let back: Vec<_> = removed.iter().map(|&i| model.points[i as usize]).collect();
            model.remove(removed);
            model.insert(back);
        }
        // One point is not enough for a solid where a plane is left.
        assert!(model.repaired > 35, "{}", model.repaired);
    }
}
