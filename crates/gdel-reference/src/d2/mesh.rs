//! The answer: triangles without gaps, in input indices.

use gdel::NONE;
use gdel::internals::d2::gpu::finish::Mesh;

use crate::State;
use crate::d2::predicates;

/// Marks the triangles of the answer: finite ones that are not flat. One invocation per slot.
pub fn mesh_mark(state: &State<2>) -> Vec<u32> {
    let kept = |t: u32| {
        let triangle = state.corners(t);
        let corners = || triangle.map(|v| state.points[v as usize].position);
        state.is_used(t as usize)
            && !triangle.contains(&state.params.infinite)
            && predicates::orient2d_exact(corners()) != 0
    };
    (0..state.simplices.len() as u32).map(|t| u32::from(kept(t))).collect()
}

/// Writes the mesh. `numbers` are the exclusive prefix sums of the marks. One invocation per slot
/// but the last.
pub fn mesh_compact(state: &State<2>, numbers: &[u32]) -> Mesh {
    let mut mesh = Mesh::default();
    let is_kept = |t: u32| numbers[t as usize + 1] != numbers[t as usize];
    for t in (0..numbers.len() as u32 - 1).filter(|&t| is_kept(t)) {
        let [a, b, c] = state.corners(t).map(|v| state.points[v as usize].index);
        // Edges are numbered by the vertex opposite, half-edges by the vertex where they begin.
        let (triangle, edge_of_halfedge, halfedge_of_edge) = match state.params.clockwise {
            0 => ([a, b, c], [2, 0, 1], [1, 2, 0]),
            _ => ([a, c, b], [1, 0, 2], [1, 0, 2]),
        };
        mesh.triangles.push(triangle);
        mesh.halfedges.push([0, 1, 2].map(|k| {
            let (u, edge) = state.across(t, edge_of_halfedge[k]);
            if is_kept(u) {
                return 3 * numbers[u as usize] + halfedge_of_edge[edge];
            }
            mesh.hull.push([triangle[k], triangle[(k + 1) % 3]]);
            NONE
        }));
    }
    mesh
}
