//! What is known about the sides of the surface beyond the points: normals, sensors, the ground.
//!
//! Normals point outwards, and what a sensor saw a point through is outside, so that both say for a
//! vertex in which direction the outside is. That gives the poles of the vertex their sides, and the
//! simplices before and behind it a vote. The lines of sight vote for the simplices that they cross as
//! well (after Labatut, Pons and Keriven, *Efficient multi-view reconstruction of large-scale scenes
//! using interest points, Delaunay triangulation and graph cuts*, 2007). Where the ground is known to
//! be solid, what is below the hull is inside.

use super::{
    super::complex::Complex,
    SurfaceOptions,
    spheres::{BENEATH, OUTSIDE, Spheres},
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    input::points::Points,
    mesh::Csr,
    parallel::{self, Threads},
};
use std::sync::atomic::{AtomicI32, Ordering::Relaxed};

/// A direction that is within some 15° of a plane does not say on which side of it the outside is.
const LEAST_COSINE: f64 = 0.25;

/// Votes of more normals or lines of sight for a simplex do not count.
const MAX_VOTES: i32 = 20;

/// How much more a hull facet weighs where what is beyond it is known by the up direction.
const GROUND_WEIGHT: i32 = 50;

/// A line of sight gives up after so many steps that do not bring it closer to the sensor.
const MAX_IDLE_STEPS: u32 = 64;

/// The number of vertices that is worth handing to another thread.
const GRAIN: usize = 1 << 9;

/// How it is known which side of a [`Surface`](crate::Surface) is inside.
///
/// # Examples
///
/// ```
/// use gdel::{Evidence, Surface, SurfaceOptions};
///
/// let points: Vec<[f64; 3]> = (0..125).map(|i| [i % 5, i / 5 % 5, i / 25].map(f64::from)).collect();
/// let mesh = gdel::delaunay3d(&points)?;
/// let surface = Surface::new(&mesh, &points, &SurfaceOptions::default())?;
/// assert_eq!(surface.evidence(), Evidence::Hull);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Evidence {
    /// By [normals](SurfaceOptions::normals).
    Normals,
    /// By the positions of [sensors](SurfaceOptions::sensors).
    Sensors,
    /// By the [up direction](SurfaceOptions::up): what is below all points is inside.
    Below,
    /// What is beyond the convex hull is outside, and the points enclose the inside.
    Hull,
    /// As for [`Hull`](Self::Hull), but the points do not enclose much: a large share of the surface only
    /// closes gaps between them, as in scans from one side. The surface may be inside out.
    Guess,
}

impl Evidence {
    /// Returns the name, such as `normals`.
    pub fn name(self) -> &'static str {
        match self {
            Evidence::Normals => "normals",
            Evidence::Sensors => "sensors",
            Evidence::Below => "below",
            Evidence::Hull => "hull",
            Evidence::Guess => "guess",
        }
    }
}

/// Which side of the surface is beyond a facet or vertex of the hull.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Beyond {
    Outside,
    Inside,
    Unknown,
}

impl Beyond {
    /// Returns the side, by the cosine between the way out of the hull and a direction to the outside.
    fn by_cosine(cosine: f64) -> Self {
        match cosine {
            c if c > LEAST_COSINE => Beyond::Outside,
            c if c < -LEAST_COSINE => Beyond::Inside,
            _ => Beyond::Unknown,
        }
    }

    /// Returns what stands for it among the poles.
    pub(super) fn pole(self) -> u32 {
        match self {
            Beyond::Outside => OUTSIDE,
            Beyond::Inside => BENEATH,
            Beyond::Unknown => NONE,
        }
    }
}

/// Checks the evidence among the options for a number of points.
///
/// # Errors
///
/// [`Error::ValueCount`] or [`Error::BadOption`].
pub(super) fn check<const D: usize>(options: &SurfaceOptions<'_, D>, points: usize) -> Result<(), Error> {
    let are_finite = |vectors: Points<'_, D>| vectors.iter().all(|vector| vector.iter().all(|x| x.is_finite()));
    if let Some(normals) = options.normals {
        if normals.len() != points {
            return Err(Error::ValueCount { values: normals.len(), points });
        }
        if !are_finite(normals) {
            return Err(Error::BadOption { option: "normals", range: "finite; zero where one is unknown" });
        }
    }
    if let Some(sensors) = options.sensors {
        if sensors.len() != points && sensors.len() != 1 {
            return Err(Error::ValueCount { values: sensors.len(), points });
        }
        if !are_finite(sensors) {
            return Err(Error::BadOption { option: "sensors", range: "finite" });
        }
    }
    if options.up.is_some_and(|up| unit(up).is_none()) {
        return Err(Error::BadOption { option: "up", range: "finite and not zero" });
    }
    Ok(())
}

/// Returns the direction of a vector; `None` if it has none.
fn unit<const D: usize>(vector: [f64; D]) -> Option<[f64; D]> {
    let length = vector::norm(vector);
    (length > 0.0 && length.is_finite()).then(|| vector.map(|x| x / length))
}

/// The evidence about the vertices of a mesh.
#[derive(Debug)]
pub(super) struct Hints<const D: usize> {
    /// The direction to the outside at each vertex, zero where it is unknown; empty if it is unknown
    /// everywhere.
    outward: Vec<[f64; D]>,
    /// The sensor of each vertex, or of all, scaled; empty if there is none.
    sensors: Vec<[f64; D]>,
    up: Option<[f64; D]>,
    /// Whether some directions come from normals.
    are_normals: bool,
}

impl<const D: usize> Hints<D> {
    /// Gathers the evidence. `names` are the points' indices by which it is given, and `scale` is what
    /// their coordinates were multiplied by.
    pub(super) fn new(points: Points<'_, D>, names: &[u32], scale: f64, options: &SurfaceOptions<'_, D>) -> Self {
        let sensor = |sensors: Points<'_, D>, name: u32| {
            let i = if sensors.len() == 1 { 0 } else { name as usize };
            vector::times(scale, sensors.get(i))
        };
        let sensors: Vec<[f64; D]> = match options.sensors {
            Some(sensors) => names.iter().map(|&name| sensor(sensors, name)).collect(),
            None => Vec::new(),
        };
        let normal = |v: usize| options.normals.and_then(|normals| unit(normals.get(names[v] as usize)));
        let to_sensor = |v: usize| sensors.get(v).and_then(|&sensor| unit(vector::minus(sensor, points.get(v))));
        let are_normals = (0..names.len()).any(|v| normal(v).is_some());
        let outward = if are_normals || !sensors.is_empty() {
            (0..names.len()).map(|v| normal(v).or_else(|| to_sensor(v)).unwrap_or([0.0; D])).collect()
        } else {
            Vec::new()
        };
        Hints { outward, sensors, up: options.up.and_then(unit), are_normals }
    }

    /// Returns what the sides come from; `None` if nothing is known.
    pub(super) fn kind(&self) -> Option<Evidence> {
        match self {
            _ if self.are_normals => Some(Evidence::Normals),
            _ if !self.sensors.is_empty() => Some(Evidence::Sensors),
            _ => self.up.map(|_| Evidence::Below),
        }
    }

    /// Returns the direction to the outside at a vertex.
    fn outward(&self, v: u32) -> Option<[f64; D]> {
        self.outward.get(v as usize).copied().filter(|&direction| direction != [0.0; D])
    }

    /// Returns what is beyond a vertex of the hull with a normal.
    pub(super) fn beyond_vertex(&self, v: u32, normal: [f64; D]) -> Beyond {
        let Some(out) = unit(normal) else { return Beyond::Outside };
        match self.up.or_else(|| self.outward(v)) {
            Some(direction) => Beyond::by_cosine(vector::dot(out, direction)),
            None => Beyond::Outside,
        }
    }

    /// Returns what is beyond a facet of the hull with a normal.
    fn beyond_facet(&self, vertices: [u32; D], normal: [f64; D]) -> Beyond {
        let Some(out) = unit(normal) else { return Beyond::Outside };
        if let Some(up) = self.up {
            return Beyond::by_cosine(vector::dot(out, up));
        }
        let directions = vertices.iter().filter_map(|&v| self.outward(v));
        let (sum, count) = directions.fold((0.0, 0), |(sum, count), d| (sum + vector::dot(out, d), count + 1));
        if count == 0 { Beyond::Outside } else { Beyond::by_cosine(sum / f64::from(count)) }
    }

    /// Returns what is beyond a facet of the hull of a mesh.
    pub(super) fn beyond_facet_of<const N: usize>(&self, complex: &Complex<'_, D, N>, vertices: [u32; D]) -> Beyond
    where
        Euclidean: Geometry<D, N>,
    {
        self.beyond_facet(vertices, Euclidean::facet_normal(&vertices.map(|v| complex.point(v))))
    }

    /// Returns the votes that a facet of the hull has for the inside of its simplex, times its cost.
    pub(super) fn hull_excess<const N: usize>(&self, complex: &Complex<'_, D, N>, vertices: [u32; D], cost: u16) -> i32
    where
        Euclidean: Geometry<D, N>,
    {
        let weight = if self.up.is_some() { GROUND_WEIGHT } else { 1 };
        match self.beyond_facet_of(complex, vertices) {
            Beyond::Outside => -weight * i32::from(cost),
            Beyond::Inside => weight * i32::from(cost),
            Beyond::Unknown => 0,
        }
    }

    /// Returns the cosine between the direction to the outside at a vertex and that to one of its poles,
    /// unless it is too small to say anything.
    pub(super) fn cosine(&self, v: u32, point: [f64; D], pole: u32, spheres: &Spheres<D>) -> Option<f64> {
        if pole >= BENEATH {
            return None;
        }
        let direction = self.outward(v)?;
        let to_pole = vector::minus(spheres.centers[pole as usize], point);
        let cosine = vector::dot(to_pole, direction) / spheres.radii[pole as usize];
        (cosine.abs() >= LEAST_COSINE).then_some(cosine)
    }

    /// Returns the votes for each simplex, positive for the inside; none if there is no evidence.
    pub(super) fn votes<const N: usize>(&self, complex: &Complex<'_, D, N>, stars: &Csr) -> Vec<i32>
    where
        Euclidean: Geometry<D, N>,
    {
        if self.outward.is_empty() {
            return Vec::new();
        }
        let zeros = || (0..complex.simplices.len()).map(|_| AtomicI32::new(0)).collect::<Vec<_>>();
        // Sums of integers do not depend on the order.
        let (near, seen) = (zeros(), zeros());
        parallel::map_grains(Threads::All, self.outward.len(), GRAIN, |range| {
            for v in range.start as u32..range.end as u32 {
                let Some(direction) = self.outward(v).filter(|_| !stars.of(v).is_empty()) else { continue };
                let before = towards(complex, stars.of(v), v, direction);
                let behind = towards(complex, stars.of(v), v, vector::times(-1.0, direction));
                before.inspect(|&t| _ = near[t].fetch_sub(1, Relaxed));
                behind.inspect(|&t| _ = near[t].fetch_add(1, Relaxed));
                let Some(&sensor) = self.sensors.get(v as usize) else { continue };
                let to_sensor = vector::minus(sensor, complex.point(v));
                if let Some(t) = towards(complex, stars.of(v), v, to_sensor) {
                    let margin = spacing(complex, stars.of(v), v) / vector::norm(to_sensor);
                    see(complex, v, t, to_sensor, margin, |t| _ = seen[t].fetch_add(1, Relaxed));
                }
            }
        });
        let near = near.into_iter().map(|votes| votes.into_inner().clamp(-MAX_VOTES, MAX_VOTES));
        near.zip(seen).map(|(near, seen)| near - seen.into_inner().min(MAX_VOTES)).collect()
    }
}

/// Returns the simplex around a vertex into which a direction leads; `None` if it leads out of the hull.
fn towards<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    star: &[u32],
    v: u32,
    direction: [f64; D],
) -> Option<usize>
where
    Euclidean: Geometry<D, N>,
{
    let direction = unit(direction)?;
    let mut best = (-1e-9, None);
    for &t in star {
        let (corners, simplex) = (complex.corners(t as usize), complex.simplices[t as usize]);
        let inward = (0..N).filter(|&k| simplex[k] != v).map(|k| {
            let normal = Euclidean::facet_normal(&facet(&corners, k));
            -vector::dot(normal, direction) / vector::norm(normal)
        });
        let least = inward.fold(f64::INFINITY, f64::min);
        if least > best.0 {
            best = (least, Some(t as usize));
        }
    }
    best.1
}

/// Returns about how far a vertex is from its nearest neighbours.
fn spacing<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, star: &[u32], v: u32) -> f64 {
    let point = complex.point(v);
    let mut nearest = [f64::INFINITY; 3];
    let mut last = [v; 3];
    for &w in star.iter().flat_map(|&t| &complex.simplices[t as usize]) {
        if w == v || last.contains(&w) {
            continue;
        }
        let squared = vector::squared_norm(vector::minus(complex.point(w), point));
        if let Some(i) = nearest.iter().position(|&other| squared < other) {
            nearest[i..].rotate_right(1);
            last[i..].rotate_right(1);
            (nearest[i], last[i]) = (squared, w);
        }
    }
    nearest.iter().filter(|squared| squared.is_finite()).fold(0.0, |far, &squared| far.max(squared.sqrt()))
}

/// Calls `visit` for the simplices that the line from vertex `v` to its sensor crosses, from simplex `t`
/// on, except for those that begin within `margin`, a share of the line.
///
/// The line leaves each simplex through the facet whose plane it crosses first. Rounding may lead it
/// past an edge on the wrong side, for which votes are good enough.
fn see<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    v: u32,
    mut t: usize,
    to_sensor: [f64; D],
    margin: f64,
    mut visit: impl FnMut(usize),
) where
    Euclidean: Geometry<D, N>,
{
    let origin = complex.point(v);
    let (mut before, mut at, mut idle) = (NONE, 0.0, 0);
    while idle < MAX_IDLE_STEPS {
        if at >= margin {
            visit(t);
        }
        let (corners, (simplex, neighbors)) = (complex.corners(t), complex.row(t));
        let mut exit = (f64::INFINITY, None);
        for k in 0..N {
            // The line begins at a corner, and does not go back.
            let is_behind = if before == NONE { simplex[k] != v } else { neighbors[k] == before };
            let corners: [[f64; D]; D] = facet(&corners, k);
            let normal = Euclidean::facet_normal(&corners);
            let speed = vector::dot(normal, to_sensor);
            if is_behind || speed <= 0.0 {
                continue;
            }
            let crossing = vector::dot(normal, vector::minus(corners[0], origin)) / speed;
            if crossing < exit.0 {
                exit = (crossing, Some(k));
            }
        }
        let (crossing, Some(k)) = exit else { return };
        if crossing >= 1.0 || neighbors[k] == NONE {
            return;
        }
        idle = if crossing > at { 0 } else { idle + 1 };
        at = crossing.max(at);
        (before, t) = (t as u32, neighbors[k] as usize);
    }
}
