//! The clock of phases.

use crate::platform::Instant;
use std::time::Duration;

/// Times consecutive phases.
pub(crate) struct Stopwatch {
    started: Instant,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Stopwatch { started: Instant::now() }
    }

    /// Returns the time since the start or the last lap; zero where there is no clock.
    pub(crate) fn lap(&mut self) -> Duration {
        let now = Instant::now();
        let time = now - self.started;
        self.started = now;
        time
    }
}
