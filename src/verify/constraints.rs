//! Whether the constrained edges of a 2D mesh are edges, and whether they are what segments are made of.

use crate::verify::{
    input::Input,
    report::{Defect, Findings},
};
use crate::{index::NONE, predicates::orient2d};

/// Returns constrained edges with the lower vertex first, in ascending order.
pub(crate) fn sorted(edges: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut sorted: Vec<[u32; 2]> = edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    sorted.sort_unstable();
    sorted
}

/// Checks that constrained edges, which are [sorted], are among the edges of a mesh.
pub(crate) fn check_edges(constraints: &[[u32; 2]], edges: impl Iterator<Item = [u32; 2]>) -> Findings {
    let mut is_edge = vec![false; constraints.len()];
    for [a, b] in edges {
        if let Ok(at) = constraints.binary_search(&[a.min(b), a.max(b)]) {
            is_edge[at] = true;
        }
    }
    let mut findings = Findings::default();
    for (i, [a, b]) in constraints.iter().enumerate() {
        if constraints.get(i + 1) == Some(&[*a, *b]) {
            findings.add(|| Defect::in_mesh(format!("the constrained edge {a}-{b} is stated twice")));
        } else if !is_edge[i] {
            findings.add(|| Defect::in_mesh(format!("the constrained edge {a}-{b} is not an edge of the mesh")));
        }
    }
    findings
}

/// Checks that each segment is a chain of constrained edges, which are [sorted] edges of the mesh, and that each of
/// these belongs to one.
pub(crate) fn check_segments(
    constraints: &[[u32; 2]],
    segments: &[[u32; 2]],
    input: &Input<2>,
    findings: &mut Findings,
) {
    let mut chains = Chains::new(constraints, input);
    for &[a, b] in segments {
        let missing = |v: u32| input.representative.get(v as usize).is_none_or(|&first| first == NONE);
        if missing(a) || missing(b) {
            findings.add(|| Defect::in_mesh(format!("the segment {a}-{b} has an end that is not a point of the mesh")));
            continue;
        }
        let [from, to] = [a, b].map(|v| input.representative[v as usize]);
        if let Some(gap) = chains.gap(from, to) {
            findings.add(|| Defect::in_mesh(format!("no constrained edge continues the segment {a}-{b} at {gap}")));
        }
    }
    for ([a, b], is_used) in constraints.iter().zip(chains.is_used) {
        if !is_used {
            findings.add(|| Defect::in_mesh(format!("the constrained edge {a}-{b} is not a piece of a segment")));
        }
    }
}

/// The constrained edges at each vertex.
struct Chains<'a> {
    input: &'a Input<2>,
    /// Where the edges of each vertex are in `others`.
    offsets: Vec<usize>,
    /// The other vertex of each edge, and the edge.
    others: Vec<(u32, usize)>,
    /// Whether each edge belongs to a segment.
    is_used: Vec<bool>,
}

impl<'a> Chains<'a> {
    fn new(constraints: &[[u32; 2]], input: &'a Input<2>) -> Self {
        // Ends that are no points have been found as such.
        let is_proper = |(_, ends): &(usize, &[u32; 2])| ends.iter().all(|&v| (v as usize) < input.points.len());
        let edges = constraints.iter().enumerate().filter(is_proper);
        let mut ends: Vec<(u32, u32, usize)> = edges.flat_map(|(i, &[a, b])| [(a, b, i), (b, a, i)]).collect();
        ends.sort_unstable();
        let offset = |v: usize| ends.partition_point(|&(from, ..)| (from as usize) < v);
        let offsets = (0..=input.points.len()).map(offset).collect();
        let others = ends.into_iter().map(|(_, other, i)| (other, i)).collect();
        Chains { input, offsets, others, is_used: vec![false; constraints.len()] }
    }

    fn of(&self, v: u32) -> &[(u32, usize)] {
        &self.others[self.offsets[v as usize]..self.offsets[v as usize + 1]]
    }

    /// Follows the edges from one end of a segment to the other. Returns the vertex where none goes on.
    fn gap(&mut self, a: u32, b: u32) -> Option<u32> {
        // From the end with fewer edges: a star has many at its centre.
        let [from, to] = if self.of(a).len() <= self.of(b).len() { [a, b] } else { [b, a] };
        let point = |v: u32| self.input.points[v as usize];
        let is_forward = point(from) < point(to);
        let mut at = from;
        while at != to {
            let goes_on = |&&(next, _): &&(u32, usize)| {
                let is_between = if is_forward {
                    point(at) < point(next) && point(next) <= point(to)
                } else {
                    point(at) > point(next) && point(next) >= point(to)
                };
                is_between && orient2d(point(from), point(to), point(next)) == 0
            };
            let Some(&(next, edge)) = self.of(at).iter().find(goes_on) else { return Some(at) };
            self.is_used[edge] = true;
            at = next;
        }
        None
    }
}
