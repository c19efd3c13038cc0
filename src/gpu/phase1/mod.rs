//! Phase 1: parallel insertion and flipping (§3.1), from lattice points to a nearly Delaunay
//! triangulation.
//!
//! 1. *Points*: lattice, points at the same place, order along the Hilbert curve
//!    ([`points`](crate::gpu::points)).
//! 2. *Rounds*, until no point waits: every simplex with waiting points picks one and is split;
//!    flip iterations until (nearly) none is active; the waiting points follow the history of the
//!    flips.
//! 3. *Last flips*, until no simplex is active. In 2D the result is the Delaunay triangulation of
//!    the lattice's points, with its coordinates perturbed; in 3D flipping can get stuck.
//! 4. *Finish*: the mesh without gaps, in input indices, what rounding leaves open, and the one
//!    large readback; in 3D also the failed vertices (§3.2.1).
//!
//! What it costs in 3D, for *n* points in *r* rounds of *k* flip iterations (uniform, 1 M: r = 11,
//! k ≈ 20, of which a fifth too many are recorded): dispatches, 15 for the points, 5 + 3¼·k per
//! round, 8 to finish, about 1,400 in all; a flip iteration visits its active tetrahedra (42·n in
//! all, 14·n flips) at 4 to 10 sectors of 32 bytes each, so 10 to 15 GB of traffic for 1 M points,
//! most of it in the cache. Readbacks: one of a hundred bytes per round, one or two for the last
//! flips, 8 to finish. In 2D: dispatches, 15 for the points, 5 + 3·k per round, 5 to finish;
//! readbacks, one per round, 6 to finish.
//!
//! Flip iterations are recorded ahead, some more than the last round took: those that find nothing
//! to do cost microseconds, and what they leave undone is taken up in the next round. No flip is
//! lost for want of room: when the slots (3D only) or the history run out, flips wait in the active
//! list until there is more.
//!
//! All of it is generic over the number `D` of coordinates; [`Dim`](crate::gpu::dim::Dim) and
//! [`Finish`] are what the dimensions supply.

mod buffers;
mod finish;
mod flip;
mod insert;
mod kernels;
mod memory;
mod relocate;
mod run;
mod settings;
mod stages;
mod stats;

pub use buffers::{Buffers, Slot};
pub use finish::{Aliases, Copied, Copies, Finish, Step};
pub use kernels::Phase1;
pub use run::{Input, Phase1Output, Run};
pub use settings::Settings;
pub use stats::Phase1Stats;
