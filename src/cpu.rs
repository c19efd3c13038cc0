//! The CPU engine: Bowyer–Watson insertion (1981), point by point, with exact predicates.
//!
//! `points → lattice → insertion order → insert → drop the ghosts → input indices → mesh`
//!
//! All of it is generic over the number `D` of coordinates; [`Incremental`] and [`Insert`] are what
//! the dimensions supply.

use crate::{
    backend::Backend,
    dimension::Dimension,
    error::Error,
    input::{
        lattice::Lattice,
        order::{Curve, Distinct, Order, insertion_order},
        points::Points,
    },
    mesh::MeshInfo,
    options::Options,
    predicates::filter::PredicateContext,
    stats::{Phase, Stats, Stopwatch},
};

/// The mesh of `D` dimensions.
pub type MeshOf<const D: usize> = <Dimension<D> as Incremental<D>>::Mesh;

/// What the CPU engine of a dimension has of its own.
pub trait Incremental<const D: usize> {
    /// The result.
    type Mesh: MeshInfo;
    /// The triangulation under construction.
    type Triangulation: Insert<D>;

    /// The maximum number of points.
    const MAX_POINTS: usize;
    /// The curve along which points are inserted.
    const CURVE: Curve<D>;

    /// Moves the first affinely independent points of `order` to its front, at most `D + 1`, which
    /// are then positively oriented. Returns the affine dimension of all points.
    fn spanning_first(points: Points<'_, D>, order: &mut [u32]) -> u8;

    /// Returns the mesh of a triangulation, in which vertex *v* becomes `names[v]`.
    fn mesh(triangulation: Self::Triangulation, names: &[u32], options: &Options) -> Self::Mesh;

    /// Returns the mesh of distinct points that span fewer dimensions.
    fn degenerate_mesh(points: Points<'_, D>, distinct: Vec<u32>) -> Self::Mesh;
}

/// A triangulation into which vertices are inserted.
pub trait Insert<const D: usize>: Sized {
    /// Lists that insertions reuse.
    type Scratch;

    /// The expected number of simplices per point, ghosts included.
    const SIMPLICES_PER_POINT: usize;
    /// The number of points between two reports of progress: few enough for a smooth display, and
    /// so many that reports cost little beside the insertions.
    const REPORT: usize;

    /// Creates the triangulation of the first `D + 1` vertices, which are positively oriented.
    /// `infinite` is the number of vertices.
    fn initial(infinite: u32) -> Self;

    /// Reserves memory for this many simplices in all.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfMemory`].
    fn reserve(&mut self, simplices: usize) -> Result<(), Error>;

    /// Creates the lists for so many vertices.
    fn scratch(vertices: usize) -> Self::Scratch;

    /// Returns a simplex that contains vertex `p`, or a ghost whose facet sees it.
    ///
    /// Walks from simplex `start` across facets that separate the current simplex from `p`. The
    /// walk ends because the power distance to `p` decreases with every step.
    fn locate(&self, vertices: &PredicateContext<'_, D>, p: u32, start: u32) -> u32;

    /// Inserts vertex `p`, which is in conflict with simplex `start`. Returns a simplex at `p`.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
    fn insert(
        &mut self,
        vertices: &PredicateContext<'_, D>,
        p: u32,
        start: u32,
        scratch: &mut Self::Scratch,
    ) -> Result<u32, Error>;

    /// Takes over what the lists know of the triangulation, after the last insertion.
    fn finish(&mut self, scratch: Self::Scratch);
}

/// Triangulates `points` by incremental insertion.
///
/// # Errors
///
/// Returns the errors of [`delaunay3d`](crate::delaunay3d) that are not a GPU's.
pub fn delaunay<const D: usize>(points: Points<'_, D>, options: &Options) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Incremental<D>,
{
    delaunay_in_order(points, options, Order::default())
}

/// Triangulates `points` by incremental insertion in a given order, on which the set of simplices
/// does not depend.
///
/// # Errors
///
/// Returns the errors of [`delaunay3d`](crate::delaunay3d) that are not a GPU's.
pub fn delaunay_in_order<const D: usize>(
    points: Points<'_, D>,
    options: &Options,
    order: Order,
) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Incremental<D>,
{
    let limit = Dimension::<D>::MAX_POINTS;
    if points.len() > limit {
        return Err(Error::TooManyPoints { points: points.len(), limit });
    }
    let mut stopwatch = Stopwatch::start();
    let mut stats = Stats::new(Backend::Cpu);
    options.report(Phase::Sort, 0.0)?;
    points.validate()?;
    let lattice = Lattice::fit(points);
    let Distinct { mut order, duplicate_of } = insertion_order(points, &lattice, Dimension::<D>::CURVE, order);
    let dimension = Dimension::<D>::spanning_first(points, &mut order);
    stats.phases.push((Phase::Sort, stopwatch.lap()));
    let mut mesh = if usize::from(dimension) == D {
        let vertices = PredicateContext::new(points, &lattice, order);
        let triangulation = insert_all(&vertices, options)?;
        stats.phases.push((Phase::Insert, stopwatch.lap()));
        stats.exact = vertices.exact_counts();
        let mesh = Dimension::<D>::mesh(triangulation, &vertices.into_input_indices(), options);
        stats.phases.push((Phase::Finish, stopwatch.lap()));
        mesh
    } else {
        Dimension::<D>::degenerate_mesh(points, order)
    };
    options.report(Phase::Finish, 1.0)?;
    mesh.set_input(duplicate_of, dimension);
    *mesh.stats_mut() = stats;
    Ok(mesh)
}

/// Triangulates all vertices, of which the first `D + 1` must be positively oriented.
///
/// # Errors
///
/// Returns [`Error::Cancelled`], [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub(crate) fn insert_all<const D: usize, T: Insert<D>>(
    vertices: &PredicateContext<'_, D>,
    options: &Options,
) -> Result<T, Error> {
    let (first, n) = (D + 1, vertices.len());
    let mut triangulation = T::initial(n as u32);
    triangulation.reserve(n * T::SIMPLICES_PER_POINT)?;
    let report = |inserted: usize| options.report(Phase::Insert, (first + inserted) as f64 / n as f64);
    insert_points(&mut triangulation, vertices, first as u32..n as u32, 0, report)?;
    Ok(triangulation)
}

/// Inserts vertices that a Delaunay triangulation lacks.
///
/// Insertion is fast if consecutive vertices are near each other, and the first is near simplex
/// `start`. Calls `report` with the number of vertices inserted so far from time to time; an error
/// from it ends the insertion.
///
/// # Errors
///
/// Returns the errors of `report`, [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub(crate) fn insert_points<const D: usize, T: Insert<D>>(
    triangulation: &mut T,
    vertices: &PredicateContext<'_, D>,
    points: impl IntoIterator<Item = u32>,
    start: u32,
    report: impl Fn(usize) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut scratch = T::scratch(vertices.len());
    let mut last = start;
    for (inserted, p) in points.into_iter().enumerate() {
        if inserted % T::REPORT == 0 {
            report(inserted)?;
        }
        let start = triangulation.locate(vertices, p, last);
        last = triangulation.insert(vertices, p, start, &mut scratch)?;
    }
    triangulation.finish(scratch);
    Ok(())
}
