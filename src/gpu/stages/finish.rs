//! The end of Phase 1: failed vertices (§3.2.1), the mesh without gaps, and what rounding leaves open.

use super::scan::{GROUPS, Scan, ScanParams};
use crate::{
    Error,
    gpu::{
        Gpu, Kernel, Recorder, Storage,
        layout::{Active, BLOCK},
        phase1::Buffers,
    },
    lattice::Width,
};

/// The kernels of the end of Phase 1.
#[derive(Debug)]
pub struct Finish {
    mark_failed: Kernel,
    mesh_mark: Kernel,
    mesh_compact: Kernel,
    /// Where coordinates can be rounded.
    certify: Option<Kernel>,
    scan: Scan,
}

/// The mesh without gaps, on the device.
#[derive(Debug)]
pub struct Compacted {
    /// Vertices of the tetrahedra.
    pub tets: Storage<[u32; 4]>,
    /// Neighbours, 4·tetrahedron + face.
    pub neighbors: Storage<[u32; 4]>,
    /// One tetrahedron of each vertex, plus 1; 0 for one that another stands for. Infinity comes last.
    pub tet_of: Storage<u32>,
    /// Entry [`GROUPS`] is the number of tetrahedra.
    pub sums: Storage<u32>,
    /// Tetrahedra of which the lattice does not prove everything, with what is open, as `shaders/certify.wgsl` has it.
    pub uncertain: Storage<Active>,
}

impl Compacted {
    /// Where in [`Compacted::sums`] the number of tetrahedra is.
    pub const COUNT: usize = GROUPS;
}

impl Finish {
    /// The kernels.
    pub fn new(gpu: &Gpu, width: Width) -> Self {
        let kernel = |name| Kernel::new(gpu, name, width, &[]);
        Finish {
            mark_failed: kernel("mark_failed"),
            mesh_mark: kernel("mesh_mark"),
            mesh_compact: kernel("mesh_compact"),
            certify: (width == Width::Wide).then(|| kernel("certify")),
            scan: Scan::new(gpu),
        }
    }

    /// Records the search for failed vertices, and the compaction.
    ///
    /// # Errors
    ///
    /// As [`Storage::new`].
    pub fn record(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        b: &Buffers,
        blocks: u32,
        workgroups: u32,
    ) -> Result<Compacted, Error> {
        let (control, tets, neighbors) = (b.control.buffer(), b.tets.buffer(), b.neighbors.buffer());
        let slots = b.tets.len();
        let failed = self
            .mark_failed
            .bind(gpu, &[control, b.points.vertices.buffer(), tets, neighbors, b.status.buffer(), b.failed.buffer()]);
        recorder.stage("mark failed");
        recorder.dispatch(&self.mark_failed, &failed, workgroups);

        let params = Storage::with_contents(gpu, "scan parameters", &[ScanParams { count: blocks * BLOCK }])?;
        let marks = Storage::new(gpu, "marks", slots)?;
        let offsets = Storage::new(gpu, "offsets", slots)?;
        let scan = self.scan.bind(gpu, &params, &marks, &offsets)?;
        let compacted = Compacted {
            // Messages are over; their buffer has one entry a slot.
            tets: b.messages.clone(),
            neighbors: Storage::new(gpu, "compacted neighbours", slots)?,
            tet_of: Storage::new(gpu, "tetrahedra of vertices", b.failed.len() + 1)?,
            sums: scan.sums().clone(),
            // The active list is empty; its buffer has two entries a slot.
            uncertain: b.active.clone(),
        };
        let mark = self.mesh_mark.bind(gpu, &[control, tets, marks.buffer()]);
        let compact = self.mesh_compact.bind(
            gpu,
            &[
                control,
                tets,
                neighbors,
                offsets.buffer(),
                compacted.tets.buffer(),
                compacted.neighbors.buffer(),
                compacted.tet_of.buffer(),
            ],
        );
        recorder.stage("compact mesh");
        recorder.dispatch(&self.mesh_mark, &mark, workgroups);
        self.scan.record(recorder, &scan);
        recorder.dispatch(&self.mesh_compact, &compact, workgroups);
        if let Some(kernel) = &self.certify {
            let certify = kernel.bind(
                gpu,
                &[
                    control,
                    b.points.vertices.buffer(),
                    compacted.tets.buffer(),
                    compacted.neighbors.buffer(),
                    compacted.sums.buffer(),
                    b.points.counts.buffer(),
                    compacted.uncertain.buffer(),
                ],
            );
            recorder.stage("certify");
            recorder.dispatch(kernel, &certify, workgroups);
        }
        Ok(compacted)
    }
}
