//! The test of a device by known answers: they are those of the CPU, and a device that works passes.

use gdel::{
    Backend, Triangulator,
    internals::gpu::{
        AdapterChoice, Gpu,
        engine::GpuEngine,
        self_test::{KNOWN_ANSWERS, fingerprint},
    },
};
use pollster::block_on;

#[test]
fn known_answers_are_those_of_the_cpu() {
    let cpu = Triangulator::new().backend(Backend::Cpu);
    let (mut found, mut expected) = (String::new(), String::new());
    for test in &KNOWN_ANSWERS {
        let in_2d = cpu.delaunay2d(&test.points::<2>()).unwrap();
        let in_3d = cpu.delaunay3d(&test.points::<3>()).unwrap();
        let halfedges: Vec<u32> = in_2d.halfedges.iter().flatten().copied().collect();
        let answers = [
            fingerprint::<2>(in_2d.triangles.as_flattened(), &halfedges),
            fingerprint::<3>(in_3d.tetrahedra.as_flattened(), in_3d.neighbors.as_flattened()),
        ];
        found += &format!("{} {answers:#018x?}\n", test.name);
        expected += &format!("{} {:#018x?}\n", test.name, [test.answer::<2>(), test.answer::<3>()]);
    }
    assert_eq!(found, expected, "found:\n{found}");
}

#[test]
fn a_device_that_works_passes() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    block_on(block_on(GpuEngine::<2>::new(gpu.clone())).unwrap().self_test()).unwrap();
    let mut engine = block_on(GpuEngine::<3>::new(gpu)).unwrap();
    for _ in 0..2 {
        let clock = std::time::Instant::now();
        block_on(engine.self_test()).unwrap();
        println!("the test of 3D takes {:?}", clock.elapsed());
    }
}

/// Other corners or neighbours give another number, and another order the same.
#[test]
fn fingerprints_depend_on_the_simplices_and_their_neighbors() {
    let none = u32::MAX;
    let (triangles, halfedges) = ([0, 1, 2, 1, 3, 2], [none, 5, none, none, none, 1]);
    let pinned = fingerprint::<2>(&triangles, &halfedges);
    assert_eq!(fingerprint::<2>(&[1, 3, 2, 0, 1, 2], &[none, none, 4, none, 2, none]), pinned);
    assert_ne!(fingerprint::<2>(&[0, 1, 2, 1, 4, 2], &halfedges), pinned);
    assert_ne!(fingerprint::<2>(&triangles, &[none; 6]), pinned);
    assert_ne!(fingerprint::<2>(&[0; 6], &[0; 6]), pinned);
}
