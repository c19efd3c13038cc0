//! The kernels of Phase 1, one function each, on the CPU.
//!
//! A reference is a loop over the threads of its kernel. No result depends on the order of that loop except for which of
//! several equal things is taken (a free slot, a number in the history): what one thread writes, no other reads before
//! the next kernel. So the references prove the algorithm, and each is the oracle of the kernel of its name.

mod flip_check;
mod flip_commit;
mod flip_link;
pub mod hilbert;
mod locate;
mod mark_failed;
mod pick;
pub mod predicates;
mod relocate;
pub mod run;
mod split;
mod state;
mod validate;

pub use flip_check::flip_check;
pub use flip_commit::flip_commit;
pub use flip_link::{flip_compact, flip_link};
pub use locate::{locate, start};
pub use mark_failed::mark_failed;
pub use pick::{pick_point, pick_score};
pub use relocate::relocate;
pub use split::{relocate_split, split};
pub use state::State;
pub(crate) use state::scramble;
