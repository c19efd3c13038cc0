//! Every reader on damaged files of every format: no panic, and memory in proportion to the file.

#[path = "io/samples.rs"]
mod samples;

use gdel::{Mesh2, Mesh3};
use gdel_io::{MeshFormat, PointFormat, ShapeFormat, read_neigh};
use peak_alloc::PeakAlloc;
use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_pcg::Pcg64Mcg;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Damaged files per reader; 10,000 are run by hand: `GDEL_MUTATIONS=10000 cargo test --test
/// mutations`.
const CASES: u64 = 1000;
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
fn check(case: u64, format: &str, bytes: &[u8], read: impl FnOnce(Vec<u8>)) {
    let copy = bytes.to_vec();
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    read(copy);
    let taken = MEMORY.peak_usage().saturating_sub(before);
    let length = bytes.len();
    assert!(taken <= BASE + PER_BYTE * length, "case {case}, {format}: {taken} bytes of memory for {length} of file");
}

/// A reader by the name of its format, with the whole files that are to be damaged.
struct Reader {
    name: String,
    read: Box<dyn Fn(Vec<u8>)>,
    samples: Vec<Vec<u8>>,
}

/// Every reader, in both dimensions where it has two.
fn readers() -> Vec<Reader> {
    let mut readers: Vec<Reader> = Vec::new();
    let points = samples::point_clouds();
    for &format in PointFormat::ALL {
        let samples: Vec<_> = points.iter().filter(|(of, ..)| *of == format).map(|(.., bytes)| bytes.clone()).collect();
        assert!(!samples.is_empty(), "{format:?}");
        let read = Box::new(move |bytes| drop(format.read::<3>(bytes)));
        readers.push(Reader { name: format!("{format:?}"), read, samples: samples.clone() });
        let read = Box::new(move |bytes| drop(format.read::<2>(bytes)));
        readers.push(Reader { name: format!("{format:?} in 2D"), read, samples: samples.clone() });
        let read = Box::new(move |bytes: Vec<u8>| drop(format.read_with_values::<3>(&bytes, "4")));
        readers.push(Reader { name: format!("{format:?} with values"), read, samples });
    }
    let samples = points.iter().filter(|(of, ..)| *of == PointFormat::E57).map(|(.., bytes)| bytes.clone()).collect();
    let read = Box::new(|mut bytes: Vec<u8>| {
        samples::write_checksums(&mut bytes);
        drop(PointFormat::E57.read::<3>(bytes));
    });
    readers.push(Reader { name: "E57 behind its checksums".into(), read, samples });
    let [meshes, meshes2] = [samples::meshes(), samples::meshes2()];
    for &format in MeshFormat::ALL {
        let of = |samples: &[(MeshFormat, _, Vec<u8>)]| -> Vec<Vec<u8>> {
            samples.iter().filter(|(of, ..)| *of == format).map(|(.., bytes)| bytes.clone()).collect()
        };
        let read = Box::new(move |bytes: Vec<u8>| drop(format.read::<Mesh3, _, _>(&bytes)));
        readers.push(Reader { name: format!("{format:?}"), read, samples: of(&meshes) });
        let read = Box::new(move |bytes: Vec<u8>| drop(format.read::<Mesh2, _, _>(&bytes)));
        readers.push(Reader { name: format!("{format:?} in 2D"), read, samples: of(&meshes2) });
    }
    for &format in ShapeFormat::ALL {
        let samples: Vec<_> = samples::shapes().into_iter().filter(|(of, _)| *of == format).collect();
        let samples = samples.into_iter().map(|(_, bytes)| bytes).collect();
        let read = Box::new(move |bytes: Vec<u8>| drop(format.read(&bytes)));
        readers.push(Reader { name: format!("{format:?}"), read, samples });
    }
    let [neigh, neigh2] = samples::neighbors();
    let read = Box::new(|bytes: Vec<u8>| drop(read_neigh::<Mesh3, _, _>(&bytes)));
    readers.push(Reader { name: "neigh".into(), read, samples: vec![neigh] });
    let read = Box::new(|bytes: Vec<u8>| drop(read_neigh::<Mesh2, _, _>(&bytes)));
    readers.push(Reader { name: "neigh in 2D".into(), read, samples: vec![neigh2] });
    readers
}

/// One test only: memory is counted for the whole process.
#[test]
fn damaged_files_neither_panic_nor_exhaust_memory() {
    // As the command line does it; the report of a panic would count as the reader's memory, too.
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !gdel_io::panics_are_caught() {
            report(info);
        }
    }));
    let cases = std::env::var("GDEL_MUTATIONS").map_or(CASES, |count| count.parse().expect("a number"));
    let readers = readers();
    for (r, reader) in readers.iter().enumerate() {
        for case in 0..cases {
            let random = &mut Pcg64Mcg::seed_from_u64(case << 8 | r as u64);
            // Now and then a file of one format goes to the reader of another.
            let source = if random.random_bool(0.1) { readers.choose(random).expect("readers") } else { reader };
            let mut bytes = source.samples.choose(random).expect("samples").clone();
            (0..random.random_range(1..5)).for_each(|_| damage(&mut bytes, random));
            check(case, &reader.name, &bytes, &reader.read);
        }
    }
}
