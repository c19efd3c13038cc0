//! Times what is derived from a mesh of uniform points, one JSON object per line, the triangulation
//! first.
//!
//! `cargo bench --no-default-features --bench derived -- [--points N] [--queries N] [--only NAME]
//! [--write FOLDER]`: on one core. With default features and without `RAYON_NUM_THREADS=1`, threads
//! share the work. With `--write`, points and queries are written there for `benches/answers.py`.

use gdel::{
    AlphaShape, Backend, Clip, Interpolation, Interpolator, Locator, SpanningTree, Triangulator, Voronoi,
    internals::d3::generate::{Distribution3, generate3d},
};
use std::{path::PathBuf, time::Instant};

struct Arguments {
    points: usize,
    queries: usize,
    only: Option<String>,
    write: Option<PathBuf>,
}

fn main() {
    let mut arguments = Arguments { points: 1_000_000, queries: 1_000_000, only: None, write: None };
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        let value = words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        match word.as_str() {
            "--points" => arguments.points = value.parse().expect("a number of points"),
            "--queries" => arguments.queries = value.parse().expect("a number of queries"),
            "--only" => arguments.only = Some(value),
            "--write" => arguments.write = Some(value.into()),
            _ => panic!("unknown argument {word}"),
        }
    }
    run(&arguments);
}

/// Returns the time that this thread has run, where Linux says it: on a busy machine it says more
/// than the clock.
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
    if let Some(folder) = &arguments.write {
        for (name, points) in [("points.f64", &points), ("queries.f64", &queries)] {
            let bytes: Vec<u8> = points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
            std::fs::write(folder.join(name), bytes).expect("a folder to write to");
        }
        return;
    }
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
        let inside = located.iter().filter(|location| location.simplex().is_some()).count();
        println!("{{\"name\": \"locate\", \"inside\": {inside}}}");
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
        let pairs = (0..).zip(&nearest).map(|(query, vertex)| (query, vertex.expect("a mesh with vertices")));
        println!("{{\"name\": \"nearest\", \"checksum\": \"{:016x}\"}}", checksum(pairs));
    }
    if wanted("alpha") {
        let done = timed("alpha");
        let shape = AlphaShape::new(&mesh, &points).expect("a mesh with its points");
        done();
        let done = timed("alpha, edges");
        assert!(shape.edges().len() > 0);
        done();
        let done = timed("alpha, one component");
        shape.find_alpha(1).expect("a mesh with tetrahedra");
        done();
    }
    if wanted("tree") {
        let done = timed("tree");
        let tree = SpanningTree::new(&mesh, &points).expect("a mesh with its points");
        done();
        assert_eq!(tree.edges.len() + 1, points.len());
    }
    if wanted("voronoi") {
        let few = &points[..points.len().min(100_000)];
        let done = timed("triangulate, 100,000 points");
        let mesh = Triangulator::new().backend(Backend::Cpu).delaunay3d(few).expect("finite points");
        done();
        let done = timed("voronoi, 100,000 points");
        let voronoi = Voronoi::new(&mesh, few, Clip::Box([[0.0; 3], [1.0; 3]])).expect("a mesh with its points");
        let cells = voronoi.map_cells(|_, cell| (cell.volume, cell.neighbors()));
        done();
        let volume: f64 = cells.iter().map(|(volume, _)| volume).sum();
        assert!((volume - 1.0).abs() < 1e-9, "{volume}");
        let pairs = (0..).zip(&cells).flat_map(|(i, (_, neighbors))| neighbors.iter().map(move |&j| (i, j)));
        println!("{{\"name\": \"voronoi\", \"checksum\": \"{:016x}\"}}", checksum(pairs));
    }
}

/// Returns a sum that is the same for the same pairs in any order, as the programs in
/// `benches/peers/` do.
fn checksum(pairs: impl Iterator<Item = (u32, u32)>) -> u64 {
    pairs.fold(0, |sum, (i, j)| {
        let pair = u64::from(i) << 32 | u64::from(j);
        let mixed = (pair ^ pair >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        sum.wrapping_add(mixed ^ mixed >> 32)
    })
}
