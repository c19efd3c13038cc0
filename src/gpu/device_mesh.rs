//! Meshes that stay on the device that made them.

use std::{fmt, ops::BitOr};

use bytemuck::Pod;

use crate::{
    cpu::{Incremental, MeshOf},
    dimension::Dimension,
    error::Error,
    gpu::{Gpu, Readback, Storage, readback::Target},
    mesh::MeshInfo,
    stats::{Phase, Stats, Stopwatch},
};

/// Which arrays of a mesh are read from the device.
///
/// # Examples
///
/// ```
/// use gdel::Outputs;
///
/// let outputs = Outputs::SIMPLICES | Outputs::HULL;
/// assert!(outputs.contains(Outputs::HULL) && !outputs.contains(Outputs::NEIGHBORS));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub struct Outputs(u8);

impl Outputs {
    /// No arrays, only what the host knows.
    pub const NONE: Outputs = Outputs(0);
    /// The vertices of the tetrahedra or triangles.
    pub const SIMPLICES: Outputs = Outputs(1);
    /// The neighbours of the tetrahedra, or the half-edges of the triangles.
    pub const NEIGHBORS: Outputs = Outputs(2);
    /// The hull.
    pub const HULL: Outputs = Outputs(4);
    /// All arrays of a mesh.
    pub const ALL: Outputs = Outputs(7);

    /// Returns whether all of `outputs` are among these.
    pub fn contains(self, outputs: Outputs) -> bool {
        self.0 & outputs.0 == outputs.0
    }
}

impl BitOr for Outputs {
    type Output = Outputs;

    fn bitor(self, other: Outputs) -> Outputs {
        Outputs(self.0 | other.0)
    }
}

impl fmt::Debug for Outputs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = [(Outputs::SIMPLICES, "simplices"), (Outputs::NEIGHBORS, "neighbors"), (Outputs::HULL, "hull")];
        f.debug_set().entries(named.into_iter().filter(|&(one, _)| self.contains(one)).map(|(_, name)| name)).finish()
    }
}

/// The arrays of a mesh in host memory, as the device has them.
pub trait MeshArrays<const D: usize>: Incremental<D> {
    /// Returns the words of the simplices, of their neighbours, and of the hull.
    fn words(mesh: &Self::Mesh) -> [&[u32]; 3];

    /// Returns the lowest simplex of each point.
    fn vertex_simplex(mesh: &Self::Mesh) -> Vec<u32>;

    /// Gives the arrays that are among `outputs` room for `simplices` simplices and a hull of
    /// `hull` elements, and empties the others. Returns their bytes.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfMemory`].
    fn make_room(
        mesh: &mut Self::Mesh,
        outputs: Outputs,
        simplices: usize,
        hull: usize,
    ) -> Result<[&mut [u8]; 3], Error>;
}

/// Sets the length of `array`, in its own memory if that suffices; the elements are arbitrary. Returns
/// their bytes.
///
/// # Errors
///
/// Returns [`Error::OutOfMemory`].
pub(crate) fn with_len<T: Pod>(array: &mut Vec<T>, len: usize) -> Result<&mut [u8], Error> {
    if array.capacity() < len {
        // The old memory is freed first, so that both are never held.
        *array = Vec::new();
        *array = bytemuck::try_zeroed_vec(len).map_err(|()| Error::OutOfMemory { simplices: len })?;
    } else {
        array.resize(len, T::zeroed());
    }
    Ok(bytemuck::cast_slice_mut(array))
}

/// The arrays of a mesh on the device.
#[derive(Debug)]
pub struct DeviceArrays {
    /// The vertices of the simplices, D + 1 each.
    pub simplices: Storage<u32>,
    /// The neighbours of the simplices, D + 1 each.
    pub neighbors: Storage<u32>,
    /// The hull: three vertices per triangle in 3D, the vertices in their order in 2D.
    pub hull: Storage<u32>,
    /// The lowest simplex of each point.
    pub vertex_simplices: Storage<u32>,
}

impl DeviceArrays {
    /// Creates the arrays of `simplices` simplices with `corners` corners each, a hull of `hull`
    /// words, and `points` points.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub(crate) fn new(gpu: &Gpu, corners: usize, simplices: usize, hull: usize, points: usize) -> Result<Self, Error> {
        Ok(DeviceArrays {
            simplices: Storage::for_caller(gpu, "simplices of the mesh", corners * simplices)?,
            neighbors: Storage::for_caller(gpu, "neighbours of the mesh", corners * simplices)?,
            hull: Storage::for_caller(gpu, "hull of the mesh", hull)?,
            vertex_simplices: Storage::for_caller(gpu, "simplices of points", points)?,
        })
    }

    fn storages(&self) -> [&Storage<u32>; 4] {
        [&self.simplices, &self.neighbors, &self.hull, &self.vertex_simplices]
    }
}

/// A mesh on the device that made it, in buffers that belong to it: later runs do not change them.
///
/// All buffers are arrays of 32-bit integers. They can be bound as storage, vertex and index
/// buffers, and copied from. An array without elements has a buffer of 16 bytes.
///
/// The memory is freed when the mesh is dropped, once the device has no more use for it. Meshes
/// outlive the triangulator that made them.
///
/// # Examples
///
/// ```
/// use gdel::{Outputs, Triangulator};
///
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
/// match Triangulator::new().device().and_then(|device| device.delaunay3d(&points)) {
///     Ok(mesh) => {
///         // Four words per tetrahedron.
///         assert_eq!((mesh.simplex_count(), mesh.simplices().size()), (1, 16));
///         let read = mesh.read(Outputs::HULL)?;
///         assert_eq!((read.hull.len(), read.tetrahedra.len()), (4, 0));
///         assert_eq!(mesh.read_vertex_simplex()?, [0; 4]);
///     }
///     // There is no GPU at all.
///     Err(error) => println!("{error}"),
/// }
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct DeviceMesh<const D: usize> {
    gpu: Gpu,
    /// Shares the staging buffers of the runs.
    readback: Readback,
    arrays: DeviceArrays,
    duplicate_of: Vec<u32>,
    /// Whether some points are unused: their own duplicates.
    has_unused: bool,
    /// The vertices of the first simplex of the run that made the mesh, if it was one of the device.
    first: Vec<u32>,
    /// How many updates in a row up to this one began anew.
    begun_anew: u32,
    dimension: u8,
    stats: Stats,
}

/// A 3D mesh on the device.
pub type DeviceMesh3 = DeviceMesh<3>;
/// A 2D mesh on the device.
pub type DeviceMesh2 = DeviceMesh<2>;

impl<const D: usize> DeviceMesh<D> {
    /// Returns the buffer of the vertices of the simplices, which are input indices: four per
    /// tetrahedron (`vec4<u32>`), or three per triangle.
    pub fn simplices(&self) -> &wgpu::Buffer {
        self.arrays.simplices.buffer()
    }

    /// Returns the buffer of the neighbours, −1 outside the hull: four tetrahedra per tetrahedron
    /// (`vec4<u32>`), as [`Mesh3::neighbors`](crate::Mesh3::neighbors), or three half-edges per
    /// triangle, as [`Mesh2::halfedges`](crate::Mesh2::halfedges).
    pub fn neighbors(&self) -> &wgpu::Buffer {
        self.arrays.neighbors.buffer()
    }

    /// Returns the buffer of the hull: three vertices per triangle, as
    /// [`Mesh3::hull`](crate::Mesh3::hull), or the vertices, as
    /// [`Mesh2::hull`](crate::Mesh2::hull).
    pub fn hull(&self) -> &wgpu::Buffer {
        self.arrays.hull.buffer()
    }

    /// Returns the buffer of the lowest simplex of each point (`u32`), [`NONE`](crate::NONE) for duplicates.
    pub fn vertex_simplex(&self) -> &wgpu::Buffer {
        self.arrays.vertex_simplices.buffer()
    }

    /// Returns the number of tetrahedra or triangles.
    pub fn simplex_count(&self) -> usize {
        self.arrays.simplices.len() / (D + 1)
    }

    /// Returns the number of triangles of the hull, or of its vertices in 2D.
    pub fn hull_count(&self) -> usize {
        self.arrays.hull.len() / if D == 3 { 3 } else { 1 }
    }

    /// Returns the number of points.
    pub fn point_count(&self) -> usize {
        self.duplicate_of.len()
    }

    /// Returns for each point the one that stands for it, as
    /// [`Mesh3::duplicate_of`](crate::Mesh3::duplicate_of): the host has it in any case.
    pub fn duplicate_of(&self) -> &[u32] {
        &self.duplicate_of
    }

    /// Returns the affine dimension of the points; with less than `D` there are no simplices.
    pub fn dimension(&self) -> u8 {
        self.dimension
    }

    /// Returns how the mesh was computed.
    pub fn stats(&self) -> &Stats {
        &self.stats
    }

    /// Returns whether some points are unused: removed, but still counted.
    pub(crate) fn has_unused(&self) -> bool {
        self.has_unused
    }

    /// Returns the device.
    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Returns the staging buffers.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn readback(&self) -> Readback {
        self.readback.clone()
    }

    /// Returns the vertices of a simplex that was positively oriented and large where the points were;
    /// none if no such simplex is known.
    pub(crate) fn first(&self) -> &[u32] {
        &self.first
    }

    /// Sets what [`first`](Self::first) returns.
    pub(crate) fn set_first(&mut self, vertices: &[u32]) {
        self.first = vertices.to_vec();
    }

    /// Returns how many updates in a row up to this mesh began anew.
    pub(crate) fn begun_anew(&self) -> u32 {
        self.begun_anew
    }

    /// Counts the updates in a row that began anew, given the mesh that this one updates.
    pub(crate) fn count_restarts(&mut self, before: &Self) {
        let has_begun_anew = self.stats.update.is_some_and(|update| update.restarted.is_some());
        self.begun_anew = if has_begun_anew { before.begun_anew.saturating_add(1) } else { 0 };
    }

    pub(crate) fn stats_mut(&mut self) -> &mut Stats {
        &mut self.stats
    }

    /// Returns the bytes that the mesh takes on the device.
    pub fn bytes(&self) -> u64 {
        self.arrays.storages().map(Storage::bytes).iter().sum()
    }

    /// Frees the buffers at once, even if there are clones of them: garbage collectors cannot see device
    /// memory.
    #[doc(hidden)]
    pub fn destroy(&self) {
        for storage in self.arrays.storages() {
            storage.buffer().destroy();
        }
    }

    /// Reads buffers of the mesh. Returns the statistics as well, these readbacks included.
    pub(crate) async fn read_with<T: Target>(&self, reads: Vec<(&wgpu::Buffer, T)>) -> Result<(Vec<T>, Stats), Error> {
        let mut readback = self.readback.clone();
        let (count, bytes) = (readback.count(), readback.bytes());
        let targets = readback.read_into(&self.gpu, reads).await?;
        let mut stats = self.stats.clone();
        if let Some(gpu) = &mut stats.gpu {
            // Each in a submission of its own.
            let pieces = (readback.count() - count) as u64;
            (gpu.readbacks, gpu.submits) = (gpu.readbacks + pieces, gpu.submits + pieces);
            gpu.bytes_read += readback.bytes() - bytes;
        }
        Ok((targets, stats))
    }

    /// Reads buffers of the mesh into memory outside of that of WebAssembly: the simplices, their
    /// neighbours, the hull, and the lowest simplex of each point, by these numbers. `memory` allocates
    /// so many bytes, if it can. Returns the statistics as well, these readbacks included.
    ///
    /// # Errors
    ///
    /// Returns the errors of `read`.
    #[cfg(target_arch = "wasm32")]
    pub async fn read_to_js(
        &self,
        arrays: &[usize],
        memory: impl Fn(u32) -> Option<js_sys::Uint8Array>,
    ) -> Result<(Vec<js_sys::Uint8Array>, Stats), Error> {
        let storages = self.arrays.storages();
        let read = |&i: &usize| {
            let target = memory(4 * storages[i].len() as u32);
            let target = target.ok_or(Error::OutOfMemory { simplices: self.simplex_count() })?;
            Ok((storages[i].buffer(), target))
        };
        self.read_with(arrays.iter().map(read).collect::<Result<_, Error>>()?).await
    }

    /// Returns the lowest simplex of each point, [`NONE`](crate::NONE) for duplicates.
    ///
    /// # Errors
    ///
    /// Returns the errors of `read`.
    pub async fn read_vertex_simplex_async(&self) -> Result<Vec<u32>, Error> {
        let mut array = Vec::new();
        let bytes = with_len(&mut array, self.arrays.vertex_simplices.len())?;
        self.readback.clone().read_into(&self.gpu, vec![(self.vertex_simplex(), bytes)]).await?;
        Ok(array)
    }
}

impl<const D: usize> DeviceMesh<D>
where
    Dimension<D>: MeshArrays<D>,
{
    /// Creates a mesh of arrays that a run has made. `mesh` has the rest; its own arrays are empty.
    pub(crate) fn new(gpu: &Gpu, readback: &Readback, arrays: DeviceArrays, mesh: MeshOf<D>) -> Self {
        let (duplicate_of, dimension, stats) = mesh.into_info();
        let (gpu, readback) = (gpu.clone(), readback.clone());
        DeviceMesh {
            gpu,
            readback,
            arrays,
            duplicate_of,
            has_unused: false,
            first: Vec::new(),
            begun_anew: 0,
            dimension,
            stats,
        }
    }

    /// Creates the buffers of a mesh that somebody else fills: of so many simplices and elements of the hull. Every
    /// point is used.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`] and [`Storage::new`].
    #[cfg(target_arch = "wasm32")]
    pub(crate) async fn with_room(gpu: &Gpu, [simplices, hull]: [usize; 2], info: MeshOf<D>) -> Result<Self, Error> {
        let allocate = || {
            let arrays = DeviceArrays::new(gpu, D + 1, simplices, hull, info.duplicate_of().len())?;
            Ok(DeviceMesh::new(gpu, &Readback::default(), arrays, info))
        };
        gpu.with_error_scope("the mesh", allocate).await
    }

    /// Uploads a mesh that the host has made.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`] and [`Storage::new`].
    pub(crate) async fn upload(gpu: &Gpu, mesh: MeshOf<D>) -> Result<Self, Error> {
        let [simplices, neighbors, hull] = Dimension::<D>::words(&mesh);
        let vertex_simplex = Dimension::<D>::vertex_simplex(&mesh);
        let points = vertex_simplex.len();
        let arrays = gpu
            .with_error_scope("the mesh", || {
                let arrays = DeviceArrays::new(gpu, D + 1, simplices.len() / (D + 1), hull.len(), points)?;
                let words = [simplices, neighbors, hull, bytemuck::cast_slice(&vertex_simplex)];
                for (storage, words) in arrays.storages().into_iter().zip(words) {
                    storage.write(gpu, 0, words);
                }
                gpu.queue().submit([]);
                Ok(arrays)
            })
            .await?;
        let mut mesh = DeviceMesh::new(gpu, &Readback::default(), arrays, mesh);
        mesh.has_unused = (0..).zip(&mesh.duplicate_of).any(|(i, &first)| first == i);
        Ok(mesh)
    }

    /// Reads all arrays, and frees those on the device.
    ///
    /// # Errors
    ///
    /// Returns the errors of `read`.
    pub(crate) async fn into_host(self) -> Result<MeshOf<D>, Error> {
        let mut stopwatch = Stopwatch::start();
        let mut mesh = MeshOf::<D>::default();
        self.read_arrays(Outputs::ALL, &mut mesh).await?;
        mesh.stats_mut().phases.push((Phase::Readback, stopwatch.lap()));
        mesh.set_input(self.duplicate_of, self.dimension);
        Ok(mesh)
    }

    /// Reads all arrays.
    ///
    /// # Errors
    ///
    /// Returns the errors of `read`.
    pub(crate) async fn read_all(&self) -> Result<MeshOf<D>, Error> {
        let mut mesh = MeshOf::<D>::default();
        self.read_arrays(Outputs::ALL, &mut mesh).await?;
        mesh.set_input(self.duplicate_of.clone(), self.dimension);
        Ok(mesh)
    }

    async fn read_arrays(&self, outputs: Outputs, mesh: &mut MeshOf<D>) -> Result<(), Error> {
        let parts = Dimension::<D>::make_room(mesh, outputs, self.simplex_count(), self.hull_count())?;
        let buffers = [self.simplices(), self.neighbors(), self.hull()];
        let (_, stats) = self.read_with(buffers.into_iter().zip(parts).collect()).await?;
        *mesh.stats_mut() = stats;
        Ok(())
    }
}

/// Implements the methods of a mesh on the device that return a `$mesh`.
macro_rules! reading {
    ($D:literal, $mesh:ident) => {
        impl DeviceMesh<$D> {
            /// Reads the arrays that are among `outputs`; the others are empty.
            ///
            /// # Errors
            ///
            /// Returns the errors of `read`.
            pub async fn read_async(&self, outputs: Outputs) -> Result<crate::$mesh, Error> {
                let mut mesh = crate::$mesh::default();
                self.read_into_async(outputs, &mut mesh).await?;
                Ok(mesh)
            }

            /// Reads the arrays that are among `outputs` into the memory that the arrays of `mesh` have: most of the time of
            /// [`read_async`](Self::read_async) goes into fresh memory. The other arrays become empty. After an error the
            /// contents have no meaning.
            ///
            /// # Errors
            ///
            /// Returns the errors of `read`.
            pub async fn read_into_async(&self, outputs: Outputs, mesh: &mut crate::$mesh) -> Result<(), Error> {
                self.read_arrays(outputs, mesh).await?;
                mesh.duplicate_of.clone_from(&self.duplicate_of);
                mesh.dimension = self.dimension;
                Ok(())
            }
        }
    };
}
reading!(3, Mesh3);
reading!(2, Mesh2);
