//! The least cut between simplices that votes place inside and outside, by preflows (Goldberg and
//! Tarjan, *A new approach to the maximum-flow problem*, 1988).
//!
//! Nodes are simplices, and arc *k* of a node is its facet *k*. Votes for the inside are supplies, votes
//! for the outside demands. Flow goes from the supplies through facets to the demands, and what cannot
//! is left over. At the end those nodes are outside that can still reach a demand: of all least cuts,
//! this has the smallest outside, and so it is the same whatever the order of the steps.

use super::super::complex::Complex;
use crate::{
    index::NONE,
    parallel::{self, Threads},
};
use std::collections::VecDeque;

/// A simplex with its arcs.
#[derive(Debug, Clone, Copy)]
struct Node<const N: usize> {
    /// The arc from the other side of each facet, as 4·(node) + (facet); [`NONE`] on the hull.
    mates: [u32; N],
    /// How much can still flow through each facet to the other side.
    residual: [u16; N],
    /// What has come here and not gone on, or the demand that is left, which is negative.
    excess: i32,
    /// At most the number of arcs to the nearest node with a demand; [`UNREACHED`] if there is no way.
    label: u32,
}

/// No demand can be reached.
const UNREACHED: u32 = u32::MAX;

/// So many nodes can be numbered, since an arc takes two bits more.
pub(super) const MAX_NODES: usize = 1 << 30;

/// Returns whether each simplex is inside. `costs` are those of facets as their simplices see them, and
/// `excess` the votes for the inside less those for the outside.
pub(super) fn inside<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    costs: &[[u16; N]],
    excess: &[i32],
) -> Vec<bool> {
    let mut network = Network::new(complex, costs, excess);
    network.run();
    network.nodes.iter().map(|node| node.label == UNREACHED).collect()
}

#[derive(Debug)]
struct Network<const N: usize> {
    nodes: Vec<Node<N>>,
    /// Nodes with an excess that can reach a demand.
    active: VecDeque<u32>,
}

impl<const N: usize> Network<N> {
    fn new<const D: usize>(complex: &Complex<'_, D, N>, costs: &[[u16; N]], excess: &[i32]) -> Self {
        let empty = Node { mates: [NONE; N], residual: [0; N], excess: 0, label: 0 };
        let mut nodes = parallel::filled(Threads::All, excess.len(), empty);
        parallel::for_chunks(Threads::All, &mut nodes, |start, chunk| {
            for (node, t) in chunk.iter_mut().zip(start..) {
                node.excess = excess[t];
                for k in 0..N {
                    let Some(across) = complex.across(t, k) else { continue };
                    // Only in a broken mesh a neighbour does not know its neighbour.
                    if let Some(&cost) = costs[across].get(complex.facet_towards(across, t)) {
                        node.mates[k] = 4 * across as u32 + complex.facet_towards(across, t) as u32;
                        node.residual[k] = costs[t][k].max(cost);
                    }
                }
            }
        });
        Network { nodes, active: VecDeque::new() }
    }

    /// Sends as much as possible from supplies to demands.
    fn run(&mut self) {
        self.label_all();
        let mut steps = 0;
        while let Some(t) = self.active.pop_front() {
            steps += self.discharge(t);
            // Labels fall behind the distances, and nodes that are cut off look for a way in vain.
            if steps > self.nodes.len() / 4 {
                steps = 0;
                self.label_all();
            }
        }
        self.label_all();
    }

    /// Sets all labels to the distances, and gathers the nodes that have an excess to send.
    fn label_all(&mut self) {
        let mut queue = VecDeque::new();
        for (t, node) in (0..).zip(&mut self.nodes) {
            node.label = UNREACHED;
            if node.excess < 0 {
                node.label = 0;
                queue.push_back(t);
            }
        }
        self.active.clear();
        while let Some(t) = queue.pop_front() {
            let Node { mates, label, excess, .. } = self.nodes[t as usize];
            if excess > 0 {
                self.active.push_back(t);
            }
            for mate in mates.into_iter().filter(|&mate| mate != NONE) {
                let from = &mut self.nodes[(mate / 4) as usize];
                if from.label == UNREACHED && from.residual[(mate % 4) as usize] > 0 {
                    from.label = label + 1;
                    queue.push_back(mate / 4);
                }
            }
        }
    }

    /// Sends the excess of a node on, raising its label as far as necessary. Returns the number of
    /// times that its arcs were looked at.
    fn discharge(&mut self, t: u32) -> usize {
        let mut steps = 0;
        while self.nodes[t as usize].excess > 0 && self.nodes[t as usize].label != UNREACHED {
            steps += 1;
            let Node { mates, mut residual, mut excess, label } = self.nodes[t as usize];
            let mut lowest = UNREACHED;
            for k in (0..N).filter(|&k| mates[k] != NONE) {
                if residual[k] == 0 {
                    continue;
                }
                let to = &mut self.nodes[(mates[k] / 4) as usize];
                if to.label.checked_add(1) == Some(label) && excess > 0 {
                    let sent = excess.min(i32::from(residual[k]));
                    let was_active = to.excess > 0;
                    to.excess += sent;
                    to.residual[(mates[k] % 4) as usize] += sent as u16;
                    if to.excess > 0 && !was_active {
                        self.active.push_back(mates[k] / 4);
                    }
                    excess -= sent;
                    residual[k] -= sent as u16;
                }
                if residual[k] > 0 {
                    lowest = lowest.min(self.nodes[(mates[k] / 4) as usize].label);
                }
            }
            let node = &mut self.nodes[t as usize];
            (node.residual, node.excess) = (residual, excess);
            if excess > 0 {
                node.label = lowest.saturating_add(1);
            }
        }
        steps
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
