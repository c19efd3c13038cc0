//! Turns the caller's slices into lattice points in insertion order, for any dimension.

pub mod hilbert;
pub mod lattice;
pub mod order;
pub mod points;

pub use order::Order;
pub use points::{Points, Points2, Points3};
