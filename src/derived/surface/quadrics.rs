//! Noise: how far points lie from smooth surfaces through their neighbours, and moving them there.
//!
//! Around each point a quadric *z*(*u*, *v*), in 2D a parabola *z*(*u*), is fitted by least squares (the
//! jets of Cazals and Pouget, *Estimating differential quantities using polynomial fitting of osculating
//! jets*, 2003). Unlike planes, quadrics do not shrink what is curved.

use super::neighbors::{Tree, median};
use crate::{
    geometry::vector,
    parallel::{self, Threads},
};
use std::f64::consts::PI;

/// The number of neighbours, the point included.
const NEIGHBORS: usize = 40;

/// With fewer points, neighbourhoods are not small.
pub(super) const MIN_POINTS: usize = 8 * NEIGHBORS;

/// The numbers of neighbours that are taken, and what their mean distance from the quadric is multiplied by: fewer points
/// come closer to their own quadric, whatever the noise.
const COUNTS: [(usize, f64); 3] = [(NEIGHBORS, 1.0), (20, 1.25), (12, 2.0)];

/// Neighbours do not fit one quadric if their mean distance from it is so many times larger than that of fewer: there is
/// an edge, or another sheet.
const MISFIT: f64 = 1.5;

/// The number of points of a plane, in 2D and in 3D, the point included.
const NEAREST: [usize; 2] = [5, 9];

/// Points lie in a plane if they are not farther from it than this share of their distance. With the least noise that is
/// mended they are farther: three times.
const FLAT: f64 = 0.01;

/// The number of points by which noise is estimated.
const SAMPLES: usize = 2000;

/// Points that are farther from a quadric, in units of their distance, do not fit it: there is an edge.
const MAX_RESIDUAL: f64 = 0.1;

/// The number of points that is worth handing to another thread.
const GRAIN: usize = 1 << 9;

/// The coefficients of a quadric: of 1, u, v, u², uv, v².
const MAX_TERMS: usize = 6;

/// A quadric that was fitted to the neighbours of a point.
struct Fit<const D: usize> {
    /// What moves the point onto the quadric.
    offset: [f64; D],
    /// The mean distance of the neighbours from the quadric.
    residual: f64,
    /// The distance between points that has as many of them in a disk.
    spacing: f64,
}

/// Returns the median distance of points from quadrics through their neighbours, in units of the
/// distance between points.
///
/// It is 0 where a quarter of the points lie in a plane with the nearest ones: there is no noise then, but edges, of which the
/// neighbours have some where faces have few points.
pub(super) fn noise<const D: usize>(tree: &Tree<'_, D>) -> f64 {
    let points = tree.points;
    let mut from_planes = of_samples(points, |point, near| from_plane(tree, point, near));
    from_planes.sort_unstable_by(f64::total_cmp);
    if from_planes.get(from_planes.len() / 4).is_none_or(|&quarter| quarter < FLAT) {
        return 0.0;
    }
    // Noise is the same with few neighbours and with many. Where it is less with few, the others lie on another sheet.
    let from_quadrics = of_samples(points, |point, near| {
        let noise = |(factor, fit): (f64, Fit<D>)| {
            if fit.spacing > 0.0 { factor * fit.residual / fit.spacing } else { 0.0 }
        };
        fits(tree, point, near).map(noise)
    });
    let noises = (0..COUNTS.len()).map(|i| {
        let mut noises: Vec<f64> = from_quadrics.iter().map(|noises| noises[i]).collect();
        median(&mut noises).unwrap_or(0.0)
    });
    noises.fold(f64::INFINITY, f64::min)
}

/// Returns the results of `work` for a sample of the points. It gets memory for the neighbours of a point.
fn of_samples<const D: usize, R: Clone + Send>(
    points: &[[f64; D]],
    work: impl Fn([f64; D], &mut Vec<(f64, u32)>) -> R + Sync,
) -> Vec<R> {
    let step = points.len().div_ceil(SAMPLES);
    let samples: Vec<u32> = (0..points.len() as u32).step_by(step).collect();
    let parts = parallel::map_grains(Threads::All, samples.len(), GRAIN, |range| {
        let mut near = Vec::new();
        samples[range].iter().map(|&i| work(points[i as usize], &mut near)).collect::<Vec<R>>()
    });
    parallel::joined(parts)
}

/// Returns how far the points next to one are from a plane, in 2D a line, in units of the distance between points.
fn from_plane<const D: usize>(tree: &Tree<'_, D>, point: [f64; D], near: &mut Vec<(f64, u32)>) -> f64 {
    tree.nearest(point, NEAREST[D - 2], near);
    let around: Vec<[f64; D]> = near.iter().map(|&(_, j)| vector::minus(tree.points[j as usize], point)).collect();
    thickness(&around)
}

/// Returns how far points are from a plane, in 2D a line, in units of the distance from the origin to the last one.
pub(super) fn thickness<const D: usize>(points: &[[f64; D]]) -> f64 {
    let radius = points.last().map_or(0.0, |&p| vector::norm(p));
    if radius == 0.0 {
        return 0.0;
    }
    let count = points.len() as f64;
    let center = vector::times(1.0 / count, points.iter().copied().fold([0.0; D], vector::plus));
    let mut covariance = [[0.0; D]; D];
    for q in points.iter().map(|&q| vector::minus(q, center)) {
        for (row, x) in covariance.iter_mut().zip(q) {
            *row = vector::plus(*row, vector::times(x, q));
        }
    }
    let normal = axes(covariance)[0];
    let heights = points.iter().map(|&q| vector::dot(normal, vector::minus(q, center)));
    (heights.map(|height| height * height).sum::<f64>() / count).sqrt() / radius
}

/// Returns the points of a tree, each moved onto the quadric through its neighbours.
pub(super) fn projected<const D: usize>(tree: &Tree<'_, D>) -> Vec<[f64; D]> {
    let points = tree.points;
    let parts = parallel::map_grains(Threads::All, points.len(), GRAIN, |range| {
        let mut near = Vec::new();
        range
            .map(|i| {
                let moved = vector::plus(points[i], best_fit(tree, points[i], &mut near).offset);
                if moved.iter().all(|x| x.is_finite()) { moved } else { points[i] }
            })
            .collect::<Vec<_>>()
    });
    parallel::joined(parts)
}

/// Returns what moves a place onto the quadric through the points around it; `None` if they do not fit one.
pub(super) fn offset<const D: usize>(
    tree: &Tree<'_, D>,
    place: [f64; D],
    near: &mut Vec<(f64, u32)>,
) -> Option<[f64; D]> {
    // Of points that are not noisy, fewer would only be rougher.
    tree.nearest(place, NEIGHBORS, near);
    let fit = fit(tree.points, place, near);
    let is_good = fit.residual <= MAX_RESIDUAL * fit.spacing && fit.offset.iter().all(|x| x.is_finite());
    is_good.then_some(fit.offset)
}

/// Fits a quadric to the points around one: to fewer where not all fit.
fn best_fit<const D: usize>(tree: &Tree<'_, D>, point: [f64; D], near: &mut Vec<(f64, u32)>) -> Fit<D> {
    let [first, others @ ..] = fits(tree, point, near);
    let fewer = |best: (f64, Fit<D>), fewer: (f64, Fit<D>)| {
        if best.0 * best.1.residual > MISFIT * fewer.0 * fewer.1.residual { fewer } else { best }
    };
    others.into_iter().fold(first, fewer).1
}

/// Fits quadrics to the points around one, for each of [`COUNTS`]. Returns them with the factors of their distances.
fn fits<const D: usize>(
    tree: &Tree<'_, D>,
    point: [f64; D],
    near: &mut Vec<(f64, u32)>,
) -> [(f64, Fit<D>); COUNTS.len()] {
    tree.nearest(point, NEIGHBORS, near);
    COUNTS.map(|(count, factor)| (factor, fit(tree.points, point, &near[..near.len().min(count)])))
}

/// Fits a quadric to points near one, in order of their distances. The nearer ones weigh more.
fn fit<const D: usize>(points: &[[f64; D]], point: [f64; D], near: &[(f64, u32)]) -> Fit<D> {
    let radius = near.last().map_or(0.0, |&(squared, _)| squared.sqrt());
    let mut fit = Fit { offset: [0.0; D], residual: 0.0, spacing: 0.0 };
    if radius == 0.0 {
        return fit;
    }
    let count = near.len() as f64;
    fit.spacing = if D == 3 { radius * (PI / count).sqrt() } else { 2.0 * radius / count };
    // Relative to the point, in units of the radius.
    let weighted: Vec<([f64; D], f64)> = near
        .iter()
        .map(|&(squared, j)| {
            let q = vector::times(1.0 / radius, vector::minus(points[j as usize], point));
            (q, weight(squared / (radius * radius)))
        })
        .collect();
    let total: f64 = weighted.iter().map(|(_, weight)| weight).sum();
    let sum = weighted.iter().fold([0.0; D], |sum, &(q, weight)| vector::plus(sum, vector::times(weight, q)));
    let center = vector::times(1.0 / total, sum);
    let mut covariance = [[0.0; D]; D];
    for &(q, weight) in &weighted {
        let q = vector::minus(q, center);
        for (row, x) in covariance.iter_mut().zip(q) {
            *row = vector::plus(*row, vector::times(weight * x, q));
        }
    }
    // The first axis is the normal.
    let frame = axes(covariance);
    let mut system = [[0.0; MAX_TERMS + 1]; MAX_TERMS];
    for &(q, weight) in &weighted {
        let local = frame.map(|axis| vector::dot(axis, q));
        let (terms, count) = terms(local);
        for (a, row) in system.iter_mut().enumerate().take(count) {
            let term = weight * terms[a];
            row[a..count].iter_mut().zip(&terms[a..]).for_each(|(entry, other)| *entry += term * other);
            row[MAX_TERMS] += term * local[0];
        }
    }
    let count = terms([0.0; D]).1;
    // The matrix is symmetric.
    for a in 1..count {
        let (above, rest) = system.split_at_mut(a);
        rest[0].iter_mut().zip(above).for_each(|(entry, row)| *entry = row[a]);
    }
    let coefficients = solve(system, count);
    fit.offset = vector::times(radius * coefficients[0], frame[0]);
    let squares = weighted.iter().map(|&(q, weight)| {
        let local = frame.map(|axis| vector::dot(axis, q));
        let height: f64 = terms(local).0.iter().zip(coefficients).map(|(term, c)| term * c).sum();
        weight * (local[0] - height) * (local[0] - height)
    });
    fit.residual = radius * (squares.sum::<f64>() / total).sqrt();
    fit
}

/// Returns the products of up to two of all coordinates but the first, and how many there are.
fn terms<const D: usize>(local: [f64; D]) -> ([f64; MAX_TERMS], usize) {
    let mut terms = [0.0; MAX_TERMS];
    terms[0] = 1.0;
    let mut count = 1;
    let mut add = |term: f64| {
        terms[count] = term;
        count += 1;
    };
    let (_, coordinates) = local.split_at(1);
    coordinates.iter().for_each(|&x| add(x));
    for (a, x) in coordinates.iter().enumerate() {
        coordinates[a..].iter().for_each(|y| add(x * y));
    }
    (terms, count)
}

/// Returns the weight of a point by its squared distance as a share of the largest one: exp(−3·share), with a relative
/// error below 0.001.
fn weight(share: f64) -> f64 {
    let x = 3.0 / 8.0 * share;
    let root = 1.0 - x * (1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0 - x / 24.0)));
    let square = root * root;
    let fourth = square * square;
    fourth * fourth
}

/// Returns the eigenvectors of a symmetric matrix by ascending eigenvalues, by Jacobi's rotations.
fn axes<const D: usize>(mut matrix: [[f64; D]; D]) -> [[f64; D]; D] {
    let mut vectors: [[f64; D]; D] = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    // Each sweep squares what is left beside the diagonal.
    for _ in 0..12 {
        for p in 0..D {
            for q in p + 1..D {
                // What does not change the diagonal in the least does not turn the axes.
                let least = matrix[p][p].abs().min(matrix[q][q].abs());
                if least + matrix[p][q].abs() == least {
                    continue;
                }
                let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
                let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                let sine = tangent * cosine;
                let turned = |x: f64, y: f64| (cosine * x - sine * y, sine * x + cosine * y);
                for row in &mut matrix {
                    (row[p], row[q]) = turned(row[p], row[q]);
                }
                for k in 0..D {
                    (matrix[p][k], matrix[q][k]) = turned(matrix[p][k], matrix[q][k]);
                    (vectors[p][k], vectors[q][k]) = turned(vectors[p][k], vectors[q][k]);
                }
            }
        }
    }
    let mut order: [usize; D] = std::array::from_fn(|i| i);
    order.sort_by(|&i, &j| matrix[i][i].total_cmp(&matrix[j][j]));
    order.map(|i| vectors[i])
}

/// Solves `count` linear equations, whose right sides are in the last column, by elimination.
fn solve(mut system: [[f64; MAX_TERMS + 1]; MAX_TERMS], count: usize) -> [f64; MAX_TERMS] {
    // Neighbours on a line, as a scanner has them, leave terms open.
    for (i, row) in system.iter_mut().enumerate() {
        row[i] += 1e-9;
    }
    for column in 0..count {
        let size = |row: usize| system[row][column].abs();
        let pivot = (column..count).fold(column, |best, row| if size(row) > size(best) { row } else { best });
        system.swap(column, pivot);
        for row in column + 1..count {
            let factor = system[row][column] / system[column][column];
            let from = system[column];
            system[row].iter_mut().zip(from).for_each(|(x, y)| *x -= factor * y);
        }
    }
    let mut solution = [0.0; MAX_TERMS];
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|k| system[row][k] * solution[k]).sum();
        solution[row] = (system[row][MAX_TERMS] - known) / system[row][row];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_quadric_stay_and_others_move_there() {
        let height = |x: f64, y: f64| 0.3 * x * x - 0.2 * x * y + 0.1 * y * y + 0.5 * x;
        let mut points: Vec<[f64; 3]> = (0..400)
            .map(|i| [f64::from(i % 20) * 0.05, f64::from(i / 20) * 0.05])
            .map(|[x, y]| [x, y, height(x, y)])
            .collect();
        assert!(noise(&Tree::new(&points)) < 0.01);
        let before = points[210];
        points[210][2] += 0.03;
        let moved = projected(&Tree::new(&points))[210];
        assert!((moved[2] - before[2]).abs() < 0.02 && (moved[0] - before[0]).abs() < 0.02, "{moved:?} {before:?}");
        let line: Vec<[f64; 2]> = (0..400).map(|i| f64::from(i) * 0.01).map(|x| [x, x * x]).collect();
        assert!(noise(&Tree::new(&line)) < 0.01);
        let moves =
            projected(&Tree::new(&line)).into_iter().zip(&line).map(|(p, q)| (p[0] - q[0]).abs() + (p[1] - q[1]).abs());
        // At the ends, all neighbours lie on one side.
        let moves: Vec<f64> = moves.skip(20).take(360).collect();
        assert!(moves.iter().all(|&x| x < 1e-3), "{moves:?}");
    }
}
