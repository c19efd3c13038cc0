//! Points that move: the triangulation of the points where they were is made that of the points
//! where they are.
//!
//! `mesh → ghosts → exact signs at the new points → flips, in 3D splaying → points that are no
//! duplicates any more → mesh`
//!
//! What the signs leave unproven is repaired, and what is repaired is proven like the rest. So the
//! result is the Delaunay triangulation, or there is none and a reason to triangulate the points
//! from scratch.

use crate::{
    backend::Backend,
    cpu::{Incremental, Insert, MIN_SHARED, MeshOf},
    dimension::Dimension,
    error::Error,
    index::{NO_INDEX, NONE},
    input::{lattice::Lattice, order::missing_points, points::Points},
    mesh::MeshInfo,
    options::Options,
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    stats::{Phase, Restart, Stats, Stopwatch, UpdateStats},
};
use std::{num::NonZeroUsize, ops::Range};

/// With more points to be inserted than one of so many, triangulating from scratch is faster: one
/// thread inserts these.
pub(crate) const PARTED: usize = 16;

/// The number of simplices that are worth handing to another thread, and into how many parts they
/// are split for each.
const GRAIN: usize = 1 << 11;
const PARTS: usize = 8;

/// How many parts of a mesh are looked at first, of so many simplices each.
const SAMPLES: usize = 16;
const SAMPLE: usize = 256;

/// So much it always pays to repair.
const FEW: f64 = 8.0;

/// So many points it always pays to insert.
const FEW_POINTS: f64 = 64.0;

/// What it pays to repair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The number of simplices that are flat or inverted, by that of all.
    pub inverted: f64,
    /// The number of facets that are not locally Delaunay, by that of simplices.
    pub changed: f64,
    /// The number of points that are inserted, by that of all, where one thread triangulates from
    /// scratch. One that is removed counts as [`Edit::REMOVAL`](crate::cpu::edit::Edit::REMOVAL).
    pub points: f64,
    /// The number of threads.
    pub threads: usize,
    /// The number of updates in a row that may begin anew before only every fourth looks at the mesh.
    pub attempts: u32,
}

impl Limits {
    /// Everything, so that tests see what the repair can do.
    pub const NONE: Limits = Limits {
        inverted: f64::INFINITY,
        changed: f64::INFINITY,
        points: f64::INFINITY,
        threads: usize::MAX,
        attempts: u32::MAX,
    };

    /// Returns the limits beyond which one thread triangulates faster from scratch in `dimension`
    /// dimensions: what uniform points have that move by 1 % of their mean spacing in 3D, and by
    /// 3 % in 2D; and 2.8 % and 2 % new points. With several threads that is less, because one of
    /// them flips; and many threads triangulate from scratch before they have checked the mesh.
    pub fn measured(dimension: usize) -> Self {
        match dimension {
            2 => Limits { inverted: 0.003, changed: 0.06, points: 0.02, threads: 3, ..Limits::NONE },
            _ => Limits { inverted: 0.001, changed: 0.075, points: 0.028, threads: 3, ..Limits::NONE },
        }
    }

    /// Returns the limits beyond which a device triangulates faster from scratch in `dimension`
    /// dimensions. In 3D, a million uniform points have so much that move by 1.5 % of their mean
    /// spacing: beyond that, star splaying often gives up. In 2D, where it pays to repair anything,
    /// one inverted triangle in ten is left by the flips.
    pub fn on_device(dimension: usize) -> Self {
        match dimension {
            2 => Limits { inverted: 0.0, changed: 0.06, attempts: 2, ..Limits::NONE },
            _ => Limits { inverted: 0.001, changed: 0.12, attempts: 2, ..Limits::NONE },
        }
    }

    /// Returns the most inverted and the most changed of so many simplices that [`check`](Self::check)
    /// lets pass.
    #[cfg(feature = "gpu")]
    pub(crate) fn most(&self, simplices: f64) -> [u32; 2] {
        [self.inverted, self.changed].map(|share| (FEW + share * simplices) as u32)
    }

    /// Returns whether an update looks at a mesh, after so many in a row that began anew: to look at what
    /// has moved too far takes a device a tenth of a run from scratch.
    #[cfg(feature = "gpu")]
    pub(crate) fn looks_after(&self, begun_anew: u32) -> bool {
        begun_anew < self.attempts || begun_anew.is_multiple_of(4)
    }

    /// Returns why it does not pay to repair so much of so many simplices by one thread.
    pub(crate) fn check(&self, inverted: f64, changed: f64, simplices: f64) -> Result<(), Restart> {
        if inverted > FEW + self.inverted * simplices {
            Err(Restart::Inverted)
        } else if changed > FEW + self.changed * simplices {
            Err(Restart::Changed)
        } else {
            Ok(())
        }
    }
}

impl Limits {
    /// Returns why it does not pay to insert so many of so many points, one after the other, where so
    /// many threads triangulate from scratch.
    pub(crate) fn check_points(&self, count: f64, points: f64, threads: usize) -> Result<(), Restart> {
        // Two are 1.6 times as fast as one, and sixteen 8 times.
        let faster = (threads as f64).powf(0.75);
        if count > FEW_POINTS + self.points * points / faster { Err(Restart::Points) } else { Ok(()) }
    }
}

/// What is known of a triangulation whose vertices have moved.
pub struct Moved<'a, const D: usize> {
    /// The points as they are now.
    pub(crate) points: Points<'a, D>,
    /// The lattice that is fitted to them.
    pub(crate) lattice: &'a Lattice<D>,
    /// The points as vertices, with stored coordinates.
    pub(crate) vertices: &'a PredicateContext<'a, D>,
    /// Who shares the work.
    pub(crate) threads: Threads,
    /// The options of the run.
    pub(crate) options: &'a Options,
    /// What it pays to repair.
    pub(crate) limits: Limits,
    /// Receives the statistics.
    pub(crate) stats: &'a mut Stats,
    /// Receives those of the update.
    pub(crate) update: &'a mut UpdateStats,
    /// Times the phases.
    pub(crate) stopwatch: &'a mut Stopwatch,
    /// Receives the vertices that the repair has removed, each with one near it.
    pub(crate) removed: Vec<[u32; 2]>,
}

impl<const D: usize> Moved<'_, D> {
    /// Splits 0 … `len` into ranges and returns the results of `work` for each, in order, with the
    /// vertices as its thread has them.
    pub(crate) fn map<R: Send>(
        &self,
        len: usize,
        work: impl Fn(&PredicateContext<'_, D>, Range<usize>) -> R + Sync,
    ) -> Vec<R> {
        let count = parallel::count(self.threads);
        if count == 1 || len < GRAIN {
            return vec![work(self.vertices, 0..len)];
        }
        let grain = len.div_ceil(PARTS * count).max(GRAIN);
        let part = |start: usize| (self.vertices.fork(), start..(start + grain).min(len));
        let mut parts: Vec<_> = (0..len).step_by(grain).map(part).collect();
        let results = parallel::map_mut(self.threads, &mut parts, |_, (vertices, range)| work(vertices, range.clone()));
        parts.iter().for_each(|(vertices, _)| self.vertices.add_counts(vertices.exact_counts()));
        results
    }

    /// Returns what `check` leaves unproven of so many simplices, or why it does not pay to repair
    /// it. `check` returns `None` where the arrays of the mesh do not fit each other.
    pub(crate) fn check<C: Checked>(
        &mut self,
        simplices: usize,
        check: impl Fn(&PredicateContext<'_, D>, Range<usize>) -> Option<C> + Sync,
    ) -> Result<Vec<C>, Restart> {
        // Where a few parts show that too much has changed, the others are not looked at.
        let step = simplices / SAMPLES;
        if step > SAMPLE {
            let sample = (0..SAMPLES).map(|i| check(self.vertices, i * step..i * step + SAMPLE));
            let sample: Option<Vec<C>> = sample.collect();
            self.count(&sample.ok_or(Restart::Broken)?, SAMPLES * SAMPLE, simplices)?;
        }
        let parts: Option<Vec<C>> = self.map(simplices, check).into_iter().collect();
        let parts = parts.ok_or(Restart::Broken)?;
        self.count(&parts, simplices, simplices)?;
        Ok(parts)
    }

    /// Counts what is unproven of so many simplices, and so expects of all. Returns an error if it
    /// does not pay to repair that.
    fn count(&mut self, parts: &[impl Checked], simplices: usize, all: usize) -> Result<(), Restart> {
        let [inverted, not_locally_delaunay] =
            parts.iter().map(Checked::counts).fold([0; 2], |[a, b], [c, d]| [a + c, b + d]);
        let threads = parallel::count(self.threads) as f64;
        let expected = |count: usize| (count as f64 * all as f64 / simplices.max(1) as f64) as usize;
        self.update.inverted = expected(inverted);
        self.update.not_locally_delaunay = expected(not_locally_delaunay);
        self.limits.check(inverted as f64, not_locally_delaunay as f64, simplices as f64 / threads)
    }
}

/// What is unproven of some simplices.
pub trait Checked: Send {
    /// Returns the numbers of simplices that are not positively oriented, and of facets that are
    /// not locally Delaunay.
    fn counts(&self) -> [usize; 2];
}

/// How the triangulation of points that move is kept.
pub trait Update<const D: usize>: Incremental<D> {
    /// The vertices of a simplex.
    type Corners: AsRef<[u32]>;

    /// Returns the field `duplicate_of` of a mesh.
    fn duplicate_of(mesh: &Self::Mesh) -> &[i32];

    /// Returns the vertices of a simplex; none of those of a slot that is not used.
    fn corners(triangulation: &Self::Triangulation, t: u32) -> Self::Corners;

    /// Returns a simplex of each vertex, a ghost if there is one; [`NO_INDEX`] for points that are
    /// no vertices.
    fn incident(triangulation: &Self::Triangulation) -> Vec<u32>;

    /// Returns the Delaunay triangulation of the points as they are now, given the mesh of the
    /// points as they were, or says why that does not work or pay. It may lack
    /// [`Moved::removed`], and the points that the mesh has as duplicates.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Cancelled`], [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
    fn repair(moved: &mut Moved<'_, D>, mesh: &Self::Mesh) -> Result<Result<Self::Triangulation, Restart>, Error>;
}

/// Returns the Delaunay triangulation of `points`, given the one of as many other points, or the
/// reason why they have to be triangulated from scratch; and what was done.
///
/// # Errors
///
/// Returns [`Error::PointCount`], [`Error::NotFinite`], [`Error::Cancelled`] and
/// [`Error::OutOfMemory`].
pub fn update<const D: usize>(
    mesh: &MeshOf<D>,
    points: Points<'_, D>,
    options: &Options,
    limits: Limits,
) -> Result<(Option<MeshOf<D>>, UpdateStats), Error>
where
    Dimension<D>: Update<D>,
    MeshOf<D>: Sync,
{
    let expected = Dimension::<D>::duplicate_of(mesh).len();
    if points.len() != expected {
        return Err(Error::PointCount { points: points.len(), expected });
    }
    let threads = if points.len() < MIN_SHARED { Some(NonZeroUsize::MIN) } else { options.threads };
    parallel::with_threads(threads, |threads| {
        let mut update = UpdateStats::default();
        let mesh = match update_by(threads, mesh, points, options, limits, &mut update)? {
            Ok(mesh) => Some(mesh),
            Err(why) => {
                update.restarted = Some(why);
                None
            }
        };
        Ok((mesh, update))
    })
}

/// Updates a mesh by `threads`.
fn update_by<const D: usize>(
    threads: Threads,
    mesh: &MeshOf<D>,
    points: Points<'_, D>,
    options: &Options,
    limits: Limits,
    update: &mut UpdateStats,
) -> Result<Result<MeshOf<D>, Restart>, Error>
where
    Dimension<D>: Update<D>,
{
    let mut stopwatch = Stopwatch::start();
    let mut stats = Stats::new(Backend::Cpu);
    options.report(Phase::Check, 0.0)?;
    points.validate_by(threads)?;
    if usize::from(mesh.dimension()) != D {
        return Ok(Err(Restart::Degenerate));
    }
    if parallel::count(threads) > limits.threads {
        return Ok(Err(Restart::Threads));
    }
    let Some((mut missing, duplicate_of)) = parted(Dimension::<D>::duplicate_of(mesh), points) else {
        return Ok(Err(Restart::Broken));
    };
    if missing.len() > points.len() / PARTED {
        return Ok(Err(Restart::Parted));
    }
    let lattice = &Lattice::fit_by(threads, points)?;
    let names: Vec<u32> = (0..points.len() as u32).collect();
    let vertices = PredicateContext::new_by(threads, points, lattice, names);
    let mut moved = Moved {
        points,
        lattice,
        vertices: &vertices,
        threads,
        options,
        limits,
        stats: &mut stats,
        update: &mut *update,
        stopwatch: &mut stopwatch,
        removed: Vec::new(),
    };
    let mut triangulation = match Dimension::<D>::repair(&mut moved, mesh)? {
        Ok(triangulation) => triangulation,
        Err(why) => return Ok(Err(why)),
    };
    let removed = moved.removed;

    update.inserted = missing.len();
    update.reinserted = removed.len();
    missing.extend(removed);
    missing.sort_unstable();
    options.report(Phase::Finish, 0.9)?;
    let incident = Dimension::<D>::incident(&triangulation);
    // Points that are vertices, or will be, are those that are no duplicates.
    let is_missing = |v: u32| missing.binary_search_by_key(&v, |&[v, _]| v).is_ok();
    let is_complete = |(v, &t): (u32, &u32)| {
        (t != NO_INDEX) == (duplicate_of[v as usize] == NONE) || (t == NO_INDEX && is_missing(v))
    };
    if !(0..).zip(&incident[..points.len()]).all(is_complete) {
        return Ok(Err(Restart::Broken));
    }
    if !insert_parted(&mut triangulation, &vertices, &missing, &incident)? {
        return Ok(Err(Restart::Coincident));
    }
    stats.exact = stats.exact + vertices.exact_counts();
    let mut made = Dimension::<D>::mesh(triangulation, &vertices.into_input_indices(), threads, options);
    made.set_input(duplicate_of, D as u8);
    stats.phases.push((Phase::Finish, stopwatch.lap()));
    stats.update = Some(*update);
    *made.stats_mut() = stats;
    options.report(Phase::Finish, 1.0)?;
    Ok(Ok(made))
}

/// Returns the points that are no duplicates any more, each with the vertex that it duplicated; and
/// what the others duplicate, those that are unused themselves. `None` if duplicates of duplicates are given.
fn parted<const D: usize>(duplicate_of: &[i32], points: Points<'_, D>) -> Option<(Vec<[u32; 2]>, Vec<i32>)> {
    let mut merged = Vec::new();
    let mut duplicates = vec![NONE; points.len()];
    for (i, &first) in (0..).zip(duplicate_of) {
        if first == i {
            duplicates[i as usize] = i;
        } else if first != NONE {
            // The lowest index stands for a point.
            if first < 0 || first >= i || duplicate_of[first as usize] != NONE {
                return None;
            }
            merged.push([i as u32, first as u32]);
        }
    }
    let missing = missing_points(points, &merged, &mut duplicates);
    Some((missing, duplicates))
}

/// Inserts vertices, each from one near it. Returns whether there is no vertex yet at
/// any of their places.
fn insert_parted<const D: usize>(
    triangulation: &mut <Dimension<D> as Incremental<D>>::Triangulation,
    vertices: &PredicateContext<'_, D>,
    missing: &[[u32; 2]],
    incident: &[u32],
) -> Result<bool, Error>
where
    Dimension<D>: Update<D>,
{
    if missing.is_empty() {
        return Ok(true);
    }
    let mut scratch = triangulation.scratch();
    let first = incident.iter().copied().find(|&t| t != NO_INDEX);
    let mut last = first.expect("the triangulation has a simplex");
    for &[p, near] in missing {
        // What was at the vertex may have been replaced by an insertion since.
        let at_near = incident[near as usize];
        let is_there = |t: u32| Dimension::<D>::corners(triangulation, t).as_ref().contains(&near);
        let start = if at_near != NO_INDEX && is_there(at_near) { at_near } else { last };
        let start = triangulation.locate(vertices, p, start);
        let corners = Dimension::<D>::corners(triangulation, start);
        let is_there = |&v: &u32| (v as usize) < vertices.len() && vertices.point(v) == vertices.point(p);
        if corners.as_ref().iter().any(is_there) {
            return Ok(false);
        }
        last = triangulation.insert(vertices, p, start, &mut scratch)?.expect("nobody disturbs the only thread");
    }
    triangulation.finish(scratch);
    Ok(true)
}
