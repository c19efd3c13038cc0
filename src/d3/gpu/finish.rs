//! The end of Phase 1: failed vertices (§3.2.1), the mesh without gaps, and what is flat or left
//! open by rounding.

use crate::gpu::primitives::scan::{BoundScan, Scan, ScanParams};
use crate::{
    Error,
    d3::gpu::aliases::Aliases,
    gpu::{
        Gpu, Kernel, Pending, Readback, Recorder, Storage,
        dim::{Dim, Dimension},
        layout::{Active, BLOCK, Counters},
        phase1::{Buffers, Finish, Slot},
    },
    input::lattice::Width,
};

/// The kernels of the end of Phase 1.
#[derive(Debug)]
pub struct Kernels {
    mark_failed: Kernel,
    mark: Kernel,
    number: Kernel,
    compact: Kernel,
    certify: Kernel,
    scan: Scan,
}

/// The bind groups of the end of Phase 1, and the buffers that it fills.
#[derive(Debug)]
pub struct Bound {
    /// What is written over buffers that are of no more use.
    aliases: Aliases,
    /// One tetrahedron of each point, plus 1; 0 for one that another stands for. Infinity comes
    /// last.
    tet_of: Storage<u32>,
    params: Storage<ScanParams>,
    mark_failed: wgpu::BindGroup,
    mark: wgpu::BindGroup,
    scan: BoundScan,
    number: wgpu::BindGroup,
    compact: wgpu::BindGroup,
    certify: wgpu::BindGroup,
    bytes: u64,
}

/// A triangulation whose only facets that are not locally Delaunay cannot be flipped.
///
/// Vertices are places in the input. All tetrahedra are positively oriented in the sense of the
/// perturbed predicates: there can be flat ones.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NearMesh {
    /// Four vertices per tetrahedron, the finite ones first. The infinite ones have the vertex at
    /// infinity, the number of points, last.
    pub tets: Vec<[u32; 4]>,
    /// Entry *k* is 4·tetrahedron + face across the facet opposite vertex *k*.
    pub neighbors: Vec<[u32; 4]>,
    /// The number of finite tetrahedra.
    pub finite: usize,
    /// The vertices with a facet that is not locally Delaunay, ascending.
    pub failed: Vec<u32>,
    /// One tetrahedron of each vertex, infinity last; [`NONE`](crate::gpu::layout::NONE) for points
    /// that are merged into others.
    pub tet_of: Vec<u32>,
    /// Tetrahedra, ascending, that are flat (bit 4); and where coordinates were rounded to the
    /// lattice, those of which it does not prove everything: whether facet *k* is locally Delaunay
    /// (bit *k*), or the orientation (bit 4). Each facet is listed with one of its tetrahedra.
    pub uncertain: Vec<[u32; 2]>,
}

/// The result while it is on its way.
struct Reading {
    first: wgpu::SubmissionIndex,
    tets: Pending<Slot>,
    second: wgpu::SubmissionIndex,
    neighbors: Pending<Slot>,
    tet_of: Pending<u32>,
    failed: Pending<u32>,
    merged: Pending<u32>,
    uncertain: Pending<Active>,
}

impl Finish<3> for Dimension<3> {
    type Kernels = Kernels;
    type Bound = Bound;
    type Result = NearMesh;

    fn compile(gpu: &Gpu, width: Width) -> Kernels {
        let kernel = |name| Kernel::new(gpu, Self::SHADERS.get(name), width);
        Kernels {
            mark_failed: kernel("mark_failed"),
            mark: kernel("mesh_mark"),
            number: kernel("mesh_number"),
            compact: kernel("mesh_compact"),
            certify: kernel("certify"),
            scan: Scan::new(gpu),
        }
    }

    fn bind(kernels: &Kernels, gpu: &Gpu, b: &Buffers<3>) -> Result<Bound, Error> {
        let slots = b.simplices.len();
        let params = Storage::new(gpu, "scan parameters", 1)?;
        let marks = Storage::new(gpu, "marks", slots)?;
        let numbers = Storage::new(gpu, "numbers of tetrahedra", slots)?;
        let tet_of = Storage::new(gpu, "tetrahedra of points", b.own.failed.len() + 1)?;
        let bytes = marks.bytes() + numbers.bytes() + tet_of.bytes();
        let scan = kernels.scan.bind(gpu, &params, &marks, &numbers)?;
        let aliases = Aliases::new(b);
        let mut buffers = b.bindings();
        buffers.extend(aliases.bindings());
        buffers.extend([
            ("marks", marks.buffer()),
            ("numbers", numbers.buffer()),
            ("sums", scan.sums().buffer()),
            ("tet_of", tet_of.buffer()),
        ]);
        let Kernels { mark_failed, mark, number, compact, certify, .. } = kernels;
        let [mark_failed, mark, number, compact, certify] =
            [mark_failed, mark, number, compact, certify].map(|kernel| kernel.bind(gpu, &buffers));
        Ok(Bound { aliases, tet_of, params, mark_failed, mark, scan, number, compact, certify, bytes })
    }

    fn bound_bytes(bound: &Bound) -> u64 {
        bound.bytes
    }

    /// Records the search for failed vertices, the compaction, and the certification.
    fn record(kernels: &Kernels, gpu: &Gpu, recorder: &mut Recorder<'_>, bound: &Bound, blocks: u32, workgroups: u32) {
        bound.params.write(gpu, 0, &[ScanParams { count: blocks * BLOCK }]);
        recorder.encoder().clear_buffer(bound.tet_of.buffer(), 0, None);
        recorder.stage("mark failed");
        recorder.dispatch(&kernels.mark_failed, &bound.mark_failed, workgroups);
        recorder.stage("compact mesh");
        recorder.dispatch(&kernels.mark, &bound.mark, workgroups);
        kernels.scan.record(recorder, &bound.scan);
        recorder.dispatch(&kernels.number, &bound.number, workgroups);
        recorder.dispatch(&kernels.compact, &bound.compact, workgroups);
        recorder.stage("certify");
        recorder.dispatch(&kernels.certify, &bound.certify, workgroups);
    }

    fn sums(bound: &Bound) -> &Storage<u32> {
        bound.scan.sums()
    }

    async fn read_result(
        gpu: &Gpu,
        readback: &mut Readback,
        b: &Buffers<3>,
        bound: &Bound,
        finite: usize,
        counters: &Counters,
    ) -> Result<(NearMesh, Vec<u32>), Error> {
        let tetrahedra = finite + counters.ghosts as usize;
        let merged_len = if counters.merged > 0 { b.points.merged_into.len() } else { 0 };
        let aliases = &bound.aliases;
        let Reading { first, tets, second, neighbors, tet_of, failed, merged, uncertain } = gpu
            .with_error_scope("the result of Phase 1", || {
                // The host takes the first part while the device sends the second.
                let mut recorder = Recorder::new(gpu, None);
                let tets = readback.copy(gpu, recorder.encoder(), &aliases.tets, 0, tetrahedra);
                let first = recorder.submit(gpu);
                let mut recorder = Recorder::new(gpu, None);
                let encoder = recorder.encoder();
                Ok(Reading {
                    first,
                    tets,
                    neighbors: readback.copy(gpu, encoder, &aliases.neighbors, 0, tetrahedra),
                    tet_of: readback.copy(gpu, encoder, &bound.tet_of, 0, bound.tet_of.len()),
                    failed: readback.copy(gpu, encoder, &aliases.failed, 0, counters.failed as usize),
                    merged: readback.copy(gpu, encoder, &b.points.merged_into, 0, merged_len),
                    uncertain: readback.copy(gpu, encoder, &aliases.uncertain, 0, counters.uncertain as usize),
                    second: recorder.submit(gpu),
                })
            })
            .await?;
        let tets = readback.receive(gpu, &first, tets).await?;
        let neighbors = readback.receive(gpu, &second, neighbors).await?;
        let mut tet_of = readback.receive(gpu, &second, tet_of).await?;
        let mut failed = readback.receive(gpu, &second, failed).await?;
        let merged = readback.receive(gpu, &second, merged).await?;
        let uncertain = readback.receive(gpu, &second, uncertain).await?;

        tet_of.iter_mut().for_each(|t: &mut u32| *t = t.wrapping_sub(1));
        failed.sort_unstable();
        let mut uncertain: Vec<[u32; 2]> = uncertain.into_iter().map(|a| [a.tet, a.outcome]).collect();
        uncertain.sort_unstable();
        Ok((NearMesh { tets, neighbors, finite, failed, tet_of, uncertain }, merged))
    }
}
