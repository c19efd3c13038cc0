//! 3D triangulation on the CPU: Bowyer–Watson insertion, point by point, with exact predicates.
//!
//! `points → lattice → insertion order → insert → drop the ghosts → input indices → mesh`

use super::{Mesh3, insert};
use crate::{
    Backend, Error, Options, Points,
    input::{
        hilbert,
        lattice::Lattice,
        order::{Distinct, Order, insertion_order},
    },
    parallel::Threads,
    predicates::{collinear, filter::PredicateContext, orient3d},
    stats::{Phase, Stats, Stopwatch},
};

/// Triangulates `points` by incremental insertion.
///
/// # Errors
///
/// Returns the errors of [`delaunay3d`](crate::delaunay3d) that are not a GPU's.
pub fn delaunay3d(points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
    delaunay3d_in_order(points, options, Order::default())
}

/// Triangulates `points` by incremental insertion in a given order, on which the set of tetrahedra
/// does not depend.
///
/// # Errors
///
/// Returns the errors of [`delaunay3d`](crate::delaunay3d) that are not a GPU's.
pub fn delaunay3d_in_order(points: Points<'_>, options: &Options, order: Order) -> Result<Mesh3, Error> {
    if points.len() > insert::MAX_POINTS {
        return Err(Error::TooManyPoints { points: points.len(), limit: insert::MAX_POINTS });
    }
    let mut stopwatch = Stopwatch::start();
    let mut stats = Stats::new(Backend::Cpu);
    options.report(Phase::Sort, 0.0)?;
    points.validate()?;
    let lattice = Lattice::fit(points);
    let Distinct { mut order, duplicate_of } = insertion_order(points, &lattice, hilbert::index3d, order);
    let dimension = spanning_first(points, &mut order);
    let mut mesh = Mesh3 { duplicate_of, dimension, ..Mesh3::default() };
    stats.phases.push((Phase::Sort, stopwatch.lap()));
    if dimension == 3 {
        let vertices = PredicateContext::new(points, &lattice, order);
        let inserted = insert::insert_all(&vertices, options)?;
        stats.phases.push((Phase::Insert, stopwatch.lap()));
        stats.exact = vertices.exact_counts();
        let finite = inserted.into_mesh(Some(&vertices.into_input_indices()), Threads::One);
        (mesh.tetrahedra, mesh.neighbors, mesh.hull) = (finite.tetrahedra, finite.neighbors, finite.hull);
        stats.phases.push((Phase::Finish, stopwatch.lap()));
    }
    options.report(Phase::Finish, 1.0)?;
    mesh.stats = stats;
    Ok(mesh)
}

/// Moves the first affinely independent points of `order` to its front, at most four, which are
/// then positively oriented. Returns the affine dimension of all points.
fn spanning_first(points: Points<'_>, order: &mut [u32]) -> u8 {
    let point = |i: u32| points.get(i as usize);
    // A rotation keeps the order of the points that are jumped over.
    let bring = |order: &mut [u32], from: usize, to: usize| order[to..=from].rotate_right(1);
    if order.len() < 2 {
        return 0;
    }
    let (a, b) = (point(order[0]), point(order[1]));
    let Some(at) = (2..order.len()).find(|&k| !collinear(a, b, point(order[k]))) else { return 1 };
    bring(order, at, 2);
    let c = point(order[2]);
    let orient = |d: u32| orient3d(a, b, c, point(d));
    let Some(at) = (3..order.len()).find(|&k| orient(order[k]) != 0) else { return 2 };
    bring(order, at, 3);
    if orient(order[3]) < 0 {
        order.swap(0, 1);
    }
    3
}
