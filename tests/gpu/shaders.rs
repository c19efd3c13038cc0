//! The shaders and the buffers that are bound to them go together.

use std::collections::BTreeSet;

use gdel::internals::{
    d2, d3,
    gpu::{
        AdapterChoice, Compiler, Gpu, Storage,
        dim::OwnBuffers,
        phase1::{Aliases, Buffers, Sizes},
        points::DevicePoints,
        shader::{self, Shaders},
    },
    input::lattice::Width,
};
use pollster::block_on;

const SIZES: Sizes = Sizes { blocks: 1, history: 1, start_points: 1, parts: None };

fn points(gpu: &Gpu) -> DevicePoints {
    DevicePoints {
        vertices: Storage::new(gpu, "vertices", 1).unwrap(),
        pairs: Storage::new(gpu, "pairs", 1).unwrap(),
        vertex_of: Storage::new(gpu, "vertices of points", 1).unwrap(),
        merged_into: Storage::new(gpu, "merged", 1).unwrap(),
        counts: Storage::new(gpu, "counts", 1).unwrap(),
    }
}

/// The names of all variables of some kernels.
fn variables(shaders: &Shaders) -> BTreeSet<&'static str> {
    shaders.iter().flat_map(gdel::internals::gpu::shader::Shader::variables).map(|&(name, ..)| name).collect()
}

/// Every kernel is bound in every run, which finds a name that is missing; this finds those that
/// are superfluous. The buffers that both dimensions have may have names that only one uses.
#[test]
fn every_name_of_a_buffer_is_one_of_a_variable() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let (d2_names, d3_names) = (variables(&shader::D2), variables(&shader::D3));
    let in_2d = Buffers::<2>::new(&gpu, points(&gpu), SIZES).unwrap();
    let in_3d = Buffers::<3>::new(&gpu, points(&gpu), SIZES).unwrap();
    let (aliases_2d, aliases_3d) = (d2::gpu::aliases::Aliases::new(&in_2d), d3::gpu::aliases::Aliases::new(&in_3d));
    for (name, _) in aliases_2d.bindings() {
        assert!(d2_names.contains(name), "no kernel for triangles has a variable {name}");
    }
    for (name, _) in [in_3d.own.bindings(), aliases_3d.bindings()].concat() {
        assert!(d3_names.contains(name), "no kernel for tetrahedra has a variable {name}");
    }
    for (name, _) in [in_2d.bindings(), in_3d.bindings()].concat() {
        assert!(d2_names.contains(name) || d3_names.contains(name), "no kernel has a variable {name}");
    }
}

/// The dimensions share names, so that either's kernels can be chosen by them.
#[test]
fn shared_kernels_are_kernels_of_both_dimensions() {
    for name in [
        "split",
        "relocate",
        "relocate_split",
        "locate",
        "points_gather",
        "pick_score",
        "flip_check",
        "flip_link",
        "flip_commit",
    ] {
        assert_eq!(shader::D2.get(name).name(), format!("d2/{name}"));
        assert_eq!(shader::D3.get(name).name(), format!("d3/{name}"));
    }
}

#[test]
#[should_panic(expected = "kernel d3/flip_link: not exactly one buffer is named neighbors")]
fn a_missing_buffer_is_named() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let control = Storage::<u32>::new(&gpu, "control", 64).unwrap();
    let kernel = Compiler::new(&gpu).on_demand(shader::D3.get("flip_link"), Width::Narrow);
    kernel.bind(&[("control", control.buffer())]);
}
