//! The file formats.
#![cfg(feature = "io")]

mod samples;

mod bad_input;
mod degenerate;
mod glb;
mod laz;
mod meshes;
mod outputs;
mod points;
