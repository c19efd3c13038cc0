//! Which poles lie inside and which outside, by the constraints between them.
//!
//! The two poles of a vertex lie on opposite sides of the surface, the more surely the more nearly
//! they lie in opposite directions. Poles whose spheres intersect deeply lie on the same side. The
//! power crust (Amenta, Choi and Kolluri 2001) spreads labels by these rules with a priority queue, and
//! eigencrust (Kolluri, Shewchuk and O'Brien 2004) with an eigenvector. Here the constraints are taken
//! by falling strength, and those that contradict stronger ones are left out: a maximum spanning forest
//! of a signed graph, which has no parameter and one answer.
//!
//! Normals and sensors decide the sides of poles directly, and are constraints for those of other vertices.

use super::{
    super::complex::Complex,
    evidence::Hints,
    parity::ParitySets,
    poles::Poles,
    spheres::{BENEATH, OUTSIDE, Spheres},
};
use crate::{
    index::NONE,
    mesh::Csr,
    parallel::{self, Threads},
};

/// The number of vertices that is worth handing to another thread.
const GRAIN: usize = 1 << 12;

/// So many neighbours of a vertex are looked through for another one. What is left out is sorted out later.
const RECENT: usize = 16;

/// The strength of what is certain. Strengths are integers, and equal ones are taken in the order of
/// the vertices, so that the result does not depend on the last bits of the spheres.
const CERTAIN: f64 = 65535.0;

/// Constraints are taken in rounds of these strengths and more. After each round, those between poles
/// that are connected already need not be sorted.
const ROUNDS: [u16; 5] = [63_000, 57_000, 49_000, 33_000, 1];

/// A vertex of the hull has no pole outside, but a mean normal, which is less certain.
const NORMAL_SHARE: f64 = 0.98;

/// Votes of more vertices do not count.
const MAX_VOTES: i8 = 20;

/// Returns for each simplex how many vertices have it as a pole, positive if it lies inside and
/// negative if outside; 0 if it is no pole or nothing is known about it.
pub(super) fn votes<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    spheres: &Spheres<D>,
    stars: &Csr,
    poles: &[Poles],
    hints: &Hints<D>,
) -> Vec<i8> {
    let mut constraints = Constraints::new(complex, spheres, stars, poles);
    constraints.known = known(complex, spheres, poles, hints);
    // The outside has number 0, and so stands for its set.
    let mut sets = ParitySets::new(complex.simplices.len() + 1);
    let mut strongest = u16::MAX;
    for weakest in ROUNDS {
        let (strengths, found) = constraints.between(weakest, strongest, &sets);
        for i in parallel::order_of(Threads::All, strengths) {
            let Constraint { poles: [a, b], are_opposite } = found[i as usize];
            sets.unite(a, b, are_opposite);
        }
        sets.flatten();
        strongest = weakest.saturating_sub(1);
    }
    let mut votes = vec![0; complex.simplices.len()];
    let each = (0..).zip(poles).flat_map(|(v, poles)| [(v, poles.first), (v, poles.second)]);
    for (v, pole) in each.filter(|&(_, pole)| pole < BENEATH) {
        let known = hints.cosine(v, complex.point(v), pole, spheres).map(|cosine| cosine < 0.0);
        let found = || Some(sets.root(number(pole))).filter(|&(root, _)| root == 0).map(|(_, is_inside)| is_inside);
        let vote = match known.or_else(found) {
            Some(true) => 1,
            Some(false) => -1,
            None => 0,
        };
        let sum: &mut i8 = &mut votes[pole as usize];
        *sum = (*sum + vote).clamp(-MAX_VOTES, MAX_VOTES);
    }
    votes
}

/// Returns the number of a pole in the sets.
fn number(pole: u32) -> u32 {
    if pole >= BENEATH { 0 } else { pole + 1 }
}

/// Returns the constraints between the outside and the poles whose sides the evidence knows, with their
/// strengths.
fn known<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    spheres: &Spheres<D>,
    poles: &[Poles],
    hints: &Hints<D>,
) -> Vec<(u16, Constraint)> {
    let each = (0..).zip(poles).flat_map(|(v, poles)| [(v, poles.first), (v, poles.second)]);
    let known = each.filter_map(|(v, pole)| {
        let cosine = hints.cosine(v, complex.point(v), pole, spheres)?;
        let constraint = Constraint { poles: [0, number(pole)], are_opposite: cosine < 0.0 };
        Some((strength(2.0 * cosine.abs()), constraint))
    });
    known.collect()
}

/// Two poles, by their numbers, on the same side or on opposite ones.
#[derive(Debug, Clone, Copy)]
struct Constraint {
    poles: [u32; 2],
    are_opposite: bool,
}

/// The constraints with their strengths, 0 where there is none.
#[derive(Debug)]
struct Constraints<'a> {
    poles: &'a [Poles],
    /// Between the two poles of each vertex.
    opposite: Vec<u16>,
    same: Vec<Edges>,
    /// Those by evidence.
    known: Vec<(u16, Constraint)>,
}

/// Edges of the mesh, with the strengths of the constraints between the first poles of both ends, the
/// first and the second, the second and the first, and both second poles.
#[derive(Debug, Default)]
struct Edges {
    ends: Vec<[u32; 2]>,
    strengths: Vec<[u16; 4]>,
}

impl<'a> Constraints<'a> {
    fn new<const D: usize, const N: usize>(
        complex: &Complex<'_, D, N>,
        spheres: &Spheres<D>,
        stars: &Csr,
        poles: &'a [Poles],
    ) -> Self {
        let opposite = |poles: &Poles| match (poles.first, poles.second) {
            (NONE, _) | (_, NONE) => 0,
            (OUTSIDE | BENEATH, _) => strength(NORMAL_SHARE * (1.0 - poles.cosine)),
            _ => strength(1.0 - poles.cosine),
        };
        let same = |i: u32, j: u32| {
            // Missing ones, too, have higher numbers than the simplices.
            if i == j || i.max(j) >= BENEATH { 0 } else { strength(1.0 + spheres.intersection(i, j)) }
        };
        let edges = parallel::map_grains(Threads::All, poles.len(), GRAIN, |range| {
            let mut edges = Edges::default();
            let mut higher = Vec::new();
            for v in range.start as u32..range.end as u32 {
                higher.clear();
                for &w in stars.of(v).iter().flat_map(|&t| &complex.simplices[t as usize]) {
                    // Most come several times, and are few.
                    if w > v && !higher[higher.len().saturating_sub(RECENT)..].contains(&w) {
                        higher.push(w);
                    }
                }
                higher.sort_unstable();
                higher.dedup();
                for &w in &higher {
                    let (p, q) = (poles[v as usize], poles[w as usize]);
                    edges.ends.push([v, w]);
                    edges.strengths.push(pairs(p, q).map(|[i, j]| same(i, j)));
                }
            }
            edges
        });
        Constraints { poles, opposite: poles.iter().map(opposite).collect(), same: edges, known: Vec::new() }
    }

    /// Returns the constraints with strengths from `low` to `high` between poles of different sets,
    /// and by how much the strength of each is less than that of a certain one.
    fn between(&mut self, low: u16, high: u16, sets: &ParitySets) -> (Vec<u32>, Vec<Constraint>) {
        let mut found = (Vec::new(), Vec::new());
        let take = |found: &mut (Vec<u32>, Vec<Constraint>), strength: u16, pair: [u32; 2], are_opposite: bool| {
            if (low..=high).contains(&strength) {
                let poles = pair.map(number);
                if sets.root(poles[0]).0 != sets.root(poles[1]).0 {
                    found.0.push(u32::from(u16::MAX - strength));
                    found.1.push(Constraint { poles, are_opposite });
                }
            }
        };
        for (poles, &strength) in self.poles.iter().zip(&self.opposite) {
            // What is beneath is not outside.
            take(&mut found, strength, [poles.first, poles.second], poles.first != BENEATH);
        }
        for &(strength, constraint) in &self.known {
            if (low..=high).contains(&strength) {
                found.0.push(u32::from(u16::MAX - strength));
                found.1.push(constraint);
            }
        }
        let parts = parallel::map_mut(Threads::All, &mut self.same, |_, edges| {
            let mut found = (Vec::new(), Vec::new());
            for (&ends, strengths) in edges.ends.iter().zip(&edges.strengths) {
                let [p, q] = ends.map(|v| self.poles[v as usize]);
                for (pair, &strength) in pairs(p, q).into_iter().zip(strengths) {
                    take(&mut found, strength, pair, false);
                }
            }
            found
        });
        for (strengths, constraints) in parts {
            found.0.extend(strengths);
            found.1.extend(constraints);
        }
        found
    }
}

/// Returns the pairs of a pole of one vertex and a pole of another.
fn pairs(p: Poles, q: Poles) -> [[u32; 2]; 4] {
    [[p.first, q.first], [p.first, q.second], [p.second, q.first], [p.second, q.second]]
}

/// Returns the strength of a constraint that is between 0 and 2.
fn strength(twice: f64) -> u16 {
    // A conversion to an integer saturates, and NaN becomes 0.
    libm::rint(0.5 * CERTAIN * twice) as u16
}
