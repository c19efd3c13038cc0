//! The end of Phase 1: failed vertices (§3.2.1), the mesh without gaps, and what is flat or left open by rounding.

use crate::gpu::primitives::scan::{BoundScan, GROUPS, Scan, ScanParams};
use crate::{
    Error,
    d3::gpu::buffers::Buffers,
    gpu::{
        Gpu, Kernel, Recorder, Storage,
        layout::{Active, BLOCK},
        shader,
    },
    input::lattice::Width,
};

/// The kernels of the end of Phase 1.
#[derive(Debug)]
pub struct Finish {
    mark_failed: Kernel,
    mark: Kernel,
    number: Kernel,
    compact: Kernel,
    certify: Kernel,
    scan: Scan,
}

/// The bind groups of the end of Phase 1, and the buffers that it fills.
#[derive(Debug)]
pub struct BoundFinish {
    /// The mesh without gaps: vertices of the tetrahedra, as places in the input. Infinite tetrahedra come last, and have
    /// infinity last.
    pub tets: Storage<[u32; 4]>,
    /// Neighbours, 4·tetrahedron + face.
    pub neighbors: Storage<[u32; 4]>,
    /// One tetrahedron of each point, plus 1; 0 for one that another stands for. Infinity comes last.
    pub tet_of: Storage<u32>,
    /// Entry [`BoundFinish::FINITE`] is the number of finite tetrahedra.
    pub sums: Storage<u32>,
    /// Tetrahedra that are flat or of which the lattice does not prove everything, with what is open, as
    /// `shaders/d3/certify.wgsl` has it.
    pub uncertain: Storage<Active>,
    /// The places in the input of the failed vertices.
    pub failed: Storage<u32>,
    params: Storage<ScanParams>,
    mark_failed: wgpu::BindGroup,
    mark: wgpu::BindGroup,
    scan: BoundScan,
    number: wgpu::BindGroup,
    compact: wgpu::BindGroup,
    certify: wgpu::BindGroup,
    bytes: u64,
}

impl BoundFinish {
    /// Where in [`BoundFinish::sums`] the number of finite tetrahedra is.
    pub const FINITE: usize = GROUPS;

    /// The bytes that it takes on the device beside the buffers that it shares.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl Finish {
    /// The kernels.
    pub fn new(gpu: &Gpu, width: Width) -> Self {
        let kernel = |name| Kernel::new(gpu, shader::D3.get(name), width);
        Finish {
            mark_failed: kernel("mark_failed"),
            mark: kernel("mesh_mark"),
            number: kernel("mesh_number"),
            compact: kernel("mesh_compact"),
            certify: kernel("certify"),
            scan: Scan::new(gpu),
        }
    }

    /// The bind groups for these buffers.
    ///
    /// # Errors
    ///
    /// As [`Storage::new`].
    pub fn bind(&self, gpu: &Gpu, b: &Buffers) -> Result<BoundFinish, Error> {
        let slots = b.tets.len();
        let params = Storage::new(gpu, "scan parameters", 1)?;
        let marks = Storage::new(gpu, "marks", slots)?;
        let numbers = Storage::new(gpu, "numbers of tetrahedra", slots)?;
        let tet_of = Storage::new(gpu, "tetrahedra of points", b.failed.len() + 1)?;
        let bytes = marks.bytes() + numbers.bytes() + tet_of.bytes();
        let scan = self.scan.bind(gpu, &params, &marks, &numbers)?;
        let sums = scan.sums().clone();
        // Messages and the active list are over by then, and have as many bytes a slot; so is the status once the failed
        // vertices are marked, and the scores of points.
        let (tets, neighbors) = (b.messages.clone(), b.active.seen_as());
        let (uncertain, failed) = (b.status.seen_as(), b.scores.clone());

        let mut buffers = b.bindings();
        buffers.extend([
            ("marks", marks.buffer()),
            ("numbers", numbers.buffer()),
            ("sums", sums.buffer()),
            ("tet_of", tet_of.buffer()),
            ("mesh_tetrahedra", tets.buffer()),
            ("mesh_neighbors", neighbors.buffer()),
            ("uncertain", uncertain.buffer()),
            ("failed_points", failed.buffer()),
        ]);
        let kernels = [&self.mark_failed, &self.mark, &self.number, &self.compact, &self.certify];
        let [mark_failed, mark, number, compact, certify] = kernels.map(|kernel| kernel.bind(gpu, &buffers));
        Ok(BoundFinish {
            tets,
            neighbors,
            tet_of,
            sums,
            uncertain,
            failed,
            params,
            mark_failed,
            mark,
            scan,
            number,
            compact,
            certify,
            bytes,
        })
    }

    /// Records the search for failed vertices, the compaction of `blocks` blocks, and the certification.
    pub fn record(&self, gpu: &Gpu, recorder: &mut Recorder<'_>, bound: &BoundFinish, blocks: u32, workgroups: u32) {
        bound.params.write(gpu, 0, &[ScanParams { count: blocks * BLOCK }]);
        recorder.encoder().clear_buffer(bound.tet_of.buffer(), 0, None);
        recorder.stage("mark failed");
        recorder.dispatch(&self.mark_failed, &bound.mark_failed, workgroups);
        recorder.stage("compact mesh");
        recorder.dispatch(&self.mark, &bound.mark, workgroups);
        self.scan.record(recorder, &bound.scan);
        recorder.dispatch(&self.number, &bound.number, workgroups);
        recorder.dispatch(&self.compact, &bound.compact, workgroups);
        recorder.stage("certify");
        recorder.dispatch(&self.certify, &bound.certify, workgroups);
    }
}
