//! The boundary of a solid as a closed surface.
//!
//! Each facet meets another one at each of its ridges (edges, or vertices in 2D): that which is reached
//! by turning around the ridge through the inside. So every ridge has two facets even where several
//! sheets touch, and a vertex is split into as many as there are cycles of facets around it. Where two
//! edges still have the same vertices, one of them gets a new vertex in its middle.

use super::{
    super::{
        complex::Complex,
        groups::Groups,
        sets::DisjointSets,
        sorted::{even_order, inverse},
    },
    beyond::INFINITY,
};
use crate::{
    geometry::{Euclidean, Geometry, facet, factorial, vector},
    index::NONE,
    parallel::{self, Threads},
};

/// The facets between a solid and its outside.
#[derive(Debug, Default)]
pub(super) struct Boundary<const D: usize> {
    /// The points that the vertices come from, ascending.
    pub(super) sources: Vec<u32>,
    /// The vertices that follow them: the middles of edges between these.
    pub(super) middles: Vec<[u32; 2]>,
    /// The facets by their vertices, ascending, as seen from outside: counter-clockwise in 3D, with
    /// the inside on the left in 2D.
    pub(super) facets: Vec<[u32; D]>,
    /// The facet across the ridge opposite each corner, as `D`·(facet) + (its corner opposite the
    /// ridge).
    pub(super) mates: Vec<[u32; D]>,
}

/// A facet of a simplex of the solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    simplex: u32,
    facet: u8,
}

impl<const D: usize> Boundary<D> {
    /// Gathers the boundary of a solid. `points` has the name of each vertex of the complex.
    pub(super) fn new<const N: usize>(complex: &Complex<'_, D, N>, points: &[u32], is_inside: &[bool]) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        let sides = sides(complex, points, is_inside);
        // The numbers of the facets, by the simplices that have any, and where each simplex is among
        // these.
        let mut numbers: Vec<[u32; N]> = Vec::new();
        let mut places = vec![NONE; is_inside.len()];
        for (number, &(_, Side { simplex, facet })) in (0..).zip(&sides) {
            let place = &mut places[simplex as usize];
            if *place == NONE {
                *place = numbers.len() as u32;
                numbers.push([NONE; N]);
            }
            numbers[*place as usize][usize::from(facet)] = number;
        }
        let number = |side: Side| {
            let numbers = numbers.get(places[side.simplex as usize] as usize);
            numbers.map_or(NONE, |numbers| numbers[usize::from(side.facet)])
        };
        let mut mates = vec![[NONE; D]; sides.len()];
        parallel::for_chunks(Threads::All, &mut mates, |start, chunk| {
            let mates = chunk.as_flattened_mut();
            for h in 0..mates.len() {
                if mates[h] != NONE {
                    continue;
                }
                let (vertices, side) = sides[start + h / D];
                let (next, from) = turn(complex, points, is_inside, side, vertices[h % D]);
                // Only in a broken mesh there is no next facet.
                let Some((vertices, _)) = sides.get(number(next) as usize) else { continue };
                let corner = vertices.iter().position(|&w| w == from).unwrap_or(0);
                let mate = number(next) as usize * D + corner;
                mates[h] = mate as u32;
                // The way back is the same. Other chunks find it themselves.
                if let Some(back @ &mut NONE) = mate.checked_sub(start * D).and_then(|mate| mates.get_mut(mate)) {
                    *back = (start * D + h) as u32;
                }
            }
        });
        let mut boundary = Boundary {
            sources: Vec::new(),
            middles: Vec::new(),
            facets: sides.into_iter().map(|(vertices, _)| vertices).collect(),
            mates,
        };
        boundary.split_vertices();
        while boundary.split_edges() {}
        boundary
    }

    /// Splits edges that have the same vertices as others, in 3D. Returns whether there were any; there
    /// may be more in the facets that were changed.
    fn split_edges(&mut self) -> bool {
        if D != 3 {
            return false;
        }
        let corners = self.facets.as_flattened();
        // Each edge in one of its two directions, with the corner opposite it.
        let edges = parallel::map_ranges(Threads::All, corners.len(), |range| {
            let edge = |h: u32| {
                let [from, to] = [next(h, D), next(next(h, D), D)].map(|end| corners[end as usize]);
                (from < to).then_some(([from, to], h))
            };
            range.filter_map(|h| edge(h as u32)).collect()
        });
        let mut edges: Vec<([u32; 2], u32)> = parallel::joined(edges);
        parallel::sort(Threads::All, &mut edges);
        let pairs = edges.windows(2).filter(|pair| pair[0].0 == pair[1].0);
        let doubled: Vec<u32> = pairs.map(|pair| pair[1].1).collect();
        let mut is_changed = vec![false; if doubled.is_empty() { 0 } else { self.facets.len() }];
        for &h in &doubled {
            let facets = [h, self.mates.as_flattened()[h as usize]].map(|h| h as usize / D);
            if facets.iter().all(|&f| f < is_changed.len() && !is_changed[f]) {
                facets.iter().for_each(|&f| is_changed[f] = true);
                self.split_edge(h);
            }
        }
        // Only in a broken mesh an edge has no mate.
        is_changed.contains(&true)
    }

    /// Splits the edge opposite a corner in its middle, with the facets on both sides.
    fn split_edge(&mut self, h: u32) {
        let opposite = self.mates.as_flattened()[h as usize];
        let middle = (self.sources.len() + self.middles.len()) as u32;
        let first = self.facets.len() as u32 * D as u32;
        let ends = [h, opposite].map(|h| next(h, D));
        self.middles.push(ends.map(|end| self.facets.as_flattened()[end as usize]));
        // A facet (c, p, q) becomes (c, p, m), and (c, m, q) is new.
        for (h, new) in [(h, first), (opposite, first + D as u32)] {
            let (after, last) = (next(h, D), next(next(h, D), D));
            let corners = self.facets.as_flattened_mut();
            let mut facet = [0; D];
            (facet[0], facet[1], facet[D - 1]) = (corners[h as usize], middle, corners[last as usize]);
            corners[last as usize] = middle;
            self.facets.push(facet);
            self.mates.push([NONE; D]);
            let outer = self.mates.as_flattened()[after as usize];
            self.link(new + 1, outer);
            self.link(after, new + 2);
        }
        self.link(h, first + D as u32);
        self.link(opposite, first);
    }

    /// Makes two facets meet, each at the edge opposite a corner.
    fn link(&mut self, h: u32, opposite: u32) {
        let mates = self.mates.as_flattened_mut();
        mates[h as usize] = opposite;
        if let Some(mate) = mates.get_mut(opposite as usize) {
            *mate = h;
        }
    }

    /// Returns the number of surfaces that hang together.
    pub(super) fn components(&self) -> usize {
        let mut sets = DisjointSets::of_lower(Threads::All, self.facets.len(), |f| {
            let mates = self.mates[f as usize].into_iter().filter(|&mate| mate != NONE);
            mates.map(|mate| mate / D as u32).filter(move |&mate| mate < f)
        });
        (0..self.facets.len() as u32).filter(|&f| sets.find(f) == f).count()
    }

    /// Numbers the vertices, one for each cycle of facets around a point.
    pub(super) fn split_vertices(&mut self) {
        let corners = self.facets.as_flattened();
        // The cycle of each corner; and the first corner of each cycle.
        let (mut cycles, mut firsts) = (vec![NONE; corners.len()], Vec::new());
        let mut found = Vec::new();
        for first in 0..corners.len() {
            if cycles[first] != NONE {
                continue;
            }
            let cycle = firsts.len() as u32;
            firsts.push(corners[first]);
            cycles[first] = cycle;
            found.push(first);
            while let Some(corner) = found.pop() {
                let ridges = (0..D).filter(|&i| i != corner % D).map(|i| self.mates[corner / D][i]);
                for (across, opposite) in ridges.filter(|&mate| mate != NONE).map(|h| (h as usize / D, h as usize % D))
                {
                    let is_same = |&l: &usize| l != opposite && corners[D * across + l] == corners[corner];
                    let Some(next) = (0..D).find(is_same).map(|l| D * across + l) else { continue };
                    if cycles[next] == NONE {
                        cycles[next] = cycle;
                        found.push(next);
                    }
                }
            }
        }
        let order = parallel::order_of(Threads::All, firsts.clone());
        let names = inverse(&order);
        for (corner, &cycle) in self.facets.as_flattened_mut().iter_mut().zip(&cycles) {
            *corner = names[cycle as usize];
        }
        self.sources = order.into_iter().map(|cycle| firsts[cycle as usize]).collect();
    }
}

/// Returns the sum of the facets' measures, times `scale` for each of their dimensions.
pub(super) fn area<const D: usize, const N: usize>(facets: &[[u32; D]], vertices: &[[f64; D]], scale: f64) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let area_of = |facet: &[u32; D]| {
        vector::norm(Euclidean::facet_normal(&facet.map(|v| vector::times(scale, vertices[v as usize]))))
    };
    let areas = parallel::map_ranges(Threads::All, facets.len(), |range| {
        facets[range].iter().map(area_of).collect::<Vec<f64>>()
    });
    areas.into_iter().flatten().fold(0.0, |sum, area| sum + area) / factorial(D - 1)
}

/// Returns the next corner of the same facet.
fn next(h: u32, size: usize) -> u32 {
    let size = size as u32;
    h / size * size + (h + 1) % size
}

/// Returns whether every ridge of the facets belongs to two facets, in opposite directions.
pub(super) fn is_closed<const D: usize>(facets: &[[u32; D]]) -> bool {
    // In 3D the edges as pairs; in 2D the vertices, where edges start and where they end.
    let ridges = |is_reversed: bool| {
        let ridge = |facet: &[u32; D], i: usize| {
            let [from, to] = [facet[i], facet[(i + 1) % D]].map(u64::from);
            match (D, is_reversed) {
                (3, false) => from << 32 | to,
                (3, true) => to << 32 | from,
                (_, false) => from,
                (_, true) => to,
            }
        };
        let per_facet = if D == 3 { 3 } else { 1 };
        let mut ridges: Vec<u64> =
            facets.iter().flat_map(|facet| (0..per_facet).map(move |i| ridge(facet, i))).collect();
        parallel::sort(Threads::All, &mut ridges);
        ridges
    };
    let forward = ridges(false);
    forward.windows(2).all(|pair| pair[0] < pair[1]) && forward == ridges(true)
}

/// Returns the facets of the boundary by the points at their corners, ascending.
fn sides<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    points: &[u32],
    is_inside: &[bool],
) -> Vec<([u32; D], Side)>
where
    Euclidean: Geometry<D, N>,
{
    let parts = parallel::map_ranges(Threads::All, is_inside.len(), |range| {
        let mut sides = Vec::new();
        for t in range.filter(|&t| is_inside[t]) {
            for k in (0..N).filter(|&k| complex.across(t, k).is_none_or(|across| !is_inside[across])) {
                let vertices: [u32; D] = facet(&complex.simplices[t], k).map(|v| points[v as usize]);
                let vertices = even_order(&vertices).map(|corner| vertices[corner]);
                sides.push((vertices, Side { simplex: t as u32, facet: k as u8 }));
            }
        }
        sides
    });
    // The vertex at infinity, which may be the first one of an edge, has no place among the others.
    let firsts = parts.iter().flatten().map(|(vertices, _)| vertices[0]);
    let infinite = firsts.filter(|&name| name < INFINITY).max().map_or(0, |name| name + 1);
    let sides = parts.iter().flatten().map(|&side| (side.0[0].min(infinite), side));
    let mut sides = Groups::new(infinite as usize + 1, sides);
    sides.for_each_sorted(|_| {});
    sides.items
}

/// Turns around the ridge of a facet that is opposite a point of it, through the inside to the next
/// facet of the boundary. Returns that, and its point opposite the ridge.
fn turn<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    points: &[u32],
    is_inside: &[bool],
    side: Side,
    opposite: u32,
) -> (Side, u32) {
    let place = |t: usize, v: u32| complex.simplices[t].iter().position(|&w| w == v).unwrap_or(0);
    let mut t = side.simplex as usize;
    // The simplices around the ridge have two more vertices each: one that was come from, and one to
    // leave behind.
    let mut from = usize::from(side.facet);
    let mut leave = complex.simplices[t].iter().position(|&v| points[v as usize] == opposite).unwrap_or(0);
    // Only a broken mesh needs the limit.
    for _ in 0..is_inside.len() {
        let Some(across) = complex.across(t, leave).filter(|&across| is_inside[across]) else { break };
        let pivot = complex.simplices[t][from];
        // In a broken mesh, the neighbour may not know this simplex.
        from = complex.facet_towards(across, t) % N;
        t = across;
        leave = place(across, pivot);
    }
    (Side { simplex: t as u32, facet: leave as u8 }, points[complex.simplices[t][from] as usize])
}
