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

    /// Returns how deeply two spheres intersect: the cosine of the angle between their radii at a
    /// common point, with the sign that makes it 1 for equal spheres and −1 for spheres that touch
    /// from outside; less if they are disjoint.
    pub(super) fn intersection(&self, i: u32, j: u32) -> f64 {
        let (i, j) = (i as usize, j as usize);
        let (r, s) = (self.radii[i], self.radii[j]);
        let squared = vector::squared_norm(vector::minus(self.centers[i], self.centers[j]));
        (r * r + s * s - squared) / (2.0 * r * s)
    }
}
