//! The host of the GPU, its kernels and stages, and Phase 1: against their references on the CPU, and the references on their own.
#![cfg(feature = "gpu")]

mod cases;
mod kernels;
#[path = "../engine/oracle.rs"]
mod oracle;
mod perturbation;
mod phase1_inputs;
mod plane_cases;
mod plane_inputs;
mod positions;
mod signs;

mod certify;
mod host;
mod phase1;
mod phase1_kernels;
mod phase1_twins;
mod plane;
mod plane_kernels;
mod plane_predicates;
mod plane_twins;
mod points;
mod predicate_twin;
mod predicates;
mod primitives;
mod shaders;
