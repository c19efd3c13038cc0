//! Terrain: a few of many points, with a surface of triangles between them that is near to all.
//!
//! Greedy insertion (Garland and Heckbert, *Fast triangular approximation of terrains and height fields*, 1997), in a
//! constrained Delaunay triangulation:
//!
//! 1. `places`: where points are as seen from above, which of several counts, and the corners of the hull;
//! 2. the constrained Delaunay triangulation of these corners and of the ends of segments;
//! 3. `insert`: the point that is farthest from the surface becomes a vertex, in the triangles of `growing`, until none is
//!    too far. Only the points in triangles that change are measured anew;
//! 4. `heights`: how high a triangle is at a place.
//!
//! Signs are exact, so the mesh is always the constrained Delaunay triangulation of its vertices; heights are computed in
//! floating point.

mod heights;
mod insert;
mod places;

use super::{Constrained2, Constraints, Unconstrained, constrain, constrained, split::crossing};
use crate::{
    cpu,
    d2::insert::MAX_POINTS,
    error::Error,
    geometry::vector::norm,
    index::NONE,
    input::points::{Points2, Points3},
    options::Options,
    parallel::{self, Threads},
};
use insert::Greedy;
use places::Places;
use std::num::NonZeroUsize;

/// What [`Triangulator::tin`](crate::Triangulator::tin) is to reach.
///
/// # Examples
///
/// ```
/// let mut options = gdel::TinOptions::default();
/// options.max_error = 0.1;
/// options.max_points = Some(100_000);
/// ```
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct TinOptions {
    /// How far points may be above or below the surface, in the unit of their heights; by default 0, with which all points
    /// become vertices but those that the surface meets anyway.
    pub max_error: f64,
    /// The largest number of vertices. By default there are as many as are needed. The corners of the hull and the ends of
    /// segments always are vertices.
    pub max_points: Option<usize>,
}

impl TinOptions {
    fn check(&self) -> Result<(), Error> {
        match self.max_error >= 0.0 {
            true => Ok(()),
            false => Err(Error::BadOption { option: "the largest error", range: "a number from 0 on" }),
        }
    }
}

/// Terrain: the surface over some of the points that is near to all of them.
///
/// # Examples
///
/// ```
/// use gdel::{Constraints, TinOptions, Triangulator};
///
/// // A valley, by a hundred points.
/// let points: Vec<[f64; 3]> = (0..100i32).map(|i| [i % 10, i / 10, (5 - i % 10).abs()].map(f64::from)).collect();
/// let mut options = TinOptions::default();
/// options.max_error = 0.1;
/// let tin = Triangulator::new().tin(&points, &Constraints::new(), &options)?;
/// assert!(tin.max_error <= 0.1);
/// // Four corners, and the two ends of the valley.
/// assert_eq!(tin.vertices.len(), 6);
/// assert!(tin.sources.iter().zip(&tin.vertices).all(|(&i, &vertex)| points[i as usize] == vertex));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Tin {
    /// The triangles, as seen from above. Their vertices are [`vertices`](Self::vertices). Its
    /// [`segments`](Constrained2::segments), too, are by these, and so are its [`added`](Constrained2::added) points.
    pub constrained: Constrained2,
    /// The vertices: the corners of the hull, the ends of segments, and points where these cross, in the order of the points;
    /// other crossings, if these are [split](Constraints::split_crossings); then all others in the order in which they were needed.
    pub vertices: Vec<[f64; 3]>,
    /// The point that each vertex is; [`NONE`](crate::NONE) for those at crossings.
    pub sources: Vec<u32>,
    /// How far from the surface the farthest point is that counts.
    pub max_error: f64,
    /// What was found and done.
    pub stats: TinStats,
}

/// What [`Triangulator::tin`](crate::Triangulator::tin) has found and done.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct TinStats {
    /// The number of vertices at the start: corners of the hull, ends of segments, and points where segments cross.
    pub start: usize,
    /// The number of points that have the x and y of another one that counts in their place.
    pub duplicates: usize,
    /// The number of these that have another height than that one.
    pub other_heights: usize,
    /// The number of places of points outside the boundaries, whose heights do not matter.
    pub outside: usize,
    /// Whether more vertices were needed than allowed.
    pub limited: bool,
}

impl Tin {
    /// Returns the triangles inside the boundaries, counter-clockwise as seen from above.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + Clone + '_ {
        self.constrained.inside_triangles()
    }
}

/// Returns the terrain of points with the CPU engine.
///
/// # Errors
///
/// Returns the errors of [`Triangulator::tin`](crate::Triangulator::tin).
pub fn tin(points: Points3<'_>, constraints: &Constraints, options: &TinOptions, run: &Options) -> Result<Tin, Error> {
    options.check()?;
    if points.len() > MAX_POINTS {
        return Err(Error::TooManyPoints { points: points.len(), limit: MAX_POINTS });
    }
    constraints.check(points.len())?;
    parallel::with_threads(run.threads, |threads| tin_by(threads, points, constraints, options, run))
}

fn tin_by(
    threads: Threads,
    points: Points3<'_>,
    constraints: &Constraints,
    options: &TinOptions,
    run: &Options,
) -> Result<Tin, Error> {
    let segments = constraints.segments();
    let places = Places::new(threads, points, &segments)?;
    let Start { mesh: mut constrained, mut sources, mut vertices } =
        start(threads, points, constraints, &segments, &places)?;
    sources.resize(vertices.len(), NONE);
    let stats = TinStats {
        start: vertices.len(),
        duplicates: places.duplicates(),
        other_heights: places.other_heights,
        ..TinStats::default()
    };
    if constrained.mesh.triangles.is_empty() {
        return Ok(Tin { constrained, vertices, sources, max_error: 0.0, stats });
    }
    let first_added = vertices.len() - constrained.added.len();
    for (place, i) in places.at(&constrained.added) {
        vertices[first_added + i][2] = places.heights[place];
    }
    let mut greedy = Greedy::new(threads, &constrained, &vertices, &places, stats)?;
    let most = options.max_points.map_or(usize::MAX, |most| most.saturating_sub(vertices.len()));
    greedy.insert_all(options, most, run)?;
    sources.extend(&greedy.inserted);
    let (max_error, stats) = (greedy.error_left(), greedy.stats);
    let vertices = greedy.finish(&mut constrained);
    Ok(Tin { constrained, vertices, sources, max_error, stats })
}

/// The surface that insertion begins with.
struct Start {
    mesh: Constrained2,
    /// The points among the vertices.
    sources: Vec<u32>,
    vertices: Vec<[f64; 3]>,
}

/// Triangulates the corners of the hull, the ends of segments, and points where segments cross.
///
/// # Errors
///
/// Returns the errors of constraints, with the points that were given.
fn start(
    threads: Threads,
    points: Points3<'_>,
    given: &Constraints,
    segments: &[[u32; 2]],
    places: &Places,
) -> Result<Start, Error> {
    let mut sources = places.corners(threads);
    sources.extend(segments.as_flattened().iter().map(|&v| places.counting[v as usize]));
    let own = Options { threads: (threads == Threads::One).then_some(NonZeroUsize::MIN), ..Options::default() };
    loop {
        sources.sort_unstable();
        sources.dedup();
        let named = Named { given, segments, counting: &places.counting, sources: &sources };
        let mut vertices: Vec<[f64; 3]> = sources.iter().map(|&v| points.get(v as usize)).collect();
        let seen: Vec<[f64; 2]> = vertices.iter().map(|&[x, y, _]| [x, y]).collect();
        let seen = Points2::F64(&seen);
        let constraints = named.constraints();
        let mesh = match constrain(threads, cpu::delaunay::<2>(seen, &own)?, seen, &constraints) {
            Ok(mesh) => mesh,
            Err(Unconstrained::Error(error)) => return Err(named.error(error)),
            Err(Unconstrained::Crossings(pairs)) => {
                // A point where segments cross has to be a vertex.
                let all = constraints.segments();
                let ends = |i: u32| all[i as usize].map(|v| seen.get(v as usize));
                let crossings: Vec<[f64; 2]> = pairs.iter().map(|pair| crossing(pair.map(ends)).0).collect();
                let there = places.at(&crossings).into_iter().map(|(place, _)| places.names[place]);
                let new: Vec<u32> = there.filter(|name| sources.binary_search(name).is_err()).collect();
                if !new.is_empty() {
                    sources.extend(new);
                    continue;
                }
                constrained(seen, &constraints, &own).map_err(|error| named.error(error))?
            }
        };
        let heights = heights_of_added(&named, &mesh, &vertices);
        vertices.extend(mesh.added.iter().zip(heights).map(|(&[x, y], z)| [x, y, z]));
        return Ok(Start { mesh, sources, vertices });
    }
}

/// The constraints of the points, and those of the vertices at the start.
struct Named<'a> {
    given: &'a Constraints,
    /// All segments that were given.
    segments: &'a [[u32; 2]],
    /// The point that counts at the place of each point.
    counting: &'a [u32],
    /// The point that each vertex is; they ascend.
    sources: &'a [u32],
}

impl Named<'_> {
    fn segment(&self, segment: [u32; 2]) -> [u32; 2] {
        segment.map(|v| self.sources.partition_point(|&source| source < self.counting[v as usize]) as u32)
    }

    fn constraints(&self) -> Constraints {
        let named = |segments: &[[u32; 2]]| segments.iter().map(|&segment| self.segment(segment)).collect();
        let (edges, boundary) = (named(&self.given.edges), named(&self.given.boundary));
        Constraints { edges, boundary, ..self.given.clone() }
    }

    /// Returns an error with the points that were given.
    fn error(&self, error: Error) -> Error {
        let given = |segment: [u32; 2]| {
            let found = self.segments.iter().find(|&&other| self.segment(other) == segment);
            found.copied().unwrap_or(segment)
        };
        match error {
            Error::CrossingConstraints { count, pairs } => {
                Error::CrossingConstraints { count, pairs: pairs.into_iter().map(|pair| pair.map(given)).collect() }
            }
            Error::OpenBoundary { point } => Error::OpenBoundary { point: self.sources[point] as usize },
            other => other,
        }
    }
}

/// Returns the heights of points at crossings: the mean of those that the segments have there.
fn heights_of_added(named: &Named<'_>, start: &Constrained2, vertices: &[[f64; 3]]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); start.added.len()];
    let at = |v: u32| match vertices.get(v as usize) {
        Some(&[x, y, _]) => [x, y],
        None => start.added[v as usize - vertices.len()],
    };
    let mut pieces = start.segments.iter();
    for &segment in named.segments {
        let [from, to] = named.segment(segment);
        let [a, b] = [from, to].map(at);
        let [low, high] = [from, to].map(|v| vertices[v as usize][2]);
        let length = distance(a, b);
        for &[_, end] in pieces.by_ref() {
            if end == to {
                break;
            }
            let share = if length > 0.0 { (distance(a, at(end)) / length).min(1.0) } else { 0.0 };
            let (sum, count) = &mut sums[end as usize - vertices.len()];
            *sum += (1.0 - share) * low + share * high;
            *count += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| if count > 0.0 { sum / count } else { 0.0 }).collect()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    norm([b[0] / 2.0 - a[0] / 2.0, b[1] / 2.0 - a[1] / 2.0])
}
