//! Voronoi diagrams, the duals of Delaunay triangulations, and power diagrams, those of regular triangulations.

mod bounded;
mod cell;
mod flat;
mod frame;
mod hull;
mod polytope;
mod shapes;
mod weights;
mod window;

pub use cell::Cell;
pub use shapes::VoronoiShapes;
use shapes::{FacetMeasures, Row, Star};
pub(super) use shapes::{THIRD, place, ring};

use super::{
    Locator,
    complex::{Complex, Coordinates},
    locate::Place,
    queries::order_along_curve,
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    input::points::Points,
    mesh::Csr,
    mesh::Mesh,
    parallel::{self, Threads},
};
use frame::Frame;
use polytope::Polytope;
use weights::Weights;
use window::Window;
pub(super) use window::{Convex, check_box};

/// The number of cells that is worth handing to another thread.
const GRAIN: usize = 1 << 8;

/// The number of cells or simplices for which what they need is gathered at once: it is far apart
/// in memory, and the iterations of a loop that only reads it do not wait for each other.
const BLOCK: usize = 32;

/// What a Voronoi diagram is clipped to.
///
/// # Examples
///
/// ```
/// use gdel::{Clip, Voronoi};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let total = |clip| Ok::<f64, gdel::Error>(Voronoi::new(&mesh, &points, clip)?.volumes().iter().sum());
/// assert!(total(Clip::None)?.is_infinite());
/// assert!((total(Clip::Box([[-1.0, -1.0], [2.0, 2.0]]))? - 9.0).abs() < 1e-14);
/// assert!((total(Clip::Hull)? - 0.5).abs() < 1e-15);
/// let diamond = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
/// assert!((total(Clip::Convex(&diamond))? - 2.0).abs() < 1e-15);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Clip<'c, const D: usize = 3> {
    /// Nothing: cells of vertices on the convex hull are unbounded.
    #[default]
    None,
    /// The box with this lowest and this highest corner. If all points have the same coordinate along an
    /// axis, the box may have no extent along it other than that coordinate: cells then are measured
    /// within it.
    Box([[f64; D]; 2]),
    /// The convex hull of the points.
    Hull,
    /// A convex polygon or polyhedron with these corners, in any order.
    Convex(&'c [[f64; D]]),
}

/// The Voronoi diagram of the vertices of a mesh: for each vertex, the places that are nearer to it
/// than to any other.
///
/// Cells are computed when they are asked for; [`diagram`](Self::diagram) has all of them as
/// arrays. Their vertices are the circumcentres of the simplices, with the errors of
/// [`Mesh3::circumcenters`](crate::Mesh3::circumcenters). Cells whose vertices are not all within
/// what the diagram is clipped to are made from it by clipping with bisectors, so that no
/// circumcentre, however far away, makes them wrong. Facets that are empty because of a tie are
/// left out, exactly.
///
/// A mesh of [weighted](crate::Triangulator::regular3d) points has the power diagram: distances are power distances,
/// |x − p|² − *w*, and the vertices power centres, with errors below 2⁻³⁶ of how far they or the other sites are. A
/// site may be outside its own cell. The cells of hidden points are empty, and so are those that only touch what the
/// diagram is clipped to. A cell that has no inside because of a tie has the volume 0, and no facets if it is a single
/// place.
///
/// Points in a plane, or on a line, have cells of their own dimension, unless these are clipped to a
/// box that has an inside: polygons, or segments. Their facets then are edges with two vertices, or
/// ends with one, and areas and volumes are lengths and areas, or 1 and lengths. In a plane that is not
/// perpendicular to an axis, ties are decided up to rounding.
///
/// Everything is computed in coordinates that are neither large nor small, nor far from the origin
/// compared with the extent of the points, and scaled at the end. So volumes are right, or infinite
/// if they are above the range of `f64`; below it, a cell that is not empty has the smallest positive
/// number.
///
/// The cells that are bounded, those clipped to the hull, and those clipped to a box:
///
#[cfg_attr(doc, doc = concat!("<div>\n", include_str!("../../../docs/answers/voronoi.svg"), "</div>"))]
///
/// # Examples
///
/// ```
/// use gdel::{Clip, Voronoi};
///
/// let points: Vec<[f64; 3]> = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect();
/// let mesh = gdel::delaunay3d(&points)?;
/// let voronoi = Voronoi::new(&mesh, &points, Clip::Box([[-0.5; 3], [9.5; 3]]))?;
/// // All cells of a grid are cubes.
/// assert!(voronoi.volumes().iter().all(|volume| (volume - 1.0).abs() < 1e-12));
/// assert_eq!(voronoi.neighbors().of(555), [455, 545, 554, 556, 565, 655]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct Voronoi<'a, const D: usize = 3, const N: usize = 4> {
    /// With the points in the coordinates of the frame, if there is one.
    locator: Locator<'a, D, N>,
    /// The points as they were given.
    points: Points<'a, D>,
    frame: Option<Frame<D>>,
    /// The weights of the points. The locator has none.
    weights: Weights<'a>,
    window: Window<D>,
    /// The simplices around each vertex.
    stars: Csr,
    /// The circumcentre or power centre of each simplex, in the coordinates of the frame.
    vertices: Vec<[f64; D]>,
    /// The same in the coordinates of the points, if there is a frame.
    outer_vertices: Option<Vec<[f64; D]>>,
    /// Whether each vertex of the mesh is on the hull.
    on_hull: Vec<bool>,
    /// If the diagram is clipped to the hull, the facets that each vertex's cell meets, as places
    /// in the next list.
    hull_facets_of_cells: Csr,
    /// The facets of the hull as (simplex, opposite vertex).
    hull_facets: Vec<(usize, usize)>,
    /// The cells of points in a plane or on a line that are measured within it.
    flat: Option<Vec<Cell<D>>>,
}

/// The Voronoi diagram of the vertices of a 2D mesh.
///
/// # Examples
///
/// ```
/// use gdel::{Clip, Voronoi, Voronoi2};
///
/// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [4.0, 4.0], [2.0, 2.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let voronoi: Voronoi2 = Voronoi::new(&mesh, &points, Clip::None)?;
/// // The cell in the middle is a square that stands on a corner; the others are unbounded.
/// assert_eq!(voronoi.volumes()[4], 8.0);
/// assert_eq!(voronoi.volumes()[0], f64::INFINITY);
/// # Ok::<(), gdel::Error>(())
/// ```
pub type Voronoi2<'a> = Voronoi<'a, 2, 3>;

/// All cells of a Voronoi diagram as arrays, which [`Voronoi::diagram`] returns.
///
/// The facets between two cells are listed with each of both.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Diagram<const D: usize = 3> {
    /// The vertices: first the circumcentre or power centre of each simplex of the mesh, then those that clipping
    /// made. Of the centres not all are vertices of cells, if the diagram was clipped.
    pub vertices: Vec<[f64; D]>,
    /// The vertices of each facet, as in [`Cell::facets`].
    pub facets: Csr,
    /// For each facet the point on the other side; [`NONE`](crate::NONE) where the cell was
    /// clipped.
    pub neighbors: Vec<u32>,
    /// The area of each facet, its length in 2D; infinite for unbounded facets.
    pub areas: Vec<f64>,
    /// Where the facets of each point's cell start, and one more entry that says where the last
    /// ones end. Duplicates and hidden points have none.
    pub cells: Vec<usize>,
    /// The volume of each point's cell, its area in 2D: infinite for unbounded cells, 0 for empty
    /// ones.
    pub volumes: Vec<f64>,
    /// The centre of mass of each point's cell; NaN for unbounded and empty ones.
    pub centroids: Vec<[f64; D]>,
}

impl<const D: usize> Diagram<D> {
    /// Joins the cells of all points, some of whose vertices are among these.
    fn new(vertices: Vec<[f64; D]>, cells: impl IntoIterator<Item = Cell<D>>) -> Self {
        let mut diagram = Diagram { vertices, cells: vec![0], ..Diagram::default() };
        for cell in cells {
            let mut index = cell.simplices.clone();
            for (index, vertex) in index.iter_mut().zip(&cell.vertices) {
                if *index == NONE {
                    *index = diagram.vertices.len() as u32;
                    diagram.vertices.push(*vertex);
                }
            }
            for f in 0..cell.facets.len() as u32 {
                diagram.facets.push(cell.facets.of(f).iter().map(|&v| index[v as usize]));
            }
            diagram.neighbors.extend(&cell.neighbors);
            diagram.areas.extend(&cell.areas);
            diagram.cells.push(diagram.neighbors.len());
            diagram.volumes.push(cell.volume);
            diagram.centroids.push(cell.centroid);
        }
        diagram
    }
}

impl<'a, const D: usize, const N: usize> Voronoi<'a, D, N>
where
    Euclidean: VoronoiShapes<D, N>,
{
    /// Creates the Voronoi diagram of a mesh with its points, clipped to a box, a convex shape or the
    /// hull if wanted.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`], [`Error::NotFinite`], [`Error::BadWeight`] or [`Error::BrokenMesh`] as for
    /// [`Locator::new`](crate::Locator::new); [`Error::EmptyBox`] if the lowest corner of the box
    /// is not below the highest, or not finite, unless the points are as flat as the box;
    /// [`Error::ConstrainedMesh`], since such a mesh has a
    /// [bounded diagram](crate::Constrained2::bounded_voronoi); [`Error::BadOption`] if the corners of a convex shape are not finite, flat, or not all on their
    /// convex hull.
    pub fn new(mesh: &'a impl Mesh<D, N>, points: impl Into<Points<'a, D>>, clip: Clip<'_, D>) -> Result<Self, Error> {
        let points = points.into();
        let mut locator = Locator::new(mesh, points)?;
        locator.complex.check_unconstrained()?;
        let flat = flat::cells(&locator, &clip)?;
        let frame = points.bounds().and_then(Frame::of);
        let window = if flat.is_some() { Window::All } else { Window::new(clip, frame)? };
        let on_hull = on_hull(&locator.complex);
        let is_clipped_to_hull = matches!(window, Window::Hull);
        let nearest = (is_clipped_to_hull && !locator.complex.weights.is_empty())
            .then(|| hull::nearest_to_corners(&locator, &on_hull));
        let weights = std::mem::take(&mut locator.complex.weights);
        let weights = Weights { given: weights, scale: frame.map_or(1.0, |frame| frame.scale()) };
        if let Some(frame) = frame {
            let Locator { mut complex, flat, .. } = locator;
            complex.points = Coordinates::Owned(frame.inner_points(points));
            locator = Locator::of(complex, flat);
        }
        let complex = &locator.complex;
        let stars = Csr::stars(&complex.simplices, complex.points().len());
        let mut vertices = vec![[0.0; D]; complex.simplices.len()];
        parallel::for_chunks(Threads::All, &mut vertices, |start, chunk| {
            let mut corners = Vec::new();
            for (block, simplices) in chunk.chunks_mut(BLOCK).zip(complex.simplices[start..].chunks(BLOCK)) {
                corners.clear();
                corners.extend(simplices.iter().map(|simplex| complex.corners_of(simplex)));
                for (vertex, (simplex, corners)) in block.iter_mut().zip(simplices.iter().zip(&corners)) {
                    *vertex = weights.center(simplex, corners, points);
                }
            }
        });
        let (hull_facets_of_cells, hull_facets) = if is_clipped_to_hull {
            hull::hull_facets_of_cells(&locator, &weights, nearest.as_ref())
        } else {
            Default::default()
        };
        let outer_vertices = frame.map(|frame| vertices.iter().map(|&vertex| frame.outer(vertex)).collect());
        Ok(Voronoi {
            locator,
            points,
            frame,
            weights,
            window,
            stars,
            vertices,
            outer_vertices,
            on_hull,
            hull_facets_of_cells,
            hull_facets,
            flat,
        })
    }

    /// Returns the vertices of the diagram before it is clipped: the circumcentre, with weights the power centre, of
    /// each simplex of the mesh.
    pub fn vertices(&self) -> &[[f64; D]] {
        self.outer_vertices.as_ref().unwrap_or(&self.vertices)
    }

    /// Returns the cell of point `i`; an empty one for duplicates and hidden points.
    ///
    /// # Panics
    ///
    /// Panics if there is no point `i`.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Clip, Voronoi};
    ///
    /// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let voronoi = Voronoi::new(&mesh, &points, Clip::Box([[-1.0, -1.0], [4.0, 4.0]]))?;
    /// let cell = voronoi.cell(3);
    /// assert_eq!((cell.volume, cell.centroid), (9.0, [2.5, 2.5]));
    /// // Not point 0, from whose cell only a corner separates it.
    /// assert_eq!(cell.neighbors(), [1, 2]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn cell(&self, i: u32) -> Cell<D> {
        let mut worker = Worker::default();
        worker.block.gather(self, &[i]);
        self.find_cell(i, 0, &mut worker);
        worker.cell
    }

    /// Calls `f` with every point and its cell, and returns the results. Threads share the cells.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Clip, Voronoi};
    ///
    /// let points = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [3.0, 3.0], [1.0, 2.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let perimeters = Voronoi::new(&mesh, &points, Clip::Hull)?.map_cells(|_, cell| cell.areas.iter().sum::<f64>());
    /// assert!((perimeters[2] - (2.0 + 2f64.sqrt())).abs() < 1e-14);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// With weights:
    ///
    /// ```
    /// use gdel::{Clip, Triangulator, Voronoi};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [4.0, 4.0], [1.0, 1.0f64]];
    /// let mesh = Triangulator::new().regular2d(&points, &[4.0, 0.0, 0.0, 4.0, -9.0])?;
    /// let areas = Voronoi::new(&mesh, &points, Clip::Hull)?.map_cells(|_, cell| cell.volume);
    /// // The heavy corners have more than a quarter of the square, and the last point is hidden.
    /// assert_eq!(mesh.hidden, [4]);
    /// assert_eq!(areas, [5.75, 2.25, 2.25, 5.75, 0.0]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn map_cells<R: Send>(&self, f: impl Fn(u32, &Cell<D>) -> R + Sync) -> Vec<R> {
        // Cells that come one after the other share simplices, which are then at hand.
        let mut order = order_along_curve(self.locator.complex.points(), self.locator.key);
        let results = parallel::map_grains(Threads::All, order.len(), GRAIN, |range| {
            let mut worker = Worker::default();
            let mut results = Vec::with_capacity(range.len());
            for block in order[range].chunks(BLOCK) {
                worker.block.gather(self, block);
                for (place, &i) in (0..).zip(block) {
                    self.find_cell(i, place, &mut worker);
                    results.push(f(i, &worker.cell));
                }
            }
            results
        });
        let joined = results.into_iter().reduce(|mut joined, part| {
            joined.extend(part);
            joined
        });
        let mut results = joined.unwrap_or_default();
        // Each swap moves one result to the place of its point.
        for place in 0..results.len() {
            while order[place] as usize != place {
                let i = order[place] as usize;
                results.swap(place, i);
                order.swap(place, i);
            }
        }
        results
    }

    /// Returns the volume of each point's cell, its area in 2D: infinite for unbounded cells, 0 for
    /// empty ones.
    ///
    /// The sum of all is the volume of the box or the hull, as far as that contains all points,
    /// within 10⁻⁹ of it.
    pub fn volumes(&self) -> Vec<f64> {
        self.map_cells(|_, cell| cell.volume)
    }

    /// Returns the centre of mass of each point's cell; NaN for unbounded and empty cells.
    pub fn centroids(&self) -> Vec<[f64; D]> {
        self.map_cells(|_, cell| cell.centroid)
    }

    /// Returns the points that each point's cell shares a facet with, in ascending order.
    pub fn neighbors(&self) -> Csr {
        let mut neighbors = Csr::default();
        for of_cell in self.map_cells(|_, cell| cell.neighbors()) {
            neighbors.push(of_cell);
        }
        neighbors
    }

    /// Returns the points after one step of Lloyd's relaxation: each in the centre of mass of its
    /// cell, duplicates in that of their vertex. Points with unbounded or empty cells stay.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Clip, Voronoi};
    ///
    /// let mut points = vec![[0.1, 0.2], [0.9, 0.1], [0.3, 0.7], [0.8, 0.6], [0.5, 0.4f64]];
    /// for _ in 0..100 {
    ///     let mesh = gdel::delaunay2d(&points)?;
    ///     points = Voronoi::new(&mesh, &points, Clip::Box([[0.0, 0.0], [1.0, 1.0]]))?.relaxed();
    /// }
    /// // The areas have become more equal.
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let areas = Voronoi::new(&mesh, &points, Clip::Box([[0.0, 0.0], [1.0, 1.0]]))?.volumes();
    /// assert!(areas.iter().all(|area| (0.15..0.25).contains(area)));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn relaxed(&self) -> Vec<[f64; D]> {
        let complex = &self.locator.complex;
        let centroids = self.centroids();
        let relaxed = |i: usize| {
            let centroid = centroids[complex.representative(i as u32) as usize];
            if centroid.iter().all(|x| x.is_finite()) { centroid } else { self.points.get(i) }
        };
        (0..centroids.len()).map(relaxed).collect()
    }

    /// Returns all cells as arrays.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Clip, Voronoi};
    ///
    /// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let diagram = Voronoi::new(&mesh, &points, Clip::None)?.diagram();
    /// // The four edges of the cell in the middle.
    /// let facets = diagram.cells[4]..diagram.cells[5];
    /// assert_eq!(facets.len(), 4);
    /// assert!(facets.clone().all(|f| diagram.neighbors[f] < 4 && diagram.areas[f] == 0.5f64.sqrt()));
    /// // Unbounded edges have one vertex, that where they start.
    /// let facets = diagram.cells[0]..diagram.cells[1];
    /// assert!(facets.into_iter().all(|f| diagram.areas[f].is_infinite() == (diagram.facets.of(f as u32).len() == 1)));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn diagram(&self) -> Diagram<D> {
        Diagram::new(self.vertices().to_vec(), self.map_cells(|_, cell| cell.clone()))
    }

    /// Finds the cell of point `i`, which is at this place in the worker's block.
    fn find_cell(&self, i: u32, place: u32, worker: &mut Worker<D, N, <Euclidean as VoronoiShapes<D, N>>::Polytope>) {
        let Worker { block, cell, relative, star: scratch, polytope } = worker;
        cell.clear();
        if let Some(cells) = &self.flat {
            cell.clone_from(&cells[i as usize]);
            return;
        }
        let star = block.stars.of(place);
        let site = block.sites[place as usize];
        if star.is_empty() {
            if let (Some(flat), Window::Convex(_)) = (&self.locator.flat, &self.window)
                && self.locator.complex.duplicate_of[i as usize] == NONE
            {
                cell.neighbors.extend(flat.neighbors.of(i));
                let moment = self.clip_cell(i, cell, polytope);
                self.finish(cell, site, moment);
            }
            return;
        }
        let range = block.stars.offsets[place as usize]..block.stars.offsets[place as usize + 1];
        let (vertices, rows) = (&block.vertices[range.clone()], &block.rows[range]);
        relative.clear();
        relative.extend(vertices.iter().map(|&vertex| vector::minus(vertex, site)));
        let around = Around { star, rows, relative };
        let mut moment = self.find_facets(i, &around, cell, scratch);
        // With weights, a cell may be a single place, or beyond the hull.
        if cell.facets.is_empty() || self.is_beyond_hull(i, cell, moment, site, vertices[0]) {
            cell.clear();
            return;
        }
        if self.is_whole(i, vertices) {
            cell.vertices.extend_from_slice(vertices);
            cell.simplices.extend(star);
            cell.is_bounded = !self.on_hull[i as usize];
        } else {
            moment = self.clip_cell(i, cell, polytope);
        }
        self.finish(cell, site, moment);
    }

    /// Gives a cell its centre of mass, and the coordinates of the points.
    fn finish(&self, cell: &mut Cell<D>, site: [f64; D], moment: [f64; D]) {
        if !cell.is_bounded {
            cell.volume = f64::INFINITY;
        } else if cell.volume > self.noise(cell, site) {
            cell.centroid = vector::plus(site, vector::times(1.0 / cell.volume, moment));
        } else if !self.weights.is_empty() {
            cell.volume = 0.0;
        }
        if let Some(frame) = &self.frame {
            frame.restore(cell);
        }
    }

    /// Returns a bound of what errors can make of a volume of 0, as a cell can have with weights: because of a tie, all
    /// of it is then within a facet. Without weights, that is 0.
    fn noise(&self, cell: &Cell<D>, site: [f64; D]) -> f64 {
        if self.weights.is_empty() {
            return 0.0;
        }
        let reach = cell.vertices.iter().map(|&p| vector::norm(vector::minus(p, site))).fold(0.0, f64::max);
        reach * cell.areas.iter().sum::<f64>() * (1.0 / (1u64 << 36) as f64)
    }

    /// Returns whether the cell of vertex `v`, which has this volume and this integral of the coordinates, is beyond
    /// the hull to which the diagram is clipped.
    fn is_beyond_hull(&self, v: u32, cell: &Cell<D>, moment: [f64; D], site: [f64; D], vertex: [f64; D]) -> bool {
        if self.weights.is_empty()
            || !matches!(self.window, Window::Hull)
            || !self.hull_facets_of_cells.of(v).is_empty()
        {
            return false;
        }
        // It is all inside or all outside, and unbounded if its site is on the hull.
        let inner =
            if cell.volume > 0.0 { vector::plus(site, vector::times(1.0 / cell.volume, moment)) } else { vertex };
        self.on_hull[v as usize]
            || inner.iter().any(|x| !x.is_finite())
            || matches!(self.locator.place(inner, None), Ok(Some(Place { beyond: Some(_), .. })))
    }

    /// Returns whether clipping leaves the cell of vertex `v`, with these vertices, as it is.
    fn is_whole(&self, v: u32, vertices: &[[f64; D]]) -> bool {
        match &self.window {
            Window::All => true,
            Window::Hull => self.hull_facets_of_cells.of(v).is_empty(),
            Window::Convex(shape) => !self.on_hull[v as usize] && vertices.iter().all(|&vertex| shape.contains(vertex)),
        }
    }

    /// Finds the facets of the cell of vertex `v` before it is clipped, as places in its star, and
    /// their measures. Returns the integral of the coordinates over the cell.
    fn find_facets(&self, v: u32, around: &Around<'_, D, N>, cell: &mut Cell<D>, scratch: &mut Star) -> [f64; D] {
        let &Around { star, rows, relative } = around;
        let mut moment = [0.0; D];
        let site = self.locator.complex.point(v);
        let mut reach = relative.iter().fold(0.0, |max, &p| vector::squared_norm(p).max(max));
        if !self.weights.is_empty() {
            // What the errors of power centres are relative to, too. Without weights it is less.
            let others = rows.iter().flat_map(|(simplex, _)| simplex).map(|&w| self.locator.complex.point(w));
            reach = others.map(|p| vector::squared_norm(vector::minus(p, site))).fold(reach, f64::max);
        }
        let reach = reach.sqrt();
        // Far more than the errors of all these, which are below 2⁻³⁷ times the circumradius, and
        // what rounding to coordinates costs.
        let error = reach * (1.0 / (1u64 << 30) as f64) + vector::norm(site) * (1.0 / (1u64 << 48) as f64);
        // More than what errors can make of an area or length of 0, for each vertex of the facet.
        let tiny = if D == 2 { error } else { error * reach } + f64::MIN_POSITIVE;
        let Cell { facets, neighbors, areas, volume, .. } = cell;
        <Euclidean as VoronoiShapes<D, N>>::push_rings(v, star, rows, scratch, facets, |a, ring, is_closed| {
            let measures = Euclidean::facet_measures(relative, ring);
            let is_facet =
                measures.area > tiny * ring.len() as f64 || self.is_facet(around, error, ring, is_closed, [v, a]);
            if is_facet {
                neighbors.push(a);
                areas.push(if is_closed { measures.area } else { f64::INFINITY });
                *volume += self.pyramid([v, a], &measures);
                moment = vector::plus(moment, measures.moment);
            }
            is_facet
        });
        moment
    }

    /// Returns the volume between the site `v` and its facet towards `a`, which has these measures.
    ///
    /// Vertices that are far away, as those of nearly flat simplices, have coordinates from which it cannot be computed: it
    /// would be the difference of much larger numbers, and negative at times. Without weights, the facet is halfway to `a`.
    fn pyramid(&self, [v, a]: [u32; 2], measures: &FacetMeasures<D>) -> f64 {
        if !self.weights.is_empty() {
            return measures.volume;
        }
        let [site, other] = [v, a].map(|v| self.locator.complex.point(v));
        let height = 0.5 * vector::norm(vector::minus(other, site));
        let pyramid = height * measures.area / D as f64;
        let is_right = (measures.volume - pyramid).abs() <= pyramid * (1.0 / (1u64 << 20) as f64);
        if is_right { measures.volume } else { pyramid }
    }

    /// Returns whether the facet that is dual to an edge has an area, in 2D a length. It has none
    /// if ties make so many of its vertices coincide that at most two are left, in 2D one.
    #[cold]
    fn is_facet(
        &self,
        &Around { star, relative, .. }: &Around<'_, D, N>,
        error: f64,
        ring: &[u32],
        is_closed: bool,
        [v, a]: [u32; 2],
    ) -> bool {
        let complex = &self.locator.complex;
        let are_distinct = |&[t, u]: &[u32; 2]| {
            let [p, q] = [t, u].map(|place| relative[place as usize]);
            if vector::squared_norm(vector::minus(p, q)) > error * error {
                return true;
            }
            let [t, u] = [t, u].map(|place| star[place as usize] as usize);
            let apex = complex.simplices[u].into_iter().find(|w| !complex.simplices[t].contains(w));
            apex.is_some_and(|w| !self.weights.is_tied(&complex.simplices[t], w, self.points))
        };
        let edges = ring.windows(2).map(|pair| [pair[0], pair[1]]);
        let last = ring.last().zip(ring.first()).filter(|_| is_closed && ring.len() > 2).map(|(&t, &u)| [t, u]);
        let distinct = edges.chain(last).filter(are_distinct).take(3).count();
        if is_closed {
            return distinct >= <Euclidean as VoronoiShapes<D, N>>::FACET_EDGES;
        }
        // Without an edge, an unbounded facet has two rays from one vertex, which coincide if the
        // facets of the hull share a plane.
        distinct > 0 || !self.hull_is_flat_at(star, ring, [v, a])
    }

    /// Returns whether the two facets of the hull at an edge, around which these simplices of a
    /// star are, share a plane.
    fn hull_is_flat_at(&self, star: &[u32], ring: &[u32], edge: [u32; 2]) -> bool {
        let complex = &self.locator.complex;
        // In 2D, the edge is all of the hull's facet.
        if D == 2 {
            return false;
        }
        let mut hull_facets = ring.iter().flat_map(|&place| {
            let t = star[place as usize];
            let simplex = &complex.simplices[t as usize];
            let is_outer = move |&k: &usize| !edge.contains(&simplex[k]) && complex.neighbors[t as usize][k] == NONE;
            (0..N).filter(is_outer).map(move |k| facet(simplex, k))
        });
        let (Some(one), Some(other)) = (hull_facets.next(), hull_facets.next()) else { return false };
        let one = one.map(|v| complex.point(v));
        other.into_iter().all(|v| Euclidean::side(&one, complex.point(v)) == 0)
    }

    /// Makes the cell of vertex `v` from the box around what it is clipped to, by clipping it with the
    /// bisectors of the cell's facets, which it replaces, and with the facets of that. Returns
    /// the integral of the coordinates over the cell.
    fn clip_cell(
        &self,
        v: u32,
        cell: &mut Cell<D>,
        polytope: &mut <Euclidean as VoronoiShapes<D, N>>::Polytope,
    ) -> [f64; D] {
        let complex = &self.locator.complex;
        let site = complex.point(v);
        let (bounds, planes) = match &self.window {
            Window::Convex(shape) => (shape.bounds, &shape.planes[..]),
            _ => (self.locator.bounds, &[][..]),
        };
        // Relative to the site.
        polytope.reset(bounds.map(|corner| vector::minus(corner, site)), NONE);
        let bisector = |&neighbor: &u32| {
            let to = vector::minus(complex.point(neighbor), site);
            (self.weights.bisector(v, neighbor, to), to, neighbor)
        };
        let mut bisectors: Vec<_> = cell.neighbors.iter().map(bisector).collect();
        // The nearest ones first: what these leave, the others cut less of.
        bisectors.sort_unstable_by(|(one, ..), (other, ..)| one.total_cmp(other));
        for (offset, normal, neighbor) in bisectors {
            polytope.clip(normal, offset, neighbor);
        }
        for &(normal, offset) in planes {
            polytope.clip(normal, offset - vector::dot(normal, site), NONE);
        }
        if let Window::Hull = self.window {
            for &f in self.hull_facets_of_cells.of(v) {
                let (t, k) = self.hull_facets[f as usize];
                let corners = facet(&complex.simplices[t], k).map(|w| vector::minus(complex.point(w), site));
                let (normal, offset) = Euclidean::plane(&corners);
                polytope.clip(normal, offset, NONE);
            }
        }
        cell.clear();
        let vertices = polytope.vertices();
        let mut moment = [0.0; D];
        polytope.for_facets(|corners, name| {
            let measures = Euclidean::facet_measures(vertices, corners);
            // Where a bisector only touches the rest of the cell, nothing is left of the facet.
            if measures.area > 0.0 {
                cell.facets.push(corners.iter().copied());
                cell.neighbors.push(name);
                cell.areas.push(measures.area);
                cell.volume += measures.volume;
                moment = vector::plus(moment, measures.moment);
            }
        });
        cell.vertices.extend(vertices.iter().map(|&vertex| vector::plus(vertex, site)));
        cell.simplices.resize(cell.vertices.len(), NONE);
        // With weights, a cell may only touch what it is clipped to.
        if !self.weights.is_empty() && cell.volume <= self.noise(cell, site) {
            cell.clear();
        }
        moment
    }
}

/// Returns for each point whether it is a vertex on the hull.
fn on_hull<const D: usize, const N: usize>(complex: &Complex<'_, D, N>) -> Vec<bool>
where
    Euclidean: Geometry<D, N>,
{
    let mut on_hull = vec![false; complex.points().len()];
    for (simplex, neighbors) in complex.simplices.iter().zip(&*complex.neighbors) {
        for k in (0..N).filter(|&k| neighbors[k] == NONE) {
            facet(simplex, k).into_iter().for_each(|v| on_hull[v as usize] = true);
        }
    }
    on_hull
}

/// The star of a vertex.
struct Around<'a, const D: usize, const N: usize> {
    /// The simplices, in ascending order.
    star: &'a [u32],
    /// The row of each of them.
    rows: &'a [Row<N>],
    /// The circumcentre of each of them, relative to the vertex.
    relative: &'a [[f64; D]],
}

/// Memory that is used again from one cell to the next.
#[derive(Debug)]
struct Worker<const D: usize, const N: usize, P> {
    block: Block<D, N>,
    cell: Cell<D>,
    /// The circumcentres of the star, relative to its vertex.
    relative: Vec<[f64; D]>,
    star: Star,
    polytope: P,
}

impl<const D: usize, const N: usize, P: Default> Default for Worker<D, N, P> {
    fn default() -> Self {
        Worker {
            block: Block::default(),
            cell: Cell::default(),
            relative: Vec::new(),
            star: Star::default(),
            polytope: P::default(),
        }
    }
}

/// The input of the cells of a few points.
#[derive(Debug, Default)]
struct Block<const D: usize, const N: usize> {
    sites: Vec<[f64; D]>,
    /// Where each star is in the list of all.
    ranges: Vec<[usize; 2]>,
    stars: Csr,
    /// The circumcentre of each simplex of the stars.
    vertices: Vec<[f64; D]>,
    /// The row of each simplex of the stars.
    rows: Vec<Row<N>>,
}

impl<const D: usize, const N: usize> Block<D, N> {
    fn gather(&mut self, voronoi: &Voronoi<'_, D, N>, points: &[u32]) {
        let Block { sites, ranges, stars, vertices, rows } = self;
        let (complex, offsets) = (&voronoi.locator.complex, &voronoi.stars.offsets);
        sites.clear();
        sites.extend(points.iter().map(|&i| complex.point(i)));
        ranges.clear();
        ranges.extend(points.iter().map(|&i| [offsets[i as usize], offsets[i as usize + 1]]));
        stars.clear();
        for &[start, end] in &*ranges {
            stars.push(voronoi.stars.indices[start..end].iter().copied());
        }
        vertices.clear();
        vertices.extend(stars.indices.iter().map(|&t| voronoi.vertices[t as usize]));
        rows.clear();
        rows.extend(stars.indices.iter().map(|&t| complex.row(t as usize)));
    }
}
