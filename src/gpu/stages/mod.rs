//! The host half of each stage, in the order of the data.

pub mod compact;
pub mod finish;
pub mod flip;
pub mod hilbert;
pub mod insert;
pub mod order;
pub mod relocate;
pub mod scan;
pub mod sort;
