//! The kernels that take over a mesh whose points have moved, against the exact signs of the
//! references.

use crate::{kernels::Device, states::Own};
use gdel::internals::{
    cpu::{Incremental, MeshOf, delaunay},
    dimension::Dimension,
    gpu::{
        Storage,
        device_mesh::MeshArrays,
        layout::{BLOCK, CHECK, Params},
        start::first_simplex,
    },
    input::{lattice::Width, points::Points},
};
use gdel_reference::{self as reference, State, Vertex, kernels::Kernels};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// Marks inverted simplices, in the flags of their status.
const INVERTED: u32 = 0x100;

/// Returns `count` points with coordinates from 100 to below 100 + `side`.
fn positions<const D: usize>(count: usize, side: i64) -> Vec<[i64; D]> {
    let mut random = Pcg32::seed_from_u64(count as u64);
    let mut positions: Vec<[i64; D]> =
        (0..count).map(|_| std::array::from_fn(|_| 100 + random.random_range(0..side))).collect();
    positions.sort_unstable();
    positions.dedup();
    positions
}

/// Returns the points after each has moved along each axis by up to `by`, if they stay apart.
fn displaced<const D: usize>(positions: &[[i64; D]], by: i64) -> Vec<[i64; D]> {
    let mut random = Pcg32::seed_from_u64(7);
    let moved: Vec<[i64; D]> = positions.iter().map(|p| p.map(|x| x + random.random_range(-by..=by))).collect();
    let mut distinct = moved.clone();
    distinct.sort_unstable();
    distinct.dedup();
    if distinct.len() == moved.len() { moved } else { positions.to_vec() }
}

/// Takes over the mesh of the points where they were, and returns what the device makes of it where
/// they are.
fn taken<const D: usize>(width: Width, from: &[[i64; D]], to: &[[i64; D]]) -> State<D>
where
    Dimension<D>: Kernels<D> + Own<D> + MeshArrays<D>,
    MeshOf<D>: Sync,
{
    let points: Vec<[f64; D]> = from.iter().map(|p| p.map(|x| x as f64)).collect();
    let mesh = delaunay::<D>(Points::F64(&points), &Default::default()).expect("triangulates");
    let [simplices, neighbors, hull] = Dimension::<D>::words(&mesh);
    // On a wide lattice these are the high words.
    let on_lattice = |p: [i64; D]| if width == Width::Wide { p.map(|x| x << 31 | 5) } else { p };
    let to: Vec<[i64; D]> = to.iter().copied().map(on_lattice).collect();
    let start = first_simplex(width, to.len(), |i| to[i]).expect("they are not flat");
    let mut vertices: Vec<Vertex<D>> = (0..).zip(&to).map(|(index, &position)| Vertex { position, index }).collect();
    vertices.push(Vertex { position: start.interior_point, index: to.len() as u32 });
    let mut state = State::new(width, vertices, 16, 64);
    let (count, ghosts) = ((simplices.len() / (D + 1)) as u32, (hull.len() / if D == 3 { 3 } else { 1 }) as u32);
    let free = state.params.blocks * BLOCK - count - ghosts - 1;
    let spread = free * 1024 / (count + ghosts);
    state.params = Params { moved_simplices: count, moved_ghosts: ghosts, moved_spread: spread, ..state.params };
    state.counters.bid_base = 1;

    let device = Device::new(width, &state);
    let gpu = &device.kernels.gpu;
    let array = |words: &[u32]| Storage::with_contents(gpu, "array of the mesh", words).expect("there is room");
    let [simplices, neighbors] = [simplices, neighbors].map(array);
    let vertex_of: Vec<u32> = (0..to.len() as u32).collect();
    device.buffers.points.vertex_of.write(gpu, 0, &vertex_of);
    device.upload(&state);
    let device = device.with(&[("moved_simplices", simplices.buffer()), ("moved_neighbors", neighbors.buffer())]);
    for kernel in ["moved_mesh", "moved_ghosts", "moved_signs", "moved_facets"] {
        device.run(kernel);
    }
    let state = device.download(&state);
    assert_eq!((state.counters.moved_hull, state.counters.inserted), (ghosts, to.len() as u32));
    state
}

/// The simplices are those of the mesh; all that are inverted are marked and listed, and so are all
/// others with a facet that is not locally Delaunay. Returns the number of inverted ones.
fn signs_are_right<const D: usize>(width: Width, from: &[[i64; D]], to: &[[i64; D]]) -> usize
where
    Dimension<D>: Kernels<D> + Own<D> + MeshArrays<D>,
    MeshOf<D>: Sync,
{
    let state = taken(width, from, to);
    let used: Vec<u32> = (0..state.simplices.len() as u32).filter(|&t| state.is_used(t as usize)).collect();
    assert_eq!(used.len() as u32, state.params.moved_simplices + state.params.moved_ghosts);
    let flags = |t: u32| state.status[t as usize].flags;
    let is_inverted = |t: u32| state.orient(state.corners(t)) < 0;
    let (mut inverted, mut violated, mut to_check) = (0, 0, Vec::new());
    for &t in &used {
        assert_eq!(flags(t) & INVERTED != 0, is_inverted(t), "simplex {t}");
        inverted += usize::from(is_inverted(t));
        if flags(t) & CHECK != 0 {
            to_check.push(t);
        }
        for k in 0..=D {
            let (u, face) = state.across(t, k);
            assert_eq!(state.across(u, face), (t, k), "{t} and {u} are not mutual neighbours");
            if is_inverted(t) {
                assert!(flags(t) >> k & 1 != 0, "nobody will check facet {k} of {t}");
            } else if t < u && !is_inverted(u) && state.inside(state.corners(t), state.corners(u).as_ref()[face]) {
                assert!(flags(t) >> k & 1 != 0, "nobody will check facet {k} of {t}");
                violated += 1;
            }
        }
    }
    let mut listed: Vec<u32> =
        state.active[0][..state.counters.active_len[0] as usize].iter().map(|active| active.tet).collect();
    listed.sort_unstable();
    assert_eq!(listed, to_check);
    assert_eq!(state.counters.inverted as usize, inverted);
    assert!(state.counters.violated <= violated, "{} of {violated}", state.counters.violated);
    inverted
}

fn meshes_are_taken<const D: usize>()
where
    Dimension<D>: Kernels<D> + Own<D> + MeshArrays<D> + Incremental<D>,
    MeshOf<D>: Sync,
{
    for width in [Width::Narrow, Width::Wide] {
        for (count, side) in [(300, 1_000_000), (200, 9), (D + 2, 50)] {
            let from = positions::<D>(count, side);
            // Where nothing moves, nothing is wrong.
            assert_eq!(signs_are_right(width, &from, &from), 0);
            taken(width, &from, &from).validate_mesh();
            for by in [side / 100, side / 20, side] {
                signs_are_right(width, &from, &displaced(&from, by));
            }
        }
        let from = positions::<D>(300, 1_000_000);
        assert!(signs_are_right(width, &from, &displaced(&from, 50_000)) > 3);
    }
}

/// Nothing is flipped of a mesh of which more is wrong than the parameters allow.
fn meshes_with_too_many_wrong_simplices_are_left<const D: usize>()
where
    Dimension<D>: Kernels<D> + Own<D> + MeshArrays<D> + Incremental<D>,
    MeshOf<D>: Sync,
{
    let from = positions::<D>(300, 1_000_000);
    let taken = taken(Width::Wide, &from, &displaced(&from, 50_000));
    let all = taken.counters.active_len[0];
    assert!(all > 0);
    for (moved_inverted, moved_violated, active) in [(u32::MAX, u32::MAX, all), (0, u32::MAX, 0), (u32::MAX, 0, 0)] {
        let mut state = taken.clone();
        state.params = Params { moved_inverted, moved_violated, ..state.params };
        Device::new(Width::Wide, &state).equal("begin_round", &mut state, reference::begin_round);
        assert_eq!(state.counters.active_len[0], active, "at most {moved_inverted} and {moved_violated}");
    }
}

/// Tetrahedra with facets that could not be flipped are listed once more, and once each.
#[test]
fn what_could_not_be_flipped_is_checked_again() {
    let from = positions::<3>(300, 1_000_000);
    for width in [Width::Narrow, Width::Wide] {
        let mut state = taken(width, &from, &displaced(&from, 50_000));
        let listed = state.active[0][..state.counters.active_len[0] as usize].to_vec();
        assert!(listed.len() > 100);
        // Of every third one, a facet could not be flipped and others are still to be checked; of the
        // next ones nothing is, and of the rest the list knows nothing any more.
        for (i, active) in listed.iter().enumerate() {
            let flags = &mut state.status[active.tet as usize].flags;
            *flags = *flags & !CHECK | [0x21, 0x60, 0][i % 3];
        }
        let left: Vec<_> = listed.iter().copied().step_by(3).collect();
        state.active[0][..left.len()].copy_from_slice(&left);
        state.counters.active_len[0] = left.len() as u32;
        let before = state.clone();
        let device = Device::new(width, &state);
        device.upload(&state);
        device.run("moved_again");
        let state = device.download(&state);
        let mut again: Vec<u32> =
            state.active[0][..state.counters.active_len[0] as usize].iter().map(|active| active.tet).collect();
        assert_eq!(again[..left.len()], left.iter().map(|active| active.tet).collect::<Vec<_>>());
        let mut expected: Vec<u32> = listed.iter().enumerate().filter(|(i, _)| i % 3 < 2).map(|(_, a)| a.tet).collect();
        again.sort_unstable();
        expected.sort_unstable();
        assert_eq!(again, expected);
        for (i, active) in listed.iter().enumerate() {
            let [was, is] = [&before, &state].map(|state| state.status[active.tet as usize].flags);
            assert_eq!((is & 0xff, is >> 8), ([0x3, 0x6, 0][i % 3], was >> 8));
        }
    }
}

#[test]
fn tetrahedra_are_left_where_too_many_are_wrong() {
    meshes_with_too_many_wrong_simplices_are_left::<3>();
}

#[test]
fn triangles_are_left_where_too_many_are_wrong() {
    meshes_with_too_many_wrong_simplices_are_left::<2>();
}

#[test]
fn meshes_of_tetrahedra_are_taken() {
    meshes_are_taken::<3>();
}

#[test]
fn meshes_of_triangles_are_taken() {
    meshes_are_taken::<2>();
}
