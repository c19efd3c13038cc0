//! Which point a triangle inserts (§3.1).

use crate::gpu::layout::Pick;

use crate::reference::State;
use crate::reference::pick::{difference, scale_of};

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
        let to_b = [u[0] - v[0], u[1] - v[1]];
        return score_or_betweenness(cross(u, v), dot(v, to_b));
    }
    let scale = scale_of(&[1, 2].map(|i| difference(vertices[i], vertices[0])));
    let [a, b, c] = vertices.map(|v| scaled(difference(v, p), scale));
    let square = |d| dot(d, d);
    if state.params.pick == Pick::Centroid as u32 {
        return 0x7f80_0000 - square([a[0] + b[0] + c[0], a[1] + b[1] + c[1]]).to_bits();
    }
    // The in-circle determinant: for one triangle it grows as the distance from the circumcentre
    // falls.
    let inside = square(a) * cross(b, c) + square(b) * cross(c, a) + square(c) * cross(a, b);
    score_or_betweenness(inside, -median([dot(a, b), dot(b, c), dot(c, a)]))
}

/// Returns the score of a point by its distance; where that is 0 because the point lies on the line
/// of the edge or of the flat triangle, by how much it lies in the middle between two neighbouring
/// vertices, below all scores by distance. So collinear points halve what is between them, and it
/// does not take a round for each.
fn score_or_betweenness(distance: f32, betweenness: f32) -> u32 {
    let score = if distance == 0.0 { betweenness * BELOW_DISTANCES } else { distance };
    score.abs().to_bits() + 1
}

/// Returns, for a point of the line of a flat triangle, of the three products of the ways to its
/// vertices that of the neighbours. The product of the outer vertices is lower, the third is
/// positive.
fn median([x, y, z]: [f32; 3]) -> f32 {
    x.min(y).max(x.max(y).min(z))
}

/// 2⁻⁷⁰: distances that are not 0 are at least about 2⁻⁶³, and betweenness is at most about 1.
const BELOW_DISTANCES: f32 = f32::from_bits((127 - 70) << 23);

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}
