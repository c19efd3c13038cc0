//! Which point a tetrahedron inserts (§3.1).

use gdel::internals::gpu::layout::Pick;

use crate::State;
use crate::pick::{difference, is_distinct, scale_of, score_by_distance, score_by_volume};

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
        let volume = triple(u, v, w);
        if is_distinct(volume, permanent(u, v, w)) {
            return score_by_volume(volume);
        }
        return score_in_plane(u, v, w);
    }
    let scale = scale_of(&[1, 2, 3].map(|i| difference(vertices[i], vertices[0])));
    let d = vertices.map(|v| difference(v, p).map(|x| x * scale));
    if state.counters.criterion == Pick::Centroid as u32 {
        let off: [f32; 3] = std::array::from_fn(|i| d[0][i] + d[1][i] + d[2][i] + d[3][i]);
        return 0x7f80_0000 - off.iter().map(|x| x * x).sum::<f32>().to_bits();
    }
    // The in-sphere determinant: for one tetrahedron it grows as the distance from the circumcentre
    // falls. In a flat one it is 0.
    let lift = d.map(square);
    let inside = lift[0] * triple(d[1], d[2], d[3]) - lift[1] * triple(d[2], d[3], d[0])
        + lift[2] * triple(d[3], d[0], d[1])
        - lift[3] * triple(d[0], d[1], d[2]);
    if inside == 0.0 { score_by_distance(lift) } else { score_by_volume(inside) }
}

/// Returns the score of point w in the plane of a facet with the corners 0, u and v, by the
/// in-circle determinant.
fn score_in_plane(u: [f32; 3], v: [f32; 3], w: [f32; 3]) -> u32 {
    let [x, y] = [u, v].map(|corner| std::array::from_fn(|i| w[i] - corner[i]));
    let normal = cross(u, v);
    let inside = square(w) * triple(normal, x, y) + square(x) * triple(normal, y, w) + square(y) * triple(normal, w, x);
    if inside == 0.0 { score_by_distance([w, x, y].map(square)) } else { inside.abs().to_bits() >> 1 | 1 << 30 }
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
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
