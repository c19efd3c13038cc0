//! Reference implementations of the GPU kernels on the CPU, for tests only: production code never
//! imports them.
//!
//! A reference is a loop over the invocations of its kernel. No result depends on the order of that
//! loop, except for which of several equal things is taken (a free slot, a number in the history):
//! what one invocation writes, no other reads before the next kernel. So the references prove the
//! algorithm, and each is the oracle of the kernel of its name.
//!
//! What is the same in both dimensions is generic over the number `D` of coordinates. [`dim`] has
//! the traits that supply the rest, and [`d2`] and [`d3`] implement them.

mod begin_round;
pub mod d2;
pub mod d3;
pub mod dim;
mod flip_check;
mod flip_commit;
mod flip_link;
pub mod hilbert;
pub mod kernels;
mod locate;
mod pick;
mod relocate;
pub mod run;
mod split;
mod state;
mod symbolic;
mod ties;
mod validate;
mod vertex;

pub use begin_round::begin_round;
pub use flip_check::flip_check;
pub use flip_commit::flip_commit;
pub use flip_link::flip_link;
pub use locate::{locate, start_mesh};
pub use pick::{pick_point, pick_score};
pub use relocate::relocate;
pub use split::{relocate_split, split};
pub use state::State;
pub use symbolic::{incircle_symbolic, insphere_symbolic};
pub use vertex::Vertex;
