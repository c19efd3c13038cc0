//! The triangulation on the CPU, the predicates and the verifier.

mod broken;
#[path = "../shared/clouds.rs"]
mod clouds;
#[path = "../shared/degenerate.rs"]
mod degenerate;
#[path = "../shared/motions.rs"]
mod motions;
mod oracle;

mod constrained;
mod conversions;
mod d2_canonical;
mod d2_verifier;
mod d3_canonical;
mod d3_verifier;
mod editing;
mod fingerprints;
mod generate;
mod inputs;
mod meshes;
mod moving;
mod predicates;
mod refining;
mod regular;
mod threads;
mod tiles;
mod tin;
mod trackers;
mod typescript;
