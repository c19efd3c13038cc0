//! What is derived from meshes, against brute force.

mod alpha;
mod balls;
mod border;
mod broken;
#[path = "../shared/clouds.rs"]
mod clouds;
mod constrained;
mod contours;
mod evidence;
mod flat;
mod geometry;
mod inputs;
mod interpolate;
mod locate;
mod nearest;
mod refine;
mod smooth;
mod sphere;
mod surface;
mod surfaces_pinned;
mod transport;
mod tree;
mod unused;
mod voronoi;
mod weighted;
