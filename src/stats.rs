//! What a run did, and how long it took.

// The standard library's clock, and `performance.now()` on `wasm32-unknown-unknown`, where that has none.
use web_time::Instant;

/// How a mesh came about.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stats {
    /// The engine that made the mesh: `"cpu"` or `"gpu"`.
    pub engine: &'static str,
    /// Why the CPU engine took over, where another was asked for.
    pub fallback: Option<&'static str>,
    /// The phases in the order in which they ran, with the seconds that each took.
    pub phases: Vec<(&'static str, f64)>,
    /// Signs that the floating-point filter left open, by what decided them.
    pub exact: ExactCounts,
}

/// How many signs each stage of the predicates decided, after the floating-point filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ExactCounts {
    /// Decided by fixed-width integers on the lattice.
    pub integer: u64,
    /// Decided by floating-point expansions or big integers, where a point does not fit the lattice.
    pub expansion: u64,
    /// Cospherical: decided by the symbolic perturbation.
    pub symbolic: u64,
}

impl Stats {
    /// The seconds that all phases took together.
    pub fn total_seconds(&self) -> f64 {
        self.phases.iter().map(|(_, seconds)| seconds).sum()
    }
}

/// Times consecutive phases.
pub(crate) struct Stopwatch {
    started: Instant,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Stopwatch { started: Instant::now() }
    }

    /// The seconds since the start or the last lap.
    pub(crate) fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let seconds = (now - self.started).as_secs_f64();
        self.started = now;
        seconds
    }
}
