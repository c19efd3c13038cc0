//! Points that come and go: a few vertices are inserted into a mesh or removed from it.
//!
//! `mesh → walks → vertices removed, by triangulating those around each → vertices inserted → patch
//! → mesh`
//!
//! An index whose point is removed stays *unused*: it is its own duplicate.
//!
//! **Removal.** The simplices that take the place of a vertex's star are those of the Delaunay
//! triangulation of the vertices around it that are in conflict with it: without the vertex they are
//! there, as nothing else lies in their circumspheres, and inserting it would make a cavity of them.
//! Ties are broken by input index in both triangulations, and ghosts are simplices like others, so
//! neither degenerate points nor the hull are special. Only where all vertices around it lie in one
//! plane, or on one line in 2D, those just beyond are taken as well.

use crate::{
    backend::Backend,
    cpu::{
        Grow, Incremental, Insert, MIN_SHARED, MeshOf, delaunay,
        sparse::{Patch, Row, Sparse},
        update::{Limits, Update},
    },
    dimension::Dimension,
    error::Error,
    index::{NO_INDEX, NONE},
    input::{
        lattice::Lattice,
        order::{Distinct, Order, insertion_order, mix},
        points::Points,
    },
    mesh::MeshInfo,
    options::{Options, Winding},
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    slots::{MarkedSlots, Slots},
    stats::{Phase, Restart, Stats, Stopwatch, UpdateStats},
};
use rustc_hash::{FxHashMap, FxHashSet};
use std::num::NonZeroUsize;

/// The number of points between two reports of progress.
const REPORT: usize = 1 << 6;

/// There are so many vertices around each of those that are removed, in the mean of uniform points.
const AROUND: f64 = 16.0;

/// So many vertices around those that are removed never keep them from being removed.
const MIN_AROUND: f64 = 4096.0;

/// What the insertion and the removal of a few points need of a dimension: `N` vertices per simplex.
pub trait Edit<const D: usize, const N: usize>: Update<D, Triangulation: Slots<N>> {
    /// The hull of a mesh.
    type Hull;

    /// The maximum number of simplices.
    const MAX_SIMPLICES: usize;
    /// The number of uniform points that are inserted in the time in which one is removed.
    const REMOVAL: f64;

    /// Returns the number of simplices of a mesh.
    fn count(mesh: &Self::Mesh) -> usize;

    /// Returns the vertices of simplex `t` of a mesh of this orientation, positively oriented, and
    /// its neighbours as [`Slots`] number them, [`NO_INDEX`] outside the hull; `None` if it is not
    /// there, or its neighbours are not.
    fn row(mesh: &Self::Mesh, winding: Winding, t: u32) -> Option<Row<N>>;

    /// Returns the vertices of the simplex that facet `across` belongs to, as [`row`](Self::row) has
    /// them, if `facet` is across that facet.
    fn beyond(mesh: &Self::Mesh, winding: Winding, facet: u32, across: u32) -> Option<[u32; N]>;

    /// Returns the ghost on the facet opposite corner `k`, the infinite vertex last.
    fn ghost(simplex: [u32; N], k: usize, infinite: u32) -> [u32; N];

    /// Returns whether a simplex is positively oriented.
    fn is_positive(vertices: &PredicateContext<'_, D>, simplex: [u32; N]) -> bool;

    /// Returns whether the circumsphere of simplex `t` contains vertex `v`.
    fn in_conflict(triangulation: &Self::Triangulation, vertices: &PredicateContext<'_, D>, v: u32, t: u32) -> bool;

    /// Returns the hull of a mesh without the facets of the ghosts in `removed`, whose vertices are
    /// sorted, and with those of the ghosts in `added`; `None` if that is not closed.
    fn hull(
        mesh: &Self::Mesh,
        removed: &FxHashSet<[u32; N]>,
        added: Vec<[u32; N]>,
        infinite: u32,
        winding: Winding,
    ) -> Option<Self::Hull>;

    /// Changes a mesh, for whose simplices there is room.
    fn apply(mesh: &mut Self::Mesh, patch: Patch<N, Self::Hull>, winding: Winding);

    /// Makes room for so many simplices.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfMemory`].
    fn reserve(mesh: &mut Self::Mesh, simplices: usize) -> Result<(), Error>;
}

/// What is to be done with the points of a mesh.
#[derive(Default)]
struct Plan {
    /// The vertices to be removed.
    removed: Vec<u32>,
    /// The duplicates that take the place of one of these.
    heirs: Vec<u32>,
    /// The field `duplicate_of` afterwards, without what the new points duplicate.
    duplicate_of: Vec<i32>,
}

/// Inserts the points that a mesh does not have yet, which are those from its number of points on,
/// and removes those with the indices in `removed`. If the points have to be triangulated from
/// scratch, returns what that takes; then and after an error the mesh is what it was.
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
    limits: Limits,
) -> Result<Option<Again>, Error>
where
    Dimension<D>: Edit<D, N>,
    for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
{
    let threads = if points.len() < MIN_SHARED { Some(NonZeroUsize::MIN) } else { options.threads };
    parallel::with_threads(threads, |threads| edit_by(threads, mesh, points, removed, options, limits))
}

/// Edits a mesh by `threads`, of which one does most of it.
fn edit_by<const D: usize, const N: usize>(
    threads: Threads,
    mesh: &mut MeshOf<D>,
    points: Points<'_, D>,
    removed: &[u32],
    options: &Options,
    limits: Limits,
) -> Result<Option<Again>, Error>
where
    Dimension<D>: Edit<D, N>,
    for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
{
    let mut stopwatch = Stopwatch::start();
    let mut stats = Stats::new(Backend::Cpu);
    options.report(Phase::Sort, 0.0)?;
    let known = Dimension::<D>::duplicate_of(mesh).len();
    if points.len() < known {
        return Err(Error::PointCount { points: points.len(), expected: known });
    }
    let limit = Dimension::<D>::MAX_POINTS;
    if points.len() > limit {
        return Err(Error::TooManyPoints { points: points.len(), limit });
    }
    check_indices(Dimension::<D>::duplicate_of(mesh), removed)?;
    let lattice = Lattice::fit_by(threads, points)?;
    let mut update = UpdateStats::default();
    let plan = Plan::new(Dimension::<D>::duplicate_of(mesh), points.len(), removed);
    let Plan { removed: vertices, heirs, mut duplicate_of } = match plan {
        Ok(plan) => plan,
        Err(duplicate_of) => {
            return Ok(Some(Again::new(Restart::Broken, duplicate_of)));
        }
    };
    let few = |removed: usize, inserted: usize| {
        let count = Dimension::<D>::REMOVAL * removed as f64 + inserted as f64;
        let pays = limits.check_points(count, points.len() as f64, parallel::count(threads));
        pays.and(if usize::from(mesh.dimension()) == D { Ok(()) } else { Err(Restart::Degenerate) })
    };
    let new = points.len() - known;
    let context = PredicateContext::of_input(points, &lattice);
    let ordered = few(vertices.len(), heirs.len() + new)
        .and_then(|()| in_order(threads, points, &lattice, &vertices).ok_or(Restart::Broken));
    let changed = match ordered {
        // The indices that are removed were duplicates.
        _ if vertices.is_empty() && new == 0 => Ok(None),
        Err(why) => Err(why),
        Ok(vertices) => {
            let order = order_of_new(threads, points, &lattice, known, &mut duplicate_of);
            stats.phases.push((Phase::Sort, stopwatch.lap()));
            let sparse = Sparse::new(mesh, &context, options.winding);
            let max_around = (AROUND * limits.points * points.len() as f64).max(MIN_AROUND);
            let mut editing = Editing { sparse, points, lattice: &lattice, context: &context, last: 0, max_around };
            editing
                .run(&vertices, &[heirs, order].concat(), &mut duplicate_of, options, &mut update)?
                .and_then(|()| editing.sparse.into_patch().map(Some).ok_or(Restart::Broken))
        }
    };
    let patch = match changed {
        Ok(patch) => patch,
        Err(why) => {
            duplicate_of[known..].fill(NONE);
            return Ok(Some(Again::new(why, duplicate_of)));
        }
    };
    stats.phases.push((Phase::Insert, stopwatch.lap()));
    options.report(Phase::Finish, 1.0)?;
    if let Some(patch) = patch {
        Dimension::<D>::reserve(mesh, patch.count)?;
        Dimension::<D>::apply(mesh, patch, options.winding);
    }
    mesh.set_input(duplicate_of, mesh.dimension());
    stats.exact = context.exact_counts();
    stats.phases.push((Phase::Finish, stopwatch.lap()));
    stats.update = Some(update);
    *mesh.stats_mut() = stats;
    Ok(None)
}

/// What it takes to triangulate the points of a mesh from scratch, some of which are unused.
#[derive(Debug)]
pub struct Again {
    /// What is said of the attempt to do without.
    pub update: UpdateStats,
    /// For the points that are unused, their own index, as in the field of a mesh.
    pub(crate) unused: Vec<i32>,
}

impl Again {
    fn new(why: Restart, unused: Vec<i32>) -> Self {
        Again { update: UpdateStats { restarted: Some(why), ..UpdateStats::default() }, unused }
    }

    /// Returns the points that are used; `None` if all are.
    pub fn used<const D: usize>(&self, points: Points<'_, D>) -> Option<Used<D>> {
        Used::of(points, &self.unused)
    }
}

/// The points of a mesh that are used.
#[derive(Debug)]
pub struct Used<const D: usize> {
    /// Their indices, ascending.
    names: Vec<u32>,
    /// Their coordinates.
    points: Vec<[f64; D]>,
    /// The number of all points.
    all: usize,
}

impl<const D: usize> Used<D> {
    /// Returns the used ones of these points, given the field `duplicate_of` of their mesh; `None` if
    /// all are.
    pub fn of(points: Points<'_, D>, duplicate_of: &[i32]) -> Option<Self> {
        let is_unused = |i: u32| duplicate_of.get(i as usize) == Some(&(i as i32));
        let all = points.len();
        if !(0..all as u32).any(is_unused) {
            return None;
        }
        let names: Vec<u32> = (0..all as u32).filter(|&i| !is_unused(i)).collect();
        let points = names.iter().map(|&i| points.get(i as usize)).collect();
        Some(Used { names, points, all })
    }

    /// Returns the points.
    pub fn points(&self) -> Points<'_, D> {
        Points::F64(&self.points)
    }

    /// Makes the mesh of these points that of all points, with at most so many threads.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Threads`].
    pub fn restore(&self, mesh: &mut (impl MeshInfo + Send), threads: Option<NonZeroUsize>) -> Result<(), Error> {
        let mut duplicate_of: Vec<i32> = (0..self.all as i32).collect();
        for (&name, &first) in self.names.iter().zip(mesh.duplicate_of()) {
            duplicate_of[name as usize] = if first == NONE { NONE } else { self.names[first as usize] as i32 };
        }
        let threads = if self.all < MIN_SHARED { Some(NonZeroUsize::MIN) } else { threads };
        parallel::with_threads(threads, |threads| {
            mesh.rename(threads, &self.names);
            Ok(())
        })?;
        mesh.set_input(duplicate_of, mesh.dimension());
        Ok(())
    }
}

/// Triangulates the used points by the CPU engine, as [`Triangulator`](crate::Triangulator) does by
/// any.
///
/// # Errors
///
/// Returns the errors of [`delaunay`](crate::cpu::delaunay).
pub fn delaunay_of_used<const D: usize>(
    points: Points<'_, D>,
    used: Option<&Used<D>>,
    update: UpdateStats,
    options: &Options,
) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Incremental<D>,
{
    let mut mesh = delaunay(used.map_or(points, Used::points), options)?;
    if let Some(used) = used {
        used.restore(&mut mesh, options.threads)?;
    }
    mesh.stats_mut().update = Some(update);
    Ok(mesh)
}

/// Checks that the points with these indices can be removed from a mesh with this field
/// `duplicate_of`.
///
/// # Errors
///
/// Returns [`Error::BadIndex`].
pub(crate) fn check_indices(duplicate_of: &[i32], removed: &[u32]) -> Result<(), Error> {
    let mut seen = FxHashSet::default();
    for &index in removed {
        let why = match duplicate_of.get(index as usize) {
            None => "there is no such point",
            Some(&first) if first == index as i32 => "it was removed before",
            Some(_) if !seen.insert(index) => "it is given twice",
            Some(_) => continue,
        };
        return Err(Error::BadIndex { index, why });
    }
    Ok(())
}

impl Plan {
    /// Plans to remove points, and to add some until there are so many. Fails with what the field is
    /// to be if that of the mesh is not one.
    fn new(before: &[i32], points: usize, removed: &[u32]) -> Result<Self, Vec<i32>> {
        let mut duplicate_of = Vec::with_capacity(points);
        duplicate_of.extend_from_slice(before);
        duplicate_of.resize(points, NONE);
        for &i in removed {
            duplicate_of[i as usize] = i as i32;
        }
        let mut plan = Plan::default();
        let mut heir_of = FxHashMap::default();
        for &i in removed.iter().filter(|&&i| before[i as usize] == NONE) {
            plan.removed.push(i);
            heir_of.insert(i as i32, NONE);
        }
        let mut is_valid = true;
        for (i, &first) in (0..).zip(before) {
            // Of the duplicates, the lowest index stands for a point.
            if first == NONE || first == i {
                continue;
            }
            is_valid &= (0..i).contains(&first) && before[first as usize] == NONE;
            if let Some(heir) = heir_of.get_mut(&first)
                && duplicate_of[i as usize] != i
            {
                if *heir == NONE {
                    *heir = i;
                    plan.heirs.push(i as u32);
                    duplicate_of[i as usize] = NONE;
                } else {
                    duplicate_of[i as usize] = *heir;
                }
            }
        }
        if !is_valid {
            // What is unused is still known.
            let unused = |(i, first): (i32, &mut i32)| *first = if *first == i { i } else { NONE };
            (0..).zip(&mut duplicate_of).for_each(unused);
            return Err(duplicate_of);
        }
        plan.duplicate_of = duplicate_of;
        Ok(plan)
    }
}

/// Returns these points in an order in which each is near the one before; `None` if two are equal.
fn in_order<const D: usize>(
    threads: Threads,
    points: Points<'_, D>,
    lattice: &Lattice<D>,
    indices: &[u32],
) -> Option<Vec<u32>>
where
    Dimension<D>: Incremental<D>,
{
    let points: Vec<[f64; D]> = indices.iter().map(|&i| points.get(i as usize)).collect();
    let Distinct { order, .. } =
        insertion_order(threads, Points::F64(&points), lattice, Dimension::<D>::CURVE, Order::Brio);
    (order.len() == indices.len()).then(|| order.into_iter().map(|i| indices[i as usize]).collect())
}

/// Returns the new points in an order in which each is near the one before, without those that
/// duplicate another new one, which are noted.
fn order_of_new<const D: usize>(
    threads: Threads,
    points: Points<'_, D>,
    lattice: &Lattice<D>,
    known: usize,
    duplicate_of: &mut [i32],
) -> Vec<u32>
where
    Dimension<D>: Incremental<D>,
{
    let new = points.range(known..points.len());
    let Distinct { order, duplicate_of: of_new, .. } =
        insertion_order(threads, new, lattice, Dimension::<D>::CURVE, Order::Brio);
    for (first, of_new) in duplicate_of[known..].iter_mut().zip(of_new) {
        *first = if of_new == NONE { NONE } else { of_new + known as i32 };
    }
    order.into_iter().map(|i| i + known as u32).collect()
}

/// A mesh whose vertices come and go.
struct Editing<'m, 'p, const D: usize, const N: usize>
where
    Dimension<D>: Edit<D, N>,
{
    sparse: Sparse<'m, 'p, D, N>,
    points: Points<'p, D>,
    lattice: &'m Lattice<D>,
    context: &'m PredicateContext<'p, D>,
    /// A simplex.
    last: u32,
    /// How many vertices there may still be around those that are removed.
    max_around: f64,
}

impl<const D: usize, const N: usize> Editing<'_, '_, D, N>
where
    Dimension<D>: Edit<D, N>,
    Self: Sized,
    for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
{
    /// Removes vertices, then inserts others, or notes what they duplicate. Says why it does not
    /// work or pay.
    fn run(
        &mut self,
        removed: &[u32],
        inserted: &[u32],
        duplicate_of: &mut [i32],
        options: &Options,
        update: &mut UpdateStats,
    ) -> Result<Result<(), Restart>, Error> {
        let known = Dimension::<D>::duplicate_of(self.sparse.mesh()).len();
        let all = (removed.len() + inserted.len()) as f64;
        let report = |done: usize| match done % REPORT {
            0 => options.report(Phase::Insert, done as f64 / all),
            _ => Ok(()),
        };
        for (i, &v) in removed.iter().enumerate() {
            report(i)?;
            if let Err(why) = self.remove(v)? {
                return Ok(Err(why));
            }
        }
        update.removed = removed.len();
        let mut scratch = self.sparse.scratch();
        let mut aliases = FxHashMap::default();
        for (i, &p) in inserted.iter().enumerate() {
            report(removed.len() + i)?;
            let at = self.sparse.locate(self.context, p, self.last);
            let is_there =
                |&v: &u32| (v as usize) < self.points.len() && self.context.point(v) == self.context.point(p);
            if let Some(v) = self.sparse.corners(at).into_iter().find(is_there) {
                if v >= p {
                    return Ok(Err(Restart::Broken));
                }
                duplicate_of[p as usize] = v as i32;
                aliases.insert(p as i32, v as i32);
                continue;
            }
            match self.sparse.insert(self.context, p, at, &mut scratch)? {
                Some(t) if self.sparse.is_sound() => self.last = t,
                _ => return Ok(Err(Restart::Broken)),
            }
            update.inserted += 1;
        }
        self.sparse.finish(scratch);
        if !aliases.is_empty() {
            // Other new points may be duplicates of those that turned out to be duplicates.
            for first in &mut duplicate_of[known..] {
                *first = aliases.get(first).copied().unwrap_or(*first);
            }
        }
        Ok(Ok(()))
    }

    /// Removes vertex `v`, or says why that does not work.
    fn remove(&mut self, v: u32) -> Result<Result<(), Restart>, Error> {
        let at = self.sparse.locate(self.context, v, self.last);
        let Some(Star { simplices, facets, around, beyond }) = self.star(at, v) else {
            return Ok(Err(Restart::Broken));
        };
        self.max_around -= around.len() as f64;
        if self.max_around < 0.0 {
            return Ok(Err(Restart::Points));
        }
        let mut order = around;
        // In no order that a caller could choose.
        order.sort_unstable_by_key(|&v| mix(v.into()));
        if usize::from(Dimension::<D>::spanning_first(self.points, &mut order)) < D {
            order.extend(beyond);
            order.sort_unstable();
            order.dedup();
            if usize::from(Dimension::<D>::spanning_first(self.points, &mut order)) < D {
                return Ok(Err(Restart::Degenerate));
            }
        }
        order.push(v);
        let Some(small) = Small::new::<N>(self.points, self.lattice, order)? else {
            return Ok(Err(Restart::Broken));
        };
        let Some(cavity) = small.cavity::<N>() else { return Ok(Err(Restart::Broken)) };

        let infinite = self.sparse.infinite();
        let name = |v: u32| small.names.get(v as usize).copied().unwrap_or(infinite);
        let mut slots = simplices;
        let unused = slots.split_off(cavity.len().min(slots.len()));
        unused.into_iter().for_each(|t| self.sparse.discard(t));
        while slots.len() < cavity.len() {
            slots.push(self.sparse.push()?);
        }
        let places: FxHashMap<u32, u32> = cavity.iter().copied().zip(slots.iter().copied()).collect();
        let mut sewn = 0;
        for (&t, &slot) in cavity.iter().zip(&slots) {
            let simplex = small.triangulation.simplex(t).map(name);
            let mut neighbors = small.triangulation.neighbors(t);
            for (k, neighbor) in neighbors.iter_mut().enumerate() {
                if let Some(slot) = places.get(&(*neighbor >> 2)) {
                    *neighbor = 4 * slot + (*neighbor & 3);
                    continue;
                }
                let Some(&across) = facets.get(&facet_of(simplex, k)) else { return Ok(Err(Restart::Broken)) };
                self.sparse.set_neighbor(across, 4 * slot + k as u32);
                *neighbor = across;
                sewn += 1;
            }
            self.sparse.set_simplex(slot, simplex);
            self.sparse.set_neighbors(slot, neighbors);
        }
        self.context.add_counts(small.context.exact_counts());
        self.last = slots[0];
        Ok(if sewn == facets.len() && self.sparse.is_sound() { Ok(()) } else { Err(Restart::Broken) })
    }

    /// Returns what is around vertex `v`, which simplex `at` has; `None` if it does not, or the star is
    /// none.
    fn star(&self, at: u32, v: u32) -> Option<Star<N>> {
        let infinite = self.sparse.infinite();
        let mut star =
            Star { simplices: vec![at], facets: FxHashMap::default(), around: Vec::new(), beyond: Vec::new() };
        let mut seen: FxHashSet<u32> = [at].into_iter().collect();
        let mut next = 0;
        while let Some(&t) = star.simplices.get(next) {
            next += 1;
            let simplex = self.sparse.simplex(t);
            let neighbors = self.sparse.neighbors(t);
            let place = simplex.iter().position(|&w| w == v)?;
            for (k, &across) in neighbors.iter().enumerate() {
                if k != place && seen.insert(across >> 2) {
                    star.simplices.push(across >> 2);
                }
            }
            let across = neighbors[place];
            let beyond = *self.sparse.corners(across >> 2).get(across as usize & 3)?;
            if star.facets.insert(facet_of(simplex, place), across).is_some() || beyond == v {
                return None;
            }
            star.around.extend(simplex.into_iter().filter(|&w| w != v && w != infinite));
            star.beyond.extend(Some(beyond).filter(|&w| w != infinite));
        }
        star.around.sort_unstable();
        star.around.dedup();
        Some(star)
    }
}

/// What is around a vertex.
struct Star<const N: usize> {
    /// The simplices.
    simplices: Vec<u32>,
    /// What is across each facet opposite the vertex, by [`facet_of`].
    facets: FxHashMap<[u32; N], u32>,
    /// The vertices of these facets.
    around: Vec<u32>,
    /// The vertices opposite these facets on the other side.
    beyond: Vec<u32>,
}

/// Returns what is the same for both simplices of the facet opposite corner `k`: its vertices,
/// sorted, and [`NO_INDEX`].
fn facet_of<const N: usize>(mut simplex: [u32; N], k: usize) -> [u32; N] {
    simplex[k] = NO_INDEX;
    simplex.sort_unstable();
    simplex
}

/// A triangulation of the vertices around one that is to be removed.
struct Small<'p, const D: usize>
where
    Dimension<D>: Incremental<D>,
{
    triangulation: <Dimension<D> as Incremental<D>>::Triangulation,
    context: PredicateContext<'p, D>,
    /// The input indices of the vertices, of which the last one is not inserted.
    names: Vec<u32>,
    /// A simplex.
    last: u32,
}

impl<'p, const D: usize> Small<'p, D>
where
    Dimension<D>: Incremental<D>,
{
    /// Triangulates these vertices except for the last one. The first `D + 1` are positively
    /// oriented. Returns `None` if two of them are equal.
    fn new<const N: usize>(points: Points<'p, D>, lattice: &Lattice<D>, names: Vec<u32>) -> Result<Option<Self>, Error>
    where
        Dimension<D>: Edit<D, N>,
    {
        let context = PredicateContext::new(points, lattice, names.clone());
        let mut triangulation = <Dimension<D> as Incremental<D>>::Triangulation::initial(names.len() as u32);
        let mut scratch = triangulation.scratch();
        let mut last = 0;
        for p in D as u32 + 1..names.len() as u32 - 1 {
            let start = triangulation.locate(&context, p, last);
            let is_there = |&v: &u32| v < p && context.point(v) == context.point(p);
            if triangulation.simplex(start).iter().any(is_there) {
                return Ok(None);
            }
            last = triangulation.insert(&context, p, start, &mut scratch)?.expect("nobody disturbs the only thread");
        }
        triangulation.finish(scratch);
        Ok(Some(Small { triangulation, context, names, last }))
    }

    /// Returns the simplices in conflict with the last vertex; `None` if there are none.
    fn cavity<const N: usize>(&self) -> Option<Vec<u32>>
    where
        Dimension<D>: Edit<D, N>,
    {
        let v = self.names.len() as u32 - 1;
        let is_in_conflict = |t: u32| Dimension::<D>::in_conflict(&self.triangulation, &self.context, v, t);
        let start = self.triangulation.locate(&self.context, v, self.last);
        if !is_in_conflict(start) {
            return None;
        }
        let mut cavity = vec![start];
        let mut seen: FxHashSet<u32> = [start].into_iter().collect();
        let mut next = 0;
        while let Some(&t) = cavity.get(next) {
            next += 1;
            for across in Slots::<N>::neighbors(&self.triangulation, t) {
                let u = across >> 2;
                if seen.insert(u) && is_in_conflict(u) {
                    cavity.push(u);
                }
            }
        }
        Some(cavity)
    }
}
