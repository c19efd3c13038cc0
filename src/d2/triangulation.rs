//! Triangles and their neighbours under construction, the outside of the hull included.

use crate::{
    index::NONE,
    options::Winding,
    parallel::{self, Threads},
    slots,
};

/// Half-edges are numbered below 2³¹, because −1 stands for none.
pub(crate) const MAX_TRIANGLES: usize = i32::MAX as usize / 3;

/// Returns the places of the vertices of a triangle in a mesh of this orientation, and the inverse.
const fn vertex_order(clockwise: bool) -> [usize; 3] {
    if clockwise { [0, 2, 1] } else { [0, 1, 2] }
}

/// Returns the half-edge, numbered by the vertex where it begins, that the edge opposite vertex *k*
/// becomes.
const fn halfedge_of_edge(clockwise: bool) -> [usize; 3] {
    if clockwise { [1, 0, 2] } else { [1, 2, 0] }
}

/// Returns the inverse of [`halfedge_of_edge`].
const fn edge_of_halfedge(clockwise: bool) -> [usize; 3] {
    if clockwise { [1, 0, 2] } else { [2, 0, 1] }
}

/// Returns the vertices of a triangle of a mesh of this orientation, counter-clockwise.
pub(super) fn vertices_of_mesh(triangle: [u32; 3], winding: Winding) -> [u32; 3] {
    vertex_order(winding == Winding::Clockwise).map(|k| triangle[k])
}

/// Returns the vertices of a counter-clockwise triangle as a mesh of this orientation has them.
pub(crate) fn vertices_to_mesh(triangle: [u32; 3], winding: Winding) -> [u32; 3] {
    vertices_of_mesh(triangle, winding)
}

/// Returns what is across the edges of a triangle of a mesh of this orientation, given its
/// half-edges; [`NONE`] outside the hull.
pub(super) fn edges_of_mesh(halfedges: [u32; 3], winding: Winding) -> [u32; 3] {
    let mut edges = [NONE; 3];
    for (k, edge) in edge_of_halfedge(winding == Winding::Clockwise).into_iter().enumerate() {
        if halfedges[k] != NONE {
            edges[edge] = Triangulation2::edge_of_halfedge(halfedges[k], winding);
        }
    }
    edges
}

/// Returns the half-edges of a triangle, given what is across its edges: the inverse of
/// [`edges_of_mesh`].
pub(crate) fn edges_to_mesh(edges: [u32; 3], winding: Winding) -> [u32; 3] {
    let is_clockwise = winding == Winding::Clockwise;
    edge_of_halfedge(is_clockwise).map(|k| match edges[k] {
        NONE => NONE,
        across => (across as usize / 4 * 3 + halfedge_of_edge(is_clockwise)[across as usize % 4]) as u32,
    })
}

/// A 2D triangulation: triangles, and *ghosts*, which join the edges of the hull to one infinite
/// vertex.
///
/// Every triangle has three neighbours, and edge *k* is the one opposite its vertex *k*. So
/// topologically it is a sphere.
#[derive(Debug, Clone)]
pub struct Triangulation2 {
    /// Three vertices per triangle, counter-clockwise with the *y* axis up. A ghost has the
    /// infinite vertex in any place, and is oriented as if that lay outside the hull.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Entry *k* is across the edge opposite vertex *k*: 4·(triangle) + (edge as it is numbered
    /// there).
    pub(crate) neighbors: Vec<[u32; 3]>,
    /// The infinite vertex: the number of vertices.
    pub(crate) infinite: u32,
}

impl Triangulation2 {
    /// Creates a triangulation from its arrays, which are not checked.
    ///
    /// Triangles are counter-clockwise with the *y* axis up; ghosts are oriented as if the infinite
    /// vertex lay outside the hull. Entry *k* of `neighbors` is across the edge opposite vertex
    /// *k*: 4·(triangle) + (edge as it is numbered there). `infinite` is the number of vertices.
    pub fn new(triangles: Vec<[u32; 3]>, neighbors: Vec<[u32; 3]>, infinite: u32) -> Self {
        Triangulation2 { triangles, neighbors, infinite }
    }

    /// Creates the triangulation of a mesh of this orientation from its triangles, half-edges and
    /// hull, which are not checked: the inverse of [`Triangulation2::into_mesh`] without names.
    /// `infinite` is the number of vertices. The mesh's triangles keep their numbers, and one ghost
    /// per edge of the hull follows.
    pub fn from_mesh(
        triangles: Vec<[u32; 3]>,
        halfedges: Vec<[u32; 3]>,
        hull: &[u32],
        infinite: u32,
        winding: Winding,
    ) -> Self {
        match winding {
            Winding::CounterClockwise => Self::read::<false>(triangles, halfedges, hull, infinite),
            Winding::Clockwise => Self::read::<true>(triangles, halfedges, hull, infinite),
        }
    }

    fn read<const CLOCKWISE: bool>(
        mut triangles: Vec<[u32; 3]>,
        halfedges: Vec<[u32; 3]>,
        hull: &[u32],
        infinite: u32,
    ) -> Self {
        let count = triangles.len();
        let ghost = |i: usize| (count + i % hull.len()) as u32;
        // Ghosts go around the infinite vertex clockwise; the half-edge below a ghost begins at its
        // first vertex, or ends there.
        let clockwise_hull = |i: usize| hull[if CLOCKWISE { i % hull.len() } else { hull.len() - 1 - i % hull.len() }];
        let mut ghost_from = vec![0; infinite as usize];
        for i in 0..hull.len() {
            ghost_from[clockwise_hull(i) as usize] = ghost(i);
        }
        let mut neighbors = halfedges;
        neighbors.extend((0..hull.len()).map(|i| [4 * ghost(i + 1) + 1, 4 * ghost(i + hull.len() - 1), 0]));
        for t in 0..count {
            let halfedges = neighbors[t];
            for (k, edge) in edge_of_halfedge(CLOCKWISE).into_iter().enumerate() {
                neighbors[t][edge] = match halfedges[k] {
                    NONE => {
                        let first = if CLOCKWISE { k } else { (k + 1) % 3 };
                        let ghost = ghost_from[triangles[t][first] as usize];
                        neighbors[ghost as usize][2] = (4 * t + edge) as u32;
                        4 * ghost + 2
                    }
                    e => 4 * (e / 3) + edge_of_halfedge(CLOCKWISE)[e as usize % 3] as u32,
                };
            }
            triangles[t] = vertex_order(CLOCKWISE).map(|k| triangles[t][k]);
        }
        triangles.extend((0..hull.len()).map(|i| [clockwise_hull(i), clockwise_hull(i + 1), infinite]));
        Triangulation2 { triangles, neighbors, infinite }
    }

    /// Returns the edge that half-edge `halfedge` of a mesh of this orientation has become.
    pub(crate) fn edge_of_halfedge(halfedge: u32, winding: Winding) -> u32 {
        4 * (halfedge / 3) + edge_of_halfedge(winding == Winding::Clockwise)[halfedge as usize % 3] as u32
    }

    /// Returns the half-edge of a mesh of this orientation that edge `edge` becomes.
    pub(crate) fn halfedge_of_edge(edge: u32, winding: Winding) -> u32 {
        edge / 4 * 3 + halfedge_of_edge(winding == Winding::Clockwise)[edge as usize % 4] as u32
    }

    /// Returns the vertices of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns the neighbours of each triangle.
    pub fn neighbors(&self) -> &[[u32; 3]] {
        &self.neighbors
    }

    /// Returns whether triangle `t` is a ghost.
    pub fn is_ghost(&self, t: u32) -> bool {
        self.triangles[t as usize].contains(&self.infinite)
    }

    /// Makes two edges each other's neighbours.
    pub(crate) fn join(&mut self, e: u32, f: u32) {
        self.neighbors[e as usize / 4][e as usize % 4] = f;
        self.neighbors[f as usize / 4][f as usize % 4] = e;
    }

    /// Moves the last triangle into an unused slot.
    fn close_gap(&mut self, t: u32) {
        self.triangles.swap_remove(t as usize);
        self.neighbors.swap_remove(t as usize);
        for (across, k) in self.neighbors.get(t as usize).copied().into_iter().flatten().zip(0..) {
            self.neighbors[across as usize / 4][across as usize % 4] = 4 * t + k;
        }
    }

    /// Returns the vertices of the hull, clockwise with the *y* axis up: those around the infinite
    /// vertex, beginning at a ghost.
    fn hull_from(&self, first: u32) -> Vec<u32> {
        let place_of_infinite = |t: u32| self.triangles[t as usize].iter().position(|&v| v == self.infinite);
        let mut hull = Vec::new();
        let mut t = first;
        while let Some(k) = place_of_infinite(t) {
            let next = (k + 1) % 3;
            hull.push(self.triangles[t as usize][next]);
            t = self.neighbors[t as usize][next] >> 2;
            if t == first {
                break;
            }
        }
        hull
    }

    /// Returns the vertices of the hull, clockwise with the *y* axis up.
    pub(crate) fn hull_vertices(&self) -> Vec<u32> {
        let first = (0..self.triangles.len() as u32).find(|&t| self.is_ghost(t));
        first.map_or_else(Vec::new, |first| self.hull_from(first))
    }

    /// Returns triangles, half-edges and hull as in [`Mesh2`](crate::d2::Mesh2), but of this
    /// orientation, in the arrays where they lie; vertex *v* becomes `names[v]`. `threads` share
    /// the work.
    pub fn into_mesh(
        self,
        names: &[u32],
        winding: Winding,
        threads: Threads,
    ) -> (Vec<[u32; 3]>, Vec<[u32; 3]>, Vec<u32>) {
        match winding {
            Winding::CounterClockwise => self.write::<false>(names, threads),
            Winding::Clockwise => self.write::<true>(names, threads),
        }
    }

    fn write<const CLOCKWISE: bool>(
        mut self,
        names: &[u32],
        threads: Threads,
    ) -> (Vec<[u32; 3]>, Vec<[u32; 3]>, Vec<u32>) {
        let winding = if CLOCKWISE { Winding::Clockwise } else { Winding::CounterClockwise };
        let slots = self.triangles.len();
        let ghosts = parallel::map_ranges(threads, slots, |range| {
            (range.start as u32..range.end as u32).filter(|&t| self.is_ghost(t)).collect::<Vec<_>>()
        });
        let ghosts = ghosts.concat();
        let mut hull = ghosts.first().map_or_else(Vec::new, |&first| self.hull_from(first));
        hull.iter_mut().for_each(|v| *v = names[*v as usize]);
        if !CLOCKWISE {
            hull.reverse();
        }
        let lowest = hull.iter().enumerate().min_by_key(|&(_, v)| v).map_or(0, |(at, _)| at);
        hull.rotate_left(lowest);
        for &t in &ghosts {
            for across in self.neighbors[t as usize] {
                if across != NONE {
                    self.neighbors[across as usize / 4][across as usize % 4] = NONE;
                }
            }
        }
        // The last triangles move into the slots of ghosts, and their neighbours are updated.
        let count = slots - ghosts.len();
        let (gaps, behind) = ghosts.split_at(ghosts.partition_point(|&t| (t as usize) < count));
        let mut behind = behind.iter().rev().copied().peekable();
        let movers = (count..slots).rev().filter(|&t| behind.next_if_eq(&(t as u32)).is_none());
        for (gap, last) in gaps.iter().map(|&t| t as usize).zip(movers) {
            self.triangles[gap] = self.triangles[last];
            self.neighbors[gap] = self.neighbors[last];
            for (across, k) in self.neighbors[gap].into_iter().zip(0..) {
                if across != NONE {
                    self.neighbors[across as usize / 4][across as usize % 4] = 4 * gap as u32 + k;
                }
            }
        }
        let Triangulation2 { mut triangles, mut neighbors, .. } = self;
        triangles.truncate(count);
        neighbors.truncate(count);
        parallel::for_chunks(threads, &mut triangles, |_, chunk| {
            for t in chunk {
                *t = vertex_order(CLOCKWISE).map(|k| names[t[k] as usize]);
            }
        });
        parallel::for_chunks(threads, &mut neighbors, |_, chunk| {
            for edges in chunk {
                *edges = edges_to_mesh(*edges, winding);
            }
        });
        (triangles, neighbors, hull)
    }
}

slots::slots_of_arrays!(Triangulation2, 3, triangles, MAX_TRIANGLES, Triangulation2::close_gap);
