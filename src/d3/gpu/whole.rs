//! Completes a mesh in the memory of the host: reads it as a whole, and splays it there.

use crate::{
    d3::{
        Mesh3,
        gpu::{
            host::{Facets, Whole, WholeSplayed},
            trace::Tracer,
        },
    },
    error::Error,
    gpu::{
        engine::{MadeMesh, Near},
        host::Host,
        phase1::Phase1Run,
        progress,
    },
    stats::{Fallback, Phase},
};

/// Ends the run, and makes the mesh of what is read back as a whole.
pub(super) async fn complete<H: Host<3>>(
    run: Phase1Run<'_, 3>,
    mut near: Near<'_, H, 3>,
    mut tracer: Option<Tracer>,
) -> Result<Result<MadeMesh<3>, Fallback>, Error> {
    let (mut ended, _, (), ()) = run.end(|_, _| (), || ()).await?;
    let (result, merged) = ended.read().await?;
    near.end_of_phase1(&ended.stats);
    // Whether splaying is cancelled or not, the next run gets the memory of this one.
    near.stats.gpu = Some(ended.release().summary(near.adapter));
    let merged = near.merged(merged);
    if let Some(tracer) = &mut tracer {
        let (tetrahedra, neighbors) = (result.tets.clone(), result.neighbors.clone());
        tracer.facets(near.host.ask(Facets { tetrahedra, neighbors }).await?);
    }
    near.options.report(Phase::Splay, progress::COMPLETION)?;
    let splayed = near.host.ask(Whole { near: result, merged }).await?;
    let WholeSplayed { tetrahedra, neighbors, hull, duplicate_of, missing, stats: splay, exact } = match splayed {
        Ok(splayed) => splayed,
        Err(reason) => return Ok(Err(reason.into())),
    };
    near.note_inserted(missing);
    let Near { options, stats, stopwatch, .. } = near;
    (stats.splay, stats.exact) = (Some(splay), exact);
    stats.phases.push((Phase::Splay, stopwatch.lap()));
    options.report(Phase::Finish, progress::FINISH)?;
    stats.trace = tracer.map(|tracer| tracer.finish(&tetrahedra));
    let mesh = Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension: 3, ..Mesh3::default() };
    Ok(Ok(MadeMesh::Host(mesh)))
}
