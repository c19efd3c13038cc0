//! The least cut between simplices that votes place inside and outside, by augmenting paths (Boykov and
//! Kolmogorov, *An experimental comparison of min-cut/max-flow algorithms for energy minimization in
//! vision*, 2004).
//!
//! Nodes are simplices, and arc *k* of a node is its facet *k*. Votes for the inside are supplies, votes
//! for the outside demands. Trees grow from both through arcs that are not full. Where they meet, flow
//! goes from a supply to a demand, and what is cut off looks for another parent. At the end those nodes
//! are outside that can still reach a demand: of all least cuts, this has the smallest outside, and so it
//! is the same whatever the order of the steps.
//!
//! So nodes that are near in memory, and in space, find their paths first, each block by itself and in
//! any thread. The trees stay, and where blocks meet they grow on, in larger and larger blocks.

use super::super::complex::Complex;
use crate::{
    index::NONE,
    parallel::{self, Threads},
};
use std::collections::VecDeque;

/// So many nodes can be numbered, since an arc takes two bits more.
pub(super) const MAX_NODES: usize = 1 << 30;

/// The number of nodes of the first blocks: they fit into a processor's own cache. The tests' meshes have several.
const BLOCK: usize = if cfg!(test) { 4 } else { 1 << 14 };

/// How many blocks make a larger one.
const BLOCKS: usize = if cfg!(test) { 2 } else { 8 };

/// A simplex with its arcs, and its place in a tree.
#[derive(Debug, Clone, Copy)]
struct Node<const N: usize> {
    /// The arc from the other side of each facet, as 4·(node) + (facet); [`NONE`] on the hull.
    mates: [u32; N],
    /// How much can still flow through each facet to the other side.
    residual: [u16; N],
    /// The supply that is left, or the demand, which is negative.
    excess: i32,
    tree: Tree,
    parent: Parent,
    is_active: bool,
    /// The number of nodes on the way to the root, as it was known at the time of the stamp.
    depth: u32,
    stamp: u32,
}

/// The tree that a node belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Tree {
    None,
    /// A supply can reach the node.
    Supply,
    /// The node can reach a demand.
    Demand,
}

/// What connects a node to its tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Parent {
    /// The node is in no tree, or has lost its parent.
    None,
    /// The node is a supply or a demand.
    Root,
    /// The arc of the node that leads to its parent.
    Arc(u8),
}

/// Returns whether each simplex is inside. `costs` are those of facets as their simplices see them, and
/// `excess` the votes for the inside less those for the outside.
pub(super) fn inside<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    costs: &[[u16; N]],
    excess: &[i32],
) -> Vec<bool> {
    let mut nodes = nodes(complex, costs, excess);
    let (mut stamp, mut done, mut size) = (0, 1, BLOCK);
    loop {
        // Trees cannot grow further but across the borders of the last blocks.
        let is_border = |i: usize, mate: u32| mate != NONE && mate as usize / 4 / done != i / done;
        let active = parallel::map_grains(Threads::All, nodes.len(), BLOCK, |range| {
            let trees = range.filter(|&i| nodes[i].tree != Tree::None);
            let active = trees.filter(|&i| nodes[i].mates.iter().any(|&mate| is_border(i, mate)));
            active.map(|i| i as u32).collect::<Vec<u32>>()
        });
        let blocks = nodes.chunks_mut(size).zip(active.chunks(size / BLOCK));
        let mut blocks: Vec<(&mut [Node<N>], &[Vec<u32>])> = blocks.collect();
        let stamps = parallel::map_mut(Threads::All, &mut blocks, |i, (block, active)| {
            let mut forest = Forest::new(block, i * size, stamp);
            active.iter().flatten().for_each(|&node| forest.activate(node - (i * size) as u32));
            forest.run();
            forest.stamp
        });
        stamp = stamps.into_iter().max().unwrap_or(0);
        if size >= nodes.len() {
            break;
        }
        (done, size) = (size, size.saturating_mul(BLOCKS));
    }
    parallel::joined(parallel::map_ranges(Threads::All, nodes.len(), |range| {
        nodes[range].iter().map(|node| node.tree != Tree::Demand).collect()
    }))
}

/// Returns the nodes, of which supplies and demands are roots.
fn nodes<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    costs: &[[u16; N]],
    excess: &[i32],
) -> Vec<Node<N>> {
    let (mates, residual) = ([NONE; N], [0; N]);
    let (tree, parent) = (Tree::None, Parent::None);
    let empty = Node { mates, residual, excess: 0, tree, parent, is_active: false, depth: 0, stamp: 0 };
    let mut nodes = parallel::filled(Threads::All, excess.len(), empty);
    parallel::for_chunks(Threads::All, &mut nodes, |start, chunk| {
        for (node, t) in chunk.iter_mut().zip(start..) {
            node.excess = excess[t];
            if excess[t] != 0 {
                node.tree = if excess[t] > 0 { Tree::Supply } else { Tree::Demand };
                (node.parent, node.depth) = (Parent::Root, 1);
            }
            for k in 0..N {
                let Some(across) = complex.across(t, k) else { continue };
                let facet = complex.facet_towards(across, t);
                // Only in a broken mesh a neighbour does not know its neighbour, or meets it twice.
                if complex.facet_towards(t, across) != k {
                    continue;
                }
                if let Some(&cost) = costs[across].get(facet) {
                    node.mates[k] = 4 * across as u32 + facet as u32;
                    node.residual[k] = costs[t][k].max(cost);
                }
            }
        }
    });
    nodes
}

/// Trees over a range of nodes. Arcs that leave it are not seen.
struct Forest<'a, const N: usize> {
    nodes: &'a mut [Node<N>],
    /// The number of the first node.
    first: usize,
    /// Nodes at which trees may grow.
    active: VecDeque<u32>,
    /// Nodes that have lost their parents.
    orphans: VecDeque<u32>,
    /// The number of paths so far.
    stamp: u32,
}

impl<'a, const N: usize> Forest<'a, N> {
    fn new(nodes: &'a mut [Node<N>], first: usize, stamp: u32) -> Self {
        Forest { nodes, first, active: VecDeque::new(), orphans: VecDeque::new(), stamp }
    }

    /// Lets trees grow at a node.
    fn activate(&mut self, i: u32) {
        if !std::mem::replace(&mut self.nodes[i as usize].is_active, true) {
            self.active.push_back(i);
        }
    }

    /// Sends as much as possible from supplies to demands.
    fn run(&mut self) {
        while let Some(i) = self.active.pop_front() {
            while self.node(i).tree != Tree::None {
                let Some((from, k)) = self.grow(i) else { break };
                self.stamp += 1;
                self.augment(from, k);
                while let Some(orphan) = self.orphans.pop_front() {
                    self.adopt(orphan);
                }
            }
            self.nodes[i as usize].is_active = false;
        }
    }

    fn node(&self, i: u32) -> &Node<N> {
        &self.nodes[i as usize]
    }

    /// Returns the node across facet `k` and the number of the facet there; `None` outside.
    fn across(&self, i: u32, k: usize) -> Option<(u32, usize)> {
        let mate = self.nodes[i as usize].mates[k];
        let other = (mate as usize / 4).wrapping_sub(self.first);
        (mate != NONE && other < self.nodes.len()).then_some((other as u32, mate as usize % 4))
    }

    /// Returns how much can flow through facet `k` of a node away from the root, in the direction of a
    /// tree: of supplies to the other side, of demands from there.
    fn outward(&self, tree: Tree, (i, k): (u32, usize), (j, l): (u32, usize)) -> u16 {
        if tree == Tree::Supply { self.nodes[i as usize].residual[k] } else { self.nodes[j as usize].residual[l] }
    }

    /// Makes the neighbours of a node part of its tree. Returns the arc from the tree of a supply to
    /// that of a demand if it finds one.
    // Engines of WebAssembly replace code by faster code only when it is called again: the loop of `run` is not.
    #[inline(never)]
    fn grow(&mut self, i: u32) -> Option<(u32, usize)> {
        let Node { tree, depth, stamp, .. } = *self.node(i);
        for k in 0..N {
            let Some((j, l)) = self.across(i, k) else { continue };
            if self.outward(tree, (i, k), (j, l)) == 0 {
                continue;
            }
            let other = &mut self.nodes[j as usize];
            if other.tree == Tree::None {
                (other.tree, other.parent) = (tree, Parent::Arc(l as u8));
                (other.depth, other.stamp) = (depth + 1, stamp);
                self.activate(j);
            } else if other.tree != tree {
                return Some(if tree == Tree::Supply { (i, k) } else { (j, l) });
            } else if other.stamp <= stamp && other.depth > depth + 1 {
                // A shorter way to a root.
                (other.parent, other.depth, other.stamp) = (Parent::Arc(l as u8), depth + 1, stamp);
            }
        }
        None
    }

    /// Calls `visit` with each arc in the direction of the flow on the path from a node to its root, and
    /// returns the root.
    fn path(&self, mut i: u32, mut visit: impl FnMut((u32, usize))) -> u32 {
        while let Parent::Arc(k) = self.node(i).parent {
            // The other node is in the range, as it is a parent.
            let Some((j, l)) = self.across(i, k.into()) else { break };
            visit(if self.node(i).tree == Tree::Supply { (j, l) } else { (i, k.into()) });
            i = j;
        }
        i
    }

    /// Sends flow through an arc from the tree of a supply to that of a demand, as much as the paths to
    /// both roots let through.
    #[inline(never)]
    fn augment(&mut self, from: u32, k: usize) {
        let Some((to, _)) = self.across(from, k) else { return };
        let mut amount = self.node(from).residual[k];
        let mut limit = |(i, k): (u32, usize)| amount = amount.min(self.node(i).residual[k]);
        let roots = [self.path(from, &mut limit), self.path(to, &mut limit)];
        let [supply, demand] = roots.map(|root| self.node(root).excess.unsigned_abs());
        let amount = u32::from(amount).min(supply).min(demand) as u16;
        self.send(from, k, amount);
        for end in [from, to] {
            self.send_along(end, amount);
        }
    }

    /// Sends flow along the path between a node and its root.
    fn send_along(&mut self, mut i: u32, amount: u16) {
        while let Parent::Arc(k) = self.node(i).parent {
            let k = usize::from(k);
            let Some((j, l)) = self.across(i, k) else { return };
            let (from, k) = if self.node(i).tree == Tree::Supply { (j, l) } else { (i, k) };
            if self.send(from, k, amount) == 0 {
                self.lose_parent(i);
            }
            i = j;
        }
        let root = &mut self.nodes[i as usize];
        root.excess -= root.excess.signum() * i32::from(amount);
        if root.excess == 0 {
            self.lose_parent(i);
        }
    }

    fn lose_parent(&mut self, i: u32) {
        self.nodes[i as usize].parent = Parent::None;
        self.orphans.push_back(i);
    }

    /// Sends flow through facet `k` of a node, and returns what can still flow there.
    fn send(&mut self, i: u32, k: usize, amount: u16) -> u16 {
        if let Some((j, l)) = self.across(i, k) {
            self.nodes[j as usize].residual[l] += amount;
        }
        let residual = &mut self.nodes[i as usize].residual[k];
        *residual -= amount;
        *residual
    }

    /// Finds another parent for a node of a tree, or else makes it part of none.
    #[inline(never)]
    fn adopt(&mut self, i: u32) {
        let tree = self.node(i).tree;
        let mut best = (u32::MAX, 0);
        for k in 0..N {
            let Some((j, l)) = self.across(i, k) else { continue };
            if self.node(j).tree == tree && self.outward(tree, (j, l), (i, k)) > 0 {
                best = best.min((self.depth(j).unwrap_or(u32::MAX), k));
            }
        }
        if best.0 < u32::MAX {
            let node = &mut self.nodes[i as usize];
            (node.parent, node.depth, node.stamp) = (Parent::Arc(best.1 as u8), best.0 + 1, self.stamp);
            return;
        }
        for k in 0..N {
            let Some((j, l)) = self.across(i, k).filter(|&(j, _)| self.node(j).tree == tree) else { continue };
            if self.outward(tree, (j, l), (i, k)) > 0 {
                self.activate(j);
            }
            if self.node(j).parent == Parent::Arc(l as u8) {
                self.lose_parent(j);
            }
        }
        self.nodes[i as usize].tree = Tree::None;
    }

    /// Returns the number of nodes from a node to its root; `None` if the path is broken. Notes it in
    /// all nodes on the way.
    fn depth(&mut self, start: u32) -> Option<u32> {
        let (mut i, mut steps) = (start, 0);
        let depth = loop {
            let node = self.node(i);
            if node.stamp == self.stamp && node.parent != Parent::None {
                break steps + node.depth;
            }
            steps += 1;
            match node.parent {
                Parent::None => return None,
                Parent::Root => break steps,
                Parent::Arc(k) => i = self.across(i, k.into())?.0,
            }
        };
        let (mut i, mut left) = (start, depth);
        while self.node(i).stamp != self.stamp {
            let node = &mut self.nodes[i as usize];
            (node.stamp, node.depth) = (self.stamp, left);
            left -= 1;
            match self.node(i).parent {
                Parent::Arc(k) => i = self.across(i, k.into())?.0,
                _ => break,
            }
        }
        Some(depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{input::points::Points, mesh::Mesh};

    /// Compares the cut of a small mesh with all others, for several costs and votes.
    fn check<const D: usize, const N: usize>(
        mesh: &impl Mesh<D, N>,
        points: Points<'_, D>,
        mut random: impl FnMut(u32) -> u32,
    ) {
        let complex = Complex::new(mesh, points).expect("a mesh of these points");
        let count = complex.simplices.len();
        assert!((2..16).contains(&count), "{count} simplices");
        for _ in 0..20 {
            let costs: Vec<[u16; N]> = (0..count).map(|_| std::array::from_fn(|_| random(4) as u16)).collect();
            let excess: Vec<i32> = (0..count).map(|_| random(9) as i32 - 4).collect();
            let is_inside = |mask: usize, t: usize| mask >> t & 1 == 1;
            let cost = |mask: usize| {
                let votes = (0..count).filter(|&t| is_inside(mask, t) != (excess[t] > 0)).map(|t| excess[t].abs());
                let facets = (0..count).flat_map(|t| (0..N).map(move |k| (t, k)));
                let between = facets.filter_map(|(t, k)| {
                    let across =
                        complex.across(t, k).filter(|&across| is_inside(mask, t) && !is_inside(mask, across))?;
                    Some(i32::from(costs[t][k].max(costs[across][complex.facet_towards(across, t)])))
                });
                votes.sum::<i32>() + between.sum::<i32>()
            };
            let least = (0..1 << count).map(cost).min();
            // The union of all that have the least cost is one of them.
            let expected = (0..1 << count).filter(|&mask| Some(cost(mask)) == least).fold(0, |all, mask| all | mask);
            let found = inside(&complex, &costs, &excess);
            assert!((0..count).all(|t| found[t] == is_inside(expected, t)), "{costs:?}, {excess:?}");
        }
    }

    #[test]
    fn the_cut_is_the_least_one_with_the_smallest_outside() {
        let mut state = 1u32;
        let mut random = move |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % below
        };
        for _ in 0..4 {
            let points: Vec<[f64; 2]> = (0..8).map(|_| [random(100), random(100)].map(f64::from)).collect();
            let mesh = crate::delaunay2d(&points).expect("points of a plane");
            check(&mesh, (&points).into(), &mut random);
            let points: Vec<[f64; 3]> =
                (0..7).map(|_| [random(100), random(100), random(100)].map(f64::from)).collect();
            let mesh = crate::delaunay3d(&points).expect("points of space");
            check(&mesh, (&points).into(), &mut random);
        }
    }
}
