//! Sort, scan and compaction on the GPU, against the CPU, for sizes around those of every block.

use gdel::internals::gpu::{
    AdapterChoice, Compiler, Gpu, Readback, Recorder, Storage,
    primitives::{
        compact::Compact,
        scan::{self, Scan, ScanParams},
        sort::{self, Sort},
    },
};
use pollster::block_on;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// 0, 1, around the sizes at which a kernel takes another step, and large.
fn sizes<const N: usize>(steps: [usize; N]) -> impl Iterator<Item = usize> {
    let around = steps.into_iter().flat_map(|n| [n - 1, n, n + 1]);
    [0, 1].into_iter().chain(around).chain([3_000_000])
}

/// The sizes at which a scan takes another step: an invocation's, a workgroup's, and that of all
/// workgroups.
const SCAN_STEPS: [usize; 4] = [4, 256, 1024, 1024 * scan::GROUPS];

/// The sizes at which a sort takes another step: a mask's word, a row, a tile, few tiles, and a row
/// of tiles.
const SORT_STEPS: [usize; 5] = [32, 256, sort::TILE, sort::FEW as usize * sort::TILE, 256 * sort::TILE];

fn open() -> Gpu {
    block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a GPU or lavapipe")
}

fn run<T: bytemuck::Pod>(gpu: &Gpu, result: &Storage<T>, body: impl FnOnce(&mut Recorder<'_>)) -> Vec<T> {
    block_on(gpu.with_error_scope("test", || {
        let mut recorder = Recorder::new(gpu, None);
        body(&mut recorder);
        recorder.submit(gpu);
        Ok(())
    }))
    .unwrap();
    block_on(Readback::default().read(gpu, result, 0, result.len())).unwrap()
}

#[test]
fn scan_is_the_exclusive_prefix_sum() {
    let gpu = open();
    let scan = Scan::new(&Compiler::new(&gpu));
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    for n in sizes(SCAN_STEPS) {
        let values: Vec<u32> = (0..n).map(|_| rng.random_range(0..1000)).collect();
        let mut sum = 0;
        let mut expected = Vec::new();
        for v in &values {
            expected.push(sum);
            sum += v;
        }
        let params = Storage::with_contents(&gpu, "params", &[ScanParams { count: n as u32 }]).unwrap();
        let values = Storage::with_contents(&gpu, "values", &values).unwrap();
        let offsets = Storage::new(&gpu, "offsets", n).unwrap();
        let bound = scan.bind(&gpu, &params, &values, &offsets).unwrap();
        let result = run(&gpu, &offsets, |recorder| bound.record(recorder));
        assert!(result == expected, "{n} values");
        let total = block_on(Readback::default().read(&gpu, bound.sums(), scan::GROUPS, 1)).unwrap();
        assert_eq!(total, [sum], "{n} values");
    }
}

/// The count may be smaller than the buffers, and than it was before: a kernel may have written it.
#[test]
fn scan_goes_as_far_as_it_is_told() {
    let gpu = open();
    let scan = Scan::new(&Compiler::new(&gpu));
    let params = Storage::with_contents(&gpu, "params", &[ScanParams { count: 3000 }]).unwrap();
    let values = Storage::with_contents(&gpu, "values", &[1; 3000]).unwrap();
    let offsets = Storage::new(&gpu, "offsets", 3000).unwrap();
    let bound = scan.bind(&gpu, &params, &values, &offsets).unwrap();
    assert!(run(&gpu, &offsets, |recorder| bound.record(recorder)).into_iter().eq(0..3000));
    params.write(&gpu, 0, &[ScanParams { count: 1500 }]);
    offsets.write(&gpu, 0, &[7; 3000]);
    let result = run(&gpu, &offsets, |recorder| bound.record(recorder));
    assert!(result[..1500].iter().copied().eq(0..1500));
    assert_eq!(result[1500..], [7; 1500]);
    assert_eq!(block_on(Readback::default().read(&gpu, bound.sums(), scan::GROUPS, 1)).unwrap(), [1500]);
}

#[test]
fn compaction_keeps_the_marked_in_order() {
    let gpu = open();
    let compact = Compact::new(&Compiler::new(&gpu));
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    for (i, n) in sizes(SCAN_STEPS).enumerate() {
        let share = [0.5, 0.01, 1.0, 0.0][i % 4];
        let marks: Vec<u32> = (0..n).map(|_| u32::from(rng.random_bool(share))).collect();
        let expected: Vec<u32> = (0..n as u32).filter(|&i| marks[i as usize] == 1).collect();
        let params = Storage::with_contents(&gpu, "params", &[ScanParams { count: n as u32 }]).unwrap();
        let marks = Storage::with_contents(&gpu, "marks", &marks).unwrap();
        let kept = Storage::new(&gpu, "kept", n).unwrap();
        let bound = compact.bind(&gpu, &params, &marks, &kept).unwrap();
        let result = run(&gpu, &kept, |recorder| bound.record(recorder));
        let total = block_on(Readback::default().read(&gpu, bound.sums(), scan::GROUPS, 1)).unwrap();
        assert_eq!(total, [expected.len() as u32], "{n} marks");
        assert!(result[..expected.len()] == expected, "{n} marks");
    }
}

fn check_sort(gpu: &Gpu, sort: &Sort, keys: Vec<u32>, bits: u32) {
    let n = keys.len();
    let contents: Vec<[u32; 2]> = keys.into_iter().zip(0..).map(|(key, i)| [key, i]).collect();
    let mask = u32::MAX >> (32 - bits);
    let mut expected = contents.clone();
    expected.sort_by_key(|&[key, _]| key & mask);
    let mut pairs = Storage::with_contents(gpu, "pairs", &contents).unwrap();
    let mut scratch = Storage::new(gpu, "scratch", n).unwrap();
    let bound = sort.bind(gpu, &mut pairs, &mut scratch, bits).unwrap();
    let result = run(gpu, &pairs, |recorder| sort.record(recorder, &bound));
    assert!(result == expected, "{n} pairs of {bits} bits");
}

#[test]
fn sort_is_stable_and_by_key() {
    let gpu = open();
    let sort = Sort::new(&Compiler::new(&gpu));
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    for n in sizes(SORT_STEPS) {
        check_sort(&gpu, &sort, (0..n).map(|_| rng.random()).collect(), 32);
    }
    // Many equal keys, an odd number of passes, and bits above the sorted ones.
    for bits in [8, 16, 24] {
        check_sort(&gpu, &sort, (0..100_000).map(|_| rng.random::<u32>() & 0xff07_0103).collect(), bits);
    }
    check_sort(&gpu, &sort, vec![5; 10_000], 32);
    check_sort(&gpu, &sort, (0..10_000).rev().collect(), 32);
}
