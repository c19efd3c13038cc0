//! The CPU engine: Bowyer–Watson insertion (1981), point by point, with exact predicates.
//!
//! `points → lattice → insertion order → insert → drop the ghosts → input indices → mesh`
//!
//! All of it is generic over the number `D` of coordinates; [`Incremental`] and [`Insert`] are what
//! the dimensions supply.

pub mod edit;
mod regular;
mod workers;

pub(crate) use regular::are_equal;
pub use regular::{regular, regular_in_order, weights_of_radii};
pub(crate) use workers::{SharedRun, insert_by_workers};

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
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    stats::{Phase, Stats, Stopwatch},
};
use std::{fmt::Debug, num::NonZeroUsize, ops::Range};

/// With fewer points than this, one thread is as fast as several. Tests let many threads meet on
/// few points.
const MIN_SHARED: usize = if cfg!(test) { 8 } else { 1 << 13 };
/// The number of points that one thread inserts before the others join in, unless that is more than an
/// eighth of all.
const FEW: usize = 1 << 9;

/// The mesh of `D` dimensions.
pub type MeshOf<const D: usize> = <Dimension<D> as Incremental<D>>::Mesh;

/// The dimension-dependent parts of the CPU engine.
pub trait Incremental<const D: usize> {
    /// The result.
    type Mesh: MeshInfo + Debug + Default + Send + Sync;
    /// The triangulation under construction.
    type Triangulation: Grow<D>;

    /// The maximum number of points.
    const MAX_POINTS: usize;
    /// The curve along which points are inserted.
    const CURVE: Curve<D>;

    /// Moves the first affinely independent points of `order` to its front, at most `D + 1`, which
    /// are then positively oriented. Returns the affine dimension of all points.
    fn spanning_first(points: Points<'_, D>, order: &mut [u32]) -> u8;

    /// Triangulates all vertices by [`insert_all`]. An item of its own, so that it is compiled with this crate
    /// and its profile, whoever calls it.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`insert_all`].
    fn triangulate(
        threads: Threads,
        vertices: &PredicateContext<'_, D>,
        rounds: &[Range<u32>],
        options: &Options,
    ) -> Result<Self::Triangulation, Error>;

    /// Triangulates all vertices, as far as they are not hidden, like [`triangulate`](Incremental::triangulate).
    ///
    /// # Errors
    ///
    /// Returns the errors of [`insert_all`].
    fn triangulate_weighted(
        threads: Threads,
        vertices: &PredicateContext<'_, D, true>,
        rounds: &[Range<u32>],
        options: &Options,
    ) -> Result<Self::Triangulation, Error>;

    /// Returns the mesh of a triangulation, in which vertex *v* becomes `names[v]`, made by
    /// `threads`.
    fn mesh(triangulation: Self::Triangulation, names: &[u32], threads: Threads, options: &Options) -> Self::Mesh;

    /// Returns the mesh of distinct points that span fewer dimensions.
    fn degenerate_mesh(points: Points<'_, D>, distinct: Vec<u32>) -> Self::Mesh;
}

/// A triangulation that starts with one simplex, and grows.
pub trait Grow<const D: usize>: Insert<D> + Sized {
    /// The expected number of simplices per point, ghosts included.
    const SIMPLICES_PER_POINT: usize;

    /// Creates the triangulation of the first `D + 1` vertices, which are positively oriented.
    /// `infinite` is the number of vertices.
    fn initial(infinite: u32) -> Self;

    /// Reserves memory for this many simplices in all.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfMemory`].
    fn reserve(&mut self, simplices: usize) -> Result<(), Error>;

    /// Returns the corners and the neighbours of the simplices without unused slots, each as four
    /// words: infinity is [`NONE`](crate::index::NONE), and in 2D the last one is 0.
    fn into_simplices(self) -> Vec<[[u32; 4]; 2]>;

    /// Inserts the vertices of a run by several threads. Returns those that the threads could not
    /// insert because they disturbed each other.
    ///
    /// # Errors
    ///
    /// Returns the errors of the run's reports, [`Error::TooManySimplices`] and
    /// [`Error::OutOfMemory`].
    fn insert_by_threads<const W: bool>(self, run: &SharedRun<'_, D, W>) -> Result<(Self, Vec<u32>), Error>;
}

/// Simplices among which vertices are inserted: a whole triangulation, or what a thread sees of
/// one that several change.
pub trait Insert<const D: usize> {
    /// Lists that insertions reuse.
    type Scratch;

    /// The number of points between two reports of progress. Reports then cost little, and a display is
    /// still smooth.
    const REPORT: usize;

    /// Creates the lists.
    fn scratch(&self) -> Self::Scratch;

    /// Returns a simplex that contains vertex `p`, or a ghost whose facet sees it; any simplex if
    /// other threads disturb the walk.
    ///
    /// Walks from simplex `start` across facets that separate the current simplex from `p`. The
    /// walk ends because the power distance to `p` decreases with every step.
    fn locate<const W: bool>(&self, vertices: &PredicateContext<'_, D, W>, p: u32, start: u32) -> u32;

    /// Inserts vertex `p`, which [`locate`](Insert::locate) has found in simplex `start`. Returns a simplex at `p`, or,
    /// without having changed anything, `start` if `p` is hidden, and `None` if another thread disturbs the insertion.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
    fn insert<const W: bool>(
        &mut self,
        vertices: &PredicateContext<'_, D, W>,
        p: u32,
        start: u32,
        scratch: &mut Self::Scratch,
    ) -> Result<Option<u32>, Error>;

    /// Ends the insertions: returns to the simplices what only the lists know of them.
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
    triangulate_in_order::<D, false>(points, &[], options, order)
}

/// Triangulates `points`, which have `weights` if `W`: modules of WebAssembly without weights have no code for them.
fn triangulate_in_order<const D: usize, const W: bool>(
    points: Points<'_, D>,
    weights: &[f64],
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
    // Threads that have nothing to do would cost more than they bring.
    let threads = if points.len() < MIN_SHARED { Some(NonZeroUsize::MIN) } else { options.threads };
    parallel::with_threads(threads, |threads| triangulate_by::<D, W>(threads, points, weights, options, order))
}

/// Triangulates `points`, which have `weights` if `W`, by `threads`.
fn triangulate_by<const D: usize, const W: bool>(
    threads: Threads,
    points: Points<'_, D>,
    weights: &[f64],
    options: &Options,
    order: Order,
) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Incremental<D>,
{
    let mut stopwatch = Stopwatch::start();
    let mut stats = Stats::new(Backend::Cpu);
    options.report(Phase::Sort, 0.0)?;
    let lattice = if W { Lattice::fit_weighted(threads, points, weights)? } else { Lattice::fit_by(threads, points)? };
    let Distinct { mut order, rounds, mut duplicate_of } =
        insertion_order(threads, points, &lattice, Dimension::<D>::CURVE, order);
    if W {
        regular::keep_heaviest(weights, &mut order, &mut duplicate_of);
    }
    let dimension = Dimension::<D>::spanning_first(points, &mut order);
    stats.phases.push((Phase::Sort, stopwatch.lap()));
    let mut mesh = if usize::from(dimension) == D {
        let (triangulation, names);
        if W {
            let vertices = PredicateContext::weighted_by(threads, points, weights, &lattice, order);
            triangulation = Dimension::<D>::triangulate_weighted(threads, &vertices, &rounds, options)?;
            (stats.exact, names) = (vertices.exact_counts(), vertices.into_input_indices());
        } else {
            let vertices = PredicateContext::new_by(threads, points, &lattice, order);
            triangulation = Dimension::<D>::triangulate(threads, &vertices, &rounds, options)?;
            (stats.exact, names) = (vertices.exact_counts(), vertices.into_input_indices());
        }
        stats.phases.push((Phase::Insert, stopwatch.lap()));
        let mesh = Dimension::<D>::mesh(triangulation, &names, threads, options);
        stats.phases.push((Phase::Finish, stopwatch.lap()));
        mesh
    } else {
        Dimension::<D>::degenerate_mesh(points, order)
    };
    options.report(Phase::Finish, 1.0)?;
    mesh.set_input(duplicate_of, dimension);
    if W {
        mesh.set_weights(weights);
    }
    *mesh.stats_mut() = stats;
    Ok(mesh)
}

/// Triangulates all vertices, of which the first `D + 1` must be positively oriented. Each of the
/// `rounds` goes along the curve.
///
/// # Errors
///
/// Returns [`Error::Cancelled`], [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub(crate) fn insert_all<const D: usize, T: Grow<D>, const W: bool>(
    threads: Threads,
    vertices: &PredicateContext<'_, D, W>,
    rounds: &[Range<u32>],
    options: &Options,
) -> Result<T, Error> {
    let (first, n) = (D as u32 + 1, vertices.len());
    let mut triangulation = T::initial(n as u32);
    let report = |inserted: usize| options.report(Phase::Insert, inserted as f64 / n as f64);
    let alone = |triangulation: &mut T, points: &mut dyn Iterator<Item = u32>, before: usize| {
        insert_points(triangulation, vertices, points, 0, |inserted| report(before + inserted))
    };
    if parallel::count(threads) == 1 || n < MIN_SHARED {
        triangulation.reserve(n * T::SIMPLICES_PER_POINT)?;
        alone(&mut triangulation, &mut (first..n as u32), first as usize)?;
        return Ok(triangulation);
    }
    // Threads need a triangulation in which they are far apart.
    let few = rounds.iter().map(|round| round.end).find(|&end| end as usize >= FEW).unwrap_or(0).min(n as u32 / 8);
    let few = few.max(first);
    triangulation.reserve(few as usize * T::SIMPLICES_PER_POINT)?;
    alone(&mut triangulation, &mut (first..few), first as usize)?;
    let rest = rounds.iter().map(|round| round.start.max(few)..round.end).filter(|round| !round.is_empty());
    let run = SharedRun { threads, vertices, rounds: rest.collect(), report: &report };
    let (mut triangulation, mut left) = triangulation.insert_by_threads(&run)?;
    left.sort_unstable();
    let before = n - left.len();
    alone(&mut triangulation, &mut left.into_iter(), before)?;
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
pub(crate) fn insert_points<const D: usize, T: Insert<D>, const W: bool>(
    triangulation: &mut T,
    vertices: &PredicateContext<'_, D, W>,
    points: impl IntoIterator<Item = u32>,
    start: u32,
    report: impl Fn(usize) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut scratch = triangulation.scratch();
    let mut points = points.into_iter().peekable();
    let (mut last, mut inserted) = (start, 0);
    while points.peek().is_some() {
        report(inserted)?;
        last = insert_some(triangulation, vertices, &mut points.by_ref().take(T::REPORT), last, &mut scratch)?;
        inserted += T::REPORT;
    }
    triangulation.finish(scratch);
    Ok(())
}

/// Inserts a few vertices. Returns a simplex at the last one.
///
/// Engines of WebAssembly replace code by faster code only when it is called again, so this is a function.
///
/// # Errors
///
/// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
#[inline(never)]
fn insert_some<const D: usize, T: Insert<D>, const W: bool>(
    triangulation: &mut T,
    vertices: &PredicateContext<'_, D, W>,
    points: &mut dyn Iterator<Item = u32>,
    start: u32,
    scratch: &mut T::Scratch,
) -> Result<u32, Error> {
    let mut last = start;
    for p in points {
        let start = triangulation.locate(vertices, p, last);
        last = triangulation.insert(vertices, p, start, scratch)?.expect("nobody disturbs the only thread");
    }
    Ok(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mesh2, Mesh3, random::Random};
    use proptest::prelude::*;

    fn options(threads: usize) -> Options {
        Options { threads: NonZeroUsize::new(threads), ..Options::default() }
    }

    /// Checks that any number of threads makes the mesh of one thread.
    fn check3(points: &[[f64; 3]]) -> Result<(), TestCaseError> {
        let expected: Mesh3 = delaunay::<3>(points.into(), &options(1))?;
        for threads in [2, 3, 8, 16] {
            for order in [Order::Brio, Order::Shuffled(1)] {
                let mesh: Mesh3 = delaunay_in_order::<3>(points.into(), &options(threads), order)?;
                prop_assert!(mesh.canonical() == expected.canonical(), "{} threads, {:?}", threads, order);
                prop_assert_eq!(&mesh.duplicate_of, &expected.duplicate_of);
                let report = crate::verify3d(points, &mesh)?;
                prop_assert!(report.passed(), "{} threads, {:?}:\n{}", threads, order, report);
            }
        }
        Ok(())
    }

    /// Checks that any number of threads makes the mesh of one thread.
    fn check2(points: &[[f64; 2]]) -> Result<(), TestCaseError> {
        let expected: Mesh2 = delaunay::<2>(points.into(), &options(1))?;
        for threads in [2, 3, 8, 16] {
            for order in [Order::Brio, Order::Shuffled(1)] {
                let mesh: Mesh2 = delaunay_in_order::<2>(points.into(), &options(threads), order)?;
                prop_assert!(mesh.canonical() == expected.canonical(), "{} threads, {:?}", threads, order);
                prop_assert_eq!(&mesh.duplicate_of, &expected.duplicate_of);
                let report = crate::verify2d(points, &mesh)?;
                prop_assert!(report.passed(), "{} threads, {:?}:\n{}", threads, order, report);
            }
        }
        Ok(())
    }

    /// At most `max` points of an integer grid with few points along some axes.
    fn grid<const D: usize>(max: usize) -> impl Strategy<Value = Vec<[f64; D]>> {
        let sides = prop::array::uniform::<_, D>(prop::sample::select(vec![1u32, 2, 3, 7, 40]));
        (sides, 0..=max, any::<u64>()).prop_map(|(sides, count, seed)| {
            let mut random = Random::new(seed);
            (0..count).map(|_| sides.map(|side| (random.unit() * f64::from(side)).floor())).collect()
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn threads_agree_on_grids(points in grid::<3>(600)) { check3(&points)?; }

        #[test]
        fn threads_agree_on_2d_grids(points in grid::<2>(900)) { check2(&points)?; }
    }

    /// Every cavity meets nearly every other, and there are more slots than were reserved.
    #[test]
    fn threads_agree_on_skew_lines() {
        let points: Vec<_> = (0..80u32).map(f64::from).flat_map(|i| [[i, 0.0, 0.0], [40.0, i - 40.5, 40.0]]).collect();
        check3(&points).unwrap();
    }

    /// Every triangle has the hub as a vertex, so that only one thread at a time gets on.
    #[test]
    fn threads_agree_on_a_wheel() {
        let angle = |i: u32| f64::from(i) * 0.01;
        let rim = (0..600).map(angle).map(|a| [100.0 * libm::cos(a), 100.0 * libm::sin(a)]);
        check2(&rim.chain([[0.0; 2]]).collect::<Vec<_>>()).unwrap();
    }
}
