//! Every reader on damaged files of every format: no panic, and memory in proportion to the file.
#![cfg(feature = "io")]

#[path = "io/samples.rs"]
mod samples;

use gdel::internals::io::{MeshFormat, PointFormat};
use peak_alloc::PeakAlloc;
use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_pcg::Pcg64Mcg;
use std::fmt::Debug;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const CASES: u64 = 20_000;
/// What a reader may take whatever the file: the tables of the decoders of LAZ and DEFLATE.
const BASE: usize = 4 << 20;
/// What it may take for each byte of the file: DEFLATE and LZF expand at most so much.
const PER_BYTE: usize = 1 << 11;

/// Does to a file what broken disks, broken programs and attackers do.
fn damage(bytes: &mut Vec<u8>, random: &mut Pcg64Mcg) {
    if bytes.is_empty() {
        return;
    }
    let at = random.random_range(0..bytes.len());
    let to = random.random_range(at..bytes.len());
    match random.random_range(0..6) {
        0 => bytes.truncate(at),
        1 => bytes[at] = random.random(),
        2 => drop(bytes.drain(at..to)),
        3 => bytes.extend_from_within(at..to),
        // A number in binary, as sizes and counts often are.
        4 => {
            let number: u32 = *[0, 1, 0xffff, i32::MAX as u32, u32::MAX, random.random()].choose(random).expect("six");
            bytes[at..].iter_mut().zip(number.to_le_bytes()).for_each(|(byte, new)| *byte = new);
        }
        // A number in text.
        _ => {
            if let Some(digit) = bytes[at..].iter_mut().find(|byte| byte.is_ascii_digit()) {
                *digit = random.random_range(b'0'..=b'9');
            }
        }
    }
}

/// Runs `read` on the file; what it returns does not matter.
fn check(case: u64, format: impl Debug, bytes: &[u8], read: impl FnOnce(Vec<u8>)) {
    let copy = bytes.to_vec();
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    read(copy);
    let taken = MEMORY.peak_usage().saturating_sub(before);
    let length = bytes.len();
    assert!(taken <= BASE + PER_BYTE * length, "case {case}, {format:?}: {taken} bytes of memory for {length} of file");
}

/// One test only: memory is counted for the whole process.
#[test]
fn damaged_files_neither_panic_nor_exhaust_memory() {
    // As the command line does it; the report of a panic would count as the reader's memory, too.
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !gdel::internals::io::panics_are_caught() {
            report(info);
        }
    }));
    let points = samples::point_clouds();
    let meshes = samples::meshes();
    for case in 0..CASES {
        let random = &mut Pcg64Mcg::seed_from_u64(case);
        // Now and then a file of one format goes to the reader of another.
        let is_stranger = random.random_bool(0.1);
        if random.random_bool(0.8) {
            let (format, _, mut bytes) = points.choose(random).expect("samples").clone();
            (0..random.random_range(1..5)).for_each(|_| damage(&mut bytes, random));
            let format = if is_stranger { *PointFormat::ALL.choose(random).expect("formats") } else { format };
            check(case, format, &bytes, |bytes| drop(format.read(bytes)));
        } else {
            let (format, _, mut bytes) = meshes.choose(random).expect("samples").clone();
            (0..random.random_range(1..5)).for_each(|_| damage(&mut bytes, random));
            let format = if is_stranger { *MeshFormat::ALL.choose(random).expect("formats") } else { format };
            check(case, format, &bytes, |bytes| drop(format.read(&bytes)));
        }
    }
}
