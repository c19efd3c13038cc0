//! Any number of threads makes the mesh of one thread.

use crate::clouds;
use gdel::{
    Backend, Error, Mesh2, Mesh3, Progress, Triangulator,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
    },
    verify2d, verify3d,
};
use std::{
    num::NonZeroUsize,
    ops::ControlFlow,
    sync::{Arc, Mutex},
};

/// More than the machine has, too.
const THREADS: [usize; 5] = [1, 2, 3, 8, 16];

fn triangulator(threads: usize) -> Triangulator {
    Triangulator::new().backend(Backend::Cpu).threads(NonZeroUsize::new(threads).unwrap())
}

/// Returns the facets of the hull in a form that is equal for equal hulls.
pub fn facets(mesh: &Mesh3) -> Vec<[u32; 3]> {
    let mut facets = mesh.hull.clone();
    // A rotation keeps the orientation.
    facets.iter_mut().for_each(|facet| {
        let lowest = (0..3).min_by_key(|&k| facet[k]).unwrap();
        facet.rotate_left(lowest);
    });
    facets.sort_unstable();
    facets
}

fn check3(name: &str, points: &[[f64; 3]]) {
    let [expected, meshes @ ..] = &THREADS.map(|threads| triangulator(threads).delaunay3d(points).unwrap());
    for (mesh, threads) in meshes.iter().zip(&THREADS[1..]) {
        assert!(mesh.canonical() == expected.canonical(), "{name}, {threads} threads");
        assert!(facets(mesh) == facets(expected), "{name}, {threads} threads");
        assert_eq!(mesh.duplicate_of, expected.duplicate_of, "{name}, {threads} threads");
    }
    let report = verify3d(points, &meshes[3]).unwrap();
    assert!(report.passed(), "{name}:\n{report}");
}

fn check2(name: &str, points: &[[f64; 2]]) {
    let [expected, meshes @ ..] = &THREADS.map(|threads| triangulator(threads).delaunay2d(points).unwrap());
    let parts = |mesh: &Mesh2| (mesh.canonical(), mesh.hull.clone(), mesh.duplicate_of.clone());
    for (mesh, threads) in meshes.iter().zip(&THREADS[1..]) {
        assert!(parts(mesh) == parts(expected), "{name}, {threads} threads");
    }
    let report = verify2d(points, &meshes[3]).unwrap();
    assert!(report.passed(), "{name}:\n{report}");
}

#[test]
fn threads_agree_on_all_distributions() {
    for distribution in Distribution3::ALL {
        check3(distribution.name(), &generate3d(distribution, 20_000, 1));
    }
    for distribution in Distribution2::ALL {
        check2(distribution.name(), &generate2d(distribution, 30_000, 1));
    }
}

#[test]
fn threads_agree_on_difficult_clouds() {
    check3("grid", &clouds::grid(22));
    check3("shuffled grid", &clouds::shuffled(&clouds::grid(22), 1));
    check3("grid with duplicates", &clouds::grid_64_with_duplicates(20_000));
    check3("clusters", &clouds::clusters_at_1e_9_spacing(20_000));
    check3("grids at corners", &clouds::grids_at_1e_9_spacing(15));
    check3("survey", &clouds::survey(20_000));
    check3("flat ground", &clouds::flat_ground(20_000));
    check3("duplicates", &clouds::thirty_percent_duplicates(2_000));
    check3("one plane", &clouds::grid(21).iter().map(|&[x, y, _]| [x, y, 1.0]).collect::<Vec<_>>());
}

#[test]
fn progress_by_threads_never_goes_back_and_can_cancel() {
    let points = generate3d(Distribution3::Uniform, 100_000, 1);
    for threads in THREADS {
        let seen = Arc::new(Mutex::new(Vec::new()));
        let sink = Arc::clone(&seen);
        let report = move |Progress { fraction, .. }: Progress| {
            sink.lock().unwrap().push(fraction);
            ControlFlow::Continue(())
        };
        triangulator(threads).on_progress(report).delaunay3d(&points).unwrap();
        let seen = seen.lock().unwrap();
        assert!(seen.is_sorted() && seen.last() == Some(&1.0), "{threads} threads: {seen:?}");
        assert!(seen.iter().any(|&fraction| 0.2 < fraction && fraction < 0.9), "{threads} threads: {seen:?}");

        let stop = |Progress { fraction, .. }: Progress| match fraction {
            ..0.3 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        };
        let result = triangulator(threads).on_progress(stop).delaunay3d(&points);
        assert_eq!(result.unwrap_err(), Error::Cancelled, "{threads} threads");
    }
}
