//! The plane's algorithm on the kernels' twins: proven without a GPU.
#![cfg(feature = "gpu")]

#[allow(dead_code)]
mod plane_inputs;

use gdel::gpu::phase1::Pick;
use gdel::gpu::plane::twin::predicates::Vertex;
use gdel::gpu::plane::twin::run::{Settings, run};
use gdel::gpu::plane::twin::{State, mesh_compact, mesh_mark};
use gdel::gpu::twin::hilbert::hilbert_key;
use gdel::lattice::Width;

/// Distinct points along the Hilbert curve, with the places of their input order.
fn sites(points: &[[i64; 2]]) -> Vec<Vertex> {
    let mut distinct: Vec<[i64; 2]> = Vec::new();
    for p in points {
        if !distinct.contains(p) {
            distinct.push(*p);
        }
    }
    let mut sites: Vec<Vertex> = (0..).zip(distinct).map(|(index, position)| Vertex { position, index }).collect();
    sites.sort_by_key(|v| hilbert_key(v.position.map(|x| (x & 0x7fff) as u32)));
    sites
}

fn valid(points: &[[i64; 2]], settings: Settings) -> State {
    let sites = sites(points);
    let count = sites.len();
    let state = run(Width::Narrow, sites, &Settings { validate: true, ..settings }).expect("not collinear");
    assert_eq!(state.counters.inserted as usize, count);
    state.validate_end();
    let marks = mesh_mark(&state);
    let offsets: Vec<u32> = marks.iter().scan(0, |sum, &m| Some(std::mem::replace(sum, *sum + m))).collect();
    let mesh = mesh_compact(&state, &offsets);
    // Euler: a triangulation of a polygon.
    assert_eq!(mesh.triangles.len() + mesh.hull.len() + 2, 2 * count);
    let (halfedges, from) = (mesh.halfedges.as_flattened(), mesh.triangles.as_flattened());
    let to = |e: usize| from[e / 3 * 3 + (e + 1) % 3];
    for (e, &against) in halfedges.iter().enumerate().filter(|&(_, &against)| against >= 0) {
        assert_eq!(halfedges[against as usize], e as i32);
        assert_eq!([from[e], to(e)], [to(against as usize), from[against as usize]]);
    }
    state
}

#[test]
fn every_phase_is_valid() {
    for (name, points) in plane_inputs::all() {
        println!("{name}");
        for pick in [Pick::Circumcenter, Pick::Centroid, Pick::Random] {
            valid(&points, Settings { pick, ..Settings::default() });
        }
        valid(&points, Settings { insert_all: true, ..Settings::default() });
        valid(&points, Settings { min_active: 30, history: 20, ..Settings::default() });
    }
}
