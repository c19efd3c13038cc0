//! The parts of the references that are specific to 3D.

mod dim;
mod flip_check;
mod flip_commit;
pub mod gather;
mod mark_failed;
mod outputs;
mod pick;
pub mod predicates;
mod validate;

pub use dim::OwnState;
pub use mark_failed::mark_failed;
pub use outputs::{outputs_mark, outputs_write};
