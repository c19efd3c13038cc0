//! What meshes of both dimensions have in common, and a mesh with the index that finds its simplices.

use gdel::{
    Clip, Editable, Error, Locator, Mesh, Mesh2, Mesh3, Points, Transport, TransportOptions, Triangulator,
    internals::{
        derived::{AlphaEdges, StolenMeasures, SurfaceMesh, VoronoiShapes},
        geometry::Euclidean,
    },
    verify::Report,
};
use self_cell::self_cell;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// What the shapes of simplices are.
pub(crate) struct Shapes<const D: usize> {
    pub(crate) circumcenters: Vec<[f64; D]>,
    pub(crate) circumradii: Vec<f64>,
    pub(crate) volumes: Vec<f64>,
    pub(crate) radius_ratios: Vec<f64>,
}

/// The arrays of a mesh.
pub(crate) struct Arrays<const N: usize> {
    pub(crate) simplices: Vec<[u32; N]>,
    /// The neighbours, in 2D the half-edges.
    pub(crate) links: Vec<[u32; N]>,
    /// The facets of the hull, in 2D its vertices.
    pub(crate) hull: Vec<u32>,
    pub(crate) duplicate_of: Vec<u32>,
    /// In 2D.
    pub(crate) constraints: Vec<[u32; 2]>,
    /// None for a Delaunay triangulation.
    pub(crate) weights: Vec<f64>,
    pub(crate) hidden: Vec<u32>,
    pub(crate) dimension: u8,
}

/// A mesh of one of the dimensions.
pub(crate) trait Core<const D: usize, const N: usize>:
    Mesh<D, N> + Editable<D> + Default + Clone + Send + Sync + 'static
{
    /// A locator with what it borrows.
    type Located: Send + Sync;

    fn triangulate(triangulator: &Triangulator, points: Points<'_, D>) -> Result<Self, Error>;
    /// Triangulates weighted points.
    fn regular(triangulator: &Triangulator, points: Points<'_, D>, weights: &[f64]) -> Result<Self, Error>;
    /// Finds the weights with which the cells of points have given volumes.
    fn transport(
        triangulator: &Triangulator,
        points: Points<'_, D>,
        clip: Clip<'_, D>,
        options: &TransportOptions<'_>,
    ) -> Result<Transport, Error>;
    /// Returns the points that are no vertices because of their weights.
    fn hidden(&self) -> &[u32];
    fn from_arrays(arrays: Arrays<N>) -> Self;
    /// Returns the neighbours, in 2D the half-edges.
    fn links(&self) -> &[[u32; N]];
    /// Returns the facets of the hull, in 2D its vertices.
    fn hull(&self) -> &[u32];
    /// Returns the facets of the hull.
    fn hull_facets(&self) -> Vec<[u32; D]>;
    fn dimension(&self) -> u8;
    fn shapes(&self, points: Points<'_, D>) -> Shapes<D>;
    fn verify(&self, points: Points<'_, D>) -> Result<Report, Error>;
    /// Returns whether a point is on the circumsphere of a simplex.
    fn is_cospherical(corners: [[f64; D]; N], point: [f64; D]) -> bool;
    fn locate(owner: Owner<Self, D>) -> Result<Self::Located, Error>;
    fn locator(located: &Self::Located) -> &Locator<'_, D, N>;
}

/// The bounds of everything that is derived from a mesh.
pub(crate) trait Derives<const D: usize, const N: usize>:
    AlphaEdges<D, N> + StolenMeasures<D, N> + SurfaceMesh<D, N> + VoronoiShapes<D, N>
{
}

impl Derives<2, 3> for Euclidean {}
impl Derives<3, 4> for Euclidean {}

/// A copy of the points of a mesh.
pub(crate) enum Coordinates<const D: usize> {
    F32(Vec<[f32; D]>),
    F64(Vec<[f64; D]>),
}

impl<const D: usize> Coordinates<D> {
    fn new(points: Points<'_, D>) -> Self {
        match points {
            Points::F32(points) => Coordinates::F32(points.to_vec()),
            Points::F64(points) => Coordinates::F64(points.to_vec()),
        }
    }

    fn points(&self) -> Result<Points<'_, D>, Error> {
        match self {
            Coordinates::F32(points) => Points::from_interleaved_f32(points.as_flattened()),
            Coordinates::F64(points) => Points::from_interleaved_f64(points.as_flattened()),
        }
    }
}

/// What a locator borrows.
pub(crate) struct Owner<M, const D: usize> {
    mesh: Arc<M>,
    points: Coordinates<D>,
}

type Locator2<'a> = Locator<'a, 2, 3>;
type Locator3<'a> = Locator<'a, 3, 4>;

self_cell!(
    pub(crate) struct Located2 {
        owner: Owner<Mesh2, 2>,
        #[covariant]
        dependent: Locator2,
    }
);

self_cell!(
    pub(crate) struct Located3 {
        owner: Owner<Mesh3, 3>,
        #[covariant]
        dependent: Locator3,
    }
);

/// Implements what both meshes do in the same way.
macro_rules! common {
    ($D:literal, $N:literal, $located:ident, $links:ident, $triangulate:ident, $regular:ident, $transport:ident, $measures:ident, $verify:ident) => {
        type Located = $located;

        fn triangulate(triangulator: &Triangulator, points: Points<'_, $D>) -> Result<Self, Error> {
            triangulator.$triangulate(points)
        }
        fn regular(triangulator: &Triangulator, points: Points<'_, $D>, weights: &[f64]) -> Result<Self, Error> {
            triangulator.$regular(points, weights)
        }
        fn transport(
            triangulator: &Triangulator,
            points: Points<'_, $D>,
            clip: Clip<'_, $D>,
            options: &TransportOptions<'_>,
        ) -> Result<Transport, Error> {
            triangulator.$transport(points, clip, options)
        }
        fn hidden(&self) -> &[u32] {
            &self.hidden
        }
        fn links(&self) -> &[[u32; $N]] {
            &self.$links
        }
        fn dimension(&self) -> u8 {
            self.dimension
        }
        fn shapes(&self, points: Points<'_, $D>) -> Shapes<$D> {
            Shapes {
                circumcenters: self.circumcenters(points).collect(),
                circumradii: self.circumradii(points).collect(),
                volumes: self.$measures(points).collect(),
                radius_ratios: self.radius_ratios(points).collect(),
            }
        }
        fn verify(&self, points: Points<'_, $D>) -> Result<Report, Error> {
            gdel::$verify(points, self)
        }
        fn locate(owner: Owner<Self, $D>) -> Result<$located, Error> {
            $located::try_new(owner, |owner| Locator::new(&*owner.mesh, owner.points.points()?))
        }
        fn locator(located: &$located) -> &Locator<'_, $D, $N> {
            located.borrow_dependent()
        }
    };
}

impl Core<3, 4> for Mesh3 {
    common!(3, 4, Located3, neighbors, delaunay3d, regular3d, transport3d, volumes, verify3d);

    fn from_arrays(arrays: Arrays<4>) -> Self {
        let mut mesh = Mesh3::default();
        (mesh.tetrahedra, mesh.neighbors) = (arrays.simplices, arrays.links);
        mesh.hull = arrays.hull.as_chunks().0.to_vec();
        (mesh.duplicate_of, mesh.dimension) = (arrays.duplicate_of, arrays.dimension);
        (mesh.weights, mesh.hidden) = (arrays.weights, arrays.hidden);
        mesh
    }
    fn hull(&self) -> &[u32] {
        self.hull.as_flattened()
    }
    fn hull_facets(&self) -> Vec<[u32; 3]> {
        self.hull.clone()
    }
    fn is_cospherical([a, b, c, d]: [[f64; 3]; 4], point: [f64; 3]) -> bool {
        gdel::insphere(a, b, c, d, point) == 0
    }
}

impl Core<2, 3> for Mesh2 {
    common!(2, 3, Located2, halfedges, delaunay2d, regular2d, transport2d, areas, verify2d);

    fn from_arrays(arrays: Arrays<3>) -> Self {
        let mut mesh = Mesh2::default();
        (mesh.triangles, mesh.halfedges, mesh.hull) = (arrays.simplices, arrays.links, arrays.hull);
        (mesh.duplicate_of, mesh.dimension) = (arrays.duplicate_of, arrays.dimension);
        (mesh.weights, mesh.hidden) = (arrays.weights, arrays.hidden);
        mesh.constraints = arrays.constraints;
        mesh
    }
    fn hull(&self) -> &[u32] {
        &self.hull
    }
    fn hull_facets(&self) -> Vec<[u32; 2]> {
        self.hull_edges().collect()
    }
    fn is_cospherical([a, b, c]: [[f64; 2]; 3], point: [f64; 2]) -> bool {
        gdel::incircle(a, b, c, point) == 0
    }
}

/// A mesh that does not change any more, with its locator once somebody has asked for it.
pub(crate) struct Data<M: Core<D, N>, const D: usize, const N: usize> {
    pub(crate) mesh: Arc<M>,
    located: OnceLock<M::Located>,
    /// Taken while the locator is made, so that only one is.
    making: Mutex<()>,
}

impl<M: Core<D, N>, const D: usize, const N: usize> Data<M, D, N> {
    pub(crate) fn new(mesh: M) -> Self {
        Data { mesh: Arc::new(mesh), located: OnceLock::new(), making: Mutex::default() }
    }

    /// Returns the locator, which keeps a copy of the points.
    pub(crate) fn locator(&self, points: Points<'_, D>) -> Result<&Locator<'_, D, N>, Error> {
        let _making = self.located.get().is_none().then(|| self.making.lock().unwrap_or_else(PoisonError::into_inner));
        let located = match self.located.get() {
            Some(located) => located,
            None => {
                let owner = Owner { mesh: self.mesh.clone(), points: Coordinates::new(points) };
                let located = M::locate(owner)?;
                self.located.get_or_init(|| located)
            }
        };
        Ok(M::locator(located))
    }
}
