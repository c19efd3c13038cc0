//! The host half of each stage, in the order of the data.

pub mod points;

pub mod insert;

pub mod flip;

pub mod relocate;
pub mod waiting;

pub mod finish;

pub mod compact;
pub mod scan;
pub mod sort;
