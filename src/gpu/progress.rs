//! The shares of a run at which its phases begin, as progress reports them.
//!
//! They are about the shares of the time for uniform points. Between Phase 1 and its completion lies the readback.

/// Phase 1, after the lattice.
pub const PHASE_1: f64 = 0.05;
/// What the CPU does with the result of Phase 1.
pub const COMPLETION: f64 = 0.8;
/// The mesh for the caller.
pub const FINISH: f64 = 0.95;

/// Returns the share of a run at which so much of the completion is done.
pub(crate) fn of_completion(share: f64) -> f64 {
    COMPLETION + (FINISH - COMPLETION) * share
}
