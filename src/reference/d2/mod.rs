//! The kernels of the plane, one function each, on the CPU: see [`gpu::reference`](crate::reference::d3).

mod flip;
mod locate;
mod mesh;
mod pick;
pub mod predicates;
mod relocate;
pub mod run;
mod split;
mod state;
mod validate;

pub use flip::{flip_check, flip_commit, flip_link};
pub use locate::{locate, start};
pub use mesh::{mesh_compact, mesh_mark};
pub use pick::{pick_point, pick_score};
pub use relocate::relocate;
pub use split::{relocate_split, split};
pub use state::State;
