//! Invariants at the end of Phase 1.

use gdel::internals::d3::mesh::FACETS;

use crate::State;

impl State<3> {
    /// Panics if a facet can still be flipped. Returns how many are not locally Delaunay.
    pub fn validate_end(&self) -> usize {
        let mut bad = 0;
        for t in (0..self.simplices.len() as u32).filter(|&t| self.is_used(t as usize)) {
            let tet = self.corners(t);
            for k in 0..4 {
                let (u, face) = self.across(t, k);
                let e = self.corners(u)[face];
                if u < t || !self.inside(tet, e) {
                    continue;
                }
                bad += 1;
                let x = FACETS[k].map(|c| tet[c]);
                let negative: Vec<usize> =
                    (0..3).filter(|&i| self.orient([x[i], x[(i + 1) % 3], tet[k], e]) < 0).collect();
                assert!(!negative.is_empty(), "{t} and {u} can be flipped to three");
                if let [i] = negative[..] {
                    let ends = [x[i], x[(i + 1) % 3]];
                    let around = self.simplices.iter().filter(|tet| ends.iter().all(|v| tet.contains(v))).count();
                    assert!(around > 3, "three tetrahedra around {ends:?} can be flipped to two");
                }
                for v in x.into_iter().filter(|&v| v != self.params.infinite) {
                    assert_eq!(self.own.failed[v as usize], 1, "vertex {v} is not marked as failed");
                }
            }
        }
        bad
    }
}
