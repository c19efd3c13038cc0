//! Invariants after every phase.

use std::collections::HashSet;

use gdel::internals::dimension::Dimension;
use gdel::{
    NONE,
    internals::gpu::layout::{CHECK, Waiting},
};

use crate::State;
use crate::dim::ReferenceDim;
use crate::kernels::Kernels;
use crate::state::replaced;

impl<const D: usize> State<D>
where
    Dimension<D>: Kernels<D>,
{
    /// Panics unless the buffers hold a triangulation: neighbours mutual, sharing their facet and
    /// on opposite sides of it, all simplices positively oriented, the Euler characteristic that of
    /// the sphere, every facet that is not locally Delaunay to be checked, all inserted points
    /// present, every waiting point inside its simplex, and the buffers of this dimension in
    /// agreement.
    pub fn validate(&self) {
        self.validate_mesh();
        self.validate_points();
    }

    fn used(&self) -> impl Iterator<Item = u32> {
        (0..self.simplices.len() as u32).filter(|&t| self.is_used(t as usize))
    }

    /// Returns the vertices of facet `k`, sorted, and whether an odd permutation sorts them.
    fn sorted_facet(&self, t: u32, k: usize) -> (Vec<u32>, bool) {
        let corners = self.corners(t);
        let mut facet: Vec<u32> = Dimension::<D>::facet(k).iter().map(|&c| corners.as_ref()[c]).collect();
        let inversions: usize = (0..D).map(|i| facet[..i].iter().filter(|&&v| v > facet[i]).count()).sum();
        facet.sort_unstable();
        (facet, !inversions.is_multiple_of(2))
    }

    /// Panics unless the invariants of the simplices hold.
    pub fn validate_mesh(&self) {
        let mut present = HashSet::new();
        let mut edges = HashSet::new();
        for t in self.used() {
            let corners = self.corners(t);
            let vertices = corners.as_ref();
            assert!(self.orient(corners) > 0, "simplex {t} {corners:?} is not positively oriented");
            for (i, &v) in vertices.iter().enumerate() {
                present.insert(v);
                edges.extend(vertices[..i].iter().map(|&w| (v.min(w), v.max(w))));
            }
            for k in 0..=D {
                let (u, face) = self.across(t, k);
                assert!(self.is_used(u as usize), "{t} has the unused slot {u} for a neighbour");
                assert_eq!(self.across(u, face), (t, k), "{t} and {u} are not mutual neighbours");
                let [(facet, turn), (other_facet, other_turn)] = [self.sorted_facet(t, k), self.sorted_facet(u, face)];
                assert_eq!(facet, other_facet, "{t} and {u} do not share a facet");
                assert_ne!(turn, other_turn, "{t} and {u} lie on one side of their facet");
                let noticed = |t: u32, k: usize| self.status[t as usize].flags >> k & 0x11 != 0;
                let other = self.corners(u);
                assert!(
                    noticed(t, k) || noticed(u, face) || !self.inside(corners, other.as_ref()[face]),
                    "nobody will check the facet of {t} {corners:?} and {u} {other:?}, which is not locally Delaunay"
                );
            }
        }
        assert_eq!(
            present.len() + self.used().count(),
            edges.len() + Dimension::<D>::EULER_CHARACTERISTIC,
            "the Euler characteristic is not that of the sphere"
        );
        Dimension::<D>::validate_own(self);
        let half = &self.active[self.half()][..self.counters.active_len[self.half()] as usize];
        let listed: HashSet<u32> = half.iter().map(|a| a.tet).collect();
        assert_eq!(listed.len(), half.len(), "a simplex is active twice");
        for t in self.used() {
            let active = self.status[t as usize].flags & CHECK != 0;
            assert_eq!(active, listed.contains(&t), "simplex {t}: list and flags disagree");
        }
    }

    fn validate_points(&self) {
        let present: HashSet<u32> = self.used().flat_map(|t| self.corners(t).as_ref().to_vec()).collect();
        let located: Vec<&Waiting> = self.waiting.iter().filter(|w| w.tet != NONE).collect();
        let waiting: HashSet<u32> = located.iter().map(|w| w.point).collect();
        for p in 0..self.params.infinite {
            let states = [present.contains(&p), waiting.contains(&p), self.merged[p as usize]];
            let count = states.into_iter().filter(|&s| s).count();
            assert_eq!(count, 1, "point {p}: inserted, waiting, merged: {states:?}");
        }
        for &&Waiting { point: p, tet: t } in &located {
            let corners = self.corners(t);
            assert!(
                (0..=D).all(|k| self.orient(replaced(corners, k, p)) > 0),
                "point {p} does not lie in its simplex {t} {corners:?}"
            );
        }
    }
}
