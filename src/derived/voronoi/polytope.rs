//! Convex polygons and polyhedra, clipped by half-planes and half-spaces.
//!
//! A clipped polytope is closed whatever rounding does: which vertices remain is decided once for
//! each vertex, an edge between one that remains and one that does not is cut once, and the new
//! edges are linked to the boundary of the new facet.

use crate::geometry::vector;

/// A convex polygon or polyhedron.
pub trait Polytope<const D: usize>: Default + Send {
    /// Makes it a box. Its sides have the name `side`.
    fn reset(&mut self, bounds: [[f64; D]; 2], side: u32);

    /// Keeps what is on the side x·normal ≤ offset of a line or plane, which becomes a facet of
    /// this name.
    fn clip(&mut self, normal: [f64; D], offset: f64, name: u32);

    /// Returns the vertices.
    fn vertices(&self) -> &[[f64; D]];

    /// Calls `visit` with the vertices and the name of every facet: both ends in 2D,
    /// counter-clockwise; the corners in 3D, counter-clockwise as seen from outside.
    fn for_facets(&self, visit: impl FnMut(&[u32], u32));
}

/// Where the edge from p to q, of which p remains, meets the line or plane: `s` and `t` are their
/// values of x·normal − offset.
fn cut<const D: usize>(p: [f64; D], q: [f64; D], s: f64, t: f64) -> [f64; D] {
    // Not more than 1, as s ≤ 0 < t.
    vector::plus(p, vector::times(s / (s - t), vector::minus(q, p)))
}

/// A convex polygon, counter-clockwise in 2D; in 3D within a plane. With two vertices it is a
/// segment, whose edges lead there and back.
#[derive(Debug)]
pub struct Polygon<const D: usize> {
    vertices: Vec<[f64; D]>,
    /// The name of the edge from each vertex to the next.
    names: Vec<u32>,
    halved: (Vec<[f64; D]>, Vec<u32>),
}

impl<const D: usize> Default for Polygon<D> {
    fn default() -> Self {
        Polygon { vertices: Vec::new(), names: Vec::new(), halved: Default::default() }
    }
}

impl<const D: usize> Polygon<D> {
    /// Makes it the polygon with these vertices. Its edges have the name `side`.
    pub(super) fn start(&mut self, vertices: &[[f64; D]], side: u32) {
        self.vertices.clear();
        self.vertices.extend(vertices);
        self.names.clear();
        self.names.resize(vertices.len(), side);
    }

    /// Keeps what is on the side x·normal ≤ offset of a line or plane. The edge on it has this
    /// name.
    pub(super) fn halve(&mut self, normal: [f64; D], offset: f64, name: u32) {
        let value = |p: [f64; D]| vector::dot(p, normal) - offset;
        let (vertices, names) = &mut self.halved;
        vertices.clear();
        names.clear();
        for (i, &p) in self.vertices.iter().enumerate() {
            let q = self.vertices[(i + 1) % self.vertices.len()];
            let (s, t) = (value(p), value(q));
            match (s <= 0.0, t <= 0.0) {
                (true, true) => {
                    vertices.push(p);
                    names.push(self.names[i]);
                }
                (true, false) => {
                    vertices.extend([p, cut(p, q, s, t)]);
                    names.extend([self.names[i], name]);
                }
                (false, true) => {
                    vertices.push(cut(q, p, t, s));
                    names.push(self.names[i]);
                }
                (false, false) => {}
            }
        }
        std::mem::swap(&mut self.vertices, vertices);
        std::mem::swap(&mut self.names, names);
    }

    /// Returns whether nothing is left.
    pub(super) fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Returns the names of the edges.
    pub(super) fn names(&self) -> impl Iterator<Item = u32> {
        self.names.iter().copied()
    }
}

impl Polytope<2> for Polygon<2> {
    fn reset(&mut self, [[x0, y0], [x1, y1]]: [[f64; 2]; 2], side: u32) {
        self.start(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]], side);
    }

    fn clip(&mut self, normal: [f64; 2], offset: f64, name: u32) {
        self.halve(normal, offset, name);
    }

    fn vertices(&self) -> &[[f64; 2]] {
        &self.vertices
    }

    fn for_facets(&self, mut visit: impl FnMut(&[u32], u32)) {
        let count = self.vertices.len() as u32;
        for (i, &name) in (0..).zip(&self.names) {
            visit(&[i, (i + 1) % count], name);
        }
    }
}

/// A convex polyhedron.
///
/// Three faces meet in each vertex; where more would, several vertices are at the same place. Edge
/// *k* of a vertex is the one that is not part of its face *k*.
#[derive(Debug, Default, Clone)]
pub struct Polyhedron {
    vertices: Vec<[f64; 3]>,
    /// The faces around each vertex, counter-clockwise as seen from outside.
    faces: Vec<[u32; 3]>,
    /// The vertices at the other ends of the edges of each vertex.
    across: Vec<[u32; 3]>,
    /// The names of the faces.
    names: Vec<u32>,
    /// The value x·normal − offset of each vertex.
    values: Vec<f64>,
    /// The vertices that a plane cuts off, in ascending order.
    removed: Vec<u32>,
    /// For each vertex that is cut off the new ones on its edges.
    cuts: Vec<[u32; 3]>,
}

impl Polyhedron {
    /// Returns the number of a face of vertex `v`.
    fn number(&self, v: u32, face: u32) -> usize {
        let faces = self.faces[v as usize];
        usize::from(faces[1] == face) | usize::from(faces[2] == face) << 1
    }

    /// Makes `to` the other end of the edge that leads from the other end of edge `k` of vertex `v`
    /// to `v`.
    fn redirect(&mut self, v: u32, k: usize, to: u32) {
        // Around that vertex, the two faces of the edge are in the other order.
        let other = self.across[v as usize][k];
        let number = self.number(other, self.faces[v as usize][(k + 2) % 3]);
        self.across[other as usize][(number + 2) % 3] = to;
    }
}

impl Polytope<3> for Polyhedron {
    fn reset(&mut self, bounds: [[f64; 3]; 2], side: u32) {
        self.vertices.clear();
        self.faces.clear();
        self.across.clear();
        for i in 0..8u32 {
            // Bit k of the index is set at the upper end of axis k.
            let bits = [0, 1, 2].map(|axis| i >> axis & 1);
            self.vertices.push(std::array::from_fn(|axis| bounds[bits[axis] as usize][axis]));
            // From one vertex to the next the order is reversed.
            let axes = if i.count_ones() % 2 == 1 { [0, 1, 2] } else { [0, 2, 1] };
            self.faces.push(axes.map(|axis| 2 * axis as u32 + bits[axis]));
            self.across.push(axes.map(|axis| i ^ 1 << axis));
        }
        self.names.clear();
        self.names.resize(6, side);
    }

    fn clip(&mut self, normal: [f64; 3], offset: f64, name: u32) {
        self.values.clear();
        self.values.extend(self.vertices.iter().map(|&p| vector::dot(p, normal) - offset));
        if self.values.iter().all(|&value| value <= 0.0) {
            return;
        }
        let old = self.vertices.len();
        let remains = |values: &[f64], v: u32| values[v as usize] <= 0.0;
        self.removed.clear();
        self.removed.extend((0..old as u32).filter(|&v| !remains(&self.values, v)));
        self.cuts.resize(old, [0; 3]);
        let face = self.names.len() as u32;
        self.names.push(name);
        // A vertex on each edge that is cut, in place of the one that is not on its side.
        for i in 0..self.removed.len() {
            let v = self.removed[i];
            let (faces, across) = (self.faces[v as usize], self.across[v as usize]);
            for k in 0..3 {
                let other = across[k];
                if remains(&self.values, other) {
                    let new = self.vertices.len() as u32;
                    let [p, q] = [other, v].map(|v| self.vertices[v as usize]);
                    let [s, t] = [other, v].map(|v| self.values[v as usize]);
                    self.redirect(v, k, new);
                    self.vertices.push(cut(p, q, s, t));
                    self.faces.push([face, faces[(k + 1) % 3], faces[(k + 2) % 3]]);
                    self.across.push([other, 0, 0]);
                    self.cuts[v as usize][k] = new;
                }
            }
        }
        // The edges of the new face, each of which ends where the boundary of another face comes
        // back from what is cut off.
        for i in 0..self.removed.len() {
            let v = self.removed[i];
            for k in 0..3 {
                if remains(&self.values, self.across[v as usize][k]) {
                    let turning = self.faces[v as usize][(k + 2) % 3];
                    let (mut at, mut edge) = (v, (k + 1) % 3);
                    while !remains(&self.values, self.across[at as usize][edge]) {
                        at = self.across[at as usize][edge];
                        edge = (self.number(at, turning) + 2) % 3;
                    }
                    let [from, to] = [self.cuts[v as usize][k], self.cuts[at as usize][edge]];
                    self.across[from as usize][1] = to;
                    self.across[to as usize][2] = from;
                }
            }
        }
        // The last vertices take the places of those that are cut off.
        while let Some(v) = self.removed.pop() {
            let last = self.vertices.len() as u32 - 1;
            if v != last {
                (0..3).for_each(|k| self.redirect(last, k, v));
            }
            self.vertices.swap_remove(v as usize);
            self.faces.swap_remove(v as usize);
            self.across.swap_remove(v as usize);
        }
    }

    fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    fn for_facets(&self, mut visit: impl FnMut(&[u32], u32)) {
        let mut is_visited = vec![[false; 3]; self.vertices.len()];
        let mut corners = Vec::new();
        for v in 0..self.vertices.len() as u32 {
            for k in 0..3 {
                let face = self.faces[v as usize][k];
                corners.clear();
                let (mut at, mut number) = (v, k);
                while !std::mem::replace(&mut is_visited[at as usize][number], true) {
                    corners.push(at);
                    at = self.across[at as usize][(number + 1) % 3];
                    number = self.number(at, face);
                }
                if !corners.is_empty() {
                    visit(&corners, self.names[face as usize]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::index::NONE;
    use proptest::prelude::*;

    fn volume(polyhedron: &Polyhedron) -> f64 {
        let mut sum = 0.0;
        polyhedron.for_facets(|corners, _| {
            for pair in corners[1..].windows(2) {
                let [a, b, c] = [corners[0], pair[0], pair[1]].map(|v| polyhedron.vertices[v as usize]);
                sum += vector::dot(a, vector::cross(b, c)) / 6.0;
            }
        });
        sum
    }

    fn area(polygon: &Polygon<2>) -> f64 {
        let mut sum = 0.0;
        polygon.for_facets(|ends, _| {
            let [p, q] = [ends[0], ends[1]].map(|v| polygon.vertices[v as usize]);
            sum += (p[0] * q[1] - p[1] * q[0]) / 2.0;
        });
        sum
    }

    /// Every edge of a closed surface has a face on either side.
    fn assert_closed(polyhedron: &Polyhedron) {
        let mut edges = Vec::new();
        polyhedron.for_facets(|corners, _| {
            for (i, &a) in corners.iter().enumerate() {
                edges.push([a, corners[(i + 1) % corners.len()]]);
            }
        });
        let mut reversed: Vec<_> = edges.iter().map(|&[a, b]| [b, a]).collect();
        edges.sort_unstable();
        reversed.sort_unstable();
        assert_eq!(edges, reversed);
    }

    proptest! {
        /// Both sides of a plane together are what was there before, also where the plane meets
        /// vertices.
        #[test]
        fn both_sides_of_planes_add_up(planes in prop::collection::vec((prop::array::uniform3(-3i32..4), -3i32..4), 1..12), scale in 0.1f64..3.0) {
            let (mut space, mut plane) = (Polyhedron::default(), Polygon::default());
            space.reset([[-1.0; 3], [1.0; 3]], NONE);
            plane.reset([[-1.0; 2], [1.0; 2]], NONE);
            let clipped = |space: &Polyhedron, normal: [f64; 3], offset: f64| {
                let mut copy = space.clone();
                copy.clip(normal, offset, 7);
                copy
            };
            for (normal, offset) in planes {
                let (normal, offset) = (normal.map(|x| f64::from(x) * scale), f64::from(offset) * 0.5);
                let [one, other] = [clipped(&space, normal, offset), clipped(&space, normal.map(|x| -x), -offset)];
                assert_closed(&one);
                // A plane without a normal is everything or nothing.
                if normal != [0.0; 3] {
                    prop_assert!((volume(&one) + volume(&other) - volume(&space)).abs() < 1e-12);
                }
                if volume(&one) > 1e-3 {
                    space = one;
                }
                let before = area(&plane);
                let mut half = Polygon { vertices: plane.vertices.clone(), names: plane.names.clone(), ..Polygon::default() };
                half.clip([-normal[0], -normal[1]], -offset, 7);
                let mut other = Polygon { vertices: plane.vertices.clone(), names: plane.names.clone(), ..Polygon::default() };
                other.clip([normal[0], normal[1]], offset, 7);
                if normal[..2] != [0.0; 2] {
                    prop_assert!((area(&half) + area(&other) - before).abs() < 1e-12);
                }
                if area(&other) > 1e-3 {
                    plane = other;
                }
            }
        }
    }
}
