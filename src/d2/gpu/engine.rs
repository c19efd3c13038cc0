//! How the GPU engine of 2D completes what Phase 1 leaves: on the CPU, exact edge flips for what
//! the lattice leaves open (the paper's §5.6).
//!
//! `result of Phase 1 → tests that rounding makes uncertain → mesh`, or, where one of these fails,
//! `result of Phase 1 → uncertain tests → flips → missing points → mesh`
//!
//! A mesh that is to stay on the device never leaves it in the first case.

use crate::{
    d2::{
        Mesh2,
        gpu::{
            finish::{Mesh, NearMesh, Open},
            host::{Check, Checked, Flip, Flipped},
            layout::UncertainTest,
        },
        lawson::Aborted,
    },
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Recorder,
        device_mesh::DeviceMesh,
        engine::{Complete, MadeMesh, Near},
        host::{Host, Work},
        phase1::{Copied, Copies, Ended, Phase1Run},
        progress,
    },
    options::Options,
    stats::{Fallback, Phase, Stats},
};

impl Complete<2> for Dimension<2> {
    /// 2D keeps no trace.
    type Tracer = ();

    const DEGENERATE: Fallback = Fallback::Collinear;
    const ROUNDS_SHARE: f64 = 0.7;

    fn take_lists(mesh: &mut Mesh2) -> [Vec<[u32; 3]>; 2] {
        [std::mem::take(&mut mesh.triangles), std::mem::take(&mut mesh.halfedges)]
    }

    fn tracer(_options: &Options) {}

    async fn trace_round(_tracer: &mut (), _gpu: &Gpu, _run: &Phase1Run<'_, 2>) -> Result<(), Error> {
        Ok(())
    }

    async fn complete<H: Host<2>>(
        run: Phase1Run<'_, 2>,
        mut near: Near<'_, H, 2>,
        _tracer: (),
    ) -> Result<Result<MadeMesh<2>, Fallback>, Error> {
        let prepare = || {
            let points = near.host.point_count();
            near.host.work().map(|work| Dimension::<2>::prepare(work, points))
        };
        let (mut ended, _, (), _) = run.end(|_, _| (), prepare).await?;
        if near.moved.is_some() && ended.counters.failed > 0 {
            // Triangles are still inverted.
            near.stats.gpu = Some(ended.release().summary(near.adapter));
            return Ok(Err(Fallback::Folded));
        }
        let mut checked = None;
        if near.resident {
            near.end_of_phase1(&ended.stats);
            let Open { hull, uncertain } = read_open(&mut ended).await?;
            let merged = ended.read_merged().await?;
            near.stats.phases.push((Phase::Readback, near.stopwatch.lap()));
            let now = check(&mut near, hull, uncertain, merged).await?;
            if near.moved.is_some() && now.is_proven && !now.turns_once {
                near.stats.gpu = Some(ended.release().summary(near.adapter));
                return Ok(Err(Fallback::Folded));
            }
            if now.is_proven {
                return complete_resident(ended, near, now).await;
            }
            checked = Some(now);
        }
        let (result, merged) = ended.read().await?;
        let phase1 = ended.release();
        if near.resident {
            near.stats.gpu = Some(phase1.summary(near.adapter));
            near.stats.phases.push((Phase::Readback, near.stopwatch.lap()));
        } else {
            near.end_of_phase1(&phase1);
        }
        let NearMesh { mesh: Mesh { mut triangles, mut halfedges, hull }, uncertain } = result;
        let checked = match checked {
            Some(checked) => checked,
            None => check(&mut near, hull, uncertain, merged).await?,
        };
        let Checked { mut hull, is_proven, mut turns_once, duplicate_of, .. } = checked;
        if !is_proven {
            let flipped = match near.host.ask(Flip { triangles, halfedges }).await? {
                Ok(flipped) => flipped,
                Err(Aborted::BudgetExceeded) => return Ok(Err(Fallback::Flips)),
                Err(Aborted::Folded) => return Ok(Err(Fallback::Folded)),
            };
            near.stats.exact = near.stats.exact + flipped.exact;
            Flipped { triangles, halfedges, hull, turns_once, .. } = flipped;
            near.stats.phases.push((Phase::Flip, near.stopwatch.lap()));
        }
        if near.moved.is_some() && !turns_once {
            return Ok(Err(Fallback::Folded));
        }
        near.stats.phases.push((Phase::Finish, near.stopwatch.lap()));
        let mesh = Mesh2 { triangles, halfedges, hull, duplicate_of, dimension: 2, stats: Stats::default() };
        Ok(Ok(MadeMesh::Host(mesh)))
    }
}

/// Asks the host whether the mesh is that of the true points.
async fn check<H: Host<2>>(
    near: &mut Near<'_, H, 2>,
    hull: Vec<[u32; 2]>,
    uncertain: Option<Vec<UncertainTest>>,
    merged: Vec<[u32; 2]>,
) -> Result<Checked, Error> {
    near.options.report(Phase::Finish, progress::COMPLETION)?;
    let has_tests = uncertain.as_ref().is_some_and(|tests| !tests.is_empty());
    let merged = near.merged(merged);
    let checked = near.host.ask(Check { hull, uncertain, merged }).await?;
    near.note_inserted(checked.missing);
    near.stats.exact = checked.exact;
    if has_tests {
        near.stats.phases.push((Phase::Check, near.stopwatch.lap()));
    }
    Ok(checked)
}

/// Makes the arrays of a mesh to which nothing is to be done any more on the device.
async fn complete_resident<H: Host<2>>(
    mut ended: Ended<'_, 2>,
    near: Near<'_, H, 2>,
    Checked { hull, duplicate_of, .. }: Checked,
) -> Result<Result<MadeMesh<2>, Fallback>, Error> {
    let Ended { gpu, kernels, memory, stats, finite, .. } = &mut ended;
    let aliases = &memory.bound.aliases;
    let points = near.host.point_count();
    let (arrays, dispatches) = kernels.outputs.run(gpu, aliases, *finite, points, &hull).await?;
    stats.dispatches += dispatches;
    stats.submits += 1;
    let readback = ended.kernels.readback.clone();
    let mesh = Mesh2 { duplicate_of, dimension: 2, ..Mesh2::default() };
    let mesh = DeviceMesh::<2>::new(ended.gpu, &readback, arrays, mesh);
    near.stats.gpu = Some(ended.release().summary(near.adapter));
    near.stats.phases.push((Phase::Finish, near.stopwatch.lap()));
    Ok(Ok(MadeMesh::Device(Box::new(mesh))))
}

/// Reads what the host has to see of any mesh.
async fn read_open(ended: &mut Ended<'_, 2>) -> Result<Open<Vec<[u32; 2]>, Vec<UncertainTest>>, Error> {
    let Ended { gpu, kernels, memory, stats, counters, .. } = ended;
    let gpu: &Gpu = gpu;
    let readback = &mut kernels.readback;
    let (submission, open) = gpu
        .with_error_scope("the result of Phase 1", || {
            let mut copies = Copies { readback, gpu, recorder: Recorder::new(gpu, None) };
            let open = Open::copy(&mut copies, &memory.buffers, &memory.bound.aliases, counters);
            Ok((copies.recorder.submit(gpu), open))
        })
        .await?;
    stats.submits += 1;
    open.receive(&mut Copied { readback: &mut kernels.readback, gpu, submission }).await
}
