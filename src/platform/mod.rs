//! The code that differs by target: threads, the clock, and how the host and a device exchange data.
//!
//! `native` and `web` have the same items.

#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(target_arch = "wasm32")]
mod web;

#[cfg(not(target_arch = "wasm32"))]
pub(crate) use native::*;
#[cfg(target_arch = "wasm32")]
pub(crate) use web::*;

#[cfg(any(target_arch = "wasm32", not(feature = "threads")))]
pub(crate) mod single;
