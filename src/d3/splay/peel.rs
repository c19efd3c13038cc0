//! Peeling: flat tetrahedra on the hull are replaced by ghosts on their other side. Phase 1 leaves
//! such tetrahedra where the hull has coplanar points, because there it decides by a perturbation
//! of the coordinates.
//!
//! A flat tetrahedron under one facet of the hull has its fourth vertex inside that facet: the
//! tetrahedron and the ghost are flipped into three ghosts. A flat tetrahedron under two facets of
//! the hull is flipped, with their ghosts, into two ghosts. Each flip peels one tetrahedron, so
//! peeling ends. A flip must not put on the hull what is already there, which can happen where
//! tetrahedra are flat in the exact coordinates only. What cannot be peeled is left to the stars.

use crate::d3::splay::{
    TETRAHEDRON_GRAIN,
    predicates::{StarPredicates, replaced},
};
use crate::{
    d3::triangulation::{Triangulation3, state},
    error::Error,
    parallel::Threads,
    slots::Slots,
};
use rustc_hash::FxHashMap;

/// Peels the tetrahedra of `flat` that can be peeled; the others are left in it. Returns the slots
/// of new ghosts, some of which may have been replaced again.
///
/// `vertex_simplex` has a tetrahedron of each vertex, before and after, and a ghost of each vertex on the
/// hull. All threads evaluate predicates, one thread flips.
pub(super) fn peel(
    mesh: &mut Triangulation3,
    predicates: &StarPredicates<'_>,
    threads: Threads,
    flat: &mut Vec<u32>,
    vertex_simplex: &mut [u32],
    free: &mut Vec<u32>,
) -> Result<Vec<u32>, Error> {
    let sides = predicates.shared(threads, flat.len(), TETRAHEDRON_GRAIN, |predicates, range| {
        flat[range].iter().map(|&t| sides(mesh, predicates, t)).collect::<Vec<_>>()
    });
    let mut left: FxHashMap<u32, Sides> = flat.iter().copied().zip(sides.into_iter().flatten()).collect();
    let mut made = Vec::new();
    // Flat tetrahedra lie on top of each other: the one that a peeled tetrahedron covered comes
    // next.
    let mut next = Vec::new();
    loop {
        let before = left.len();
        for &t in flat.iter() {
            next.push(t);
            while let Some(t) = next.pop() {
                let Some(&sides) = left.get(&t) else { continue };
                let start = made.len();
                peel_one(mesh, t, sides, vertex_simplex, free, &mut made)?;
                if made.len() == start {
                    continue;
                }
                left.remove(&t);
                next.extend(made[start..].iter().map(|&ghost| mesh.neighbors[ghost as usize][3] >> 2));
            }
        }
        flat.retain(|t| left.contains_key(t));
        if left.is_empty() || left.len() == before {
            return Ok(made);
        }
    }
}

/// For each facet of a flat tetrahedron, whether a ghost in its place, on that facet, would not be
/// inverted.
type Sides = u32;

/// Returns the sides of flat tetrahedron `t`.
fn sides(mesh: &Triangulation3, predicates: &StarPredicates<'_>, t: u32) -> Sides {
    let v = mesh.vertices(t);
    let is_outer = |&k: &usize| predicates.orient(replaced(v, k, mesh.infinite)) >= 0;
    (0..4).filter(is_outer).map(|k| 1 << k).sum()
}

/// Peels one flat tetrahedron, and lists the new ghosts, if it lies under one or two facets of the
/// hull and the new ghosts fit.
fn peel_one(
    mesh: &mut Triangulation3,
    t: u32,
    sides: Sides,
    vertex_simplex: &mut [u32],
    free: &mut Vec<u32>,
    made: &mut Vec<u32>,
) -> Result<(), Error> {
    let v = mesh.vertices(t);
    let across = mesh.neighbors[t as usize];
    let mut covers = (0..4).filter(|&k| mesh.is_ghost(across[k] >> 2));
    let Some(x) = covers.next() else { return Ok(()) };
    let (y, more) = (covers.next(), covers.next());
    if more.is_some() {
        return Ok(());
    }
    let ghost = across[x] >> 2;
    let g = mesh.vertices(ghost);
    let beyond = mesh.neighbors[ghost as usize];
    // The corners of t at which the ghost's corners are, and the ghost with x in place of corner i.
    let in_t: [usize; 3] = std::array::from_fn(|i| v.iter().position(|&w| w == g[i]).unwrap_or(x));
    let moved = |i: usize| replaced(g, i, v[x]);
    let fits = |i: usize| sides >> in_t[i] & 1 != 0;
    match y {
        None => {
            if !(0..3).all(fits) || mesh.is_ghost(vertex_simplex[v[x] as usize]) {
                return Ok(());
            }
            let slots = [ghost, t, take(mesh, free)?];
            for (i, slot) in slots.into_iter().enumerate() {
                mesh.tetrahedra[slot as usize] = moved(i);
            }
            for (i, slot) in slots.map(|slot| 4 * slot).into_iter().enumerate() {
                mesh.join(slot + 3, across[in_t[i]]);
                mesh.join(slot + i as u32, beyond[i]);
                let j = (i + 1) % 3;
                mesh.join(slot + j as u32, 4 * slots[j] + i as u32);
            }
            // Only these vertices are no longer in the slot recorded for them, or were not on the
            // hull.
            vertex_simplex[g[0] as usize] = slots[1];
            vertex_simplex[v[x] as usize] = ghost;
            made.extend(slots);
        }
        Some(y) => {
            // The ghosts (y, a, b, ∞) and (x, b, a, ∞) become (y, x, b, ∞) and (y, a, x, ∞).
            let Some(iy) = in_t.iter().position(|&k| k == y) else { return Ok(()) };
            let (ia, ib) = ((iy + 1) % 3, (iy + 2) % 3);
            let other = across[y] >> 2;
            if beyond[iy] >> 2 != other || !fits(ia) || !fits(ib) || is_hull_edge(mesh, t, x, y) {
                return Ok(());
            }
            let o = mesh.vertices(other);
            let beyond_other = |w: u32| o.iter().position(|&u| u == w).map(|k| mesh.neighbors[other as usize][k]);
            let (Some(by_a), Some(by_b)) = (beyond_other(g[ia]), beyond_other(g[ib])) else { return Ok(()) };
            mesh.tetrahedra[ghost as usize] = moved(ia);
            mesh.tetrahedra[other as usize] = moved(ib);
            for (slot, at, outer) in [(ghost, ia, by_a), (other, ib, by_b)] {
                // Vertex g[at] is no longer here: x has its corner.
                mesh.join(4 * slot + 3, across[in_t[at]]);
                mesh.join(4 * slot + at as u32, beyond[at]);
                mesh.join(4 * slot + iy as u32, outer);
            }
            mesh.join(4 * ghost + ib as u32, 4 * other + ia as u32);
            vertex_simplex[g[ia] as usize] = other;
            vertex_simplex[g[ib] as usize] = ghost;
            mesh.set_state(t, state::FREE);
            free.push(t);
            made.extend([ghost, other]);
        }
    }
    Ok(())
}

/// Returns whether the edge from corner `x` to corner `y` of tetrahedron `t` is an edge of the
/// hull.
fn is_hull_edge(mesh: &Triangulation3, t: u32, x: usize, y: usize) -> bool {
    let (vx, vy) = (mesh.vertices(t)[x], mesh.vertices(t)[y]);
    let mut at = t;
    let mut through = (0..4).find(|&k| k != x && k != y).unwrap_or(0);
    // Around the edge: out through the one facet at it that was not the way in.
    for _ in 0..mesh.tetrahedra.len() {
        let across = mesh.neighbors[at as usize][through];
        at = across >> 2;
        if at == t {
            return false;
        }
        if mesh.is_ghost(at) {
            return true;
        }
        let corners = mesh.vertices(at);
        let out = (0..4).find(|&k| k != across as usize % 4 && corners[k] != vx && corners[k] != vy);
        through = out.unwrap_or(0);
    }
    // That is no triangulation; the edge is left as it is.
    true
}

/// Returns an unused slot.
fn take(mesh: &mut Triangulation3, free: &mut Vec<u32>) -> Result<u32, Error> {
    free.pop().map_or_else(|| mesh.push(), Ok)
}
