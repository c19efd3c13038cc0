//! Tetrahedra whose vertices come and go.

use crate::{
    cpu::edit::{Edit, Patch, Row},
    d3::{
        Mesh3, insert,
        mesh::FACETS,
        triangulation::{MAX_TETRAHEDRA, Triangulation3},
    },
    dimension::Dimension,
    error::Error,
    index::NONE,
    options::Winding,
    predicates::filter::PredicateContext3,
    slots,
};
use rustc_hash::FxHashSet;

impl Edit<3, 4> for Dimension<3> {
    type Hull = Vec<[u32; 3]>;

    const MAX_SIMPLICES: usize = MAX_TETRAHEDRA;
    const REMOVAL: f64 = 1.2;
    const MAX_SHARE: f64 = 0.028;

    fn count(mesh: &Mesh3) -> usize {
        mesh.tetrahedra.len()
    }

    fn row(mesh: &Mesh3, _winding: Winding, t: u32) -> Option<Row<4>> {
        let mut row = [NONE; 4];
        for (across, &u) in row.iter_mut().zip(mesh.neighbors.get(t as usize)?) {
            if u != NONE {
                let back = mesh.neighbors.get(u as usize)?;
                *across = 4 * u + back.iter().position(|&back| back == t)? as u32;
            }
        }
        Some((*mesh.tetrahedra.get(t as usize)?, row))
    }

    /// Does not make the row, which would take as many accesses for each of its facets.
    fn beyond(mesh: &Mesh3, _winding: Winding, facet: u32, across: u32) -> Option<[u32; 4]> {
        let [t, u] = [facet, across].map(|facet| facet >> 2);
        let back = mesh.neighbors.get(u as usize)?[across as usize & 3];
        let place = mesh.neighbors.get(t as usize)?.iter().position(|&v| v == u)?;
        if back == t && place == facet as usize & 3 { mesh.tetrahedra.get(u as usize).copied() } else { None }
    }

    fn ghost(simplex: [u32; 4], k: usize, infinite: u32) -> [u32; 4] {
        let [a, b, c] = FACETS[k].map(|i| simplex[i]);
        [a, b, c, infinite]
    }

    fn is_positive(vertices: &PredicateContext3<'_>, [a, b, c, d]: [u32; 4]) -> bool {
        vertices.orient3d(a, b, c, d) > 0
    }

    fn in_conflict(triangulation: &Triangulation3, vertices: &PredicateContext3<'_>, v: u32, t: u32) -> bool {
        insert::in_conflict(triangulation, &vertices.at(v), t)
    }

    fn hull(
        mesh: &Mesh3,
        removed: &FxHashSet<[u32; 4]>,
        added: Vec<[u32; 4]>,
        infinite: u32,
        _winding: Winding,
    ) -> Option<Vec<[u32; 3]>> {
        let is_kept = |&&[a, b, c]: &&[u32; 3]| {
            let mut ghost = [a, b, c, infinite];
            ghost.sort_unstable();
            !removed.contains(&ghost)
        };
        let kept = mesh.hull.iter().filter(is_kept).copied();
        Some(kept.chain(added.into_iter().map(|[a, b, c, _]| [a, b, c])).collect())
    }

    fn apply(mesh: &mut Mesh3, Patch { count, rows, hull }: Patch<4, Vec<[u32; 3]>>, _winding: Winding) {
        let room = count.max(mesh.tetrahedra.len());
        mesh.tetrahedra.resize(room, [0; 4]);
        mesh.neighbors.resize(room, [NONE; 4]);
        for (t, (vertices, across)) in rows {
            mesh.tetrahedra[t as usize] = vertices;
            mesh.neighbors[t as usize] = across.map(|f| if f == NONE { NONE } else { f / 4 });
        }
        mesh.tetrahedra.truncate(count);
        mesh.neighbors.truncate(count);
        mesh.hull = hull.unwrap_or_else(|| std::mem::take(&mut mesh.hull));
    }

    fn reserve(mesh: &mut Mesh3, tetrahedra: usize) -> Result<(), Error> {
        let more = tetrahedra.saturating_sub(mesh.tetrahedra.len());
        slots::reserve_more(&mut mesh.tetrahedra, &mut mesh.neighbors, more)
    }
}
