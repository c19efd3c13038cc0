//! Which point each tetrahedron inserts (§3.1).

use crate::gpu::layout::Pick;
use crate::gpu::layout::{NONE, Waiting};

use crate::reference::d3::State;

/// Scores each waiting point and finds the best score of each tetrahedron. One thread a waiting point.
///
/// It also begins the insertion round.
pub fn pick_score(state: &mut State) {
    state.counters.round += 1;
    state.counters.first_node = state.counters.next_node;
    for i in 0..state.waiting.len() {
        let Waiting { point: p, tet: t } = state.waiting[i];
        if t == NONE {
            continue;
        }
        let score = score(state, t, p);
        state.scores[i] = score;
        let best = &mut state.messages[t as usize][0];
        *best = score.max(*best);
    }
}

/// Picks the point with the best score, the last of equals. One thread a waiting point.
pub fn pick_point(state: &mut State) {
    for (&Waiting { point: p, tet: t }, &score) in state.waiting.iter().zip(&state.scores) {
        if t != NONE && score == state.messages[t as usize][0] {
            let picked = &mut state.messages[t as usize][1];
            *picked = (p + 1).max(*picked);
        }
    }
}

/// How much a tetrahedron wants a point, at least 1. Scores of different tetrahedra do not compare.
pub fn score(state: &State, t: u32, p: u32) -> u32 {
    let vertices = state.tets[t as usize];
    let infinite = state.params.infinite;
    if state.params.pick == Pick::Random as u32 {
        return (p ^ state.counters.inserted.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b) >> 1 | 1;
    }
    // Of wide coordinates, the high words.
    let drop = state.width.bits() - 31;
    let q = |v: u32| state.points[v as usize].position.map(|x| x >> drop);
    let difference = |v: u32, w: u32| -> [f32; 3] { std::array::from_fn(|i| (q(v)[i] - q(w)[i]) as f32) };
    if let Some(k) = vertices.iter().position(|&v| v == infinite) {
        // The hull grows most by the point that is farthest from the facet.
        let [a, b, c] = [1, 2, 3].map(|i| vertices[(k + i) % 4]);
        let (u, v) = (difference(b, a), difference(c, a));
        let scale = scale_of(&[u, v]);
        let [u, v, w] = [u, v, difference(p, a)].map(|d| d.map(|x| x * scale));
        return triple(u, v, w).abs().to_bits() + 1;
    }
    let scale = scale_of(&[1, 2, 3].map(|i| difference(vertices[i], vertices[0])));
    let d = vertices.map(|v| difference(v, p).map(|x| x * scale));
    if state.params.pick == Pick::Centroid as u32 {
        let off: [f32; 3] = std::array::from_fn(|i| d[0][i] + d[1][i] + d[2][i] + d[3][i]);
        return 0x7f80_0000 - off.iter().map(|x| x * x).sum::<f32>().to_bits();
    }
    // The in-sphere determinant: for one tetrahedron it grows as the distance from the circumcentre falls.
    let lift = d.map(|v| v.iter().map(|x| x * x).sum::<f32>());
    let inside = lift[0] * triple(d[1], d[2], d[3]) - lift[1] * triple(d[2], d[3], d[0])
        + lift[2] * triple(d[3], d[0], d[1])
        - lift[3] * triple(d[0], d[1], d[2]);
    inside.abs().to_bits() + 1
}

/// A power of two that brings the largest of these below 2.
fn scale_of(vectors: &[[f32; 3]]) -> f32 {
    let largest = vectors.iter().flatten().fold(1.0f32, |m, x| m.max(x.abs()));
    f32::from_bits(0x7f00_0000 - (largest.to_bits() & 0x7f80_0000))
}

fn triple(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> f32 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}
