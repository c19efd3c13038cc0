//! Records how a mesh is made step by step, to look at small inputs.

use crate::{
    d3::{
        mesh::FACETS,
        triangulation::{Triangulation3, state},
    },
    error::Error,
    gpu::{Gpu, Readback, phase1::Phase1Run},
    parallel::{self, Threads},
    predicates::filter::PredicateContext3,
    stats::Trace,
};

/// Collects a [`Trace`].
#[derive(Debug, Default)]
pub struct Tracer {
    trace: Trace,
}

impl Tracer {
    /// Reads all tetrahedra back, after a round of Phase 1.
    pub(crate) async fn round(&mut self, gpu: &Gpu, run: &Phase1Run<'_, 3>) -> Result<(), Error> {
        let (buffers, infinite) = (run.buffers(), run.control().0.infinite);
        let mut readback = Readback::default();
        let slots = readback.read(gpu, &buffers.simplices, 0, buffers.simplices.len()).await?;
        let pairs = readback.read(gpu, &buffers.points.pairs, 0, buffers.points.pairs.len()).await?;
        let tetrahedra = slots
            .into_iter()
            .filter(|v| *v != [0; 4] && !v.contains(&infinite))
            .map(|v| v.map(|v| pairs[v as usize][1]))
            .collect();
        self.trace.rounds.push(tetrahedra);
        Ok(())
    }

    /// Takes the facets that are not locally Delaunay, before splaying.
    pub(crate) fn facets(&mut self, facets: Vec<[u32; 3]>) {
        self.trace.not_locally_delaunay = facets;
    }

    /// Finds the tetrahedra that splaying has added, at the end.
    pub(crate) fn finish(mut self, tetrahedra: &[[u32; 4]]) -> Trace {
        let sorted = |mut v: [u32; 4]| {
            v.sort_unstable();
            v
        };
        let mut before: Vec<[u32; 4]> = self.trace.rounds.last().into_iter().flatten().copied().map(sorted).collect();
        parallel::sort(Threads::One, &mut before);
        self.trace.splayed = tetrahedra.iter().map(|&v| before.binary_search(&sorted(v)).is_err()).collect();
        self.trace
    }
}

/// Returns the facets between finite tetrahedra that are not locally Delaunay, as input indices.
pub(super) fn facets_not_delaunay(mesh: &Triangulation3, vertices: &PredicateContext3<'_>) -> Vec<[u32; 3]> {
    let mut facets = Vec::new();
    let finite = |t: u32| mesh.state(t) != state::FREE && !mesh.is_ghost(t);
    let is_oriented = |t: u32| {
        let [a, b, c, d] = mesh.vertices(t);
        vertices.orient3d(a, b, c, d) > 0
    };
    for t in (0..mesh.tetrahedra().len() as u32).filter(|&t| finite(t)) {
        for (k, facet) in FACETS.iter().enumerate() {
            let across = mesh.neighbors()[t as usize][k];
            let other = across >> 2;
            if other < t || !finite(other) {
                continue;
            }
            // A flat tetrahedron has no circumsphere; then that on the other side decides.
            let apex = |of: u32, at: u32| mesh.vertices(of)[at as usize & 3];
            let is_inside = if is_oriented(t) {
                vertices.insphere(mesh.vertices(t), apex(other, across)) > 0
            } else {
                is_oriented(other) && vertices.insphere(mesh.vertices(other), apex(t, k as u32)) > 0
            };
            if is_inside {
                let corners = facet.map(|i| vertices.input_index(mesh.vertices(t)[i]));
                facets.push(corners);
            }
        }
    }
    facets
}
