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
        Gpu, Recorder, Storage,
        device_mesh::{DeviceArrays, DeviceMesh},
        engine::{Complete, MadeMesh, Near},
        host::{Host, Work},
        mesh_check::{self, count_vertices, euler2, samples2},
        phase1::{Copied, Copies, Ended, Phase1Run},
        progress,
    },
    index::NONE,
    options::Options,
    stats::{Fallback, Phase},
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
            let (Open { hull, uncertain, .. }, arrays, words) = read_open(&mut ended, near.host.point_count()).await?;
            let merged = ended.read_merged().await?;
            near.stats.phases.push((Phase::Readback, near.stopwatch.lap()));
            let now = check(&mut near, hull, uncertain, merged).await?;
            if near.moved.is_some() && now.is_proven && !now.turns_once {
                near.stats.gpu = Some(ended.release().summary(near.adapter));
                return Ok(Err(Fallback::Folded));
            }
            if now.is_proven {
                let vertices = count_vertices(&now.duplicate_of);
                let samples = euler2(vertices, ended.finite, now.hull.len()).and_then(|()| samples2(words, vertices));
                mesh_check::check(near.host, ended.gpu, samples).await?;
                return complete_resident(ended, near, now, arrays).await;
            }
            checked = Some(now);
        }
        let (result, merged) = ended.read().await?;
        let gpu = ended.gpu;
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
            if !is_triangulation(&triangles, &halfedges, near.host.point_count()) {
                return Err(gpu.wrong("a triangle has a vertex or a neighbour that is none"));
            }
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
        let mesh = Mesh2 { triangles, halfedges, hull, duplicate_of, dimension: 2, ..Mesh2::default() };
        Ok(Ok(MadeMesh::Host(mesh)))
    }
}

/// Returns whether all vertices and half-edges are there.
fn is_triangulation(triangles: &[[u32; 3]], halfedges: &[[u32; 3]], points: usize) -> bool {
    let edges = 3 * triangles.len();
    triangles.as_flattened().iter().all(|&v| (v as usize) < points)
        && halfedges.as_flattened().iter().all(|&e| e == NONE || (e as usize) < edges)
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

/// Adds the hull to the arrays of a mesh to which nothing is to be done any more on the device.
async fn complete_resident<H: Host<2>>(
    mut ended: Ended<'_, 2>,
    near: Near<'_, H, 2>,
    Checked { hull, duplicate_of, .. }: Checked,
    mut arrays: DeviceArrays,
) -> Result<Result<MadeMesh<2>, Fallback>, Error> {
    let gpu = ended.gpu;
    let write_hull = || {
        arrays.hull = Storage::for_caller(gpu, "hull of the mesh", hull.len())?;
        arrays.hull.write(gpu, 0, &hull);
        gpu.queue().submit([]);
        Ok(())
    };
    gpu.with_error_scope("the mesh", write_hull).await?;
    ended.stats.submits += 1;
    let readback = ended.kernels.readback.clone();
    let mesh = Mesh2 { duplicate_of, dimension: 2, ..Mesh2::default() };
    let mesh = DeviceMesh::<2>::new(gpu, &readback, arrays, mesh);
    near.stats.gpu = Some(ended.release().summary(near.adapter));
    near.stats.phases.push((Phase::Finish, near.stopwatch.lap()));
    Ok(Ok(MadeMesh::Device(Box::new(mesh))))
}

/// Makes the arrays of a mesh of so many points, but for the hull, and reads what the host has to see of any mesh, and what
/// the check of the arrays has written.
async fn read_open(
    ended: &mut Ended<'_, 2>,
    points: usize,
) -> Result<(Open<Vec<[u32; 2]>, Vec<UncertainTest>>, DeviceArrays, Vec<u32>), Error> {
    let Ended { gpu, kernels, memory, stats, counters, finite, .. } = ended;
    let gpu: &Gpu = gpu;
    let (outputs, readback, aliases) = (&kernels.outputs, &mut kernels.readback, &memory.bound.aliases);
    let (submission, open, arrays, checked) = gpu
        .with_error_scope("the result of Phase 1", || {
            let mut copies = Copies { readback, gpu, recorder: Recorder::new(gpu, None) };
            let open = Open::copy(&mut copies, &memory.buffers, aliases, counters);
            let (arrays, checked) = outputs.record(gpu, &mut copies.recorder, aliases, *finite, points)?;
            stats.dispatches += copies.recorder.dispatches();
            let checked = copies.copy(&checked, checked.len());
            Ok((copies.recorder.submit(gpu), open, arrays, checked))
        })
        .await?;
    stats.submits += 1;
    let mut copied = Copied { readback: &mut kernels.readback, gpu, submission };
    Ok((open.receive(&mut copied).await?, arrays, copied.receive(checked).await?))
}
