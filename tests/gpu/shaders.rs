//! The shaders and the buffers that are bound to them go together.

use std::collections::BTreeSet;

use gdel::internals::gpu::{
    AdapterChoice, Gpu, Kernel, Storage,
    dim::{Dim, Dimension},
    phase1::Buffers,
    points::DevicePoints,
    shader::{self, Shader},
};
use gdel::internals::{d2, d3, input::lattice::Width};
use pollster::block_on;

fn open() -> Gpu {
    block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU")
}

fn buffers<const D: usize>(gpu: &Gpu) -> Buffers<D>
where
    Dimension<D>: Dim<D>,
{
    let points = DevicePoints {
        vertices: Storage::new(gpu, "vertices", 1).unwrap(),
        pairs: Storage::new(gpu, "pairs", 1).unwrap(),
        merged_into: Storage::new(gpu, "merged", 1).unwrap(),
        counts: Storage::new(gpu, "counts", 1).unwrap(),
    };
    Buffers::new(gpu, points, 1, 1).unwrap()
}

/// Every kernel is bound in every run, which finds a name that is missing; this finds those that are superfluous.
#[test]
fn every_name_of_a_buffer_is_one_of_a_variable() {
    let gpu = open();
    let variables: BTreeSet<&str> =
        shader::D2.iter().chain(shader::D3.iter()).flat_map(Shader::variables).map(|&(name, _)| name).collect();
    let (triangles, tetrahedra) = (buffers::<2>(&gpu), buffers::<3>(&gpu));
    let aliases = (d2::gpu::aliases::Aliases::new(&triangles), d3::gpu::aliases::Aliases::new(&tetrahedra));
    let sets = [triangles.bindings(), tetrahedra.bindings(), aliases.0.bindings(), aliases.1.bindings()];
    for (name, _) in sets.concat() {
        assert!(variables.contains(name), "no kernel has a variable {name}");
    }
}

/// The host chooses a kernel of either dimension by the same name.
#[test]
fn shared_kernels_are_kernels_of_both_dimensions() {
    let shared =
        ["split", "relocate", "relocate_split", "locate", "points_gather", "pick_score", "flip_link", "flip_commit"];
    for name in shared {
        assert_eq!(shader::D2.get(name).name(), format!("d2/{name}"));
        assert_eq!(shader::D3.get(name).name(), format!("d3/{name}"));
    }
}

#[test]
#[should_panic(expected = "kernel d3/flip_link: not exactly one buffer is named neighbors")]
fn a_missing_buffer_is_named() {
    let gpu = open();
    let control = Storage::<u32>::new(&gpu, "control", 64).unwrap();
    let kernel = Kernel::new(&gpu, shader::D3.get("flip_link"), Width::Narrow);
    kernel.bind(&gpu, &[("control", control.buffer())]);
}
