//! What is true of the points alone: duplicates and dimension.

use super::report::{Defect, Findings};
use crate::{Error, Points, mesh::NONE, predicates::orient3d};

/// The points with what follows from them.
pub(super) struct Input {
    /// The exact coordinates, duplicates included.
    pub(super) points: Vec<[f64; 3]>,
    /// For each point the lowest index with the same coordinates.
    representative: Vec<u32>,
    /// The number of points without duplicates.
    pub(super) distinct: usize,
    /// The affine dimension, 0 to 3.
    pub(super) dimension: u8,
}

impl Input {
    pub(super) fn new(points: Points<'_>) -> Result<Self, Error> {
        points.validate()?;
        let limit = i32::MAX as usize;
        if points.len() > limit {
            return Err(Error::TooManyPoints { points: points.len(), limit });
        }
        // Adding zero turns −0 into 0, which is the same coordinate.
        let points: Vec<[f64; 3]> = points.iter().map(|p| p.map(|x| x + 0.0)).collect();
        let representative = representatives(&points);
        let distinct = (0u32..).zip(&representative).filter(|&(i, &r)| r == i).count();
        let dimension = affine_dimension(&points);
        Ok(Input { points, representative, distinct, dimension })
    }

    pub(super) fn check_dimension(&self, stated: u8) -> Findings {
        let mut findings = Findings::default();
        if stated != self.dimension {
            findings.add(|| {
                Defect::in_mesh(format!("the mesh states dimension {stated}, but the points span {}", self.dimension))
            });
        }
        findings
    }

    pub(super) fn check_duplicates(&self, stated: &[i32]) -> Findings {
        let mut findings = Findings::default();
        if stated.len() != self.points.len() {
            findings.add(|| Defect::in_mesh(format!("{} entries for {} points", stated.len(), self.points.len())));
            return findings;
        }
        for (i, (&stated, &representative)) in stated.iter().zip(&self.representative).enumerate() {
            let expected = if representative as usize == i { NONE } else { representative as i32 };
            if stated != expected {
                findings.add(|| {
                    let detail = format!("the mesh states {stated} as the point that stands for it, not {expected}");
                    Defect::at_point(i, detail)
                });
            }
        }
        findings
    }

    /// Needs vertices that are indices of points.
    pub(super) fn check_vertices(&self, tetrahedra: &[[u32; 4]]) -> Findings {
        let mut findings = Findings::default();
        let mut used = vec![false; self.points.len()];
        for (t, vertices) in tetrahedra.iter().enumerate() {
            for &v in vertices {
                used[v as usize] = true;
                let representative = self.representative[v as usize];
                if representative != v {
                    findings.add(|| {
                        let detail =
                            format!("vertex {v} is a duplicate of point {representative}, which stands for it");
                        Defect::at_tetrahedron(t, detail)
                    });
                }
            }
        }
        if self.dimension == 3 {
            for (i, used) in used.into_iter().enumerate() {
                if !used && self.representative[i] as usize == i {
                    findings.add(|| Defect::at_point(i, "not a vertex of any tetrahedron".to_owned()));
                }
            }
        }
        findings
    }
}

fn representatives(points: &[[f64; 3]]) -> Vec<u32> {
    let coordinates = |i: u32| points[i as usize];
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by(|&i, &j| {
        let [a, b] = [i, j].map(coordinates);
        let axes = a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]));
        axes.then(i.cmp(&j))
    });
    let mut representative = vec![0; points.len()];
    for equal in order.chunk_by(|&i, &j| coordinates(i) == coordinates(j)) {
        for &i in equal {
            representative[i as usize] = equal[0];
        }
    }
    representative
}

fn affine_dimension(points: &[[f64; 3]]) -> u8 {
    // As a function of d, orient3d(a, b, c, d) is affine. It vanishes everywhere, so that a, b, c are collinear, exactly
    // when it vanishes at four points that are not coplanar.
    const FRAME: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut points = points.iter().copied();
    let Some(a) = points.next() else { return 0 };
    let Some(b) = points.find(|&p| p != a) else { return 0 };
    let Some(c) = points.find(|&p| FRAME.iter().any(|&q| orient3d(a, b, p, q) != 0)) else { return 1 };
    if points.any(|p| orient3d(a, b, c, p) != 0) { 3 } else { 2 }
}
