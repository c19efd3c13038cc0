//! The cavity of a point, whose facets say what its Voronoi cell takes from those of the vertices.

use super::{super::Interpolation, numeric::MAX_ERROR};
use crate::geometry::{real::Real, vector};

/// A cavity as its vertices, facets and circumcentres, relative to the point.
#[derive(Debug)]
pub struct Cavity<T, const D: usize> {
    pub(super) vertices: Vec<Vertex<T, D>>,
    /// The facets between two simplices of the cavity, once each, and those of its boundary.
    pub(super) facets: Vec<CavityFacet<T, D>>,
    /// A bound of the sum of the terms of all `stolen`: their rounding errors are relative to it.
    pub(super) magnitude: f64,
}

#[derive(Debug)]
pub struct Vertex<T, const D: usize> {
    pub(super) index: u32,
    pub(super) position: [T; D],
    /// The volume that the cell of the point takes from the cell of the vertex; in 2D the area.
    pub(super) stolen: T,
    /// The pyramid (in 2D: triangle) over the facet between both cells, with its apex at the point.
    pub(super) pyramid: T,
    /// A bound of the terms of `pyramid`: its rounding error is relative to it.
    pub(super) pyramid_magnitude: f64,
}

impl<T: Real, const D: usize> Vertex<T, D> {
    pub(super) fn new(index: u32, position: [T; D]) -> Self {
        let zero = T::from(0);
        Vertex { index, position, stolen: zero, pyramid: zero, pyramid_magnitude: 0.0 }
    }
}

/// A facet of a cavity's simplex, and its dual Voronoi edge.
#[derive(Debug, Clone, Copy)]
pub struct CavityFacet<T, const D: usize> {
    /// Places in `vertices`: in the direction that has the simplex inside on the left in 2D,
    /// counter-clockwise as seen from the other side in 3D.
    pub(super) corners: [u32; D],
    /// The circumcentre of the simplex inside.
    pub(super) inside: [T; D],
    /// The circumcentre of the simplex on the other side or, around the cavity, that of the facet
    /// and the point.
    pub(super) beyond: [T; D],
    pub(super) is_boundary: bool,
}

impl<T, const D: usize> Default for Cavity<T, D> {
    fn default() -> Self {
        Cavity { vertices: Vec::new(), facets: Vec::new(), magnitude: 0.0 }
    }
}

impl<T: Real, const D: usize> Cavity<T, D> {
    pub(super) fn clear(&mut self) {
        self.vertices.clear();
        self.facets.clear();
        self.magnitude = 0.0;
    }

    /// Appends the weights of the vertices, unless their errors might exceed [`MAX_ERROR`].
    pub(super) fn weights(&self, method: Interpolation, weights: &mut Vec<(u32, f64)>) -> bool {
        let measure = |vertex: &Vertex<T, D>| match method {
            // The measure of the facet, divided by the distance: a pyramid has half the distance as
            // its height.
            Interpolation::Laplace => {
                let squared = vector::squared_norm(vertex.position.map(T::to_f64));
                [vertex.pyramid.to_f64() / squared, vertex.pyramid_magnitude / squared]
            }
            _ => [vertex.stolen.to_f64(), 0.0],
        };
        let start = weights.len();
        let mut magnitude = if method == Interpolation::Laplace { 0.0 } else { self.magnitude };
        let mut sum = 0.0;
        for vertex in &self.vertices {
            let [measure, more] = measure(vertex);
            // Not `max`, which would hide NaN.
            let measure = if measure < 0.0 { 0.0 } else { measure };
            weights.push((vertex.index, measure));
            sum += measure;
            magnitude += more;
        }
        if !(magnitude * T::EPSILON <= sum * MAX_ERROR && sum < f64::MAX && sum > 0.0) {
            weights.truncate(start);
            return false;
        }
        for (_, weight) in &mut weights[start..] {
            *weight /= sum;
        }
        true
    }
}
