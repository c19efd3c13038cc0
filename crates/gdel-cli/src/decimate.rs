//! Fewer triangles: decimation by quadrics, by the library meshoptimizer.

use meshopt::{SimplifyOptions, simplify_decoder};
use std::collections::HashMap;

/// So often fewer triangles are tried.
const ATTEMPTS: u32 = 40;

/// Returns about `count` triangles with some of the vertices, or more where fewer would not be a manifold or
/// would not be closed although the given ones are.
pub(super) fn decimated(vertices: &[[f64; 3]], triangles: &[[u32; 3]], count: usize) -> Vec<[u32; 3]> {
    let (center, size) = middle(vertices);
    // The library computes in single precision.
    let positions: Vec<[f32; 3]> =
        vertices.iter().map(|p| [0, 1, 2].map(|k| ((p[k] - center[k]) / size) as f32)).collect();
    let is_closed = |triangles: &[[u32; 3]]| boundary_edges(triangles).map(|open| open == 0);
    let wanted = is_closed(triangles);
    let mut best = triangles.to_vec();
    // Where the way to the goal leads to something else than a manifold, half of it may not.
    let mut target = count;
    for _ in 0..ATTEMPTS {
        if best.len() <= count || target >= best.len() {
            break;
        }
        let fewer =
            simplify_decoder(best.as_flattened(), &positions, 3 * target, f32::MAX, SimplifyOptions::None, None);
        let fewer = fewer.as_chunks().0;
        if fewer.len() < best.len() && !fewer.is_empty() && is_closed(fewer) == wanted {
            best = fewer.to_vec();
            target = count;
        } else {
            target += (best.len() - target).div_ceil(2);
        }
    }
    best
}

/// Returns the middle of points and the largest extent, at least 1 if they are all the same.
fn middle(points: &[[f64; 3]]) -> ([f64; 3], f64) {
    let along = |axis: usize| points.iter().map(move |p| p[axis]);
    let low = [0, 1, 2].map(|axis| along(axis).fold(f64::INFINITY, f64::min));
    let high = [0, 1, 2].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max));
    let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    let center = [0, 1, 2].map(|axis| low[axis] / 2.0 + high[axis] / 2.0);
    (center, if extent > 0.0 && extent.is_finite() { extent } else { 1.0 })
}

/// Returns the number of edges with one triangle; `None` if an edge or a vertex has triangles of several
/// sheets, or if neighbours have opposite directions.
fn boundary_edges(triangles: &[[u32; 3]]) -> Option<usize> {
    // The triangles around a vertex turn from one neighbour to the next.
    let mut next: HashMap<[u32; 2], u32> = HashMap::new();
    for &[a, b, c] in triangles {
        for [v, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
            if from == to || next.insert([v, from], to).is_some() {
                return None;
            }
        }
    }
    // How many triangles each vertex has, and where they begin.
    let mut fans: HashMap<u32, (usize, u32)> = HashMap::new();
    let mut open = 0;
    for &[v, from] in next.keys() {
        let fan = fans.entry(v).or_insert((0, from));
        fan.0 += 1;
        if !next.contains_key(&[from, v]) {
            fan.1 = from;
            open += 1;
        }
    }
    let is_whole = |(&v, &(count, start)): (&u32, &(usize, u32))| {
        let (mut at, mut steps) = (start, 0);
        while let Some(&to) = next.get(&[v, at]).filter(|_| steps < count) {
            (at, steps) = (to, steps + 1);
            if at == start {
                break;
            }
        }
        steps == count
    };
    fans.iter().all(is_whole).then_some(open)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_are_told_apart() {
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert_eq!(boundary_edges(&tetrahedron), Some(0));
        assert_eq!(boundary_edges(&tetrahedron[1..]), Some(3));
        assert_eq!(boundary_edges(&tetrahedron[2..]), Some(4));
        assert_eq!(boundary_edges(&[]), Some(0));
        // Two triangles at a vertex, the same edge twice, opposite directions.
        assert_eq!(boundary_edges(&[[0, 1, 2], [0, 3, 4]]), None);
        assert_eq!(boundary_edges(&[[0, 1, 2], [0, 1, 3]]), None);
        assert_eq!(boundary_edges(&[[0, 1, 2], [0, 1, 2]]), None);
        let other = tetrahedron.map(|t| t.map(|v| if v == 0 { 0 } else { v + 3 }));
        assert_eq!(boundary_edges(&[tetrahedron, other].concat()), None);
    }
}
