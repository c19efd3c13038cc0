//! 2D and 3D meshes each of which is broken in one way, and what the verifier must say about them.

use gdel::verify::{Check, Report};
use proptest::{prelude::*, sample::Index};
use std::collections::BTreeSet;

/// The object that the first defect of a broken mesh must name.
#[derive(Debug, Clone, Copy)]
pub enum At {
    Mesh,
    Triangle(usize),
    Tetrahedron(usize),
    Point(usize),
}

/// A mesh that must fail one check and no other.
pub struct Broken {
    pub name: &'static str,
    pub check: Check,
    pub at: At,
    pub report: Report,
}

/// Collects broken meshes `M` of points `P` and simplices `S`.
pub struct BrokenMeshes<P, S, M> {
    /// Returns the correct mesh.
    pub right: fn(&[P]) -> M,
    /// Verifies all arrays of a mesh.
    pub verify: fn(&[P], &M) -> Report,
    /// Verifies simplices, without the arrays beside them.
    pub verify_bare: fn(&[P], &[S]) -> Report,
    pub all: Vec<Broken>,
}

impl<P, S, M> BrokenMeshes<P, S, M> {
    /// Adds simplices, without the arrays beside them.
    pub fn bare(&mut self, check: Check, name: &'static str, points: &[P], simplices: &[S], at: At) {
        self.add(check, name, (self.verify_bare)(points, simplices), at);
    }

    /// Adds the correct mesh with one change.
    pub fn changed(&mut self, check: Check, name: &'static str, points: &[P], at: At, change: impl FnOnce(&mut M)) {
        let mut mesh = (self.right)(points);
        change(&mut mesh);
        self.add(check, name, (self.verify)(points, &mesh), at);
    }

    pub fn add(&mut self, check: Check, name: &'static str, report: Report, at: At) {
        self.all.push(Broken { name, check, at, report });
    }
}

/// Returns the checks that failed.
pub fn failures(report: &Report) -> Vec<Check> {
    report.failures().map(|(check, ..)| check).collect()
}

/// Asserts that each mesh fails its check and no other, and that the report says where.
pub fn assert_that_each_fails_its_check(broken: &[Broken]) {
    for Broken { name, check, at, report } in broken {
        assert!(!report.passed(), "{name}");
        assert_eq!(failures(report), [*check], "{name}:\n{report}");
        let (_, first, count) = report.failures().next().expect("one check failed");
        let (triangle, tetrahedron, point) = match *at {
            At::Mesh => (None, None, None),
            At::Triangle(t) => (Some(t), None, None),
            At::Tetrahedron(t) => (None, Some(t), None),
            At::Point(p) => (None, None, Some(p)),
        };
        assert_eq!((first.triangle, first.tetrahedron, first.point), (triangle, tetrahedron, point), "{name}: {first}");
        assert!(count > 0 && !first.detail.is_empty(), "{name}");
        assert!(report.to_string().contains(&format!("FAILED  {first}")), "{name}:\n{report}");
    }
}

/// Asserts that each of these checks has a mesh that fails it.
pub fn assert_that_each_check_fails(broken: &[Broken], checks: &[Check]) {
    let caught: BTreeSet<_> = broken.iter().map(|broken| broken.check).collect();
    assert_eq!(caught, checks.iter().copied().collect());
}

/// One change to the simplices of a mesh.
#[derive(Debug, Clone)]
pub enum Change {
    Remove(Index),
    Repeat(Index),
    SwapVertices(Index),
    SetVertex(Index, usize, Index),
    Exchange(Index, Index, usize),
    Rotate(Index),
}

/// Generates any change to simplices of `N` vertices.
pub fn change<const N: usize>() -> impl Strategy<Value = Change> {
    let index = any::<Index>;
    prop_oneof![
        index().prop_map(Change::Remove),
        index().prop_map(Change::Repeat),
        index().prop_map(Change::SwapVertices),
        (index(), 0..N, index()).prop_map(|(t, k, v)| Change::SetVertex(t, k, v)),
        (index(), index(), 0..N).prop_map(|(s, t, k)| Change::Exchange(s, t, k)),
        index().prop_map(Change::Rotate),
    ]
}

impl Change {
    /// Changes simplices, of which there must be at least one.
    pub fn apply<const N: usize>(self, simplices: &mut Vec<[u32; N]>, points: usize) {
        let count = simplices.len();
        match self {
            Change::Remove(t) => drop(simplices.remove(t.index(count))),
            Change::Repeat(t) => simplices.push(simplices[t.index(count)]),
            Change::SwapVertices(t) => simplices[t.index(count)].swap(1, 2),
            Change::SetVertex(t, k, v) => simplices[t.index(count)][k] = v.index(points) as u32,
            Change::Exchange(s, t, k) => {
                let (s, t) = (s.index(count), t.index(count));
                (simplices[s][k], simplices[t][k]) = (simplices[t][k], simplices[s][k]);
            }
            // Three vertices, which leaves triangles and tetrahedra the same.
            Change::Rotate(t) => simplices[t.index(count)][..3].rotate_left(1),
        }
    }
}
