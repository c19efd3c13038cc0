//! Splaying with the stars that it needs, which are gathered from the device.

use crate::{
    d3::{
        gpu::{
            exchange::{ResidentRun, spare},
            host::{Advanced, Begin, Begun, Facets, Stars, Step},
            trace::Tracer,
        },
        splay::Patch,
    },
    error::Error,
    gpu::{engine::Near, host::Host, progress},
    stats::{Fallback, Phase},
};

/// What splaying has come to.
pub(super) struct Splayed {
    /// What has changed in the mesh.
    pub(super) patch: Patch,
    pub(super) duplicate_of: Vec<u32>,
}

/// Splays the mesh on the device with the stars that this needs, which are gathered from it.
pub(super) async fn splay<H: Host<3>>(
    device: &mut ResidentRun<'_>,
    begin: Begin,
    near: &mut Near<'_, H, 3>,
    tracer: &mut Option<Tracer>,
) -> Result<Result<Splayed, Fallback>, Error> {
    near.end_of_phase1(&device.ended.stats);
    let merged = near.merged(device.ended.read_merged().await?);
    near.options.report(Phase::Splay, progress::COMPLETION)?;
    if let Some(tracer) = tracer {
        let [tetrahedra, neighbors] = device.read().await?;
        tracer.facets(near.host.ask(Facets { tetrahedra, neighbors }).await?);
    }
    let Begun { mut step, missing, duplicate_of, mut exact } = near.host.ask(Begin { merged, ..begin }).await?;
    near.note_inserted(missing);
    let (patch, splayed) = loop {
        let (vertices, next) = match step {
            Ok(Step::Splayed(patch, splayed)) => break (patch, splayed),
            Ok(Step::Lacking { vertices, next }) => (vertices, next),
            Err(reason) => return Ok(Err(reason.into())),
        };
        let gathered = device.gather(&vertices, next, spare(near.host)).await?;
        let advanced: Advanced = near.host.ask(Stars(gathered)).await?;
        (step, exact) = (advanced.step, exact + advanced.exact);
    };
    (near.stats.splay, near.stats.exact) = (Some(splayed), exact);
    Ok(Ok(Splayed { patch, duplicate_of }))
}
