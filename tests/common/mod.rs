//! What several test programs share.

pub mod cases;
pub mod phase1;
