//! Whole 2D triangulations on the CPU, in points per second. The verifier checks each before it is
//! timed.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gdel::{
    Backend, Triangulator,
    internals::d2::generate::{Distribution2, generate2d},
    verify2d,
};

fn engine(c: &mut Criterion) {
    let mut group = c.benchmark_group("cpu, 2D");
    group.sample_size(10);
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    for distribution in Distribution2::ALL {
        let points = generate2d(distribution, 100_000, 1);
        let triangulate = || triangulator.delaunay2d(&points).expect("finite points");
        let report = verify2d(&points, &triangulate()).expect("finite points");
        assert!(report.passed(), "{distribution:?}: {report}");
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_function(BenchmarkId::new(distribution.name(), points.len()), |b| {
            b.iter_with_large_drop(triangulate);
        });
    }
}

criterion_group!(benches, engine);
criterion_main!(benches);
