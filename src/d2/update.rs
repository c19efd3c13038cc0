//! Triangles whose vertices move: exact signs, edge flips, and the removal of vertices that flips do not free.

use crate::{
    cpu::update::{Checked, Moved, PARTED, Update},
    d2::{Mesh2, Triangulation2, insert::NEXT, lawson::flip_edges},
    dimension::Dimension,
    error::Error,
    index::{NO_INDEX, NONE},
    options::Winding,
    predicates::filter::PredicateContext2,
    stats::{Phase, Restart},
};
use rustc_hash::FxHashSet;
use std::{cmp::Reverse, ops::Range};

/// What the signs at the new points leave unproven of a part of a mesh.
#[derive(Default)]
struct Part {
    /// The triangles that are flat or inverted.
    inverted: Vec<u32>,
    /// A half-edge of each edge that is not locally Delaunay.
    edges: Vec<u32>,
    /// The number of half-edges on the hull.
    outer: usize,
}

impl Checked for Part {
    fn counts(&self) -> [usize; 2] {
        [self.inverted.len(), self.edges.len()]
    }
}

impl Update<2> for Dimension<2> {
    type Corners = [u32; 3];

    fn duplicate_of(mesh: &Mesh2) -> &[i32] {
        &mesh.duplicate_of
    }

    fn corners(triangulation: &Triangulation2, t: u32) -> [u32; 3] {
        triangulation.triangles[t as usize]
    }

    fn incident(triangulation: &Triangulation2) -> Vec<u32> {
        let mut incident = vec![NO_INDEX; triangulation.infinite as usize + 1];
        for (t, triangle) in (0..).zip(&triangulation.triangles) {
            for &v in triangle {
                incident[v as usize] = t;
            }
        }
        incident
    }

    fn repair(moved: &mut Moved<'_, 2>, mesh: &Mesh2) -> Result<Result<Triangulation2, Restart>, Error> {
        let winding = moved.options.winding;
        let hull = next_on_hull(mesh);
        let parts = match hull {
            Some(hull) => {
                moved.check(mesh.triangles.len(), |vertices, range| check(mesh, &hull, winding, vertices, range))
            }
            None => Err(Restart::Broken),
        };
        let mut parts = match parts {
            Ok(parts) => parts,
            Err(why) => return Ok(Err(why)),
        };
        let outer: usize = parts.iter().map(|part| part.outer).sum();
        if outer != mesh.hull.len() || mesh.halfedges.len() != mesh.triangles.len() {
            return Ok(Err(Restart::Broken));
        }
        let (count, infinite) = (mesh.triangles.len() as u32, mesh.duplicate_of.len() as u32);
        let (triangles, halfedges) = (mesh.triangles.clone(), mesh.halfedges.clone());
        let mesh = Triangulation2::from_mesh(triangles, halfedges, &mesh.hull, infinite, winding);
        let (mut inverted, mut edges) = (Vec::new(), Vec::new());
        for part in &mut parts {
            inverted.append(&mut part.inverted);
            edges.extend(part.edges.iter().map(|&halfedge| Triangulation2::edge_of_halfedge(halfedge, winding)));
        }
        let of_ghosts = 4 * count..4 * mesh.triangles.len() as u32;
        edges.extend(of_ghosts.filter(|e| e % 4 < 3).filter(|&e| !mesh.is_delaunay(moved.vertices, e)));
        moved.update.not_locally_delaunay = edges.len();
        moved.stats.phases.push((Phase::Check, moved.stopwatch.lap()));

        moved.options.report(Phase::Flip, 0.5)?;
        let repaired = repair(moved, mesh, inverted, edges)?;
        moved.stats.phases.push((Phase::Flip, moved.stopwatch.lap()));
        Ok(repaired)
    }
}

/// Removes vertices that have left their stars, then flips edges.
fn repair(
    moved: &mut Moved<'_, 2>,
    mut mesh: Triangulation2,
    inverted: Vec<u32>,
    mut pending: Vec<u32>,
) -> Result<Result<Triangulation2, Restart>, Error> {
    let vertices = moved.vertices;
    let mut left: FxHashSet<u32> = inverted.into_iter().collect();
    loop {
        let before = left.len();
        let mut these: Vec<u32> = left.iter().copied().collect();
        these.sort_unstable();
        for t in these {
            let Some(removal) = left.contains(&t).then(|| removal(&mesh, vertices, t, &left)).flatten() else {
                continue;
            };
            if moved.removed.len() > vertices.len() / PARTED {
                return Ok(Err(Restart::Inverted));
            }
            moved.removed.push([removal.vertex, removal.triangles[0].0[0]]);
            pending.extend(removal.apply(&mut mesh, &mut left));
        }
        if left.len() == before || left.is_empty() {
            break;
        }
    }
    // At the hull, a flip brings a triangle round, or removes it.
    let mut left: Vec<u32> = left.into_iter().collect();
    left.sort_unstable();
    pending.extend(left.iter().flat_map(|&t| [4 * t, 4 * t + 1, 4 * t + 2]));
    pending.retain(|&edge| (edge as usize / 4) < mesh.triangles.len());
    // A flip takes about as long as a triangle from scratch.
    let max_flips = mesh.triangles.len() as u64;
    let report = |flips: u64| moved.options.report(Phase::Flip, 0.5 + 0.4 * flips as f64 / max_flips as f64);
    let Some(stuck) = flip_edges(&mut mesh, vertices, pending, &mut moved.update.flips, max_flips, &report)? else {
        return Ok(Err(Restart::Changed));
    };
    let is_delaunay = stuck.iter().all(|&edge| mesh.is_delaunay(vertices, edge))
        && left.iter().all(|&t| mesh.is_ghost(t) || mesh.orientation(vertices, t) > 0)
        && mesh.hull_turns_once(vertices);
    Ok(if is_delaunay { Ok(mesh) } else { Err(Restart::Stuck) })
}

/// Returns how one of the vertices of an inverted triangle can be removed: if possible, the one that
/// has the most inverted triangles around it.
fn removal(
    mesh: &Triangulation2,
    vertices: &PredicateContext2<'_>,
    t: u32,
    inverted: &FxHashSet<u32>,
) -> Option<Removal> {
    let mut candidates = mesh.triangles[t as usize].map(|v| {
        let star = mesh.star(t, v);
        let count = star.iter().filter(|&t| inverted.contains(t)).count();
        (Reverse(count), v, star)
    });
    // Where they have as many, it is the one with the lowest index: nothing depends on the slots.
    candidates.sort_unstable();
    candidates.into_iter().find_map(|(_, v, star)| Removal::plan(mesh, vertices, v, star))
}

/// How a vertex is removed: the polygon around it is triangulated by cutting off ears.
struct Removal {
    vertex: u32,
    /// The triangles around the vertex.
    star: Vec<u32>,
    /// The vertices of the triangles that replace these, in as many of their slots, and what is
    /// across their edges.
    triangles: Vec<([u32; 3], [u32; 3])>,
}

/// Larger stars are not cut into ears, which takes quadratic time.
const MAX_STAR: usize = 64;

impl Removal {
    /// Plans the removal of vertex `v`, if it is not on the hull, and the polygon around it can be
    /// triangulated.
    fn plan(mesh: &Triangulation2, vertices: &PredicateContext2<'_>, v: u32, star: Vec<u32>) -> Option<Self> {
        if v == mesh.infinite || star.len() < 3 || star.len() > MAX_STAR || star.iter().any(|&t| mesh.is_ghost(t)) {
            return None;
        }
        // The polygon, counter-clockwise: each vertex with what is across the edge to the next.
        let mut ring: Vec<(u32, u32)> = star
            .iter()
            .map(|&t| {
                let triangle = mesh.triangles[t as usize];
                let k = triangle.iter().position(|&w| w == v).unwrap_or(0);
                (triangle[NEXT[k]], mesh.neighbors[t as usize][k])
            })
            .collect();
        let mut triangles = Vec::new();
        while ring.len() >= 3 {
            let n = ring.len();
            let corners = |i: usize| [ring[(i + n - 1) % n].0, ring[i].0, ring[(i + 1) % n].0];
            let is_ear = |&i: &usize| {
                let [a, b, c] = corners(i);
                let orient = |p, q, r| vertices.orient2d(p, q, r);
                let is_inside = |w: u32| orient(a, b, w) >= 0 && orient(b, c, w) >= 0 && orient(c, a, w) >= 0;
                orient(a, b, c) > 0 && ring.iter().all(|&(w, _)| [a, b, c].contains(&w) || !is_inside(w))
            };
            let i = (0..n).find(is_ear)?;
            let (before, slot) = ((i + n - 1) % n, star[triangles.len()]);
            let [a, b, c] = corners(i);
            let closing = if n == 3 { ring[(i + 1) % n].1 } else { NO_INDEX };
            // Across the edges b c, c a and a b.
            triangles.push(([a, b, c], [ring[i].1, closing, ring[before].1]));
            ring[before].1 = 4 * slot + 1;
            ring.remove(i);
            if n == 3 {
                break;
            }
        }
        Some(Removal { vertex: v, star, triangles })
    }

    /// Removes the vertex. The last triangles move into the two slots that get free; `inverted`
    /// follows them. Returns the edges that may not be locally Delaunay.
    fn apply(self, mesh: &mut Triangulation2, inverted: &mut FxHashSet<u32>) -> Vec<u32> {
        let Removal { star, triangles, .. } = self;
        star.iter().for_each(|t| _ = inverted.remove(t));
        let mut changed = Vec::new();
        for (&slot, &(triangle, across)) in star.iter().zip(&triangles) {
            mesh.triangles[slot as usize] = triangle;
            for (k, across) in (0..).zip(across) {
                // The other side of an edge between new triangles comes later, and sets both.
                if across != NO_INDEX {
                    mesh.join(4 * slot + k, across);
                }
            }
        }
        for &slot in &star[..triangles.len()] {
            changed.extend([4 * slot, 4 * slot + 1, 4 * slot + 2]);
        }
        let mut unused = star[triangles.len()..].to_vec();
        // From the last one, so that what moves is never unused itself.
        unused.sort_unstable();
        while let Some(gap) = unused.pop() {
            let last = mesh.triangles.len() as u32 - 1;
            if gap != last {
                mesh.triangles[gap as usize] = mesh.triangles[last as usize];
                for (k, across) in (0..).zip(mesh.neighbors[last as usize]) {
                    mesh.join(4 * gap + k, across);
                    changed.push(4 * gap + k);
                }
                if inverted.remove(&last) {
                    inverted.insert(gap);
                }
            }
            mesh.triangles.pop();
            mesh.neighbors.pop();
        }
        changed
    }
}

impl Triangulation2 {
    /// Returns the triangles around vertex `v` counter-clockwise from `t`, which is one of them, but
    /// no more than one more than [`MAX_STAR`].
    fn star(&self, t: u32, v: u32) -> Vec<u32> {
        let mut star = vec![t];
        let mut at = t;
        while star.len() <= MAX_STAR {
            let k = self.triangles[at as usize].iter().position(|&w| w == v).unwrap_or(0);
            // Across the edge that begins at the previous vertex and ends here.
            at = self.neighbors[at as usize][NEXT[k]] >> 2;
            if at == t {
                break;
            }
            star.push(at);
        }
        star
    }
}

/// Returns the vertex that follows each on the hull, [`NO_INDEX`] for those inside; `None` if one
/// is there twice.
fn next_on_hull(mesh: &Mesh2) -> Option<Vec<u32>> {
    let hull = &mesh.hull;
    let mut next = vec![NO_INDEX; mesh.duplicate_of.len()];
    for (i, &v) in hull.iter().enumerate() {
        let next = next.get_mut(v as usize).filter(|next| **next == NO_INDEX)?;
        *next = hull[(i + 1) % hull.len()];
    }
    Some(next)
}

/// Evaluates the signs of some triangles, and of their edges with later ones. Returns `None` if
/// half-edges do not run against each other, or those without one are not the hull's.
fn check(
    mesh: &Mesh2,
    next_on_hull: &[u32],
    winding: Winding,
    vertices: &PredicateContext2<'_>,
    range: Range<usize>,
) -> Option<Part> {
    let mut part = Part::default();
    let points = vertices.len();
    for t in range {
        let v = mesh.triangles[t];
        if v.iter().any(|&v| v as usize >= points) {
            return None;
        }
        let triangle = match winding {
            Winding::CounterClockwise => v,
            Winding::Clockwise => [v[0], v[2], v[1]],
        };
        let is_inverted = vertices.orient2d(triangle[0], triangle[1], triangle[2]) <= 0;
        if is_inverted {
            part.inverted.push(t as u32);
        }
        for (k, &across) in mesh.halfedges.get(t)?.iter().enumerate() {
            let (from, to) = (v[k], v[NEXT[k]]);
            if across == NONE {
                part.outer += 1;
                if next_on_hull[from as usize] != to {
                    return None;
                }
                continue;
            }
            let (u, l, halfedge) = (across as usize / 3, across as usize % 3, 3 * t + k);
            let (w, back) = (mesh.triangles.get(u)?, mesh.halfedges.get(u)?);
            let apex = w[NEXT[NEXT[l]]];
            if back[l] as usize != halfedge || [w[NEXT[l]], w[l]] != [from, to] || apex as usize >= points {
                return None;
            }
            if !is_inverted && halfedge < across as usize && vertices.incircle(triangle, apex) > 0 {
                part.edges.push(halfedge as u32);
            }
        }
    }
    Some(part)
}
