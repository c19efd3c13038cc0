//! Small fixed inputs, on which `instructions.rs` counts instructions. They are the same bit for
//! bit on every machine.

pub mod files;
pub mod points;
pub mod predicates;
pub mod splay;
