//! From the mesh of the slots to the arrays of the caller's mesh, on the device.
//!
//! 1. `outputs_mark` and a scan number the tetrahedra of the mesh in the order of their slots.
//! 2. `outputs_write` copies them with these numbers, and the hull from the ghosts.
//! 3. `vertex_clear` and `vertex_simplex` find a tetrahedron of each point.

use bytemuck::{Pod, Zeroable};

use crate::{
    d3::Mesh3,
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Kernel, Readback, Recorder, Storage, append_bindings,
        device_mesh::{DeviceArrays, MeshArrays, Outputs, with_len},
        mesh_check::{MeshCheck, Samples, count_vertices, samples3},
        phase1::Slot,
        primitives::scan::{GROUPS, Scan},
        shader::{self, assert_layout},
        vertex_simplices::VertexSimplices,
    },
    input::lattice::Width,
    mesh,
};

/// The parameters of the kernels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct OutputParams {
    /// The number of slots.
    pub count: u32,
    /// The number of points, which is the vertex at infinity.
    pub infinite: u32,
    /// The number of tetrahedra of the mesh.
    pub finite: u32,
    /// The number of facets of its hull.
    pub hull: u32,
}
assert_layout!(OutputParams);

/// A mesh in slots, on the device.
#[derive(Debug, Clone, Copy)]
pub struct SlotMesh<'a> {
    /// The vertices of each slot, as input indices: ghosts have infinity last, unused slots are
    /// zero.
    pub tetrahedra: &'a Storage<Slot>,
    /// The neighbours of each slot: 4·slot + facet.
    pub neighbors: &'a Storage<Slot>,
    /// A word per slot to work with.
    pub marks: &'a Storage<u32>,
    /// Another one.
    pub numbers: &'a Storage<u32>,
    /// The numbers of all these.
    pub params: OutputParams,
}

/// The kernels.
#[derive(Debug)]
pub struct OutputStage {
    mark: Kernel,
    scan: Scan,
    write: Kernel,
    vertices: VertexSimplices,
    check: MeshCheck,
}

/// What the kernels have made.
#[derive(Debug)]
pub struct MadeArrays {
    /// The arrays of the caller's mesh.
    pub arrays: DeviceArrays,
    /// The hull, if it was to be read.
    pub hull: Vec<[u32; 3]>,
    /// Samples of the mesh for the host, or what is wrong with it.
    pub(crate) samples: Result<Samples, &'static str>,
    /// The number of dispatches.
    pub dispatches: usize,
}

impl OutputStage {
    /// Creates the kernels.
    pub fn new(compiler: &Compiler<'_>) -> Self {
        let kernel = |name| compiler.kernel(shader::D3.get(name), Width::Narrow);
        OutputStage {
            mark: kernel("outputs_mark"),
            scan: Scan::new(compiler),
            write: kernel("outputs_write"),
            vertices: VertexSimplices::new::<3>(compiler),
            check: MeshCheck::new::<3>(compiler),
        }
    }

    /// Makes the arrays of the mesh after what `before` records, and waits until the device has done so. Reads the hull in the
    /// same submission if `reads_hull`. All points are vertices but those that are `duplicate_of` others.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`] and [`Storage::new`], and [`Error::WrongResults`] if
    /// there are not as many tetrahedra or facets of the hull as `mesh` says.
    pub async fn run(
        &self,
        gpu: &Gpu,
        readback: &mut Readback,
        before: impl FnOnce(&mut Recorder<'_>),
        mesh: SlotMesh<'_>,
        duplicate_of: &[u32],
        reads_hull: bool,
    ) -> Result<MadeArrays, Error> {
        let OutputParams { count, infinite, finite, hull } = mesh.params;
        let (arrays, dispatches, submission, (finite_read, hull_len_read, hull_read, checked)) = gpu
            .with_error_scope("the mesh", || {
                let [finite, hull, points] = [finite, hull, infinite].map(|n| n as usize);
                let arrays = DeviceArrays::new(gpu, 4, finite, 3 * hull, points)?;
                let params = Storage::with_contents(gpu, "parameters of the mesh", &[mesh.params])?;
                let hull_len = Storage::<u32>::new(gpu, "facets of the hull", 1)?;
                let mut buffers = vec![
                    ("outputs", params.buffer()),
                    ("out_tetrahedra", arrays.simplices.buffer()),
                    ("out_neighbors", arrays.neighbors.buffer()),
                    ("out_hull", arrays.hull.buffer()),
                    ("hull_len", hull_len.buffer()),
                ];
                append_bindings(
                    &mut buffers,
                    &[
                        mesh.tetrahedra.named("mesh_tetrahedra"),
                        mesh.neighbors.named("mesh_neighbors"),
                        mesh.marks.named("marks"),
                        mesh.numbers.named("numbers"),
                    ],
                );
                // The parameters of the scan are the count alone, which comes first here, too.
                let scan = self.scan.bind(gpu, &params.cast(), mesh.marks, mesh.numbers)?;
                let mut recorder = Recorder::new(gpu, None);
                before(&mut recorder);
                let run = |recorder: &mut Recorder<'_>, kernel: &Kernel, items: u32| {
                    recorder.dispatch(kernel, &kernel.bind(&buffers), gpu.workgroups(items as usize));
                };
                run(&mut recorder, &self.mark, count);
                scan.record(&mut recorder);
                run(&mut recorder, &self.write, count);
                self.vertices.record(gpu, &mut recorder, &arrays);
                let checked = self.check.record::<3>(gpu, &mut recorder, &arrays)?;
                let dispatches = recorder.dispatches();
                let finite = readback.copy(gpu, recorder.encoder(), scan.sums(), GROUPS, 1);
                let hull_len = readback.copy(gpu, recorder.encoder(), &hull_len, 0, 1);
                let hull =
                    reads_hull.then(|| readback.copy(gpu, recorder.encoder(), &arrays.hull, 0, arrays.hull.len()));
                let checked = readback.copy(gpu, recorder.encoder(), &checked, 0, checked.len());
                Ok((arrays, dispatches, recorder.submit(gpu), (finite, hull_len, hull, checked)))
            })
            .await?;
        // While the device is at work.
        let vertices = count_vertices(duplicate_of);
        let counted = readback.receive(gpu, &submission, finite_read).await?;
        let on_hull = readback.receive(gpu, &submission, hull_len_read).await?;
        let hull_words = match hull_read {
            Some(pending) => readback.receive(gpu, &submission, pending).await?,
            None => Vec::new(),
        };
        let checked = readback.receive(gpu, &submission, checked).await?;
        if (counted[0], on_hull[0]) != (finite, hull) {
            return Err(gpu.wrong("the device and the host count the tetrahedra of the mesh differently"));
        }
        let samples = samples3(checked, vertices, arrays.hull.len() / 3);
        let hull = hull_words.as_chunks().0.to_vec();
        Ok(MadeArrays { arrays, hull, samples, dispatches })
    }
}

impl MeshArrays<3> for Dimension<3> {
    fn words(mesh: &Mesh3) -> [&[u32]; 3] {
        let neighbors = bytemuck::cast_slice(mesh.neighbors.as_flattened());
        [mesh.tetrahedra.as_flattened(), neighbors, mesh.hull.as_flattened()]
    }

    fn vertex_simplex(mesh: &Mesh3) -> Vec<u32> {
        mesh::vertex_simplex(&mesh.tetrahedra, mesh.duplicate_of.len())
    }

    fn make_room(mesh: &mut Mesh3, outputs: Outputs, simplices: usize, hull: usize) -> Result<[&mut [u8]; 3], Error> {
        let len = |output: Outputs, len: usize| if outputs.contains(output) { len } else { 0 };
        Ok([
            with_len(&mut mesh.tetrahedra, len(Outputs::SIMPLICES, simplices))?,
            with_len(&mut mesh.neighbors, len(Outputs::NEIGHBORS, simplices))?,
            with_len(&mut mesh.hull, len(Outputs::HULL, hull))?,
        ])
    }
}
