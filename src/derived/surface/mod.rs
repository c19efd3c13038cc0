//! One closed surface through unordered points, such as those of a scan.
//!
//! The solid consists of simplices of the Delaunay triangulation, so that its boundary is closed,
//! oriented and does not intersect itself. Which simplices belong to it is found in these steps:
//!
//! 1. `poles`: the circumspheres, and the two farthest circumcentres around each vertex;
//! 2. `constraints`, `parity`: which poles lie inside and which outside;
//! 3. `capacity`: what it costs that a facet belongs to the surface;
//! 4. `cut`: the least surface that separates the poles inside from those outside;
//! 5. `solid`: without specks and bubbles;
//! 6. `boundary`: its facets as a manifold.

mod boundary;
mod capacity;
mod constraints;
mod cut;
mod parity;
mod poles;
mod solid;

use super::{
    complex::{Complex, Coordinates},
    sorted::Sorted,
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, vector},
    index::NONE,
    input::points::Points,
    mesh::{Csr, Mesh},
};
use boundary::Boundary;
use poles::{Poles, Spheres};

/// How [`Surface::new`] finds a surface.
///
/// # Examples
///
/// ```
/// let mut options = gdel::SurfaceOptions::default();
/// // All pieces count, however small they are.
/// options.min_part = 0.0;
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SurfaceOptions {
    /// Pieces of the solid and cavities in it are dropped if their volume is less than this share of
    /// the largest piece's; by default 0.01.
    pub min_part: f64,
}

impl Default for SurfaceOptions {
    fn default() -> Self {
        SurfaceOptions { min_part: 0.01 }
    }
}

/// Where a point lies with respect to a [`Surface`].
///
/// # Examples
///
/// ```
/// use gdel::{Side, Surface, SurfaceOptions};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let polygon = Surface::new(&mesh, &points, &SurfaceOptions::default())?;
/// assert_eq!(polygon.sides(), [Side::On; 4]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// It is a vertex of the surface.
    On,
    /// It lies in the solid, but not on the surface.
    Inside,
    /// It lies outside the solid.
    Outside,
}

/// One closed surface through the vertices of a mesh, and the solid that it encloses; in 2D, closed
/// curves and their area.
///
/// The points need neither order nor normals. They should lie on the surface of something, densely
/// compared with its details. The solid is a set of simplices of the mesh, found by the least cut
/// between the farthest circumcentres around the vertices inside and outside. So the surface is closed,
/// oriented and does not intersect itself. Where sheets of it touch at a vertex or an edge, each has
/// its own copy of the vertices, so that every edge belongs to exactly two triangles.
///
/// The surface depends on the points and the options alone: not on threads or, where the
/// triangulation does not, on the order of the points.
///
/// # Examples
///
/// ```
/// use gdel::{Side, Surface, SurfaceOptions};
///
/// // Points on a sphere, along a spiral, and one at its centre.
/// let mut points: Vec<[f64; 3]> = (0..1000)
///     .map(|i| {
///         let (z, turn) = (1.0 - (2 * i + 1) as f64 / 1000.0, 2.399963 * i as f64);
///         let r = (1.0 - z * z).sqrt();
///         [r * turn.cos(), r * turn.sin(), z]
///     })
///     .collect();
/// points.push([0.0; 3]);
/// let mesh = gdel::delaunay3d(&points)?;
/// let surface = Surface::new(&mesh, &points, &SurfaceOptions::default())?;
///
/// assert!(surface.is_closed());
/// assert_eq!((surface.components(), surface.genus()), (1, 0));
/// assert_eq!((surface.vertices().len(), surface.facets().len()), (1000, 1996));
/// assert!((surface.volume() / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 0.02);
/// assert_eq!(surface.sides()[1000], Side::Inside);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Surface<const D: usize = 3, const N: usize = 4> {
    vertices: Vec<[f64; D]>,
    sources: Vec<u32>,
    facets: Vec<[u32; D]>,
    solid: Vec<[u32; N]>,
    sides: Vec<Side>,
    volume: f64,
    area: f64,
    components: usize,
    dropped: [usize; 2],
}

impl<const D: usize, const N: usize> Surface<D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Finds the surface through the vertices of a mesh with its points.
    ///
    /// Points that are flat, and fewer than four in 3D or three in 2D, have no solid: the surface is
    /// then empty.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`], [`Error::NotFinite`] or [`Error::BrokenMesh`] as for
    /// [`Locator::new`](crate::Locator::new); [`Error::TooManySimplices`] beyond 2³⁰ simplices;
    /// [`Error::BadOption`].
    pub fn new<'a>(
        mesh: &'a impl Mesh<D, N>,
        points: impl Into<Points<'a, D>>,
        options: &SurfaceOptions,
    ) -> Result<Self, Error> {
        if !(0.0..=1.0).contains(&options.min_part) {
            return Err(Error::BadOption { option: "min_part", range: "a number from 0 to 1" });
        }
        let given = Complex::new(mesh, points.into())?;
        if given.simplices.len() > cut::MAX_NODES {
            return Err(Error::TooManySimplices { limit: cut::MAX_NODES });
        }
        let mut mesh = Sorted::new(&given);
        mesh.arrange_rows();
        let scale = vector::scale_of(given.bounds());
        if scale != 1.0
            && let Coordinates::Owned(points) = &mut mesh.complex.points
        {
            points.iter_mut().for_each(|p| *p = vector::times(scale, *p));
        }
        let (is_inside, dropped) = solid(&mesh, options);
        let boundary = Boundary::new(&mesh.complex, &mesh.points, &is_inside);
        let complex = &mesh.complex;
        let inside = || (0..is_inside.len()).filter(|&t| is_inside[t]);
        let mut vertices: Vec<[f64; D]> = boundary.sources.iter().map(|&point| given.point(point)).collect();
        for &[a, b] in &boundary.middles {
            let halves = [a, b].map(|v| vector::times(0.5, vertices[v as usize]));
            vertices.push(vector::plus(halves[0], halves[1]));
        }
        let components = boundary.components();
        let mut sources = boundary.sources;
        let sides = sides(&mesh, &is_inside, &sources);
        sources.resize(vertices.len(), NONE);
        // The power of the scale may underflow.
        let unscaled = |measure: f64, power: usize| (0..power).fold(measure, |measure, _| measure / scale);
        Ok(Surface {
            solid: inside().map(|t| mesh.given(complex.simplices[t])).collect(),
            sides,
            volume: unscaled(solid::volume(complex, inside()), D),
            area: unscaled(boundary::area(&boundary.facets, &vertices, scale), D - 1),
            vertices,
            components,
            sources,
            facets: boundary.facets,
            dropped,
        })
    }
}

impl<const D: usize, const N: usize> Surface<D, N> {
    /// Returns the coordinates of the vertices.
    pub fn vertices(&self) -> &[[f64; D]] {
        &self.vertices
    }

    /// Returns for each vertex the point that it is, in ascending order. Points at which sheets of the
    /// surface touch come several times. Where two sheets touch along an edge whose vertices they cannot
    /// split, one has a new vertex in its middle, which is no point: `u32::MAX`.
    pub fn sources(&self) -> &[u32] {
        &self.sources
    }

    /// Returns the facets by their [`vertices`](Self::vertices): triangles that are counter-clockwise as
    /// seen from outside, in 2D edges that have the inside on their left.
    pub fn facets(&self) -> &[[u32; D]] {
        &self.facets
    }

    /// Returns the simplices of the mesh that are inside, by points.
    pub fn solid(&self) -> &[[u32; N]] {
        &self.solid
    }

    /// Returns where each point lies.
    pub fn sides(&self) -> &[Side] {
        &self.sides
    }

    /// Returns the volume of the solid, in 2D the area.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Returns the area of the surface, in 2D the length of the curves.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns the number of connected surfaces, or curves in 2D. A ball with a cavity has two.
    pub fn components(&self) -> usize {
        self.components
    }

    /// Returns the number of handles of all surfaces together: 0 for a sphere, 1 for a torus. It is 0 in
    /// 2D.
    pub fn genus(&self) -> usize {
        // Euler's characteristic; every edge belongs to two triangles.
        let doubled = 2 * (self.vertices.len() + self.facets.len()) as i64 - 3 * self.facets.len() as i64;
        if D == 3 { (self.components as i64 - doubled / 4) as usize } else { 0 }
    }

    /// Returns how many pieces of the solid, and how many cavities, were dropped because they were
    /// smaller than [`min_part`](SurfaceOptions::min_part).
    pub fn dropped(&self) -> [usize; 2] {
        self.dropped
    }

    /// Returns whether every edge belongs to exactly two triangles, in opposite directions, and in 2D
    /// every vertex to one edge that ends there and one that starts there. Counts them; by
    /// construction, the result is `true`.
    pub fn is_closed(&self) -> bool {
        boundary::is_closed(&self.facets)
    }
}

/// Returns where each point lies.
fn sides<const D: usize, const N: usize>(mesh: &Sorted<D, N>, is_inside: &[bool], vertices: &[u32]) -> Vec<Side> {
    let complex = &mesh.complex;
    let mut sides = vec![Side::Outside; mesh.points.len()];
    for (simplex, _) in complex.simplices.iter().zip(is_inside).filter(|&(_, &is_inside)| is_inside) {
        simplex.iter().for_each(|&v| sides[mesh.points[v as usize] as usize] = Side::Inside);
    }
    vertices.iter().for_each(|&point| sides[point as usize] = Side::On);
    for (&point, &vertex) in mesh.points.iter().zip(&*complex.duplicate_of) {
        if vertex != NONE {
            sides[point as usize] = sides[mesh.points[vertex as usize] as usize];
        }
    }
    sides
}

/// Returns whether each simplex is inside, and how many pieces and cavities were dropped.
fn solid<const D: usize, const N: usize>(mesh: &Sorted<D, N>, options: &SurfaceOptions) -> (Vec<bool>, [usize; 2])
where
    Euclidean: Geometry<D, N>,
{
    let complex = &mesh.complex;
    let spheres = Spheres::new(complex);
    let stars = Csr::stars(&complex.simplices, complex.points().len());
    let poles = Poles::of_all(mesh, &spheres, &stars);
    let votes = constraints::votes(complex, &spheres, &stars, &poles);
    let costs = capacity::costs(complex, &spheres);
    drop((spheres, stars, poles));
    let excess: Vec<i32> = votes
        .iter()
        .zip(&costs)
        .enumerate()
        .map(|(t, (&votes, costs))| {
            let hull = (0..N).filter(|&k| complex.across(t, k).is_none()).map(|k| i32::from(costs[k]));
            capacity::UNIT * i32::from(votes) - hull.sum::<i32>()
        })
        .collect();
    let mut is_inside = cut::inside(complex, &costs, &excess);
    let dropped = solid::drop_small(complex, &mut is_inside, options.min_part);
    (is_inside, dropped)
}
