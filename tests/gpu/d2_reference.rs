//! The 2D algorithm on the kernels' references: proven without a GPU.

use std::collections::HashSet;

use gdel::internals::gpu::layout::Pick;
use gdel::internals::input::lattice::Width;
use gdel_reference::d2::predicates::Vertex;
use gdel_reference::d2::{mesh_compact, mesh_mark};
use gdel_reference::hilbert::hilbert_key;
use gdel_reference::run::{Settings, run};
use rand::{SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg32;

type State = gdel_reference::State<2>;

/// Distinct points along the Hilbert curve, with the places of their input order.
fn sites(points: &[[i64; 2]]) -> Vec<Vertex> {
    let mut seen = HashSet::new();
    let distinct = points.iter().copied().filter(|p| seen.insert(*p));
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
    let numbers: Vec<u32> = marks.iter().scan(0, |sum, &m| Some(std::mem::replace(sum, *sum + m))).collect();
    let mesh = mesh_compact(&state, &numbers);
    // Euler: a triangulation of a polygon.
    assert_eq!(mesh.triangles.len() + mesh.hull.len() + 2, 2 * count);
    let (halfedges, from) = (mesh.halfedges.as_flattened(), mesh.triangles.as_flattened());
    let to = |e: usize| from[e / 3 * 3 + (e + 1) % 3];
    for (e, &against) in halfedges.iter().enumerate().filter(|&(_, &against)| against != gdel::NONE) {
        assert_eq!(halfedges[against as usize], e as u32);
        assert_eq!([from[e], to(e)], [to(against as usize), from[against as usize]]);
    }
    state
}

#[test]
fn every_phase_is_valid() {
    for (name, points) in crate::d2_inputs::all() {
        println!("{name}");
        for pick in [Pick::Circumcenter, Pick::Centroid, Pick::Random] {
            valid(&points, Settings { pick, ..Settings::default() });
        }
        valid(&points, Settings { insert_all: true, ..Settings::default() });
        valid(&points, Settings { min_active: 30, history: 20, ..Settings::default() });
    }
}

/// Collinear points on the hull are inserted in rounds that grow as the logarithm of their number,
/// whatever the perturbation of their coordinates makes of them: inside of the hull, outside of it,
/// or within flat triangles.
#[test]
fn rounds_on_grids_and_lines() {
    let grid = |side: i64| -> Vec<[i64; 2]> { (0..side * side).map(|i| [i % side, i / side]).collect() };
    let shapes: Vec<(&str, Vec<[i64; 2]>)> = vec![
        ("grid", grid(48)),
        ("slanted grid", grid(48).into_iter().map(|[x, y]| [3 * x - y + 48, x + 3 * y]).collect()),
        ("ribbon", (0..1600).map(|i| [i % 800, i / 800]).collect()),
        ("line and a point", (0..800).map(|i| [i, 0]).chain([[300, 500]]).collect()),
        ("saw", (0..800).map(|i| [i, 5 * (i % 2) * (i % 10)]).collect()),
        ("diagonal and a point", (0..800).map(|i| [i, i]).chain([[0, 9]]).collect()),
    ];
    for (name, points) in shapes {
        let n = points.len();
        // In order, in reverse, from both ends, in ten sweeps that take turns, and in two random
        // orders.
        let mut orders: Vec<Vec<usize>> = vec![(0..n).collect(); 6];
        orders[1].reverse();
        orders[2].iter_mut().for_each(|i| *i = if *i % 2 == 0 { *i / 2 } else { n - 1 - *i / 2 });
        orders[3].sort_by_key(|i| (i % (n / 10 + 1), i / (n / 10 + 1)));
        orders[4].shuffle(&mut Pcg32::seed_from_u64(1));
        orders[5].shuffle(&mut Pcg32::seed_from_u64(2));
        for (k, order) in orders.into_iter().enumerate() {
            let points: Vec<[i64; 2]> = order.into_iter().map(|i| points[i].map(|x| 4 * x)).collect();
            let state = run(Width::Narrow, sites(&points), &Settings::default()).expect("not collinear");
            state.validate_end();
            let rounds = state.counters.round;
            println!("{name}, order {k}: {rounds} rounds");
            assert!(f64::from(rounds) <= 1.5 * (n as f64).log2() + 4.0, "{name}, order {k}: {rounds} rounds");
        }
    }
}
