//! The file formats.

mod samples;

mod bad_input;
mod colors;
mod degenerate;
mod e57;
mod evidence;
mod glb;
mod laz;
mod meshes;
mod outputs;
mod pieces;
mod points;
mod rasters;
mod shapes;
mod solvers;
mod three_mf;
