//! The parts of the references that are specific to 2D.

mod dim;
mod flip_check;
mod flip_commit;
mod mesh;
mod pick;
pub mod predicates;
mod validate;

pub use mesh::{mesh_compact, mesh_mark};
