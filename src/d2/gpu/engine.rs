//! How the GPU engine of 2D completes what Phase 1 leaves: on the CPU, exact edge flips for what
//! the lattice leaves open (the paper's §5.6).
//!
//! `result of Phase 1 → tests that rounding makes uncertain → mesh`, or, where one of these fails,
//! `result of Phase 1 → uncertain tests → flips → missing points → mesh`
//!
//! A mesh that is to stay on the device never leaves it in the first case.

use crate::{
    d2::{
        Mesh2, Triangulation2,
        gpu::{
            certify::{failed_tests, near_delaunay},
            finish::{Mesh, NearMesh, Open},
            layout::UncertainTest,
        },
        lawson::{self, Aborted, LawsonOutcome, turns_once},
    },
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Recorder,
        device_mesh::{DeviceArrays, DeviceMesh},
        engine::{Complete, Made, Near, progress},
        phase1::{Copied, Copies, Ended, Run},
    },
    options::Options,
    parallel::Threads,
    predicates::filter::PredicateContext2,
    stats::{Fallback, Phase, Stats},
};

impl Complete<2> for Dimension<2> {
    /// 2D keeps no trace.
    type Tracer = ();

    const DEGENERATE: Fallback = Fallback::Collinear;
    const ROUNDS_SHARE: f64 = 0.7;

    fn take_lists(mesh: &mut Mesh2) -> [Vec<[u32; 3]>; 2] {
        [std::mem::take(&mut mesh.triangles), bytemuck::cast_vec(std::mem::take(&mut mesh.halfedges))]
    }

    fn tracer(_options: &Options) {}

    async fn trace_round(_tracer: &mut (), _gpu: &Gpu, _run: &Run<'_, 2>) -> Result<(), Error> {
        Ok(())
    }

    async fn complete(run: Run<'_, 2>, mut near: Near<'_, 2>, _tracer: ()) -> Result<Result<Made<2>, Fallback>, Error> {
        let (mut ended, _, (), ()) = run.end(|_, _| (), || near.prepare()).await?;
        if near.moved.is_some() && ended.counters.failed > 0 {
            // Triangles are still inverted.
            near.stats.gpu = Some(ended.release().summary(near.adapter));
            return Ok(Err(Fallback::Folded));
        }
        if near.resident {
            near.end_of_phase1(&ended.stats);
            if let Some((arrays, duplicate_of)) = complete_on_device(&mut ended, &mut near).await? {
                let readback = ended.kernels.readback.clone();
                let mesh = Mesh2 { duplicate_of, dimension: 2, ..Mesh2::default() };
                let mesh = DeviceMesh::<2>::new(ended.gpu, &readback, arrays, mesh);
                near.stats.gpu = Some(ended.release().summary(near.adapter));
                near.stats.phases.push((Phase::Finish, near.stopwatch.lap()));
                return Ok(Ok(Made::Device(Box::new(mesh))));
            }
        }
        let (result, merged) = ended.read().await?;
        let phase1 = ended.release();
        if near.resident {
            near.stats.gpu = Some(phase1.summary(near.adapter));
            near.stats.phases.push((Phase::Readback, near.stopwatch.lap()));
        } else {
            near.end_of_phase1(&phase1);
        }
        let (missing, duplicate_of) = near.missing(&merged);
        let Near { points, lattice, options, moved, stats, stopwatch, .. } = near;
        let NearMesh { mesh: Mesh { mut triangles, mut halfedges, hull }, uncertain } = result;
        options.report(Phase::Finish, progress::COMPLETION)?;
        let mut failed = uncertain;
        if let Some(tests) = failed.as_mut().filter(|tests| !tests.is_empty()) {
            (*tests, stats.exact) = failed_tests(points, lattice, tests);
            stats.phases.push((Phase::Check, stopwatch.lap()));
        }
        let mut hull = in_order(&hull, points.len());
        if !missing.is_empty() || !failed.as_ref().is_some_and(Vec::is_empty) {
            let share = progress::FINISH - progress::COMPLETION;
            let report = |done: f64| options.report(Phase::Flip, progress::COMPLETION + share * done);
            let vertices = PredicateContext2::of_input(points, lattice);
            let triangulation =
                Triangulation2::from_mesh(triangles, halfedges, &hull, points.len() as u32, options.winding);
            let near = near_delaunay(triangulation, failed.as_deref(), &missing);
            let max_flips = FLIPS_PER_POINT * points.len() as u64;
            let triangulation = match lawson::lawson(&vertices, near, max_flips, &report)? {
                LawsonOutcome::Delaunay(triangulation, _) => triangulation,
                LawsonOutcome::Aborted(Aborted::BudgetExceeded) => return Ok(Err(Fallback::Flips)),
                LawsonOutcome::Aborted(Aborted::Folded) => return Ok(Err(Fallback::Folded)),
            };
            stats.exact = stats.exact + vertices.exact_counts();
            (triangles, halfedges, hull) =
                triangulation.into_mesh(&(0..points.len() as u32).collect::<Vec<_>>(), options.winding, Threads::All);
            stats.phases.push((Phase::Flip, stopwatch.lap()));
        }
        let vertices = PredicateContext2::of_input(points, lattice);
        if moved.is_some() && !turns_once(&vertices, &hull, options.winding) {
            return Ok(Err(Fallback::Folded));
        }
        stats.phases.push((Phase::Finish, stopwatch.lap()));
        let mesh = Mesh2 { triangles, halfedges, hull, duplicate_of, dimension: 2, stats: Stats::default() };
        Ok(Ok(Made::Host(mesh)))
    }
}

/// Makes the arrays of the mesh on the device, if nothing is left to flips. Returns them with
/// [`Mesh2::duplicate_of`].
async fn complete_on_device(
    ended: &mut Ended<'_, 2>,
    near: &mut Near<'_, 2>,
) -> Result<Option<(DeviceArrays, Vec<i32>)>, Error> {
    let Open { hull, uncertain } = read_open(ended).await?;
    let (missing, duplicate_of) = near.missing(&ended.read_merged().await?);
    near.stats.phases.push((Phase::Readback, near.stopwatch.lap()));
    let Some(tests) = uncertain.filter(|_| missing.is_empty()) else { return Ok(None) };
    near.options.report(Phase::Finish, progress::COMPLETION)?;
    if !tests.is_empty() {
        let (failed, exact) = failed_tests(near.points, near.lattice, &tests);
        near.stats.phases.push((Phase::Check, near.stopwatch.lap()));
        if !failed.is_empty() {
            return Ok(None);
        }
        near.stats.exact = exact;
    }
    let points = near.points.len();
    let hull = in_order(&hull, points);
    // The triangles of points that have moved may go round more than once.
    let vertices = PredicateContext2::of_input(near.points, near.lattice);
    if near.moved.is_some() && !turns_once(&vertices, &hull, near.options.winding) {
        return Ok(None);
    }
    let Ended { gpu, kernels, memory, stats, finite, .. } = ended;
    let aliases = &memory.bound.aliases;
    let made = kernels.outputs.run(gpu, aliases, *finite, points, &hull).await?;
    stats.dispatches += made.1;
    stats.submits += 1;
    Ok(Some((made.0, duplicate_of)))
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

/// The flips per point after which the CPU engine finishes sooner: about as many as it takes from
/// nothing.
const FLIPS_PER_POINT: u64 = 3;

/// Returns the vertices of the hull, from the lowest index, by its edges.
fn in_order(edges: &[[u32; 2]], points: usize) -> Vec<u32> {
    let mut next = vec![u32::MAX; points];
    for &[from, to] in edges {
        next[from as usize] = to;
    }
    let lowest = edges.iter().map(|&[from, _]| from).min();
    std::iter::successors(lowest, |&v| Some(next[v as usize])).take(edges.len()).collect()
}
