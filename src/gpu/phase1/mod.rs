//! Phase 1: parallel insertion and flipping (§3.1), from lattice points to a nearly Delaunay
//! triangulation.
//!
//! 1. *Points*: lattice, points at the same place, order along the Hilbert curve
//!    ([`points`](crate::gpu::points)). Meanwhile the CPU engine triangulates some of them
//!    ([`start`](crate::gpu::start)), from which the rounds go on.
//! 2. *Rounds*, until no point waits: every simplex with waiting points picks one and is split;
//!    flip iterations until (nearly) none is active; the waiting points follow the history of the
//!    flips.
//! 3. *Last flips*, until no simplex is active. In 2D the result is the Delaunay triangulation of
//!    the lattice's points, with its coordinates perturbed; in 3D flipping can get stuck.
//! 4. *Removals*, in 3D: facets at which it got stuck are removed with those beside them, and flips go on
//!    until no simplex is active again.
//! 5. *Finish*: the mesh without gaps, in input indices, what rounding leaves open, and the one
//!    large readback; in 3D also the failed vertices (§3.2.1).
//!
//! The device drives the rounds: at the beginning of each, a kernel of one invocation decides by the
//! counters what it does. The host submits batches of rounds ahead and reads the counters of one batch
//! while the device works on the next. What it submits is decided by a *plan* (`plan.rs`), which sees
//! nothing but counters; a *round* (`round.rs`) is a list of *stages* (`stages.rs`), each a table of
//! kernels; `record.rs` records them, and `run.rs` drives all this.
//!
//! Flip iterations are recorded ahead, with a dispatch per pass. Those that find nothing to do cost
//! microseconds; flips that they leave undone are done in the next round. In 3D, one workgroup does
//! iterations with few active tetrahedra, all in one dispatch. No flip is lost for want of memory: when
//! slots (3D only) or the history run out, flips wait in the active list until there are more.
//!
//! All of it is generic over the number `D` of coordinates; [`Dim`](crate::gpu::dim::Dim) and
//! [`Finish`] are what the dimensions supply.

mod begin;
mod buffers;
mod capacity;
mod ended;
mod finish;
mod iterations;
mod kernels;
mod memory;
mod moved;
mod plan;
mod record;
mod round;
mod run;
mod settings;
mod stages;
mod stats;

pub use begin::Begin;
pub use buffers::{Buffers, Sizes, Slot};
pub use ended::{Ended, Phase1Output};
pub use finish::{Aliases, Copied, Copies, Finish};
pub use kernels::Phase1;
pub(crate) use memory::Memory;
pub use run::Phase1Run;
pub use settings::{Budget, MemorySettings, Settings, WayToHost};
pub(crate) use stages::Stage;
pub use stats::Phase1Stats;
