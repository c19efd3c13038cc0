//! Points before the surface is found: without isolated ones, and without noise.

use super::{SurfaceOptions, find::Prepared, outliers::isolated, quadrics};
use crate::{
    geometry::{Euclidean, Geometry, vector},
    input::points::Points,
    mesh::Csr,
};

/// With less noise, points are not moved. A scan with little noise and fine details has 0.055.
const MIN_NOISE: f64 = 0.07;

/// With more, the points do not lie on a surface.
const MAX_NOISE: f64 = 0.8;

/// How often points are moved if there is noise.
const PASSES: u32 = 2;

/// The vertices of a mesh that are not isolated, in the order of the sorted mesh, moved if there is
/// noise.
pub(super) struct Cleaned<const D: usize> {
    /// The input's indices of the vertices.
    pub(super) names: Vec<u32>,
    /// The coordinates, scaled.
    scaled: Vec<[f64; D]>,
    scale: f64,
    /// The number of vertices that are isolated.
    pub(super) isolated: usize,
    pub(super) noise: f64,
    /// How often the points were moved.
    pub(super) passes: u32,
}

impl<const D: usize> Cleaned<D> {
    pub(super) fn new<const N: usize>(prepared: &Prepared<D, N>, stars: &Csr, options: &SurfaceOptions<'_, D>) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        let complex = &prepared.mesh.complex;
        let mut is_isolated = vec![false; prepared.mesh.points.len()];
        if options.drop_isolated {
            is_isolated = isolated(complex, stars);
        }
        let is_kept = |&v: &u32| !is_isolated[v as usize] && !stars.of(v).is_empty();
        let kept: Vec<u32> = (0..is_isolated.len() as u32).filter(is_kept).collect();
        let mut scaled: Vec<[f64; D]> = kept.iter().map(|&v| complex.point(v)).collect();
        let is_estimated = options.smooth != Some(0) && kept.len() >= quadrics::MIN_POINTS;
        let noise = if is_estimated { quadrics::noise(&scaled) } else { 0.0 };
        let automatic = if (MIN_NOISE..MAX_NOISE).contains(&noise) { PASSES } else { 0 };
        let passes = if is_estimated { options.smooth.unwrap_or(automatic) } else { 0 };
        for _ in 0..passes {
            scaled = quadrics::projected(&scaled);
        }
        Cleaned {
            names: kept.iter().map(|&v| prepared.mesh.points[v as usize]).collect(),
            scaled,
            scale: prepared.scale,
            isolated: is_isolated.iter().filter(|&&is_isolated| is_isolated).count(),
            noise,
            passes,
        }
    }

    /// Returns whether the points have to be triangulated again.
    pub(super) fn is_changed(&self) -> bool {
        self.isolated > 0 || self.passes > 0
    }

    /// Returns the points, in the precision of those that were given, so that files of that precision
    /// have them exactly.
    pub(super) fn points(&self, given: Points<'_, D>) -> Vec<[f64; D]> {
        let unscaled = self.scaled.iter().map(|&p| vector::times(1.0 / self.scale, p));
        match given {
            Points::F32(_) => unscaled.map(|p| p.map(|x| f64::from(x as f32))).collect(),
            Points::F64(_) => unscaled.collect(),
        }
    }
}
