//! Which point a triangle inserts (§3.1).

use gdel::internals::gpu::layout::Pick;

use crate::State;
use crate::pick::{difference, is_distinct, scale_of, score_by_distance, score_by_volume};

/// Returns how much a triangle wants a point, at least 1. Scores of different triangles do not
/// compare.
pub(super) fn score(state: &State<2>, t: u32, p: u32) -> u32 {
    let vertices = state.corners(t);
    let infinite = state.params.infinite;
    let difference = |v: u32, w: u32| difference(state, v, w);
    let scaled = |d: [f32; 2], scale: f32| d.map(|x| x * scale);
    if let Some(k) = vertices.iter().position(|&v| v == infinite) {
        // The hull grows most by the point that is farthest from the edge.
        let [a, b] = [1, 2].map(|i| vertices[(k + i) % 3]);
        let scale = scale_of(&[difference(b, a)]);
        let [u, v] = [difference(b, a), difference(p, a)].map(|d| scaled(d, scale));
        let area = cross(u, v);
        if is_distinct(area, (u[0] * v[1]).abs() + (u[1] * v[0]).abs()) {
            return score_by_volume(area);
        }
        return score_by_distance([v, [v[0] - u[0], v[1] - u[1]]].map(square));
    }
    let scale = scale_of(&[1, 2].map(|i| difference(vertices[i], vertices[0])));
    let [a, b, c] = vertices.map(|v| scaled(difference(v, p), scale));
    if state.counters.criterion == Pick::Centroid as u32 {
        return 0x7f80_0000 - square([a[0] + b[0] + c[0], a[1] + b[1] + c[1]]).to_bits();
    }
    // The in-circle determinant: for one triangle it grows as the distance from the circumcentre
    // falls. In a flat one it is 0.
    let inside = square(a) * cross(b, c) + square(b) * cross(c, a) + square(c) * cross(a, b);
    if inside == 0.0 { score_by_distance([a, b, c].map(square)) } else { score_by_volume(inside) }
}

fn square(a: [f32; 2]) -> f32 {
    dot(a, a)
}

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}
