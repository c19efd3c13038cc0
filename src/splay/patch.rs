//! Patching (§3.2.3): the tetrahedra T⁻ of the triangulation make room for T⁺; nothing else is touched.
//!
//! Facets find each other by their vertices: those around the holes that T⁻ leaves, and those of T⁺. Where every facet of
//! T⁺ finds its like, T⁺ fills the holes; since all of T⁺ is positively oriented, it fills them once; and where every
//! facet of T⁺ is locally Delaunay, as the facets elsewhere are, the whole is Delaunay. All of this is checked.

use super::{GaveUp, Stop, consistency::Key, space::Space};
use crate::{
    mesh::FACETS,
    triangulation::{Triangulation, state},
};
use rustc_hash::FxHashMap;

const UNMATCHED: GaveUp = GaveUp::Inconsistent("a facet of the patch has no neighbour");

/// Replaces the tetrahedra in the slots `remove` by `add`. `free` has unused slots, before and after; gives the slots of
/// the new tetrahedra.
pub(super) fn patch(
    mesh: &mut Triangulation,
    space: &Space<'_>,
    remove: &[u32],
    add: &[Key],
    free: &mut Vec<u32>,
) -> Result<Vec<u32>, Stop> {
    let mut open: FxHashMap<[u32; 3], u32> = FxHashMap::default();
    open.reserve(2 * add.len());
    for &t in remove {
        mesh.set_state(t, state::FREE);
    }
    for &t in remove {
        let v = mesh.vertices(t);
        for k in 0..4 {
            let across = mesh.neighbors[t as usize][k];
            if mesh.state(across >> 2) != state::FREE {
                open.insert(facet(v, k), across);
            }
        }
    }
    free.extend(remove.iter().rev());
    let mut filled = Vec::with_capacity(add.len());
    for &v in add {
        if space.orient(v) <= 0 {
            return Err(GaveUp::Inconsistent("the patch has a tetrahedron that is not positively oriented").into());
        }
        let slot = match free.pop() {
            Some(slot) => slot,
            None => mesh.push()?,
        };
        filled.push(slot);
        mesh.tetrahedra[slot as usize] = v;
        for k in 0..4 {
            let name = 4 * slot + k as u32;
            match open.remove(&facet(v, k)) {
                Some(other) => mesh.join(name, other),
                None => {
                    open.insert(facet(v, k), name);
                }
            }
        }
    }
    if !open.is_empty() {
        return Err(UNMATCHED.into());
    }
    for &t in &filled {
        for k in 0..4 {
            if !is_locally_delaunay(mesh, space, t, k) {
                return Err(GaveUp::Inconsistent("the patch is not Delaunay").into());
            }
        }
    }
    Ok(filled)
}

/// Whether the vertex across facet `k` lies outside the circumsphere of tetrahedron `t`.
pub(super) fn is_locally_delaunay(mesh: &Triangulation, space: &Space<'_>, t: u32, k: usize) -> bool {
    let across = mesh.neighbors[t as usize][k];
    let apex = mesh.vertices(across >> 2)[across as usize & 3];
    space.conflict(mesh.vertices(t), apex) < 0
}

/// The vertices of facet `k`, in ascending order.
fn facet(v: [u32; 4], k: usize) -> [u32; 3] {
    let mut facet = FACETS[k].map(|i| v[i]);
    facet.sort_unstable();
    facet
}
