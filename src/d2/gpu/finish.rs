//! The end of Phase 1: the mesh without gaps, and what is left open by rounding.

use crate::gpu::primitives::scan::{BoundScan, Scan, ScanParams};
use crate::{
    Error,
    d2::gpu::{aliases::Aliases, layout::UncertainTest},
    gpu::{
        Gpu, Kernel, Pending, Readback, Recorder, Storage,
        dim::{Dim, Dimension},
        layout::Counters,
        phase1::{Buffers, Finish},
    },
    input::lattice::Width,
};

/// The kernels of the end of Phase 1.
#[derive(Debug)]
pub struct Kernels {
    mark: Kernel,
    compact: Kernel,
    scan: Scan,
}

/// The bind groups of the end of Phase 1, and the buffers that it fills.
#[derive(Debug)]
pub struct Bound {
    /// What is written over buffers that are of no more use.
    aliases: Aliases,
    mark: wgpu::BindGroup,
    compact: wgpu::BindGroup,
    scan: BoundScan,
}

/// Triangles in input indices and as [`Mesh2`](crate::d2::Mesh2) has them, but for the hull.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mesh {
    /// Three vertices per triangle in the order of
    /// [`Settings::winding`](crate::gpu::phase1::Settings::winding), none flat.
    pub triangles: Vec<[u32; 3]>,
    /// Entry *k* is the half-edge that runs against the one from vertex *k* to the next,
    /// 3·(triangle) + (vertex); -1 on the hull.
    pub halfedges: Vec<[i32; 3]>,
    /// The half-edges of the hull, from where to where, in no order.
    pub hull: Vec<[u32; 2]>,
}

/// The Delaunay triangulation of the lattice's points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NearMesh {
    /// The triangles: those of the true points, if all `uncertain` tests have the right answer.
    pub mesh: Mesh,
    /// What the lattice does not prove of the mesh, because coordinates were rounded; `None` if
    /// that is more than the device has room for.
    pub uncertain: Option<Vec<UncertainTest>>,
}

/// The result while it is on its way.
struct Reading {
    first: wgpu::SubmissionIndex,
    triangles: Pending<[u32; 3]>,
    second: wgpu::SubmissionIndex,
    halfedges: Pending<[i32; 3]>,
    hull: Pending<[u32; 2]>,
    uncertain: Pending<UncertainTest>,
    merged: Pending<u32>,
}

impl Finish<2> for Dimension<2> {
    type Kernels = Kernels;
    type Bound = Bound;
    type Result = NearMesh;

    fn compile(gpu: &Gpu, width: Width) -> Kernels {
        let kernel = |name| Kernel::new(gpu, Self::SHADERS.get(name), width);
        Kernels { mark: kernel("mesh_mark"), compact: kernel("mesh_compact"), scan: Scan::new(gpu) }
    }

    fn bind(kernels: &Kernels, gpu: &Gpu, b: &Buffers<2>) -> Result<Bound, Error> {
        let count = ScanParams { count: b.simplices.len() as u32 };
        let scan_params = Storage::with_contents(gpu, "scan parameters", &[count])?;
        let scan = kernels.scan.bind(gpu, &scan_params, &b.own.marks, &b.own.offsets)?;
        let aliases = Aliases::new(b);
        let mut buffers = b.bindings();
        buffers.extend(aliases.bindings());
        let [mark, compact] = [&kernels.mark, &kernels.compact].map(|kernel| kernel.bind(gpu, &buffers));
        Ok(Bound { aliases, mark, compact, scan })
    }

    fn bound_bytes(_bound: &Bound) -> u64 {
        0
    }

    /// Records the search for uncertain tests, and the compaction.
    fn record(
        kernels: &Kernels,
        _gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        bound: &Bound,
        _blocks: u32,
        workgroups: u32,
    ) {
        recorder.stage("mark mesh");
        recorder.dispatch(&kernels.mark, &bound.mark, workgroups);
        recorder.stage("compact mesh");
        kernels.scan.record(recorder, &bound.scan);
        recorder.dispatch(&kernels.compact, &bound.compact, workgroups);
    }

    fn sums(bound: &Bound) -> &Storage<u32> {
        bound.scan.sums()
    }

    async fn read_result(
        gpu: &Gpu,
        readback: &mut Readback,
        b: &Buffers<2>,
        bound: &Bound,
        count: usize,
        counters: &Counters,
    ) -> Result<(NearMesh, Vec<u32>), Error> {
        let tests = counters.uncertain as usize;
        let has_room = tests <= b.simplices.len();
        let merged_len = if counters.merged > 0 { b.points.merged_into.len() } else { 0 };
        let aliases = &bound.aliases;
        let Reading { first, triangles, second, halfedges, hull, uncertain, merged } = gpu
            .with_error_scope("the result of Phase 1", || {
                // The host takes the first part while the device sends the second.
                let mut recorder = Recorder::new(gpu, None);
                let triangles = readback.copy(gpu, recorder.encoder(), &aliases.triangles, 0, count);
                let first = recorder.submit(gpu);
                let mut recorder = Recorder::new(gpu, None);
                let encoder = recorder.encoder();
                Ok(Reading {
                    first,
                    triangles,
                    halfedges: readback.copy(gpu, encoder, &aliases.halfedges, 0, count),
                    hull: readback.copy(gpu, encoder, &aliases.hull, 0, counters.hull as usize),
                    uncertain: readback.copy(gpu, encoder, &aliases.uncertain, 0, if has_room { tests } else { 0 }),
                    merged: readback.copy(gpu, encoder, &b.points.merged_into, 0, merged_len),
                    second: recorder.submit(gpu),
                })
            })
            .await?;
        let mesh = Mesh {
            triangles: readback.receive(gpu, &first, triangles).await?,
            halfedges: readback.receive(gpu, &second, halfedges).await?,
            hull: readback.receive(gpu, &second, hull).await?,
        };
        let uncertain = readback.receive(gpu, &second, uncertain).await?;
        let merged = readback.receive(gpu, &second, merged).await?;
        Ok((NearMesh { mesh, uncertain: has_room.then_some(uncertain) }, merged))
    }
}
