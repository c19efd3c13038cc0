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
    spheres::{BENEATH, OUTSIDE, Sphere, Spheres},
};
use crate::{
    geometry::vector,
    index::NONE,
    mesh::Csr,
    parallel::{self, Pool, Threads},
};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// The number of vertices that is worth handing to another thread.
const GRAIN: usize = 1 << 12;

/// The strength of what is certain. Strengths are integers, and equal ones are taken in the order of
/// the vertices, so that the result does not depend on the last bits of the spheres.
const CERTAIN: f64 = 65535.0;

/// Constraints are taken in rounds of these strengths and more. After each round, those between poles
/// that are connected already are dropped, and need not be sorted: most of them.
const ROUNDS: [u16; 7] = [65_450, 65_200, 64_000, 59_000, 49_000, 33_000, 1];

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
    let numbered = Numbered::new(spheres, poles);
    let each = || {
        (0..)
            .zip(poles)
            .zip(&numbered.poles)
            .flat_map(|((v, poles), numbers)| [(v, poles.first, numbers[0]), (v, poles.second, numbers[1])])
    };
    let cosine = |v: u32, pole: u32| hints.cosine(v, complex.point(v), pole, spheres);
    let mut constraints = Constraints::new(complex, stars, poles, &numbered);
    constraints.at_vertices.extend(each().filter_map(|(v, pole, number)| {
        let cosine = cosine(v, pole)?;
        Some(Constraint { poles: [0, number], strength: strength(2.0 * cosine.abs()), are_opposite: cosine < 0.0 })
    }));
    // The outside has number 0, and so stands for its set.
    let mut sets = ParitySets::new(numbered.spheres.len());
    let mut strongest = u16::MAX;
    for weakest in ROUNDS {
        for Constraint { poles: [a, b], are_opposite, .. } in constraints.take(weakest, strongest, &sets) {
            sets.unite(a, b, are_opposite);
        }
        sets.flatten();
        strongest = weakest.saturating_sub(1);
    }
    let mut votes = vec![0; complex.simplices.len()];
    for (v, pole, number) in each().filter(|&(_, pole, _)| pole < BENEATH) {
        let known = cosine(v, pole).map(|cosine| cosine < 0.0);
        let found = || Some(sets.root(number)).filter(|&(root, _)| root == 0).map(|(_, is_inside)| is_inside);
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

/// The poles, numbered in the order of the simplices from 1 on. The outside has number 0.
struct Numbered<const D: usize> {
    /// The numbers of the poles of each vertex; [`NONE`] for those that are missing.
    poles: Vec<[u32; 2]>,
    /// The sphere of each number.
    spheres: Vec<Sphere<D>>,
}

impl<const D: usize> Numbered<D> {
    fn new(spheres: &Spheres<D>, poles: &[Poles]) -> Self {
        let is_pole: Vec<AtomicBool> = spheres.radii.iter().map(|_| AtomicBool::new(false)).collect();
        parallel::map_ranges(Threads::All, poles.len(), |range| {
            let both = poles[range].iter().flat_map(|poles| [poles.first, poles.second]);
            both.filter(|&pole| pole < BENEATH).for_each(|pole| is_pole[pole as usize].store(true, Relaxed));
        });
        let simplices = parallel::joined(parallel::map_ranges(Threads::All, is_pole.len(), |range| {
            range.filter(|&t| is_pole[t].load(Relaxed)).map(|t| t as u32).collect::<Vec<u32>>()
        }));
        let mut numbers = parallel::filled(Threads::All, is_pole.len(), NONE);
        (1..).zip(&simplices).for_each(|(number, &t)| numbers[t as usize] = number);
        let number = |pole: u32| match pole {
            NONE => NONE,
            OUTSIDE | BENEATH => 0,
            t => numbers[t as usize],
        };
        let outside = Sphere { center: [0.0; D], radius: 0.0 };
        let sphere = |t: u32| Sphere { center: spheres.centers[t as usize], radius: spheres.radii[t as usize] };
        let mut numbered = Numbered {
            poles: parallel::filled(Threads::All, poles.len(), [NONE; 2]),
            spheres: parallel::filled(Threads::All, simplices.len() + 1, outside),
        };
        parallel::for_chunks(Threads::All, &mut numbered.poles, |start, chunk| {
            for (numbers, poles) in chunk.iter_mut().zip(&poles[start..]) {
                *numbers = [number(poles.first), number(poles.second)];
            }
        });
        parallel::for_chunks(Threads::All, &mut numbered.spheres[1..], |start, chunk| {
            chunk.iter_mut().zip(&simplices[start..]).for_each(|(place, &t)| *place = sphere(t));
        });
        numbered
    }

    /// Returns the strength of the constraint that the poles of two vertices are on the same side; 0 if there is none.
    fn same(&self, [i, j]: [u32; 2], vertices: [[f64; D]; 2]) -> u16 {
        // The outside has no sphere, and a missing pole has none either.
        if i == j || i == 0 || j == 0 {
            return 0;
        }
        match [i, j].map(|i| self.spheres.get(i as usize)) {
            [Some(a), Some(b)] => strength(1.0 + a.intersection(b, vertices)),
            _ => 0,
        }
    }
}

/// Two poles, by their numbers, on the same side or on opposite ones.
#[derive(Debug, Clone, Copy)]
struct Constraint {
    poles: [u32; 2],
    strength: u16,
    are_opposite: bool,
}

/// An edge of the mesh, with the strengths of the constraints between the first poles of both ends, the
/// first and the second, the second and the first, and both second poles; 0 where there is none.
#[derive(Debug)]
struct Edge {
    ends: [u32; 2],
    strengths: [u16; 4],
}

/// The constraints that were not taken yet.
struct Constraints<'a> {
    /// The numbers of the poles of each vertex.
    poles: &'a [[u32; 2]],
    /// Between the two poles of a vertex; then those by evidence.
    at_vertices: Vec<Constraint>,
    at_edges: Vec<Vec<Edge>>,
}

impl<'a> Constraints<'a> {
    fn new<const D: usize, const N: usize>(
        complex: &Complex<'_, D, N>,
        stars: &Csr,
        poles: &[Poles],
        numbered: &'a Numbered<D>,
    ) -> Self {
        let opposite = |(poles, &numbers): (&Poles, &[u32; 2])| {
            let strength = match (poles.first, poles.second) {
                (NONE, _) | (_, NONE) => return None,
                (OUTSIDE | BENEATH, _) => strength(NORMAL_SHARE * (1.0 - poles.cosine)),
                _ => strength(1.0 - poles.cosine),
            };
            // What is beneath is not outside.
            Some(Constraint { poles: numbers, strength, are_opposite: poles.first != BENEATH })
        };
        let listed: Pool<Vec<u32>> = Pool::default();
        let at_edges = parallel::map_grains(Threads::All, poles.len(), GRAIN, |range| {
            // The last vertex whose list each vertex was put into.
            listed.with(|listed_by| {
                listed_by.resize(poles.len(), NONE);
                let (mut edges, mut higher) = (Vec::new(), Vec::new());
                for v in range.start as u32..range.end as u32 {
                    higher.clear();
                    for &w in stars.of(v).iter().flat_map(|&t| &complex.simplices[t as usize]) {
                        if w > v && listed_by[w as usize] != v {
                            listed_by[w as usize] = v;
                            higher.push(w);
                        }
                    }
                    higher.sort_unstable();
                    let p = numbered.poles[v as usize];
                    edges.extend(higher.iter().map(|&w| {
                        let vertices = [v, w].map(|v| complex.point(v));
                        let strengths = pairs(p, numbered.poles[w as usize]).map(|pair| numbered.same(pair, vertices));
                        Edge { ends: [v, w], strengths }
                    }));
                }
                edges
            })
        });
        let at_vertices = poles.iter().zip(&numbered.poles).filter_map(opposite).collect();
        Constraints { poles: &numbered.poles, at_vertices, at_edges }
    }

    /// Returns the constraints with strengths from `low` to `high` between poles of different sets, by
    /// falling strength. Keeps only the weaker ones.
    fn take(&mut self, low: u16, high: u16, sets: &ParitySets) -> Vec<Constraint> {
        let is_open =
            |[a, b]: [u32; 2], strength: u16| (1..=high).contains(&strength) && sets.root(a).0 != sets.root(b).0;
        let mut taken = Vec::new();
        self.at_vertices.retain(|constraint| {
            let is_open = is_open(constraint.poles, constraint.strength);
            if is_open && constraint.strength >= low {
                taken.push(*constraint);
            }
            is_open && constraint.strength < low
        });
        let mut parts = vec![taken];
        parts.extend(parallel::map_mut(Threads::All, &mut self.at_edges, |_, edges| {
            let mut taken = Vec::new();
            edges.retain(|edge| {
                let [p, q] = edge.ends.map(|v| self.poles[v as usize]);
                let mut is_kept = false;
                for (poles, &strength) in pairs(p, q).into_iter().zip(&edge.strengths) {
                    if is_open(poles, strength) {
                        is_kept |= strength < low;
                        if strength >= low {
                            taken.push(Constraint { poles, strength, are_opposite: false });
                        }
                    }
                }
                is_kept
            });
            taken
        }));
        let mut taken = parallel::joined(parts);
        let keys = taken.iter().map(|constraint| u32::from(high - constraint.strength)).collect();
        parallel::sort_by_keys(Threads::All, &mut taken, keys);
        taken
    }
}

/// Returns the pairs of a pole of one vertex and a pole of another.
fn pairs(p: [u32; 2], q: [u32; 2]) -> [[u32; 2]; 4] {
    [[p[0], q[0]], [p[0], q[1]], [p[1], q[0]], [p[1], q[1]]]
}

/// Returns the strength of a constraint that is between 0 and 2.
fn strength(twice: f64) -> u16 {
    // A conversion to an integer saturates, and NaN becomes 0.
    vector::rounded(0.5 * CERTAIN * twice) as u16
}
