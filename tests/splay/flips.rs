//! A triangulation that can be spoilt: splits and flips of tetrahedra found by their facets.

use gdel::NONE;
use gdel::internals::{
    d3::{mesh::FACETS, splay::NearDelaunay3, triangulation::Triangulation3},
    predicates::filter::PredicateContext3,
};
use std::collections::HashMap;

/// Tetrahedra without ghosts, positively oriented, and the tetrahedra at each facet.
pub struct Soup<'a> {
    vertices: &'a PredicateContext3<'a>,
    pub tetrahedra: Vec<[u32; 4]>,
    facets: HashMap<[u32; 3], Vec<usize>>,
}

fn facet(t: [u32; 4], k: usize) -> [u32; 3] {
    let mut facet = FACETS[k].map(|i| t[i]);
    facet.sort_unstable();
    facet
}

impl<'a> Soup<'a> {
    pub fn new(vertices: &'a PredicateContext3<'a>, tetrahedra: &[[u32; 4]]) -> Self {
        let mut soup = Soup { vertices, tetrahedra: Vec::new(), facets: HashMap::new() };
        tetrahedra.iter().for_each(|&t| soup.add(t));
        soup
    }

    fn orient(&self, [a, b, c, d]: [u32; 4]) -> i8 {
        self.vertices.orient3d(a, b, c, d)
    }

    fn add(&mut self, t: [u32; 4]) {
        let slot = self.tetrahedra.len();
        self.tetrahedra.push(t);
        (0..4).for_each(|k| self.facets.entry(facet(t, k)).or_default().push(slot));
    }

    fn remove(&mut self, slot: usize) {
        let t = self.tetrahedra[slot];
        (0..4).for_each(|k| self.facets.get_mut(&facet(t, k)).unwrap().retain(|&s| s != slot));
        let last = self.tetrahedra.len() - 1;
        if slot != last {
            let moved = self.tetrahedra[last];
            for k in 0..4 {
                self.facets
                    .get_mut(&facet(moved, k))
                    .unwrap()
                    .iter_mut()
                    .filter(|s| **s == last)
                    .for_each(|s| *s = slot);
            }
        }
        self.tetrahedra.swap_remove(slot);
    }

    fn replace(&mut self, mut old: Vec<usize>, new: &[[u32; 4]]) {
        old.sort_unstable();
        old.into_iter().rev().for_each(|slot| self.remove(slot));
        new.iter().for_each(|&t| self.add(t));
    }

    /// Returns the tetrahedron across facet `k`, and its vertex opposite the facet.
    fn across(&self, slot: usize, k: usize) -> Option<(usize, u32)> {
        let t = self.tetrahedra[slot];
        let other = *self.facets[&facet(t, k)].iter().find(|&&s| s != slot)?;
        let apex = self.tetrahedra[other].into_iter().find(|v| !t.contains(v) || *v == t[k])?;
        Some((other, apex))
    }

    /// Returns whether the facet is on the hull or locally Delaunay.
    pub fn is_delaunay(&self, slot: usize, k: usize) -> bool {
        self.across(slot, k).is_none_or(|(_, apex)| self.vertices.insphere(self.tetrahedra[slot], apex) < 0)
    }

    /// Flips facet `k`, 2-3 or else 3-2, if no tetrahedron becomes flat or inverted. Returns
    /// whether it did.
    pub fn flip(&mut self, slot: usize, k: usize) -> bool {
        let Some((other, apex)) = self.across(slot, k) else { return false };
        let t = self.tetrahedra[slot];
        let [a, b, c] = FACETS[k].map(|i| t[i]);
        let three = [[a, b, t[k], apex], [b, c, t[k], apex], [c, a, t[k], apex]];
        if three.iter().all(|&t| self.orient(t) > 0) {
            self.replace(vec![slot, other], &three);
            return true;
        }
        // A third tetrahedron with both apices and an edge of the facet.
        for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
            let mut key = [a, b, t[k]];
            key.sort_unstable();
            let Some(&third) = self.facets[&key].iter().find(|&&s| s != slot) else { continue };
            if !self.tetrahedra[third].contains(&apex) {
                continue;
            }
            let two = [[c, a, t[k], apex], [b, c, t[k], apex]];
            if two.iter().all(|&t| self.orient(t) > 0) {
                self.replace(vec![slot, other, third], &two);
                return true;
            }
        }
        false
    }

    /// Splits the tetrahedron that contains vertex `p` in its interior, if there is one. Returns
    /// whether it did.
    pub fn split(&mut self, p: u32) -> bool {
        let parts = |t: [u32; 4]| (0..4).map(move |k| std::array::from_fn(|i| if i == k { p } else { t[i] }));
        let holds = |t: &[u32; 4]| parts(*t).all(|part: [u32; 4]| self.orient(part) > 0);
        let Some(slot) = self.tetrahedra.iter().position(holds) else { return false };
        let parts: Vec<_> = parts(self.tetrahedra[slot]).collect();
        self.replace(vec![slot], &parts);
        true
    }

    /// Flips facets that are not locally Delaunay until none can be flipped.
    pub fn lawson(&mut self) {
        while (0..self.tetrahedra.len() * 4).any(|f| {
            let (slot, k) = (f / 4, f % 4);
            slot < self.tetrahedra.len() && !self.is_delaunay(slot, k) && self.flip(slot, k)
        }) {
            // Continues where a flip was possible, as long as one is.
            let mut f = 0;
            while f < self.tetrahedra.len() * 4 {
                if self.is_delaunay(f / 4, f % 4) || !self.flip(f / 4, f % 4) {
                    f += 1;
                }
            }
        }
    }

    /// Returns the triangulation with ghosts; all tetrahedra are uncertain.
    pub fn finish(&self) -> NearDelaunay3 {
        near(self.vertices.len() as u32, &self.tetrahedra)
    }
}

/// Returns a triangulation of the hull of the vertices below `infinite`, with ghosts. All
/// tetrahedra are uncertain, and nothing is known to have failed.
pub fn near(infinite: u32, tetrahedra: &[[u32; 4]]) -> NearDelaunay3 {
    let mut all = tetrahedra.to_vec();
    let mut neighbors = vec![[NONE; 4]; all.len()];
    let mut open = HashMap::new();
    let match_facets = |all: &[[u32; 4]], neighbors: &mut [[u32; 4]], open: &mut HashMap<_, u32>, from: usize| {
        for slot in from..all.len() {
            for k in 0..4 {
                let name = (4 * slot + k) as u32;
                match open.remove(&facet(all[slot], k)) {
                    Some(other) => {
                        neighbors[slot][k] = other;
                        neighbors[other as usize / 4][other as usize % 4] = name;
                    }
                    None => {
                        open.insert(facet(all[slot], k), name);
                    }
                }
            }
        }
    };
    match_facets(&all, &mut neighbors, &mut open, 0);
    let mut hull: Vec<u32> = open.values().copied().collect();
    hull.sort_unstable();
    for f in hull {
        let [a, b, c] = FACETS[f as usize % 4].map(|i| tetrahedra[f as usize / 4][i]);
        all.push([a, b, c, infinite]);
        neighbors.push([NONE; 4]);
    }
    match_facets(&all, &mut neighbors, &mut open, tetrahedra.len());
    assert!(open.is_empty(), "the boundary is not closed");
    let mut vertex_simplex = vec![NONE; infinite as usize + 1];
    for (slot, t) in all.iter().enumerate() {
        t.iter().for_each(|&v| vertex_simplex[v as usize] = slot as u32);
    }
    let missing = (0..infinite).filter(|&v| vertex_simplex[v as usize] == NONE).collect();
    let uncertain = (0..all.len() as u32).collect();
    NearDelaunay3 {
        triangulation: Triangulation3::new(all, neighbors, infinite),
        vertex_simplex,
        failed: Vec::new(),
        uncertain,
        missing,
    }
}

/// Returns the finite tetrahedra that are flat or inverted.
pub fn flat_or_inverted(mesh: &Triangulation3, vertices: &PredicateContext3<'_>) -> Vec<u32> {
    let finite = |t: &[u32; 4]| t[3] != vertices.len() as u32;
    let bad = |&[a, b, c, d]: &[u32; 4]| vertices.orient3d(a, b, c, d) <= 0;
    (0..).zip(mesh.tetrahedra()).filter(|(_, t)| finite(t) && bad(t)).map(|(slot, _)| slot).collect()
}

/// Returns what a GPU would report about `near`: the vertices that have a facet that is not locally
/// Delaunay, and the tetrahedra that are flat or inverted. The others are certain.
pub fn found_out(vertices: &PredicateContext3<'_>, near: &NearDelaunay3) -> NearDelaunay3 {
    let (tetrahedra, neighbors) = (near.triangulation.tetrahedra(), near.triangulation.neighbors());
    let infinite = vertices.len() as u32;
    let mut bad = vec![false; tetrahedra.len()];
    flat_or_inverted(&near.triangulation, vertices).iter().for_each(|&t| bad[t as usize] = true);
    let mut uncertain = Vec::new();
    let mut failed = Vec::new();
    for (slot, &t) in tetrahedra.iter().enumerate() {
        let across = neighbors[slot];
        if bad[slot] || (t[3] == infinite && bad[across[3] as usize / 4]) {
            uncertain.push(slot as u32);
            continue;
        }
        for k in 0..4 {
            let apex = tetrahedra[across[k] as usize / 4][across[k] as usize % 4];
            let conflict = match (t[3] == infinite, apex == infinite) {
                (_, true) => -1,
                (false, false) => vertices.insphere(t, apex),
                // Beyond its own facet is the inside.
                (true, false) if k == 3 => -1,
                (true, false) => match vertices.orient3d(t[0], t[1], t[2], apex) {
                    0 => vertices.insphere(tetrahedra[across[3] as usize / 4], apex),
                    side => side,
                },
            };
            if conflict > 0 {
                failed.extend(FACETS[k].map(|i| t[i]).iter().filter(|&&v| v != infinite));
            }
        }
    }
    NearDelaunay3 { uncertain, failed, ..near.clone() }
}
