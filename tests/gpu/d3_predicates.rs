//! The predicates in WGSL and their reference, against big integers.

use crate::d3_cases::{Case, FAMILIES, Family, cases};
use crate::signs::{SignKernel, exact_in_circumsphere, exact_orientation};
use gdel::internals::{d3::gpu::vertex, gpu::Storage, input::lattice::Width, predicates::Sign};
use gdel::internals::{dimension::Dimension, gpu::dim::Dim};
use gdel_reference::d3::predicates::{self as reference, Vertex};

const KERNEL: &str = include_str!("../shaders/d3_predicates.wgsl");

fn on_the_gpu(kernel: &SignKernel, width: Width, cases: &[Case]) -> Vec<[i32; 7]> {
    let mut words = Vec::new();
    for (i, case) in cases.iter().enumerate() {
        for v in case.iter().chain([&interior_of(cases, i)]) {
            vertex::append_words(&mut words, width, v.position, v.index, false);
        }
    }
    assert_eq!(words.len(), 6 * cases.len() * Dimension::<3>::vertex_words(width));
    let vertices = Storage::with_contents(&kernel.gpu, "vertices", &words).unwrap();
    kernel.signs(&[("vertices", vertices.buffer())], cases.len())
}

/// The interior point of a case: a vertex of the next one.
fn interior_of(cases: &[Case], i: usize) -> Vertex {
    Vertex { index: u32::MAX, ..cases[(i + 1) % cases.len()][4] }
}

fn check(width: Width) {
    for kernel in SignKernel::all(width, KERNEL, &["vertices", "signs"]) {
        check_kernel(&kernel, width);
    }
}

fn check_kernel(kernel: &SignKernel, width: Width) {
    for &family in FAMILIES {
        let cases = cases(family, width, 10_000);
        let mut zeros = [0, 0];
        let mut decided = [0, 0];
        let mut refined = [0, 0];
        for (i, (case, signs)) in cases.iter().zip(on_the_gpu(kernel, width, &cases)).enumerate() {
            let signs = signs.map(|s| s as Sign);
            let four = [case[0], case[1], case[2], case[3]];
            let interior = interior_of(&cases, i);
            let exact = exact_orientation(&case.map(|v| v.position));
            assert_eq!(signs[0], exact, "orient3d_exact, {family:?}: {case:?}");
            assert!(signs[3] == 0 || signs[3] == exact, "orient3d_filter, {family:?}: {case:?}");
            assert!(signs[5] == 0 || signs[5] == exact, "orient3d_refined, {family:?}: {case:?}");
            assert_eq!(signs[1], reference::orient3d(width, four, interior), "orientation, {family:?}: {case:?}");
            assert!(exact == 0 || signs[1] == exact, "orientation, {family:?}: {case:?}");
            assert_ne!(signs[1], 0);
            zeros[0] += usize::from(exact == 0);
            decided[0] += usize::from(signs[3] != 0);
            refined[0] += usize::from(signs[5] != 0);
            let exact = exact_in_circumsphere(&case.map(|v| v.position));
            let rounds = std::array::from_fn(|k| (i >> k & 1) as u32);
            let expected = reference::insphere(width, *case, rounds, interior);
            assert_eq!(signs[2], expected, "in-sphere, {family:?}: {case:?}, {rounds:?}, {interior:?}");
            assert!(exact == 0 || signs[2] == exact, "in-sphere, {family:?}: {case:?}");
            assert_ne!(signs[2], 0);
            assert!(signs[4] == 0 || signs[4] == exact, "insphere_filter, {family:?}: {case:?}");
            assert!(signs[6] == 0 || signs[6] == exact, "insphere_refined, {family:?}: {case:?}");
            zeros[1] += usize::from(exact == 0);
            decided[1] += usize::from(signs[4] != 0);
            refined[1] += usize::from(signs[6] != 0);
        }
        println!(
            "{width:?} {family:?}: zeros {zeros:?}, decided by the filter {decided:?}, by the refined one {refined:?} of {}",
            cases.len()
        );
        if family == Family::Clustered {
            // What the low words are for.
            let [orientation, in_sphere] = refined.map(|n| n as f64 / cases.len() as f64);
            assert_eq!(width == Width::Wide, orientation > 0.99 && in_sphere > 0.99, "{refined:?}");
        }
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
