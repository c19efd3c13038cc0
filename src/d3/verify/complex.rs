//! What is true of the vertex indices alone: which tetrahedra share facets, the boundary, the
//! counts.

use crate::verify::report::{Defect, Findings};
use crate::{
    d3::mesh::FACETS,
    index::{Entry, NONE},
};
use std::ops::Range;

/// A facet of one tetrahedron.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Side {
    /// The tetrahedron.
    pub(crate) tetrahedron: usize,
    /// The vertex that the facet is opposite to, 0 to 3.
    pub(crate) k: usize,
}

/// One side of a facet, as met in the star of the facet's lowest vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct FacetSide {
    /// The facet's other vertices, ascending.
    others: [u32; 2],
    tetrahedron: u32,
    /// The vertex of the tetrahedron that the facet is opposite to, 0 to 3.
    k: u8,
    /// Which way the ascending vertices turn, as seen from outside the tetrahedron.
    turn: bool,
}

/// Tetrahedra with the adjacency that follows from their vertices.
#[derive(Default)]
pub(crate) struct Complex<'a> {
    pub(crate) tetrahedra: &'a [[u32; 4]],
    /// The tetrahedron across each facet; none where the facet has one tetrahedron only, or more
    /// than two.
    pub(crate) across: Vec<[u32; 4]>,
    /// The facets of one tetrahedron only.
    pub(crate) hull: Vec<Side>,
    pub(crate) vertices: usize,
    pub(crate) edges: usize,
    pub(crate) facets: usize,
    pub(crate) bad_facets: Findings,
}

pub(crate) fn check_indices(tetrahedra: &[[u32; 4]], points: usize) -> Findings {
    let mut findings = Findings::default();
    if tetrahedra.len() > i32::MAX as usize {
        let detail = format!("{} tetrahedra are more than a neighbor's index can name", tetrahedra.len());
        findings.add(|| Defect::in_mesh(detail));
    }
    for (t, vertices) in tetrahedra.iter().enumerate() {
        if let Some(v) = vertices.iter().find(|&&v| v as usize >= points) {
            findings.add(|| Defect::at_tetrahedron(t, format!("vertex {v} is not one of the {points} points")));
        } else if (0..4).any(|i| vertices[..i].contains(&vertices[i])) {
            findings.add(|| Defect::at_tetrahedron(t, format!("the vertices {vertices:?} are not four points")));
        }
    }
    findings
}

impl<'a> Complex<'a> {
    /// Derives the adjacency. Needs vertices that are indices of points, four different ones per
    /// tetrahedron.
    pub(crate) fn new(tetrahedra: &'a [[u32; 4]], points: usize) -> Self {
        let across = vec![[NONE; 4]; tetrahedra.len()];
        let mut complex = Complex { tetrahedra, across, ..Complex::default() };
        let stars = LowerStars::new(tetrahedra, points);
        // Every edge and every facet is met in the star of its lowest vertex. Vertices in
        // the order in which they appear are near each other, and so are their tetrahedra in
        // memory.
        let order = first_appearances(tetrahedra, points);
        let mut seen_from = vec![NONE; points];
        let mut facets = Vec::new();
        for &v in &order {
            facets.clear();
            for &t in stars.of(v) {
                let vertices = tetrahedra[t as usize];
                for w in vertices.into_iter().filter(|&w| w > v) {
                    complex.edges += usize::from(seen_from[w as usize] != v);
                    seen_from[w as usize] = v;
                }
                for k in lowest_of(v, vertices) {
                    let (turn, [_, b, c]) = sorted(FACETS[k].map(|i| vertices[i]));
                    facets.push(FacetSide { others: [b, c], tetrahedron: t, k: k as u8, turn });
                }
            }
            facets.sort_unstable();
            for sides in facets.chunk_by(|a, b| a.others == b.others) {
                complex.join(sides);
            }
        }
        complex.vertices = order.len();
        complex
    }

    /// Takes in one facet, given all its sides.
    fn join(&mut self, sides: &[FacetSide]) {
        self.facets += 1;
        match *sides {
            [a] => self.hull.push(Side { tetrahedron: a.tetrahedron as usize, k: a.k as usize }),
            [a, b] => {
                self.across[a.tetrahedron as usize][a.k as usize] = b.tetrahedron;
                self.across[b.tetrahedron as usize][b.k as usize] = a.tetrahedron;
                if a.turn == b.turn {
                    let detail = || format!("on the same side of facet {} as tetrahedron {}", a.k, b.tetrahedron);
                    self.bad_facets.add(|| Defect::at_tetrahedron(a.tetrahedron as usize, detail()));
                }
            }
            [a, ..] => {
                let detail = || format!("facet {} belongs to {} tetrahedra", a.k, sides.len());
                self.bad_facets.add(|| Defect::at_tetrahedron(a.tetrahedron as usize, detail()));
            }
            [] => {}
        }
    }

    /// Returns the corners of a facet, counter-clockwise as seen from outside a positively oriented
    /// tetrahedron.
    pub(crate) fn corners(&self, side: Side) -> [u32; 3] {
        FACETS[side.k].map(|i| self.tetrahedra[side.tetrahedron][i])
    }

    /// Returns the vertex of a facet's tetrahedron that is not on the facet.
    pub(crate) fn apex(&self, side: Side) -> u32 {
        self.tetrahedra[side.tetrahedron][side.k]
    }

    /// Returns the facets between one of these tetrahedra and a later one, with the vertex beyond.
    pub(crate) fn inner_facets(&self, tetrahedra: Range<usize>) -> impl Iterator<Item = (Side, u32)> {
        let sides = tetrahedra.flat_map(|tetrahedron| (0..4).map(move |k| Side { tetrahedron, k }));
        sides.filter_map(|side| {
            let beyond = self.across[side.tetrahedron][side.k];
            if beyond == NONE || (beyond as usize) < side.tetrahedron {
                return None;
            }
            let corners = self.corners(side);
            let apex = self.tetrahedra[beyond as usize].into_iter().find(|v| !corners.contains(v))?;
            Some((side, apex))
        })
    }

    pub(crate) fn check_facets(&mut self) -> Findings {
        std::mem::take(&mut self.bad_facets)
    }

    pub(crate) fn check_neighbors(&self, stated: &[[u32; 4]]) -> Findings {
        let mut findings = Findings::default();
        if stated.len() != self.tetrahedra.len() {
            let detail = format!("neighbors of {} tetrahedra, not of {}", stated.len(), self.tetrahedra.len());
            findings.add(|| Defect::in_mesh(detail));
            return findings;
        }
        for (t, (stated, across)) in stated.iter().zip(&self.across).enumerate() {
            for k in 0..4 {
                if stated[k] != across[k] {
                    findings.add(|| {
                        let detail =
                            format!("the neighbor across facet {k} is {}, not {}", Entry(across[k]), Entry(stated[k]));
                        Defect::at_tetrahedron(t, detail)
                    });
                }
            }
        }
        findings
    }

    pub(crate) fn check_hull(&self, stated: &[[u32; 3]]) -> Findings {
        let mut findings = Findings::default();
        let mut stated: Vec<_> = stated.iter().map(|&triangle| from_lowest(triangle)).collect();
        stated.sort_unstable();
        let mut expected: Vec<_> = self.hull.iter().map(|&side| (from_lowest(self.corners(side)), side)).collect();
        expected.sort_unstable_by_key(|&(triangle, _)| triangle);
        let mut stated = stated.into_iter().peekable();
        for (triangle, side) in expected {
            while let Some(extra) = stated.next_if(|&s| s < triangle) {
                findings.add(|| Defect::in_mesh(format!("{extra:?} is not a triangle of the hull, or not once")));
            }
            if stated.next_if_eq(&triangle).is_none() {
                findings.add(|| {
                    Defect::at_tetrahedron(side.tetrahedron, format!("the hull lacks its triangle {triangle:?}"))
                });
            }
        }
        for extra in stated {
            findings.add(|| Defect::in_mesh(format!("{extra:?} is not a triangle of the hull, or not once")));
        }
        findings
    }

    /// Checks that the hull is closed, and finds the two hull triangles at each edge of a closed
    /// hull, from either of which the edge is `k` of the triangle's corners *k* and *k* + 1.
    pub(crate) fn check_hull_closed(&self, ridges: &mut Vec<[(Side, usize); 2]>) -> Findings {
        let mut findings = Findings::default();
        let mut edges = Vec::with_capacity(3 * self.hull.len());
        for &side in &self.hull {
            let corners = self.corners(side);
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                edges.push(((a.min(b), a.max(b)), a < b, (side, k)));
            }
        }
        edges.sort_unstable_by_key(|&(edge, ..)| edge);
        for around in edges.chunk_by(|(a, ..), (b, ..)| a == b) {
            match *around {
                [(_, true, a), (_, false, b)] | [(_, false, a), (_, true, b)] => ridges.push([a, b]),
                [((a, b), _, (side, _)), ..] => findings.add(|| {
                    let detail = format!("its edge {a}-{b} is in {} hull triangles", around.len());
                    Defect::at_tetrahedron(side.tetrahedron, detail)
                }),
                [] => {}
            }
        }
        findings
    }

    pub(crate) fn check_euler_characteristic(&self) -> Findings {
        let mut findings = Findings::default();
        let [vertices, edges, facets, tetrahedra] = [self.vertices, self.edges, self.facets, self.tetrahedra.len()];
        // No tetrahedra do not form a ball, but are right for coplanar points; the check of the
        // vertices decides.
        if tetrahedra > 0 && vertices + facets != edges + tetrahedra + 1 {
            findings.add(|| {
                Defect::in_mesh(format!(
                    "{vertices} vertices - {edges} edges + {facets} facets - {tetrahedra} tetrahedra is not 1"
                ))
            });
        }
        findings
    }
}

/// For each vertex, the tetrahedra in which it is not the highest.
struct LowerStars {
    /// Where the list of each vertex begins in `tetrahedra`, and at last its end.
    begin: Vec<usize>,
    tetrahedra: Vec<u32>,
}

impl LowerStars {
    fn new(tetrahedra: &[[u32; 4]], points: usize) -> Self {
        let lower = |vertices: &[u32; 4]| {
            let mut vertices = *vertices;
            vertices.sort_unstable();
            [vertices[0], vertices[1], vertices[2]].map(|v| v as usize)
        };
        let mut begin = vec![0; points + 1];
        for v in tetrahedra.iter().flat_map(lower) {
            begin[v] += 1;
        }
        let mut end = 0;
        for b in &mut begin {
            end += *b;
            *b = end;
        }
        // Filled from the back, each list's end moves to its beginning.
        let mut list = vec![0; end];
        for (t, vertices) in tetrahedra.iter().enumerate().rev() {
            for v in lower(vertices) {
                begin[v] -= 1;
                list[begin[v]] = t as u32;
            }
        }
        LowerStars { begin, tetrahedra: list }
    }

    fn of(&self, v: u32) -> &[u32] {
        &self.tetrahedra[self.begin[v as usize]..self.begin[v as usize + 1]]
    }
}

/// Returns the triangle's vertices ascending, and whether that turns the same way.
fn sorted([a, b, c]: [u32; 3]) -> (bool, [u32; 3]) {
    let mut ascending = [a, b, c];
    ascending.sort_unstable();
    ((a < b) as u8 + (b < c) as u8 + (c < a) as u8 == 2, ascending)
}

/// Returns the same triangle, from its lowest vertex on.
fn from_lowest([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Returns the facets of which `v` is the lowest vertex, each by the vertex that it is opposite to.
fn lowest_of(v: u32, vertices: [u32; 4]) -> impl Iterator<Item = usize> {
    let lower = vertices.into_iter().filter(|&w| w < v).count();
    (0..4).filter(move |&k| match lower {
        0 => vertices[k] != v,
        1 => vertices[k] < v,
        _ => false,
    })
}

/// Returns the vertices of the tetrahedra, each once.
fn first_appearances(tetrahedra: &[[u32; 4]], points: usize) -> Vec<u32> {
    let mut seen = vec![false; points];
    let new = |v: &u32| !std::mem::replace(&mut seen[*v as usize], true);
    tetrahedra.as_flattened().iter().copied().filter(new).collect()
}
