//! Devices that are wrong in one place each: the test by known answers notices all of them.

use gdel::{
    Error,
    internals::{
        dimension::Dimension,
        gpu::{
            AdapterChoice, Gpu,
            engine::{Complete, GpuEngine},
            mutation::Mutation,
        },
    },
};
use pollster::block_on;
use std::sync::Arc;

/// A line of the list of mutants.
struct Mutant {
    dimension: usize,
    line: &'static str,
    mutation: Mutation,
}

fn mutants() -> Vec<Mutant> {
    let lines = include_str!("../data/mutants.txt").lines().filter(|line| !line.starts_with('#'));
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

/// Returns what the test by known answers says of a device.
fn tested(gpu: &Gpu, dimension: usize) -> Result<(), Error> {
    async fn test<const D: usize>(gpu: &Gpu) -> Result<(), Error>
    where
        Dimension<D>: Complete<D>,
    {
        GpuEngine::<D>::new(gpu.clone()).await?.self_test().await
    }
    block_on(async {
        match dimension {
            2 => test::<2>(gpu).await,
            _ => test::<3>(gpu).await,
        }
    })
}

#[test]
fn wrong_devices_fail_their_test() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    assert_eq!(tested(&gpu.mutated(None), 3), Ok(()));
    for Mutant { dimension, line, mutation } in mutants() {
        let outcome = tested(&gpu.mutated(Some(mutation)), dimension);
        println!("{outcome:?} | {line}");
        assert!(outcome.is_err(), "{line}");
    }
}
