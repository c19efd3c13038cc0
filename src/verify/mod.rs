//! Whether a mesh is the Delaunay triangulation of its points: decided exactly, and independently
//! of how it was made.
//!
//! The checks are local but together sufficient (Mehlhorn et al., *Checking geometric programs or
//! verification of geometric structures*, 1999):
//!
//! 1. The tetrahedra are positively oriented and meet across facets from either side, so the map of
//!    the mesh into 3D space covers every point away from the hull triangles a number of times that
//!    changes at those triangles only.
//! 2. A point inside one tetrahedron sees all hull triangles from their inner side and is covered
//!    once. So every ray from it leaves through one hull triangle, the hull bounds a star-shaped
//!    body, and its inside is covered once.
//! 3. The hull has no concave edge, so the body is convex; every distinct point is a vertex, so it
//!    is the convex hull.
//! 4. A triangulation of the convex hull that is locally Delaunay across every facet is a Delaunay
//!    triangulation, and one that is so for perturbed heights is the only one.
//!
//! With weights, which make it the regular triangulation, a point may be no vertex instead of (3), and in (4) lifted
//! simplices take the place of circumspheres. A point that is no vertex lies in a simplex, and above it when both are
//! lifted: then it is above the lower side of the lifted points' hull, and the vertices alone are on that.
//!
//! With constraints in 2D, which are edges, (4) holds without the test across them: for a given set of constrained
//! edges there is only one such triangulation.
//!
//! 2D is simpler. Triangles that are all oriented alike and meet across edges from either side
//! cover a point as often as their boundary winds around it: once inside, if that is a convex
//! polygon that turns once.

pub(crate) mod constraints;
pub(crate) mod hidden;
pub(crate) mod input;
pub(crate) mod report;

pub use report::{Check, Counts, Defect, Outcome, Report};
