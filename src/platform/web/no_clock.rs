//! Stands for the clock, which WebAssembly has only through JavaScript.

use std::{ops::Sub, time::Duration};

/// The only instant that there is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instant;

impl Instant {
    pub(crate) fn now() -> Self {
        Instant
    }
}

impl Sub for Instant {
    type Output = Duration;

    fn sub(self, _: Self) -> Duration {
        Duration::ZERO
    }
}
