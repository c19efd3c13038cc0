//! Completes a mesh in the memory of the host: reads it as a whole, and splays it there.

use crate::{
    d3::{
        Mesh3,
        gpu::{finish::NearMesh, trace::Tracer},
        splay::{self, NearDelaunay3, SplayOutcome, Terms},
        triangulation::{FiniteMesh, Triangulation3},
    },
    error::Error,
    gpu::{
        engine::{Made, Near, progress},
        phase1::Run,
    },
    parallel::Threads,
    predicates::filter::PredicateContext,
    stats::{Fallback, Phase, Stats},
};

/// Ends the run, and makes the mesh of what is read back as a whole.
pub(super) async fn complete(
    run: Run<'_, 3>,
    mut near: Near<'_, 3>,
    mut tracer: Option<Tracer>,
) -> Result<Result<Made<3>, Fallback>, Error> {
    let (mut ended, _, (), ()) = run.end(|_, _| (), || near.prepare()).await?;
    let (result, merged) = ended.read().await?;
    near.end_of_phase1(&ended.stats);
    let (missing, duplicate_of) = near.missing(&merged);
    let Near { points, lattice, options, adapter, stats, stopwatch, .. } = near;

    let vertices = PredicateContext::of_input(points, lattice);
    let near = near_delaunay(points.len(), result, &missing);
    if let Some(tracer) = &mut tracer {
        tracer.facets(&near.triangulation, &vertices);
    }
    let share = progress::FINISH - progress::COMPLETION;
    let report = |done: f64| options.report(Phase::Splay, progress::COMPLETION + share * done);
    let max_evaluations = splay::evaluations_from_scratch(near.triangulation.tetrahedra().len());
    let terms = Terms { max_evaluations, threads: Threads::All, report: &report };
    let splayed = options
        .report(Phase::Splay, progress::COMPLETION)
        .and_then(|()| splay::splay_again(&vertices, near, terms, &mut ended.host));
    // Whether splaying was cancelled or not, the next run gets the memory of this one.
    stats.gpu = Some(ended.release().summary(adapter));
    let triangulation = match splayed? {
        SplayOutcome::Delaunay(triangulation, splay) => {
            stats.splay = Some(splay);
            triangulation
        }
        SplayOutcome::Aborted(reason) => return Ok(Err(reason.into())),
    };
    stats.phases.push((Phase::Splay, stopwatch.lap()));

    options.report(Phase::Finish, progress::FINISH)?;
    stats.exact = vertices.exact_counts();
    let FiniteMesh { tetrahedra, neighbors, hull } = triangulation.into_mesh(None, Threads::All);
    stats.phases.push((Phase::Finish, stopwatch.lap()));
    stats.trace = tracer.map(|tracer| tracer.finish(&tetrahedra));
    let mesh = Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension: 3, stats: Stats::default() };
    Ok(Ok(Made::Host(mesh)))
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
