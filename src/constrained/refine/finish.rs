//! The result: what was removed leaves no gaps in the indices.

use super::{RefineLeft, RefineStats, Refined2, improve::Improver, pieces::Vertex};
use crate::{
    constrained::{Constrained2, growing::hull},
    index::NONE,
    predicates::orient2d,
};

/// Makes the refined mesh the result. `given` is what it was made of, which has as many points.
pub(super) fn finish(improver: &Improver<'_>, given: &Constrained2, points: usize) -> Refined2 {
    let mesh = &improver.mesh;
    // Where each vertex goes, and each triangle.
    let mut places: Vec<u32> = (0..points as u32).collect();
    places.resize(mesh.points.len(), NONE);
    mesh.triangles.iter().flat_map(|t| t.vertices).filter(|&v| v != NONE).for_each(|v| places[v as usize] = v);
    let mut found = given.clone();
    for (place, &point) in places.iter_mut().zip(&mesh.points).skip(points).filter(|(place, _)| **place != NONE) {
        *place = (points + found.added.len() - given.added.len()) as u32;
        found.added.push(point);
    }
    let kept: Vec<usize> = (0..mesh.triangles.len()).filter(|&t| mesh.triangles[t].vertices[0] != NONE).collect();
    let mut slots = vec![NONE; mesh.triangles.len()];
    (0..).zip(&kept).for_each(|(slot, &t)| slots[t] = slot);
    let at = |v: u32| places[v as usize];
    let moved = |e: u32| if e == NONE { NONE } else { 3 * slots[e as usize / 3] + e % 3 };
    found.mesh.triangles = kept.iter().map(|&t| mesh.triangles[t].vertices.map(at)).collect();
    found.mesh.halfedges = kept.iter().map(|&t| mesh.triangles[t].across.map(moved)).collect();
    found.inside = kept.iter().map(|&t| mesh.triangles[t].is_inside).collect();
    found.mesh.duplicate_of.resize(points + found.added.len() - given.added.len(), NONE);
    found.mesh.hull = hull(&found.mesh);
    let pieces = improver.pieces.pieces.iter().map(|piece| piece.ends.map(at));
    found.mesh.constraints = pieces.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    found.mesh.constraints.sort_unstable();
    let (segments, segment_of) = cut_segments(improver, given);
    found.segments = segments.into_iter().map(|piece| piece.map(at)).collect();
    let stats = statistics(improver, &kept, &places[points..]);
    Refined2 { constrained: found, segment_of, stats }
}

/// Returns the pieces of the segments, in their order and direction, and the number of each one's segment.
fn cut_segments(improver: &Improver<'_>, given: &Constrained2) -> (Vec<[u32; 2]>, Vec<u32>) {
    let constraints = &given.mesh.constraints;
    let neighbors = Neighbors::new(improver, constraints);
    let (mut pieces, mut segment_of) = (Vec::new(), Vec::new());
    let mut add = |edge: usize, is_reversed: bool, segment: u32| {
        let from = pieces.len();
        pieces.extend(improver.pieces.of_segment(edge as u32));
        if is_reversed {
            pieces[from..].reverse();
            pieces[from..].iter_mut().for_each(|ends| ends.reverse());
        }
        segment_of.resize(pieces.len(), segment);
    };
    for (i, &segment) in (0..).zip(&given.segments) {
        let [a, b] = segment.map(|v| given.mesh.representative(v));
        let mut path = neighbors.path(a, b);
        // Around the other end there may be fewer.
        let is_reversed = neighbors.of(b).len() < neighbors.of(a).len();
        if is_reversed {
            path = neighbors.path(b, a);
            path.reverse();
        }
        for (edge, is_backward) in path {
            add(edge, is_backward != is_reversed, i);
        }
    }
    for edge in constraints.len()..improver.pieces.segments.len() {
        add(edge, false, NONE);
    }
    (pieces, segment_of)
}

/// The constrained edges of each given vertex.
struct Neighbors<'i> {
    improver: &'i Improver<'i>,
    constraints: &'i [[u32; 2]],
    first: Vec<u32>,
    edges: Vec<u32>,
}

impl<'i> Neighbors<'i> {
    fn new(improver: &'i Improver<'i>, constraints: &'i [[u32; 2]]) -> Self {
        let mut first = vec![0; improver.mesh.points.len() + 2];
        constraints.as_flattened().iter().for_each(|&v| first[v as usize + 2] += 1);
        (2..first.len()).for_each(|v| first[v] += first[v - 1]);
        let mut edges = vec![0; 2 * constraints.len()];
        for (i, ends) in (0..).zip(constraints) {
            for &v in ends {
                edges[first[v as usize + 1] as usize] = i;
                first[v as usize + 1] += 1;
            }
        }
        Neighbors { improver, constraints, first, edges }
    }

    fn of(&self, v: u32) -> &[u32] {
        &self.edges[self.first[v as usize] as usize..self.first[v as usize + 1] as usize]
    }

    /// Returns the constrained edges that lead straight from a vertex to another, and whether each leads from its higher
    /// vertex to the lower one.
    fn path(&self, from: u32, to: u32) -> Vec<(usize, bool)> {
        let mut path = Vec::new();
        let mut at = from;
        let point = |v: u32| self.improver.mesh.point(v);
        while at != to && path.len() < self.constraints.len() {
            let other = |edge: u32| {
                let [low, high] = self.constraints[edge as usize];
                if low == at { high } else { low }
            };
            if let Ok(edge) = self.constraints.binary_search(&[at.min(to), at.max(to)]) {
                path.push((edge, at > to));
                break;
            }
            let is_on = |&&edge: &&u32| {
                let v = other(edge);
                orient2d(point(at), point(to), point(v)) == 0 && (point(at) < point(v)) == (point(at) < point(to))
            };
            let Some(&edge) = self.of(at).iter().find(is_on) else { break };
            let on = other(edge);
            path.push((edge as usize, at > on));
            at = on;
        }
        path
    }
}

/// Counts what was done, and what is left.
fn statistics(improver: &Improver<'_>, kept: &[usize], places: &[u32]) -> RefineStats {
    let mut stats = RefineStats { removed: improver.removed, limited: improver.is_limited, ..RefineStats::default() };
    let added = &improver.pieces.vertices[improver.pieces.vertices.len() - places.len()..];
    for vertex in added.iter().zip(places).filter(|&(_, &place)| place != NONE).map(|(&vertex, _)| vertex) {
        match vertex {
            Vertex::On(_) => stats.points_on_segments += 1,
            _ => stats.points_inside += 1,
        }
    }
    let mut left = RefineLeft::default();
    let mut smallest = f64::INFINITY;
    for &t in kept.iter().filter(|&&t| improver.mesh.triangles[t].is_inside) {
        let t = t as u32;
        let measures = improver.measure(t);
        smallest = smallest.min(measures.sine);
        left.too_large += usize::from(improver.is_large(t, &measures));
        if improver.shape.is_skinny(&measures) {
            let reason = if improver.is_between(t, &measures) {
                &mut left.input_angle
            } else if improver.is_limited {
                &mut left.limit
            } else {
                &mut left.resolution
            };
            *reason += 1;
        }
    }
    stats.min_angle = if smallest.is_finite() { libm::asin(smallest.sqrt()).to_degrees() } else { 0.0 };
    stats.left = left;
    stats
}
