//! How the GPU engine of 3D completes what Phase 1 leaves: star splaying on the CPU (the paper's
//! §3).
//!
//! `stars → splay → patch → arrays of the mesh, on the device`, or, for a mesh that a native host wants to have,
//! `read the mesh → splay → drop the ghosts → mesh`; where it is large, `stars → splay → patch of the arrays, which are
//! read meanwhile → drop the ghosts → mesh`

#[cfg(not(target_arch = "wasm32"))]
use crate::d3::gpu::{beside, whole};
use crate::{
    d3::{
        Mesh3,
        gpu::{
            exchange::ResidentRun,
            host::Encloses,
            outputs::MadeArrays,
            stars::{Splayed, splay},
            trace::Tracer,
        },
    },
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu,
        device_mesh::{DeviceMesh, Outputs},
        engine::{Complete, MadeMesh, Moved, Near},
        host::Host,
        mesh_check,
        phase1::Phase1Run,
        progress,
    },
    options::Options,
    stats::{Fallback, Phase},
};

impl Complete<3> for Dimension<3> {
    type Tracer = Option<Tracer>;

    const DEGENERATE: Fallback = Fallback::Coplanar;
    const ROUNDS_SHARE: f64 = 0.6;

    fn take_lists(mesh: &mut Mesh3) -> [Vec<[u32; 4]>; 2] {
        [std::mem::take(&mut mesh.tetrahedra), std::mem::take(&mut mesh.neighbors)]
    }

    fn tracer(options: &Options) -> Option<Tracer> {
        options.trace.then(Tracer::default)
    }

    async fn trace_round(tracer: &mut Option<Tracer>, gpu: &Gpu, run: &Phase1Run<'_, 3>) -> Result<(), Error> {
        match tracer {
            Some(tracer) => tracer.round(gpu, run).await,
            None => Ok(()),
        }
    }

    async fn complete<H: Host<3>>(
        run: Phase1Run<'_, 3>,
        near: Near<'_, H, 3>,
        tracer: Option<Tracer>,
    ) -> Result<Result<MadeMesh<3>, Fallback>, Error> {
        #[cfg(not(target_arch = "wasm32"))]
        if !near.resident {
            return if beside::pays(&run) {
                beside::complete(run, near, tracer).await
            } else {
                whole::complete(run, near, tracer).await
            };
        }
        complete_resident(run, near, tracer).await
    }
}

/// Splays the mesh, and has the device make the arrays.
async fn complete_resident<H: Host<3>>(
    run: Phase1Run<'_, 3>,
    mut near: Near<'_, H, 3>,
    mut tracer: Option<Tracer>,
) -> Result<Result<MadeMesh<3>, Fallback>, Error> {
    let (mut device, begin) = ResidentRun::end(run, near.host).await?;
    let splayed = splay(&mut device, begin, &mut near, &mut tracer).await?;
    let Near { host, options, adapter, moved, stats, stopwatch, .. } = near;
    let Splayed { patch, duplicate_of } = match splayed {
        Ok(splayed) => splayed,
        Err(fallback) => {
            stats.gpu = Some(device.ended.release().summary(adapter));
            return Ok(Err(fallback));
        }
    };
    stats.phases.push((Phase::Splay, stopwatch.lap()));

    options.report(Phase::Finish, progress::FINISH)?;
    let made = device.outputs(&patch, &duplicate_of, moved.is_some()).await;
    let MadeArrays { arrays, hull, samples, .. } = match made {
        Ok(made) => made,
        Err(error @ Error::TooManySimplices { .. }) => {
            stats.gpu = Some(device.ended.release().summary(adapter));
            return Ok(Err(Fallback::GpuFailed(error)));
        }
        Err(error) => return Err(error),
    };
    let gpu = device.ended.gpu;
    let readback = device.ended.kernels.readback.clone();
    stats.gpu = Some(device.ended.release().summary(adapter));
    let mesh = Mesh3 { duplicate_of, dimension: 3, ..Mesh3::default() };
    let mesh = DeviceMesh::<3>::new(gpu, &readback, arrays, mesh);
    if let Some(Moved { spanning, .. }) = moved
        && !host.ask(Encloses { hull, spanning }).await?
    {
        return Ok(Err(Fallback::Inconsistent("the hull does not enclose its inside once")));
    }
    mesh_check::check(host, gpu, samples).await?;
    stats.phases.push((Phase::Finish, stopwatch.lap()));
    if let Some(tracer) = tracer {
        let tetrahedra = mesh.read_async(Outputs::SIMPLICES).await?.tetrahedra;
        stats.trace = Some(tracer.finish(&tetrahedra));
    }
    Ok(Ok(MadeMesh::Device(Box::new(mesh))))
}
