//! Every reader of point clouds; the first byte chooses the format.
#![no_main]

use gdel::{internals::io::{PointFormat, panics_are_caught}, Points};
use libfuzzer_sys::fuzz_target;
use std::panic;

fuzz_target!(
    init: {
        // libFuzzer's hook aborts, even on the panics of the decoder of LAZ that the reader turns into errors.
        let abort = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !panics_are_caught() {
                abort(info);
            }
        }));
    },
    |data: &[u8]| {
        let Some((&choice, bytes)) = data.split_first() else { return };
        let format = PointFormat::ALL[usize::from(choice) % PointFormat::ALL.len()];
        if let Ok(cloud) = format.read(bytes.to_vec()) {
            assert_eq!(Points::from(&cloud).validate(), Ok(()));
        }
    }
);
