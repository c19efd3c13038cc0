//! The 2D triangulation on the CPU is the one that the definition names, and no other, and flips
//! lead to it from any triangulation.

use crate::oracle::{Definition2, definition2};
use gdel::{
    Mesh2, NONE,
    internals::{
        Options, Winding,
        cpu::delaunay_in_order,
        d2::{
            Triangulation2,
            lawson::{Aborted, LawsonOutcome, NearDelaunay2, lawson},
        },
        input::{lattice::Lattice, order::Order},
        mesh,
        parallel::Threads,
        predicates::filter::PredicateContext2,
    },
    verify2d,
};
use proptest::prelude::*;
use rand_pcg::{
    Pcg64Mcg,
    rand_core::{Rng, SeedableRng},
};

fn found(mesh: Mesh2) -> Definition2 {
    Definition2 { triangles: mesh.canonical(), duplicate_of: mesh.duplicate_of, dimension: mesh.dimension }
}

/// Checks that the mesh is that of the definition, for several insertion orders, and that the
/// verifier agrees.
fn check(points: &[[f64; 2]]) -> Result<(), TestCaseError> {
    let expected = definition2(points);
    for order in [Order::default(), Order::Shuffled(1), Order::Shuffled(2)] {
        let mesh = delaunay_in_order::<2>(points.into(), &Options::default(), order)?;
        check_layout(points, &mesh)?;
        let report = verify2d(points, &mesh)?;
        prop_assert!(report.passed(), "{order:?}:\n{report}");
        prop_assert_eq!(&found(mesh), &expected, "{:?}", order);
    }
    check_flips(points, &expected)
}

/// What the documentation of [`Mesh2`] says of `triangles`, `halfedges` and `hull`.
fn check_layout(points: &[[f64; 2]], mesh: &Mesh2) -> Result<(), TestCaseError> {
    let triangles = mesh.triangles.as_flattened();
    let halfedges = mesh.halfedges.as_flattened();
    let next = |e: usize| if e % 3 == 2 { e - 2 } else { e + 1 };
    let mut hull_edges = 0;
    for &triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| points[v as usize]);
        prop_assert_eq!(gdel::orient2d(a, b, c), 1);
    }
    for e in 0..halfedges.len() {
        let reference = halfedges[e] as usize;
        if halfedges[e] == NONE {
            hull_edges += 1;
            let at = mesh.hull.iter().position(|&v| v == triangles[e]);
            prop_assert_eq!(at.map(|at| mesh.hull[(at + 1) % mesh.hull.len()]), Some(triangles[next(e)]));
            continue;
        }
        prop_assert_eq!(halfedges[reference], e as u32);
        prop_assert_eq!([triangles[e], triangles[next(e)]], [triangles[next(reference)], triangles[reference]]);
    }
    if mesh.dimension == 2 {
        prop_assert_eq!(hull_edges, mesh.hull.len());
        prop_assert_eq!(mesh.hull.first(), mesh.hull.iter().min());
    } else {
        let ascending = mesh.hull.windows(2).all(|pair| points[pair[0] as usize] < points[pair[1] as usize]);
        prop_assert!(ascending, "{:?}", mesh.hull);
        prop_assert_eq!(mesh.hull.len(), points.len() - mesh.duplicate_count());
    }
    Ok(())
}

/// Returns some triangulation of the points, without regard to circles: the points are added in
/// lexicographic order, and each is joined to the edges of the hull that it sees.
fn any_triangulation(vertices: &PredicateContext2<'_>) -> Triangulation2 {
    // Sorted by coordinates, every point lies outside the hull of the points before it.
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    order.sort_by(|&v, &w| vertices.point(v).partial_cmp(&vertices.point(w)).unwrap());
    let infinite = vertices.len() as u32;
    let off_line = (2..order.len()).find(|&k| vertices.orient2d(order[0], order[1], order[k]) != 0).unwrap();
    let apex = order[off_line];
    let left = vertices.orient2d(order[0], order[1], apex) > 0;
    let mut triangles = Vec::new();
    // Counter-clockwise.
    let mut hull: Vec<u32> = order[..off_line].to_vec();
    for pair in order[..off_line].windows(2) {
        triangles.push(if left { [pair[0], pair[1], apex] } else { [pair[1], pair[0], apex] });
    }
    if !left {
        hull.reverse();
    }
    hull.push(apex);
    for &p in &order[off_line + 1..] {
        let n = hull.len();
        let sees = |i: usize| vertices.orient2d(hull[i % n], hull[(i + 1) % n], p) < 0;
        let first = (0..n).find(|&i| sees(i) && !sees(i + n - 1)).unwrap();
        let count = (0..n).take_while(|&k| sees(first + k)).count();
        for k in 0..count {
            triangles.push([hull[(first + k + 1) % n], hull[(first + k) % n], p]);
        }
        hull.rotate_left(first);
        hull.splice(1..count, [p]);
    }
    for i in 0..hull.len() {
        triangles.push([infinite, hull[(i + 1) % hull.len()], hull[i]]);
    }
    with_neighbors(triangles, infinite)
}

fn with_neighbors(triangles: Vec<[u32; 3]>, infinite: u32) -> Triangulation2 {
    let ends = |t: [u32; 3], k: usize| [t[(k + 1) % 3], t[(k + 2) % 3]];
    let across = |[from, to]: [u32; 2]| {
        let edges = (0..triangles.len()).flat_map(|t| (0..3).map(move |k| (t, k)));
        let (t, k) = edges.into_iter().find(|&(t, k)| ends(triangles[t], k) == [to, from]).unwrap();
        (4 * t + k) as u32
    };
    let neighbors = triangles.iter().map(|&t| [0, 1, 2].map(|k| across(ends(t, k)))).collect();
    Triangulation2::new(triangles, neighbors, infinite)
}

/// Checks that flips make any triangulation the expected one.
fn check_flips(points: &[[f64; 2]], expected: &Definition2) -> Result<(), TestCaseError> {
    if expected.dimension < 2 {
        return Ok(());
    }
    let lattice = Lattice::fit(points.into());
    let distinct = (0..points.len() as u32).filter(|&i| expected.duplicate_of[i as usize] == NONE);
    let vertices = PredicateContext2::new(points.into(), &lattice, distinct.collect());
    let triangulation = any_triangulation(&vertices);
    let uncertain: Vec<u32> = (0..triangulation.triangles().len() as u32).collect();
    let near = NearDelaunay2 { triangulation, uncertain, missing: Vec::new() };
    match lawson(&vertices, near, 10_000, &|_| Ok(()))? {
        LawsonOutcome::Delaunay(triangulation, _) => {
            let names: Vec<u32> = (0..vertices.len() as u32).map(|v| vertices.input_index(v)).collect();
            let (triangles, ..) = triangulation.into_mesh(&names, Winding::default(), Threads::One);
            prop_assert_eq!(mesh::canonical(&triangles), expected.triangles.clone());
            Ok(())
        }
        LawsonOutcome::Aborted(why) => Err(TestCaseError::fail(format!("flips aborted: {why:?}"))),
    }
}

/// A mesh becomes the triangulation with ghosts that it came from, and vice versa.
#[test]
fn from_mesh_and_back() {
    let line_and_point = vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 1.0]];
    let grid = (0..30).map(|i| [i % 6, i / 6].map(f64::from)).collect();
    let windings = [Winding::CounterClockwise, Winding::Clockwise];
    let inputs = [line_and_point, grid, vec![[0.0, 0.0], [2.0, 1.0], [1.0, 3.0]]];
    for (points, winding) in inputs.iter().flat_map(|points| windings.map(|winding| (points, winding))) {
        let options = Options { winding, ..Options::default() };
        let mesh = delaunay_in_order::<2>(points.into(), &options, Order::default()).unwrap();
        let n = points.len() as u32;
        let (triangles, halfedges) = (mesh.triangles.clone(), mesh.halfedges.clone());
        let triangulation = Triangulation2::from_mesh(triangles, halfedges, &mesh.hull, n, winding);
        let triangles = triangulation.triangles();
        assert_eq!(triangles.len(), 2 * points.len() - 2);
        for (t, near) in triangulation.neighbors().iter().enumerate() {
            for (k, &across) in near.iter().enumerate() {
                let (u, l) = (across as usize / 4, across as usize % 4);
                assert_eq!(triangulation.neighbors()[u][l] as usize, 4 * t + k);
                let ends = |t: usize, k: usize| [triangles[t][(k + 1) % 3], triangles[t][(k + 2) % 3]];
                let [from, to] = ends(t, k);
                assert_eq!(ends(u, l), [to, from]);
            }
        }
        let names: Vec<u32> = (0..n).collect();
        assert_eq!(triangulation.into_mesh(&names, winding, Threads::One), (mesh.triangles, mesh.halfedges, mesh.hull));
    }
}

/// Starts from the triangulation of coarsely rounded points, whose triangles may be flat or
/// inverted in the exact coordinates, and which lacks points that share a place. Checks that flips
/// lead to the correct triangulation, or abort. Returns whether they led to it.
fn check_flips_after_rounding(points: &[[f64; 2]]) -> Result<bool, TestCaseError> {
    let expected = delaunay_in_order::<2>(points.into(), &Options::default(), Order::default())?;
    let rounded: Vec<_> = points.iter().map(|p| p.map(f64::round)).collect();
    let coarse = delaunay_in_order::<2>((&rounded).into(), &Options::default(), Order::default())?;
    if coarse.dimension < 2 {
        return Ok(false);
    }
    let infinite = points.len() as u32;
    let mut triangles = coarse.triangles.clone();
    let next_on_hull = coarse.hull.iter().cycle().skip(1);
    triangles.extend(coarse.hull.iter().zip(next_on_hull).map(|(&a, &b)| [infinite, b, a]));
    let missing = (0..infinite).filter_map(|i| {
        let shares = coarse.duplicate_of[i as usize];
        let at = triangles.iter().position(|t| t.contains(&(shares as u32)));
        (shares != NONE && expected.duplicate_of[i as usize] == NONE).then(|| (i, at.unwrap() as u32))
    });
    let missing = missing.collect();
    let uncertain = (0..triangles.len() as u32).collect();
    let near = NearDelaunay2 { triangulation: with_neighbors(triangles, infinite), uncertain, missing };
    let vertices = PredicateContext2::new(points.into(), &Lattice::fit(points.into()), (0..infinite).collect());
    let LawsonOutcome::Delaunay(triangulation, _) = lawson(&vertices, near, 1_000, &|_| Ok(()))? else {
        return Ok(false);
    };
    let names: Vec<u32> = (0..infinite).collect();
    let (triangles, ..) = triangulation.into_mesh(&names, Winding::default(), Threads::One);
    prop_assert_eq!(mesh::canonical(&triangles), expected.canonical());
    Ok(true)
}

/// Random points of the integer grid with `side` points along each axis, duplicates included.
fn grid(side: u8) -> impl Strategy<Value = [f64; 2]> {
    [0..side, 0..side].prop_map(|p| p.map(f64::from))
}

/// All integer points at a given squared distance from the origin.
fn circle(squared_radius: i32) -> impl Strategy<Value = [f64; 2]> {
    let all = (-65..=65).flat_map(|x| (-65..=65).map(move |y| [x, y]));
    let on: Vec<_> = all.filter(|p: &[i32; 2]| p.iter().map(|x| x * x).sum::<i32>() == squared_radius).collect();
    prop::sample::select(on).prop_map(|p| p.map(f64::from))
}

/// Small integers at scales that are far apart: no lattice represents them all.
fn mixed_scales() -> impl Strategy<Value = [f64; 2]> {
    let scale = prop::sample::select(vec![f64::from_bits(1), 1e-300, f64::MIN_POSITIVE, 1.0, 3e7, 1e300]);
    (prop::array::uniform2(-3i8..=3), scale).prop_map(|(p, scale)| p.map(|x| f64::from(x) * scale))
}

/// Any finite numbers.
fn any_finite() -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(any::<f64>().prop_filter("finite", |x| x.is_finite()))
}

/// Points of a small grid, some of which are off by one rounding step.
fn nearly_grid() -> impl Strategy<Value = [f64; 2]> {
    let coordinate =
        (1..4u8, -1..=1i64).prop_map(|(x, steps)| f64::from_bits(f64::from(x).to_bits().wrapping_add_signed(steps)));
    [coordinate.clone(), coordinate]
}

/// Points on the line through two small integer points, and up to two points that may be off it.
fn line() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let ends = [prop::array::uniform2(-4..=4i8), prop::array::uniform2(-4..=4i8)];
    let on = prop::collection::vec(-9..=9i8, 0..16);
    (ends, on, prop::collection::vec(grid(4), 0..=2)).prop_map(|([origin, step], multiples, off)| {
        let at = |t: i8| std::array::from_fn(|i| f64::from(origin[i]) + f64::from(t) * f64::from(step[i]));
        multiples.into_iter().map(at).chain(off).collect()
    })
}

/// At most `max` points.
fn some(point: impl Strategy<Value = [f64; 2]>, max: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
    prop::collection::vec(point, 0..=max)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn points_of_a_grid_of_side_3(points in some(grid(3), 12)) { check(&points)? }

    #[test]
    fn points_of_a_grid_of_side_6(points in some(grid(6), 24)) { check(&points)? }

    #[test]
    fn points_of_a_circle(points in prop::sample::select(vec![25, 65, 325, 4225]).prop_flat_map(|r| some(circle(r), 20))) {
        check(&points)?;
    }

    #[test]
    fn points_of_a_line(points in line()) { check(&points)? }

    #[test]
    fn points_of_mixed_scales(points in some(mixed_scales(), 14)) { check(&points)? }

    #[test]
    fn points_of_any_finite_numbers(points in some(any_finite(), 14)) { check(&points)? }

    #[test]
    fn points_one_rounding_step_off_a_grid(points in some(nearly_grid(), 16)) { check(&points)? }

    #[test]
    fn points_of_a_grid_and_of_another_scale(points in some(prop_oneof![grid(3), mixed_scales()], 14)) {
        check(&points)?;
    }
}

/// Flips undo a rounding that moves points by a small part of their distances, as on the lattice;
/// and where it moves them by as much as their distances, a wrong mesh never results.
#[test]
fn flips_after_rounding() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut below = |n: u64| (random.next_u64() % n) as f64;
    for (steps, least) in [(1.0 / 1024.0, 300), (1.0 / 8.0, 200), (0.5, 50)] {
        let mut solved = 0;
        for _ in 0..300 {
            let n = 4 + below(20) as usize;
            // An eighth of the points share the places of others.
            let points: Vec<[f64; 2]> =
                (0..n).map(|_| [0; 2].map(|_| below(6) * 2.0 + (below(7) - 3.0) / 7.0 * steps)).collect();
            solved += u32::from(check_flips_after_rounding(&points).unwrap());
        }
        assert!(solved >= least, "{solved} of 300 at {steps}");
    }
}

/// Flat triangles on the hull of a grid, which flips by perturbed coordinates leave there, are
/// removed.
#[test]
fn flat_triangles_on_the_hull() {
    let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [1.0, 1.0]];
    // 0 3 1 and 1 3 2 are flat, the second behind the first.
    let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [0, 3, 1], [1, 3, 2], [5, 3, 0], [5, 4, 3], [5, 0, 4]];
    let vertices = PredicateContext2::new((&points).into(), &Lattice::fit((&points).into()), (0..5).collect());
    let near = NearDelaunay2 { triangulation: with_neighbors(triangles, 5), uncertain: vec![3, 4], missing: vec![] };
    let LawsonOutcome::Delaunay(triangulation, flips) = lawson(&vertices, near, 100, &|_| Ok(())).unwrap() else {
        panic!("aborted");
    };
    let (triangles, _, hull) = triangulation.into_mesh(&[0, 1, 2, 3, 4], Winding::default(), Threads::One);
    assert_eq!(mesh::canonical(&triangles), definition2(&points).triangles);
    assert_eq!((hull, flips), (vec![0, 1, 2, 3, 4], 2));
}

#[test]
fn flips_stop_at_their_bound() {
    let points: Vec<[f64; 2]> = (0..40).map(|i| [f64::from(i), f64::from(i * i % 17)]).collect();
    let vertices = PredicateContext2::new((&points).into(), &Lattice::fit((&points).into()), (0..40).collect());
    let triangulation = any_triangulation(&vertices);
    let uncertain: Vec<u32> = (0..triangulation.triangles().len() as u32).collect();
    let near = NearDelaunay2 { triangulation, uncertain, missing: vec![] };
    let outcome = lawson(&vertices, near, 3, &|_| Ok(())).unwrap();
    assert!(matches!(outcome, LawsonOutcome::Aborted(Aborted::BudgetExceeded)), "{outcome:?}");
}

#[test]
fn whole_grids_in_any_order_of_the_indices() {
    let grid: Vec<_> = (0..36).map(|i| [i % 6, i / 6].map(f64::from)).collect();
    for step in [1, 5, 7, 11, 13] {
        let permuted: Vec<_> = (0..grid.len()).map(|i| grid[i * step % grid.len()]).collect();
        check(&permuted).unwrap();
    }
}
