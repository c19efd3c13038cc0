//! Points in a plane or on a line, which have no simplices: in their place are the triangles of the plane, or the
//! edges of the line.

use super::{
    edges::{Edges, smallest},
    groups::Groups,
    rounding::MAX_RATIO,
    values::Radii,
};
use crate::{
    derived::{
        complex::{Complex, Coordinates},
        flat::{Flat, Shape, in_space},
        sorted::inverse,
    },
    geometry::{Euclidean, Geometry, is_obtuse, vector},
    index::NONE,
};
use rustc_hash::FxHashMap;
use std::borrow::Cow;

/// The Delaunay triangulation of points in a plane or on a line.
#[derive(Debug)]
pub(super) struct FlatCells<const D: usize> {
    /// The cells as triangles, whose vertices are those of the sorted mesh. An edge has its second vertex twice.
    pub(super) complex: Complex<'static, D, 3>,
    /// How many vertices a cell has.
    pub(super) corners: usize,
    /// The scaled square of the circumradius of each cell.
    squared: Vec<f64>,
}

impl<const D: usize> FlatCells<D> {
    pub(super) fn new<const N: usize>(flat: &Flat, radii: &Radii<D, N>) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        let ranks = inverse(&radii.mesh.points);
        let mut neighbors = Vec::new();
        let cells: Vec<[u32; 3]> = match &flat.shape {
            Shape::Line { vertices, .. } => {
                let last = vertices.len().saturating_sub(2);
                let beside = |t: usize| [if t < last { t as u32 + 1 } else { NONE }, (t as u32).wrapping_sub(1), NONE];
                neighbors.extend((0..vertices.len() - 1).map(beside));
                vertices.windows(2).map(|pair| [pair[0], pair[1], pair[1]]).collect()
            }
            Shape::Plane(plane) => {
                // From vertex k to the next one, opposite the one after that.
                let across = |halfedge: u32| if halfedge == NONE { NONE } else { halfedge / 3 };
                neighbors.extend(plane.mesh.halfedges.iter().map(|&[a, b, c]| [b, c, a].map(across)));
                plane.triangles().collect()
            }
        };
        let cells: Vec<[u32; 3]> = cells.iter().map(|cell| cell.map(|v| ranks[v as usize])).collect();
        let corners = if matches!(flat.shape, Shape::Line { .. }) { 2 } else { 3 };
        let squared = |&[a, b, c]: &[u32; 3]| match corners {
            2 => radii.edge([a, b]),
            _ => radii.facet(std::array::from_fn(|k| [a, b, c][k])),
        };
        let squared = cells.iter().map(squared).collect();
        let complex = Complex {
            points: Coordinates::Owned(Vec::new()),
            simplices: Cow::Owned(cells),
            neighbors: Cow::Owned(neighbors),
            duplicate_of: radii.mesh.complex.duplicate_of.clone(),
            weights: Cow::Borrowed(&[]),
            visible: None,
        };
        FlatCells { complex, corners, squared }
    }

    /// Returns the vertices of cell `t` and its scaled squared radius.
    pub(super) fn cell(&self, t: usize) -> (&[u32], f64) {
        (&self.complex.simplices[t][..self.corners], self.squared[t])
    }

    /// Returns the vertices of all cells and their scaled squared radii.
    pub(super) fn cells(&self) -> impl Iterator<Item = (&[u32], f64)> {
        (0..self.squared.len()).map(|t| self.cell(t))
    }

    /// Returns the cells that are facets: triangles in space, edges in a plane.
    pub(super) fn facets(&self) -> impl Iterator<Item = (usize, [u32; D])> + '_ {
        let facets = self.complex.simplices.iter().enumerate().filter(|_| self.corners == D);
        facets.map(|(t, cell)| (t, std::array::from_fn(|k| cell[k])))
    }

    /// Returns a cell of the first group with which, and those before, all vertices have a cell, and the cells
    /// have at most so many components.
    pub(super) fn first_with(&self, groups: &Groups, components: usize) -> Option<usize> {
        groups.first_with(components, &self.complex)
    }

    /// Returns the edges, which belong to triangles, or are the cells themselves.
    pub(super) fn edges<const N: usize>(&self, radii: &Radii<D, N>) -> Edges
    where
        Euclidean: Geometry<D, N>,
    {
        let mut edges = Edges::default();
        let mut numbers: FxHashMap<[u32; 2], usize> = FxHashMap::default();
        for (t, &[a, b, c]) in (0..).zip(&*self.complex.simplices) {
            for [v, w, opposite] in [[a, b, c], [b, c, a], [c, a, b]] {
                if v == w || (self.corners == 2 && v != a) {
                    continue;
                }
                let edge = [v.min(w), v.max(w)];
                let e = *numbers.entry(edge).or_insert_with(|| {
                    edges.push(edge, radii.edge(edge), t);
                    edges.edges.len() - 1
                });
                // No simplex is around it.
                edges.interior[e] = f64::INFINITY;
                if self.corners == 2 {
                    continue;
                }
                edges.regular[e] = smallest(edges.regular[e], self.squared[t as usize]);
                let [p, q, r] = [opposite, v, w].map(|v| radii.mesh.complex.point(v));
                if is_obtuse(p, q, r) {
                    edges.own[e] = f64::INFINITY;
                }
            }
        }
        edges
    }

    /// Returns whether an edge of cell `t` belongs to a triangle that is part of a complex.
    pub(super) fn has_solid(&self, t: usize, edge: [u32; 2], is_solid: &[bool]) -> bool {
        let opposite = (0..3).find(|&k| !edge.contains(&self.complex.simplices[t][k]));
        let across = opposite.and_then(|k| self.complex.across(t, k));
        self.corners == 3 && (is_solid[t] || across.is_some_and(|across| is_solid[across]))
    }

    /// Returns a bound of the relative difference between the circumradius of a cell and that of the cell whose
    /// coordinates were rounded to these, by what holds for simplices; 0 if it is not small.
    pub(super) fn tolerance<const N: usize>(&self, t: usize, radii: &Radii<D, N>) -> f64
    where
        Euclidean: Geometry<D, N>,
    {
        let [a, b, c] = self.complex.simplices[t].map(|v| in_space(radii.scaled(radii.mesh.complex.point(v))));
        let (u, v) = (vector::minus(b, a), vector::minus(c, a));
        let lengths = [u, v, vector::minus(c, b)].map(vector::norm);
        let inradius = if self.corners == 2 {
            lengths[0] / 2.0
        } else {
            let area = vector::norm(vector::cross(u, v)) - 64.0 * f64::EPSILON * lengths[0] * lengths[1];
            area / lengths.iter().sum::<f64>()
        };
        let ratio = radii.rounding / inradius;
        if inradius > 0.0 && ratio < MAX_RATIO { 1.02 * ratio } else { 0.0 }
    }
}
