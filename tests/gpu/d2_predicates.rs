//! The 2D predicates in WGSL and their reference, against big integers and a perturbation that is
//! carried out.

use crate::d2_cases::{Case, FAMILIES, cases};
use crate::perturbation::{leaning, perturbed_rows, sign_of_columns};
use crate::signs::{SignKernel, exact_in_circumsphere, exact_orientation};
use gdel::internals::{d2::gpu::vertex, gpu::Storage, input::lattice::Width, predicates::Sign};
use gdel_reference::d2::predicates::{self as reference, Vertex};
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

const KERNEL: &str = include_str!("../shaders/d2_predicates.wgsl");

fn on_the_gpu(kernel: &SignKernel, width: Width, cases: &[Case]) -> Vec<[i32; 5]> {
    let mut words = Vec::new();
    for v in cases.iter().flatten() {
        // The mark of a rounded point is not a part of its coordinate.
        vertex::append_words(&mut words, width, v.position, v.index % 2 == 0);
    }
    let indices: Vec<u32> = cases.iter().flatten().map(|v| v.index).collect();
    let vertices = Storage::with_contents(&kernel.gpu, "vertices", &words).unwrap();
    let indices = Storage::with_contents(&kernel.gpu, "indices", &indices).unwrap();
    kernel.signs(&[("vertices", vertices.buffer()), ("indices", indices.buffer())], cases.len())
}

fn check(width: Width) {
    for kernel in SignKernel::all(width, KERNEL, &["vertices", "indices", "signs"]) {
        check_kernel(&kernel, width);
    }
}

fn check_kernel(kernel: &SignKernel, width: Width) {
    for &family in FAMILIES {
        let cases = cases(family, width, 20_000);
        let mut zeros = [0, 0];
        let mut decided = [0, 0];
        for (case, signs) in cases.iter().zip(on_the_gpu(kernel, width, &cases)) {
            let [exact_orient, orient, circle, orient_filter, circle_filter] = signs.map(|s| s as Sign);
            let positions = case.map(|v| v.position);
            let [expected_orient, expected_circle] = [exact_orientation(&positions), exact_in_circumsphere(&positions)];
            assert_eq!(exact_orient, expected_orient, "orient2d_exact, {family:?}: {case:?}");
            assert_eq!(reference::orient2d_exact([0, 1, 2].map(|i| case[i].position)), expected_orient);
            let (three, interior) = ([case[0], case[1], case[2]], Vertex { index: u32::MAX, ..case[3] });
            assert_eq!(orient, reference::orient2d(three, interior), "orientation, {family:?}: {case:?}");
            assert!(expected_orient == 0 || orient == expected_orient, "orientation, {family:?}: {case:?}");
            assert_eq!(circle, reference::incircle(*case), "in-circle, {family:?}: {case:?}");
            assert!(expected_circle == 0 || circle == expected_circle, "in-circle, {family:?}: {case:?}");
            assert!(orient != 0 && circle != 0);
            assert!(orient_filter == 0 || orient_filter == expected_orient, "orient2d_filter, {family:?}: {case:?}");
            assert!(circle_filter == 0 || circle_filter == expected_circle, "incircle_filter, {family:?}: {case:?}");
            zeros[0] += usize::from(expected_orient == 0);
            zeros[1] += usize::from(expected_circle == 0);
            decided[0] += usize::from(orient_filter != 0);
            decided[1] += usize::from(circle_filter != 0);
        }
        println!("{width:?} {family:?}: zeros {zeros:?}, decided by the filter {decided:?} of {}", cases.len());
        family.check_that_it_is_what_it_says(zeros, decided, cases.len());
    }
}

#[test]
fn narrow_signs_are_exact() {
    check(Width::Narrow);
}

#[test]
fn wide_signs_are_exact() {
    check(Width::Wide);
}

/// Points on grids so small that they are often collinear, cocircular or equal: the ties are those
/// of a perturbation that is carried out.
#[test]
fn ties_are_those_of_the_perturbation() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut collinear = 0;
    for i in 0..3000 {
        let side = 1 + i % 4;
        let mut indices: Vec<u32> = (0..4).collect();
        indices.shuffle(&mut rng);
        let four: [Vertex; 4] = std::array::from_fn(|i| Vertex {
            position: std::array::from_fn(|_| rng.random_range(0..side)),
            index: indices[i] * 1000,
        });
        let three = [four[0], four[1], four[2]];
        let interior = Vertex { position: std::array::from_fn(|_| rng.random_range(0..side)), index: u32::MAX };
        let rows = leaning(perturbed_rows(&three.map(|v| (v.index, v.position))), interior.position);
        let expected = sign_of_columns(&rows, &[0, 1, 3]);
        assert_ne!(expected, 0);
        assert_eq!(reference::orient2d(three, interior), expected, "{three:?}, {interior:?}");
        let expected = sign_of_columns(&perturbed_rows(&four.map(|v| (v.index, v.position))), &[0, 1, 2, 3]);
        assert_ne!(expected, 0);
        assert_eq!(reference::incircle(four), expected, "{four:?}");
        collinear += usize::from(reference::orient2d_exact(three.map(|v| v.position)) == 0);
    }
    assert!(collinear > 500, "{collinear}");
}
