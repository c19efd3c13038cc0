//! The 2D verifier passes only the correct mesh, and says what is wrong with any other.

use crate::broken::{
    self,
    At::{Mesh, Point, Triangle},
    Broken, assert_that_each_check_fails, assert_that_each_fails_its_check, failures,
};
use crate::oracle::definition2;
use gdel::{
    Error, Mesh2, MeshView2, NONE, delaunay2d,
    internals::{
        d2::generate::{Distribution2, generate2d},
        mesh,
    },
    verify::{Check, Outcome},
    verify2d,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// The 2D checks; a polygon that is convex and turns once needs no others.
const CHECKS: [Check; 14] = [
    Check::Dimension,
    Check::Duplicates,
    Check::Indices,
    Check::Vertices,
    Check::Orientation,
    Check::Facets,
    Check::Neighbors,
    Check::Delaunay,
    Check::CanonicalTies,
    Check::Hull,
    Check::HullClosed,
    Check::HullConvex,
    Check::Hidden,
    Check::Constraints,
];

/// The corner of the unit square.
const CORNER: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
/// Two triangles that share the edge 0-1, which is short.
const KITE: [[f64; 2]; 4] = [[0.0, 0.0], [0.0, 1.0], [3.0, 0.5], [-3.0, 0.5]];

/// The points of a 3×3 grid.
fn square() -> Vec<[f64; 2]> {
    (0..9).map(|i| [i % 3, i / 3].map(f64::from)).collect()
}

fn right(points: &[[f64; 2]]) -> Mesh2 {
    delaunay2d(points).unwrap()
}

type BrokenMeshes = broken::BrokenMeshes<[f64; 2], [u32; 3], Mesh2>;

fn broken_meshes() -> Vec<Broken> {
    let mut broken = BrokenMeshes {
        right,
        verify: |points, mesh| verify2d(points, mesh).unwrap(),
        verify_bare: |points, triangles| verify2d(points, MeshView2::of_triangles(triangles)).unwrap(),
        all: Vec::new(),
    };
    other_arrays(&mut broken);
    triangles(&mut broken);
    hulls(&mut broken);
    broken.all
}

/// Adds meshes that are wrong in the arrays beside the triangles.
fn other_arrays(broken: &mut BrokenMeshes) {
    let square = square();
    let line: Vec<_> = square[..3].to_vec();
    let doubled: Vec<_> = square.iter().chain(&square[2..4]).copied().collect();
    broken.changed(Check::Dimension, "dimension 1 of a square", &square, Mesh, |m| m.dimension = 1);
    broken.changed(Check::Dimension, "dimension 2 of a line", &line, Mesh, |m| m.dimension = 2);
    broken.changed(Check::Dimension, "dimension 3 of a square", &square, Mesh, |m| m.dimension = 3);

    let constraints = Check::Constraints;
    broken.changed(constraints, "a constraint that is no edge", &square, Mesh, |m| m.constraints.push([0, 8]));
    broken.changed(constraints, "a constraint twice", &square, Mesh, |m| m.constraints.extend([[0, 1], [1, 0]]));
    broken.changed(constraints, "a constraint of no points", &square, Mesh, |m| m.constraints.push([9, 7]));
    broken.changed(constraints, "a constraint over a point", &line, Mesh, |m| m.constraints.push([0, 2]));

    let hidden = Check::Hidden;
    broken.changed(hidden, "hidden, though there are no weights", &square, Mesh, |m| m.hidden.push(1));
    let within: Vec<_> = CORNER.into_iter().chain([[0.1, 0.1]]).collect();
    broken.changed(hidden, "hidden, though below the triangle", &within, Triangle(0), |m| {
        *m = right(&CORNER);
        (m.weights, m.hidden, m.duplicate_of) = (vec![0.0; 4], vec![3], vec![NONE; 4]);
    });
    broken.changed(hidden, "hidden and not stated", &within, Mesh, |m| {
        *m = right(&CORNER);
        (m.weights, m.duplicate_of) = (vec![9.0, 9.0, 9.0, 0.0], vec![NONE; 4]);
    });

    let duplicates = Check::Duplicates;
    broken.changed(duplicates, "duplicate not stated", &doubled, Point(9), |m| m.duplicate_of[9] = NONE);
    broken.changed(duplicates, "duplicate of another point", &doubled, Point(10), |m| m.duplicate_of[10] = 2);
    broken.changed(duplicates, "duplicate of none", &doubled, Point(10), |m| m.duplicate_of[10] = u32::MAX - 1);
    broken.changed(duplicates, "duplicates of too few points", &doubled, Mesh, |m| m.duplicate_of.truncate(9));

    let halfedges = Check::Neighbors;
    let inner = |m: &Mesh2| {
        let all = (0..m.halfedges.len()).flat_map(|t| (0..3).map(move |k| (t, k)));
        all.into_iter().find(|&(t, k)| m.halfedges[t][k] != NONE).unwrap()
    };
    let (t, _) = inner(&right(&square));
    broken.changed(halfedges, "half-edges of too few triangles", &square, Mesh, |m| m.halfedges.truncate(5));
    broken.changed(halfedges, "half-edges of too many triangles", &square, Mesh, |m| m.halfedges.push([NONE; 3]));
    broken.changed(halfedges, "one-way adjacency", &square, Triangle(t), |m| {
        let (t, k) = inner(m);
        m.halfedges[t][k] = NONE;
    });
    broken.changed(halfedges, "another half-edge of the right triangle", &square, Triangle(t), |m| {
        let (t, k) = inner(m);
        let e = m.halfedges[t][k];
        m.halfedges[t][k] = e / 3 * 3 + (e + 1) % 3;
    });
    broken.changed(halfedges, "half-edge out of range", &square, Triangle(t), |m| {
        let (t, k) = inner(m);
        m.halfedges[t][k] = i32::MAX as u32;
    });
    broken.changed(halfedges, "another mark for outside", &CORNER, Triangle(0), |m| m.halfedges[0][2] = NONE - 1);
    broken.changed(halfedges, "half-edges in another order", &square, Triangle(0), |m| m.halfedges[0].rotate_left(1));

    let hull = Check::Hull;
    broken.changed(hull, "hull point missing", &square, Mesh, |m| m.hull.truncate(7));
    broken.changed(hull, "points in the middle of edges missing", &square, Mesh, |m| m.hull.retain(|v| v % 2 == 0));
    broken.changed(hull, "hull point twice", &square, Mesh, |m| m.hull.push(m.hull[0]));
    broken.changed(hull, "hull out of order", &square, Mesh, |m| m.hull.swap(2, 3));
    broken.changed(hull, "hull in the other sense", &square, Mesh, |m| m.hull.reverse());
    broken.changed(hull, "hull with a point inside", &square, Mesh, |m| m.hull[3] = 4);
    broken.changed(hull, "hull of no points", &square, Mesh, |m| m.hull[0] = u32::MAX);
    broken.changed(hull, "line out of order", &line, Mesh, |m| m.hull.swap(0, 1));
    broken.changed(hull, "line without an end", &line, Mesh, |m| m.hull.truncate(2));
}

fn triangles(broken: &mut BrokenMeshes) {
    let indices = Check::Indices;
    broken.bare(indices, "vertex one too high", &CORNER, &[[0, 1, 3]], Triangle(0));
    broken.bare(indices, "vertex far too high", &CORNER, &[[0, 1, 2], [0, 2, u32::MAX]], Triangle(1));
    broken.bare(indices, "vertex of no points", &[], &[[0, 2, 1]], Triangle(0));
    broken.bare(indices, "vertex twice", &CORNER, &[[0, 2, 2]], Triangle(0));

    let vertices = Check::Vertices;
    let with = |p: [f64; 2]| CORNER.into_iter().chain([p]).collect::<Vec<_>>();
    broken.bare(vertices, "no triangles", &CORNER, &[], Point(0));
    broken.bare(vertices, "point inside not used", &with([0.1; 2]), &[[0, 1, 2]], Point(3));
    broken.bare(vertices, "point on the hull not used", &with([0.5; 2]), &[[0, 1, 2]], Point(3));
    broken.bare(vertices, "point outside not used", &with([9.0; 2]), &[[0, 1, 2]], Point(3));
    broken.bare(vertices, "duplicate used", &with(CORNER[0]), &[[3, 1, 2]], Triangle(0));
    broken.bare(vertices, "-0 used for 0", &with([-0.0; 2]), &[[3, 1, 2]], Triangle(0));

    let orientation = Check::Orientation;
    broken.bare(orientation, "clockwise", &CORNER, &[[0, 2, 1]], Triangle(0));
    // Rounded arithmetic sees an area.
    let flat = [[0.1, 0.1], [0.3, 0.3], [0.7, 0.7], [0.0, 1.0]];
    broken.bare(orientation, "triangle of a line", &flat, &[[0, 2, 1], [0, 1, 3], [1, 2, 3]], Triangle(0));
    // Rounded arithmetic sees none.
    let tiny = CORNER.map(|p| p.map(|x| x * 1e-200));
    broken.bare(orientation, "turned and tiny", &tiny, &[[0, 2, 1]], Triangle(0));
    // By one unit in the last place.
    let thin = [[0.0, 0.0], [0.5, 0.5f64.next_up()], [1.0, 1.0]];
    broken.bare(orientation, "turned by one bit", &thin, &[[0, 1, 2]], Triangle(0));
    let mut turned = right(&square()).triangles;
    turned[3].swap(0, 1);
    // The neighbours of the inverted triangle are on the wrong side, too.
    let report = verify2d(&square(), MeshView2::of_triangles(&turned)).unwrap();
    assert_eq!(failures(&report), [orientation, Check::Facets], "{report}");

    let edges = Check::Facets;
    let two = [[0, 2, 1], [0, 1, 3]];
    broken.bare(edges, "triangle twice", &KITE, &[two[0], two[1], two[1]], Triangle(0));
    let above = [[0.0, 0.0], [1.0, 0.0], [0.2, 1.0], [0.7, 2.0]];
    broken.bare(edges, "both on one side of an edge", &above, &[[0, 1, 2], [0, 1, 3]], Triangle(0));
    let fan = [[0.0, 0.0], [1.0, 0.0], [0.2, 1.0], [0.7, 2.0], [0.5, -1.0]];
    broken.bare(edges, "three at an edge", &fan, &[[0, 1, 2], [0, 1, 3], [0, 4, 1]], Triangle(0));

    // The long diagonal of the kite.
    broken.bare(Check::Delaunay, "flipped edge", &KITE, &[[3, 2, 1], [3, 0, 2]], Triangle(0));
    // Inside by one unit in the last place of one coordinate, which rounded arithmetic does not
    // see.
    let mut nearly = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    nearly[2][0] = 1.0f64.next_up();
    let wrong =
        if right(&nearly).canonical().contains(&[0, 1, 2]) { [[0, 1, 3], [1, 2, 3]] } else { [[0, 1, 2], [0, 2, 3]] };
    broken.bare(Check::Delaunay, "not Delaunay by one bit", &nearly, &wrong, Triangle(0));

    // The other diagonal of the square.
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let other =
        if right(&square).canonical().contains(&[0, 1, 2]) { [[0, 1, 3], [1, 2, 3]] } else { [[0, 1, 2], [0, 2, 3]] };
    broken.bare(Check::CanonicalTies, "tie broken otherwise", &square, &other, Triangle(0));
}

fn hulls(broken: &mut BrokenMeshes) {
    let closed = Check::HullClosed;
    let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]];
    broken.bare(closed, "two meet at a vertex only", &bow_tie, &[[0, 2, 1], [0, 4, 3]], Point(0));
    let apart: Vec<_> = CORNER.into_iter().chain(CORNER.map(|p| p.map(|x| x + 5.0))).collect();
    broken.bare(closed, "two that do not touch", &apart, &[[0, 1, 2], [3, 4, 5]], Mesh);
    // A triangle within a triangle: the one in the middle is missing.
    let nested = [[0.0, 8.0], [7.0, -4.0], [-7.0, -4.0], [0.0, 2.0], [1.0, -1.0], [-1.0, -1.0]];
    let hole = |m: &Mesh2| {
        let inner = m.triangles.iter().position(|t| t.iter().all(|&v| v > 2)).unwrap();
        let mut triangles = m.triangles.clone();
        triangles.remove(inner);
        triangles
    };
    broken.bare(closed, "triangle missing inside", &nested, &hole(&right(&nested)), Mesh);

    let convex = Check::HullConvex;
    let square = square();
    let mesh = right(&square);
    let at_hull = mesh.halfedges.iter().position(|h| h.contains(&NONE)).unwrap();
    let mut dented = mesh.triangles.clone();
    let missing = dented.remove(at_hull);
    // The vertex of the triangle that was missing, behind the hull's edge.
    let report = verify2d(&square, MeshView2::of_triangles(&dented)).unwrap();
    // The vertex of the missing triangle that lies behind the hull's edge.
    let behind = report.failures().next().unwrap().1.point.unwrap();
    assert!(missing.contains(&(behind as u32)));
    broken.add(convex, "triangle missing at the hull", report, Point(behind));
    // Around vertex 0, five triangles that turn twice before they meet: they have every local
    // property of a Delaunay triangulation, and one closed hull without a concave corner.
    let pentagram = [[0.0, 0.0], [10.0, 0.0], [3.0, 9.5], [-8.0, 6.0], [-8.0, -6.0], [3.0, -9.5]];
    let twice: Vec<_> = (0..5).map(|i| [0, 1 + 2 * i % 5, 1 + (2 * i + 2) % 5]).collect();
    broken.bare(convex, "covered twice", &pentagram, &twice, Mesh);
    // Five triangles around vertex 0, the last of which begins on the line on which the first ends.
    let slit = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [-2.0, 0.0], [0.0, -2.0], [3.0, 0.0]];
    let around = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    broken.bare(convex, "folded along a line", &slit, &around, Point(0));
}

#[test]
fn each_broken_mesh_fails_its_check_and_no_other() {
    assert_that_each_fails_its_check(&broken_meshes());
}

#[test]
fn every_check_has_a_broken_mesh_and_an_outcome_in_order() {
    let broken = broken_meshes();
    assert_that_each_check_fails(&broken, &CHECKS);
    for Broken { name, report, .. } in broken {
        assert!(report.outcomes.iter().map(|(check, _)| *check).collect::<BTreeSet<_>>() == CHECKS.into(), "{name}");
    }
}

#[test]
fn right_meshes_pass_whatever_they_state() {
    for distribution in Distribution2::ALL {
        let points = generate2d(distribution, 300, 1);
        let mesh = right(&points);
        let report = verify2d(&points, &mesh).unwrap();
        assert!(report.outcomes.iter().all(|(_, outcome)| *outcome == Outcome::Passed), "{distribution:?}:\n{report}");
        let bare = verify2d(&points, MeshView2::of_triangles(&mesh.triangles)).unwrap();
        assert!(bare.passed(), "{bare}");
        for check in [Check::Dimension, Check::Duplicates, Check::Neighbors, Check::Hull] {
            assert_eq!(bare.outcome(check), Some(&Outcome::NotStated));
        }
    }
    for points in [vec![], vec![[1.0; 2]], vec![[1.0; 2]; 3], vec![[0.0; 2], [2.0; 2], [1.0; 2], [2.0; 2]]] {
        let report = verify2d(&points, &right(&points)).unwrap();
        assert!(report.passed(), "{report}");
    }
}

#[test]
fn the_order_of_triangles_and_vertices_and_the_first_of_the_hull_are_free() {
    let points = square();
    let mut mesh = right(&points);
    mesh.triangles.reverse();
    mesh.triangles.iter_mut().for_each(|t| t.rotate_left(1));
    mesh.hull.rotate_left(3);
    let mut statement = MeshView2::of_triangles(&mesh.triangles);
    statement.hull = Some(&mesh.hull);
    let report = verify2d(&points, statement).unwrap();
    assert!(report.passed(), "{report}");
}

#[test]
fn counts_of_a_square() {
    let counts = verify2d(&square(), &right(&square())).unwrap().counts;
    assert_eq!((counts.points, counts.distinct_points, counts.vertices), (9, 9, 9));
    assert_eq!((counts.facets, counts.edges, counts.hull_edges), (8, 16, 8));
}

#[test]
fn a_point_that_is_not_finite_is_an_error() {
    let error = verify2d(&[[0.0, 0.0], [0.0, f64::NAN]], MeshView2::default()).unwrap_err();
    assert_eq!(error, Error::NotFinite { index: 1, axis: 'y', value: "NaN" });
}

/// Of all sets of counter-clockwise triangles of these five points, the right one passes and no
/// other.
fn only_the_definition_passes(points: &[[f64; 2]; 5]) {
    let mut oriented = Vec::new();
    for a in 0..5u32 {
        for b in a + 1..5 {
            for c in b + 1..5 {
                let [p, q, r] = [a, b, c].map(|v| points[v as usize]);
                match gdel::orient2d(p, q, r) {
                    0 => {}
                    1 => oriented.push([a, b, c]),
                    _ => oriented.push([a, c, b]),
                }
            }
        }
    }
    let mut passed = Vec::new();
    for set in 0u32..1 << oriented.len() {
        let triangles: Vec<_> = (0..).zip(&oriented).filter(|(i, _)| set >> i & 1 == 1).map(|(_, t)| *t).collect();
        if verify2d(points, MeshView2::of_triangles(&triangles)).unwrap().passed() {
            passed.push(mesh::canonical(&triangles));
        }
    }
    assert_eq!(passed, [definition2(points).triangles]);
}

#[test]
fn of_all_meshes_of_five_points_only_the_right_one_passes() {
    for seed in 0..20 {
        only_the_definition_passes(generate2d(Distribution2::Uniform, 5, seed).first_chunk().unwrap());
    }
    let [o, i] = [0.0, 1.0];
    only_the_definition_passes(&[[i, o], [o, i], [-i, o], [o, -i], [o, o]]);
    only_the_definition_passes(&[[o, o], [i, o], [2.0, o], [o, i], [i, i]]);
    only_the_definition_passes(&[[2.0, o], [i, o], [o, o], [3.0, o], [i, i]]);
    only_the_definition_passes(&[[5.0, o], [4.0, 3.0], [3.0, 4.0], [o, 5.0], [-3.0, 4.0]]);
}

/// One change to the triangles of a mesh.
#[derive(Debug, Clone)]
enum Change {
    OfSimplices(broken::Change),
    Flip(prop::sample::Index),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        6 => broken::change::<3>().prop_map(Change::OfSimplices),
        1 => any::<prop::sample::Index>().prop_map(Change::Flip),
    ]
}

fn apply(change: Change, mesh: &mut Mesh2, points: usize) {
    let triangles = &mut mesh.triangles;
    let count = triangles.len();
    match change {
        Change::OfSimplices(change) => change.apply(triangles, points),
        Change::Flip(e) => {
            let e = e.index(mesh.halfedges.len() * 3);
            let f = mesh.halfedges[e / 3][e % 3];
            if f == NONE {
                return;
            }
            let f = f as usize;
            if e / 3 < count && f / 3 < count {
                let ([a, b, c], d) = ([0, 1, 2].map(|k| triangles[e / 3][(e + k) % 3]), triangles[f / 3][(f + 2) % 3]);
                (triangles[e / 3], triangles[f / 3]) = ([c, a, d], [d, b, c]);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_changed_mesh_passes_only_if_it_is_still_the_right_one(
        points in prop::collection::vec(prop::array::uniform2(0..5u8), 4..20),
        changes in prop::collection::vec(change(), 1..3),
    ) {
        let points: Vec<_> = points.into_iter().map(|p| p.map(f64::from)).collect();
        let mut mesh = right(&points);
        let expected = mesh.canonical();
        for change in changes {
            if !mesh.triangles.is_empty() {
                apply(change, &mut mesh, points.len());
            }
        }
        let counter_clockwise = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            gdel::orient2d(a, b, c) > 0
        };
        let still_right = mesh.canonical() == expected && mesh.triangles.iter().all(counter_clockwise);
        let report = verify2d(&points, MeshView2::of_triangles(&mesh.triangles)).unwrap();
        prop_assert_eq!(report.passed(), still_right, "{}", report);
    }

    #[test]
    fn any_garbage_gets_a_report(
        points in prop::collection::vec(prop::array::uniform2(any::<f64>().prop_filter("finite", |x| x.is_finite())), 0..9),
        triangles in prop::collection::vec(prop::array::uniform3(prop_oneof![20 => 0..9u32, 1 => any::<u32>()]), 0..9),
        halfedges in prop::option::of(prop::collection::vec(any::<[u32; 3]>(), 0..9)),
        neighbors in prop::option::of(prop::collection::vec(any::<[u32; 3]>(), 0..9)),
        hull in prop::option::of(prop::collection::vec(any::<u32>(), 0..9)),
        duplicate_of in prop::option::of(prop::collection::vec(any::<u32>(), 0..9)),
        dimension in any::<Option<u8>>(),
        constraints in prop::option::of(prop::collection::vec([0..12u32, 0..12], 0..9)),
        segments in prop::option::of(prop::collection::vec([0..12u32, 0..12], 0..9)),
    ) {
        let mut statement = MeshView2::of_triangles(&triangles);
        statement.halfedges = halfedges.as_deref();
        statement.neighbors = neighbors.as_deref();
        statement.hull = hull.as_deref();
        statement.duplicate_of = duplicate_of.as_deref();
        statement.dimension = dimension;
        (statement.constraints, statement.segments) = (constraints.as_deref(), segments.as_deref());
        let report = verify2d(&points, statement).unwrap();
        prop_assert_eq!(report.outcomes.len(), CHECKS.len());
        prop_assert_eq!(report.passed(), report.failures().next().is_none());
    }
}
