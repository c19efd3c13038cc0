//! Devices that are wrong in one place each: the test by known answers or the checks of meshes notice all of them, and none
//! hands out a wrong mesh, even without the test.

use gdel::{
    Error,
    internals::{
        Options,
        cpu::{self, MeshOf},
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        dimension::Dimension,
        gpu::{
            AdapterChoice, Gpu,
            device_mesh::MeshArrays,
            engine::{Complete, GpuEngine},
            mutation::Mutation,
            phase1::{Settings, WayToHost},
            self_test::{KNOWN_ANSWERS, fingerprint},
        },
        input::points::Points,
    },
};
use pollster::block_on;
use std::sync::{Arc, Mutex};

/// A line of the list of mutants.
struct Mutant {
    dimension: usize,
    line: &'static str,
    mutation: Mutation,
}

fn mutants() -> Vec<Mutant> {
    // Another list may be tried without compiling this again.
    let list = match std::env::var("MUTANTS") {
        Ok(path) => std::fs::read_to_string(path).expect("the list can be read").leak(),
        Err(_) => include_str!("../data/mutants.txt"),
    };
    let lines = list.lines().filter(|line| !line.starts_with('#'));
    let mutant = |line: &'static str| {
        let [of, _, edit] = line.split(" | ").collect::<Vec<_>>()[..] else { panic!("{line}") };
        let (dimension, kernel) = of.split_once(' ').unwrap();
        let (from, to) = edit.split_once(" =>").unwrap();
        let from = from.replace("\\n", "\n");
        let edit = move |wgsl: String| {
            let (start, end) = match &*from {
                "main" => {
                    let main = wgsl.find("fn main(").unwrap();
                    let body = main + wgsl[main..].find('{').unwrap() + 1;
                    (body, body)
                }
                from => {
                    let start = wgsl.find(from).unwrap_or_else(|| panic!("no such text: {line}"));
                    (start, start + from.len())
                }
            };
            [&wgsl[..start], to.trim_start(), &wgsl[end..]].concat()
        };
        let mutation = Mutation { kernel, edit: Arc::new(edit) };
        Mutant { dimension: dimension.parse().unwrap(), line, mutation }
    };
    lines.map(mutant).collect()
}

/// A run: how the mesh comes to the host, the points, and the fingerprint of their mesh.
struct Case<const D: usize> {
    way: WayToHost,
    points: Vec<[f64; D]>,
    answer: u64,
}

fn fingerprint_of<const D: usize>(mesh: &MeshOf<D>) -> u64
where
    Dimension<D>: MeshArrays<D>,
{
    let [simplices, neighbors, _] = Dimension::<D>::words(mesh);
    fingerprint::<D>(simplices, neighbors)
}

impl<const D: usize> Case<D>
where
    Dimension<D>: MeshArrays<D>,
{
    fn new(way: WayToHost, points: &[[f64; D]]) -> Self {
        let mesh = cpu::delaunay(Points::F64(points), &Options::default()).expect("the CPU is right");
        Case { way, points: points.to_vec(), answer: fingerprint_of::<D>(&mesh) }
    }
}

/// Triangulates without the test by known answers, then with it. Returns what notices that the device is wrong, if
/// anything does.
fn noticed<const D: usize>(gpu: &Gpu, cases: &[Case<D>], line: &str) -> Result<(), Error>
where
    Dimension<D>: Complete<D>,
{
    let mut engine = block_on(GpuEngine::<D>::new(gpu.clone()))?;
    for Case { way, points, answer } in cases {
        engine.set_settings(Settings { way_to_host: Some(*way), ..Settings::default() });
        let mesh = block_on(engine.triangulate(Points::F64(points), &Options::default()))?;
        assert_eq!(fingerprint_of::<D>(&mesh), *answer, "a wrong mesh, {way:?}: {line}");
    }
    engine.set_settings(Settings::default());
    block_on(engine.self_test())
}

#[test]
fn wrong_devices_are_noticed_and_hand_out_no_wrong_mesh() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let (uniform3, uniform2) =
        (generate3d(Distribution3::Uniform, 600, 1), generate2d(Distribution2::Uniform, 1_000, 1));
    let sphere = KNOWN_ANSWERS[1];
    let cases3 = [
        Case::new(WayToHost::MadeOnDevice, &uniform3),
        Case::new(WayToHost::ReadMeanwhile, &uniform3),
        Case::new(WayToHost::ReadFirst, &sphere.points::<3>()[..300]),
    ];
    let cases2 =
        [Case::new(WayToHost::MadeOnDevice, &uniform2), Case::new(WayToHost::ReadFirst, &sphere.points::<2>()[..300])];
    assert_eq!(noticed(&gpu.mutated(None), &cases2, "a right device"), Ok(()));
    let all = mutants();
    assert!(all.len() >= 40 || std::env::var_os("MUTANTS").is_some(), "{} wrong devices", all.len());
    let judge = |Mutant { dimension, line, mutation }: Mutant| {
        let gpu = gpu.mutated(Some(mutation));
        let outcome = if dimension == 2 { noticed(&gpu, &cases2, line) } else { noticed(&gpu, &cases3, line) };
        println!("{outcome:?} | {line}");
        outcome.is_ok().then_some(line)
    };
    // Much of the time, the host waits for one thread.
    let next = Mutex::new(all.into_iter());
    let worker = || std::iter::from_fn(|| next.lock().expect("no panic").next()).filter_map(judge).collect::<Vec<_>>();
    let unnoticed = std::thread::scope(|scope| {
        let workers = [(); 2].map(|()| scope.spawn(worker));
        workers.map(|worker| worker.join().expect("no wrong mesh")).concat()
    });
    assert!(unnoticed.is_empty(), "{unnoticed:#?}");
}
