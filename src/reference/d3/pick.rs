//! Which point a tetrahedron inserts (§3.1).

use crate::gpu::layout::Pick;

use crate::reference::State;
use crate::reference::pick::{difference, nearest, scale_of};
use crate::reference::pick;

/// Returns how much a tetrahedron wants a point, at least 1. Scores of different tetrahedra do not
/// compare.
pub(super) fn score(state: &State<3>, t: u32, p: u32) -> u32 {
    let vertices = state.corners(t);
    let infinite = state.params.infinite;
    let difference = |v: u32, w: u32| difference(state, v, w);
    if let Some(k) = vertices.iter().position(|&v| v == infinite) {
        // The hull grows most by the point that is farthest from the facet.
        let [a, b, c] = [1, 2, 3].map(|i| vertices[(k + i) % 4]);
        let (u, v) = (difference(b, a), difference(c, a));
        let scale = scale_of(&[u, v]);
        let [u, v, w] = [u, v, difference(p, a)].map(|d| d.map(|x| x * scale));
        let minus = |p: [f32; 3], q: [f32; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        let from_nearest = nearest([w, minus(w, u), minus(w, v)].map(square));
        return pick::score(triple(u, v, w), permanent(u, v, w), from_nearest);
    }
    let scale = scale_of(&[1, 2, 3].map(|i| difference(vertices[i], vertices[0])));
    let d = vertices.map(|v| difference(v, p).map(|x| x * scale));
    if state.params.pick == Pick::Centroid as u32 {
        let off: [f32; 3] = std::array::from_fn(|i| d[0][i] + d[1][i] + d[2][i] + d[3][i]);
        return 0x7f80_0000 - off.iter().map(|x| x * x).sum::<f32>().to_bits();
    }
    // The in-sphere determinant: for one tetrahedron it grows as the distance from the circumcentre
    // falls.
    let lift = d.map(square);
    let inside = lift[0] * triple(d[1], d[2], d[3]) - lift[1] * triple(d[2], d[3], d[0])
        + lift[2] * triple(d[3], d[0], d[1])
        - lift[3] * triple(d[0], d[1], d[2]);
    pick::score(inside, 0.0, nearest(lift))
}

fn square(a: [f32; 3]) -> f32 {
    a.iter().map(|x| x * x).sum()
}

fn triple(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> f32 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Returns the sum of the terms of `triple`, all of them taken as positive.
fn permanent(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> f32 {
    let [a, b, c] = [a, b, c].map(|v| v.map(f32::abs));
    a[0] * (b[1] * c[2] + b[2] * c[1]) + a[1] * (b[2] * c[0] + b[0] * c[2]) + a[2] * (b[0] * c[1] + b[1] * c[0])
}
