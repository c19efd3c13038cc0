//! The 2D parts of tiles.

use super::{dim::Tiled, in_pieces};
use crate::{
    d2::{
        Mesh2,
        insert::edge_of,
        triangulation::{Triangulation2, edges_to_mesh, vertices_to_mesh},
    },
    dimension::Dimension,
    options::Winding,
};
use rustc_hash::FxHashMap;

impl Tiled<2, 3> for Dimension<2> {
    const STRIDE: u32 = 3;

    fn slots(triangulation: &Triangulation2) -> u32 {
        triangulation.triangles.len() as u32
    }

    #[inline]
    fn simplex(triangulation: &Triangulation2, t: u32) -> Option<[u32; 3]> {
        Some(triangulation.triangles[t as usize])
    }

    /// Clockwise with the *y* axis up.
    fn ghost_facet(simplex: [u32; 3], infinite: u32) -> Option<[u32; 2]> {
        simplex.iter().position(|&v| v == infinite).map(|k| edge_of(simplex, k))
    }

    fn into_arrays(triangulation: Triangulation2) -> [Vec<[u32; 3]>; 2] {
        [triangulation.triangles, triangulation.neighbors]
    }

    fn rename(triangulation: &mut Triangulation2, names: &[u32], infinite: u32) {
        triangulation.infinite = infinite;
        let vertices = triangulation.triangles.as_flattened_mut();
        in_pieces(vertices.len() as u32, &mut |piece| {
            for v in &mut vertices[piece.start as usize..piece.end as usize] {
                *v = names.get(*v as usize).copied().unwrap_or(infinite);
            }
        });
    }

    fn move_infinite(triangulation: &mut Triangulation2, infinite: u32) {
        let before = std::mem::replace(&mut triangulation.infinite, infinite);
        let vertices = triangulation.triangles.as_flattened_mut();
        in_pieces(vertices.len() as u32, &mut |piece| {
            let vertices = &mut vertices[piece.start as usize..piece.end as usize];
            vertices.iter_mut().filter(|v| **v == before).for_each(|v| *v = infinite);
        });
    }

    fn to_mesh(simplex: [u32; 3], winding: Winding) -> [u32; 3] {
        vertices_to_mesh(simplex, winding)
    }

    fn entries(across: [u32; 3], winding: Winding) -> [u32; 3] {
        edges_to_mesh(across, winding)
    }

    fn place(t: u32, k: usize, winding: Winding) -> [u32; 2] {
        let halfedge = Triangulation2::halfedge_of_edge(4 * t + k as u32, winding);
        [halfedge; 2]
    }

    fn assemble(triangles: Vec<[u32; 3]>, halfedges: Vec<[u32; 3]>, edges: Vec<[u32; 2]>, winding: Winding) -> Mesh2 {
        let next: FxHashMap<u32, u32> = edges.iter().map(|&[from, to]| (from, to)).collect();
        let mut hull = Vec::with_capacity(edges.len());
        let lowest = edges.iter().map(|&[from, _]| from).min();
        let mut at = lowest;
        while let Some(v) = at {
            hull.push(v);
            at = next.get(&v).copied().filter(|&to| Some(to) != lowest && hull.len() < edges.len());
        }
        if winding == Winding::CounterClockwise && !hull.is_empty() {
            hull[1..].reverse();
        }
        Mesh2 { triangles, halfedges, hull, ..Mesh2::default() }
    }
}
