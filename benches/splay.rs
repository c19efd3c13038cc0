//! Star splaying of a triangulation that is about as far from Delaunay as Phase 1 leaves it: 0.12 % failed vertices.

#[path = "../tests/splay/flips.rs"]
#[allow(dead_code)]
mod flips;

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use gdel::{
    Options, cpu,
    lattice::Lattice,
    predicates::vertices::Vertices,
    splay::{Outcome, splay},
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Uniform points, sorted by cubes as Phase 1 sorts them along its curve.
fn uniform(n: usize) -> Vec<[f64; 3]> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut points: Vec<[f64; 3]> = (0..n).map(|_| rng.random()).collect();
    let morton = |p: &[f64; 3]| {
        let q = p.map(|x| (x * 1024.0) as u64);
        (0..10)
            .fold(0, |key, bit| key | q.iter().zip(0..).fold(0, |k, (x, axis)| k | (x >> bit & 1) << (3 * bit + axis)))
    };
    points.sort_by_cached_key(morton);
    points
}

fn benchmark(c: &mut Criterion) {
    let mut group = c.benchmark_group("splay");
    group.sample_size(10);
    for n in [100_000, 1_000_000] {
        let points = uniform(n);
        let mut rng = Pcg64Mcg::seed_from_u64(2);
        // The Delaunay triangulation of points that are a little off.
        let off = 3.5e-5 / (n as f64).cbrt();
        let displaced: Vec<_> = points.iter().map(|p| p.map(|x| x + off * (rng.random::<f64>() - 0.5))).collect();
        let mesh = cpu::delaunay3d((&displaced).into(), &Options::default()).expect("finite points");
        let lattice = Lattice::fit((&points).into());
        let vertices = Vertices::new((&points).into(), &lattice, (0..n as u32).collect());
        // Phase 1 keeps tetrahedra near their vertices.
        let mut tetrahedra = mesh.tetrahedra;
        tetrahedra.sort_unstable_by_key(|t| t.iter().min().copied());
        let near = flips::found_out(&vertices, &flips::near(n as u32, &tetrahedra));
        if let Ok(Outcome::Delaunay(_, stats)) = splay(&vertices, near.clone(), u64::MAX, 4, &|_| Ok(())) {
            println!("{stats:?}");
        }
        group.bench_function(BenchmarkId::new("uniform", n), |b| {
            let run = |near| splay(&vertices, near, u64::MAX, 4, &|_| Ok(()));
            b.iter_batched(|| near.clone(), run, BatchSize::PerIteration);
        });
    }
}

criterion_group!(benches, benchmark);
criterion_main!(benches);
