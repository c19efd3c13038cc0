//! The predicates in WGSL and their twin, against big integers.
#![cfg(feature = "gpu")]

mod common;

use common::cases::{Case, FAMILIES, cases};
use gdel::{
    gpu::{
        AdapterChoice, Gpu, Kernel, Readback, Recorder, Storage, shader,
        twin::predicates::{self as twin, Vertex},
        vertex, workgroups,
    },
    lattice::Width,
    predicates::Sign,
};
use num_bigint::BigInt;
use pollster::block_on;

const KERNEL: &str = "
//!include shared/predicates
//!include shared/filter
@group(0) @binding(0) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(1) var<storage, read_write> signs: array<i32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&signs) / 5; i += groups.x * 256) {
        let a = load_vertex(5 * i);
        let b = load_vertex(5 * i + 1);
        let c = load_vertex(5 * i + 2);
        let d = load_vertex(5 * i + 3);
        let e = load_vertex(5 * i + 4);
        signs[5 * i] = orient3d_exact(a, b, c, d);
        signs[5 * i + 1] = orient3d(a, b, c, d);
        signs[5 * i + 2] = insphere(a, b, c, d, e);
        signs[5 * i + 3] = orient3d_filter(load_high(5 * i), load_high(5 * i + 1), load_high(5 * i + 2), load_high(5 * i + 3));
        signs[5 * i + 4] = insphere_filter(
            load_high(5 * i), load_high(5 * i + 1), load_high(5 * i + 2), load_high(5 * i + 3), load_high(5 * i + 4)
        );
    }
}
";

fn on_the_gpu(gpu: &Gpu, kernel: &Kernel, width: Width, cases: &[Case]) -> Vec<[i32; 5]> {
    let mut words = Vec::new();
    for v in cases.iter().flatten() {
        vertex::append_words(&mut words, width, v.position, v.index);
    }
    assert_eq!(words.len(), 5 * cases.len() * vertex::stride(width));
    let vertices = Storage::with_contents(gpu, "vertices", &words).unwrap();
    let signs = Storage::<[i32; 5]>::new(gpu, "signs", cases.len()).unwrap();
    let bindings = kernel.bind(gpu, &[vertices.buffer(), signs.buffer()]);
    let mut recorder = Recorder::new(gpu, None);
    recorder.dispatch(kernel, &bindings, workgroups(cases.len() as u32));
    recorder.submit(gpu);
    block_on(Readback::default().read(gpu, &signs, 0, cases.len())).unwrap()
}

fn big_sign(value: &BigInt) -> Sign {
    match value.sign() {
        num_bigint::Sign::Minus => -1,
        num_bigint::Sign::NoSign => 0,
        num_bigint::Sign::Plus => 1,
    }
}

fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    if rows.is_empty() {
        return BigInt::from(1);
    }
    let mut sum = BigInt::ZERO;
    for (i, row) in rows.iter().enumerate() {
        let others: Vec<Vec<BigInt>> =
            rows.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, r)| r[1..].to_vec()).collect();
        let term = &row[0] * determinant(&others);
        if i % 2 == 0 { sum += term } else { sum -= term }
    }
    sum
}

/// det(b − a, c − a, d − a) from the homogeneous 4×4 determinant.
fn big_orient3d(case: &Case) -> Sign {
    let rows: Vec<_> = case[..4].iter().map(|v| [&v.position[..], &[1]].concat()).collect();
    let rows: Vec<Vec<BigInt>> = rows.iter().map(|r| r.iter().map(|&x| BigInt::from(x)).collect()).collect();
    // Taking the first row off the others leaves −1 times the determinant of the differences.
    -big_sign(&determinant(&rows))
}

/// From the 5×5 determinant of (x, y, z, |p|², 1).
fn big_insphere(case: &Case) -> Sign {
    let rows: Vec<Vec<BigInt>> = case
        .iter()
        .map(|v| {
            let p = v.position.map(BigInt::from);
            let height = p.iter().map(|x| x * x).sum();
            p.into_iter().chain([height, BigInt::from(1)]).collect()
        })
        .collect();
    -big_sign(&determinant(&rows))
}

fn check(width: Width) {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a GPU or lavapipe");
    let wgsl = shader::assemble_text(KERNEL, width);
    let kernel = block_on(gpu.catching("test", || Ok(Kernel::from_wgsl(&gpu, "predicates", &wgsl, &[])))).unwrap();
    for &family in FAMILIES {
        let cases = cases(family, width, 10_000);
        let mut zeros = [0, 0];
        let mut decided = [0, 0];
        let finite = |case: &Case| case.iter().all(|v| *v != Vertex::AT_INFINITY);
        for (case, signs) in cases.iter().zip(on_the_gpu(&gpu, &kernel, width, &cases)) {
            let signs = signs.map(|s| s as Sign);
            let four = [case[0], case[1], case[2], case[3]];
            if four.iter().all(|v| *v != Vertex::AT_INFINITY) {
                let exact = big_orient3d(case);
                assert_eq!(signs[0], exact, "orient3d_exact, {family:?}: {case:?}");
                assert!(signs[3] == 0 || signs[3] == exact, "orient3d_filter, {family:?}: {case:?}");
                assert_eq!(signs[1], twin::orient3d(width, four), "orient3d, {family:?}: {case:?}");
                assert!(exact == 0 || signs[1] == exact, "orient3d, {family:?}: {case:?}");
                assert_ne!(signs[1], 0);
                zeros[0] += usize::from(exact == 0);
                decided[0] += usize::from(signs[3] != 0);
            }
            assert_eq!(signs[2], twin::insphere(width, *case), "insphere, {family:?}: {case:?}");
            assert_ne!(signs[2], 0);
            if finite(case) {
                let exact = big_insphere(case);
                assert!(exact == 0 || signs[2] == exact, "insphere, {family:?}: {case:?}");
                assert!(signs[4] == 0 || signs[4] == exact, "insphere_filter, {family:?}: {case:?}");
                zeros[1] += usize::from(exact == 0);
                decided[1] += usize::from(signs[4] != 0);
            }
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
