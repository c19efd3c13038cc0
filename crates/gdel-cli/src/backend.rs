//! Where triangulations are computed, as options name it.

use clap::ValueEnum;
use gdel::Backend;

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum BackendName {
    /// The GPU for large inputs if there is a hardware GPU, else the CPU
    Auto,
    /// Incremental insertion
    Cpu,
    /// Insertion and flipping on the GPU; an error if there is none
    Gpu,
}

impl From<BackendName> for Backend {
    fn from(name: BackendName) -> Self {
        match name {
            BackendName::Auto => Backend::Auto,
            BackendName::Cpu => Backend::Cpu,
            BackendName::Gpu => Backend::Gpu,
        }
    }
}
