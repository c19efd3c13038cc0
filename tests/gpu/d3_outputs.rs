//! The caller's arrays on the device, from meshes with ghosts and unused slots: against the
//! reference, and against what the CPU makes of the same.

use crate::kernels::Kernels;
use gdel::{
    Error, Mesh3, NONE,
    internals::{
        Options, cpu,
        d3::{
            generate::{Distribution3, generate3d},
            gpu::outputs::{MadeArrays, OutputParams, OutputStage, SlotMesh},
            mesh::FACETS,
            triangulation::{FiniteMesh, Triangulation3},
        },
        gpu::{Compiler, Gpu, Readback, Storage, device_mesh::DeviceArrays},
        input::lattice::Width,
        mesh::canonical,
        parallel::Threads,
    },
};
use gdel_reference::d3::{outputs_mark, outputs_write};
use pollster::block_on;
use rand::{SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;
use std::collections::HashMap;

/// A mesh in slots.
struct Slots {
    tetrahedra: Vec<[u32; 4]>,
    neighbors: Vec<[u32; 4]>,
    params: OutputParams,
}

/// Puts a mesh and its ghosts into any slots, of which `unused` remain.
fn slots(mesh: &Mesh3, unused: usize) -> Slots {
    let infinite = mesh.duplicate_of.len() as u32;
    let mut tetrahedra = mesh.tetrahedra.clone();
    let mut neighbors = vec![[0; 4]; mesh.tetrahedra.len()];
    let mut ghost_at = HashMap::new();
    for (t, across) in (0..).zip(&mesh.neighbors) {
        for k in 0..4 {
            let u = across[k];
            neighbors[t][k] = if u != NONE {
                let face = mesh.neighbors[u as usize].iter().position(|&back| back == t as u32).expect("mutual");
                4 * u + face as u32
            } else {
                let ghost = tetrahedra.len() as u32;
                let [a, b, c] = FACETS[k].map(|corner| mesh.tetrahedra[t][corner]);
                tetrahedra.push([a, b, c, infinite]);
                neighbors.push([0, 0, 0, 4 * t as u32 + k as u32]);
                for (i, edge) in [[b, c], [c, a], [a, b]].into_iter().enumerate() {
                    ghost_at.insert(edge, 4 * ghost + i as u32);
                }
                4 * ghost + 3
            };
        }
    }
    for (&[a, b], &facet) in &ghost_at {
        neighbors[facet as usize / 4][facet as usize % 4] = ghost_at[&[b, a]];
    }

    let count = tetrahedra.len() + unused;
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.shuffle(&mut Pcg64Mcg::seed_from_u64(count as u64));
    let mut scattered = Slots {
        tetrahedra: vec![[0; 4]; count],
        // What is left over in unused slots means nothing.
        neighbors: vec![[u32::MAX; 4]; count],
        params: OutputParams {
            count: count as u32,
            infinite,
            finite: mesh.tetrahedra.len() as u32,
            hull: mesh.hull.len() as u32,
        },
    };
    for (t, &slot) in order.iter().enumerate().take(tetrahedra.len()) {
        scattered.tetrahedra[slot as usize] = tetrahedra[t];
        scattered.neighbors[slot as usize] = neighbors[t].map(|facet| 4 * order[facet as usize / 4] + facet % 4);
    }
    scattered
}

fn run(gpu: &Gpu, stage: &OutputStage, slots: &Slots) -> Result<DeviceArrays, Error> {
    let marks = Storage::new(gpu, "marks", slots.tetrahedra.len())?;
    let numbers = Storage::new(gpu, "numbers", slots.tetrahedra.len())?;
    let mesh = SlotMesh {
        tetrahedra: &Storage::with_contents(gpu, "tetrahedra", &slots.tetrahedra)?,
        neighbors: &Storage::with_contents(gpu, "neighbors", &slots.neighbors)?,
        marks: &marks,
        numbers: &numbers,
        params: slots.params,
    };
    let MadeArrays { arrays, hull, .. } = block_on(stage.run(gpu, &mut Readback::default(), |_| (), mesh, &[], true))?;
    assert_eq!(hull.as_flattened(), block_on(Readback::default().read(gpu, &arrays.hull, 0, arrays.hull.len()))?);
    Ok(arrays)
}

fn read(gpu: &Gpu, array: &Storage<u32>) -> Vec<u32> {
    block_on(Readback::default().read(gpu, array, 0, array.len())).unwrap()
}

/// Every tetrahedron with its neighbours in the order of its vertices, and the facets of the hull:
/// equal for equal meshes.
fn essence(mesh: &FiniteMesh) -> (Vec<Vec<[u32; 4]>>, Vec<[u32; 3]>) {
    let sorted = |mut tet: [u32; 4]| {
        tet.sort_unstable();
        tet
    };
    let mut records: Vec<Vec<[u32; 4]>> = mesh
        .tetrahedra
        .iter()
        .zip(&mesh.neighbors)
        .map(|(&tet, across)| {
            let mut near: Vec<(u32, [u32; 4])> = (tet.into_iter())
                .zip(across)
                .map(|(v, &u)| (v, if u == NONE { [u32::MAX; 4] } else { sorted(mesh.tetrahedra[u as usize]) }))
                .collect();
            near.sort_unstable();
            [sorted(tet)].into_iter().chain(near.into_iter().map(|(_, tet)| tet)).collect()
        })
        .collect();
    records.sort_unstable();
    (records, turned(&mesh.hull))
}

/// The facets, each from its lowest vertex, in order.
fn turned(hull: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut hull = hull.to_vec();
    for facet in &mut hull {
        let lowest = (0..3).min_by_key(|&i| facet[i]).expect("three");
        facet.rotate_left(lowest);
    }
    hull.sort_unstable();
    hull
}

#[test]
fn the_callers_arrays_are_those_of_the_reference_and_of_the_cpu() {
    let gpu = Kernels::new(Width::Narrow).gpu;
    let stage = OutputStage::new(&Compiler::new(&gpu));
    let mut inputs = vec![
        ("nothing", vec![]),
        ("a tetrahedron", vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        ("uniform", generate3d(Distribution3::Uniform, 3_000, 1)),
        // All points on the hull.
        ("sphere", generate3d(Distribution3::Sphere, 2_000, 1)),
        ("grid", generate3d(Distribution3::Grid, 1_000, 1)),
    ];
    // The first points twice.
    let mut twice = generate3d(Distribution3::Uniform, 300, 2);
    twice.extend_from_within(..100);
    inputs.push(("duplicates", twice));
    for (name, points) in inputs {
        let mesh = cpu::delaunay::<3>((&points).into(), &Options::default()).unwrap();
        for unused in [0, 1, points.len()] {
            let slots = slots(&mesh, unused);
            let arrays = run(&gpu, &stage, &slots).unwrap();
            let mut device = FiniteMesh {
                tetrahedra: bytemuck::cast_slice(&read(&gpu, &arrays.simplices)).to_vec(),
                neighbors: bytemuck::cast_slice(&read(&gpu, &arrays.neighbors)).to_vec(),
                hull: bytemuck::cast_slice(&read(&gpu, &arrays.hull)).to_vec(),
            };

            let Slots { tetrahedra, neighbors, params } = slots;
            let marks = outputs_mark(&tetrahedra, params.infinite);
            let numbers: Vec<u32> = (marks.iter())
                .scan(0, |before, mark| {
                    *before += mark;
                    Some(*before - mark)
                })
                .collect();
            let mut expected = outputs_write(&tetrahedra, &neighbors, &numbers, params.infinite);
            // Only the facets of the hull have no order.
            (device.hull, expected.hull) = (turned(&device.hull), turned(&expected.hull));
            assert!(device.tetrahedra == expected.tetrahedra, "{name}, {unused} unused");
            assert!(device.neighbors == expected.neighbors, "{name}, {unused} unused");
            assert!(device.hull == expected.hull, "{name}, {unused} unused");

            const UNUSED: u32 = 3 << 30;
            let marked = tetrahedra.iter().map(|&t| if t == [0; 4] { [UNUSED, 0, 0, 0] } else { t }).collect();
            let of_cpu = Triangulation3::new(marked, neighbors, params.infinite).into_mesh(None, Threads::All);
            assert!(essence(&device) == essence(&of_cpu), "{name}, {unused} unused");
            assert!(canonical(&device.tetrahedra) == mesh.canonical(), "{name}, {unused} unused");

            let mut lowest = vec![NONE; points.len()];
            for (t, tet) in device.tetrahedra.iter().enumerate().rev() {
                tet.iter().for_each(|&v| lowest[v as usize] = t as u32);
            }
            let vertex_simplices: Vec<u32> = bytemuck::cast_vec(read(&gpu, &arrays.vertex_simplices));
            assert!(vertex_simplices == lowest, "{name}, {unused} unused");
        }
    }
}

#[test]
fn a_wrong_number_of_tetrahedra_or_facets_is_an_error() {
    let gpu = Kernels::new(Width::Narrow).gpu;
    let stage = OutputStage::new(&Compiler::new(&gpu));
    let points = generate3d(Distribution3::Uniform, 100, 1);
    let mesh = cpu::delaunay::<3>((&points).into(), &Options::default()).unwrap();
    let right = slots(&mesh, 3);
    for params in [
        OutputParams { finite: right.params.finite - 1, ..right.params },
        OutputParams { hull: right.params.hull - 1, ..right.params },
        OutputParams { finite: right.params.finite + 1, ..right.params },
    ] {
        let wrong = Slots { tetrahedra: right.tetrahedra.clone(), neighbors: right.neighbors.clone(), params };
        assert!(matches!(run(&gpu, &stage, &wrong), Err(Error::WrongResults { .. })));
    }
}
