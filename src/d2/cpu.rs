//! 2D triangulation on the CPU: Bowyer–Watson insertion, point by point, with exact predicates.
//!
//! `points → lattice → insertion order → insert → drop the ghosts → input indices → mesh`

use super::{Mesh2, insert};
use crate::{
    Backend, Error, Options, Points2,
    input::{
        hilbert,
        lattice::Lattice,
        order::{Distinct, Order, insertion_order},
    },
    predicates::{filter::PredicateContext2, orient2d},
    stats::{Phase, Stats, Stopwatch},
};

/// Triangulates `points` by incremental insertion.
///
/// # Errors
///
/// Returns the errors of [`delaunay2d`](crate::delaunay2d) that are not a GPU's.
pub fn delaunay2d(points: Points2<'_>, options: &Options) -> Result<Mesh2, Error> {
    delaunay2d_in_order(points, options, Order::default())
}

/// Triangulates `points` by incremental insertion in a given order, on which the set of triangles
/// does not depend.
///
/// # Errors
///
/// Returns the errors of [`delaunay2d`](crate::delaunay2d) that are not a GPU's.
pub fn delaunay2d_in_order(points: Points2<'_>, options: &Options, order: Order) -> Result<Mesh2, Error> {
    if points.len() > insert::MAX_POINTS {
        return Err(Error::TooManyPoints { points: points.len(), limit: insert::MAX_POINTS });
    }
    let mut stopwatch = Stopwatch::start();
    let mut stats = Stats::new(Backend::Cpu);
    options.report(Phase::Sort, 0.0)?;
    points.validate()?;
    let lattice = Lattice::fit(points);
    let Distinct { mut order, duplicate_of } = insertion_order(points, &lattice, hilbert::index2d, order);
    let dimension = spanning_first(points, &mut order);
    let mut mesh = Mesh2 { duplicate_of, dimension, ..Mesh2::default() };
    stats.phases.push((Phase::Sort, stopwatch.lap()));
    if dimension == 2 {
        let vertices = PredicateContext2::new(points, &lattice, order);
        let inserted = insert::insert_all(&vertices, options)?;
        stats.phases.push((Phase::Insert, stopwatch.lap()));
        stats.exact = vertices.exact_counts();
        (mesh.triangles, mesh.halfedges, mesh.hull) =
            inserted.into_mesh(&vertices.into_input_indices(), options.winding);
        stats.phases.push((Phase::Finish, stopwatch.lap()));
    } else {
        order.sort_unstable_by(|&i, &j| {
            let [p, q] = [i, j].map(|i| points.get(i as usize));
            p.partial_cmp(&q).unwrap_or(std::cmp::Ordering::Equal)
        });
        mesh.hull = order;
    }
    options.report(Phase::Finish, 1.0)?;
    mesh.stats = stats;
    Ok(mesh)
}

/// Moves the first affinely independent points of `order` to its front, at most three, which are
/// then counter-clockwise. Returns the affine dimension of all points.
fn spanning_first(points: Points2<'_>, order: &mut [u32]) -> u8 {
    let point = |i: u32| points.get(i as usize);
    if order.len() < 2 {
        return 0;
    }
    let orient = |c: u32| orient2d(point(order[0]), point(order[1]), point(c));
    let Some(at) = (2..order.len()).find(|&k| orient(order[k]) != 0) else { return 1 };
    let clockwise = orient(order[at]) < 0;
    // A rotation keeps the order of the points that are jumped over.
    order[2..=at].rotate_right(1);
    if clockwise {
        order.swap(0, 1);
    }
    2
}
