//! The 3D parts of tiles.

use super::{dim::Tiled, in_pieces};
use crate::{
    d3::{
        Mesh3,
        triangulation::{Triangulation3, state},
    },
    dimension::Dimension,
    index::NONE,
    options::Winding,
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

    fn rename(triangulation: &mut Triangulation3, names: &[u32], infinite: u32) {
        triangulation.infinite = infinite;
        let simplices = &mut triangulation.tetrahedra;
        in_pieces(simplices.len() as u32, &mut |piece| {
            for simplex in &mut simplices[piece.start as usize..piece.end as usize] {
                if simplex[0] & state::MASK != state::FREE {
                    *simplex = simplex.map(|v| names.get(v as usize).copied().unwrap_or(infinite));
                }
            }
        });
    }

    fn move_infinite(triangulation: &mut Triangulation3, infinite: u32) {
        let before = std::mem::replace(&mut triangulation.infinite, infinite);
        let simplices = &mut triangulation.tetrahedra;
        in_pieces(simplices.len() as u32, &mut |piece| {
            let simplices = &mut simplices[piece.start as usize..piece.end as usize];
            simplices.iter_mut().filter(|t| t[3] == before).for_each(|t| t[3] = infinite);
        });
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
