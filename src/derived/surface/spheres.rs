//! The circumspheres of simplices, and what stands for those beyond the hull.

use super::super::complex::Complex;
use crate::{
    geometry::{Euclidean, Geometry, circumsphere, vector},
    index::NONE,
    parallel::{self, Threads},
};

/// Stands for what is outside the hull as a pole.
pub(super) const OUTSIDE: u32 = NONE - 1;

/// Stands for what is beyond the hull, but known to be inside. Simplices have lower numbers.
pub(super) const BENEATH: u32 = NONE - 2;

/// The circumspheres of simplices.
#[derive(Debug)]
pub(super) struct Spheres<const D: usize> {
    pub(super) centers: Vec<[f64; D]>,
    pub(super) radii: Vec<f64>,
}

impl<const D: usize> Spheres<D> {
    pub(super) fn new<const N: usize>(complex: &Complex<'_, D, N>) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        let count = complex.simplices.len();
        let mut spheres = Spheres { centers: vec![[0.0; D]; count], radii: vec![0.0; count] };
        let lists = (&mut spheres.centers[..], &mut spheres.radii[..]);
        parallel::for_chunk_pairs(Threads::All, lists, |start, (centers, radii)| {
            for ((center, radius), t) in centers.iter_mut().zip(radii).zip(start..) {
                let corners = complex.corners(t);
                let (offset, length) = circumsphere(&corners);
                (*center, *radius) = (vector::plus(corners[0], offset), length);
            }
        });
        spheres
    }
}

/// A circumsphere.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere<const D: usize> {
    pub(super) center: [f64; D],
    pub(super) radius: f64,
}

impl<const D: usize> Sphere<D> {
    /// Returns how deeply two spheres intersect: the cosine of the angle between their radii at a
    /// common point, with the sign that makes it 1 for equal spheres and −1 for spheres that touch
    /// from outside; less if they are disjoint. Each comes with a point on it.
    ///
    /// Of the larger one only the direction counts: circumspheres of nearly flat simplices, as of points on a
    /// grid, are so large that the square of the radius has an error above all else.
    pub(super) fn intersection(&self, other: &Self, points: [[f64; D]; 2]) -> f64 {
        let [large, small, point] = if self.radius >= other.radius {
            [self.center, other.center, points[0]]
        } else {
            [other.center, self.center, points[1]]
        };
        let (r, s) = (self.radius.max(other.radius), self.radius.min(other.radius));
        let [to_large, to_small] = [large, small].map(|center| vector::minus(center, point));
        (vector::dot(to_large, to_small) / r + 0.5 * (s * s - vector::squared_norm(to_small)) / r) / s
    }
}
