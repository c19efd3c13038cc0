//! Squared radii, rounded, with exact comparisons where rounding leaves them open.

use super::super::sorted::Sorted;
use crate::{
    geometry::{
        Euclidean, Geometry, circumcenter_offset, compare_radii, compare_radius, facet, precise_squared_radius, vector,
    },
    predicates::Sign,
};
use std::cmp::Ordering;

/// A bound of the relative error of rounded squared radii, and of the difference of two,
/// generously: 2⁻³³.
const ERROR: f64 = 1.0 / (1u64 << 33) as f64;

/// Squared radii out of this range, in which no product of them or of coordinates comes near the
/// limits of `f64`, are not known by their rounded values: these are NaN.
const KNOWN: std::ops::Range<f64> = 1e-100..1e100;

/// A squared radius that is not known: the NaN whose bits are those of a negative number.
pub(super) const UNKNOWN: f64 = f64::from_bits(0xfff8 << 48);

/// Returns a rounded squared radius, or [`UNKNOWN`].
pub(super) fn known(squared: f64) -> f64 {
    if KNOWN.contains(&squared) { squared } else { UNKNOWN }
}

/// Returns the sign of the difference of two squared radii, or `None` if rounding may have changed
/// it.
#[inline]
pub(super) fn certain(a: f64, b: f64) -> Option<Sign> {
    let margin = ERROR * (a + b);
    match a - b {
        difference if difference > margin => Some(1),
        difference if difference < -margin => Some(-1),
        _ => None,
    }
}

/// A mesh whose faces have squared radii.
#[derive(Debug)]
pub struct Radii<const D: usize, const N: usize> {
    pub(super) mesh: Sorted<D, N>,
    /// The power of two that coordinates are multiplied by before they are rounded.
    pub(super) scale: f64,
    /// How far a vertex may be from where it was before its coordinates were rounded, scaled.
    pub(super) rounding: f64,
}

/// A radius to compare with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Alpha {
    pub(super) radius: f64,
    /// Its square, scaled and rounded, or NaN.
    squared: f64,
}

impl Alpha {
    pub(super) fn squared(self) -> f64 {
        self.squared
    }
}

impl<const D: usize, const N: usize> Radii<D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Prepares a mesh whose coordinates may be off by `unit` times the largest one.
    pub(super) fn new(mesh: Sorted<D, N>, unit: f64) -> Self {
        let bounds = mesh.complex.bounds();
        let scale = vector::scale_of(bounds);
        // An empty mesh has infinite bounds.
        let largest = bounds.as_flattened().iter().fold(0.0f64, |largest, x| largest.max((x * scale).abs()));
        let rounding = unit * (D as f64).sqrt() * largest;
        Radii { mesh, scale, rounding }
    }

    pub(super) fn alpha(&self, radius: f64) -> Alpha {
        let scaled = radius * self.scale;
        let squared = scaled * scaled;
        Alpha { radius, squared: if radius == 0.0 || radius == f64::INFINITY { squared } else { known(squared) } }
    }

    pub(super) fn scaled(&self, p: [f64; D]) -> [f64; D] {
        vector::times(self.scale, p)
    }

    /// Returns the coordinates of the vertices of a face.
    pub(super) fn points<const K: usize>(&self, face: [u32; K]) -> [[f64; D]; K] {
        face.map(|v| self.mesh.complex.point(v))
    }

    /// Returns the squared circumradius of simplex `t`, and for each facet whether its smallest
    /// sphere contains the opposite vertex: whether the circumcentre lies beyond it.
    pub(super) fn simplex(&self, t: usize) -> (f64, [bool; N]) {
        let corners = self.mesh.complex.corners(t);
        let scaled = corners.map(|p| self.scaled(p));
        let center = circumcenter_offset(&scaled);
        let squared = vector::squared_norm(center);
        let rows = scaled.map(|p| vector::minus(vector::minus(p, scaled[0]), center));
        // The centre is off by at most 2⁻³⁷ times the radius, and a facet has at most 2.6 times its
        // (D − 1)-th power.
        let bound = 16.0 * ERROR * if D == 2 { squared } else { squared * squared.sqrt() };
        let is_known = KNOWN.contains(&squared);
        let is_beyond = std::array::from_fn(|k| {
            let side = Euclidean::determinant(&facet(&rows, k));
            match side {
                side if is_known && side > bound => false,
                side if is_known && side < -bound => true,
                _ => Euclidean::in_smallest_sphere(&facet(&corners, k), corners[k]),
            }
        });
        (known(squared), is_beyond)
    }

    /// Returns the squared radius of the smallest sphere through the vertices of a facet.
    pub(super) fn facet(&self, facet: [u32; D]) -> f64 {
        known(Euclidean::facet_squared_radius(&self.points(facet).map(|p| self.scaled(p))))
    }

    /// Returns the squared radius of the smallest sphere through two vertices.
    pub(super) fn edge(&self, edge: [u32; 2]) -> f64 {
        let [a, b] = self.points(edge).map(|p| self.scaled(p));
        known(0.25 * vector::squared_norm(vector::minus(a, b)))
    }

    /// Compares the radius of a face, whose rounded square is given, with alpha, exactly.
    #[inline]
    pub(super) fn compare_with(&self, face: &[u32], squared: f64, alpha: Alpha) -> Sign {
        if alpha.radius == f64::INFINITY {
            return -1;
        }
        certain(squared, alpha.squared).unwrap_or_else(|| {
            let points: Vec<[f64; D]> = face.iter().map(|&v| self.mesh.complex.point(v)).collect();
            compare_radius::<D, N>(&points, alpha.radius)
        })
    }

    /// Returns the squared radius of a face, whose rounded one is known, as precisely as
    /// [`precise_squared_radius`] does.
    pub(super) fn precise(&self, face: &[u32]) -> [f64; 2] {
        let points: Vec<[f64; D]> = face.iter().map(|&v| self.mesh.complex.point(v)).collect();
        precise_squared_radius::<D, N>(&points, self.scale)
    }

    /// Compares the radii of two faces, whose rounded squares are given, exactly.
    #[inline]
    pub(super) fn compare(&self, a: (&[u32], f64), b: (&[u32], f64)) -> Ordering {
        let sign = certain(a.1, b.1).unwrap_or_else(|| {
            let points = |face: &[u32]| face.iter().map(|&v| self.mesh.complex.point(v)).collect::<Vec<_>>();
            compare_radii::<D, N>(&points(a.0), &points(b.0))
        });
        sign.cmp(&0)
    }
}
