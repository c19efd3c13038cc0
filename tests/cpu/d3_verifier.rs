//! The 3D verifier passes only the correct mesh, and says what is wrong with any other.

use crate::broken::{
    self,
    At::{Mesh, Point, Tetrahedron},
    Broken, assert_that_each_check_fails, assert_that_each_fails_its_check, change, failures,
};
use crate::oracle::{self, definition};
use gdel::{
    Error, Mesh3, MeshView3, NONE, delaunay3d,
    internals::{
        d3::generate::{Distribution3, generate3d},
        mesh,
    },
    verify::{Check, Outcome},
    verify3d,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// The corner of the unit cube.
const CORNER: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// A short edge 0-1 through a triangle 2, 3, 4: its Delaunay triangulation has the three tetrahedra
/// around the edge.
const SHORT_AXIS: [[f64; 3]; 5] =
    [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [4.0, 0.0, 0.0], [-2.0, 4.0, 0.0], [-2.0, -4.0, 0.0]];
const AROUND_SHORT_AXIS: [[u32; 4]; 3] = [[0, 1, 2, 3], [0, 1, 3, 4], [0, 1, 4, 2]];

fn cube() -> Vec<[f64; 3]> {
    (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect()
}

fn right(points: &[[f64; 3]]) -> Mesh3 {
    delaunay3d(points).unwrap()
}

type BrokenMeshes = broken::BrokenMeshes<[f64; 3], [u32; 4], Mesh3>;

fn broken_meshes() -> Vec<Broken> {
    let mut broken = BrokenMeshes {
        right,
        verify: |points, mesh| verify3d(points, mesh).unwrap(),
        verify_bare: |points, tetrahedra| verify3d(points, MeshView3::of_tetrahedra(tetrahedra)).unwrap(),
        all: Vec::new(),
    };
    other_arrays(&mut broken);
    tetrahedra(&mut broken);
    hulls(&mut broken);
    broken.all
}

/// Adds meshes that are wrong in the arrays beside the tetrahedra.
fn other_arrays(broken: &mut BrokenMeshes) {
    let cube = cube();
    let flat: Vec<_> = cube[..4].to_vec();
    let doubled: Vec<_> = cube.iter().chain(&cube[2..4]).copied().collect();
    broken.changed(Check::Dimension, "dimension 2 of a cube", &cube, Mesh, |m| m.dimension = 2);
    broken.changed(Check::Dimension, "dimension 3 of a square", &flat, Mesh, |m| m.dimension = 3);
    broken.changed(Check::Dimension, "dimension 1 of nothing", &[], Mesh, |m| m.dimension = 1);

    let hidden = Check::Hidden;
    broken.changed(hidden, "hidden, though there are no weights", &cube, Mesh, |m| m.hidden.push(1));
    let within: Vec<_> = CORNER.into_iter().chain([[0.1; 3]]).collect();
    broken.changed(hidden, "hidden, though below the tetrahedron", &within, Tetrahedron(0), |m| {
        *m = right(&CORNER);
        (m.weights, m.hidden, m.duplicate_of) = (vec![0.0; 5], vec![4], vec![NONE; 5]);
    });
    broken.changed(hidden, "hidden and not stated", &within, Mesh, |m| {
        *m = right(&CORNER);
        (m.weights, m.duplicate_of) = (vec![9.0, 9.0, 9.0, 9.0, 0.0], vec![NONE; 5]);
    });

    let duplicates = Check::Duplicates;
    broken.changed(duplicates, "duplicate not stated", &doubled, Point(8), |m| m.duplicate_of[8] = NONE);
    broken.changed(duplicates, "duplicate of another point", &doubled, Point(9), |m| m.duplicate_of[9] = 2);
    broken.changed(duplicates, "duplicate of none", &doubled, Point(9), |m| m.duplicate_of[9] = u32::MAX - 1);
    broken.changed(duplicates, "duplicates of too few points", &doubled, Mesh, |m| m.duplicate_of.truncate(9));
    broken.changed(duplicates, "highest index stands for all", &doubled, Point(2), |m| {
        m.duplicate_of[2] = 8;
        m.duplicate_of[8] = NONE;
    });

    let neighbors = Check::Neighbors;
    let inner = |m: &Mesh3| {
        let (t, k) = (0..m.neighbors.len())
            .flat_map(|t| (0..4).map(move |k| (t, k)))
            .find(|&(t, k)| m.neighbors[t][k] != NONE)
            .unwrap();
        (t, k)
    };
    broken.changed(neighbors, "neighbors of too few tetrahedra", &cube, Mesh, |m| m.neighbors.truncate(5));
    broken.changed(neighbors, "neighbors of too many tetrahedra", &cube, Mesh, |m| m.neighbors.push([NONE; 4]));
    let (t, _) = inner(&right(&cube));
    broken.changed(neighbors, "one-way adjacency", &cube, Tetrahedron(t), |m| {
        let (t, k) = inner(m);
        m.neighbors[t][k] = NONE;
    });
    broken.changed(neighbors, "neighbor out of range", &cube, Tetrahedron(t), |m| {
        let (t, k) = inner(m);
        m.neighbors[t][k] = i32::MAX as u32;
    });
    broken.changed(neighbors, "another mark for outside", &CORNER, Tetrahedron(0), |m| m.neighbors[0][2] = NONE - 1);
    broken.changed(neighbors, "neighbors in another order", &cube, Tetrahedron(0), |m| m.neighbors[0].rotate_left(1));

    let hull = Check::Hull;
    broken.changed(hull, "hull triangle missing", &CORNER, Tetrahedron(0), |m| m.hull.truncate(3));
    broken.changed(hull, "hull triangle inside out", &CORNER, Tetrahedron(0), |m| m.hull[1].swap(0, 1));
    broken.changed(hull, "hull triangle twice", &CORNER, Mesh, |m| m.hull.push(m.hull[0]));
    broken.changed(hull, "hull triangle of no points", &CORNER, Mesh, |m| m.hull.push([7, u32::MAX, 7]));
    broken.changed(hull, "hull of a square", &flat, Mesh, |m| m.hull.push([0, 1, 2]));
}

fn tetrahedra(broken: &mut BrokenMeshes) {
    let indices = Check::Indices;
    broken.bare(indices, "vertex one too high", &CORNER, &[[0, 1, 2, 4]], Tetrahedron(0));
    broken.bare(indices, "vertex far too high", &CORNER, &[[0, 1, 2, 3], [0, u32::MAX, 2, 3]], Tetrahedron(1));
    broken.bare(indices, "vertex of no points", &[], &[[0, 1, 2, 3]], Tetrahedron(0));
    broken.bare(indices, "vertex twice", &CORNER, &[[0, 1, 2, 1]], Tetrahedron(0));

    let vertices = Check::Vertices;
    let with = |p: [f64; 3]| CORNER.into_iter().chain([p]).collect::<Vec<_>>();
    broken.bare(vertices, "no tetrahedra", &CORNER, &[], Point(0));
    broken.bare(vertices, "point inside not used", &with([0.1; 3]), &[[0, 1, 2, 3]], Point(4));
    broken.bare(vertices, "point on the hull not used", &with([0.5, 0.5, 0.0]), &[[0, 1, 2, 3]], Point(4));
    broken.bare(vertices, "point outside not used", &with([9.0; 3]), &[[0, 1, 2, 3]], Point(4));
    broken.bare(vertices, "duplicate used", &with(CORNER[0]), &[[4, 1, 2, 3]], Tetrahedron(0));
    broken.bare(vertices, "-0 used for 0", &with([-0.0; 3]), &[[4, 1, 2, 3]], Tetrahedron(0));

    let orientation = Check::Orientation;
    broken.bare(orientation, "inside out", &CORNER, &[[1, 0, 2, 3]], Tetrahedron(0));
    broken.bare(orientation, "tetrahedron of a square", &cube()[..4], &[[0, 1, 2, 3]], Tetrahedron(0));
    // Rounded arithmetic sees a volume.
    let line = [[0.0; 3], [1.0, 1.0, 1.0], [0.1, 0.1, 0.1], [0.3, 0.3, 0.3]];
    broken.bare(orientation, "tetrahedron of a line", &line, &[[0, 1, 2, 3]], Tetrahedron(0));
    // Rounded arithmetic sees none.
    let thin = [[0.0; 3], [1e-200, 0.0, 0.0], [0.0, 1e-200, 0.0], [0.0, 0.0, -1e-200]];
    broken.bare(orientation, "inside out and tiny", &thin, &[[0, 1, 2, 3]], Tetrahedron(0));

    let facets = Check::Facets;
    let [a, b, c] = AROUND_SHORT_AXIS;
    broken.bare(facets, "tetrahedron twice", &SHORT_AXIS, &[a, b, c, b], Tetrahedron(0));
    let two_above: Vec<_> = with([0.25, 0.25, 3.0]);
    broken.bare(facets, "both on one side of a facet", &two_above, &[[0, 1, 2, 3], [0, 1, 2, 4]], Tetrahedron(0));
    let fan: Vec<_> = two_above.iter().copied().chain([[0.25, 0.25, -1.0]]).collect();
    let three = [[0, 1, 2, 3], [0, 1, 2, 4], [0, 2, 1, 5]];
    broken.bare(facets, "three at a facet", &fan, &three, Tetrahedron(0));

    // The same five points with the axis taken out.
    let flipped = [[2, 3, 4, 1], [2, 4, 3, 0]];
    broken.bare(Check::Delaunay, "two tetrahedra for three", &SHORT_AXIS, &flipped, Tetrahedron(0));
    let long_axis = SHORT_AXIS.map(|[x, y, z]| [x, y, 9.0 * z]);
    broken.bare(Check::Delaunay, "three tetrahedra for two", &long_axis, &AROUND_SHORT_AXIS, Tetrahedron(0));
    // Inside by one unit in the last place of one coordinate, which rounded arithmetic does not
    // see.
    let mut nearly = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [-0.6, 0.8, 0.0], [-0.6, -0.8, 0.0]];
    nearly[2][0] = 1.0f64.next_up();
    let right_one = right(&nearly).canonical();
    let three = [[1, 0, 2, 3], [1, 0, 3, 4], [1, 0, 4, 2]];
    let two = [[2, 3, 4, 0], [2, 4, 3, 1]];
    let wrong_one = if right_one.len() == 2 { &three[..] } else { &two[..] };
    broken.bare(Check::Delaunay, "not Delaunay by one bit", &nearly, wrong_one, Tetrahedron(0));

    // The triangulation of the cube for another order of the indices.
    let cube = cube();
    let mut exchanged = cube.clone();
    exchanged.swap(0, 1);
    let index = |v: u32| if v < 2 { 1 - v } else { v };
    let tetrahedra: Vec<_> = right(&exchanged).tetrahedra.into_iter().map(|t| t.map(index)).collect();
    let first = first_tie(&cube, &tetrahedra);
    broken.bare(Check::CanonicalTies, "cube for another order", &cube, &tetrahedra, Tetrahedron(first));
}

/// Returns the first tetrahedron whose circumsphere contains a neighbour's vertex by the
/// definition, judged by big integers.
fn first_tie(points: &[[f64; 3]], tetrahedra: &[[u32; 4]]) -> usize {
    let points = oracle::integers(points);
    let inside = |t: &[u32; 4], v: u32| {
        let five = [t[0], t[1], t[2], t[3], v];
        oracle::in_circumsphere_symbolic(&five, &five.map(|v| &points[v as usize])) > 0
    };
    let shared = |s: &[u32; 4], t: &[u32; 4]| s.iter().filter(|v| t.contains(v)).count();
    let bad = |(i, t): (usize, &[u32; 4])| {
        let beyond = tetrahedra[i + 1..].iter().filter(|s| shared(s, t) == 3);
        beyond.flatten().any(|v| !t.contains(v) && inside(t, *v))
    };
    tetrahedra.iter().enumerate().position(bad).unwrap()
}

fn hulls(broken: &mut BrokenMeshes) {
    let on_an_edge: Vec<_> = CORNER.into_iter().chain([[-1.0, 0.0, 0.0], [-1.0, -1.0, -1.0]]).collect();
    let touching = [[0, 1, 2, 3], [0, 3, 4, 5]];
    broken.bare(Check::HullClosed, "two meet at an edge only", &on_an_edge, &touching, Tetrahedron(0));

    let dented = &AROUND_SHORT_AXIS[..2];
    broken.bare(Check::HullConvex, "tetrahedron missing at the hull", &SHORT_AXIS, dented, Tetrahedron(0));
    // Around the edge 0-1 the tetrahedra turn by 360°, but do not meet again: the last two
    // triangles are coplanar.
    let slit = [
        [0.0, -1.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 0.0, 2.0],
        [-2.0, 0.0, 0.0],
        [0.0, 0.0, -2.0],
        [3.0, 0.0, 0.0],
    ];
    let around = [[1, 0, 2, 3], [1, 0, 3, 4], [1, 0, 4, 5], [1, 0, 5, 6]];
    broken.bare(Check::HullConvex, "coplanar triangles folded", &slit, &around, Tetrahedron(0));

    let apart: Vec<_> = CORNER.into_iter().chain(CORNER.map(|p| p.map(|x| x + 5.0))).collect();
    let two = [[0, 1, 2, 3], [4, 5, 6, 7]];
    broken.bare(Check::EulerCharacteristic, "two that do not touch", &apart, &two, Mesh);

    let mirrored: Vec<_> = CORNER.into_iter().chain(CORNER[1..].iter().map(|p| p.map(|x| -x))).collect();
    let at_a_vertex = [[0, 1, 2, 3], [0, 5, 4, 6]];
    broken.bare(Check::Covering, "two meet at a vertex only", &mirrored, &at_a_vertex, Tetrahedron(1));
    let (points, tetrahedra) = pentagram();
    broken.bare(Check::Covering, "pentagram", &points, &tetrahedra, Tetrahedron(2));
}

/// Returns five tetrahedra around an edge that turn twice before they meet: they have every local
/// property of a Delaunay triangulation, and a closed hull without a concave edge.
fn pentagram() -> (Vec<[f64; 3]>, Vec<[u32; 4]>) {
    let pentagon = [[10.0, 0.0], [3.0, 9.5], [-8.0, 6.0], [-8.0, -6.0], [3.0, -9.5]].map(|[x, y]| [x, y, 0.0]);
    let points = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]].into_iter().chain(pentagon).collect();
    let tetrahedra = (0..5).map(|i| [0, 1, 2 + 2 * i % 5, 2 + (2 * i + 2) % 5]).collect();
    (points, tetrahedra)
}

#[test]
fn each_broken_mesh_fails_its_check_and_no_other() {
    assert_that_each_fails_its_check(&broken_meshes());
}

/// The 3D checks: constraints exist in 2D only, and are the last.
fn checks() -> &'static [Check] {
    &Check::ALL[..Check::ALL.len() - 1]
}

#[test]
fn every_check_has_a_broken_mesh() {
    assert_that_each_check_fails(&broken_meshes(), checks());
}

#[test]
fn every_check_has_an_outcome_in_order_and_a_name_of_its_own() {
    for broken in broken_meshes() {
        assert_eq!(broken.report.outcomes.iter().map(|(check, _)| *check).collect::<Vec<_>>(), checks());
    }
    assert_eq!(Check::ALL.map(Check::name).into_iter().collect::<BTreeSet<_>>().len(), Check::ALL.len());
}

#[test]
fn a_mesh_of_tetrahedra_only_passes_with_the_rest_not_stated() {
    let points = generate3d(Distribution3::Uniform, 500, 1);
    let mesh = right(&points);
    let report = verify3d(&points, MeshView3::of_tetrahedra(&mesh.tetrahedra)).unwrap();
    assert!(report.passed(), "{report}");
    for check in [Check::Dimension, Check::Duplicates, Check::Neighbors, Check::Hull] {
        assert_eq!(report.outcome(check), Some(&Outcome::NotStated));
    }
    assert!(verify3d(&points, &mesh).unwrap().outcomes.iter().all(|(_, outcome)| *outcome == Outcome::Passed));
}

#[test]
fn the_order_of_tetrahedra_and_vertices_is_free() {
    let points = cube();
    let mut mesh = right(&points);
    mesh.tetrahedra.reverse();
    for t in &mut mesh.tetrahedra {
        let [a, b, c, d] = *t;
        *t = [c, a, b, d];
    }
    for (i, triangle) in mesh.hull.iter_mut().rev().enumerate() {
        triangle.rotate_left(i % 3);
    }
    let mut statement = MeshView3::of_tetrahedra(&mesh.tetrahedra);
    statement.hull = Some(&mesh.hull);
    let report = verify3d(&points, statement).unwrap();
    assert!(report.passed(), "{report}");
}

#[test]
fn counts_of_a_cube() {
    let report = verify3d(&cube(), &right(&cube())).unwrap();
    let counts = report.counts;
    assert_eq!((counts.points, counts.distinct_points, counts.vertices), (8, 8, 8));
    assert_eq!((counts.tetrahedra, counts.facets, counts.edges, counts.hull_triangles), (6, 18, 19, 12));
    assert_eq!(report.dimension, 3);
}

#[test]
fn a_point_that_is_not_finite_is_an_error() {
    let points = [[0.0; 3], [0.0, f64::NAN, 0.0]];
    let error = verify3d(&points, MeshView3::default()).unwrap_err();
    assert_eq!(error, Error::NotFinite { index: 1, axis: 'y', value: "NaN" });
}

#[test]
fn flat_tetrahedra_on_the_hull_of_a_cube_are_caught() {
    // What floating-point codes give: one facet of the cube is split by both diagonals, with a flat
    // one between.
    let points = cube();
    let mut tetrahedra = right(&points).tetrahedra;
    tetrahedra.push([0, 1, 2, 3]);
    let report = verify3d(&points, MeshView3::of_tetrahedra(&tetrahedra)).unwrap();
    assert!(failures(&report).contains(&Check::Orientation), "{report}");
    assert_eq!(report.failures().next().unwrap().1.tetrahedron, Some(tetrahedra.len() - 1));
}

/// Checks that of all sets of positively oriented tetrahedra of these six points, only the correct
/// one passes.
fn only_the_definition_passes(points: &[[f64; 3]; 6]) {
    let integers = oracle::integers(points);
    let mut oriented = Vec::new();
    for a in 0..6u32 {
        for b in a + 1..6 {
            for c in b + 1..6 {
                for d in c + 1..6 {
                    let corners = [a, b, c, d].map(|v| &integers[v as usize]);
                    match oracle::sign(&oracle::orientation(&corners)) {
                        0 => {}
                        1 => oriented.push([a, b, c, d]),
                        _ => oriented.push([b, a, c, d]),
                    }
                }
            }
        }
    }
    let mut passed = Vec::new();
    let mut chosen = Vec::new();
    for set in 0u32..1 << oriented.len() {
        chosen.clear();
        chosen.extend(oriented.iter().enumerate().filter(|(i, _)| set >> i & 1 == 1).map(|(_, t)| *t));
        if verify3d(points, MeshView3::of_tetrahedra(&chosen)).unwrap().passed() {
            passed.push(mesh::canonical(&chosen));
        }
    }
    assert_eq!(passed, [definition(points).tetrahedra]);
}

#[test]
fn of_all_meshes_of_six_points_only_the_right_one_passes() {
    for seed in 0..4 {
        only_the_definition_passes(generate3d(Distribution3::Uniform, 6, seed).first_chunk().unwrap());
    }
}

#[test]
fn of_all_meshes_of_six_degenerate_points_only_the_right_one_passes() {
    let [o, i] = [0.0, 1.0];
    only_the_definition_passes(&[[i, o, o], [-i, o, o], [o, i, o], [o, -i, o], [o, o, i], [o, o, -i]]);
    only_the_definition_passes(&[[o, o, i], [o, o, o], [i, o, o], [o, i, o], [i, i, o], [i, o, i]]);
    only_the_definition_passes(&[[o, o, o], [i, o, o], [2.0, o, o], [o, i, i], [o, 2.0, i], [o, 3.0, i]]);
    only_the_definition_passes(&[[o, o, o], [4.0, o, o], [o, 4.0, o], [i, i, o], [i, i, i], [o, o, i]]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_changed_mesh_passes_only_if_it_is_still_the_right_one(
        points in prop::collection::vec(prop::array::uniform3(0..4u8), 5..20),
        changes in prop::collection::vec(change::<4>(), 1..3),
    ) {
        let points: Vec<_> = points.into_iter().map(|p| p.map(f64::from)).collect();
        let mut mesh = right(&points);
        let expected = mesh.canonical();
        for change in changes {
            if !mesh.tetrahedra.is_empty() {
                change.apply(&mut mesh.tetrahedra, points.len());
            }
        }
        let integers = oracle::integers(&points);
        let oriented = |t: &[u32; 4]| oracle::sign(&oracle::orientation(&t.map(|v| &integers[v as usize]))) > 0;
        let still_right = mesh.canonical() == expected && mesh.tetrahedra.iter().all(oriented);
        let report = verify3d(&points, MeshView3::of_tetrahedra(&mesh.tetrahedra)).unwrap();
        prop_assert_eq!(report.passed(), still_right, "{}", report);
    }

    #[test]
    fn any_garbage_gets_a_report(
        points in prop::collection::vec(prop::array::uniform3(any::<f64>().prop_filter("finite", |x| x.is_finite())), 0..9),
        tetrahedra in prop::collection::vec(prop::array::uniform4(prop_oneof![20 => 0..9u32, 1 => any::<u32>()]), 0..9),
        neighbors in prop::option::of(prop::collection::vec(any::<[u32; 4]>(), 0..9)),
        hull in prop::option::of(prop::collection::vec(any::<[u32; 3]>(), 0..9)),
        duplicate_of in prop::option::of(prop::collection::vec(any::<u32>(), 0..9)),
        dimension in any::<Option<u8>>(),
    ) {
        let mut statement = MeshView3::of_tetrahedra(&tetrahedra);
        statement.neighbors = neighbors.as_deref();
        statement.hull = hull.as_deref();
        statement.duplicate_of = duplicate_of.as_deref();
        statement.dimension = dimension;
        let report = verify3d(&points, statement).unwrap();
        prop_assert_eq!(report.outcomes.len(), checks().len());
        prop_assert_eq!(report.passed(), report.failures().next().is_none());
    }
}
