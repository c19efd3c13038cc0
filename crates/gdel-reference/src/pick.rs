//! Which point each simplex inserts (§3.1).

use gdel::internals::dimension::Dimension;
use gdel::{
    NONE,
    internals::gpu::layout::{Pick, Waiting},
};

use crate::State;
use crate::dim::ReferenceDim;
use crate::kernels::Kernels;

/// Scores each waiting point and finds the best score of each simplex. Compacts the list if that is
/// due. One invocation per entry of the list.
pub fn pick_score<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: Kernels<D>,
{
    if state.counters.entries_before != 0 {
        state.waiting.retain(|entry| entry.tet != NONE);
        state.counters.kept = state.waiting.len() as u32;
    }
    for i in 0..state.waiting.len() {
        let Waiting { point: p, tet: t } = state.waiting[i];
        if t == NONE {
            continue;
        }
        let score = if state.counters.criterion == Pick::Random as u32 {
            (p ^ state.counters.inserted.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b) >> 1 | 1
        } else {
            Dimension::<D>::score(state, t, p)
        };
        state.scores[i] = score;
        let best = &mut state.messages[t as usize][0];
        *best = score.max(*best);
    }
}

/// Picks the point with the best score, the last of equals. One invocation per waiting point.
pub fn pick_point<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    for (&Waiting { point: p, tet: t }, &score) in state.waiting.iter().zip(&state.scores) {
        if t != NONE && score == state.messages[t as usize][0] {
            let picked = &mut state.messages[t as usize][1];
            *picked = (p + 1).max(*picked);
        }
    }
}

/// Returns the way from vertex `w` to vertex `v`. Of wide coordinates, it takes the high words.
pub(super) fn difference<const D: usize>(state: &State<D>, v: u32, w: u32) -> [f32; D]
where
    Dimension<D>: ReferenceDim<D>,
{
    let drop = state.width.bits() - 31;
    let q = |v: u32| state.points[v as usize].position.map(|x| x >> drop);
    let (v, w) = (q(v), q(w));
    std::array::from_fn(|axis| (v[axis] - w[axis]) as f32)
}

/// Returns a power of two that brings the largest of these below 2.
pub(super) fn scale_of<const D: usize>(vectors: &[[f32; D]]) -> f32 {
    let largest = vectors.iter().flatten().fold(1.0f32, |m, x| m.max(x.abs()));
    f32::from_bits(0x7f00_0000 - (largest.to_bits() & 0x7f80_0000))
}

/// Returns whether a determinant is distinct from 0, beyond rounding. `permanent` is the sum of its
/// terms, all taken as positive.
pub(super) fn is_distinct(value: f32, permanent: f32) -> bool {
    const ROUNDING: f32 = 1.0 / (1 << 20) as f32;
    value.abs() > ROUNDING * permanent
}

/// Returns a score by the size of a determinant. It is above the others.
pub(super) fn score_by_volume(value: f32) -> u32 {
    value.abs().to_bits() | 1 << 31
}

/// Returns a score by the square of the distance from the nearest vertex, given the squares of the
/// distances from all. It is below the others.
pub(super) fn score_by_distance<const N: usize>(squares: [f32; N]) -> u32 {
    squares.into_iter().fold(f32::INFINITY, f32::min).to_bits() >> 1 | 1
}
