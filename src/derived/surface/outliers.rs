//! Points that are far from all others: dust, reflections and birds.

use super::{
    super::complex::Complex,
    neighbors::{Tree, median},
    quadrics,
};
use crate::{
    geometry::{Euclidean, Geometry, vector},
    mesh::Csr,
    parallel::{self, Threads},
};

/// A point needs so many neighbours.
const NEIGHBORS: usize = 6;

/// A point is isolated if its neighbours are so many times farther than is usual.
const FACTOR: f64 = 4.0;

/// So many of the nearest points show whether they lie on a surface.
const SURROUNDING: usize = 32;

/// So many of those have to be as far from each other as the point is from them.
const MIN_ALIKE: usize = SURROUNDING / 2;

/// Points lie on a surface if their distance from a plane is at most this share of the distance to the last of
/// them. For points that are scattered in space it is about a third.
const THICK: f64 = 0.15;

/// Points are looked at again without those that were isolated, so often: a few may seem to lie on a surface by chance.
const ROUNDS: u32 = 4;

/// With fewer points, nothing is usual.
const MIN_POINTS: usize = 100;

/// The number of points by which the usual distance is found.
const SAMPLES: usize = 2000;

/// The number of points that is worth handing to another thread.
const GRAIN: usize = 1 << 10;

/// Returns whether each of some vertices is isolated. `tree` has their points.
///
/// The sixth nearest one is then more than four times as far away as the median over all; and as the median over the
/// nearest ones, or these are as far from each other but lie on no surface. So scans may become sparse with the distance,
/// while outliers that have each other for neighbours are found.
pub(super) fn isolated<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    stars: &Csr,
    vertices: &[u32],
    tree: &Tree<'_, D>,
) -> Vec<bool>
where
    Euclidean: Geometry<D, N>,
{
    let points = tree.points;
    let mut is_isolated = vec![false; points.len()];
    if points.len() < MIN_POINTS {
        return is_isolated;
    }
    let mut near = Vec::new();
    let samples = points.iter().step_by(points.len().div_ceil(SAMPLES));
    let mut samples: Vec<f64> = samples.map(|&p| reach(tree, p, &mut near)).collect();
    let limit = FACTOR * FACTOR * median(&mut samples).unwrap_or(0.0);
    let parts = parallel::map_grains(Threads::All, points.len(), GRAIN, |range| {
        let mut near = Vec::new();
        let mut is_far =
            |i: usize| !has_company(complex, stars, vertices[i], limit) && reach(tree, points[i], &mut near) > limit;
        range.filter(|&i| is_far(i)).collect::<Vec<usize>>()
    });
    let mut far: Vec<usize> = parallel::joined(parts);
    // Without those that are found, others have no neighbours left that seem to lie on a surface.
    for round in 0..ROUNDS {
        let left: Vec<[f64; D]> = match round {
            0 => Vec::new(),
            _ => points.iter().zip(&is_isolated).filter(|&(_, &is_isolated)| !is_isolated).map(|(&p, _)| p).collect(),
        };
        let fewer = Tree::new(&left);
        let tree = if round == 0 { tree } else { &fewer };
        let parts = parallel::map_grains(Threads::All, far.len(), GRAIN, |range| {
            let mut near = Vec::new();
            range.map(|i| is_apart(tree, points[far[i]], limit, &mut near)).collect::<Vec<bool>>()
        });
        let are_apart: Vec<bool> = parallel::joined(parts);
        far.iter().zip(&are_apart).for_each(|(&i, &is_apart)| is_isolated[i] = is_apart);
        far.retain(|&i| !is_isolated[i]);
        if far.is_empty() || !are_apart.contains(&true) {
            break;
        }
    }
    is_isolated
}

/// Returns whether one of the points of a tree is farther from its neighbours than `limit`, squared, and they are
/// nearer to each other or lie on no surface.
fn is_apart<const D: usize>(tree: &Tree<'_, D>, point: [f64; D], limit: f64, near: &mut Vec<(f64, u32)>) -> bool {
    let own = reach(tree, point, near);
    if own <= limit {
        return false;
    }
    // The first one is the point itself.
    tree.nearest(point, SURROUNDING + 1, near);
    let around: Vec<[f64; D]> = near.iter().skip(1).map(|&(_, j)| tree.points[j as usize]).collect();
    let reaches: Vec<f64> = around.iter().map(|&p| reach(tree, p, near)).collect();
    let usual = median(&mut reaches.iter().copied().take(NEIGHBORS).collect::<Vec<f64>>());
    if usual.is_none_or(|usual| own > FACTOR * FACTOR * usual) {
        return true;
    }
    // A dense part of the scan may be among the nearest ones.
    let alike = around.iter().zip(reaches).filter(|&(_, reach)| FACTOR * FACTOR * reach >= own);
    let alike: Vec<[f64; D]> = alike.map(|(&p, _)| vector::minus(p, point)).collect();
    alike.len() < MIN_ALIKE || quadrics::thickness(&alike) > THICK
}

/// Returns the squared distance from one of the points of a tree to the sixth nearest one.
fn reach<const D: usize>(tree: &Tree<'_, D>, point: [f64; D], near: &mut Vec<(f64, u32)>) -> f64 {
    tree.nearest(point, NEIGHBORS + 1, near);
    near.last().map_or(0.0, |&(squared, _)| squared)
}

/// Returns whether enough vertices are within a squared distance of a vertex: of its neighbours, or of the neighbours
/// of those. Then its [`reach`] is within that, too, but this is faster.
fn has_company<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, stars: &Csr, v: u32, limit: f64) -> bool {
    let point = complex.point(v);
    // First the vertex itself.
    let (mut found, mut count) = ([v; NEIGHBORS + 1], 1);
    let mut looked = 0;
    let mut direct = 1;
    while looked < direct {
        for &t in stars.of(found[looked]) {
            for &w in &complex.simplices[t as usize] {
                let is_new = !found[..count].contains(&w);
                if is_new && vector::squared_norm(vector::minus(complex.point(w), point)) <= limit {
                    found[count] = w;
                    count += 1;
                    if count > NEIGHBORS {
                        return true;
                    }
                }
            }
        }
        if looked == 0 {
            direct = count;
        }
        looked += 1;
    }
    false
}
