//! Which vertices other tiles have to know.

use super::dim::Tiled;
use crate::{
    dimension::Dimension,
    geometry::{self, Euclidean, Geometry, vector},
    parallel::{self, CHUNK, Threads},
    slots::Slots,
};

/// So many facets are between the simplices with vertices of other tiles and the last ones that are
/// [pushed](Border::push): fewer of them make more steps, and more of them send what nobody needs.
const DEPTH: usize = 3;

/// The vertices of a tile: first its own, then those of other tiles that all tiles know, then others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertices<'a> {
    /// The tile.
    pub(super) number: u32,
    /// The number of its own vertices.
    pub(super) own: u32,
    /// The number of vertices of other tiles that all tiles know.
    pub(super) common: u32,
    /// The tile that each vertex of other tiles belongs to.
    pub(super) owners: &'a [u32],
}

impl Vertices<'_> {
    /// Returns the tile that a vertex belongs to, and the tile itself for the infinite one, which follows the others.
    fn owner(&self, v: u32) -> u32 {
        v.checked_sub(self.own).and_then(|v| self.owners.get(v as usize)).copied().unwrap_or(self.number)
    }

    /// Returns the infinite vertex.
    pub(super) fn infinite(&self) -> u32 {
        self.own + self.owners.len() as u32
    }

    /// Returns whether a vertex belongs to another tile.
    #[inline]
    pub(super) fn is_foreign(&self, v: u32) -> bool {
        v >= self.own && v != self.infinite()
    }
}

/// The simplices of a tile that have vertices of others.
pub(super) struct Border<'a, const D: usize, T> {
    triangulation: &'a T,
    vertices: Vertices<'a>,
    /// Their slots.
    simplices: Vec<u32>,
}

impl<'a, const D: usize, T> Border<'a, D, T> {
    /// Finds the simplices of a tile that have a vertex of another tile, as far as they have one from `first` on.
    pub(super) fn new<const N: usize>(
        threads: Threads,
        triangulation: &'a T,
        vertices: Vertices<'a>,
        first: u32,
    ) -> Self
    where
        Dimension<D>: Tiled<D, N, Triangulation = T>,
        T: Sync,
    {
        let infinite = vertices.infinite();
        let from = first.max(vertices.own);
        // Where only vertices of other tiles are new, these are enough.
        let is_new = |v: &u32| (from..infinite).contains(v);
        let belongs =
            |t: &u32| Dimension::<D>::simplex(triangulation, *t).is_some_and(|simplex| simplex.iter().any(is_new));
        let parts = parallel::map_ranges(threads, Dimension::<D>::slots(triangulation) as usize, |range| {
            (range.start as u32..range.end as u32).filter(&belongs).collect()
        });
        Border { triangulation, vertices, simplices: parallel::joined(parts) }
    }

    /// Sends the tile's own vertices of simplices near the border whose circumspheres meet the boxes of other tiles:
    /// most of what the others need.
    ///
    /// Nothing depends on what is found here but how much is left to [`exchange`](Border::exchange).
    pub(super) fn push<const N: usize>(
        &self,
        point: impl Fn(u32) -> [f64; D],
        bounds: &[Option<[[f64; D]; 2]>],
        send: &mut impl FnMut(u32, u32),
    ) where
        Dimension<D>: Tiled<D, N, Triangulation = T>,
        Euclidean: Geometry<D, N>,
        T: Slots<N>,
    {
        let infinite = self.vertices.infinite();
        let mut is_seen = vec![false; Dimension::<D>::slots(self.triangulation) as usize];
        self.simplices.iter().for_each(|&t| is_seen[t as usize] = true);
        let mut level = self.simplices.clone();
        for depth in 0..=DEPTH {
            let mut next = Vec::new();
            for t in level {
                let Some(simplex) = Dimension::<D>::simplex(self.triangulation, t) else { continue };
                let mut goes_on = depth == 0;
                if !simplex.contains(&infinite) {
                    let corners = simplex.map(&point);
                    let (offset, radius) = geometry::circumsphere(&corners);
                    let center = vector::plus(corners[0], offset);
                    for (to, bounds) in (0..).zip(bounds) {
                        if to != self.vertices.number && bounds.is_some_and(|bounds| meets(center, radius, bounds)) {
                            goes_on = true;
                            let own = simplex.iter().filter(|&&v| v < self.vertices.own);
                            own.for_each(|&v| self.tell(to, v, send));
                        }
                    }
                }
                if goes_on && depth < DEPTH {
                    let beside = self.triangulation.neighbors(t).map(|across| across >> 2);
                    next.extend(beside.iter().filter(|&&u| !std::mem::replace(&mut is_seen[u as usize], true)));
                }
            }
            level = next;
        }
    }

    /// Sends to the owner of each vertex what its neighbours are here.
    ///
    /// If no tile has anything left to send, simplices at the tiles' own vertices are final: *a* a tile's own vertex of
    /// a simplex T, *v* one of another tile. That one knows all of T, and if T were not one of its simplices, there
    /// would be a vertex in T's sphere among the neighbours that it has for *a*; these it has sent. So all stars agree,
    /// and then they are Delaunay (Shewchuk 2005; Brédif et al. 2020).
    pub(super) fn exchange<const N: usize>(&self, send: &mut impl FnMut(u32, u32))
    where
        Dimension<D>: Tiled<D, N, Triangulation = T>,
    {
        let infinite = self.vertices.infinite();
        parallel::in_pieces(self.simplices.len(), CHUNK, &mut |piece| {
            for &t in &self.simplices[piece] {
                let Some(simplex) = Dimension::<D>::simplex(self.triangulation, t) else { continue };
                let owners = simplex.map(|v| self.vertices.owner(v));
                for (k, &to) in owners.iter().enumerate() {
                    if to != self.vertices.number && !owners[..k].contains(&to) {
                        simplex.iter().filter(|&&v| v != infinite).for_each(|&v| self.tell(to, v, send));
                    }
                }
            }
        });
    }

    /// Sends a vertex to a tile that does not know it from the start.
    fn tell(&self, to: u32, v: u32, send: &mut impl FnMut(u32, u32)) {
        let Vertices { own, common, .. } = self.vertices;
        let is_common = (own..own + common).contains(&v);
        if !is_common && self.vertices.owner(v) != to {
            send(to, v);
        }
    }
}

/// Returns whether a ball and a box meet, up to rounding.
fn meets<const D: usize>(center: [f64; D], radius: f64, [low, high]: [[f64; D]; 2]) -> bool {
    let apart: [f64; D] = std::array::from_fn(|k| (low[k] - center[k]).max(center[k] - high[k]).max(0.0));
    vector::squared_norm(apart) <= radius * radius
}
