//! What is derived from meshes, against brute force.

mod alpha;
mod broken;
#[path = "../shared/clouds.rs"]
mod clouds;
mod evidence;
mod geometry;
mod inputs;
mod interpolate;
mod locate;
mod nearest;
mod refine;
mod surface;
mod surfaces_pinned;
mod tree;
mod unused;
mod voronoi;
