//! Splaying of a triangulation that is elsewhere: only the stars that splaying asks for are
//! gathered, and what it changes is written back.

use crate::{inputs, verified};
use gdel::{
    NONE,
    internals::{
        d3::{
            splay::{Doubts, NearDelaunay3, Patch, Region, Splay, Stop, Terms},
            triangulation::Triangulation3,
        },
        parallel::Threads,
        predicates::filter::PredicateContext3,
    },
    stats::SplayStats,
};
use gdel_reference::d3::gather::{self, Mesh};

/// The triangulation elsewhere, the region of it that is here, and what may be wrong.
pub struct Elsewhere {
    pub mesh: Mesh,
    pub region: Region,
    pub doubts: Doubts,
}

/// Gathers what splaying begins with, in the memory of a region, if there is one.
pub fn elsewhere(near: NearDelaunay3, kept: Option<Region>) -> Elsewhere {
    let NearDelaunay3 { triangulation, vertex_simplex, failed, uncertain, missing } = near;
    let infinite = triangulation.infinite();
    let mut mesh = Mesh::new(triangulation.tetrahedra().to_vec(), triangulation.neighbors().to_vec(), infinite);
    let corners = |&t: &u32| mesh.tetrahedra[t as usize];
    let mut wanted: Vec<u32> = uncertain.iter().flat_map(corners).chain(failed.iter().copied()).collect();
    wanted.retain(|&v| v != infinite);
    let mut region = Region::again(kept, infinite as usize, Threads::All);
    let gathered = mesh.gather(&wanted, region.next());
    region.add(wanted, gathered, Threads::All).unwrap();
    let uncertain = uncertain.iter().map(|&t| mesh.region_numbers[t as usize]).collect();
    // A vertex that is not missing: as if each were at the place of the one before it.
    let there = (0..infinite).find(|&v| vertex_simplex[v as usize] != NONE).unwrap();
    let missing = missing.into_iter().map(|v| [v, there]).collect();
    Elsewhere { mesh, region, doubts: Doubts { failed, uncertain, missing } }
}

/// Returns what splaying changes, the region, and what splaying did.
pub fn patch(name: &str, vertices: &PredicateContext3<'_>, elsewhere: Elsewhere) -> (Mesh, Patch, Region, SplayStats) {
    let Elsewhere { mut mesh, region, doubts } = elsewhere;
    let terms = Terms::unlimited(Threads::All);
    let splayed = || -> Result<_, Stop> {
        let mut splay = Splay::begin(vertices, region, doubts, terms)?;
        loop {
            let lacking = splay.advance(vertices, terms)?;
            if lacking.is_empty() {
                return Ok(splay.finish());
            }
            let gathered = mesh.gather(&lacking, splay.region().next());
            splay.add(lacking, gathered)?;
        }
    };
    let (region, stats) = splayed().unwrap_or_else(|stop| panic!("{name}: {stop:?}"));
    let patch = region.patch(mesh.tetrahedra.len(), Threads::All);
    (mesh, patch, region, stats)
}

/// Returns the tetrahedra that splaying gives, which the verifier must accept. The region is left in place of the
/// one that is there.
pub fn splayed(
    name: &str,
    vertices: &PredicateContext3<'_>,
    near: NearDelaunay3,
    kept: &mut Option<Region>,
) -> (Vec<[u32; 4]>, SplayStats) {
    let (mut mesh, patch, region, stats) = patch(name, vertices, elsewhere(near, kept.take()));
    *kept = Some(region);
    gather::patch(&mut mesh, &patch);
    let mut triangulation = Triangulation3::new(mesh.tetrahedra, mesh.neighbors, mesh.infinite);
    triangulation.discard_unused();
    (verified(name, vertices, triangulation), stats)
}

#[test]
fn only_what_is_needed_is_gathered() {
    let points = inputs::uniform(20_000, 30);
    let indices: Vec<u32> = (0..points.len() as u32).collect();
    let lattice = gdel::internals::input::lattice::Lattice::fit((&points).into());
    let vertices = gdel::internals::predicates::filter::PredicateContext::of_input((&points).into(), &lattice);
    let mut soup = crate::Soup::new(&vertices, &crate::exact(&points, &indices));
    assert!((0..100).any(|slot| (0..4).any(|k| soup.flip(slot, k))));
    let near = crate::found_out(&vertices, &soup.finish());
    let tetrahedra = near.triangulation.tetrahedra().len();
    let (mesh, patch, _, stats) = patch("one flip", &vertices, elsewhere(near, None));
    assert!(stats.removed > 0 && stats.added > 0, "{stats:?}");
    let gathered = mesh.region_numbers.iter().filter(|&&number| number != 0).count();
    assert!(gathered < 500 && patch.slots.len() < 50, "{gathered} gathered, {} patched", patch.slots.len());
    assert!(patch.len.abs_diff(tetrahedra) < 5);
}

/// A region in the memory of another one has nothing of it, whether or not it is for as many vertices.
#[test]
fn regions_leave_their_memory_to_others() {
    let mut kept = None;
    for (count, seed) in [(3_000, 1), (3_000, 2), (2_000, 3), (3_000, 1)] {
        let points = inputs::uniform(count, seed);
        let indices: Vec<u32> = (0..count as u32).collect();
        let lattice = gdel::internals::input::lattice::Lattice::fit((&points).into());
        let vertices = gdel::internals::predicates::filter::PredicateContext::of_input((&points).into(), &lattice);
        let mut soup = crate::Soup::new(&vertices, &crate::exact(&points, &indices));
        let flips = (0..1_000).filter(|&slot| (0..4).any(|k| soup.flip(slot, k))).count();
        let near = crate::found_out(&vertices, &soup.finish());
        let name = format!("{count} points with {flips} flips");
        let (fresh, stats) = splayed(&name, &vertices, near.clone(), &mut None);
        assert!(flips > 100 && stats.built > 100, "{name}: {stats:?}");
        let (again, stats_again) = splayed(&name, &vertices, near, &mut kept);
        assert_eq!((again, stats_again), (fresh, stats), "{name}");
    }
}
