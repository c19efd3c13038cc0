//! Triangles whose vertices come and go.

use crate::{
    cpu::edit::{Edit, Patch, Row},
    d2::{
        Mesh2, Triangulation2,
        insert::{self, edge_of},
        triangulation::{MAX_TRIANGLES, edges_of_mesh, edges_to_mesh, vertices_of_mesh, vertices_to_mesh},
    },
    dimension::Dimension,
    error::Error,
    index::NONE,
    options::Winding,
    predicates::filter::PredicateContext2,
    slots,
};
use rustc_hash::{FxHashMap, FxHashSet};

impl Edit<2, 3> for Dimension<2> {
    type Hull = Vec<u32>;

    const MAX_SIMPLICES: usize = MAX_TRIANGLES;
    const REMOVAL: f64 = 1.4;
    const MAX_SHARE: f64 = 0.02;

    fn count(mesh: &Mesh2) -> usize {
        mesh.triangles.len()
    }

    fn row(mesh: &Mesh2, winding: Winding, t: u32) -> Option<Row<3>> {
        let halfedges = *mesh.halfedges.get(t as usize)?;
        let is_there = |e: u32| e == NONE || (e as usize) < 3 * mesh.triangles.len();
        let triangle = *mesh.triangles.get(t as usize)?;
        let row = || (vertices_of_mesh(triangle, winding), edges_of_mesh(halfedges, winding));
        halfedges.into_iter().all(is_there).then(row)
    }

    fn beyond(mesh: &Mesh2, winding: Winding, facet: u32, across: u32) -> Option<[u32; 3]> {
        let (triangle, edges) = Self::row(mesh, winding, across >> 2)?;
        (edges.get(across as usize & 3) == Some(&facet)).then_some(triangle)
    }

    fn ghost(triangle: [u32; 3], k: usize, infinite: u32) -> [u32; 3] {
        let [from, to] = edge_of(triangle, k);
        [to, from, infinite]
    }

    fn is_positive(vertices: &PredicateContext2<'_>, [a, b, c]: [u32; 3]) -> bool {
        vertices.orient2d(a, b, c) > 0
    }

    fn in_conflict(triangulation: &Triangulation2, vertices: &PredicateContext2<'_>, v: u32, t: u32) -> bool {
        insert::in_conflict(triangulation, &vertices.at(v), t)
    }

    /// Goes along the hull, and along the new edges where old ones were removed.
    fn hull(
        mesh: &Mesh2,
        removed: &FxHashSet<[u32; 3]>,
        added: Vec<[u32; 3]>,
        infinite: u32,
        winding: Winding,
    ) -> Option<Vec<u32>> {
        // Ghosts go around the infinite vertex clockwise.
        let edge = |ghost: [u32; 3]| {
            let k = ghost.iter().position(|&v| v == infinite).unwrap_or(2);
            let [from, to] = edge_of(ghost, k);
            match winding {
                Winding::CounterClockwise => [to, from],
                Winding::Clockwise => [from, to],
            }
        };
        let mut next: FxHashMap<u32, u32> = added.into_iter().map(edge).map(Into::into).collect();
        let old = &mesh.hull;
        let is_removed = |i: usize| {
            let mut ghost = [old[i], old[(i + 1) % old.len()], infinite];
            ghost.sort_unstable();
            removed.contains(&ghost)
        };
        // The place of the vertices at which an old edge begins that is kept.
        let kept: Vec<usize> = (0..old.len()).filter(|&i| !is_removed(i)).collect();
        let mut hull = Vec::with_capacity(kept.len() + next.len());
        for (n, &i) in kept.iter().enumerate() {
            hull.push(old[i]);
            let goal = old[kept[(n + 1) % kept.len()]];
            let mut at = old[(i + 1) % old.len()];
            while at != goal {
                hull.push(at);
                at = next.remove(&at)?;
            }
        }
        if kept.is_empty() {
            let first = *next.keys().next()?;
            let mut at = first;
            while let Some(to) = next.remove(&at) {
                hull.push(at);
                at = to;
            }
            if at != first {
                return None;
            }
        }
        let lowest = hull.iter().enumerate().min_by_key(|&(_, v)| v).map_or(0, |(at, _)| at);
        hull.rotate_left(lowest);
        next.is_empty().then_some(hull)
    }

    fn apply(mesh: &mut Mesh2, Patch { count, rows, hull }: Patch<3, Vec<u32>>, winding: Winding) {
        let room = count.max(mesh.triangles.len());
        mesh.triangles.resize(room, [0; 3]);
        mesh.halfedges.resize(room, [NONE; 3]);
        for (t, (vertices, across)) in rows {
            mesh.triangles[t as usize] = vertices_to_mesh(vertices, winding);
            mesh.halfedges[t as usize] = edges_to_mesh(across, winding);
        }
        mesh.triangles.truncate(count);
        mesh.halfedges.truncate(count);
        mesh.hull = hull.unwrap_or_else(|| std::mem::take(&mut mesh.hull));
    }

    fn reserve(mesh: &mut Mesh2, triangles: usize) -> Result<(), Error> {
        let more = triangles.saturating_sub(mesh.triangles.len());
        slots::reserve_more(&mut mesh.triangles, &mut mesh.halfedges, more)
    }
}
