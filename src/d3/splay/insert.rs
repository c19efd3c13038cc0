//! The points that Phase 1 could not insert, because others were rounded to the same place of the
//! lattice, are inserted one after the other, where the region has the whole cavity.

use crate::{
    cpu::Insert,
    d3::{
        insert::in_conflict,
        mesh::FACETS,
        splay::{Aborted, Stop, region::Region, star::LinkFinder},
        triangulation::Triangulation3,
    },
    error::Error,
    index::NONE,
    predicates::filter::{PredicateContext3, PredicatesAt},
};
use rustc_hash::FxHashMap;

/// Inserts those of the `missing` vertices, each with a vertex near it or with [`NONE`], of which
/// the region has the whole cavity; the others remain. Returns vertices whose stars they need.
pub(super) fn insert(
    region: &mut Region,
    vertices: &PredicateContext3<'_>,
    missing: &mut Vec<[u32; 2]>,
    report: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<Vec<u32>, Stop> {
    let near = missing.iter().map(|&[_, near]| near).filter(|&near| near != NONE);
    let mut lacking = region.lacking(near);
    if missing.is_empty() || !lacking.is_empty() {
        return Ok(lacking);
    }
    let mut scratch = Insert::scratch(&region.mesh);
    let mut links = LinkFinder::default();
    let first = region.vertex_simplex.iter().copied().find(|&t| t != NONE);
    let mut last = first.ok_or(Aborted::Inconsistent("no vertex has a tetrahedron"))?;
    for (i, [p, near]) in std::mem::take(missing).into_iter().enumerate() {
        if i % <Triangulation3 as Insert<3>>::REPORT == 0 {
            report(1.0)?;
        }
        let start = region.vertex_simplex.get(near as usize).copied().filter(|&t| t != NONE).unwrap_or(last);
        match cavity(region, vertices, p, start) {
            Ok(start) => {
                let inserted = region.mesh.insert(vertices, p, start, &mut scratch)?;
                // No other thread holds tetrahedra, so only those of a region that is no triangulation are taken twice.
                last = inserted.ok_or(Aborted::Inconsistent("a cavity meets itself"))?;
                let star = links.star(&region.mesh, p, last)?;
                region.note(star.used().map(|triangle| triangle.tetrahedron));
            }
            Err(around) if around.is_empty() => {
                return Err(Aborted::Inconsistent("a walk to a point does not end").into());
            }
            Err(around) => {
                lacking.extend(around);
                missing.push([p, near]);
            }
        }
    }
    Insert::finish(&mut region.mesh, scratch);
    Ok(region.lacking(lacking))
}

/// Returns a tetrahedron in conflict with `p` if the region has all of them, and all their
/// neighbours; otherwise vertices whose stars have what is missing next.
fn cavity(region: &Region, vertices: &PredicateContext3<'_>, p: u32, start: u32) -> Result<u32, Vec<u32>> {
    let (mesh, here) = (&region.mesh, vertices.at(p));
    let start = walk(region, &here, start)?;
    let (mut cavity, mut next) = (vec![start], 0);
    // A map like those of the stars: a set would be compiled for itself.
    let mut seen = FxHashMap::from_iter([(start, 0u32)]);
    let mut wanted = Vec::new();
    while let Some(&t) = cavity.get(next) {
        next += 1;
        for other in mesh.neighbors[t as usize].map(|across| across >> 2) {
            if seen.insert(other, 0).is_some() && !region.is_outside(other) {
                continue;
            }
            // A ghost's conflicts can be those of the tetrahedron under it.
            let lacks = |t: u32| mesh.is_ghost(t) && region.is_outside(mesh.neighbors[t as usize][3] >> 2);
            if region.is_outside(other) {
                wanted.extend(mesh.vertices(t));
            } else if lacks(other) {
                wanted.extend(mesh.vertices(other));
            } else if in_conflict(mesh, &here, other) {
                cavity.push(other);
            }
        }
    }
    if wanted.is_empty() { Ok(start) } else { Err(wanted) }
}

/// Walks to a point as the CPU engine does. Returns the tetrahedron that contains it, or a ghost whose
/// facet sees it; otherwise the vertices of the last one before the region ends.
fn walk(region: &Region, here: &PredicatesAt<'_, '_, 3>, start: u32) -> Result<u32, Vec<u32>> {
    let mesh = &region.mesh;
    let mut t = start;
    if mesh.is_ghost(t) {
        t = mesh.neighbors[start as usize][3] >> 2;
        if region.is_outside(t) {
            return Err(mesh.vertices(start).into());
        }
    }
    // Splaying has proven what it changed. On what a device has wrongly called certain, a walk may go round.
    for _ in 0..mesh.tetrahedra.len() {
        let v = mesh.vertices(t);
        if mesh.is_ghost(t) {
            return Ok(t);
        }
        let separates = |facet: &[usize; 3]| {
            let [a, b, c] = facet.map(|i| v[i]);
            here.orient3d(a, b, c) > 0
        };
        let Some(k) = FACETS.iter().position(separates) else { return Ok(t) };
        t = mesh.neighbors[t as usize][k] >> 2;
        if region.is_outside(t) {
            return Err(v.into());
        }
    }
    Err(Vec::new())
}
