//! The 3D parts of tiles.

use super::dim::{Provable, Tiled};
use crate::{
    d3::{
        Mesh3,
        triangulation::{FiniteMesh, Triangulation3, state},
        verify::{
            complex::{self, Complex, Side},
            geometry,
        },
    },
    dimension::Dimension,
    error::Error,
    index::NONE,
    options::Winding,
    parallel::{self, Threads},
    predicates::{Sign, orient3d},
    triangulator::Triangulator,
    verify::{
        Check,
        input::{Input, dimension_3d},
        report::Findings,
    },
};

impl Tiled<3, 4> for Dimension<3> {
    const STRIDE: u32 = 1;

    fn slots(triangulation: &Triangulation3) -> u32 {
        triangulation.tetrahedra.len() as u32
    }

    #[inline]
    fn simplex(triangulation: &Triangulation3, t: u32) -> Option<[u32; 4]> {
        (triangulation.state(t) != state::FREE).then(|| triangulation.vertices(t))
    }

    fn ghost_facet([a, b, c, d]: [u32; 4], infinite: u32) -> Option<[u32; 3]> {
        (d == infinite).then_some([a, b, c])
    }

    fn into_arrays(triangulation: Triangulation3) -> [Vec<[u32; 4]>; 2] {
        [triangulation.tetrahedra, triangulation.neighbors]
    }

    fn rename(threads: Threads, triangulation: &mut Triangulation3, names: &[u32], infinite: u32) {
        triangulation.infinite = infinite;
        parallel::for_chunks(threads, &mut triangulation.tetrahedra, |_, simplices| {
            for simplex in simplices.iter_mut().filter(|simplex| simplex[0] & state::MASK != state::FREE) {
                *simplex = simplex.map(|v| names.get(v as usize).copied().unwrap_or(infinite));
            }
        });
    }

    fn move_infinite(triangulation: &mut Triangulation3, infinite: u32) {
        let before = std::mem::replace(&mut triangulation.infinite, infinite);
        let simplices = &mut triangulation.tetrahedra;
        parallel::for_chunks(Threads::One, simplices, |_, simplices| {
            simplices.iter_mut().filter(|t| t[3] == before).for_each(|t| t[3] = infinite);
        });
    }

    fn delaunay(triangulator: &Triangulator, points: &[[f64; 3]]) -> Result<Mesh3, Error> {
        triangulator.delaunay3d(points)
    }

    fn of_mesh(threads: Threads, mesh: Mesh3, infinite: u32) -> Triangulation3 {
        let Mesh3 { tetrahedra, neighbors, hull, .. } = mesh;
        Triangulation3::from_mesh(FiniteMesh { tetrahedra, neighbors, hull }, infinite, threads)
    }

    fn to_mesh(simplex: [u32; 4], _winding: Winding) -> [u32; 4] {
        simplex
    }

    fn entries(across: [u32; 4], _winding: Winding) -> [u32; 4] {
        across.map(|f| if f == NONE { NONE } else { f >> 2 })
    }

    fn place(t: u32, k: usize, _winding: Winding) -> [u32; 2] {
        [4 * t + k as u32, t]
    }

    fn assemble(tetrahedra: Vec<[u32; 4]>, neighbors: Vec<[u32; 4]>, hull: Vec<[u32; 3]>, _winding: Winding) -> Mesh3 {
        Mesh3 { tetrahedra, neighbors, hull, ..Mesh3::default() }
    }
}

impl Provable<3, 4> for Dimension<3> {
    fn dimension_of(points: &[[f64; 3]]) -> u8 {
        dimension_3d(points)
    }

    fn side(t: u32, k: usize) -> [u32; 2] {
        Self::place(t, k, Winding::default())
    }

    fn orientation([a, b, c, d]: [[f64; 3]; 4]) -> Sign {
        orient3d(a, b, c, d)
    }

    fn in_sphere([pa, pb, pc, pd]: [[f64; 3]; 4], [a, b, c, d]: [u32; 4], q: [f64; 3], index: u32) -> [Sign; 2] {
        geometry::insphere_at([pa, pb, pc, pd, q], [a, b, c, d, index])
    }

    fn check_simplices(
        input: &Input<3>,
        simplices: &[[u32; 4]],
        neighbors: Option<&[[u32; 4]]>,
        found: &mut dyn FnMut(Check, Findings),
    ) -> Vec<[u32; 2]> {
        let indices = complex::check_indices(simplices, input.points.len());
        let is_broken = !indices.is_empty();
        found(Check::Indices, indices);
        if is_broken {
            return Vec::new();
        }
        let mut complex = Complex::new(simplices, input.points.len());
        let orientation = geometry::check_orientation(&input.points, simplices);
        let is_oriented = orientation.is_empty();
        found(Check::Orientation, orientation);
        found(Check::Facets, complex.check_facets());
        if let Some(stated) = neighbors {
            found(Check::Neighbors, complex.check_neighbors(stated));
        }
        if is_oriented {
            let (delaunay, ties) = geometry::check_delaunay(input, &complex);
            found(Check::Delaunay, delaunay);
            found(Check::CanonicalTies, ties);
        }
        complex.hull.iter().map(|side| [side.tetrahedron as u32, side.k as u32]).collect()
    }

    fn check_overlaps(inside: [[f64; 3]; 4], points: &[[f64; 3]], simplices: &[[u32; 4]]) -> Findings {
        geometry::check_overlaps(inside, points, simplices)
    }

    fn check_hull(
        inside: [[f64; 3]; 4],
        points: &[[f64; 3]],
        tetrahedra: &[[u32; 4]],
        opposite: &[usize],
    ) -> Vec<(Check, Findings)> {
        let hull = opposite.iter().enumerate().map(|(tetrahedron, &k)| Side { tetrahedron, k }).collect();
        let complex = Complex { tetrahedra, hull, ..Complex::default() };
        let mut ridges = Vec::new();
        vec![
            (Check::HullClosed, complex.check_hull_closed(&mut ridges)),
            (Check::HullConvex, geometry::check_hull_convex(points, &complex, &ridges)),
            (Check::Covering, geometry::check_hull_turned(inside, points, &complex)),
        ]
    }
}
