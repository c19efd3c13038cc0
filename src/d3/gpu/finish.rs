//! The end of Phase 1: failed vertices (§3.2.1), the mesh without gaps, and what is flat or left
//! open by rounding.

use crate::{
    d3::gpu::{aliases::Aliases, outputs::OutputStage},
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Pending,
        layout::{Active, Counters},
        phase1::{Buffers, Copied, Copies, Finish},
    },
    index::NONE,
    parallel::{self, Threads},
};

/// A triangulation whose only facets that are not locally Delaunay cannot be flipped.
///
/// Vertices are places in the input. All tetrahedra are positively oriented in the sense of the
/// perturbed predicates: there can be flat ones.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NearMesh {
    /// Four vertices per tetrahedron, the finite ones first. The infinite ones have the vertex at
    /// infinity, the number of points, last.
    pub tets: Vec<[u32; 4]>,
    /// Entry *k* is 4·tetrahedron + face across the facet opposite vertex *k*.
    pub neighbors: Vec<[u32; 4]>,
    /// The number of finite tetrahedra.
    pub finite: usize,
    /// The vertices with a facet that is not locally Delaunay, ascending.
    pub failed: Vec<u32>,
    /// One tetrahedron of each vertex, infinity last; [`NONE`](crate::NONE) for points
    /// that are merged into others.
    pub vertex_simplex: Vec<u32>,
    /// Tetrahedra, ascending, that are flat (bit 4); and where coordinates were rounded to the
    /// lattice, those of which it does not prove everything: whether facet *k* is locally Delaunay
    /// (bit *k*), or the orientation (bit 4). Each facet is listed with one of its tetrahedra.
    pub uncertain: Vec<[u32; 2]>,
}

/// The readbacks beside those of the tetrahedra and their neighbours.
pub struct Reading {
    vertex_simplex: Pending<u32>,
    failed: Pending<u32>,
    uncertain: Pending<Active>,
}

/// Returns whether all vertices, the last of which is infinity, and all neighbours are there.
fn is_triangulation(tets: &[[u32; 4]], neighbors: &[[u32; 4]], points: usize) -> bool {
    let parts = parallel::map_ranges(Threads::All, tets.len(), |range| {
        let are_vertices = |v: &[u32; 4]| v[..3].iter().all(|&v| (v as usize) < points) && v[3] as usize <= points;
        let are_here = |across: &[u32; 4]| across.iter().all(|across| ((across >> 2) as usize) < tets.len());
        tets[range.clone()].iter().all(are_vertices) && neighbors[range].iter().all(are_here)
    });
    !parts.contains(&false)
}

impl Finish<3> for Dimension<3> {
    type Aliases = Aliases;
    type Reading = Reading;
    type Result = NearMesh;
    type Outputs = OutputStage;

    fn outputs(compiler: &Compiler<'_>) -> OutputStage {
        OutputStage::new(compiler)
    }

    fn mesh_len(finite: usize, counters: &Counters) -> usize {
        finite + counters.ghosts as usize
    }

    fn copy(copies: &mut Copies<'_>, b: &Buffers<3>, aliases: &Aliases, counters: &Counters) -> Reading {
        Reading {
            vertex_simplex: copies.copy(&b.own.vertex_simplex, b.own.vertex_simplex.len()),
            failed: copies.copy(&aliases.failed, counters.failed as usize),
            uncertain: copies.copy(&aliases.uncertain, counters.uncertain as usize),
        }
    }

    async fn receive(
        copied: &mut Copied<'_>,
        reading: Reading,
        [tets, neighbors]: [Vec<[u32; 4]>; 2],
        finite: usize,
    ) -> Result<NearMesh, Error> {
        let mut vertex_simplex = copied.receive(reading.vertex_simplex).await?;
        let mut failed = copied.receive(reading.failed).await?;
        let uncertain = copied.receive(reading.uncertain).await?;

        vertex_simplex.iter_mut().for_each(|t: &mut u32| *t = t.wrapping_sub(1));
        let (points, len) = (vertex_simplex.len() - 1, tets.len());
        if !is_triangulation(&tets, &neighbors, points) {
            return Err(copied.gpu.wrong("a tetrahedron has a vertex or a neighbour that is none"));
        }
        let is_listed = failed.iter().all(|&v: &u32| (v as usize) < points)
            && uncertain.iter().all(|entry: &Active| (entry.tet as usize) < len)
            && vertex_simplex.iter().all(|&t| t == NONE || (t as usize) < len);
        if !is_listed {
            return Err(copied.gpu.wrong("a failed vertex or an uncertain tetrahedron is none"));
        }
        failed.sort_unstable();
        let mut uncertain: Vec<[u32; 2]> = uncertain.into_iter().map(|a| [a.tet, a.outcome]).collect();
        uncertain.sort_unstable();
        Ok(NearMesh { tets, neighbors, finite, failed, vertex_simplex, uncertain })
    }
}
