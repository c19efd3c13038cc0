//! Lists of arguments whose signs are all decided by one and the same stage of the predicates.

use crate::points::POINTS;
use gdel::{
    Points,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        input::lattice::{Lattice, Width},
        predicates::filter::PredicateContext,
    },
};

/// The lists of each kind of arguments.
const LISTS: usize = 1000;

/// What decides a sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The floating-point filter.
    Filter,
    /// Integers of at most 31 bits.
    Narrow,
    /// Integers of at most 62 bits.
    Wide,
    /// Expansions: points that the lattice has to round.
    Expansion,
    /// The symbolic perturbation, after the integers.
    Tie,
}

/// A point set, and lists of `N` of its points.
pub struct Lists<const D: usize, const N: usize> {
    vertices: PredicateContext<'static, D>,
    lists: Vec<[u32; N]>,
}

impl<const D: usize, const N: usize> Lists<D, N>
where
    Points<'static, D>: From<&'static [[f64; D]]>,
{
    /// Creates lists of every `N` of `points`. `sign` is the predicate; most of its signs must be
    /// decided by `stage`.
    fn new(mut points: Vec<[f64; D]>, stage: Stage, sign: impl Fn(&PredicateContext<'_, D>, [u32; N]) -> i8) -> Self {
        points.truncate(N * LISTS);
        let lists: Vec<[u32; N]> = (0..points.len() as u32).collect::<Vec<_>>().as_chunks().0.to_vec();
        assert_eq!(lists.len(), LISTS);
        if stage == Stage::Expansion {
            // In no list: the lattice of a range that is so much larger rounds the other points.
            points.push([-1e6; D]);
        }
        let points: &'static [[f64; D]] = points.leak();
        let lattice = Lattice::fit(points.into());
        let width = match stage {
            Stage::Narrow | Stage::Tie => Width::Narrow,
            Stage::Filter | Stage::Wide | Stage::Expansion => Width::Wide,
        };
        assert_eq!(lattice.width(), width, "{stage:?}");

        let indices: Vec<u32> = (0..points.len() as u32).collect();
        let vertices = || PredicateContext::new(points.into(), &lattice, indices.clone());
        let tried = vertices();
        lists.iter().for_each(|&list| _ = sign(&tried, list));
        let counts = tried.exact_counts();
        let decided = match stage {
            Stage::Filter => LISTS as u64 - counts.integer - counts.expansion,
            Stage::Narrow | Stage::Wide => counts.integer - counts.symbolic,
            Stage::Expansion => counts.expansion,
            Stage::Tie => counts.symbolic,
        };
        assert!(decided * 4 > LISTS as u64 * 3, "{stage:?}: {counts:?}");
        Lists { vertices: vertices(), lists }
    }
}

impl Lists<3, 4> {
    pub fn orient3d(stage: Stage) -> Self {
        let points = generate3d(Distribution3::Uniform, 4 * LISTS, 1).into_iter();
        let points = match stage {
            Stage::Filter => points.collect(),
            Stage::Narrow => points.map(|[x, y, _]| coplanar(integers([x, y], 29))).collect(),
            Stage::Wide => points.map(|[x, y, _]| coplanar(integers([x, y], 51))).collect(),
            // Near the plane 3z = x + y.
            Stage::Expansion => points.map(|[x, y, _]| [x, y, (x + y) / 3.0]).collect(),
            Stage::Tie => unreachable!("orientations are not perturbed"),
        };
        Lists::new(points, stage, |vertices, [a, b, c, d]| vertices.orient3d(a, b, c, d))
    }

    /// Returns the sum of all signs.
    pub fn sum_orient3d(&self) -> i32 {
        self.lists.iter().map(|&[a, b, c, d]| i32::from(self.vertices.orient3d(a, b, c, d))).sum()
    }
}

impl Lists<3, 5> {
    pub fn insphere(stage: Stage) -> Self {
        let near_sphere = || generate3d(Distribution3::Sphere, 5 * LISTS, 1).into_iter();
        let points = match stage {
            Stage::Filter => generate3d(Distribution3::Uniform, 5 * LISTS, 1),
            Stage::Narrow => nearly_cocircular(),
            Stage::Wide => near_sphere().map(|p| integers(p, 52)).collect(),
            Stage::Expansion => near_sphere().collect(),
            Stage::Tie => on_sphere(),
        };
        Lists::new(points, stage, |vertices, [a, b, c, d, e]| vertices.insphere([a, b, c, d], e))
    }

    /// Returns the sum of all signs.
    pub fn sum_insphere(&self) -> i32 {
        self.lists.iter().map(|&[a, b, c, d, e]| i32::from(self.vertices.insphere([a, b, c, d], e))).sum()
    }
}

impl Lists<2, 3> {
    pub fn orient2d(stage: Stage) -> Self {
        let points = generate2d(Distribution2::Uniform, 3 * LISTS, 1).into_iter();
        let points = match stage {
            Stage::Filter => points.collect(),
            Stage::Narrow => points.map(|[x, _]| collinear(integers([x], 28))).collect(),
            Stage::Wide => points.map(|[x, _]| collinear(integers([x], 50))).collect(),
            // Near the line 3y = x.
            Stage::Expansion => points.map(|[x, _]| [x, x / 3.0]).collect(),
            Stage::Tie => unreachable!("orientations are not perturbed"),
        };
        Lists::new(points, stage, |vertices, [a, b, c]| vertices.orient2d(a, b, c))
    }

    /// Returns the sum of all signs.
    pub fn sum_orient2d(&self) -> i32 {
        self.lists.iter().map(|&[a, b, c]| i32::from(self.vertices.orient2d(a, b, c))).sum()
    }
}

impl Lists<2, 4> {
    pub fn incircle(stage: Stage) -> Self {
        let near_circle = || generate2d(Distribution2::Circle, 4 * LISTS, 1).into_iter();
        let points = match stage {
            Stage::Filter => generate2d(Distribution2::Uniform, 4 * LISTS, 1),
            Stage::Narrow => nearly_collinear(),
            Stage::Wide => near_circle().map(|p| integers(p, 52)).collect(),
            Stage::Expansion => near_circle().collect(),
            Stage::Tie => on_circle(),
        };
        Lists::new(points, stage, |vertices, [a, b, c, d]| vertices.incircle([a, b, c], d))
    }

    /// Returns the sum of all signs.
    pub fn sum_incircle(&self) -> i32 {
        self.lists.iter().map(|&[a, b, c, d]| i32::from(self.vertices.incircle([a, b, c], d))).sum()
    }
}

/// Returns the nearest integers to `p` times 2^`bits`.
fn integers<const D: usize>(p: [f64; D], bits: i32) -> [f64; D] {
    p.map(|x| (x * 2f64.powi(bits)).round())
}

/// Returns a point of the plane x + y + z = 0.
fn coplanar([x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, -x - y]
}

/// Returns a point of the line 3y = x.
fn collinear([y]: [f64; 1]) -> [f64; 2] {
    [3.0 * y, y]
}

/// Returns integers near a circle in the plane x + y + z = 0, of which every fifth lies beside the
/// plane. So small a determinant is not zero for two reasons, which takes it below what the filter
/// can tell from zero.
fn nearly_cocircular() -> Vec<[f64; 3]> {
    let points = generate2d(Distribution2::Circle, 5 * LISTS, 1).into_iter().enumerate();
    let near = |(i, [x, y]): (usize, [f64; 2])| {
        let [s, t] = integers([x / 2f64.sqrt(), y / 6f64.sqrt()], 29);
        [s + t + if i % 5 == 3 { 1.0 } else { 0.0 }, t - s, -2.0 * t]
    };
    points.map(near).collect()
}

/// Returns integers on the line 3y = x, of which every fourth lies beside it, and two of four side
/// by side; likewise.
fn nearly_collinear() -> Vec<[f64; 2]> {
    let lists = generate2d(Distribution2::Uniform, 2 * LISTS, 1);
    let near = |&[[a, c], [_, d]]: &[[f64; 2]; 2]| {
        let [a, c, d] = integers([a, c, d], 28);
        [collinear([a]), collinear([a + 1.0]), [3.0 * c + 1.0, c], collinear([d])]
    };
    lists.as_chunks().0.iter().flat_map(near).collect()
}

/// Returns integers on the sphere of radius 9, five different ones at a time.
fn on_sphere() -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for [x, y, z] in [[0.0, 0.0, 9.0], [1.0, 4.0, 8.0], [4.0, 4.0, 7.0], [3.0, 6.0, 6.0]] {
        for p in [[x, y, z], [y, z, x], [z, x, y], [y, x, z], [x, z, y], [z, y, x]] {
            for signs in 0..8 {
                let p: [f64; 3] = std::array::from_fn(|axis| if signs >> axis & 1 == 1 { -p[axis] } else { p[axis] });
                if !all.contains(&p) {
                    all.push(p);
                }
            }
        }
    }
    drawn::<_, 5>(&all)
}

/// Returns integers on the circle of radius 65, four different ones at a time.
fn on_circle() -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    for [x, y] in [[0.0, 65.0], [16.0, 63.0], [25.0, 60.0], [33.0, 56.0], [39.0, 52.0]] {
        for p in [[x, y], [y, x], [-x, y], [y, -x], [x, -y], [-y, x], [-x, -y], [-y, -x]] {
            if !all.contains(&p) {
                all.push(p);
            }
        }
    }
    drawn::<_, 4>(&all)
}

/// Lists of `N` different ones of `all`, one list after the other.
fn drawn<P: Copy + PartialEq, const N: usize>(all: &[P]) -> Vec<P> {
    let mut random = generate2d(Distribution2::Uniform, 4 * POINTS, 2).into_iter().flatten();
    let mut drawn = Vec::with_capacity(N * LISTS);
    for _ in 0..LISTS {
        let start = drawn.len();
        while drawn.len() < start + N {
            let point = all[(random.next().expect("enough numbers") * all.len() as f64) as usize];
            if !drawn[start..].contains(&point) {
                drawn.push(point);
            }
        }
    }
    drawn
}
