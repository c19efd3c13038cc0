//! Whole 3D triangulations on the CPU, in points per second. The verifier checks each before it is
//! timed.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gdel::{
    Backend, Triangulator,
    internals::d3::generate::{Distribution3, generate3d},
    verify3d,
};

fn full_grid(side: u32) -> Vec<[f64; 3]> {
    (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side.pow(2)].map(f64::from)).collect()
}

fn engine(c: &mut Criterion) {
    let mut group = c.benchmark_group("cpu, 3D");
    group.sample_size(10);
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    let inputs = [
        ("uniform", generate3d(Distribution3::Uniform, 10_000, 1)),
        ("uniform", generate3d(Distribution3::Uniform, 100_000, 1)),
        ("sphere", generate3d(Distribution3::Sphere, 100_000, 1)),
        ("grid", full_grid(46)),
    ];
    for (name, points) in inputs {
        let triangulate = || triangulator.delaunay3d(&points).expect("finite points");
        let report = verify3d(&points, &triangulate()).expect("finite points");
        assert!(report.passed(), "{name}: {report}");
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_function(BenchmarkId::new(name, points.len()), |b| {
            b.iter_with_large_drop(triangulate);
        });
    }
}

criterion_group!(benches, engine);
criterion_main!(benches);
