//! Both phases, without a GPU: the reference implementations of the kernels make the triangulation
//! that is splayed.

use crate::{check, exact, flips::flat_or_inverted, inputs, inputs::Cloud};
use gdel::{
    NONE,
    internals::{
        d3::{splay::NearDelaunay3, triangulation::Triangulation3},
        input::lattice::{Lattice, Width},
        predicates::filter::{PredicateContext, PredicateContext3},
    },
    stats::SplayStats,
};
use gdel_reference::{
    self as reference,
    d3::predicates::Vertex,
    run::{Settings, run},
};

/// Returns the triangulation without the gaps between tetrahedra, and what has failed; flat
/// tetrahedra are uncertain.
fn near(state: &reference::State<3>, vertices: &PredicateContext3<'_>) -> NearDelaunay3 {
    let used: Vec<usize> = (0..state.simplices.len()).filter(|&t| state.is_used(t)).collect();
    let mut number = vec![NONE; state.simplices.len()];
    used.iter().zip(0..).for_each(|(&t, n)| number[t] = n);
    let infinite = vertices.len() as u32;
    // The order of the vertices that puts infinity last: two exchanges keep the orientation.
    let order = |t: usize| match state.simplices[t].iter().position(|&v| v == infinite) {
        Some(0) => [3, 2, 1, 0],
        Some(1) => [2, 3, 0, 1],
        Some(2) => [1, 0, 3, 2],
        _ => [0, 1, 2, 3],
    };
    let tetrahedra: Vec<[u32; 4]> = used.iter().map(|&t| order(t).map(|k| state.simplices[t][k])).collect();
    let renumbered = |across: u32| {
        let (u, face) = (across as usize / 4, across as usize % 4);
        // Each of these orders is its own inverse.
        4 * number[u] + order(u)[face] as u32
    };
    let neighbors = used.iter().map(|&t| order(t).map(|k| renumbered(state.neighbors[t][k]))).collect();
    let mut vertex_simplex = vec![NONE; vertices.len() + 1];
    // A ghost where there is one.
    for ghosts in [false, true] {
        let some = (0..).zip(&tetrahedra).filter(|(_, t)| (t[3] == infinite) == ghosts);
        some.for_each(|(n, t)| t.iter().for_each(|&v| vertex_simplex[v as usize] = n));
    }
    let triangulation = Triangulation3::new(tetrahedra, neighbors, infinite);
    let uncertain = flat_or_inverted(&triangulation, vertices);
    let failed = (0..vertices.len() as u32).filter(|&v| state.own.failed[v as usize] != 0).collect();
    NearDelaunay3 { triangulation, vertex_simplex, failed, uncertain, missing: Vec::new() }
}

fn both_phases(name: &str, points: &Cloud, settings: &Settings) -> SplayStats {
    // Integers, so that the lattice is narrow, in the order of their first coordinate.
    let mut indices: Vec<u32> = (0..points.len() as u32).collect();
    indices.sort_by(|&i, &j| points[i as usize].partial_cmp(&points[j as usize]).unwrap());
    let lattice = Lattice::fit(points.into());
    assert_eq!(lattice.width(), Width::Narrow);
    let position = |i: u32| lattice.coordinates(points[i as usize]).map(|c| c.value);
    let sites = indices.iter().map(|&index| Vertex { position: position(index), index }).collect();
    let state = run(Width::Narrow, sites, settings).expect("not flat");
    let answer = exact(points, &indices);
    let vertices = PredicateContext::new(points.into(), &lattice, indices);
    check(name, &vertices, near(&state, &vertices), &answer)
}

fn on_integers(points: &Cloud, steps: f64) -> Cloud {
    inputs::distinct(points.iter().map(|p| p.map(|x| (x * steps).round())).collect())
}

#[test]
fn phase_1_and_splaying_make_the_exact_triangulation() {
    let mut failed = 0;
    for seed in 0..3 {
        let clouds = [
            ("uniform", on_integers(&inputs::uniform(800, seed), 1e6)),
            ("sphere", on_integers(&inputs::sphere(800, seed), 1e6)),
            ("thin sphere", on_integers(&inputs::thin_sphere(800, seed), 1e6)),
            ("clusters", on_integers(&inputs::clusters(500, seed), 1e6)),
            ("prism", on_integers(&inputs::prism(500, seed), 32.0)),
            ("skew lines", on_integers(&inputs::skew_lines(60, seed), 1e6)),
            ("grid sample", inputs::grid_sample(600, 9, seed)),
            ("grid", inputs::grid(7)),
        ];
        for (name, points) in &clouds {
            for insert_all in [false, true] {
                let settings = Settings { insert_all, ..Settings::default() };
                failed += both_phases(&format!("{name}, insert all: {insert_all}"), points, &settings).failed;
            }
        }
    }
    assert!(failed > 0);
}
