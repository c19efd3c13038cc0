//! `gdel adapters`: the GPUs of this machine.

use super::failure::Failure;
use std::io::{self, Write};

pub(super) fn run() -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    let adapters = gdel::adapters();
    if adapters.is_empty() {
        writeln!(out, "none: there is no driver for Vulkan, Metal or Direct3D 12")?;
    }
    for (index, adapter) in adapters.iter().enumerate() {
        let software = if adapter.software { ", software" } else { "" };
        let mib = adapter.max_storage_buffer_bytes >> 20;
        writeln!(
            out,
            "{index}  {} ({}{software}; buffers of up to {mib} MiB; {})",
            adapter.name, adapter.backend, adapter.driver
        )?;
    }
    Ok(())
}
