//! Turns the caller's slices into lattice points in insertion order, for any dimension.

pub mod hilbert;
pub mod lattice;
pub mod order;
pub mod points;
