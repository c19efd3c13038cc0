//! Times what is derived from a mesh of uniform points, one JSON object per line, the triangulation first.
//!
//! `cargo bench --bench derived -- [--points N] [--queries N] [--only NAME]`; with
//! `RAYON_NUM_THREADS=1` or without default features on one core.

use gdel::{
    Backend, Interpolation, Interpolator, Locator, Triangulator,
    internals::d3::generate::{Distribution3, generate3d},
};
use std::time::Instant;

struct Arguments {
    points: usize,
    queries: usize,
    only: Option<String>,
}

fn main() {
    let mut arguments = Arguments { points: 1_000_000, queries: 1_000_000, only: None };
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        let value = words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        match word.as_str() {
            "--points" => arguments.points = value.parse().expect("a number of points"),
            "--queries" => arguments.queries = value.parse().expect("a number of queries"),
            "--only" => arguments.only = Some(value),
            _ => panic!("unknown argument {word}"),
        }
    }
    run(&arguments);
}

/// Returns the time that this thread has run, where Linux says it: on a busy machine it says more than the clock.
fn cpu_seconds() -> f64 {
    let schedstat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    schedstat.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).map_or(f64::NAN, |ns| ns * 1e-9)
}

fn run(arguments: &Arguments) {
    let timed = |name: &str| {
        let (start, cpu_start) = (Instant::now(), cpu_seconds());
        let name = name.to_owned();
        move || {
            let (seconds, cpu) = (start.elapsed().as_secs_f64(), cpu_seconds() - cpu_start);
            println!("{{\"name\": \"{name}\", \"seconds\": {seconds:.6}, \"cpu_seconds\": {cpu:.6}}}");
        }
    };
    let wanted = |name: &str| arguments.only.as_deref().is_none_or(|only| only == name);

    let points = generate3d(Distribution3::Uniform, arguments.points, 1);
    let queries = generate3d(Distribution3::Uniform, arguments.queries, 2);
    let done = timed("triangulate");
    let mesh = Triangulator::new().backend(Backend::Cpu).delaunay3d(&points).expect("finite points");
    done();
    let done = timed("locator");
    let locator = Locator::new(&mesh, &points).expect("a mesh with its points");
    done();
    if wanted("locate") {
        let done = timed("locate");
        let located = locator.locate_many(&queries).expect("finite queries");
        done();
        assert!(located.iter().filter(|l| l.simplex().is_some()).count() * 10 > 9 * queries.len());
    }
    let values: Vec<f64> = points.iter().map(|p| p[0] * p[1] + p[2]).collect();
    let interpolator = Interpolator::new(&locator, &values).expect("one value per point");
    let few = &queries[..queries.len().min(10_000)];
    for (name, method, queries) in [
        ("linear", Interpolation::Linear, &queries[..]),
        ("laplace, 10,000 queries", Interpolation::Laplace, few),
        ("sibson, 10,000 queries", Interpolation::Sibson, few),
    ] {
        if wanted(name) {
            let done = timed(name);
            let found = interpolator.interpolate_many(method, queries).expect("finite queries");
            done();
            assert_eq!(found.len(), queries.len());
        }
    }
    if wanted("nearest") {
        let done = timed("vertex neighbours");
        locator.nearest(queries[0]).expect("a finite query");
        done();
        let done = timed("nearest");
        let nearest = locator.nearest_many(&queries).expect("finite queries");
        done();
        assert!(nearest.iter().all(Option::is_some));
    }
}
