//! What later visits are to know of a device, which JavaScript keeps.

use crate::gpu::AdapterSummary;

/// Returns no name: what is known comes and goes with the functions of the bindings.
pub(crate) fn name(_: &AdapterSummary, _: usize) -> Option<String> {
    None
}

/// Returns nothing, since nothing has a name.
pub(crate) fn load(_: &str) -> Vec<u32> {
    Vec::new()
}

/// Does nothing.
pub(crate) fn save(_: &str, _: &[u32]) {}
