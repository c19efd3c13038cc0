//! Every reader of point clouds, in 3D and in 2D; the first byte chooses the format and the
//! dimension.
#![no_main]

use gdel::{
    Points,
    internals::io::{PointFormat, panics_are_caught},
};
use libfuzzer_sys::fuzz_target;
use std::panic;

fn check<const D: usize>(format: PointFormat, bytes: &[u8]) {
    if let Ok(cloud) = format.read::<D>(bytes.to_vec()) {
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
        let format = PointFormat::ALL[usize::from(choice & 0x7f) % PointFormat::ALL.len()];
        if choice & 0x80 == 0 { check::<3>(format, bytes) } else { check::<2>(format, bytes) }
    }
);
