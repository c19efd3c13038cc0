//! `gdel adapters`: the GPUs of this machine, and whether they compute rightly.

use super::{device_report, failure::Failure};
use clap::Args;
use gdel::AdapterSummary;
use std::io::{self, Write};

/// List the GPUs of this machine, or test them.
#[derive(Args)]
pub(super) struct Arguments {
    /// Test each of them: meshes that are known, and meshes that the CPU makes as well. Prints reports, which can be
    /// pasted into an issue; the exit code is 1 if one computes wrongly
    #[arg(long)]
    test: bool,
    /// How many points the CPU and the GPU triangulate
    #[arg(
        long,
        value_name = "N",
        value_delimiter = ',',
        requires = "test",
        default_values_t = [10_000, 100_000, 1_000_000]
    )]
    points: Vec<u32>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    let adapters = gdel::adapters();
    if adapters.is_empty() {
        writeln!(out, "none: there is no driver for Vulkan, Metal or Direct3D 12")?;
    }
    if !arguments.test {
        return Ok(adapters.iter().enumerate().try_for_each(|listed| list(&mut out, listed))?);
    }
    let mut wrong = Vec::new();
    for (index, adapter) in adapters.iter().enumerate() {
        if index > 0 {
            writeln!(out)?;
        }
        if !device_report::write(&mut out, index, adapter, &arguments.points)? {
            wrong.push(adapter.name.clone());
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(Failure::WrongDevices(wrong)) }
}

fn list(out: &mut impl Write, (index, adapter): (usize, &AdapterSummary)) -> io::Result<()> {
    let software = if adapter.software { ", software" } else { "" };
    let mib = adapter.max_storage_buffer_bytes >> 20;
    let AdapterSummary { name, backend, driver, .. } = adapter;
    writeln!(out, "{index}  {name} ({backend}{software}; buffers of up to {mib} MiB; {driver})")
}
