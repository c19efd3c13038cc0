//! Points that are far from all others: dust, reflections and birds.

use super::super::complex::Complex;
use crate::{
    geometry::vector,
    mesh::Csr,
    parallel::{self, Threads},
};

/// A point needs so many neighbours, as far as it has so many at all.
const NEIGHBORS: usize = 6;

/// A point is isolated if its neighbours are so many times farther than is usual.
const FACTOR: f64 = 4.0;

/// With fewer points, nothing is usual.
const MIN_POINTS: usize = 100;

/// The number of points by which the usual distance is found.
const SAMPLES: usize = 2000;

/// The number of points that is worth handing to another thread.
const GRAIN: usize = 1 << 10;

/// Returns whether each vertex is isolated: its sixth nearest vertex is more than four times as far away as the median over
/// all vertices, and as the median over its neighbours. The second condition lets scans become sparse with the distance.
pub(super) fn isolated<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, stars: &Csr) -> Vec<bool> {
    let count = complex.points().len() as u32;
    if stars.len() < MIN_POINTS {
        return vec![false; count as usize];
    }
    let mut samples: Vec<f64> = (0..count)
        .step_by((count as usize).div_ceil(SAMPLES))
        .filter(|&v| !stars.of(v).is_empty())
        .map(|v| reach(complex, stars, v))
        .collect();
    let Some(usual) = median(&mut samples) else { return vec![false; count as usize] };
    let parts = parallel::map_grains(Threads::All, count as usize, GRAIN, |range| {
        let is_isolated = |v: usize| {
            let v = v as u32;
            let limit = FACTOR * FACTOR * usual;
            if stars.of(v).is_empty() || has_company(complex, stars, v, limit) {
                return false;
            }
            let own = reach(complex, stars, v);
            if own <= limit {
                return false;
            }
            let mut others: Vec<f64> = neighbors(complex, stars, v).iter().map(|&w| reach(complex, stars, w)).collect();
            median(&mut others).is_some_and(|around| own > FACTOR * FACTOR * around)
        };
        range.map(is_isolated).collect::<Vec<bool>>()
    });
    parallel::joined(parts)
}

/// Returns whether enough vertices are within a squared distance of a vertex: of its neighbours, or of the neighbours
/// of those. Then its [`reach`] is within that, too, but this looks at fewer.
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

/// Returns the vertices that share a simplex with `v`.
fn neighbors<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, stars: &Csr, v: u32) -> Vec<u32> {
    let vertices = stars.of(v).iter().flat_map(|&t| complex.simplices[t as usize]);
    let mut neighbors: Vec<u32> = vertices.filter(|&w| w != v).collect();
    neighbors.sort_unstable();
    neighbors.dedup();
    neighbors
}

/// Returns the squared distance from a vertex to the sixth nearest one, or to the last one if there are
/// fewer. Of a vertex on a surface, most neighbours in the mesh may lie across the solid, so that those
/// of its nearest neighbours are looked at as well.
fn reach<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, stars: &Csr, v: u32) -> f64 {
    let point = complex.point(v);
    let squared = |w: u32| vector::squared_norm(vector::minus(complex.point(w), point));
    let mut near = neighbors(complex, stars, v);
    near.sort_unstable_by(|&a, &b| squared(a).total_cmp(&squared(b)));
    for i in 0..near.len().min(NEIGHBORS - 1) {
        near.extend(neighbors(complex, stars, near[i]));
    }
    near.sort_unstable();
    near.dedup();
    let mut distances: Vec<f64> = near.into_iter().filter(|&w| w != v).map(squared).collect();
    distances.sort_unstable_by(f64::total_cmp);
    distances.get(NEIGHBORS - 1).or(distances.last()).copied().unwrap_or(0.0)
}

/// Returns the median of numbers; `None` if there are none.
pub(super) fn median(numbers: &mut [f64]) -> Option<f64> {
    numbers.sort_unstable_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied()
}
