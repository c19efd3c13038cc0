//! The edges of meshes on the device.
//!
//! The lowest simplex around an edge lists it. All edges in both directions are then sorted by their
//! ends, which gives the neighbours of each vertex.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Readback, Recorder, Storage,
        device_mesh::DeviceMesh,
        dim::Dim,
        primitives::{
            scan::{GROUPS, Scan, ScanParams},
            sort::Sort,
        },
        workgroups,
    },
    input::lattice::Width,
    mesh::Csr,
};

/// The edges of a mesh on its device, and the neighbours of each vertex.
///
/// All buffers are arrays of `u32`, with the usages of those of the [mesh](DeviceMesh). An array
/// without elements has a buffer of 16 bytes.
///
/// # Examples
///
/// ```
/// use gdel::Triangulator;
///
/// // A square around its centre.
/// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0f64]];
/// if let Ok(mesh) = Triangulator::new().device().and_then(|device| device.delaunay2d(&points)) {
///     let edges = mesh.edges()?;
///     assert_eq!((edges.edge_count(), edges.edges().size()), (8, 64));
///     assert_eq!(edges.read_vertex_neighbors()?.of(4), [0, 1, 2, 3]);
/// }
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct DeviceEdges {
    gpu: Gpu,
    readback: Readback,
    edges: Storage<[u32; 2]>,
    offsets: Storage<u32>,
    neighbors: Storage<u32>,
}

impl DeviceEdges {
    /// Returns the buffer of the edges, two vertices each (`vec2<u32>`), in the order of
    /// [`Mesh3::edges`](crate::Mesh3::edges) or [`Mesh2::edges`](crate::Mesh2::edges).
    pub fn edges(&self) -> &wgpu::Buffer {
        self.edges.buffer()
    }

    /// Returns the number of edges.
    pub fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// Returns the buffer that says where the neighbours of each vertex start in
    /// [`neighbors`](Self::neighbors); one more entry says where the last ones end.
    pub fn neighbor_offsets(&self) -> &wgpu::Buffer {
        self.offsets.buffer()
    }

    /// Returns the buffer of the neighbours of the vertices, one list after the other, each in
    /// ascending order.
    pub fn neighbors(&self) -> &wgpu::Buffer {
        self.neighbors.buffer()
    }

    /// Reads the edges. Blocks the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`DeviceMesh::read_vertex_simplex`].
    pub fn read_edges(&self) -> Result<Vec<[u32; 2]>, Error> {
        pollster::block_on(self.readback.clone().read(&self.gpu, &self.edges, 0, self.edges.len()))
    }

    /// Reads the neighbours of the vertices. Blocks the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`DeviceMesh::read_vertex_simplex`].
    pub fn read_vertex_neighbors(&self) -> Result<Csr, Error> {
        let read = |storage: &Storage<u32>| {
            pollster::block_on(self.readback.clone().read(&self.gpu, storage, 0, storage.len()))
        };
        let offsets = read(&self.offsets)?.into_iter().map(|offset| offset as usize).collect();
        Ok(Csr { offsets, indices: read(&self.neighbors)? })
    }
}

impl<const D: usize> DeviceMesh<D>
where
    Dimension<D>: Dim<D>,
{
    /// Finds the edges, and the neighbours of each vertex, on the device. Blocks the thread.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`] and the other errors of the device.
    pub fn edges(&self) -> Result<DeviceEdges, Error> {
        pollster::block_on(self.edges_async())
    }

    /// Does the same without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`edges`](Self::edges).
    pub async fn edges_async(&self) -> Result<DeviceEdges, Error> {
        let gpu = self.gpu();
        let mut readback = self.readback();
        let (simplices, points) = (self.simplex_count(), self.point_count());
        if simplices == 0 {
            let empty = || {
                let [edges, neighbors] = ["edges of the mesh", "neighbours of vertices"]
                    .map(|label| Storage::<u32>::for_caller(gpu, label, 0));
                let offsets = Storage::for_caller(gpu, "offsets of neighbours", points + 1)?;
                Ok((edges?.cast(), offsets, neighbors?))
            };
            let (edges, offsets, neighbors) = gpu.with_error_scope("edges", empty).await?;
            return Ok(DeviceEdges { gpu: gpu.clone(), readback, edges, offsets, neighbors });
        }
        let compiler = Compiler::keeping(gpu);
        let kernel = |name| compiler.kernel(Dimension::<D>::SHADERS.get(name), Width::Narrow);
        let [mark, write, turn, rings] = ["edges_mark", "edges_write", "edges_turn", "edges_rings"].map(kernel);
        let (scan, sort) = (Scan::new(&compiler), Sort::new(&compiler));
        compiler.finish().await?;

        let (listed, offsets, submission, total) = gpu
            .with_error_scope("edges", || {
                let listed = Storage::<u32>::new(gpu, "listed edges", simplices)?;
                let counts = Storage::<u32>::new(gpu, "numbers of edges", simplices)?;
                let offsets = Storage::<u32>::new(gpu, "offsets of edges", simplices)?;
                let params = Storage::with_contents(gpu, "scan", &[ScanParams { count: simplices as u32 }])?;
                let bound = scan.bind(gpu, &params, &counts, &offsets)?;
                let buffers = [
                    ("simplices", self.simplices()),
                    ("neighbors", self.neighbors()),
                    ("listed", listed.buffer()),
                    ("counts", counts.buffer()),
                ];
                let mut recorder = Recorder::new(gpu, None);
                recorder.dispatch(&mark, &mark.bind(&buffers), workgroups(simplices as u32));
                bound.record(&mut recorder);
                let total = readback.copy(gpu, recorder.encoder(), bound.sums(), GROUPS, 1);
                Ok((listed, offsets, recorder.submit(gpu), total))
            })
            .await?;
        let count = readback.receive(gpu, &submission, total).await?[0] as usize;
        let (edges, offsets, neighbors) = gpu
            .with_error_scope("edges", || {
                let edges = Storage::<u32>::for_caller(gpu, "edges of the mesh", 2 * count)?;
                let mut pairs = Storage::<[u32; 2]>::new(gpu, "pairs of neighbours", 2 * count)?;
                let mut scratch = Storage::<[u32; 2]>::new(gpu, "sort scratch", 2 * count)?;
                let ring_offsets = Storage::<u32>::for_caller(gpu, "offsets of neighbours", points + 1)?;
                let ring = Storage::<u32>::for_caller(gpu, "neighbours of vertices", 2 * count)?;
                let buffers = [
                    ("simplices", self.simplices()),
                    ("listed", listed.buffer()),
                    ("offsets", offsets.buffer()),
                    ("edges", edges.buffer()),
                    ("pairs", pairs.buffer()),
                ];
                let bits = usize::BITS - points.leading_zeros();
                let mut recorder = Recorder::new(gpu, None);
                recorder.dispatch(&write, &write.bind(&buffers), gpu.workgroups(simplices));
                let first = sort.bind(gpu, &mut pairs, &mut scratch, bits)?;
                sort.record(&mut recorder, &first);
                recorder.dispatch(&turn, &turn.bind(&[("pairs", pairs.buffer())]), gpu.workgroups(2 * count));
                let second = sort.bind(gpu, &mut pairs, &mut scratch, bits)?;
                sort.record(&mut recorder, &second);
                let buffers =
                    [("pairs", pairs.buffer()), ("ring_offsets", ring_offsets.buffer()), ("ring", ring.buffer())];
                recorder.dispatch(&rings, &rings.bind(&buffers), gpu.workgroups((2 * count).max(points + 1)));
                recorder.submit(gpu);
                Ok((edges.cast(), ring_offsets, ring))
            })
            .await?;
        Ok(DeviceEdges { gpu: gpu.clone(), readback, edges, offsets, neighbors })
    }
}
