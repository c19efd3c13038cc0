//! Gathering parts of the mesh and writing changed ones back, against the references.

use crate::{kernels::Kernels, states::read};
use gdel::internals::{
    d3::{
        gpu::buffers::Gathering,
        splay::{Gathered, KEEP, Patch},
    },
    dimension::Dimension,
    gpu::{
        Storage,
        dim::Dim,
        layout::{BLOCK, COUNTER_WORDS, Counters, FREE_START, PARAM_WORDS, Params},
        primitives::scan::GROUPS,
    },
    input::lattice::Width,
};
use gdel_reference::d3::gather::{self, Mesh};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

const POINTS: u32 = 700;
const FINITE: u32 = 3000;
const GHOSTS: u32 = 200;
const BLOCKS: u32 = 600;

/// Returns tetrahedra and neighbours that are no triangulation: the kernels do not mind.
fn mesh(rng: &mut Pcg32) -> Mesh {
    let len = FINITE + GHOSTS;
    let tetrahedra = (0..len).map(|t| {
        let v: [u32; 4] = std::array::from_fn(|_| rng.random_range(0..POINTS));
        if t < FINITE { v } else { [v[0], v[1], v[2], POINTS] }
    });
    let tetrahedra = tetrahedra.collect();
    let neighbors = (0..len).map(|_| std::array::from_fn(|_| rng.random_range(0..4 * len))).collect();
    Mesh::new(tetrahedra, neighbors, POINTS)
}

#[test]
fn parts_are_gathered_and_written_back() {
    let mut rng = Pcg32::seed_from_u64(7);
    let mut mesh = mesh(&mut rng);
    let kernels = Kernels::new(Width::Narrow);
    let gpu = &kernels.gpu;
    let slots = (BLOCKS * BLOCK) as usize;
    let params = Params { infinite: POINTS, blocks: BLOCKS, ..Params::default() };
    let counters = Counters { ghosts: GHOSTS, ..Counters::default() };
    let control = Storage::<u32>::new(gpu, "control", FREE_START + BLOCKS as usize).unwrap();
    control.write(gpu, 0, bytemuck::cast_slice(&[params]));
    control.write(gpu, PARAM_WORDS, &bytemuck::cast_slice(&[counters])[..COUNTER_WORDS]);
    let mut sums = vec![0; GROUPS + 1];
    sums[GROUPS] = FINITE;
    let sums = Storage::with_contents(gpu, "sums", &sums).unwrap();
    let words = |label| Storage::<u32>::new(gpu, label, slots).unwrap();
    let slots_of_4 = |label| Storage::<[u32; 4]>::new(gpu, label, slots).unwrap();
    let [tetrahedra, neighbors] = ["tetrahedra", "neighbors"].map(slots_of_4);
    let [gathered_tetrahedra, gathered_neighbors] = ["gathered tetrahedra", "gathered neighbours"].map(slots_of_4);
    let [region_numbers, gathered_slots] = ["region", "slots"].map(words);
    let wanted = Storage::<u32>::new(gpu, "wanted", mesh.wanted.len()).unwrap();
    let gathering = Storage::<Gathering>::new(gpu, "gathering", 1).unwrap();
    tetrahedra.write(gpu, 0, &mesh.tetrahedra);
    neighbors.write(gpu, 0, &mesh.neighbors);
    // What an earlier run left does not matter.
    region_numbers.write(gpu, 0, &vec![9; slots]);
    let vertex_simplex = Storage::with_contents(gpu, "tetrahedra of points", &mesh.vertex_simplex).unwrap();
    let run = |name: &str| {
        let buffers = [
            ("control", control.buffer()),
            ("sums", sums.buffer()),
            ("vertex_simplex", vertex_simplex.buffer()),
            ("mesh_tetrahedra", tetrahedra.buffer()),
            ("mesh_neighbors", neighbors.buffer()),
            ("gathered_tetrahedra", gathered_tetrahedra.buffer()),
            ("gathered_neighbors", gathered_neighbors.buffer()),
            ("gathered_slots", gathered_slots.buffer()),
            ("region_numbers", region_numbers.buffer()),
            ("wanted", wanted.buffer()),
            ("gathering", gathering.buffer()),
        ];
        kernels.run(Dimension::<3>::SHADERS.get(name), &buffers);
    };

    let mut first = 1;
    for stars in [3, 40, 1, 0] {
        let vertices: Vec<u32> = (0..stars).map(|_| rng.random_range(0..POINTS)).collect();
        mesh.want(&vertices);
        wanted.write(gpu, 0, &mesh.wanted);
        gathering.write(gpu, 0, &[Gathering { first, patched: 0 }]);
        control.write(gpu, PARAM_WORDS, &bytemuck::cast_slice(&[counters])[..COUNTER_WORDS]);
        run("gather_list");
        let after = &read(gpu, &control)[PARAM_WORDS..][..COUNTER_WORDS];
        let total = bytemuck::from_bytes::<Counters>(bytemuck::cast_slice(after)).gathered;
        let listed = read(gpu, &gathered_slots)[..total as usize].to_vec();
        let mut sorted = listed.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, gather::gather_list(&mut mesh, first));
        // The kernel lists them in another order.
        listed.iter().zip(first..).for_each(|(&t, number)| mesh.region_numbers[t as usize] = number);
        assert_eq!(read(gpu, &region_numbers)[..mesh.region_numbers.len()], mesh.region_numbers);
        run("gather_copy");
        let Gathered { tetrahedra, neighbors, slots } = gather::gather_copy(&mesh, listed);
        assert_eq!(read(gpu, &gathered_tetrahedra)[..slots.len()], tetrahedra);
        assert_eq!(read(gpu, &gathered_neighbors)[..slots.len()], neighbors);
        assert_eq!(read(gpu, &gathered_slots)[..slots.len()], slots);
        assert!(slots.len() >= stars, "{stars} stars have {} tetrahedra", slots.len());
        first += total;
    }

    let len = (FINITE + GHOSTS + 5) as usize;
    let mut patch = Patch { len, ..Patch::default() };
    for slot in [0, 17, FINITE, FINITE + GHOSTS - 1, FINITE + GHOSTS, FINITE + GHOSTS + 4] {
        patch.slots.push(slot);
        patch.tetrahedra.push(if slot == 17 { [0; 4] } else { [slot + 1, slot + 2, slot + 3, POINTS] });
        let across = [4 * slot, KEEP, 7, if slot == 17 { KEEP } else { 3 }];
        patch.neighbors.push(across);
    }
    gathering.write(gpu, 0, &[Gathering { first: 0, patched: patch.slots.len() as u32 }]);
    gathered_slots.write(gpu, 0, &patch.slots);
    gathered_tetrahedra.write(gpu, 0, &patch.tetrahedra);
    gathered_neighbors.write(gpu, 0, &patch.neighbors);
    run("patch");
    gather::patch(&mut mesh, &patch);
    assert_eq!(read(gpu, &tetrahedra)[..len], mesh.tetrahedra);
    assert_eq!(read(gpu, &neighbors)[..len], mesh.neighbors);
}
