//! The predicates of the plane in WGSL and their twin, against big integers and a perturbation that is carried out.
#![cfg(feature = "gpu")]

#[path = "common/plane_cases.rs"]
mod plane_cases;

use gdel::{
    gpu::{
        AdapterChoice, Gpu, Kernel, Readback, Recorder, Storage,
        plane::{
            twin::predicates::{self as twin, Vertex},
            vertex,
        },
        shader, workgroups,
    },
    lattice::Width,
    predicates::Sign,
};
use num_bigint::BigInt;
use plane_cases::{Case, FAMILIES, cases};
use pollster::block_on;
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

const KERNEL: &str = "
//!include shared/plane_predicates
//!include shared/plane_filter
@group(0) @binding(0) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(1) var<storage, read> indices: array<u32>;
@group(0) @binding(2) var<storage, read_write> signs: array<i32>;

fn vertex(v: u32) -> Vertex {
    return Vertex(load_position(v), indices[v]);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&signs) / 5; i += groups.x * 256) {
        let v = 4 * i;
        signs[5 * i] = orient2d_exact(load_position(v), load_position(v + 1), load_position(v + 2));
        signs[5 * i + 1] = orient2d(vertex(v), vertex(v + 1), vertex(v + 2));
        signs[5 * i + 2] = incircle(vertex(v), vertex(v + 1), vertex(v + 2), vertex(v + 3));
        signs[5 * i + 3] = orient2d_filter(load_high(v), load_high(v + 1), load_high(v + 2));
        signs[5 * i + 4] = incircle_filter(load_high(v), load_high(v + 1), load_high(v + 2), load_high(v + 3));
    }
}
";

fn on_the_gpu(gpu: &Gpu, kernel: &Kernel, width: Width, cases: &[Case]) -> Vec<[i32; 5]> {
    let mut words = Vec::new();
    for v in cases.iter().flatten() {
        // The mark of a rounded point is not a part of its coordinate.
        vertex::append_words(&mut words, width, v.position, v.index % 2 == 0);
    }
    let indices: Vec<u32> = cases.iter().flatten().map(|v| v.index).collect();
    let vertices = Storage::with_contents(gpu, "vertices", &words).unwrap();
    let indices = Storage::with_contents(gpu, "indices", &indices).unwrap();
    let signs = Storage::<[i32; 5]>::new(gpu, "signs", cases.len()).unwrap();
    let bindings = kernel.bind(gpu, &[vertices.buffer(), indices.buffer(), signs.buffer()]);
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

/// det(b − a, c − a) from the homogeneous 3×3 determinant.
fn big_orient2d(case: &Case) -> Sign {
    let rows: Vec<_> = case[..3].iter().map(|v| [v.position[0], v.position[1], 1].map(BigInt::from).to_vec()).collect();
    big_sign(&determinant(&rows))
}

/// From the 4×4 determinant of (x, y, |p|², 1).
fn big_incircle(case: &Case) -> Sign {
    let rows: Vec<Vec<BigInt>> = case
        .iter()
        .map(|v| {
            let [x, y] = v.position.map(BigInt::from);
            let height = &x * &x + &y * &y;
            vec![x, y, height, BigInt::from(1)]
        })
        .collect();
    big_sign(&determinant(&rows))
}

fn check(width: Width) {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a GPU or lavapipe");
    let wgsl = shader::assemble_text(KERNEL, width);
    let kernel = block_on(gpu.catching("test", || Ok(Kernel::from_wgsl(&gpu, "predicates", &wgsl, &[])))).unwrap();
    for &family in FAMILIES {
        let cases = cases(family, width, 20_000);
        let mut zeros = [0, 0];
        let mut decided = [0, 0];
        for (case, signs) in cases.iter().zip(on_the_gpu(&gpu, &kernel, width, &cases)) {
            let [exact_orient, orient, circle, orient_filter, circle_filter] = signs.map(|s| s as Sign);
            let [expected_orient, expected_circle] = [big_orient2d(case), big_incircle(case)];
            assert_eq!(exact_orient, expected_orient, "orient2d_exact, {family:?}: {case:?}");
            assert_eq!(twin::orient2d_exact([0, 1, 2].map(|i| case[i].position)), expected_orient);
            assert_eq!(orient, twin::orient2d([case[0], case[1], case[2]]), "orient2d, {family:?}: {case:?}");
            assert!(expected_orient == 0 || orient == expected_orient, "orient2d, {family:?}: {case:?}");
            assert_eq!(circle, twin::incircle(*case), "incircle, {family:?}: {case:?}");
            assert!(expected_circle == 0 || circle == expected_circle, "incircle, {family:?}: {case:?}");
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

/// Exponents of two, for coordinates below 16: δᵢ = 2^(−16 (i + 1)) is small enough to leave every determinant's sign
/// alone, and the ε's, 2^(−256·2^bit), are small enough for every product of the δ's and the ε's before them.
const DELTA: u32 = 16;
const EPSILON: u32 = 256;
/// Everything is multiplied by 2^ONE; only the two lowest ranks are perturbed.
const ONE: u32 = EPSILON << 4;

/// (x, y, height, 1), perturbed.
fn perturbed_rows<const N: usize>(vertices: [Vertex; N]) -> [[BigInt; 4]; N] {
    std::array::from_fn(|i| {
        let v = vertices[i];
        let rank = vertices.iter().filter(|other| other.index < v.index).count() as u32;
        let [x, y] = std::array::from_fn(|axis| {
            let bit = 2 * rank + 1 - axis as u32;
            let epsilon = if rank < 2 { BigInt::from(1) << (ONE - (EPSILON << bit)) } else { BigInt::ZERO };
            (BigInt::from(v.position[axis]) << ONE) - epsilon
        });
        let height: i64 = v.position.iter().map(|q| q * q).sum();
        let delta = BigInt::from(1) << (ONE - DELTA * (rank + 1));
        [x, y, (BigInt::from(height) << ONE) + delta, BigInt::from(1) << ONE]
    })
}

fn columns<const N: usize>(rows: [[BigInt; 4]; N], columns: &[usize]) -> Sign {
    let rows: Vec<Vec<BigInt>> = rows.iter().map(|row| columns.iter().map(|&c| row[c].clone()).collect()).collect();
    big_sign(&determinant(&rows))
}

/// Points on grids so small that they are often collinear, cocircular or equal: the ties are those of a perturbation that
/// is carried out.
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
        let expected = columns(perturbed_rows(three), &[0, 1, 3]);
        assert_ne!(expected, 0);
        assert_eq!(twin::orient2d(three), expected, "{three:?}");
        let expected = columns(perturbed_rows(four), &[0, 1, 2, 3]);
        assert_ne!(expected, 0);
        assert_eq!(twin::incircle(four), expected, "{four:?}");
        collinear += usize::from(twin::orient2d_exact(three.map(|v| v.position)) == 0);
    }
    assert!(collinear > 500, "{collinear}");
}
