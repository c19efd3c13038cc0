//! What must hold after every round.

use std::collections::HashSet;

use crate::gpu::layout::{CHECK, NONE, Waiting};

use crate::reference::d2::State;
use crate::reference::d2::state::replaced;

impl State {
    /// Panics unless the buffers hold a triangulation: neighbours mutual and sharing their edge, all triangles positively
    /// oriented, the Euler characteristic that of the sphere, all inserted points present, every waiting point inside its
    /// triangle, and every edge that is not locally Delaunay to be checked.
    pub fn validate(&self) {
        self.validate_mesh();
        self.validate_points();
    }

    /// The part about triangles.
    pub fn validate_mesh(&self) {
        let used: Vec<u32> = (0..self.triangles.len() as u32).filter(|&t| self.is_used(t as usize)).collect();
        let mut present = HashSet::new();
        for &t in &used {
            let triangle = self.triangle(t);
            assert!(self.orient(triangle) > 0, "triangle {t} {triangle:?} is not positively oriented");
            present.extend(triangle);
            for k in 0..3 {
                let (u, edge) = self.across(t, k);
                assert!(self.is_used(u as usize), "{t} has the unused slot {u} for a neighbour");
                assert_eq!(self.across(u, edge), (t, k), "{t} and {u} are not mutual neighbours");
                let other = self.triangle(u);
                let ends = [triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
                assert_eq!([other[(edge + 2) % 3], other[(edge + 1) % 3]], ends, "{t} and {u} do not share an edge");
                let noticed = |t: u32, k: usize| self.status[t as usize].flags >> k & 1 != 0;
                assert!(
                    noticed(t, k) || noticed(u, edge) || !self.inside(triangle, other[edge]),
                    "nobody will check the edge of {t} {triangle:?} and {u} {other:?}, which is not locally Delaunay"
                );
            }
        }
        assert_eq!(used.len(), 2 * present.len() - 4, "the Euler characteristic is not 2");
        let half = &self.active[self.half()][..self.counters.active_len[self.half()] as usize];
        let listed: HashSet<u32> = half.iter().map(|a| a.tet).collect();
        assert_eq!(listed.len(), half.len(), "a triangle is active twice");
        for &t in &used {
            let active = self.status[t as usize].flags & CHECK != 0;
            assert_eq!(active, listed.contains(&t), "triangle {t}: list and flags disagree");
        }
    }

    fn validate_points(&self) {
        let used = (0..self.triangles.len() as u32).filter(|&t| self.is_used(t as usize));
        let present: HashSet<u32> = used.flat_map(|t| self.triangle(t)).collect();
        let located: Vec<&Waiting> = self.waiting.iter().filter(|w| w.tet != NONE).collect();
        let waiting: HashSet<u32> = located.iter().map(|w| w.point).collect();
        for p in 0..self.params.infinite {
            let states = [present.contains(&p), waiting.contains(&p), self.merged[p as usize]];
            let count = states.into_iter().filter(|&s| s).count();
            assert_eq!(count, 1, "point {p}: inserted, waiting, merged: {states:?}");
        }
        for &&Waiting { point: p, tet: t } in &located {
            let triangle = self.triangle(t);
            assert!(
                (0..3).all(|k| self.orient(replaced(triangle, k, p)) > 0),
                "point {p} does not lie in its triangle {t} {triangle:?}"
            );
        }
    }

    /// Panics unless every edge is locally Delaunay and no triangle is active.
    pub fn validate_end(&self) {
        self.validate_mesh();
        assert_eq!(self.counters.active_len[self.half()], 0);
    }
}
