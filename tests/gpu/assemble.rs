//! Assembly of a kernel that is not one of the crate's, but includes its shaders; for tests and
//! benchmarks.

use gdel::internals::input::lattice::Width;
use std::path::Path;

#[path = "../../build/sources.rs"]
#[allow(dead_code)]
mod sources;

/// The WGSL of `text` with its includes resolved.
pub fn assemble(text: &str, width: Width) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let sources = sources::Sources::read(&folder).expect("the shaders can be read");
    let file = sources::File::new("test".to_owned(), text);
    let width = match width {
        Width::Narrow => "narrow",
        Width::Wide => "wide",
    };
    let parts = sources.assemble(&file, &[("{width}", width)]).expect("the included files exist");
    parts.iter().map(|file| file.code()).collect()
}
