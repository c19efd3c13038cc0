//! What rounding to the lattice leaves open is listed, and all that is not listed is true.

use std::collections::HashMap;

use gdel::internals::Options;
use gdel::internals::gpu::host::Here;
use gdel::internals::gpu::phase1::{Phase1, Settings};
use gdel::internals::gpu::start::first_simplex;
use gdel::internals::gpu::{AdapterChoice, Gpu};
use gdel::internals::input::lattice::{Lattice, Width};
use gdel::internals::predicates;
use gdel_reference::d3::predicates::{self as reference, Vertex};
use pollster::block_on;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

#[test]
fn signs_that_are_not_listed_are_those_of_the_true_coordinates() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let mut points: Vec<[f64; 3]> = (0..400).map(|_| std::array::from_fn(|_| rng.random())).collect();
    // So near to each other that the lattice has few steps between them, and rounds them all.
    points.extend((0..300).map(|_| -> [f64; 3] { std::array::from_fn(|_| rng.random::<f64>() * 2e-17) }));
    let lattice = Lattice::fit((&points).into());
    assert_eq!(lattice.width(), Width::Wide);
    let position = |i: usize| lattice.coordinates(points[i]).map(|c| c.value);
    let start = first_simplex(Width::Wide, points.len(), position).expect("not coplanar");
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = block_on(Phase1::new(&gpu, Width::Wide)).unwrap();
    let options = Options::default();
    let mut host = Here::new((&points).into(), &options, Default::default());
    let output = block_on(kernels.run(&gpu, &mut host, &Settings::default(), None)).unwrap().result;

    let infinite = points.len() as u32;
    let open: HashMap<u32, u32> = output.uncertain.iter().map(|&[t, open]| (t, open)).collect();
    let is_open = |t: usize, bit: usize| open.get(&(t as u32)).is_some_and(|open| open >> bit & 1 != 0);
    let truth = |v: u32| points[v as usize];
    let on_lattice = |v: u32| Vertex { position: position(v as usize), index: v };
    let (mut wrong, mut proven) = (0, 0);
    for (t, tet) in output.tets.iter().enumerate() {
        if tet.contains(&infinite) {
            continue;
        }
        let [a, b, c, d] = tet.map(truth);
        if !is_open(t, 4) {
            proven += 1;
            let interior = Vertex { position: start.interior_point, index: infinite };
            let on_lattice = reference::orient3d(Width::Wide, tet.map(on_lattice), interior);
            assert_eq!(predicates::orient3d(a, b, c, d), on_lattice);
        } else if predicates::orient3d(a, b, c, d) < 0 {
            wrong += 1;
        }
        for (k, across) in output.neighbors[t].iter().enumerate() {
            let (u, e) = ((across >> 2) as usize, output.tets[(across >> 2) as usize][(across & 3) as usize]);
            // Listed with one of the two.
            if u < t || e == infinite || is_open(t, k) || is_open(u, (across & 3) as usize) {
                continue;
            }
            proven += 1;
            let [p, q, r, s] = tet.map(on_lattice);
            // Where it is not zero, nothing else matters.
            let any = Vertex { index: u32::MAX, ..p };
            let lattice_sign = reference::insphere(Width::Wide, [p, q, r, s, on_lattice(e)], [0; 5], any);
            let sign = predicates::insphere(a, b, c, d, truth(e));
            assert!(sign == 0 || sign == lattice_sign, "tetrahedron {t} facet {k}");
        }
    }
    assert!(wrong > 0, "the lattice misleads nobody here");
    assert!(proven > 4000 && !open.is_empty());
}
