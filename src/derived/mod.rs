//! What is derived from a triangulation: point location, nearest vertices, interpolation, Voronoi
//! diagrams and their weights for given volumes, contours, alpha shapes of points and balls, minimum spanning trees and closed surfaces, written once for 2D and 3D; and points
//! on a sphere.
//!
//! Signs are exact: which simplex contains a point, which vertex is nearest, which simplices belong
//! to an alpha shape. Lengths, areas, volumes and weights are `f64` with a stated error. Results
//! are a function of the mesh and the query, whatever the number of threads.

mod alpha;
mod balls;
mod border;
mod complex;
mod contours;
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
mod device_locator;
mod flat;
mod groups;
mod interpolate;
mod locate;
mod nearest;
mod queries;
mod sets;
mod sorted;
mod sphere;
mod straight;
mod surface;
mod transport;
mod tree;
mod voronoi;

pub use alpha::{AlphaComplex, AlphaEdges, AlphaShape, AlphaShape2, FaceClass, Interval, SingularEdges, singular};
pub use balls::{BallComplex, BallComplex2};
pub use contours::{Contour, Contours, Contours2};
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub use device_locator::{DeviceLocator, DeviceLocator2, Locations};
pub use interpolate::{
    Duplicates, Grid, Interpolated, Interpolation, Interpolator, Interpolator2, Outside, StolenMeasures, WeightTable,
};
pub use locate::{Location, Locator, Locator2};
pub use sets::DisjointSets;
pub use sphere::{Sphere, lon_lat, on_sphere};
pub use surface::{Evidence, Open, Side, Surface, SurfaceMesh, SurfaceOptions, crossing_facets};
pub use transport::{Transport, TransportOptions, sites_by_halves, transport};
pub use tree::SpanningTree;
pub use voronoi::{Cell, Clip, Diagram, Voronoi, Voronoi2, VoronoiShapes};
