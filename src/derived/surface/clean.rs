//! Points before the surface is found: without isolated ones, and without noise.

use super::{SurfaceOptions, find::Prepared, neighbors::Tree, outliers::isolated, quadrics};
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
        let mut vertices: Vec<u32> =
            (0..prepared.mesh.points.len() as u32).filter(|&v| !stars.of(v).is_empty()).collect();
        let mut scaled: Vec<[f64; D]> = vertices.iter().map(|&v| complex.point(v)).collect();
        let count = vertices.len();
        let mut smoothed = Smoothed::default();
        if options.drop_isolated || options.smooth != Some(0) {
            let tree = Tree::new(&scaled);
            let mut is_isolated = Vec::new();
            if options.drop_isolated {
                is_isolated = isolated(complex, stars, &vertices, &tree);
            }
            if is_isolated.contains(&true) {
                drop(tree);
                remove(&mut vertices, &is_isolated);
                remove(&mut scaled, &is_isolated);
                smoothed = Smoothed::new(&Tree::new(&scaled), options.smooth);
            } else {
                smoothed = Smoothed::new(&tree, options.smooth);
            }
        }
        Cleaned {
            names: vertices.iter().map(|&v| prepared.mesh.points[v as usize]).collect(),
            isolated: count - vertices.len(),
            scaled: smoothed.points.unwrap_or(scaled),
            scale: prepared.scale,
            noise: smoothed.noise,
            passes: smoothed.passes,
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

/// Points without noise.
#[derive(Default)]
struct Smoothed<const D: usize> {
    noise: f64,
    passes: u32,
    /// The points, if they were moved.
    points: Option<Vec<[f64; D]>>,
}

impl<const D: usize> Smoothed<D> {
    /// Moves points onto quadrics so often, by default as often as their noise demands.
    fn new(tree: &Tree<'_, D>, passes: Option<u32>) -> Self {
        if passes == Some(0) || tree.points.len() < quadrics::MIN_POINTS {
            return Smoothed::default();
        }
        let noise = quadrics::noise(tree);
        let automatic = if (MIN_NOISE..MAX_NOISE).contains(&noise) { PASSES } else { 0 };
        let passes = passes.unwrap_or(automatic);
        let points = (passes > 0)
            .then(|| (1..passes).fold(quadrics::projected(tree), |points, _| quadrics::projected(&Tree::new(&points))));
        Smoothed { noise, passes, points }
    }
}

/// Removes the items that are marked.
fn remove<T>(items: &mut Vec<T>, is_removed: &[bool]) {
    let mut marks = is_removed.iter();
    items.retain(|_| marks.next() != Some(&true));
}
