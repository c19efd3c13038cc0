//! What must hold after every phase.

use std::collections::HashSet;

use crate::d3::mesh::FACETS;
use crate::gpu::layout::{BLOCK, CHECK, NONE, Waiting};

use crate::reference::d3::State;
use crate::reference::d3::state::replaced;

impl State {
    /// Panics unless the buffers hold a triangulation: neighbours mutual and sharing their facet, all tetrahedra
    /// positively oriented, the Euler characteristic that of the 3-sphere, slots and free bits in agreement, all
    /// inserted points present, every waiting point inside its tetrahedron.
    pub fn validate(&self) {
        self.validate_mesh();
        self.validate_points();
    }

    /// The part about tetrahedra.
    pub fn validate_mesh(&self) {
        let used: Vec<usize> = (0..self.tets.len()).filter(|&t| self.is_used(t)).collect();
        let mut present = HashSet::new();
        let mut edges = HashSet::new();
        for &t in &used {
            let tet = self.tets[t];
            assert!(self.orient(tet) > 0, "tetrahedron {t} {tet:?} is not positively oriented");
            present.extend(tet);
            for i in 0..4 {
                edges.extend((0..i).map(|j| (tet[i].min(tet[j]), tet[i].max(tet[j]))));
            }
            for k in 0..4 {
                let across = self.neighbors[t][k];
                let (u, face) = ((across >> 2) as usize, (across & 3) as usize);
                assert!(self.is_used(u), "{t} has the free slot {u} for a neighbour");
                assert_eq!(self.neighbors[u][face], (4 * t + k) as u32, "{t} and {u} are not mutual neighbours");
                let sorted = |t: usize, k: usize| {
                    let mut facet = FACETS[k].map(|c| self.tets[t][c]);
                    facet.sort_unstable();
                    facet
                };
                assert_eq!(sorted(t, k), sorted(u, face), "{t} and {u} do not share a facet");
                let noticed = |t: usize, k: usize| self.status[t].flags >> k & 0x11 != 0;
                assert!(
                    noticed(t, k) || noticed(u, face) || !self.inside(tet, self.tets[u][face]),
                    "nobody will check the facet of {t} {tet:?} and {u} {:?}, which is not locally Delaunay",
                    self.tets[u]
                );
            }
        }
        // Facets are twice as many as tetrahedra, so vertices − edges + facets − tetrahedra is this.
        assert_eq!(present.len() + used.len(), edges.len(), "the Euler characteristic is not 0");
        for (t, tet) in self.tets.iter().enumerate() {
            let v = (t as u32) / BLOCK;
            let free = self.free[v as usize] >> (t as u32 % BLOCK) & 1 != 0;
            assert_eq!(free, *tet == [0; 4], "slot {t} is both free and used, or neither");
        }
        let half = &self.active[self.half()][..self.counters.active_len[self.half()] as usize];
        let listed: HashSet<u32> = half.iter().map(|a| a.tet).collect();
        assert_eq!(listed.len(), half.len(), "a tetrahedron is active twice");
        for &t in &used {
            let active = self.status[t].flags & CHECK != 0;
            assert_eq!(active, listed.contains(&(t as u32)), "tetrahedron {t}: list and flags disagree");
        }
    }

    fn validate_points(&self) {
        let used = (0..self.tets.len()).filter(|&t| self.is_used(t));
        let present: HashSet<u32> = used.flat_map(|t| self.tets[t]).collect();
        let located: Vec<&Waiting> = self.waiting.iter().filter(|w| w.tet != NONE).collect();
        let waiting: HashSet<u32> = located.iter().map(|w| w.point).collect();
        for p in 0..self.params.infinite {
            let states = [present.contains(&p), waiting.contains(&p), self.merged[p as usize]];
            let count = states.into_iter().filter(|&s| s).count();
            assert_eq!(count, 1, "point {p}: inserted, waiting, merged: {states:?}");
        }
        for &&Waiting { point: p, tet: t } in &located {
            let tet = self.tets[t as usize];
            assert!(
                (0..4).all(|k| self.orient(replaced(tet, k, p)) > 0),
                "point {p} does not lie in its tetrahedron {t} {tet:?}"
            );
        }
    }

    /// Panics if a facet can still be flipped. Returns how many are not locally Delaunay.
    pub fn validate_end(&self) -> usize {
        let mut bad = 0;
        for t in (0..self.tets.len()).filter(|&t| self.is_used(t)) {
            let tet = self.tets[t];
            for k in 0..4 {
                let across = self.neighbors[t][k];
                let (u, face) = ((across >> 2) as usize, (across & 3) as usize);
                let e = self.tets[u][face];
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
                    let around = self.tets.iter().filter(|tet| ends.iter().all(|v| tet.contains(v))).count();
                    assert!(around > 3, "three tetrahedra around {ends:?} can be flipped to two");
                }
                for v in x.into_iter().filter(|&v| v != self.params.infinite) {
                    assert_eq!(self.failed[v as usize], 1, "vertex {v} is not marked as failed");
                }
            }
        }
        bad
    }
}
