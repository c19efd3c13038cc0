//! What is derived from a triangulation: point location, nearest vertices, interpolation, Voronoi
//! diagrams, alpha shapes, minimum spanning trees and closed surfaces, written once for 2D and 3D.
//!
//! Signs are exact: which simplex contains a point, which vertex is nearest, which simplices belong
//! to an alpha shape. Lengths, areas, volumes and weights are `f64` with a stated error. Results
//! are a function of the mesh and the query, whatever the number of threads.

mod alpha;
mod complex;
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
mod device_locator;
mod interpolate;
mod locate;
mod nearest;
mod queries;
mod sets;
mod sorted;
mod surface;
mod tree;
mod voronoi;

pub use alpha::{AlphaComplex, AlphaEdges, AlphaShape, AlphaShape2, FaceClass, Interval};
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub use device_locator::{DeviceLocator, DeviceLocator2, Locations};
pub use interpolate::{Interpolation, Interpolator, Interpolator2, StolenMeasures};
pub use locate::{Location, Locator, Locator2};
pub use surface::{Evidence, Open, Side, Surface, SurfaceMesh, SurfaceOptions, crossing_facets};
pub use tree::SpanningTree;
pub use voronoi::{Cell, Clip, Diagram, Voronoi, Voronoi2, VoronoiShapes};
