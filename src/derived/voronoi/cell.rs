//! One Voronoi cell.

use crate::{index::NONE, mesh::Csr};

/// The largest number of neighbours for which comparing each with all is faster than to sort them.
const RANKED: usize = 48;

/// A cell of a Voronoi diagram: a convex polyhedron, or a polygon in 2D.
///
/// [`Voronoi::cell`](crate::Voronoi::cell) has an example.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Cell<const D: usize = 3> {
    /// The vertices. Vertices that coincide because of a tie are several.
    pub vertices: Vec<[f64; D]>,
    /// For each vertex the simplex of the mesh whose circumcentre or power centre it is; [`NONE`](crate::NONE) if
    /// clipping made it.
    pub simplices: Vec<u32>,
    /// The vertices of each facet: counter-clockwise as seen from outside in 3D, both ends
    /// counter-clockwise around the cell in 2D, where the facets are in this order, too, and those
    /// of an unbounded cell begin and end with its rays. The chain of an unbounded facet's vertices
    /// is open: in 3D it comes from infinity before its first vertex and returns there after its
    /// last one.
    pub facets: Csr,
    /// For each facet the point on the other side; [`NONE`](crate::NONE) where the cell was
    /// clipped.
    pub neighbors: Vec<u32>,
    /// The area of each facet, its length in 2D; infinite for unbounded facets.
    pub areas: Vec<f64>,
    /// The volume, the area in 2D; infinite for unbounded cells.
    pub volume: f64,
    /// The centre of mass; NaN for unbounded cells and those that clipping left nothing of.
    pub centroid: [f64; D],
    /// Whether the cell is bounded.
    pub is_bounded: bool,
}

/// Returns a cell without facets.
impl<const D: usize> Default for Cell<D> {
    fn default() -> Self {
        Cell {
            vertices: Vec::new(),
            simplices: Vec::new(),
            facets: Csr::default(),
            neighbors: Vec::new(),
            areas: Vec::new(),
            volume: 0.0,
            centroid: [f64::NAN; D],
            is_bounded: true,
        }
    }
}

impl<const D: usize> Cell<D> {
    /// Returns whether nothing is left of the cell: it was outside what the diagram was clipped to,
    /// or belongs to a duplicate or a hidden point, or the mesh has no simplices.
    pub fn is_empty(&self) -> bool {
        self.facets.is_empty()
    }

    /// Returns the points with which the cell shares a facet, in ascending order.
    pub fn neighbors(&self) -> Vec<u32> {
        let listed = self.neighbors.as_slice();
        if listed.len() > RANKED {
            let mut sorted: Vec<u32> = listed.iter().copied().filter(|&v| v != NONE).collect();
            sorted.sort_unstable();
            sorted.dedup();
            return sorted;
        }
        // Each goes where the number of lower ones says, without branches, which nothing could
        // predict. What equals another one leaves a gap.
        let mut sorted = vec![NONE; listed.len()];
        for &v in listed {
            let rank: u32 = listed.iter().map(|&w| u32::from(w < v)).sum();
            sorted[rank as usize] = v;
        }
        sorted.retain(|&v| v != NONE);
        sorted
    }

    pub(super) fn clear(&mut self) {
        self.vertices.clear();
        self.simplices.clear();
        self.facets.clear();
        self.neighbors.clear();
        self.areas.clear();
        self.volume = 0.0;
        self.centroid = [f64::NAN; D];
        self.is_bounded = true;
    }
}
