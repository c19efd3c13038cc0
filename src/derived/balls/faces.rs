//! Faces of a mesh of balls, from simplices to vertices: which are part of the complex of a radius, and how.

use super::{
    super::{alpha::FaceClass, complex::Complex},
    spheres::{compare_size, is_attached},
};
use crate::{
    geometry::{Euclidean, Geometry},
    index::NONE,
    mesh::Csr,
    parallel::{self, Threads},
};

/// The number of vertices that is worth handing to another thread.
const GRAIN: usize = 1 << 10;

/// A mesh, and the radius of the complex.
pub(super) struct Balls<'a, const D: usize, const N: usize> {
    pub(super) complex: &'a Complex<'a, D, N>,
    pub(super) radius: f64,
}

/// Faces of one dimension, and what they are.
pub(super) type Faces<const K: usize> = Vec<([u32; K], FaceClass)>;

impl<const D: usize, const N: usize> Balls<'_, D, N>
where
    Euclidean: Geometry<D, N>,
{
    fn ball(&self, v: u32) -> ([f64; D], f64) {
        (self.complex.point(v), self.complex.weight(v))
    }

    /// Returns whether each simplex is part of the complex.
    pub(super) fn are_small<const K: usize>(&self, simplices: &[[u32; K]]) -> Vec<bool> {
        let parts = parallel::map_ranges(Threads::All, simplices.len(), |range| {
            simplices[range].iter().map(|simplex| self.is_small(simplex)).collect::<Vec<bool>>()
        });
        parallel::joined(parts)
    }

    /// Returns cells and what they are, which are a face of nothing.
    pub(super) fn of_cells_alone<const K: usize>(&self, cells: &[[u32; K]]) -> Faces<K> {
        let class = |is_in: bool| if is_in { FaceClass::Singular } else { FaceClass::Exterior };
        cells.iter().copied().zip(self.are_small(cells).into_iter().map(class)).collect()
    }

    fn is_small<const K: usize>(&self, face: &[u32; K]) -> bool {
        compare_size::<D, N>(&face.map(|v| self.ball(v)), self.radius) <= 0
    }

    /// Returns what a face is that no larger one of the complex has. `beside` are the vertices that it has a larger face
    /// with.
    fn alone<const K: usize>(&self, face: &[u32; K], beside: impl IntoIterator<Item = u32>) -> FaceClass {
        let balls = face.map(|v| self.ball(v));
        let is_own = self.is_small(face) && !beside.into_iter().any(|v| is_attached(&balls, self.ball(v)));
        if is_own { FaceClass::Singular } else { FaceClass::Exterior }
    }

    /// Returns the facets of cells, each with the cell of the lower index, as it is seen from outside that.
    /// `is_full` says whether cells have all dimensions of space, so that there is something within them.
    pub(super) fn of_cells<const K: usize, const F: usize>(
        &self,
        (cells, neighbors): (&[[u32; K]], &[[u32; K]]),
        is_in: &[bool],
        is_full: bool,
        facet: impl Fn(&[u32; K], usize) -> [u32; F] + Sync,
    ) -> Faces<F> {
        let parts = parallel::map_ranges(Threads::All, cells.len(), |range| {
            let mut faces = Vec::new();
            for t in range {
                for k in (0..K).filter(|&k| neighbors[t][k] == NONE || t < neighbors[t][k] as usize) {
                    let face = facet(&cells[t], k);
                    let other = (neighbors[t][k] != NONE).then_some(neighbors[t][k] as usize);
                    let class = match (is_in[t], other.map(|other| is_in[other])) {
                        (true, Some(true)) if is_full => FaceClass::Interior,
                        (true, _) | (_, Some(true)) => FaceClass::Regular,
                        _ => {
                            let apexes = other.into_iter().flat_map(|other| cells[other]).filter(|v| !face.contains(v));
                            self.alone(&face, apexes.chain([cells[t][k]]))
                        }
                    };
                    faces.push((face, class));
                }
            }
            faces
        });
        parallel::joined(parts)
    }

    /// Returns the edges of triangles, in ascending order.
    pub(super) fn of_triangles(&self, triangles: &Faces<3>) -> Faces<2> {
        let points = self.complex.points().len();
        let vertices: Vec<[u32; 3]> = triangles.iter().map(|&(triangle, _)| triangle).collect();
        let stars = Csr::stars(&vertices, points);
        let parts = parallel::map_grains(Threads::All, points, GRAIN, |range| {
            let (mut edges, mut around) = (Vec::new(), Vec::new());
            for v in range.start as u32..range.end as u32 {
                around.clear();
                for &t in stars.of(v) {
                    let (triangle, class) = triangles[t as usize];
                    for w in triangle.into_iter().filter(|&w| w > v) {
                        // The triangle's third vertex.
                        let third = triangle.into_iter().find(|&u| u != v && u != w).unwrap_or(v);
                        around.push((w, third, class));
                    }
                }
                around.sort_unstable_by_key(|&(w, third, _)| (w, third));
                for edge in around.chunk_by(|a, b| a.0 == b.0) {
                    let ends = [v, edge[0].0];
                    let class = joined(edge.iter().map(|&(_, _, class)| class))
                        .unwrap_or_else(|| self.alone(&ends, edge.iter().map(|&(_, third, _)| third)));
                    edges.push((ends, class));
                }
            }
            edges
        });
        parallel::joined(parts)
    }

    /// Returns some vertices and what they are, given all edges.
    pub(super) fn of_edges(&self, edges: &Faces<2>, vertices: impl Iterator<Item = u32>) -> Vec<(u32, FaceClass)> {
        let ends: Vec<[u32; 2]> = edges.iter().map(|&(ends, _)| ends).collect();
        let stars = Csr::stars(&ends, self.complex.points().len());
        let class = |v: u32| {
            let around = || stars.of(v).iter().map(|&e| edges[e as usize]);
            let others = || around().flat_map(|(ends, _)| ends).filter(|&w| w != v);
            joined(around().map(|(_, class)| class)).unwrap_or_else(|| self.alone(&[v], others()))
        };
        vertices.map(|v| (v, class(v))).collect()
    }
}

/// Returns what a face is that belongs to larger ones of these classes, by one dimension; `None` if none of them is part
/// of the complex.
fn joined(mut around: impl Iterator<Item = FaceClass> + Clone) -> Option<FaceClass> {
    let mut all = around.clone().peekable();
    if all.peek().is_some() && all.all(|class| class == FaceClass::Interior) {
        return Some(FaceClass::Interior);
    }
    around.any(|class| class != FaceClass::Exterior).then_some(FaceClass::Regular)
}
