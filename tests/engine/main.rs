//! The CPU engines, the predicates and the verifier.

mod broken;
#[path = "../clouds.rs"]
mod clouds;
mod oracle;

mod canonical;
mod fingerprints;
mod inputs;
mod plane_canonical;
mod plane_verifier;
mod predicates;
mod verifier;
