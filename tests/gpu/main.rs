//! The host of the GPU, its kernels and stages, and Phase 1: against their references on the CPU,
//! and the references on their own.
#![cfg(feature = "gpu")]

mod assemble;
#[path = "../shared/clouds.rs"]
mod clouds;
mod d2_cases;
mod d2_inputs;
mod d3_cases;
mod d3_inputs;
#[allow(dead_code)]
#[path = "../derived/inputs.rs"]
mod inputs;
mod kernels;
#[path = "../cpu/oracle.rs"]
mod oracle;
mod perturbation;
mod positions;
mod signs;
mod states;

mod certify;
mod d2_kernels;
mod d2_phase1;
mod d2_predicates;
mod d2_reference;
mod d3_gather;
mod d3_kernels;
mod d3_outputs;
mod d3_phase1;
mod d3_predicates;
mod d3_reference;
mod d3_reference_predicates;
mod host;
mod lint;
mod mesh_checks;
mod messages;
mod moved;
mod mutants;
mod points;
mod primitives;
mod queries;
mod readbacks;
mod self_test;
mod shaders;
