//! Points become vertices on the GPU: duplicates, lattice and order, against the CPU.

use std::collections::HashMap;

use gdel::{
    Points,
    internals::{
        dimension::Dimension,
        gpu::{
            AdapterChoice, Compiler, Gpu, Readback, Recorder,
            dim::Dim,
            points::{InputCounts, InputParams, PointStage},
        },
        input::lattice::{Lattice, Width},
    },
};
use gdel_reference::hilbert::hilbert_key;
use pollster::block_on;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

struct Bench<const D: usize> {
    gpu: Gpu,
    stage: PointStage<D>,
}

impl<const D: usize> Bench<D>
where
    Dimension<D>: Dim<D>,
{
    fn new() -> Self {
        let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a GPU or lavapipe");
        Bench { stage: PointStage::new(&Compiler::new(&gpu)), gpu }
    }

    /// Runs the stage and compares everything with the CPU; returns the width and the counts.
    #[track_caller]
    fn check(&self, points: Points<'_, D>) -> (Width, InputCounts) {
        let gpu = &self.gpu;
        let n = points.len();
        let lattice = Lattice::fit(points);
        let params = InputParams::new(points, &lattice);
        let device = block_on(gpu.with_error_scope("test", || {
            let buffers = self.stage.buffers(gpu, &params)?;
            buffers.upload(gpu, points);
            let mut recorder = Recorder::new(gpu, None);
            let device = self.stage.record(gpu, &mut recorder, &buffers, params, true);
            recorder.submit(gpu);
            Ok(device)
        }))
        .unwrap();
        let mut readback = Readback::default();
        let pairs = block_on(readback.read(gpu, &device.pairs, 0, n)).unwrap();
        let merged_into = block_on(readback.read(gpu, &device.merged_into, 0, n)).unwrap();
        let vertex_of = block_on(readback.read(gpu, &device.vertex_of, 0, n)).unwrap();
        let stride = Dimension::<D>::vertex_words(lattice.width());
        let vertices = block_on(readback.read(gpu, &device.vertices, 0, n * stride)).unwrap();
        let [counts] = block_on(readback.read(gpu, &device.counts, 0, 1)).unwrap()[..] else { panic!() };

        let mut first = HashMap::new();
        let stands_for: Vec<usize> =
            (0..n).map(|i| *first.entry(lattice.coordinates(points.get(i)).map(|c| c.value)).or_insert(i)).collect();
        let expected: Vec<u32> =
            stands_for.iter().enumerate().map(|(i, &f)| if f == i { u32::MAX } else { f as u32 }).collect();
        assert!(merged_into == expected, "{n} points");

        let key = |i: usize| {
            let bits = if D == 2 { 15 } else { 10 };
            let high = lattice.coordinates(points.get(i)).map(|c| (c.value >> (lattice.width().bits() - bits)) as u32);
            if stands_for[i] == i { hilbert_key(high) } else { u32::MAX }
        };
        let mut expected_pairs: Vec<[u32; 2]> = (0..n).map(|i| [key(i), i as u32]).collect();
        expected_pairs.sort_by_key(|p| p[0]);
        assert!(pairs == expected_pairs, "{n} points");

        let order = || expected_pairs.iter().map(|&[_, i]| (i, points.get(i as usize)));
        let rounded = |p: [f64; D]| lattice.coordinates(p).iter().any(|c| !c.exact);
        let mut expected: Vec<i32> = Vec::new();
        for (index, p) in order() {
            let position = lattice.coordinates(p).map(|c| c.value);
            Dimension::<D>::append_vertex(&mut expected, lattice.width(), position, index, rounded(p));
        }
        for (v, (words, expected)) in vertices.chunks(stride).zip(expected.chunks(stride)).enumerate() {
            assert_eq!(words, expected, "vertex {v} of {n}: {:?}", points.get(pairs[v][1] as usize));
        }
        let merged = || stands_for.iter().copied().enumerate().filter(|&(i, f)| i != f);
        assert_eq!(counts.merged as usize, merged().count());
        assert_eq!(counts.duplicates as usize, merged().filter(|&(i, f)| points.get(i) == points.get(f)).count());
        for (v, &[_, point]) in (0..).zip(&pairs) {
            assert_eq!(vertex_of[point as usize], v);
        }
        assert_eq!(counts.rounded as usize, points.iter().filter(|&p| rounded(p)).count());
        (lattice.width(), counts)
    }
}

fn uniform<const D: usize>(n: usize, rng: &mut impl Rng) -> Vec<[f64; D]> {
    (0..n).map(|_| std::array::from_fn(|_| rng.random())).collect()
}

#[test]
fn uniform_points_of_all_sizes() {
    let bench = Bench::<3>::new();
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    for n in [0, 1, 2, 255, 256, 257, 2047, 2048, 2049, 100_000] {
        let points: Vec<[f64; 3]> = uniform(n, &mut rng);
        bench.check((&points).into());
        let single: Vec<[f32; 3]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
        bench.check((&single).into());
    }
}

#[test]
fn grids_are_narrow_and_their_duplicates_are_found() {
    let bench = Bench::<3>::new();
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let points: Vec<[f32; 3]> =
        (0..50_000).map(|_| std::array::from_fn(|_| rng.random_range(-16i8..16).into())).collect();
    let (width, counts) = bench.check((&points).into());
    assert_eq!(width, Width::Narrow);
    assert!(counts.duplicates > 10_000 && counts.rounded == 0, "{counts:?}");
}

#[test]
fn all_points_equal() {
    let (_, counts) = Bench::<3>::new().check((&vec![[0.1f64, -7e300, 3e-320]; 5000]).into());
    assert_eq!([counts.merged, counts.duplicates, counts.rounded], [4999, 4999, 0]);
}

/// 0 and −0 are the same point.
#[test]
fn negative_zero_is_zero() {
    let points = [[0.0, 1.0, 2.0], [-0.0, 1.0, 2.0], [0.0, 1.0, -2.0], [3.0, -0.0, 0.0], [3.0, 0.0, -0.0f32]];
    let (_, counts) = Bench::<3>::new().check((&points).into());
    assert_eq!(counts.duplicates, 2);
}

/// Exponents from subnormal to huge, large offsets, both signs: the device rounds as the host does.
#[test]
fn every_finite_number_is_put_on_the_lattice_alike() {
    let bench = Bench::<3>::new();
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let finite = |bits: u64| Some(f64::from_bits(bits)).filter(|x| x.is_finite()).unwrap_or(1.5);
    let (mut rounded, mut aside) = (0, 0);
    for round in 0..24 {
        let low = rng.random_range(0..2000u64);
        let high = rng.random_range(low..2047).max(1);
        let offset =
            if round % 3 == 0 { finite(rng.random_range(low..=high) << 52 | rng.random::<u64>() >> 12) } else { 0.0 };
        let number = |rng: &mut Pcg64Mcg| {
            let exponent = rng.random_range(low..=high);
            let fraction =
                rng.random::<u64>() >> 12 >> rng.random_range(0..53) << rng.random_range(0..53) & ((1 << 52) - 1);
            let x = finite(exponent << 52 | fraction | rng.random::<u64>() >> 63 << 63) + offset;
            if x.is_finite() { x } else { 0.0 }
        };
        let points: Vec<[f64; 3]> = (0..500).map(|_| std::array::from_fn(|_| number(&mut rng))).collect();
        let counts = bench.check((&points).into()).1;
        rounded += counts.rounded;
        aside += counts.merged - counts.duplicates;
        let single: Vec<[f32; 3]> =
            points.iter().map(|p| p.map(|x| Some(x as f32).filter(|x| x.is_finite()).unwrap_or(1e-44))).collect();
        bench.check((&single).into());
    }
    assert!(rounded > 1000 && aside > 50, "{rounded} {aside}");
}

/// Halves are rounded up, for both signs.
#[test]
fn halves_are_rounded_up() {
    let step = 2f64.powi(-60);
    let points: Vec<[f64; 3]> =
        (-40..40).map(|i| [f64::from(i) * step / 8.0, 1.0, 0.0]).chain([[3.0, -1.0, 0.0]]).collect();
    let (width, counts) = Bench::<3>::new().check((&points).into());
    assert_eq!(width, Width::Wide);
    assert!(counts.rounded > 0);
}

/// Generic, on a grid with duplicates, and with so many exponents that points are rounded and fall
/// together.
#[test]
fn points_in_2d() {
    let bench = Bench::<2>::new();
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    for n in [0, 1, 257, 20_000] {
        let points: Vec<[f64; 2]> = uniform(n, &mut rng);
        bench.check((&points).into());
        let single: Vec<[f32; 2]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
        bench.check((&single).into());
    }
    let grid: Vec<[f32; 2]> =
        (0..20_000).map(|_| std::array::from_fn(|_| rng.random_range(-64i8..64).into())).collect();
    let (width, counts) = bench.check((&grid).into());
    assert_eq!(width, Width::Narrow);
    assert!(counts.duplicates > 5_000 && counts.rounded == 0, "{counts:?}");
    let scales = |rng: &mut Pcg64Mcg| rng.random_range(-1.0..1.0) * 2f64.powi(rng.random_range(-80..0));
    let mixed: Vec<[f64; 2]> = (0..20_000).map(|_| std::array::from_fn(|_| scales(&mut rng))).collect();
    let (width, counts) = bench.check((&mixed).into());
    assert_eq!(width, Width::Wide);
    assert!(counts.rounded > 1000 && counts.merged > counts.duplicates, "{counts:?}");
}

/// The curve visits each cell once and goes from each to a neighbour.
fn is_a_hilbert_curve<const D: usize>(side: u32) {
    let cells = (0..side.pow(D as u32)).map(|i| std::array::from_fn(|axis| i / side.pow(axis as u32) % side));
    let mut cells: Vec<(u32, [u32; D])> = cells.map(|cell| (hilbert_key(cell), cell)).collect();
    cells.sort_unstable();
    for pair in cells.windows(2) {
        let [(k, a), (l, b)] = [pair[0], pair[1]];
        assert_eq!(k + 1, l);
        assert_eq!((0..D).map(|i| a[i].abs_diff(b[i])).sum::<u32>(), 1, "{a:?} {b:?}");
    }
}

#[test]
fn the_reference_of_the_keys_is_a_hilbert_curve() {
    is_a_hilbert_curve::<3>(16);
    is_a_hilbert_curve::<2>(64);
}
