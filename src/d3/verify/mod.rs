//! Verification of a 3D mesh: see [`verify`](mod@crate::verify) for what is checked and why it is
//! enough.

pub(crate) mod complex;
pub(crate) mod geometry;

use crate::{
    d3::Mesh3,
    error::Error,
    input::points::Points3,
    predicates::orient3d,
    verify::{
        Check, Defect, Outcome, Report,
        hidden::Simplices,
        input::{Input, dimension_3d},
    },
};
use complex::Complex;

/// What a 3D mesh states: at least its tetrahedra. What is `None` is not checked.
///
/// # Examples
///
/// ```
/// use gdel::{MeshView3, verify3d};
///
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
/// // A mesh of another program, with its own arrays.
/// let mut mesh = MeshView3::of_tetrahedra(&[[0, 1, 2, 3]]);
/// mesh.neighbors = Some(&[[gdel::NONE; 4]]);
/// assert!(verify3d(&points, mesh)?.passed());
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct MeshView3<'a> {
    /// The vertices of each tetrahedron: see [`Mesh3::tetrahedra`].
    pub tetrahedra: &'a [[u32; 4]],
    /// The tetrahedra across the facets: see [`Mesh3::neighbors`].
    pub neighbors: Option<&'a [[u32; 4]]>,
    /// The triangles of the hull in any order, each from any of its vertices on: see
    /// [`Mesh3::hull`].
    pub hull: Option<&'a [[u32; 3]]>,
    /// The points that stand for duplicates: see [`Mesh3::duplicate_of`].
    pub duplicate_of: Option<&'a [u32]>,
    /// The affine dimension of the points: see [`Mesh3::dimension`].
    pub dimension: Option<u8>,
    /// The weights of the points, if the mesh is to be their regular triangulation: see [`Mesh3::weights`].
    pub weights: Option<&'a [f64]>,
    /// The points that are no vertices because of their weights: see [`Mesh3::hidden`].
    pub hidden: Option<&'a [u32]>,
}

impl<'a> MeshView3<'a> {
    /// Creates the view of a mesh of which only the tetrahedra are known.
    pub fn of_tetrahedra(tetrahedra: &'a [[u32; 4]]) -> Self {
        MeshView3 { tetrahedra, ..MeshView3::default() }
    }
}

impl<'a> From<&'a Mesh3> for MeshView3<'a> {
    fn from(mesh: &'a Mesh3) -> Self {
        MeshView3 {
            tetrahedra: &mesh.tetrahedra,
            neighbors: Some(&mesh.neighbors),
            hull: Some(&mesh.hull),
            duplicate_of: Some(&mesh.duplicate_of),
            dimension: Some(mesh.dimension),
            weights: (!mesh.weights.is_empty()).then_some(&mesh.weights),
            hidden: Some(&mesh.hidden),
        }
    }
}

/// Checks that `mesh`, whoever computed it, is the Delaunay triangulation of `points`, or the regular one
/// if it states weights, except for those that it states to be [unused](Mesh3::is_unused).
///
/// ```
/// use gdel::{MeshView3, verify3d};
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
/// assert!(verify3d(&points, MeshView3::of_tetrahedra(&[[0, 1, 2, 3]]))?.passed());
/// let inside_out = verify3d(&points, MeshView3::of_tetrahedra(&[[1, 0, 2, 3]]))?;
/// assert_eq!(inside_out.failures().next().unwrap().0.name(), "orientation");
/// # Ok::<(), gdel::Error>(())
/// ```
///
/// # Errors
///
/// Returns [`Error::NotFinite`] when a coordinate is NaN or infinite, and [`Error::TooManyPoints`]
/// when an index cannot name every point; for weights [`Error::ValueCount`] and [`Error::BadWeight`]. A defect of the mesh is not an error but a failed check
/// in the [`Report`].
pub fn verify3d<'p, 'm>(points: impl Into<Points3<'p>>, mesh: impl Into<MeshView3<'m>>) -> Result<Report, Error> {
    let mesh = mesh.into();
    let input = Input::new(points.into(), mesh.weights, mesh.duplicate_of, dimension_3d)?;
    let mut report = input.report(mesh.dimension, mesh.duplicate_of);
    report.counts.tetrahedra = mesh.tetrahedra.len();
    let indices = complex::check_indices(mesh.tetrahedra, input.points.len()).into();
    let mut complex = match indices {
        Outcome::Passed => Complex::new(mesh.tetrahedra, input.points.len()),
        _ => Complex::default(),
    };
    report.decide(Check::Indices, || indices);
    report.counts.vertices = complex.vertices;
    report.counts.edges = complex.edges;
    report.counts.facets = complex.facets;
    report.counts.hull_triangles = complex.hull.len();

    report.decide(Check::Vertices, || input.check_vertices(mesh.tetrahedra, "tetrahedron", Defect::at_tetrahedron));
    report.decide(Check::Orientation, || geometry::check_orientation(&input.points, mesh.tetrahedra));
    report.decide(Check::Facets, || complex.check_facets());
    report.decide(Check::Neighbors, || mesh.neighbors.map(|stated| complex.check_neighbors(stated)));
    report.decide_delaunay(|| geometry::check_delaunay(&input, &complex));
    report.decide(Check::Hull, || mesh.hull.map(|stated| complex.check_hull(stated)));
    let mut ridges = Vec::new();
    report.decide(Check::HullClosed, || complex.check_hull_closed(&mut ridges));
    report.decide(Check::HullConvex, || geometry::check_hull_convex(&input.points, &complex, &ridges));
    report.decide(Check::EulerCharacteristic, || complex.check_euler_characteristic());
    report.decide(Check::Covering, || geometry::check_covering(&input.points, &complex));
    let simplices = Simplices {
        simplices: mesh.tetrahedra,
        across: &|t, k| complex.across[t][k],
        orientation: |[a, b, c, d]| orient3d(a, b, c, d),
        is_below: &|[a, b, c, d], e| geometry::insphere_of(&input, [a, b, c, d, e]).iter().any(|&sign| sign > 0),
        blame: Defect::at_tetrahedron,
    };
    report.decide(Check::Hidden, || simplices.check(&input, mesh.hidden));
    Ok(report)
}
