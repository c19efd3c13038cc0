//! Patching (§3.2.3): the tetrahedra T⁻ of the triangulation are replaced by T⁺; nothing else is
//! touched.
//!
//! Facets are matched by their vertices: those around the holes that T⁻ leaves, and those of T⁺. If
//! every facet of T⁺ is matched, T⁺ fills the holes. Since all of T⁺ is positively oriented, it
//! fills them once. And if every facet of T⁺ is locally Delaunay, as the facets elsewhere are, the
//! whole is Delaunay. All of this is checked.

use crate::d3::splay::{
    Aborted, Stop, TETRAHEDRON_GRAIN,
    ledger::{Key, mixed},
    predicates::StarPredicates,
};
use crate::{
    d3::{
        mesh::FACETS,
        triangulation::{Triangulation3, state},
    },
    parallel::{self, Threads},
    slots::{self, Slots},
};
use std::sync::atomic::Ordering::Relaxed;

/// The number of facets that a thread matches at a time, each with the other one.
const FACET_GRAIN: usize = 1 << 10;

/// Replaces the tetrahedra in the slots `remove` by `add`. `free` lists the unused slots, before
/// and after. Returns the slots of the new tetrahedra.
pub(super) fn patch(
    mesh: &mut Triangulation3,
    predicates: &StarPredicates<'_>,
    threads: Threads,
    remove: &[u32],
    add: &[Key],
    free: &mut Vec<u32>,
) -> Result<Vec<u32>, Stop> {
    for &t in remove {
        mesh.set_state(t, state::FREE);
    }
    // Each facet comes twice: from inside the patch, and from what is across.
    let around = parallel::map_grains(threads, remove.len(), TETRAHEDRON_GRAIN, |range| {
        let facets = remove[range].iter().flat_map(|&t| (0..4).map(move |k| (t, k)));
        let outer = facets.filter_map(|(t, k)| {
            let across = mesh.neighbors[t as usize][k];
            (mesh.state(across >> 2) != state::FREE).then(|| facet(mesh.vertices(t), k, across))
        });
        outer.collect::<Vec<_>>()
    });
    let mut facets: Vec<[u32; 4]> = around.concat();
    facets.reserve(4 * add.len());
    free.extend(remove.iter().rev());
    let mut filled = Vec::with_capacity(add.len());
    for &v in add {
        let slot = match free.pop() {
            Some(slot) => slot,
            None => mesh.push()?,
        };
        filled.push(slot);
        mesh.tetrahedra[slot as usize] = v;
        facets.extend((0..4).map(|k| facet(v, k, 4 * slot + k as u32)));
    }
    let key = |facet: &[u32; 4]| mixed(&facet[..3]);
    let keys = facets.iter().map(key).collect();
    parallel::sort_by_keys(threads, &mut facets, keys);
    // Others may have the same key.
    let groups: Vec<&[[u32; 4]]> = facets.chunk_by(|f, g| key(f) == key(g)).collect();
    let neighbors = slots::share(std::mem::take(&mut mesh.neighbors).into_flattened());
    let matched = parallel::map_grains(threads, groups.len(), FACET_GRAIN, |range| {
        groups[range].iter().all(|facets| {
            facets.iter().all(|f| {
                let mut others = facets.iter().filter(|g| g[..3] == f[..3] && g[3] != f[3]);
                let only = others.next().filter(|_| others.next().is_none());
                only.inspect(|g| neighbors[f[3] as usize].store(g[3], Relaxed)).is_some()
            })
        })
    });
    mesh.neighbors = bytemuck::cast_vec(slots::unshare(neighbors));
    if matched.contains(&false) {
        return Err(Aborted::Inconsistent("a facet of the patch has not one neighbour").into());
    }
    let mesh = &*mesh;
    let checked = predicates.shared(threads, filled.len(), TETRAHEDRON_GRAIN, |predicates, range| {
        filled[range].iter().try_for_each(|&t| {
            if predicates.orient(mesh.vertices(t)) <= 0 {
                return Err(Aborted::Inconsistent("the patch has a tetrahedron that is not positively oriented"));
            }
            let is_delaunay = (0..4).all(|k| is_locally_delaunay(mesh, predicates, t, k));
            if is_delaunay { Ok(()) } else { Err(Aborted::Inconsistent("the patch is not Delaunay")) }
        })
    });
    checked.into_iter().collect::<Result<(), Aborted>>()?;
    Ok(filled)
}

/// Returns whether the vertex across facet `k` lies outside the circumsphere of tetrahedron `t`.
pub(super) fn is_locally_delaunay(mesh: &Triangulation3, predicates: &StarPredicates<'_>, t: u32, k: usize) -> bool {
    let across = mesh.neighbors[t as usize][k];
    let apex = mesh.vertices(across >> 2)[across as usize & 3];
    predicates.conflict(mesh.vertices(t), apex) < 0
}

/// Returns the vertices of facet `k`, in ascending order, and the number of the facet.
fn facet(v: [u32; 4], k: usize, number: u32) -> [u32; 4] {
    let [mut a, mut b, mut c] = FACETS[k].map(|i| v[i]);
    (a, b) = (a.min(b), a.max(b));
    (b, c) = (b.min(c), b.max(c));
    (a, b) = (a.min(b), a.max(b));
    [a, b, c, number]
}
