//! Every shader that can be assembled is valid WGSL, within the limits that every device has.
#![cfg(feature = "gpu")]

use gdel::{gpu::shader, lattice::Width};
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn validate(name: &str, wgsl: &str) -> (naga::Module, naga::valid::ModuleInfo) {
    let module = naga::front::wgsl::parse_str(wgsl).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(wgsl)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(wgsl)));
    (module, info)
}

/// The shared files that stand for themselves, with what they expect.
#[test]
fn shared_files_are_valid() {
    for width in [Width::Narrow, Width::Wide] {
        let wgsl = shader::assemble_text(
            "@group(0) @binding(0) var<storage, read> vertices: array<vec4i>;
             //!include shared/predicates\n//!include shared/filter",
            width,
        );
        validate("shared", &wgsl);
    }
}
