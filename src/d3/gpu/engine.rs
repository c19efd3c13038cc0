//! How the GPU engine of 3D completes what Phase 1 leaves: star splaying on the CPU (the paper's
//! §3).
//!
//! `stars → splay → patch → arrays of the mesh, on the device`, or, for a mesh that the host wants and has
//! memory for, `stars → splay → patch of the arrays, which the host reads meanwhile → drop the ghosts → mesh`

use crate::{
    d3::{
        Mesh3,
        gpu::{
            exchange::{Begun, Device},
            trace::Tracer,
            whole,
        },
        hull::encloses_once,
        splay::{self, Doubts, Splay, Stop, Terms},
        triangulation::Triangulation3,
    },
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu,
        device_mesh::{DeviceMesh, Outputs},
        engine::{Complete, Made, Moved, Near, progress},
        phase1::Run,
    },
    options::Options,
    parallel::Threads,
    predicates::filter::PredicateContext,
    stats::{Fallback, Phase},
};

impl Complete<3> for Dimension<3> {
    type Tracer = Option<Tracer>;

    const DEGENERATE: Fallback = Fallback::Coplanar;
    const ROUNDS_SHARE: f64 = 0.6;

    fn take_lists(mesh: &mut Mesh3) -> [Vec<[u32; 4]>; 2] {
        [std::mem::take(&mut mesh.tetrahedra), bytemuck::cast_vec(std::mem::take(&mut mesh.neighbors))]
    }

    fn tracer(options: &Options) -> Option<Tracer> {
        options.trace.then(Tracer::default)
    }

    async fn trace_round(tracer: &mut Option<Tracer>, gpu: &Gpu, run: &Run<'_, 3>) -> Result<(), Error> {
        match tracer {
            Some(tracer) => tracer.round(gpu, run).await,
            None => Ok(()),
        }
    }

    async fn complete(
        run: Run<'_, 3>,
        near: Near<'_, 3>,
        tracer: Option<Tracer>,
    ) -> Result<Result<Made<3>, Fallback>, Error> {
        match near.resident {
            true => complete_with_stars(run, near, tracer).await,
            false => whole::complete(run, near, tracer).await,
        }
    }
}

/// Makes the mesh with the stars that splaying needs on the host.
async fn complete_with_stars(
    run: Run<'_, 3>,
    mut near: Near<'_, 3>,
    mut tracer: Option<Tracer>,
) -> Result<Result<Made<3>, Fallback>, Error> {
    let count = near.points.len();
    let (mut device, start) = Device::end(run, || near.prepare()).await?;
    near.end_of_phase1(&device.ended.stats);
    let (missing, duplicate_of) = near.missing(&device.ended.read_merged().await?);
    let Near { points, lattice, options, adapter, moved, stats, stopwatch, .. } = near;
    options.report(Phase::Splay, progress::COMPLETION)?;

    let vertices = PredicateContext::of_input(points, lattice);
    let slots = device.ended.len();
    if let Some(tracer) = &mut tracer {
        let [tetrahedra, neighbors] = device.read().await?;
        tracer.facets(&Triangulation3::new(tetrahedra, neighbors, count as u32), &vertices);
    }
    let share = progress::FINISH - progress::COMPLETION;
    let report = |done: f64| options.report(Phase::Splay, progress::COMPLETION + share * done);
    let max_evaluations = splay::evaluations_from_scratch(slots);
    let terms = || Terms { max_evaluations, threads: Threads::All, report: &report };
    let begun = start
        .begin()
        .map_err(Stop::from)
        .and_then(|Begun { region, doubts }| Splay::begin(&vertices, region, Doubts { missing, ..doubts }, terms()));
    let splayed = match begun {
        Err(stop) => Err(stop),
        // Splaying goes on as far as the stars suffice that were gathered before.
        Ok(mut splay) => loop {
            match splay.advance(&vertices, terms()) {
                Err(stop) => break Err(stop),
                Ok(lacking) if lacking.is_empty() => {
                    let patch = splay.region().patch(slots, Threads::All);
                    break Ok((splay.finish(), patch));
                }
                Ok(lacking) => {
                    let gathered = device.gather(&lacking, splay.region()).await?;
                    if let Err(stop) = splay.add(lacking, gathered) {
                        break Err(stop);
                    }
                }
            }
        },
    };
    let patch = match splayed {
        Ok(((region, splay), patch)) => {
            stats.splay = Some(splay);
            device.ended.host.keep(region);
            patch
        }
        Err(Stop::Error(error)) => return Err(error),
        Err(Stop::Aborted(reason)) => {
            stats.gpu = Some(device.ended.release().summary(adapter));
            return Ok(Err(reason.into()));
        }
    };
    stats.exact = vertices.exact_counts();
    if let Err(error) = device.patch(&patch).await {
        stats.gpu = Some(device.ended.release().summary(adapter));
        return match error {
            Error::TooManySimplices { .. } => Ok(Err(Fallback::GpuFailed(error))),
            _ => Err(error),
        };
    }
    stats.phases.push((Phase::Splay, stopwatch.lap()));

    options.report(Phase::Finish, progress::FINISH)?;
    let (arrays, hull) = device.outputs(&patch, moved.is_some()).await?;
    let gpu = device.ended.gpu;
    let readback = device.ended.kernels.readback.clone();
    stats.gpu = Some(device.ended.release().summary(adapter));
    let mesh = Mesh3 { duplicate_of, dimension: 3, ..Mesh3::default() };
    let mesh = DeviceMesh::<3>::new(gpu, &readback, arrays, mesh);
    if let Some(Moved { spanning, .. }) = moved
        && !encloses_once(points, lattice, &hull, spanning)
    {
        return Ok(Err(Fallback::Inconsistent("the hull does not enclose its inside once")));
    }
    stats.phases.push((Phase::Finish, stopwatch.lap()));
    if let Some(tracer) = tracer {
        let tetrahedra = mesh.read_async(Outputs::SIMPLICES).await?.tetrahedra;
        stats.trace = Some(tracer.finish(&tetrahedra));
    }
    Ok(Ok(Made::Device(Box::new(mesh))))
}
