//! The 2D parts of tiles.

use super::dim::{Provable, Tiled};
use crate::{
    d2::{
        Mesh2,
        insert::edge_of,
        triangulation::{Triangulation2, edges_to_mesh, vertices_to_mesh},
        verify::{self, Complex},
    },
    dimension::Dimension,
    error::Error,
    index::NONE,
    options::Winding,
    parallel::{self, Threads},
    predicates::{Sign, orient2d},
    triangulator::Triangulator,
    verify::{
        Check,
        input::{Input, dimension_2d},
        report::Findings,
    },
};
use rustc_hash::FxHashMap;

impl Tiled<2, 3> for Dimension<2> {
    const STRIDE: u32 = 3;

    fn slots(triangulation: &Triangulation2) -> u32 {
        triangulation.triangles.len() as u32
    }

    #[inline]
    fn simplex(triangulation: &Triangulation2, t: u32) -> Option<[u32; 3]> {
        Some(triangulation.triangles[t as usize])
    }

    /// Clockwise with the *y* axis up.
    fn ghost_facet(simplex: [u32; 3], infinite: u32) -> Option<[u32; 2]> {
        simplex.iter().position(|&v| v == infinite).map(|k| edge_of(simplex, k))
    }

    fn into_arrays(triangulation: Triangulation2) -> [Vec<[u32; 3]>; 2] {
        [triangulation.triangles, triangulation.neighbors]
    }

    fn rename(threads: Threads, triangulation: &mut Triangulation2, names: &[u32], infinite: u32) {
        triangulation.infinite = infinite;
        parallel::for_chunks(threads, triangulation.triangles.as_flattened_mut(), |_, vertices| {
            vertices.iter_mut().for_each(|v| *v = names.get(*v as usize).copied().unwrap_or(infinite));
        });
    }

    fn move_infinite(triangulation: &mut Triangulation2, infinite: u32) {
        let before = std::mem::replace(&mut triangulation.infinite, infinite);
        let vertices = triangulation.triangles.as_flattened_mut();
        parallel::for_chunks(Threads::One, vertices, |_, vertices| {
            vertices.iter_mut().filter(|v| **v == before).for_each(|v| *v = infinite);
        });
    }

    fn delaunay(triangulator: &Triangulator, points: &[[f64; 2]]) -> Result<Mesh2, Error> {
        triangulator.clone().winding(Winding::CounterClockwise).delaunay2d(points)
    }

    fn of_mesh(_threads: Threads, mesh: Mesh2, infinite: u32) -> Triangulation2 {
        let Mesh2 { triangles, halfedges, hull, .. } = mesh;
        Triangulation2::from_mesh(triangles, halfedges, &hull, infinite, Winding::CounterClockwise)
    }

    fn to_mesh(simplex: [u32; 3], winding: Winding) -> [u32; 3] {
        vertices_to_mesh(simplex, winding)
    }

    fn entries(across: [u32; 3], winding: Winding) -> [u32; 3] {
        edges_to_mesh(across, winding)
    }

    fn place(t: u32, k: usize, winding: Winding) -> [u32; 2] {
        let halfedge = Triangulation2::halfedge_of_edge(4 * t + k as u32, winding);
        [halfedge; 2]
    }

    fn assemble(triangles: Vec<[u32; 3]>, halfedges: Vec<[u32; 3]>, edges: Vec<[u32; 2]>, winding: Winding) -> Mesh2 {
        let next: FxHashMap<u32, u32> = edges.iter().map(|&[from, to]| (from, to)).collect();
        let mut hull = Vec::with_capacity(edges.len());
        let lowest = edges.iter().map(|&[from, _]| from).min();
        let mut at = lowest;
        while let Some(v) = at {
            hull.push(v);
            at = next.get(&v).copied().filter(|&to| Some(to) != lowest && hull.len() < edges.len());
        }
        if winding == Winding::CounterClockwise && !hull.is_empty() {
            hull[1..].reverse();
        }
        Mesh2 { triangles, halfedges, hull, ..Mesh2::default() }
    }
}

impl Provable<2, 3> for Dimension<2> {
    fn dimension_of(points: &[[f64; 2]]) -> u8 {
        dimension_2d(points)
    }

    /// The edge opposite vertex `k` begins at the next.
    fn side(t: u32, k: usize) -> [u32; 2] {
        [3 * t + (k as u32 + 1) % 3; 2]
    }

    fn orientation([a, b, c]: [[f64; 2]; 3]) -> Sign {
        orient2d(a, b, c)
    }

    fn in_sphere([pa, pb, pc]: [[f64; 2]; 3], [a, b, c]: [u32; 3], q: [f64; 2], index: u32) -> [Sign; 2] {
        verify::incircle_at([pa, pb, pc, q], [a, b, c, index])
    }

    fn check_simplices(
        input: &Input<2>,
        simplices: &[[u32; 3]],
        neighbors: Option<&[[u32; 3]]>,
        found: &mut dyn FnMut(Check, Findings),
    ) -> Vec<[u32; 2]> {
        let indices = verify::check_indices(simplices, input.points.len());
        let is_broken = !indices.is_empty();
        found(Check::Indices, indices);
        if is_broken {
            return Vec::new();
        }
        let (complex, facets) = Complex::new(simplices);
        let orientation = verify::check_orientation(&input.points, simplices);
        let is_oriented = orientation.is_empty();
        found(Check::Orientation, orientation);
        found(Check::Facets, facets);
        if let Some(stated) = neighbors {
            let mut findings = Findings::default();
            complex.check_halfedges(stated, &mut findings);
            found(Check::Neighbors, findings);
        }
        if is_oriented {
            let (delaunay, ties) = complex.check_delaunay(input, &[]);
            found(Check::Delaunay, delaunay);
            found(Check::CanonicalTies, ties);
        }
        let sides = (0..).zip(&complex.halfedges).flat_map(|(t, across)| (0..3).map(move |k| (t, k, across)));
        sides.filter(|&(_, k, across)| across[(k + 1) % 3] == NONE).map(|(t, k, _)| [t, k as u32]).collect()
    }

    /// A hull that turns once is covered once.
    fn check_overlaps(_: [[f64; 2]; 3], _: &[[f64; 2]], _: &[[u32; 3]]) -> Findings {
        Findings::default()
    }

    fn check_hull(
        _: [[f64; 2]; 3],
        points: &[[f64; 2]],
        triangles: &[[u32; 3]],
        opposite: &[usize],
    ) -> Vec<(Check, Findings)> {
        let ends = |(t, k): (&[u32; 3], &usize)| [t[(k + 1) % 3], t[(k + 2) % 3]];
        let hull = triangles.iter().zip(opposite).map(ends).collect();
        let complex = Complex { triangles, hull, ..Complex::default() };
        let mut polygon = Vec::new();
        vec![
            (Check::HullClosed, complex.check_hull_closed(&mut polygon)),
            (Check::HullConvex, verify::check_hull_convex(points, &polygon)),
        ]
    }
}
