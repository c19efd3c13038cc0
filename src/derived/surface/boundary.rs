//! The boundary of a solid as a closed surface.
//!
//! Each facet meets another one at each of its ridges (edges, or vertices in 2D): that which is reached
//! by turning around the ridge through the inside. So every ridge has two facets even where several
//! sheets touch, and a vertex is split into as many as there are cycles of facets around it. Where two
//! edges still have the same vertices, one of them gets a new vertex in its middle.

use super::super::{complex::Complex, sets::DisjointSets, sorted::even_order};
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
#[derive(Debug, Clone, Copy)]
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
            for (mates, &(vertices, side)) in chunk.iter_mut().zip(&sides[start..]) {
                for (mate, v) in mates.iter_mut().zip(vertices) {
                    let (next, from) = turn(complex, points, is_inside, side, v);
                    // Only in a broken mesh there is no next facet.
                    if let Some((vertices, _)) = sides.get(number(next) as usize) {
                        let corner = vertices.iter().position(|&w| w == from).unwrap_or(0);
                        *mate = number(next) * D as u32 + corner as u32;
                    }
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
        let edge = |h: u32| {
            let (f, i) = (h as usize / D, h as usize % D);
            [corners[D * f + (i + 1) % D], corners[D * f + (i + 2) % D]]
        };
        let mut edges: Vec<([u32; 2], u32)> =
            (0..corners.len() as u32).map(|h| (edge(h), h)).filter(|([a, b], _)| a < b).collect();
        parallel::sort(Threads::All, &mut edges);
        let doubled: Vec<u32> = edges.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| pair[1].1).collect();
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
        let mut sets = DisjointSets::new(self.facets.len());
        let mut count = self.facets.len();
        for (f, mates) in (0..).zip(&self.mates) {
            for mate in mates.iter().filter(|&&mate| mate != NONE) {
                count -= usize::from(sets.unite(f, mate / D as u32));
            }
        }
        count
    }

    /// Numbers the vertices, one for each cycle of facets around a point.
    pub(super) fn split_vertices(&mut self) {
        let mut cycles = DisjointSets::new(D * self.facets.len());
        for (f, mates) in self.mates.iter().enumerate() {
            for (i, &mate) in mates.iter().enumerate().filter(|&(_, &mate)| mate != NONE) {
                let (across, opposite) = (mate as usize / D, mate as usize % D);
                // The other corners are those at the ridge.
                for (j, v) in self.facets[f].iter().enumerate().filter(|&(j, _)| j != i) {
                    let is_same = |&l: &usize| l != opposite && self.facets[across][l] == *v;
                    if let Some(l) = (0..D).find(is_same) {
                        cycles.unite((D * f + j) as u32, (D * across + l) as u32);
                    }
                }
            }
        }
        let corners = self.facets.as_flattened_mut();
        let roots: Vec<u32> = (0..corners.len() as u32).map(|corner| cycles.find(corner)).collect();
        let mut vertices: Vec<(u32, u32)> = (0..)
            .zip(&roots)
            .filter(|&(corner, &root)| corner == root)
            .map(|(_, &root)| (corners[root as usize], root))
            .collect();
        parallel::sort(Threads::All, &mut vertices);
        let mut names = vec![NONE; corners.len()];
        for (name, &(_, root)) in (0..).zip(&vertices) {
            names[root as usize] = name;
        }
        for (corner, &root) in corners.iter_mut().zip(&roots) {
            *corner = names[root as usize];
        }
        self.sources = vertices.into_iter().map(|(point, _)| point).collect();
    }
}

/// Returns the sum of the facets' measures, times `scale` for each of their dimensions.
pub(super) fn area<const D: usize, const N: usize>(facets: &[[u32; D]], vertices: &[[f64; D]], scale: f64) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let normals =
        facets.iter().map(|facet| Euclidean::facet_normal(&facet.map(|v| vector::times(scale, vertices[v as usize]))));
    normals.map(vector::norm).fold(0.0, |sum, length| sum + length) / factorial(D - 1)
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
    let mut sides = parallel::joined(parts);
    parallel::sort_by(Threads::All, &mut sides, |(a, _), (b, _)| a.cmp(b));
    sides
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
