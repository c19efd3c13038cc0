//! What is true of the points alone: duplicates and dimension.

use crate::verify::report::{Check, Defect, Findings, Report};
use crate::{
    error::Error,
    index::{Entry, NONE},
    input::points::Points,
    parallel::{self, Threads},
    predicates::{orient2d, orient3d},
};
use std::cmp::Ordering;

/// The points with what follows from them.
pub struct Input<const D: usize> {
    /// The exact coordinates, duplicates included.
    pub(crate) points: Vec<[f64; D]>,
    /// One per point, or none.
    pub(crate) weights: Vec<f64>,
    /// For each point the lowest index with the same coordinates, of the heaviest ones; [`NONE`] for
    /// points that are unused.
    pub(crate) representative: Vec<u32>,
    /// The number of points without duplicates and unused ones.
    pub(crate) distinct: usize,
    /// The affine dimension, 0 to D.
    pub(crate) dimension: u8,
}

impl<const D: usize> Input<D> {
    /// Derives what follows from the points except for those that the mesh states to be unused, as their
    /// own duplicates; `affine_dimension` computes their dimension.
    pub(crate) fn new(
        points: Points<'_, D>,
        weights: Option<&[f64]>,
        duplicate_of: Option<&[u32]>,
        affine_dimension: fn(&[[f64; D]]) -> u8,
    ) -> Result<Self, Error> {
        points.validate_by(Threads::All)?;
        let weights = weights.unwrap_or_default().to_vec();
        if !weights.is_empty() && weights.len() != points.len() {
            return Err(Error::ValueCount { values: weights.len(), points: points.len() });
        }
        if let Some(index) = weights.iter().position(|w| !w.is_finite()) {
            return Err(Error::BadWeight { index });
        }
        let limit = i32::MAX as usize;
        if points.len() > limit {
            return Err(Error::TooManyPoints { points: points.len(), limit });
        }
        // Adding zero turns −0 into 0, which is the same coordinate.
        let points: Vec<[f64; D]> = points.iter().map(|p| p.map(|x| x + 0.0)).collect();
        let stated = duplicate_of.unwrap_or_default();
        let is_used = |i: u32| stated.get(i as usize) != Some(&i);
        let used: Vec<u32> = (0..points.len() as u32).filter(|&i| is_used(i)).collect();
        let dimension = if used.len() == points.len() {
            affine_dimension(&points)
        } else {
            affine_dimension(&used.iter().map(|&i| points[i as usize]).collect::<Vec<_>>())
        };
        let representative = representatives(&points, &weights, used);
        let distinct = (0u32..).zip(&representative).filter(|&(i, &r)| r == i).count();
        Ok(Input { points, weights, representative, distinct, dimension })
    }

    /// Begins the report on a mesh that states this dimension and these duplicates.
    pub(crate) fn report(&self, dimension: Option<u8>, duplicate_of: Option<&[u32]>) -> Report {
        let mut report = Report { dimension: self.dimension, ..Report::default() };
        report.counts.points = self.points.len();
        report.counts.distinct_points = self.distinct;
        report.counts.unused_points = self.representative.iter().filter(|&&r| r == NONE).count();
        report.decide(Check::Dimension, || dimension.map(|d| self.check_dimension(d)));
        report.decide(Check::Duplicates, || duplicate_of.map(|d| self.check_duplicates(d)));
        report
    }

    fn check_dimension(&self, stated: u8) -> Findings {
        let mut findings = Findings::default();
        if stated != self.dimension {
            findings.add(|| {
                Defect::in_mesh(format!("the mesh states dimension {stated}, but the points span {}", self.dimension))
            });
        }
        findings
    }

    fn check_duplicates(&self, stated: &[u32]) -> Findings {
        let mut findings = Findings::default();
        if stated.len() != self.points.len() {
            findings.add(|| Defect::in_mesh(format!("{} entries for {} points", stated.len(), self.points.len())));
            return findings;
        }
        for (i, (&stated, &representative)) in stated.iter().zip(&self.representative).enumerate() {
            let expected = match representative {
                NONE => i as u32,
                representative if representative as usize == i => NONE,
                representative => representative,
            };
            if stated != expected {
                findings.add(|| {
                    let detail = format!(
                        "the mesh states {} as the point that stands for it, not {}",
                        Entry(stated),
                        Entry(expected)
                    );
                    Defect::at_point(i, detail)
                });
            }
        }
        findings
    }

    /// Checks which points are vertices, which must be indices of points. `what` the simplices are,
    /// and `blame` creates the defect of one.
    pub(crate) fn check_vertices<const N: usize>(
        &self,
        simplices: &[[u32; N]],
        what: &str,
        blame: fn(usize, String) -> Defect,
    ) -> Findings {
        let mut findings = Findings::default();
        let mut used = vec![false; self.points.len()];
        for (t, vertices) in simplices.iter().enumerate() {
            for &v in vertices {
                used[v as usize] = true;
                let representative = self.representative[v as usize];
                if representative != v {
                    let detail = || match representative {
                        NONE => format!("vertex {v} is a point that the mesh states to be unused"),
                        first => format!("vertex {v} is a duplicate of point {first}, which stands for it"),
                    };
                    findings.add(|| blame(t, detail()));
                }
            }
        }
        if usize::from(self.dimension) == D && self.weights.is_empty() {
            for (i, used) in used.into_iter().enumerate() {
                if !used && self.representative[i] as usize == i {
                    findings.add(|| Defect::at_point(i, format!("not a vertex of any {what}")));
                }
            }
        }
        findings
    }

    /// Returns the distinct points by their lowest indices, in the order of their coordinates.
    pub(crate) fn distinct_in_order(&self) -> Vec<u32> {
        let mut distinct: Vec<u32> =
            (0u32..).zip(&self.representative).filter(|&(i, &r)| r == i).map(|(i, _)| i).collect();
        distinct.sort_unstable_by(|&i, &j| compare(&self.points[i as usize], &self.points[j as usize]));
        distinct
    }
}

/// Compares by the first coordinate, then by the next.
fn compare<const D: usize>(a: &[f64; D], b: &[f64; D]) -> Ordering {
    a.iter().zip(b).map(|(x, y)| x.total_cmp(y)).find(|&order| order != Ordering::Equal).unwrap_or(Ordering::Equal)
}

/// Returns for each point the lowest index with the same coordinates among those in `order`, of the
/// heaviest ones; [`NONE`] for those that are not.
fn representatives<const D: usize>(points: &[[f64; D]], weights: &[f64], mut order: Vec<u32>) -> Vec<u32> {
    let coordinates = |i: u32| points[i as usize];
    let by_place = |&i: &u32, &j: &u32| compare(&coordinates(i), &coordinates(j)).then(i.cmp(&j));
    parallel::sort_by(Threads::All, &mut order, by_place);
    let mut representative = vec![NONE; points.len()];
    for equal in order.chunk_by(|&i, &j| coordinates(i) == coordinates(j)) {
        let mut heaviest = equal[0];
        for &i in equal {
            if weights.get(i as usize) > weights.get(heaviest as usize) {
                heaviest = i;
            }
        }
        for &i in equal {
            representative[i as usize] = heaviest;
        }
    }
    representative
}

/// Returns the affine dimension of 2D points.
pub(crate) fn dimension_2d(points: &[[f64; 2]]) -> u8 {
    let mut points = points.iter().copied();
    let Some(a) = points.next() else { return 0 };
    let Some(b) = points.find(|&p| p != a) else { return 0 };
    if points.any(|p| orient2d(a, b, p) != 0) { 2 } else { 1 }
}

/// Returns the affine dimension of 3D points.
pub(crate) fn dimension_3d(points: &[[f64; 3]]) -> u8 {
    // As a function of d, orient3d(a, b, c, d) is affine. It vanishes everywhere, so that a, b, c
    // are collinear, exactly when it vanishes at four points that are not coplanar.
    const FRAME: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut points = points.iter().copied();
    let Some(a) = points.next() else { return 0 };
    let Some(b) = points.find(|&p| p != a) else { return 0 };
    let Some(c) = points.find(|&p| FRAME.iter().any(|&q| orient3d(a, b, p, q) != 0)) else { return 1 };
    if points.any(|p| orient3d(a, b, c, p) != 0) { 3 } else { 2 }
}
