//! Alpha shapes (Edelsbrunner and Mücke, *Three-dimensional alpha shapes*, 1994).

mod complex;
mod edges;
mod flat;
mod groups;
mod rounding;
mod singular;
mod values;

pub use complex::{AlphaComplex, FaceClass};
pub use edges::AlphaEdges;
pub use singular::{SingularEdges, singular};

use super::{
    complex::Complex,
    flat::Flat,
    sorted::{Sorted, inverse},
};
use crate::{
    error::Error,
    geometry::{Euclidean, facet, radius_rounded_up},
    index::NONE,
    input::points::Points,
    mesh::Mesh,
    parallel::{self, Threads},
};
use edges::{Edges, is_listed, largest, smallest};
use flat::FlatCells;
use groups::Groups;
use std::sync::OnceLock;
use values::Radii;

/// The alpha shapes of the vertices of a mesh, for all radii alpha.
///
/// The *alpha complex* of a radius consists of the simplices and faces of the triangulation that
/// have an empty sphere of this radius or less through their vertices, and of their faces. The
/// *alpha shape* is the space that it fills. With a growing radius it goes from the points to their
/// convex hull. A radius, and not its square as in CGAL, is what every function here takes and
/// returns.
///
/// Points in a plane of space, or on a line, have no solid. In the place of simplices are the triangles of
/// the plane, or the edges of the line: they are [singular](FaceClass::Singular) faces, alpha is found for
/// them, their components count, and [`surface`](AlphaComplex::surface) has both of their sides if they are
/// facets. For an infinite alpha that is the convex hull.
///
/// Which simplices and faces belong to a complex is decided exactly, for all `f64` alpha. Radii
/// that are returned have a relative error below 10⁻¹⁰, if nothing else is said.
///
/// The shapes of a ring and a disk for three radii:
///
#[cfg_attr(doc, doc = concat!("<div>\n", include_str!("../../../docs/answers/alpha.svg"), "</div>"))]
///
/// # Examples
///
/// ```
/// use gdel::AlphaShape;
///
/// // The points of a grid, without those inside a tunnel.
/// let points: Vec<[f64; 3]> = (0..1000)
///     .map(|i| [i % 10, i / 10 % 10, i / 100])
///     .filter(|[x, y, _]| !((3..7).contains(x) && (3..7).contains(y)))
///     .map(|p| p.map(f64::from))
///     .collect();
/// let mesh = gdel::delaunay3d(&points)?;
/// let shape = AlphaShape::new(&mesh, &points)?;
/// // The smallest alpha whose solid is in one piece and has all points.
/// let alpha = shape.find_alpha(1).unwrap();
/// assert!((alpha - 0.75f64.sqrt()).abs() < 1e-15);
///
/// let complex = shape.at(alpha)?;
/// let volumes: Vec<f64> = mesh.volumes(&points).collect();
/// let volume: f64 = complex.solid().map(|t| volumes[t]).sum();
/// // Half a square is left in each corner of the tunnel.
/// assert!((volume - 9.0 * (81.0 - 25.0 + 4.0 * 0.5)).abs() < 1e-9);
/// // A closed surface: every edge has as many triangles in one direction as in the other.
/// assert!(complex.surface().count() > 0);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct AlphaShape<const D: usize = 3, const N: usize = 4> {
    /// The sorted mesh. The lists below have its order.
    radii: Radii<D, N>,
    /// The scaled square of the circumradius of each simplex; NaN if it is not known. The radii
    /// below have the same form.
    simplices: Vec<f64>,
    /// The radius of the smallest sphere of each facet; infinite if the sphere contains another
    /// vertex. A facet is listed with the simplex of the lower index.
    facets: Vec<f64>,
    /// The edges, computed at the first request.
    edges: OnceLock<Edges>,
    /// The radii from which on each vertex is regular, and interior, computed at the first request.
    vertices: OnceLock<Vec<[f64; 2]>>,
    /// What points in a plane or on a line have instead of simplices.
    flat: Option<FlatCells<D>>,
    /// The simplices in groups of exactly the same circumradius, in ascending order.
    groups: OnceLock<Groups>,
}

/// The alpha shapes of the vertices of a 2D mesh.
///
/// # Examples
///
/// ```
/// use gdel::{AlphaShape, AlphaShape2};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [5.0, 0.0], [6.0, 0.0], [5.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let shape: AlphaShape2 = AlphaShape::new(&mesh, &points)?;
/// let complex = shape.at(1.0)?;
/// assert_eq!(complex.solid().count(), 3);
/// assert_eq!(complex.components().1, 2);
/// # Ok::<(), gdel::Error>(())
/// ```
pub type AlphaShape2 = AlphaShape<2, 3>;

/// From which radii on a face of the triangulation is part of the alpha complex, and how.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let shape = gdel::AlphaShape::new(&mesh, &points)?;
/// let (edge, interval) = shape.facets().find(|(edge, _)| edge.contains(&0)).unwrap();
/// // Half its length; the circumradius of the triangle; never, as it is on the hull.
/// assert!((interval.singular - 1.0).abs() < 1e-10);
/// assert!((interval.regular - 2f64.sqrt()).abs() < 1e-10);
/// assert_eq!(interval.interior, f64::INFINITY);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Interval {
    /// The radius from which on the face is part of the complex: its value in the filtration. That
    /// of its own smallest sphere, if this contains no other vertex, else the same as `regular`.
    pub singular: f64,
    /// The radius from which on the face belongs to a larger one that is part of the complex.
    pub regular: f64,
    /// The radius from which on all simplices around the face are part of the complex; infinite on
    /// the hull.
    pub interior: f64,
}

impl<const D: usize, const N: usize> AlphaShape<D, N>
where
    Euclidean: AlphaEdges<D, N>,
{
    /// Computes the filtration of a mesh with its points: from which radius on each simplex and
    /// each facet is part of the alpha complex. The values of the edges of a 3D mesh and of
    /// vertices, which take longer, are computed when they are first asked for.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`], [`Error::NotFinite`] or [`Error::BrokenMesh`] as for
    /// [`Locator::new`](crate::Locator::new).
    pub fn new<'a>(mesh: &'a impl Mesh<D, N>, points: impl Into<Points<'a, D>>) -> Result<Self, Error> {
        let given = Complex::delaunay(mesh, points.into())?;
        let flat = Flat::new(&given)?;
        let radii = Radii::new(Sorted::new(&given), rounding::UNIT);
        let flat = flat.map(|flat| FlatCells::new(&flat, &radii));
        let complex = &radii.mesh.complex;
        let mut simplices = vec![(0.0, [false; N]); complex.simplices.len()];
        parallel::for_chunks(Threads::All, &mut simplices, |start, chunk| {
            for (simplex, t) in chunk.iter_mut().zip(start..) {
                *simplex = radii.simplex(t);
            }
        });
        let facets = parallel::map_ranges(Threads::All, complex.simplices.len(), |range| {
            // Two of each simplex, and a few more on the hull.
            let mut facets = Vec::with_capacity(range.len() / 16 * 33);
            let listed = range.flat_map(|t| (0..N).filter(move |&k| is_listed(complex, t, k)).map(move |k| (t, k)));
            let own = listed.map(|(t, k)| {
                let across = complex.across(t, k).map(|across| (across, complex.facet_towards(across, t)));
                let is_attached = |(t, k): (usize, usize)| simplices[t].1.get(k).is_some_and(|&is_beyond| is_beyond);
                if is_attached((t, k)) || across.is_some_and(is_attached) {
                    return f64::INFINITY;
                }
                radii.facet(facet(&complex.simplices[t], k))
            });
            facets.extend(own);
            facets
        });
        let facets = parallel::joined(facets);
        let simplices: Vec<f64> = simplices.into_iter().map(|(squared, _)| squared).collect();
        let (edges, vertices, groups) = Default::default();
        Ok(AlphaShape { radii, simplices, facets, edges, vertices, flat, groups })
    }

    /// Returns the simplices and faces that are part of the complex for a radius.
    ///
    /// # Errors
    ///
    /// [`Error::BadAlpha`] if alpha is negative or NaN.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let shape = gdel::AlphaShape::new(&mesh, &points)?;
    /// assert_eq!(shape.at(1.4)?.solid().count(), 0);
    /// assert_eq!(shape.at(1.5)?.solid().count(), 1);
    /// assert_eq!(shape.at(-1.0).unwrap_err(), gdel::Error::BadAlpha);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn at(&self, alpha: f64) -> Result<AlphaComplex<'_, D, N>, Error> {
        if alpha.is_nan() || alpha < 0.0 {
            return Err(Error::BadAlpha);
        }
        Ok(AlphaComplex::new(self, alpha))
    }

    /// Returns the smallest alpha whose solid has all vertices and at most so many components,
    /// which hang together across facets; `None` if `components` is 0 or there are less than two vertices.
    ///
    /// The result is not rounded down: the complex at this alpha has the promised properties. Where many
    /// radii are equal up to rounding, [`auto_alpha`](Self::auto_alpha) takes all of them.
    pub fn find_alpha(&self, components: usize) -> Option<f64> {
        Some(self.radius_rounded_up(self.cell(self.first_with(components)?).0))
    }

    /// Returns the radii at which a simplex or a face becomes part of the complex, in ascending
    /// order, each once. They are rounded up, by at most 10⁻⁹ of their value, so that what becomes
    /// part of the complex at one of them is in [`at`](Self::at) it.
    ///
    /// # Examples
    ///
    /// ```
    /// // A square: its sides, and the two triangles, whose common edge is a diameter of their circle.
    /// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let critical = gdel::AlphaShape::new(&mesh, &points)?.critical_values();
    /// assert_eq!(critical.len(), 2);
    /// assert!((critical[0] - 1.0).abs() < 1e-9 && (critical[1] - 2f64.sqrt()).abs() < 1e-9);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn critical_values(&self) -> Vec<f64> {
        let complex = &self.radii.mesh.complex;
        let simplices = self.cells().map(|(vertices, r)| (face(vertices), r));
        let facets =
            self.listed_facets().zip(&self.facets).map(|((t, k), &r)| (face(&facet(&complex.simplices[t], k)), r));
        let Edges { edges, own, .. } = self.edge_values();
        let edges = edges.iter().zip(own).map(|(edge, &r)| (face(edge), r));
        let own: Vec<([u32; 4], f64)> =
            simplices.chain(facets).chain(edges).filter(|&(_, r)| r < f64::INFINITY || r.is_nan()).collect();
        let vertices = |i: u32| {
            let (face, squared) = &own[i as usize];
            let count = face.iter().take_while(|&&v| v != NONE).count();
            (&face[..count], *squared)
        };
        let groups = Groups::new(
            own.len(),
            |i| vertices(i).1,
            |i| self.radii.precise(vertices(i).0),
            |i, j| self.radii.compare(vertices(i), vertices(j)),
        );
        groups.firsts().map(|i| self.radius_above(vertices(i))).collect()
    }

    /// Returns a radius that is at most 10⁻⁹ of its value above that of a face.
    fn radius_above(&self, (face, squared): (&[u32], f64)) -> f64 {
        if squared.is_nan() { self.radius_rounded_up(face) } else { self.radius(squared) * (1.0 + 2e-10) }
    }

    /// Returns the radius of a face, rounded up.
    fn radius_rounded_up(&self, face: &[u32]) -> f64 {
        let points: Vec<[f64; D]> = face.iter().map(|&v| self.radii.mesh.complex.point(v)).collect();
        radius_rounded_up::<D, N>(&points)
    }

    /// Returns the vertices and the scaled squared radius of simplex `t`, or of what is in its place.
    fn cell(&self, t: usize) -> (&[u32], f64) {
        match &self.flat {
            Some(flat) => flat.cell(t),
            None => (&self.radii.mesh.complex.simplices[t], self.simplices[t]),
        }
    }

    /// Returns the vertices and the scaled squared radii of the simplices, or of what is in their place.
    fn cells(&self) -> impl Iterator<Item = (&[u32], f64)> {
        let simplices = self.radii.mesh.complex.simplices.iter().map(|simplex| &simplex[..]);
        let flat = self.flat.iter().flat_map(FlatCells::cells);
        simplices.zip(self.simplices.iter().copied()).chain(flat)
    }

    /// Returns a simplex, or what is in its place, with whose radius the solid has all vertices and at most so many
    /// components.
    fn first_with(&self, components: usize) -> Option<usize> {
        match &self.flat {
            Some(flat) => flat.first_with(self.groups(), components),
            None => self.groups().first_with(components, &self.radii.mesh.complex),
        }
    }

    /// Returns the radius from which on each simplex is part of the complex, its circumradius.
    pub fn simplices(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        let Sorted { complex, places, .. } = &self.radii.mesh;
        places.iter().map(|&t| self.radius_of(&complex.simplices[t as usize], self.simplices[t as usize]))
    }

    /// Returns all facets, with the radii from which on they are part of the complex. They are
    /// counter-clockwise as seen from outside the simplex with the lower index, and in 2D have the
    /// triangle with the lower index on the left.
    pub fn facets(&self) -> impl Iterator<Item = ([u32; D], Interval)> + '_ {
        let facets = self.listed_facets().zip(&self.facets).map(|((t, k), &own)| {
            let complex = &self.radii.mesh.complex;
            let vertices = self.given_facet(t, k);
            let radius = |t: usize| self.radius_of(&complex.simplices[t], self.simplices[t]);
            let (one, other) = (radius(t), complex.across(t, k).map(radius));
            let regular = other.map_or(one, |other| one.min(other));
            let interior = other.map_or(f64::INFINITY, |other| one.max(other));
            let own = if own == f64::INFINITY { own } else { self.radius_of(&facet(&complex.simplices[t], k), own) };
            (vertices, Interval { singular: own.min(regular), regular, interior })
        });
        let never = f64::INFINITY;
        facets.chain(self.flat_facets().map(move |(t, vertices)| {
            let (cell, squared) = self.cell(t);
            (vertices, Interval { singular: self.radius_of(cell, squared), regular: never, interior: never })
        }))
    }

    /// Returns the facets that points in a plane or on a line have instead of simplices, as their vertices were
    /// numbered in the mesh that was given.
    fn flat_facets(&self) -> impl Iterator<Item = (usize, [u32; D])> + '_ {
        let facets = self.flat.iter().flat_map(FlatCells::facets);
        facets.map(|(t, facet)| (t, self.radii.mesh.given(facet)))
    }

    /// Returns all vertices, with the radii from which on they are part of the complex: always, as
    /// singular ones.
    pub fn vertices(&self) -> impl Iterator<Item = (u32, Interval)> + '_ {
        let values = self.vertex_values();
        self.given_vertices().map(|(i, v)| {
            let [regular, interior] = values[v].map(|squared| self.radius(squared));
            (i, Interval { singular: 0.0, regular, interior })
        })
    }

    /// Returns the vertices in ascending order, as they were numbered in the mesh that was given and
    /// as they are here.
    fn given_vertices(&self) -> impl Iterator<Item = (u32, usize)> {
        let Sorted { complex, points, .. } = &self.radii.mesh;
        let ranks = (0..).zip(inverse(points)).map(|(i, v)| (i, v as usize));
        ranks.filter(|&(_, v)| complex.duplicate_of[v] == NONE)
    }

    /// Returns the vertices of facet `k` of simplex `t` as they were numbered in the mesh that was
    /// given, in their order in the simplex that had the lower index there.
    fn given_facet(&self, t: usize, k: usize) -> [u32; D] {
        let Sorted { complex, simplices, .. } = &self.radii.mesh;
        let across = complex.across(t, k).filter(|&across| simplices[across] < simplices[t]);
        let (t, k) = match across.map(|across| (across, complex.facet_towards(across, t))) {
            Some((across, facet)) if facet < N => (across, facet),
            _ => (t, k),
        };
        self.radii.mesh.given(facet(&complex.simplices[t], k))
    }

    /// Returns the radius whose scaled square is given.
    fn radius(&self, squared: f64) -> f64 {
        squared.sqrt() / self.radii.scale
    }

    /// Returns the radius of a face whose scaled square is given, also if that is not known.
    fn radius_of(&self, face: &[u32], squared: f64) -> f64 {
        if squared.is_nan() { self.radius_above((face, squared)) } else { self.radius(squared) }
    }

    /// Returns the facets as (simplex, opposite vertex), each with the simplex of the lower index.
    fn listed_facets(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let complex = &self.radii.mesh.complex;
        (0..complex.simplices.len())
            .flat_map(move |t| (0..N).filter(move |&k| is_listed(complex, t, k)).map(move |k| (t, k)))
    }

    /// Returns the simplices in groups of the same radius.
    fn groups(&self) -> &Groups {
        self.groups.get_or_init(|| {
            let simplex = |t: u32| self.cell(t as usize);
            Groups::new(
                self.cells().count(),
                |t| simplex(t).1,
                |t| self.radii.precise(simplex(t).0),
                |t, u| self.radii.compare(simplex(t), simplex(u)),
            )
        })
    }

    /// Returns the edges with their squared radii, which take longer than all others.
    fn edge_values(&self) -> &Edges {
        self.edges.get_or_init(|| match &self.flat {
            // In 2D the edges are facets.
            Some(flat) if D == 3 => flat.edges(&self.radii),
            _ => Euclidean::edges(&self.radii, &self.simplices, &self.facets),
        })
    }

    /// Returns the squared radii from which on each vertex is regular, and interior.
    fn vertex_values(&self) -> &[[f64; 2]] {
        self.vertices.get_or_init(|| self.find_vertex_values())
    }

    fn find_vertex_values(&self) -> Vec<[f64; 2]> {
        let complex = &self.radii.mesh.complex;
        // A vertex without simplices is never within any.
        let interior = if complex.simplices.is_empty() { f64::INFINITY } else { 0.0 };
        let mut values = vec![[f64::INFINITY, interior]; complex.points().len()];
        for (simplex, squared) in self.cells() {
            for &v in simplex {
                let [regular, interior] = &mut values[v as usize];
                *regular = smallest(*regular, squared);
                if self.flat.is_none() {
                    *interior = largest(*interior, squared);
                }
            }
        }
        for ((t, k), &own) in self.listed_facets().zip(&self.facets) {
            for v in facet(&complex.simplices[t], k) {
                let [regular, interior] = &mut values[v as usize];
                *regular = smallest(*regular, own);
                if complex.across(t, k).is_none() {
                    *interior = f64::INFINITY;
                }
            }
        }
        let Edges { edges, own, .. } = self.edge_values();
        for (edge, &own) in edges.iter().zip(own) {
            for &v in edge {
                values[v as usize][0] = smallest(values[v as usize][0], own);
            }
        }
        values
    }
}

impl AlphaShape<3, 4> {
    /// Returns all edges of a 3D mesh, with the radii from which on they are part of the complex.
    /// (In 2D they are the facets.)
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0f64]];
    /// let mesh = gdel::delaunay3d(&points)?;
    /// let shape = gdel::AlphaShape::new(&mesh, &points)?;
    /// let shortest = shape.edges().map(|(_, interval)| interval.singular).fold(f64::INFINITY, f64::min);
    /// assert!((shortest - 1.0).abs() < 1e-10);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn edges(&self) -> impl ExactSizeIterator<Item = ([u32; 2], Interval)> + '_ {
        let edges = self.edge_values();
        edges.edges.iter().enumerate().map(|(e, &edge)| {
            let [regular, interior] = [edges.regular[e], edges.interior[e]].map(|squared| self.radius(squared));
            let own = edges.own[e];
            let own = if own == f64::INFINITY { own } else { self.radius_of(&edge, own) };
            (given_edge(&self.radii.mesh, edge), Interval { singular: own.min(regular), regular, interior })
        })
    }
}

/// Returns an edge as its vertices were numbered in the mesh that was given, the lower one first.
fn given_edge(mesh: &Sorted<3, 4>, edge: [u32; 2]) -> [u32; 2] {
    let [v, w] = mesh.given(edge);
    [v.min(w), v.max(w)]
}

/// Returns the vertices of a face with [`NONE`](crate::NONE) in the unused places.
fn face(vertices: &[u32]) -> [u32; 4] {
    let mut face = [NONE; 4];
    face[..vertices.len()].copy_from_slice(vertices);
    face
}
