//! Every reader of meshes; the first byte chooses the format.
#![no_main]

use gdel::internals::io::{MeshFormat, read_neigh};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&choice, bytes)) = data.split_first() else { return };
    match MeshFormat::ALL.get(usize::from(choice) % (MeshFormat::ALL.len() + 1)) {
        Some(format) => drop(format.read(bytes)),
        None => drop(read_neigh(bytes)),
    }
});
