//! Bowyer–Watson: find the tetrahedra whose circumspheres hold the new point, and fill their cavity from the point.
//!
//! The outside of the hull is triangulated too, with *ghost* tetrahedra that join its facets to one infinite vertex, so
//! that no facet is special. The predicates never tie, so the cavity is star-shaped and no new tetrahedron is flat.

use crate::d3::adjacency::EdgeMap;
use crate::{
    Error, Options,
    d3::{
        mesh::FACETS,
        triangulation::{MAX_TETRAHEDRA, Triangulation, state},
    },
    predicates::filter::PredicateContext,
    stats::Phase,
};

/// The most points that the engine takes: none of the usual inputs has 8 tetrahedra a point.
pub(crate) const MAX_POINTS: usize = MAX_TETRAHEDRA / 8;
/// Tetrahedra of a uniform distribution per point: 6.77, and some ghosts.
const EXPECTED_TETRAHEDRA: usize = 7;
/// How often progress is reported, in points.
const REPORT: usize = 1 << 12;

/// A facet of a cavity.
#[derive(Clone, Copy)]
pub(crate) struct Facet {
    /// Counter-clockwise as seen from outside of the cavity; an infinite vertex comes last.
    pub(crate) corners: [u32; 3],
    /// What lies beyond: 4·(tetrahedron) + (facet seen from there).
    beyond: u32,
}

/// Lists that every insertion uses anew.
struct Scratch {
    conflict: Vec<u32>,
    boundary: Vec<Facet>,
    /// The slots of the new tetrahedra.
    filled: Vec<u32>,
    free: Vec<u32>,
    edges: EdgeMap,
}

/// Triangulates all vertices, of which the first four are positively oriented.
pub(crate) fn insert_all(vertices: &PredicateContext<'_>, options: &Options) -> Result<Triangulation, Error> {
    let n = vertices.len();
    let mut mesh = initial(n as u32);
    mesh.reserve(n * EXPECTED_TETRAHEDRA)?;
    let report = |inserted: usize| options.report(Phase::Insert, (4 + inserted) as f64 / n as f64);
    insert_points(&mut mesh, vertices, 4..n as u32, 0, report)?;
    Ok(mesh)
}

/// Inserts vertices that a Delaunay triangulation does not have yet; best if neighbours in the order are neighbours in
/// space, and `start` is a tetrahedron near the first. `report` learns now and then how many are inserted, and can stop.
pub(crate) fn insert_points(
    mesh: &mut Triangulation,
    vertices: &PredicateContext<'_>,
    points: impl IntoIterator<Item = u32>,
    start: u32,
    report: impl Fn(usize) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut scratch = Scratch {
        conflict: Vec::new(),
        boundary: Vec::new(),
        filled: Vec::new(),
        free: Vec::new(),
        edges: EdgeMap::new(vertices.len() + 1),
    };
    let mut last = start;
    for (inserted, p) in points.into_iter().enumerate() {
        if inserted % REPORT == 0 {
            report(inserted)?;
        }
        let start = mesh.locate(vertices, p, last);
        last = mesh.insert(vertices, p, start, &mut scratch)?;
    }
    for slot in scratch.free {
        mesh.set_state(slot, state::FREE);
    }
    Ok(())
}

/// One tetrahedron of the vertices 0 to 3, and the four ghosts on its facets.
fn initial(infinite: u32) -> Triangulation {
    let mut mesh = Triangulation { tetrahedra: vec![[0, 1, 2, 3]], neighbors: vec![[0; 4]], infinite };
    for (k, facet) in FACETS.iter().enumerate() {
        let [a, b, c] = facet.map(|v| v as u32);
        mesh.tetrahedra.push([a, b, c, infinite]);
        mesh.neighbors.push([0; 4]);
        mesh.join(k as u32, 4 * (k as u32 + 1) + 3);
    }
    // Ghosts i and j share the facet opposite i's corner j and j's corner i.
    for i in 0..4u32 {
        for j in 0..i {
            let facet = |ghost: u32, corner: u32| {
                let place = mesh.tetrahedra[ghost as usize + 1].iter().position(|&v| v == corner);
                4 * (ghost + 1) + place.map_or(0, |k| k as u32)
            };
            let (f, g) = (facet(i, j), facet(j, i));
            mesh.join(f, g);
        }
    }
    mesh
}

impl Triangulation {
    /// A tetrahedron that holds vertex `p`, or a ghost whose facet sees it: a walk that crosses facets towards `p` from
    /// tetrahedron `start`. It ends, since the power distance to `p` falls with every step.
    fn locate(&self, vertices: &PredicateContext<'_>, p: u32, start: u32) -> u32 {
        let mut t = if self.is_ghost(start) { self.neighbors[start as usize][3] >> 2 } else { start };
        let mut came_through = 4;
        'walk: loop {
            let v = self.vertices(t);
            for (k, facet) in FACETS.iter().enumerate() {
                if k == came_through {
                    continue;
                }
                let [a, b, c] = facet.map(|i| v[i]);
                if vertices.orient3d(a, b, c, p) > 0 {
                    let across = self.neighbors[t as usize][k];
                    t = across >> 2;
                    came_through = across as usize & 3;
                    if self.is_ghost(t) {
                        return t;
                    }
                    continue 'walk;
                }
            }
            return t;
        }
    }

    /// Whether the circumsphere of `t` holds vertex `p`. That of a ghost is the half-space beyond its facet and, in the
    /// facet's plane, its circumdisc, which the circumsphere on the other side of the facet cuts out of the plane.
    #[inline]
    fn in_conflict(&self, vertices: &PredicateContext<'_>, t: u32, p: u32) -> bool {
        let v = self.vertices(t);
        if v[3] != self.infinite {
            return vertices.insphere(v, p) > 0;
        }
        match vertices.orient3d(v[0], v[1], v[2], p) {
            0 => vertices.insphere(self.vertices(self.neighbors[t as usize][3] >> 2), p) > 0,
            side => side > 0,
        }
    }

    /// Inserts vertex `p`, which is in conflict with tetrahedron `start`; gives a tetrahedron at `p`.
    fn insert(
        &mut self,
        vertices: &PredicateContext<'_>,
        p: u32,
        start: u32,
        scratch: &mut Scratch,
    ) -> Result<u32, Error> {
        self.find_cavity(vertices, p, start, scratch);
        let Scratch { conflict, boundary, filled, free, edges } = scratch;
        free.append(conflict);
        filled.clear();
        for &Facet { corners: [a, b, c], beyond } in boundary.iter() {
            let new = match free.pop() {
                Some(slot) => slot,
                None => self.push()?,
            };
            filled.push(new);
            self.tetrahedra[new as usize] = [p, a, b, c];
            self.set_state(beyond >> 2, state::UNKNOWN);
            self.neighbors[beyond as usize / 4][beyond as usize % 4] = 4 * new;
        }
        edges.link_all(
            boundary,
            |f, corner| 4 * filled[f] + 1 + corner as u32,
            |f, [a, b, c]| self.neighbors[filled[f] as usize] = [boundary[f].beyond, a, b, c],
        );
        Ok(filled[filled.len() - 1])
    }

    /// Marks and lists the tetrahedra in conflict with `p`, and the facets around them, breadth-first.
    fn find_cavity(&mut self, vertices: &PredicateContext<'_>, p: u32, start: u32, scratch: &mut Scratch) {
        let Scratch { conflict, boundary, .. } = scratch;
        boundary.clear();
        conflict.push(start);
        self.set_state(start, state::CONFLICT);
        let mut next = 0;
        while let Some(&t) = conflict.get(next) {
            next += 1;
            let corners = self.vertices(t);
            for (facet, beyond) in FACETS.iter().zip(self.neighbors[t as usize]) {
                let other = beyond >> 2;
                match self.state(other) {
                    state::CONFLICT => continue,
                    state::UNKNOWN if self.in_conflict(vertices, other, p) => {
                        self.set_state(other, state::CONFLICT);
                        conflict.push(other);
                        continue;
                    }
                    state::UNKNOWN => self.set_state(other, state::BEYOND),
                    _ => {}
                }
                let [a, b, c] = facet.map(|i| corners[i]);
                let corners = match self.infinite {
                    i if i == a => [b, c, a],
                    i if i == b => [c, a, b],
                    _ => [a, b, c],
                };
                boundary.push(Facet { corners, beyond });
            }
        }
    }
}
