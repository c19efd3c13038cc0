//! One closed surface through unordered points, such as those of a scan.
//!
//! The solid consists of simplices of the Delaunay triangulation, so that its boundary is closed,
//! oriented and does not intersect itself. Which simplices belong to it is found in these steps:
//!
//! 0. `evidence`: what normals, sensors and the up direction say;
//!    `clean`: isolated points are dropped, and where there is noise, points are moved onto local
//!    quadrics (`outliers`, `quadrics`, `neighbors`), and triangulated again;
//! 1. `spheres`, `poles`: the circumspheres, and the two farthest circumcentres around each vertex;
//! 2. `constraints`, `parity`: which poles lie inside and which outside;
//! 3. `capacity`: what it costs that a facet belongs to the surface;
//! 4. `cut`: the least surface that separates the poles inside from those outside;
//! 5. `solid`: without specks and bubbles;
//! 6. `boundary`: its facets as a manifold;
//! 7. `open`: without those that only close gaps, on request (`beyond`);
//! 8. `refine`: with new vertices on quadrics, on request (`crossing`).

mod beyond;
mod boundary;
mod capacity;
mod clean;
mod constraints;
mod crossing;
mod cut;
mod evidence;
mod find;
mod neighbors;
mod open;
mod outliers;
mod parity;
mod poles;
mod quadrics;
mod refine;
mod solid;
mod spheres;

use super::complex::Complex;
use crate::{
    cpu,
    d2::Mesh2,
    d3::Mesh3,
    error::Error,
    geometry::{Euclidean, Geometry},
    index::NONE,
    input::points::Points,
    mesh::Mesh,
    options::Options,
};
use boundary::Boundary;
use clean::Cleaned;
use find::Prepared;

pub use crossing::facets as crossing_facets;
pub use evidence::Evidence;
pub use open::Open;

/// How [`Surface::new`] finds a surface.
///
/// # Examples
///
/// ```
/// let normals = [[0.0, 0.0, 1.0f32]; 500];
/// let mut options: gdel::SurfaceOptions = Default::default();
/// // All pieces count, however small they are.
/// options.min_part = 0.0;
/// options.normals = Some((&normals).into());
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SurfaceOptions<'a, const D: usize = 3> {
    /// Pieces of the solid and cavities in it are dropped if their volume is less than this share of
    /// the largest piece's; by default 0.01.
    pub min_part: f64,
    /// Whether isolated points are dropped before the surface is found; by default `true`. They are far
    /// from all others: the sixth nearest one is more than four times as far away as is usual, and as
    /// it is around them unless those around them lie on no surface either.
    pub drop_isolated: bool,
    /// How often all points are moved onto quadrics through their neighbours before the surface is
    /// found. By default twice if there is noise, which is estimated, and never else.
    pub smooth: Option<u32>,
    /// The normals of the points, which point outwards; zero where one is unknown. Their lengths do not
    /// matter. By default none: the surface is found without.
    pub normals: Option<Points<'a, D>>,
    /// The position of the sensor for each point, or one for all. What a point was seen through is outside.
    pub sensors: Option<Points<'a, D>>,
    /// The direction that is up, if what is below all points is inside, as in airborne scans of the ground.
    pub up: Option<[f64; D]>,
    /// Whether facets that only close gaps are left out; by default never.
    pub open: Open,
    /// Whether each triangle is split into four, and each edge in two in 2D, with the new vertices on quadrics
    /// through the points around them; by default `false`. The surface is then closer to what is curved.
    /// New vertices stay in the middles of their edges where points do not fit a quadric, and where facets
    /// would intersect.
    pub refine: bool,
}

impl<const D: usize> Default for SurfaceOptions<'_, D> {
    fn default() -> Self {
        SurfaceOptions {
            min_part: 0.01,
            drop_isolated: true,
            smooth: None,
            normals: None,
            sensors: None,
            up: None,
            open: Open::Never,
            refine: false,
        }
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
    /// It lies in the solid, but not on the surface. If the surface is open, it may be at a gap.
    Inside,
    /// It lies outside the solid, or was dropped.
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
/// Normals, sensors and the up direction, as far as they are known, decide which side is inside. On
/// request, facets that only close gaps are left out ([`Open::Auto`]); the surface then has a boundary.
///
/// The surface depends on the points and the options alone: not on threads or, where the
/// triangulation does not, on the order of the points.
///
/// # Examples
///
/// ```
/// use gdel::{Side, Surface, SurfaceOptions};
///
/// // Points on a sphere, along a spiral, and one at its centre, which is far from all others.
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
/// assert_eq!((surface.isolated(), surface.sides()[1000]), (1, Side::Outside));
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
    topology: Topology,
    cleaning: Cleaning,
    evidence: Evidence,
    /// All points, if they were moved.
    moved: Option<Vec<[f64; D]>>,
}

/// What was dropped before and after the surface was found, and the noise.
#[derive(Debug, Clone, Copy)]
struct Cleaning {
    dropped: [usize; 2],
    isolated: usize,
    noise: f64,
}

/// How a surface hangs together.
#[derive(Debug, Clone, Copy)]
struct Topology {
    components: usize,
    genus: usize,
    boundaries: usize,
}

impl Topology {
    fn new<const D: usize>(boundary: &Boundary<D>, vertices: usize) -> Self {
        let components = boundary.components();
        let [boundaries, rim] = open::rims(boundary, vertices);
        // Euler's characteristic; every edge belongs to two triangles, those of the rim to one.
        let facets = boundary.facets.len();
        let characteristic = (vertices + facets) as i64 - (3 * facets + rim) as i64 / 2;
        let doubled = 2 * components as i64 - boundaries as i64 - characteristic;
        Topology { components, genus: if D == 3 { (doubled / 2) as usize } else { 0 }, boundaries }
    }
}

/// What differs between the dimensions in surfaces.
#[doc(hidden)]
pub trait SurfaceMesh<const D: usize, const N: usize>: Geometry<D, N> {
    /// The mesh that [`Surface::new`] takes, and makes of points that it has moved.
    type Mesh: Mesh<D, N>;

    /// Triangulates points.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](crate::delaunay3d) that are not a GPU's.
    fn delaunay(points: &[[f64; D]]) -> Result<Self::Mesh, Error>;
}

impl SurfaceMesh<2, 3> for Euclidean {
    type Mesh = Mesh2;

    fn delaunay(points: &[[f64; 2]]) -> Result<Mesh2, Error> {
        cpu::delaunay(Points::F64(points), &Options::default())
    }
}

impl SurfaceMesh<3, 4> for Euclidean {
    type Mesh = Mesh3;

    fn delaunay(points: &[[f64; 3]]) -> Result<Mesh3, Error> {
        cpu::delaunay(Points::F64(points), &Options::default())
    }
}

impl<const D: usize, const N: usize> Surface<D, N>
where
    Euclidean: SurfaceMesh<D, N>,
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
    /// [`Error::ValueCount`] if there is not one normal or sensor per point; [`Error::BadOption`].
    pub fn new<'a>(
        mesh: &'a impl Mesh<D, N>,
        points: impl Into<Points<'a, D>>,
        options: &SurfaceOptions<'_, D>,
    ) -> Result<Self, Error> {
        if !(0.0..=1.0).contains(&options.min_part) {
            return Err(Error::BadOption { option: "min_part", range: "a number from 0 to 1" });
        }
        let points = points.into();
        evidence::check(options, points.len())?;
        let given = Complex::delaunay(mesh, points)?;
        let prepared = Prepared::new(&given)?;
        let stars = prepared.stars();
        let cleaned = Cleaned::new(&prepared, &stars, options);
        if !cleaned.is_changed() {
            let surface = prepared.surface(&stars, options, &|point| given.point(point));
            let cleaning = Cleaning { noise: cleaned.noise, ..surface.cleaning };
            return Ok(Surface { cleaning, ..surface });
        }
        drop((prepared, stars));
        let mut moved: Vec<[f64; D]> = points.iter().collect();
        let working = cleaned.points(points);
        for (&name, &p) in cleaned.names.iter().zip(&working) {
            moved[name as usize] = p;
        }
        let mesh = Euclidean::delaunay(&working)?;
        let complex = Complex::new(&mesh, Points::F64(&working))?;
        let prepared = Prepared::new(&complex)?.named(&cleaned.names, points.len());
        let mut surface = prepared.surface(&prepared.stars(), options, &|point| moved[point as usize]);
        for (i, &vertex) in given.duplicate_of.iter().enumerate().filter(|&(_, &vertex)| vertex != NONE) {
            surface.sides[i] = surface.sides[vertex as usize];
            moved[i] = moved[vertex as usize];
        }
        let moved = (cleaned.passes > 0).then_some(moved);
        let cleaning = Cleaning { noise: cleaned.noise, isolated: cleaned.isolated, ..surface.cleaning };
        Ok(Surface { cleaning, moved, ..surface })
    }
}

impl<const D: usize, const N: usize> Surface<D, N> {
    /// Returns the coordinates of the vertices.
    pub fn vertices(&self) -> &[[f64; D]] {
        &self.vertices
    }

    /// Returns for each vertex the point that it is, in ascending order. Points at which sheets of the
    /// surface touch come several times. Where two sheets touch along an edge whose vertices they cannot
    /// split, one has a new vertex in its middle, which is no point: `u32::MAX`. So are those of a
    /// [refined](SurfaceOptions::refine) surface.
    pub fn sources(&self) -> &[u32] {
        &self.sources
    }

    /// Returns the facets by their [`vertices`](Self::vertices): triangles that are counter-clockwise as
    /// seen from outside, in 2D edges that have the inside on their left.
    pub fn facets(&self) -> &[[u32; D]] {
        &self.facets
    }

    /// Returns the simplices that are inside, by points. They are those of the mesh, unless points were
    /// dropped or moved.
    pub fn solid(&self) -> &[[u32; N]] {
        &self.solid
    }

    /// Returns where each point lies.
    pub fn sides(&self) -> &[Side] {
        &self.sides
    }

    /// Returns the volume of the solid, in 2D the area. That of an open surface is closed by the facets that
    /// were left out.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Returns the area of the surface, in 2D the length of the curves.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns the number of connected surfaces, or curves in 2D. A ball with a cavity has two.
    pub fn components(&self) -> usize {
        self.topology.components
    }

    /// Returns the number of handles of all surfaces together: 0 for a sphere, 1 for a torus. It is 0 in
    /// 2D.
    pub fn genus(&self) -> usize {
        self.topology.genus
    }

    /// Returns the number of closed curves that bound the surface, and in 2D that of curves with two ends:
    /// 0 unless it is [open](SurfaceOptions::open).
    pub fn boundaries(&self) -> usize {
        self.topology.boundaries
    }

    /// Returns how it is known which side is inside.
    pub fn evidence(&self) -> Evidence {
        self.evidence
    }

    /// Returns how many pieces of the solid, and how many cavities, were dropped because they were
    /// smaller than [`min_part`](SurfaceOptions::min_part).
    pub fn dropped(&self) -> [usize; 2] {
        self.cleaning.dropped
    }

    /// Returns how many points were dropped because they are [isolated](SurfaceOptions::drop_isolated).
    pub fn isolated(&self) -> usize {
        self.cleaning.isolated
    }

    /// Returns the estimate of the noise: the median distance of the points from quadrics through their
    /// neighbours, in units of the distance between points. It is 0 where it was not needed, as for few
    /// points.
    pub fn noise(&self) -> f64 {
        self.cleaning.noise
    }

    /// Returns all points as they were [moved](SurfaceOptions::smooth), to which
    /// [`solid`](Self::solid) refers; `None` if they were not.
    pub fn moved_points(&self) -> Option<&[[f64; D]]> {
        self.moved.as_deref()
    }

    /// Returns whether every edge belongs to exactly two triangles, in opposite directions, and in 2D
    /// every vertex to one edge that ends there and one that starts there. Counts them; by
    /// construction, the result is `true` unless the surface has [boundaries](Self::boundaries).
    pub fn is_closed(&self) -> bool {
        boundary::is_closed(&self.facets)
    }
}
