//! The distinct points of an input, and the weights to start from.

use crate::{
    derived::{
        queries::{CurveKey, places},
        voronoi::{Clip, Convex, VoronoiShapes},
    },
    error::Error,
    geometry::{Euclidean, vector},
    input::{order::sort_by_place, points::Points},
};

/// The distinct points, in the order of a curve along which neighbours are near in memory.
#[derive(Debug)]
pub(super) struct Sites<const D: usize> {
    pub(super) points: Vec<[f64; D]>,
    /// The sum of the masses of all points with the same coordinates.
    pub(super) masses: Vec<f64>,
    /// The site of each point of the input.
    pub(super) of_points: Vec<u32>,
}

impl<const D: usize> Sites<D> {
    pub(super) fn new<const N: usize>(points: Points<'_, D>, masses: Option<&[f64]>) -> Self
    where
        Euclidean: VoronoiShapes<D, N>,
    {
        let bounds = points.bounds().unwrap_or([[0.0; D]; 2]);
        let keys = places(points, CurveKey::new(bounds));
        let mut entries: Vec<u64> = (0..).zip(keys).map(|(i, key)| u64::from(key) << 32 | i).collect();
        sort_by_place(points, &mut entries);
        let mut sites = Sites { points: Vec::new(), masses: Vec::new(), of_points: vec![0; points.len()] };
        for i in entries.into_iter().map(|entry| entry as u32 as usize) {
            if sites.points.last() != Some(&points.get(i)) {
                sites.points.push(points.get(i));
                sites.masses.push(0.0);
            }
            let last = sites.points.len() - 1;
            sites.of_points[i] = last as u32;
            sites.masses[last] += masses.map_or(1.0, |masses| masses[i]);
        }
        sites
    }

    /// Returns weights with which every cell has an inside: none, if all points are within what the diagram is clipped
    /// to. Otherwise those with which it is the Voronoi diagram of a copy q = c + s·(p − m) of the points p that is
    /// within it: the bisectors of q are the radical planes of p for the weights |p|² − |q|²/s.
    pub(super) fn first_weights<const N: usize>(&self, clip: Clip<'_, D>) -> Result<Vec<f64>, Error>
    where
        Euclidean: VoronoiShapes<D, N>,
    {
        let none = vec![0.0; self.points.len()];
        let Some((shape, center)) = Convex::new(clip)? else { return Ok(none) };
        let bounds = Points::F64(&self.points).bounds().filter(|_| !self.points.iter().all(|&p| shape.contains(p)));
        let Some([low, high]) = bounds else { return Ok(none) };
        let m = vector::times(0.5, vector::plus(low, high));
        let share = |&p: &[f64; D]| shape.reach(center, vector::minus(p, m));
        let scale = 0.5 * self.points.iter().map(share).fold(2.0, f64::min);
        // Relative to the centre.
        let weight = |&p: &[f64; D]| {
            let q = vector::times(scale, vector::minus(p, m));
            vector::squared_norm(vector::minus(p, center)) - vector::squared_norm(q) / scale
        };
        Ok(self.points.iter().map(weight).collect())
    }
}
