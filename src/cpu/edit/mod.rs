//! Edits: a few vertices are removed from a mesh, and others inserted.
//!
//! `mesh → walks → vertices removed → vertices inserted → patch → mesh`
//!
//! The work does not depend on the size of the mesh: [`Sparse`] copies the simplices that are looked
//! at. An index whose point is removed stays *unused*: it is its own duplicate.

mod dim;
mod editing;
mod patch;
mod plan;
mod removal;
mod sparse;
mod unused;

pub use dim::Edit;
pub use patch::{Patch, Row};
pub use sparse::Sparse;
pub use unused::{Again, Used, delaunay_of_used};

use crate::{
    backend::Backend,
    cpu::{Incremental, Insert, MIN_SHARED, MeshOf},
    dimension::Dimension,
    error::Error,
    index::NONE,
    input::{lattice::Lattice, points::Points},
    mesh::MeshInfo,
    options::Options,
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    stats::{Phase, Restart, Stats, Stopwatch, UpdateStats},
};
use editing::Editing;
use plan::{Plan, check_indices, in_order, order_of_new};
use std::num::NonZeroUsize;

/// The number of points that are always inserted one by one.
const FEW_POINTS: f64 = 64.0;

/// The number of vertices around each vertex that is removed: the mean of uniform points.
const AROUND: f64 = 16.0;

/// The number of vertices around those that are removed that never causes a run from scratch.
const MIN_AROUND: f64 = 4096.0;

/// Inserts the points of `points` that the mesh does not have yet, which follow those that it has,
/// and removes those with the indices in `removed`.
///
/// Returns `None` if the mesh was changed. Otherwise the points have to be triangulated from scratch,
/// and [`Again`] says which and why: for example because more than the share `max_share` of them come
/// or go. Then and after an error the mesh is what it was.
///
/// # Errors
///
/// Returns [`Error::PointCount`], [`Error::BadIndex`], [`Error::NotFinite`],
/// [`Error::TooManyPoints`], [`Error::TooManySimplices`], [`Error::OutOfMemory`] and
/// [`Error::Cancelled`].
pub fn edit<const D: usize, const N: usize>(
    mesh: &mut MeshOf<D>,
    points: Points<'_, D>,
    removed: &[u32],
    options: &Options,
    max_share: f64,
) -> Result<Option<Again>, Error>
where
    Dimension<D>: Edit<D, N>,
    for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
{
    let threads = if points.len() < MIN_SHARED { Some(NonZeroUsize::MIN) } else { options.threads };
    parallel::with_threads(threads, |threads| Request { threads, points, removed, options, max_share }.apply::<N>(mesh))
}

/// What is asked of an edit.
struct Request<'a, const D: usize> {
    /// The threads that order points; one does the rest.
    threads: Threads,
    /// All points, the new ones included.
    points: Points<'a, D>,
    /// The indices of the points to be removed.
    removed: &'a [u32],
    options: &'a Options,
    /// The largest share of the points that are inserted, where one thread triangulates from
    /// scratch.
    max_share: f64,
}

impl<const D: usize> Request<'_, D> {
    fn apply<const N: usize>(&self, mesh: &mut MeshOf<D>) -> Result<Option<Again>, Error>
    where
        Dimension<D>: Edit<D, N>,
        for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
    {
        let mut stopwatch = Stopwatch::start();
        let mut stats = Stats::new(Backend::Cpu);
        self.options.report(Phase::Sort, 0.0)?;
        self.check::<N>(mesh)?;
        let lattice = Lattice::fit_by(self.threads, self.points)?;
        let plan = Plan::new(mesh.duplicate_of(), self.points.len(), self.removed);
        let Plan { removed, heirs, mut duplicate_of } = match plan {
            Ok(plan) => plan,
            Err(duplicate_of) => return Ok(Some(Again::new(Restart::Broken, duplicate_of))),
        };
        let ordered = self.order::<N>(mesh, &lattice, &removed, heirs, &mut duplicate_of);
        stats.phases.push((Phase::Sort, stopwatch.lap()));

        let context = PredicateContext::of_input(self.points, &lattice);
        let mut editing = Editing {
            sparse: Sparse::new(mesh, &context, self.options.winding),
            points: self.points,
            lattice: &lattice,
            context: &context,
            options: self.options,
            last: 0,
            max_around: (AROUND * self.max_share * self.points.len() as f64).max(MIN_AROUND),
            duplicate_of,
            update: UpdateStats::default(),
        };
        let edited = match ordered {
            Ok([removed, inserted]) => editing.run(&removed, &inserted)?,
            Err(why) => Err(why),
        };
        let Editing { sparse, mut duplicate_of, update, .. } = editing;
        let patch = match edited.and_then(|()| sparse.into_patch().ok_or(Restart::Broken)) {
            Ok(patch) => patch,
            Err(why) => {
                duplicate_of[mesh.duplicate_of().len()..].fill(NONE);
                return Ok(Some(Again::new(why, duplicate_of)));
            }
        };
        stats.phases.push((Phase::Insert, stopwatch.lap()));
        self.options.report(Phase::Finish, 1.0)?;
        Dimension::<D>::reserve(mesh, patch.count)?;
        Dimension::<D>::apply(mesh, patch, self.options.winding);
        mesh.set_input(duplicate_of, mesh.dimension());
        stats.exact = context.exact_counts();
        stats.phases.push((Phase::Finish, stopwatch.lap()));
        stats.update = Some(update);
        *mesh.stats_mut() = stats;
        Ok(None)
    }

    /// Checks the points and the indices.
    fn check<const N: usize>(&self, mesh: &MeshOf<D>) -> Result<(), Error>
    where
        Dimension<D>: Edit<D, N>,
    {
        let (points, expected, limit) = (self.points.len(), mesh.duplicate_of().len(), Dimension::<D>::MAX_POINTS);
        if points < expected {
            return Err(Error::PointCount { points, expected });
        }
        if points > limit {
            return Err(Error::TooManyPoints { points, limit });
        }
        check_indices(mesh.duplicate_of(), self.removed)
    }

    /// Returns the vertices to be removed and those to be inserted, each near the one before.
    /// Notes in `duplicate_of` which new points duplicate others of them. Returns an error if the
    /// points have to be triangulated from scratch.
    fn order<const N: usize>(
        &self,
        mesh: &MeshOf<D>,
        lattice: &Lattice<D>,
        removed: &[u32],
        heirs: Vec<u32>,
        duplicate_of: &mut [u32],
    ) -> Result<[Vec<u32>; 2], Restart>
    where
        Dimension<D>: Edit<D, N>,
    {
        let known = mesh.duplicate_of().len();
        let new = self.points.len() - known;
        if removed.is_empty() && new == 0 {
            // The points that are removed were duplicates.
            return Ok([Vec::new(), Vec::new()]);
        }
        // Two threads triangulate 1.6 times as fast as one, and sixteen 8 times.
        let faster = (parallel::count(self.threads) as f64).powf(0.75);
        let max = FEW_POINTS + self.max_share * self.points.len() as f64 / faster;
        if Dimension::<D>::REMOVAL * removed.len() as f64 + (heirs.len() + new) as f64 > max {
            return Err(Restart::Points);
        }
        if usize::from(mesh.dimension()) != D {
            return Err(Restart::Degenerate);
        }
        let removed = in_order(self.threads, self.points, lattice, removed).ok_or(Restart::Broken)?;
        let new = order_of_new(self.threads, self.points, lattice, known, duplicate_of);
        Ok([removed, [heirs, new].concat()])
    }
}
