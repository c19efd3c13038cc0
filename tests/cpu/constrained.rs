//! The constrained Delaunay triangulation is the one that the definition names, whatever the order of the constraints.

use crate::degenerate::{cases, points as any_points};
use gdel::{
    Backend, Constrained2, Constraints, Error, Fill, Mesh2, MeshView2, NONE, Triangulator,
    verify::{Check, Outcome},
    verify2d,
};
use rand::{RngExt, seq::SliceRandom};
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};
use std::{collections::BTreeSet, num::NonZeroUsize};

type Segment = [u32; 2];

fn triangulator() -> Triangulator {
    Triangulator::new().backend(Backend::Cpu).threads(NonZeroUsize::MIN)
}

fn constrained(points: &[[f64; 2]], constraints: &Constraints) -> Result<Constrained2, Error> {
    triangulator().constrained2d(points, constraints)
}

fn of_edges(points: &[[f64; 2]], segments: &[Segment]) -> Result<Mesh2, Error> {
    constrained(points, &Constraints::new().edges(segments)).map(|found| found.mesh)
}

/// The points and segments in integers, by brute force.
struct Exact {
    points: Vec<[i128; 2]>,
    /// The points that stand for all.
    distinct: Vec<u32>,
    /// The segments, cut at all points on them, the lower vertex first.
    pieces: BTreeSet<Segment>,
}

fn minus(a: [i128; 2], b: [i128; 2]) -> [i128; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: [i128; 2], b: [i128; 2]) -> i128 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: [i128; 2], b: [i128; 2]) -> i128 {
    a[0] * b[0] + a[1] * b[1]
}

impl Exact {
    fn new(points: &[[f64; 2]], segments: &[Segment]) -> Self {
        let points: Vec<[i128; 2]> = points.iter().map(|p| p.map(|x| x as i128)).collect();
        let first = |v: u32| points.iter().position(|p| *p == points[v as usize]).unwrap() as u32;
        let distinct: Vec<u32> = (0..points.len() as u32).filter(|&v| first(v) == v).collect();
        let mut exact = Exact { points, distinct, pieces: BTreeSet::new() };
        for [a, b] in segments {
            let mut on: Vec<u32> = exact.distinct.iter().copied().filter(|&v| exact.is_on(v, [*a, *b])).collect();
            on.sort_by_key(|&v| exact.at(v));
            exact.pieces.extend(on.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]));
        }
        exact
    }

    fn at(&self, v: u32) -> [i128; 2] {
        self.points[v as usize]
    }

    fn orient(&self, a: u32, b: u32, c: u32) -> i128 {
        cross(minus(self.at(b), self.at(a)), minus(self.at(c), self.at(a))).signum()
    }

    /// Whether a point is on a segment, the ends included.
    fn is_on(&self, v: u32, [a, b]: Segment) -> bool {
        let [v_a, v_b] = [a, b].map(|end| minus(self.at(v), self.at(end)));
        cross(v_a, v_b) == 0 && dot(v_a, v_b) <= 0
    }

    /// Whether segments cross inside both, where there is no point.
    fn cross(&self, [a, b]: Segment, [c, d]: Segment) -> bool {
        let apart = |a, b, c, d| self.orient(a, b, c) * self.orient(a, b, d) < 0;
        let at_a_point = |&v: &u32| self.is_on(v, [a, b]) && self.is_on(v, [c, d]);
        apart(a, b, c, d) && apart(c, d, a, b) && !self.distinct.iter().any(at_a_point)
    }

    /// Whether the last point is inside the circle through the others, which are counter-clockwise; ties are broken by
    /// the definition: the heights of the points are raised, those of lower indices much more.
    fn is_inside(&self, four: [u32; 4]) -> bool {
        let row = |v: u32| {
            let p = self.at(v);
            [p[0], p[1], dot(p, p), 1]
        };
        let minor = |rows: [[i128; 4]; 3], columns: [usize; 3]| {
            let [a, b, c] = rows.map(|row| columns.map(|k| row[k]));
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        let others = |k: usize| {
            let rest: Vec<_> = (0..4).filter(|&i| i != k).map(|i| row(four[i])).collect();
            [rest[0], rest[1], rest[2]]
        };
        // By the column of heights.
        let cofactor = |k: usize| minor(others(k), [0, 1, 3]) * if k.is_multiple_of(2) { 1 } else { -1 };
        let value: i128 = (0..4).map(|k| row(four[k])[2] * cofactor(k)).sum();
        let mut order = [0, 1, 2, 3];
        order.sort_by_key(|&k| four[k]);
        let raised = || order.into_iter().map(cofactor).find(|&c| c != 0).unwrap_or(0);
        if value == 0 { raised() > 0 } else { value > 0 }
    }

    /// Returns the triangles without a point in them, not cut by a constraint, whose circumcircles contain no point
    /// that is visible from inside.
    fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        for (i, &a) in self.distinct.iter().enumerate() {
            for (j, &b) in self.distinct.iter().enumerate().skip(i + 1) {
                for &c in &self.distinct[j + 1..] {
                    let turned = match self.orient(a, b, c) {
                        0 => continue,
                        1 => [a, b, c],
                        _ => [a, c, b],
                    };
                    if self.is_free(turned) && self.is_delaunay(turned) {
                        triangles.push([a, b, c]);
                    }
                }
            }
        }
        triangles
    }

    fn is_free(&self, [a, b, c]: [u32; 3]) -> bool {
        let is_in = |v: u32| [[a, b], [b, c], [c, a]].iter().all(|&[from, to]| self.orient(from, to, v) >= 0);
        let has_no_other = self.distinct.iter().all(|&v| v == a || v == b || v == c || !is_in(v));
        // Without a point in it, a triangle is entered through two edges, or through one and a vertex.
        let cuts = |piece: Segment| [[a, b], [b, c], [c, a]].iter().any(|&edge| self.cross(piece, edge));
        has_no_other && !self.pieces.iter().any(|&piece| cuts(piece))
    }

    fn is_delaunay(&self, [a, b, c]: [u32; 3]) -> bool {
        let others = self.distinct.iter().filter(|&&v| v != a && v != b && v != c);
        others.into_iter().all(|&v| !self.is_inside([a, b, c, v]) || !self.sees(v, [a, b, c]))
    }

    /// Whether a point sees some point inside a triangle: tries a direction between any two that lead to points.
    fn sees(&self, from: u32, triangle: [u32; 3]) -> bool {
        let towards = |v: &u32| minus(self.at(*v), self.at(from));
        let mut directions: Vec<[i128; 2]> = self.distinct.iter().filter(|&&v| v != from).map(towards).collect();
        let is_upper = |d: &[i128; 2]| d[1] > 0 || (d[1] == 0 && d[0] > 0);
        directions.sort_by(|d, e| is_upper(e).cmp(&is_upper(d)).then(cross(*e, *d).cmp(&0)));
        let count = directions.len();
        (0..count).any(|i| {
            let (d, e) = (directions[i], directions[(i + 1) % count]);
            let between = [d[0] + e[0], d[1] + e[1]];
            cross(d, e) > 0 && self.hits_first(from, between, triangle)
        })
    }

    /// Whether a ray through no other point enters a triangle before it meets a constraint.
    fn hits_first(&self, from: u32, ray: [i128; 2], [a, b, c]: [u32; 3]) -> bool {
        // How far a segment is, as a fraction.
        let distance = |[p, q]: Segment| {
            let [p, q] = [p, q].map(|v| minus(self.at(v), self.at(from)));
            if cross(ray, p).signum() * cross(ray, q).signum() >= 0 {
                return None;
            }
            let (mut over, mut under) = (cross(p, minus(q, p)), cross(ray, minus(q, p)));
            if under < 0 {
                (over, under) = (-over, -under);
            }
            (over > 0).then_some((over, under))
        };
        let is_nearer = |p: (i128, i128), q: (i128, i128)| p.0 * q.1 < q.0 * p.1;
        let edges = [[a, b], [b, c], [c, a]];
        let entry = edges.into_iter().filter_map(distance).reduce(|p, q| if is_nearer(q, p) { q } else { p });
        let Some(entry) = entry else { return false };
        // A constraint along the edge that is entered is in the way, too.
        !self.pieces.iter().filter_map(|&piece| distance(piece)).any(|met| !is_nearer(entry, met))
    }
}

/// Checks that a mesh is right by the verifier, and that it does not depend on the order of the segments.
fn check(points: &[[f64; 2]], segments: &[Segment], random: &mut Pcg64Mcg) -> Mesh2 {
    let found = constrained(points, &Constraints::new().edges(segments)).unwrap();
    let context = || format!("{points:?}, {segments:?}");
    let mut view = MeshView2::from(&found.mesh);
    view.segments = Some(segments);
    let report = verify2d(points, view).unwrap();
    assert!(report.passed(), "{report}\n{}", context());
    assert_eq!(report.outcome(Check::Constraints), Some(&Outcome::Passed), "{}", context());
    let mut others = segments.to_vec();
    others.shuffle(random);
    others.iter_mut().filter(|_| random.random()).for_each(|segment| segment.reverse());
    let other = of_edges(points, &others).unwrap();
    assert_eq!(other.canonical(), found.mesh.canonical(), "{}, {others:?}", context());
    assert_eq!(other.constraints, found.mesh.constraints, "{}, {others:?}", context());
    found.mesh
}

/// Checks that a mesh is what the definition says. Needs points that are small integers.
fn check_definition(points: &[[f64; 2]], segments: &[Segment], random: &mut Pcg64Mcg) {
    let exact = Exact::new(points, segments);
    let mesh = check(points, segments, random);
    assert_eq!(mesh.canonical(), exact.triangles(), "{points:?}, {segments:?}");
    assert_eq!(mesh.constraints, exact.pieces.into_iter().collect::<Vec<_>>(), "{points:?}, {segments:?}");
}

/// Creates points with small integer coordinates, in a random order: grids, collinear points, some twice.
fn small_points(random: &mut Pcg64Mcg) -> Vec<[f64; 2]> {
    let grid = |side: u32| (0..side * side).map(move |i| [i % side, i / side].map(f64::from));
    let mut points: Vec<[f64; 2]> = match random.random_range(0..6) {
        0 => grid(3).collect(),
        1 => grid(4).collect(),
        2 => (0..random.random_range(0..8)).map(|i| [f64::from(i), f64::from(2 * i)]).collect(),
        3 => grid(4).filter(|_| random.random()).collect(),
        // On a circle, and some inside.
        4 => [[5, 0], [4, 3], [3, 4], [0, 5], [-3, 4], [-4, 3], [-5, 0], [-4, -3], [0, -5], [3, -4], [0, 0], [1, 0]]
            .map(|p| p.map(f64::from))
            .into_iter()
            .filter(|_| random.random_range(0..4) > 0)
            .collect(),
        _ => (0..random.random_range(0..14)).map(|_| [0, 1].map(|_| f64::from(random.random_range(0..6)))).collect(),
    };
    for _ in 0..random.random_range(0..3) {
        if let Some(&again) = points.get(random.random_range(0..16)) {
            points.push(again);
        }
    }
    points.shuffle(random);
    points
}

/// Creates random segments, with those that cross ones before them in a second list.
fn segments(random: &mut Pcg64Mcg, points: &[[f64; 2]], count: usize) -> [Vec<Segment>; 2] {
    let exact = Exact::new(points, &[]);
    let mut lists = [Vec::new(), Vec::new()];
    if points.is_empty() {
        return lists;
    }
    for _ in 0..count {
        let segment = [0, 1].map(|_| random.random_range(0..points.len() as u32));
        let crosses = lists[0].iter().any(|&before| exact.cross(segment, before));
        lists[usize::from(crosses)].push(segment);
    }
    lists
}

/// Whole numbers instead of the grid's, so that few points are cocircular.
fn bent(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    points.iter().map(|&[x, y]| [64.0 * x + y * y, 64.0 * y + 3.0 * x * x]).collect()
}

#[test]
fn small_degenerate_inputs_are_what_the_definition_says() {
    for seed in cases(2000) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let mut points = small_points(random);
        if random.random_range(0..4) == 0 {
            points = bent(&points);
        }
        let count = random.random_range(0..12);
        let [segments, _] = segments(random, &points, count);
        check_definition(&points, &segments, random);
    }
}

#[test]
fn small_degenerate_inputs_pass_the_verifier() {
    for seed in cases(4000) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let points = small_points(random);
        let count = random.random_range(0..20);
        let [free, crossing] = segments(random, &points, count);
        let mesh = check(&points, &free, random);
        if mesh.constraints.is_empty() {
            let plain = triangulator().delaunay2d(&points).unwrap();
            assert_eq!((&mesh.triangles, &mesh.halfedges), (&plain.triangles, &plain.halfedges));
        }
        assert_eq!(mesh.hull, triangulator().delaunay2d(&points).unwrap().hull);
        if let Some(&last) = crossing.last() {
            let all = [free.as_slice(), &[last]].concat();
            let exact = Exact::new(&points, &[]);
            let expected: Vec<[Segment; 2]> =
                free.iter().filter(|&&segment| exact.cross(segment, last)).map(|&segment| [segment, last]).collect();
            let error = of_edges(&points, &all).map(|_| ()).unwrap_err();
            let pairs = expected.iter().take(16).copied().collect();
            assert_eq!(error, Error::CrossingConstraints { count: expected.len(), pairs }, "{points:?}, {all:?}");
        }
    }
}

/// Coordinates of all sizes, and nearly collinear ones: segments that cross are an error, all others become edges.
#[test]
fn degenerate_clouds_of_all_sizes() {
    let mut proven = 0;
    for seed in cases(1500) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let points = any_points::<2>(random, 24);
        if points.is_empty() {
            continue;
        }
        let mut kept: Vec<Segment> = Vec::new();
        for _ in 0..random.random_range(0..12) {
            let segment = [0, 1].map(|_| random.random_range(0..points.len() as u32));
            kept.push(segment);
            match of_edges(&points, &kept) {
                Err(Error::CrossingConstraints { .. }) => drop(kept.pop()),
                found => drop(found.unwrap()),
            }
        }
        proven += usize::from(!check(&points, &kept, random).constraints.is_empty());
    }
    assert!(proven > 500 || cases(1).end != 1, "{proven}");
}

/// Returns the winding number of closed boundaries around a point that is on none, by the crossings to the right of it,
/// and how many these are.
fn winding(points: &[[f64; 2]], boundary: &[Segment], at: [f64; 2]) -> (i32, u32) {
    let (mut winding, mut crossings) = (0, 0);
    for &[from, to] in boundary {
        let [p, q] = [from, to].map(|v| points[v as usize]);
        let side = (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]);
        if p[1] <= at[1] && q[1] > at[1] && side > 0.0 {
            (winding, crossings) = (winding + 1, crossings + 1);
        } else if p[1] > at[1] && q[1] <= at[1] && side < 0.0 {
            (winding, crossings) = (winding - 1, crossings + 1);
        }
    }
    (winding, crossings)
}

#[test]
fn fill_rules_agree_with_winding_numbers() {
    let mut counts = [0; 3];
    for seed in cases(1500) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        // Multiples of 6: the centroids of triangles are whole.
        let points: Vec<[f64; 2]> = small_points(random).into_iter().map(|p| p.map(|x| 6.0 * x)).collect();
        if points.is_empty() {
            continue;
        }
        let exact = Exact::new(&points, &[]);
        let mut boundary: Vec<Segment> = Vec::new();
        let mut constraints = Constraints::new();
        for _ in 0..random.random_range(0..5) {
            let ring: Vec<u32> =
                (0..random.random_range(1..6)).map(|_| random.random_range(0..points.len() as u32)).collect();
            let edges: Vec<Segment> = (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]).collect();
            let all = [boundary.as_slice(), &edges].concat();
            if !edges.iter().any(|&edge| all.iter().any(|&other| exact.cross(edge, other))) {
                boundary = all;
                constraints = constraints.ring(&ring);
            }
        }
        // Edges that are no boundaries change nothing.
        let edge = [0, 1].map(|_| random.random_range(0..points.len() as u32));
        if !boundary.iter().any(|&other| exact.cross(edge, other)) {
            constraints = constraints.edges(&[edge]);
        }
        for fill in [Fill::All, Fill::EvenOdd, Fill::NonZero] {
            let found = constrained(&points, &constraints.clone().fill(fill)).unwrap();
            assert_eq!(found.inside.len(), found.mesh.triangles.len());
            for (triangle, &inside) in found.mesh.triangles.iter().zip(&found.inside) {
                let corners = triangle.map(|v| points[v as usize]);
                let centroid = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).sum::<f64>() / 3.0);
                let (winding, crossings) = winding(&points, &boundary, centroid);
                let expected = match fill {
                    Fill::EvenOdd => crossings % 2 == 1,
                    Fill::NonZero => winding != 0,
                    _ => true,
                };
                assert_eq!(inside, expected, "{fill:?} at {centroid:?}: {points:?}, {constraints:?}");
                counts[usize::from(inside) + usize::from(inside && winding > 1)] += 1;
            }
            check_regions(&found);
        }
    }
    assert!(cases(1).end != 1 || counts.iter().all(|&count| count > 20), "{counts:?}");
}

/// Neighbours are in the same region exactly if no constraint is between them or there is another way.
fn check_regions(found: &Constrained2) {
    let regions = found.triangle_regions();
    let mesh = &found.mesh;
    let mut highest = 0;
    for (t, &region) in regions.iter().enumerate() {
        assert!(region <= highest);
        highest = highest.max(region + 1);
        for k in 0..3 {
            if let Some(u) = mesh.neighbor(t, k) {
                assert!(mesh.is_constrained(mesh.edge(t, k)) || regions[u] == region);
                // All of a region is on one side of the boundaries.
                assert!(regions[u] != region || found.inside[u] == found.inside[t]);
            }
        }
    }
}

#[test]
fn larger_inputs_pass_the_verifier() {
    let random = &mut Pcg64Mcg::seed_from_u64(3);
    for (count, wanted, reach) in [(300, 40, 2.0), (3000, 60, 2.0), (3000, 1000, 0.05), (3000, 200, 0.3)] {
        let points: Vec<[f64; 2]> = (0..count).map(|_| [0, 1].map(|_| random.random())).collect();
        let mut kept: Vec<Segment> = Vec::new();
        let apart =
            |a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]| gdel::orient2d(a, b, c) * gdel::orient2d(a, b, d) < 0;
        let mut tries = 0;
        while kept.len() < wanted && tries < 30_000 {
            tries += 1;
            let segment = [0, 1].map(|_| random.random_range(0..count));
            let [a, b] = segment.map(|v| points[v as usize]);
            let crosses = |other: &Segment| {
                let [c, d] = other.map(|v| points[v as usize]);
                apart(a, b, c, d) && apart(c, d, a, b)
            };
            if (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < reach && !kept.iter().any(crosses) {
                kept.push(segment);
            }
        }
        assert!(kept.len() > wanted / 5, "{}", kept.len());
        check(&points, &kept, random);
    }
}

/// Every segment of a star, and its rim: the centre has many triangles.
#[test]
fn a_star_of_constraints() {
    let random = &mut Pcg64Mcg::seed_from_u64(5);
    let count = 2000;
    let mut points = vec![[0.0, 0.0]];
    points.extend((0..count).map(|i| {
        let angle = f64::from(i) * std::f64::consts::TAU / f64::from(count);
        [angle.cos(), angle.sin()].map(|x| x * (1.0 + f64::from(i % 7)))
    }));
    let spokes: Vec<Segment> = (1..=count as u32).map(|i| [i, 0]).collect();
    let mesh = check(&points, &spokes, random);
    assert_eq!(mesh.constraints.len(), spokes.len());
    let rim = (1..=count as u32).map(|i| [i, i % count as u32 + 1]);
    let mesh = check(&points, &spokes.iter().copied().chain(rim).collect::<Vec<_>>(), random);
    assert_eq!(mesh.vertex_neighbors().of(0).len(), count as usize);
}

/// One segment that crosses thousands of edges, with vertices on either side and exactly on it.
#[test]
fn a_segment_through_everything() {
    let random = &mut Pcg64Mcg::seed_from_u64(6);
    let mut points: Vec<[f64; 2]> = (0..20_000).map(|_| [random.random::<f64>() * 1000.0, random.random()]).collect();
    points.extend([[-1.0, 0.5], [1001.0, 0.5]]);
    let mesh = check(&points, &[[20_000, 20_001]], random);
    assert_eq!(mesh.constraints.len(), 1);
    points.extend((0..50).map(|i| [f64::from(20 * i), 0.5]));
    assert_eq!(check(&points, &[[20_000, 20_001]], random).constraints.len(), 51);
}

/// The zigzag of a comb makes cavities that touch themselves.
#[test]
fn cavities_that_touch_themselves() {
    let random = &mut Pcg64Mcg::seed_from_u64(9);
    let mut points = vec![[-1.0, 0.0], [101.0, 0.0]];
    let mut segments = Vec::new();
    // Spikes that nearly reach the segment from both sides, each with an edge on its back.
    for i in 0..50u32 {
        let x = f64::from(2 * i);
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let first = points.len() as u32;
        points.extend([[x, side * 1e-3], [x + 0.5, side * 40.0], [x + 0.25, side * 20.0]]);
        segments.push([first, first + 1]);
    }
    check(&points, &segments, random);
    segments.push([0, 1]);
    assert_eq!(check(&points, &segments, random).constraints.len(), 51);
}

/// A hole whose corner touches the outer ring, and holes that touch at a corner: Constrainautor's issue 11, earcut's
/// "touching holes".
#[test]
fn rings_that_touch() {
    let mut points = vec![[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
    points.extend([[4.0, 0.0], [6.0, 2.0], [4.0, 4.0], [2.0, 2.0]]);
    points.extend([[4.0, 4.0], [6.0, 6.0], [4.0, 8.0], [2.0, 6.0f64]]);
    let constraints =
        Constraints::new().ring(&[0, 1, 2, 3]).ring(&[4, 5, 6, 7]).ring(&[8, 9, 10, 11]).fill(Fill::EvenOdd);
    let found = constrained(&points, &constraints).unwrap();
    assert!(verify2d(&points, &found.mesh).unwrap().passed());
    let inside = found.mesh.areas(&points).zip(&found.inside).filter(|&(_, &inside)| inside);
    assert_eq!(inside.map(|(area, _)| area).sum::<f64>(), 64.0 - 8.0 - 8.0);
    // The outer ring has points of the holes on it.
    assert!(found.mesh.is_constrained([0, 4]) && found.mesh.is_constrained([10, 2]));
    // The two ends of point 6 and 8 are one.
    assert!(found.mesh.is_constrained([9, 8]) && found.mesh.constraints.contains(&[6, 9]));
}

/// Nearly collinear points: poly2tri's assertions, Constrainautor's endless loop (issue 15), cdt2d's lost edges.
#[test]
fn nearly_collinear_points() {
    let random = &mut Pcg64Mcg::seed_from_u64(12);
    for seed in 0..40 {
        let random_sign = |random: &mut Pcg64Mcg| f64::from(random.random_range(-1..2)) * f64::EPSILON;
        let tilt = 0.1 * f64::from(seed);
        let mut points: Vec<[f64; 2]> =
            (0..60).map(|i| [0.1 * f64::from(i), 0.1 * f64::from(i) * tilt + random_sign(random)]).collect();
        points.extend([[3.0, 9.0], [3.0, -9.0]]);
        // The whole line may meet points or pass beside them, whatever rounding did.
        check(&points, &[[0, 59], [0, 60], [60, 59], [59, 61], [61, 0]], random);
        let chain: Vec<Segment> = (0..59).map(|i| [i, i + 1]).collect();
        check(&points, &chain, random);
    }
}

#[test]
fn constraints_on_the_hull_and_beyond_vertices() {
    let points: Vec<[f64; 2]> = (0..25).map(|i| [i % 5, i / 5].map(f64::from)).collect();
    let random = &mut Pcg64Mcg::seed_from_u64(1);
    // The sides, both diagonals, which meet at a vertex, and a line along a row, twice.
    let segments = [[0, 4], [4, 24], [24, 20], [20, 0], [0, 24], [4, 20], [10, 14], [13, 11]];
    let mesh = check(&points, &segments, random);
    assert_eq!(mesh.constraints.len(), 16 + 8 + 4);
    assert_eq!(check(&points, &[[0, 4], [24, 4]], random).canonical(), gdel::delaunay2d(&points).unwrap().canonical());
}

#[test]
fn collinear_points_have_edges_without_triangles() {
    let points = [[3.0, 3.0], [0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [1.0, 1.0f64]];
    let found = constrained(&points, &Constraints::new().edges(&[[4, 0], [3, 2], [2, 4]])).unwrap();
    assert_eq!((found.mesh.dimension, found.mesh.triangles.len(), found.zero_length), (1, 0, 1));
    assert_eq!(found.mesh.constraints, [[0, 3], [2, 3]]);
    check(&points, &[[4, 0], [3, 2], [2, 4]], &mut Pcg64Mcg::seed_from_u64(1));
    for points in [&points[..0], &points[..1]] {
        let found = constrained(points, &Constraints::new()).unwrap();
        assert_eq!((found.mesh.constraints.len(), found.inside.len()), (0, 0));
    }
    assert_eq!(constrained(&points[..1], &Constraints::new().ring(&[0, 0])).unwrap().zero_length, 1);
}

#[test]
fn all_backends_give_the_same_mesh() {
    let random = &mut Pcg64Mcg::seed_from_u64(8);
    let points: Vec<[f64; 2]> = (0..400).map(|_| [0, 1].map(|_| f64::from(random.random_range(0..40)))).collect();
    let [free, _] = segments(random, &points, 100);
    let mesh = check(&points, &free, random);
    let narrow: Vec<[f32; 2]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
    let other = Triangulator::new().constrained2d(&narrow, &Constraints::new().edges(&free)).unwrap().mesh;
    assert_eq!((mesh.canonical(), mesh.constraints), (other.canonical(), other.constraints));
}

#[test]
fn wrong_constraints_are_errors() {
    let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [2.0, 1.0], [0.0, 0.0]];
    let error = |constraints: Constraints| constrained(&points, &constraints).map(|_| ()).unwrap_err();
    let edges = |edges: &[Segment]| Constraints::new().edges(edges);
    assert_eq!(error(edges(&[[0, 1], [1, 6]])), Error::BadConstraint { segment: [1, 6], points: 6 });
    assert_eq!(error(edges(&[[NONE, 1]])), Error::BadConstraint { segment: [NONE, 1], points: 6 });
    let crossing = error(edges(&[[0, 2], [1, 3], [3, 4]]));
    assert_eq!(crossing, Error::CrossingConstraints { count: 2, pairs: vec![[[0, 2], [1, 3]], [[0, 2], [3, 4]]] });
    assert_eq!(crossing.to_string(), "constraints cross where there is no point: 0–2 and 1–3, 0–2 and 3–4");
    // A boundary is closed by duplicates, too.
    let open = Constraints::new().boundary(&[[0, 1], [1, 2], [3, 2]]);
    assert_eq!(error(open.clone().fill(Fill::EvenOdd)), Error::OpenBoundary { point: 0 });
    let closed = open.boundary(&[[3, 5]]);
    assert!(constrained(&points, &closed.clone().fill(Fill::EvenOdd)).unwrap().inside.iter().all(|&inside| inside));
    // The directions do not agree.
    assert_eq!(error(closed.fill(Fill::NonZero)), Error::OpenBoundary { point: 2 });
    assert!(matches!(constrained(&[[0.0, f64::NAN]], &Constraints::new()), Err(Error::NotFinite { .. })));
}

#[test]
fn many_crossings_are_counted_and_the_first_listed() {
    let mut points = Vec::new();
    points.extend((0..10).flat_map(|i| [[f64::from(i), -1.0], [f64::from(i), 10.0]]));
    points.extend((0..10).flat_map(|i| [[-1.0, f64::from(i)], [10.0, f64::from(i)]]));
    let segments: Vec<Segment> = (0..20).map(|i| [2 * i, 2 * i + 1]).collect();
    let Err(Error::CrossingConstraints { count, pairs }) = of_edges(&points, &segments) else { panic!() };
    assert_eq!((count, pairs.len(), pairs[0], pairs[10]), (100, 16, [[0, 1], [20, 21]], [[2, 3], [20, 21]]));
}

#[test]
fn a_constrained_mesh_does_not_change() {
    let mut points = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0], [2.0, 0.25]];
    let mut mesh = of_edges(&points, &[[0, 2]]).unwrap();
    let refused = Some(Error::ConstrainedMesh);
    assert_eq!(triangulator().update(&mut mesh, &points).err(), refused);
    assert_eq!(triangulator().remove(&mut mesh, &points, &[4]).err(), refused);
    assert_eq!(triangulator().insert(&mut mesh, &mut points, &[[2.0, 0.5]]).err(), refused);
    assert_eq!(points.len(), 5);
}

#[test]
fn the_verifier_notices() {
    let points: Vec<[f64; 2]> = (0..25).map(|i| [i % 5, i / 5].map(|x| f64::from(x * x))).collect();
    let segments = [[0, 23], [4, 9]];
    let mesh = of_edges(&points, &segments).unwrap();
    let failed = |mesh: &Mesh2, segments: &[Segment]| {
        let mut view = MeshView2::from(mesh);
        view.segments = Some(segments);
        let report = verify2d(&points, view).unwrap();
        report.failures().map(|(check, ..)| check).collect::<Vec<_>>()
    };
    assert_eq!(failed(&mesh, &segments), []);
    // A segment that is missing, one that nobody asked for, and one that is no edge.
    assert_eq!(failed(&mesh, &[[0, 23], [4, 9], [5, 6]]), [Check::Constraints]);
    assert_eq!(failed(&mesh, &[[0, 23]]), [Check::Constraints]);
    assert_eq!(failed(&mesh, &[[0, 23], [4, 9], [9, 99]]), [Check::Constraints]);
    let mut other = mesh.clone();
    other.constraints.push([0, 24]);
    assert_eq!(failed(&other, &[[0, 23], [4, 9], [0, 24]]), [Check::Constraints]);
    let mut other = mesh.clone();
    other.constraints.push(other.constraints[0]);
    assert_eq!(failed(&other, &segments), [Check::Constraints]);
    // An edge that is Delaunay only across the constraint.
    let mut other = mesh;
    other.constraints.clear();
    assert_eq!(failed(&other, &segments), [Check::Delaunay, Check::Constraints]);
}

/// The points are the crossings as near as rounding allows, and everything else is exact.
#[test]
fn crossings_are_split() {
    let (mut rounds, mut left) = (0, 0);
    for seed in cases(1000) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let mut points = if seed % 4 == 0 { any_points::<2>(random, 20) } else { small_points(random) };
        if points.is_empty() {
            continue;
        }
        if seed % 3 == 0 {
            // Crossings are rounded.
            points.iter_mut().for_each(|p| *p = p.map(|x| x * 0.1));
        }
        let wanted: Vec<Segment> = (0..random.random_range(0..12))
            .map(|_| [0, 1].map(|_| random.random_range(0..points.len() as u32)))
            .collect();
        let constraints = Constraints::new().edges(&wanted).split_crossings();
        let context = || format!("{seed}: {points:?}, {wanted:?}");
        let found = match constrained(&points, &constraints) {
            // Segments whose distances are less than what is rounded may cross again and again.
            Err(Error::CrossingConstraints { .. }) if seed % 4 == 0 => {
                left += 1;
                continue;
            }
            found => found.unwrap_or_else(|error| panic!("{error}: {}", context())),
        };
        let all = [points.as_slice(), &found.added].concat();
        let mut view = MeshView2::from(&found.mesh);
        view.segments = Some(&found.segments);
        let report = verify2d(&all, view).unwrap();
        assert!(report.passed(), "{report}\n{}", context());
        rounds += usize::from(found.added.len() > 5);
        // No point is farther from the crossings than the coordinates are rounded.
        let largest = points.as_flattened().iter().fold(0.0f64, |most, x| most.max(x.abs()));
        assert!(found.moved <= largest * f64::EPSILON, "{} of {largest}: {}", found.moved, context());
        if found.added.is_empty() {
            assert_eq!((found.moved, &found.segments), (0.0, &wanted), "{}", context());
        }
    }
    assert!(rounds > 30 || cases(1).end != 1, "{rounds}");
    assert!(left <= 1 + cases(1000).count() / 4000, "{left}");
}

/// The pieces of a segment are its polyline, in order.
#[test]
fn split_segments_are_chains() {
    let random = &mut Pcg64Mcg::seed_from_u64(4);
    let points: Vec<[f64; 2]> = (0..60).map(|_| [0, 1].map(|_| random.random())).collect();
    let wanted: Vec<Segment> = (0..30).map(|i| [2 * i, 2 * i + 1]).collect();
    let ring = Constraints::new().edges(&wanted[..10]).boundary(&wanted[10..]).ring(&[0, 1, 2, 3, 4]);
    let found = constrained(&points, &ring.fill(Fill::All).split_crossings()).unwrap();
    assert!(found.added.len() > 80 && found.moved < 1e-15, "{}, {}", found.added.len(), found.moved);
    let all = [points.as_slice(), &found.added].concat();
    let mut at = 0;
    for &[from, to] in wanted.iter().chain(&[[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]]) {
        let [p, q] = [from, to].map(|v| all[v as usize]);
        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
        let (mut end, mut sum) = (from, 0.0);
        while end != to {
            assert_eq!(found.segments[at][0], end);
            end = found.segments[at][1];
            let [p, q] = found.segments[at].map(|v| all[v as usize]);
            sum += (q[0] - p[0]).hypot(q[1] - p[1]);
            at += 1;
        }
        assert!((sum / length - 1.0).abs() < 1e-12);
    }
    assert_eq!(at, found.segments.len());
}

/// A bow tie has a point in its middle, and two insides.
#[test]
fn fill_rules_of_a_ring_that_crosses_itself() {
    let points = [[0.0, 0.0], [3.0, 3.0], [3.0, 0.0], [0.0, 3.0], [9.0, 9.0]];
    for (fill, inside) in [(Fill::EvenOdd, 2), (Fill::NonZero, 2)] {
        let ring = Constraints::new().ring(&[0, 1, 2, 3]).fill(fill).split_crossings();
        let found = constrained(&points, &ring).unwrap();
        assert_eq!((found.added.as_slice(), found.inside_triangles().count()), (&[[1.5, 1.5]][..], inside));
    }
}

/// A ring of a 3 × 3 grid around its middle point, with a gap in the segments of its lower side on request.
fn ring(is_open: bool) -> (Vec<[f64; 2]>, Vec<Segment>) {
    let points = (0..9).map(|i| [f64::from(i % 3), f64::from(i / 3)]).collect();
    let ring = [[1, 2], [2, 5], [5, 8], [8, 7], [7, 6], [6, 3], [3, 0], [0, 1]];
    (points, ring[usize::from(is_open)..].to_vec())
}

#[test]
fn what_segments_enclose() {
    let inside = |is_open, more: &[Segment], holes: &[[f64; 2]], fill| {
        let (points, segments) = ring(is_open);
        let constraints = Constraints::new().edges(&segments).edges(more).fill(fill);
        let constraints = holes.iter().fold(constraints, |constraints, &hole| constraints.hole(hole));
        constrained(&points, &constraints).unwrap().inside_triangles().count()
    };
    assert_eq!(inside(false, &[], &[], Fill::Enclosed), 8);
    assert_eq!(inside(true, &[], &[], Fill::Enclosed), 0);
    assert_eq!(inside(true, &[[3, 4], [4, 5]], &[], Fill::Enclosed), 4);
    // A place inside, on an edge, on a vertex within a region, on a segment, outside, nowhere.
    let cut = [[3, 4], [4, 5]];
    assert_eq!(inside(false, &cut, &[[0.3, 1.2]], Fill::Enclosed), 4);
    assert_eq!(inside(false, &cut, &[[1.0, 1.5]], Fill::Enclosed), 4);
    assert_eq!(inside(false, &[], &[[1.0, 1.0]], Fill::Enclosed), 0);
    for nothing in [[1.0, 1.0], [0.5, 1.0], [3.0, 1.0], [f64::NAN, 1.0]] {
        assert_eq!(inside(false, &cut, &[nothing], Fill::Enclosed), 8, "{nothing:?}");
    }
    // The same with other rules: what a hole marks is outside.
    assert_eq!(inside(false, &cut, &[[0.3, 1.2]], Fill::All), 4);
    assert_eq!(inside(false, &cut, &[[0.3, 1.2], [0.3, 0.2]], Fill::All), 0);
}
