//! How the GPU engine of 3D completes what Phase 1 leaves: star splaying on the CPU (the paper's
//! §3).
//!
//! `result of Phase 1 → splay → drop the ghosts → input indices → mesh`

use crate::{
    d3::{
        Mesh3,
        gpu::{finish::NearMesh, trace::Tracer},
        splay::{self, Aborted, NearDelaunay3, SplayOutcome},
        triangulation::{FiniteMesh, Triangulation3},
    },
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu,
        engine::{Complete, Near, progress},
        phase1::Run,
    },
    options::Options,
    parallel::Threads,
    predicates::filter::PredicateContext,
    stats::{Fallback, Phase, Stats},
};

impl Complete<3> for Dimension<3> {
    type Tracer = Option<Tracer>;

    const DEGENERATE: Fallback = Fallback::Coplanar;
    const ROUNDS_SHARE: f64 = 0.6;

    fn tracer(options: &Options) -> Option<Tracer> {
        options.trace.then(Tracer::default)
    }

    async fn trace_round(tracer: &mut Option<Tracer>, gpu: &Gpu, run: &Run<'_, 3>) -> Result<(), Error> {
        match tracer {
            Some(tracer) => tracer.round(gpu, run).await,
            None => Ok(()),
        }
    }

    fn complete(near: Near<'_, 3>, mut tracer: Option<Tracer>) -> Result<Result<Mesh3, Fallback>, Error> {
        let Near { points, lattice, result, missing, duplicate_of, options, stats, stopwatch } = near;
        options.report(Phase::Splay, progress::COMPLETION)?;
        let vertices = PredicateContext::of_input(points, lattice);
        let near = near_delaunay(points.len(), result, &missing);
        if let Some(tracer) = &mut tracer {
            tracer.facets(&near.triangulation, &vertices);
        }
        let max_evaluations = near.evaluations_from_scratch();
        let share = progress::FINISH - progress::COMPLETION;
        let report = |done: f64| options.report(Phase::Splay, progress::COMPLETION + share * done);
        let triangulation = match splay::splay(&vertices, near, max_evaluations, Threads::All, &report)? {
            SplayOutcome::Delaunay(triangulation, splay) => {
                stats.splay = Some(splay);
                triangulation
            }
            SplayOutcome::Aborted(Aborted::BudgetExceeded) => return Ok(Err(Fallback::Splaying)),
            SplayOutcome::Aborted(Aborted::Inconsistent(what)) => return Ok(Err(Fallback::Inconsistent(what))),
        };
        stats.phases.push((Phase::Splay, stopwatch.lap()));

        options.report(Phase::Finish, progress::FINISH)?;
        stats.exact = vertices.exact_counts();
        let FiniteMesh { tetrahedra, neighbors, hull } = triangulation.into_mesh(None, Threads::All);
        stats.phases.push((Phase::Finish, stopwatch.lap()));
        stats.trace = tracer.map(|tracer| tracer.finish(&tetrahedra));
        Ok(Ok(Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension: 3, stats: Stats::default() }))
    }
}

/// Returns the result of Phase 1 in the form that splaying takes.
fn near_delaunay(points: usize, result: NearMesh, missing: &[[u32; 2]]) -> NearDelaunay3 {
    let NearMesh { tets, neighbors, failed, tet_of: mut incident, uncertain, .. } = result;
    let missing = missing.iter().map(|&[i, _]| i).collect();
    incident.truncate(points);
    let triangulation = Triangulation3::new(tets, neighbors, points as u32);
    let uncertain = uncertain.into_iter().map(|[t, _]| t).collect();
    NearDelaunay3 { triangulation, incident, failed, uncertain, missing }
}
