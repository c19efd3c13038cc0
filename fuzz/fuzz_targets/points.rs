//! Every reader of point clouds, in 3D and in 2D; the first byte chooses the format and the
//! dimension.
#![no_main]

#[path = "../../crates/gdel-io/tests/io/samples.rs"]
mod samples;

use gdel::Points;
use gdel_io::{PointFormat, panics_are_caught};
use libfuzzer_sys::fuzz_target;
use std::panic;

fn check<const D: usize>(format: PointFormat, mut bytes: Vec<u8>) {
    // What the fuzzer changes would not get past them.
    if format == PointFormat::E57 {
        samples::write_checksums(&mut bytes);
    }
    if let Ok(cloud) = format.read::<D>(bytes) {
        assert_eq!(Points::from(&cloud).validate(), Ok(()));
    }
}

fuzz_target!(
    init: {
        // libFuzzer's hook aborts, even on the panics of the decoder of LAZ that the reader turns
        // into errors.
        let abort = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !panics_are_caught() {
                abort(info);
            }
        }));
    },
    |data: &[u8]| {
        let Some((&choice, bytes)) = data.split_first() else { return };
        let bytes = bytes.to_vec();
        let format = PointFormat::ALL[usize::from(choice & 0x7f) % PointFormat::ALL.len()];
        if choice & 0x80 == 0 { check::<3>(format, bytes) } else { check::<2>(format, bytes) }
    }
);
