//! The code that differs by target: threads, the clock, and how the host and a device exchange data.
//!
//! `native` and `web` have the same items.

pub(crate) mod sharing;

#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(target_arch = "wasm32")]
mod web;

#[cfg(not(target_arch = "wasm32"))]
pub(crate) use native::*;
#[cfg(target_arch = "wasm32")]
#[cfg_attr(not(feature = "gpu"), expect(unused_imports, reason = "nothing of it is public then"))]
pub use web::*;

#[cfg(any(target_arch = "wasm32", not(feature = "threads")))]
pub(crate) mod single;

/// Returns what a future yields if it is ready without waiting.
#[cfg(any(target_arch = "wasm32", not(feature = "gpu")))]
pub(crate) fn if_ready<T>(work: impl Future<Output = T>) -> Option<T> {
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    match std::pin::pin!(work).poll(&mut context) {
        std::task::Poll::Ready(done) => Some(done),
        std::task::Poll::Pending => None,
    }
}
