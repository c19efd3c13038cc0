//! What is derived from meshes, against brute force.

#[path = "../clouds.rs"]
mod clouds;
mod geometry;
mod inputs;
mod locate;
mod nearest;
