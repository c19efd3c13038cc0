//! Convex polygons and polyhedra, clipped by half-planes and half-spaces.
//!
//! A clipped polytope is closed whatever rounding does: which vertices remain is decided once for
//! each vertex, an edge between one that remains and one that does not is cut once, and the new
//! edges are linked to the boundary of the new facet.

use crate::geometry::vector;

/// A convex polygon or polyhedron.
pub trait Polytope<const D: usize>: Default + Send {
    /// Makes it a box. Its sides have the name `side`.
    fn reset(&mut self, bounds: [[f64; D]; 2], side: i32);

    /// Keeps what is on the side x·normal ≤ offset of a line or plane, which becomes a facet of
    /// this name.
    fn clip(&mut self, normal: [f64; D], offset: f64, name: i32);

    /// Returns the vertices.
    fn vertices(&self) -> &[[f64; D]];

    /// Calls `visit` with the vertices and the name of every facet: both ends in 2D,
    /// counter-clockwise; the corners in 3D, counter-clockwise as seen from outside.
    fn for_facets(&self, visit: impl FnMut(&[u32], i32));
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
    names: Vec<i32>,
    halved: (Vec<[f64; D]>, Vec<i32>),
}

impl<const D: usize> Default for Polygon<D> {
    fn default() -> Self {
        Polygon { vertices: Vec::new(), names: Vec::new(), halved: Default::default() }
    }
}

impl<const D: usize> Polygon<D> {
    /// Makes it the polygon with these vertices. Its edges have the name `side`.
    pub(super) fn start(&mut self, vertices: &[[f64; D]], side: i32) {
        self.vertices.clear();
        self.vertices.extend(vertices);
        self.names.clear();
        self.names.resize(vertices.len(), side);
    }

    /// Keeps what is on the side x·normal ≤ offset of a line or plane. The edge on it has this
    /// name.
    pub(super) fn halve(&mut self, normal: [f64; D], offset: f64, name: i32) {
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
    pub(super) fn names(&self) -> impl Iterator<Item = i32> {
        self.names.iter().copied()
    }
}

impl Polytope<2> for Polygon<2> {
    fn reset(&mut self, [[x0, y0], [x1, y1]]: [[f64; 2]; 2], side: i32) {
        self.start(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]], side);
    }

    fn clip(&mut self, normal: [f64; 2], offset: f64, name: i32) {
        self.halve(normal, offset, name);
    }

    fn vertices(&self) -> &[[f64; 2]] {
        &self.vertices
    }

    fn for_facets(&self, mut visit: impl FnMut(&[u32], i32)) {
        let count = self.vertices.len() as u32;
        for (i, &name) in (0..).zip(&self.names) {
            visit(&[i, (i + 1) % count], name);
        }
    }
}

/// A convex polyhedron.
#[derive(Debug, Default)]
pub struct Polyhedron {
    vertices: Vec<[f64; 3]>,
    faces: Faces,
    scratch: Scratch,
}

/// The corners of faces, counter-clockwise as seen from outside, face after face.
#[derive(Debug, Default)]
struct Faces {
    corners: Vec<u32>,
    /// Where each face ends in `corners`, and its name.
    ends: Vec<(usize, i32)>,
}

impl Faces {
    fn clear(&mut self) {
        self.corners.clear();
        self.ends.clear();
    }

    /// Ends the face that the last corners belong to, if there are any.
    fn end(&mut self, name: i32) {
        if self.corners.len() > self.ends.last().map_or(0, |&(end, _)| end) {
            self.ends.push((self.corners.len(), name));
        }
    }

    fn iter(&self) -> impl Iterator<Item = (&[u32], i32)> {
        let mut start = 0;
        self.ends.iter().map(move |&(end, name)| {
            let corners = &self.corners[start..end];
            start = end;
            (corners, name)
        })
    }
}

/// Lists that one clipping leaves to the next.
#[derive(Debug, Default)]
struct Scratch {
    vertices: Vec<[f64; 3]>,
    faces: Faces,
    /// The value x·normal − offset of each old vertex, and its new index.
    values: Vec<(f64, u32)>,
    /// The edges that are cut, lower vertex first, and the new vertices.
    cuts: Vec<([u32; 2], u32)>,
    /// The new vertices of a face, in its order, and whether the face leaves what remains there.
    crossings: Vec<(u32, bool)>,
    /// For each new vertex, counted from the first, the next one around the new face.
    next: Vec<u32>,
}

/// No next vertex, or none any more.
const DONE: u32 = u32::MAX;

impl Polytope<3> for Polyhedron {
    fn reset(&mut self, bounds: [[f64; 3]; 2], side: i32) {
        self.vertices.clear();
        // Bit k of the index is set at the upper end of axis k.
        self.vertices.extend((0..8).map(|i| std::array::from_fn(|axis| bounds[i >> axis & 1][axis])));
        self.faces.clear();
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            self.faces.corners.extend(face);
            self.faces.end(side);
        }
    }

    fn clip(&mut self, normal: [f64; 3], offset: f64, name: i32) {
        let Scratch { vertices, faces, values, cuts, crossings, next } = &mut self.scratch;
        values.clear();
        values.extend(self.vertices.iter().map(|&p| (vector::dot(p, normal) - offset, 0)));
        if values.iter().all(|&(value, _)| value <= 0.0) {
            return;
        }
        vertices.clear();
        for (value, p) in values.iter_mut().zip(&self.vertices) {
            if value.0 <= 0.0 {
                value.1 = vertices.len() as u32;
                vertices.push(*p);
            }
        }
        let first_new = vertices.len() as u32;
        faces.clear();
        cuts.clear();
        next.clear();
        for (corners, name) in self.faces.iter() {
            crossings.clear();
            for (i, &a) in corners.iter().enumerate() {
                let b = if i + 1 < corners.len() { corners[i + 1] } else { corners[0] };
                let ((s, new), (t, _)) = (values[a as usize], values[b as usize]);
                if s <= 0.0 {
                    faces.corners.push(new);
                }
                if (s <= 0.0) == (t <= 0.0) {
                    continue;
                }
                let edge = [a.min(b), a.max(b)];
                let new = match cuts.iter().find(|(cut, _)| *cut == edge) {
                    Some(&(_, new)) => new,
                    None => {
                        let [p, q] = [a, b].map(|v| self.vertices[v as usize]);
                        vertices.push(if s <= 0.0 { cut(p, q, s, t) } else { cut(q, p, t, s) });
                        let new = vertices.len() as u32 - 1;
                        cuts.push((edge, new));
                        next.push(DONE);
                        new
                    }
                };
                faces.corners.push(new);
                crossings.push((new, s <= 0.0));
            }
            // From where the face leaves to where it comes back there is a new edge, which the new
            // face has in the other direction.
            for (i, &(leave, leaves)) in crossings.iter().enumerate() {
                if leaves {
                    let (back, _) = crossings[(i + 1) % crossings.len()];
                    next[(back - first_new) as usize] = leave;
                }
            }
            faces.end(name);
        }
        // One face, or several if rounding parted what is cut off.
        for start in 0..next.len() {
            let mut at = start;
            while next[at] != DONE {
                faces.corners.push(first_new + at as u32);
                at = (std::mem::replace(&mut next[at], DONE) - first_new) as usize;
            }
            faces.end(name);
        }
        std::mem::swap(&mut self.vertices, vertices);
        std::mem::swap(&mut self.faces, faces);
    }

    fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    fn for_facets(&self, mut visit: impl FnMut(&[u32], i32)) {
        for (corners, name) in self.faces.iter() {
            visit(corners, name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
            space.reset([[-1.0; 3], [1.0; 3]], -1);
            plane.reset([[-1.0; 2], [1.0; 2]], -1);
            let clipped = |space: &Polyhedron, normal: [f64; 3], offset: f64| {
                let mut copy = Polyhedron::default();
                copy.vertices.clone_from(&space.vertices);
                copy.faces.corners.clone_from(&space.faces.corners);
                copy.faces.ends.clone_from(&space.faces.ends);
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
