//! Answers of the GPU for meshes that are there.

use super::{Interpolation, Interpolator, Location, Locator, StolenMeasures, queries::CurveKey};
use crate::{
    cpu::MeshOf,
    dimension::Dimension,
    error::Error,
    geometry::{self, Euclidean},
    gpu::{
        Storage,
        device_edges::DeviceEdges,
        device_mesh::{DeviceMesh, MeshArrays},
        dim::Dim,
        points::bits_of,
        queries::{NOWHERE, OPEN, OPEN_RADIUS, QueryCounts, QueryInput, QueryPoints},
    },
    input::points::Points,
    mesh::Mesh,
    parallel::{Threads, extend},
};
use std::{
    collections::VecDeque,
    fmt,
    sync::{
        OnceLock,
        atomic::{AtomicUsize, Ordering},
    },
};

/// The queries that go to the device at a time.
const BATCH: usize = 1 << 20;
/// The batches that are on their way at a time.
const BATCHES_AHEAD: usize = 3;

/// Where points lie in a mesh, in four bytes each.
///
/// # Examples
///
/// ```
/// use gdel::{Location, Locations};
///
/// let locations = Locations::from_words(vec![7, !(4 * 5 + 1), i32::MIN]);
/// assert_eq!(locations.get(0), Location::Inside(7));
/// assert_eq!(locations.get(1), Location::Outside { simplex: 5, facet: 1 });
/// assert_eq!(locations.iter().last(), Some(Location::Nowhere));
/// ```
#[derive(Clone, PartialEq, Eq, Default)]
pub struct Locations {
    words: Vec<i32>,
}

impl Locations {
    /// Takes over the words of a buffer of locations: see
    /// [`DeviceLocator::locate_buffer`](DeviceLocator::locate_buffer).
    pub fn from_words(words: Vec<i32>) -> Self {
        Locations { words }
    }

    /// Returns the words.
    pub fn words(&self) -> &[i32] {
        &self.words
    }

    /// Returns the number of locations.
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// Returns location `i`.
    ///
    /// # Panics
    ///
    /// Panics if `i` is not below [`len`](Self::len).
    pub fn get(&self, i: usize) -> Location {
        location_of(self.words[i])
    }

    /// Returns an iterator over all locations.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Location> + Clone + '_ {
        self.words.iter().copied().map(location_of)
    }
}

impl fmt::Debug for Locations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

/// Returns the location of a word.
fn location_of(word: i32) -> Location {
    match word {
        0.. => Location::Inside(word as usize),
        i32::MIN => Location::Nowhere,
        _ => {
            let facet = !word as usize;
            Location::Outside { simplex: facet / 4, facet: facet % 4 }
        }
    }
}

/// Returns the word of a location.
fn word_of(location: Location) -> i32 {
    match location {
        Location::Inside(simplex) => simplex as i32,
        Location::Outside { simplex, facet } => !((4 * simplex + facet) as i32),
        Location::Nowhere => NOWHERE as i32,
    }
}

/// Locates points in a mesh on the device.
///
/// It answers as an [exact](Locator::exact) [`Locator`] does, without a tolerance. Queries and answers
/// may be slices, or buffers of the mesh's device, between which the host reads a few words. The points
/// stay on the device, 32 bytes each, 16 in 2D.
///
/// The device decides signs by a filter with a proven bound, and then by integers. What it leaves
/// open the host finds out: queries further away from the points than about half of their extent,
/// those that lie nearly on a facet if they or the points have more than about 60 bits, and those
/// on a vertex with hundreds of simplices. For the first of them the mesh is read to the host, and
/// stays there; [`host_answers`](Self::host_answers) counts them.
///
/// [`circumspheres`](Self::circumspheres) computes those of all simplices from the same integers.
///
/// # Examples
///
/// ```
/// use gdel::{DeviceLocator, Location, Triangulator};
///
/// let points: Vec<[f64; 3]> = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect();
/// match Triangulator::new().device().and_then(|device| device.delaunay3d(&points)) {
///     Ok(mesh) => {
///         let locator = DeviceLocator::new(&mesh, &points)?;
///         let locations = locator.locate_many(&[[4.5, 2.25, 7.75], [0.5, 0.5, -1.0f32]])?;
///         assert!(matches!(locations.get(0), Location::Inside(_)));
///         assert!(matches!(locations.get(1), Location::Outside { .. }));
///     }
///     // There is no GPU at all.
///     Err(error) => println!("{error}"),
/// }
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct DeviceLocator<'a, const D: usize = 3, const N: usize = 4>
where
    Dimension<D>: MeshArrays<D>,
{
    mesh: &'a DeviceMesh<D>,
    points: Points<'a, D>,
    /// Unless there are no simplices.
    on_device: Option<QueryPoints<D>>,
    /// The neighbours of the vertices, once they were needed.
    edges: OnceLock<DeviceEdges>,
    /// The mesh, once it was needed on the host.
    on_host: OnceLock<MeshOf<D>>,
    host_answers: AtomicUsize,
}

/// Locates points in a 2D mesh on the device.
///
/// # Examples
///
/// ```
/// use gdel::{DeviceLocator2, Location, Triangulator};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f32]];
/// if let Ok(mesh) = Triangulator::new().device().and_then(|device| device.delaunay2d(&points)) {
///     let locator = DeviceLocator2::new(&mesh, &points)?;
///     assert_eq!(locator.locate_many(&[[0.25, 0.25f32]])?.get(0), Location::Inside(0));
/// }
/// # Ok::<(), gdel::Error>(())
/// ```
pub type DeviceLocator2<'a> = DeviceLocator<'a, 2, 3>;

impl<'a, const D: usize, const N: usize> DeviceLocator<'a, D, N>
where
    Dimension<D>: Dim<D> + MeshArrays<D>,
    MeshOf<D>: Mesh<D, N>,
    Euclidean: StolenMeasures<D, N>,
{
    /// Creates a locator for a mesh on the device and its points, which are uploaded. Blocks the
    /// thread.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`] if these are not the points of the mesh, [`Error::NotFinite`] if one
    /// of them is not finite, [`Error::TooManySimplices`] beyond 2²⁹, and the errors of the device.
    pub fn new(mesh: &'a DeviceMesh<D>, points: impl Into<Points<'a, D>>) -> Result<Self, Error> {
        pollster::block_on(Self::new_async(mesh, points))
    }

    /// Does the same as [`new`](Self::new) without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new).
    pub async fn new_async(mesh: &'a DeviceMesh<D>, points: impl Into<Points<'a, D>>) -> Result<Self, Error> {
        const LIMIT: usize = 1 << 29;
        let points = points.into();
        if points.len() != mesh.point_count() {
            return Err(Error::PointCount { points: points.len(), expected: mesh.point_count() });
        }
        if mesh.simplex_count() > LIMIT {
            return Err(Error::TooManySimplices { limit: LIMIT });
        }
        let bounds = points.finite_bounds(Threads::All)?;
        let on_device = match mesh.simplex_count() {
            0 => None,
            _ => Some(QueryPoints::new(mesh, points, bounds, CurveKey::new(bounds).cells()).await?),
        };
        Ok(DeviceLocator {
            mesh,
            points,
            on_device,
            edges: OnceLock::new(),
            on_host: OnceLock::new(),
            host_answers: AtomicUsize::new(0),
        })
    }

    /// Returns where each of many points lies. Blocks the thread.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`], [`Error::BrokenMesh`] if the points are not those of the mesh, and the
    /// errors of the device.
    pub fn locate_many<'q>(&self, queries: impl Into<Points<'q, D>>) -> Result<Locations, Error> {
        pollster::block_on(self.locate_many_async(queries))
    }

    /// Does the same as [`locate_many`](Self::locate_many) without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`locate_many`](Self::locate_many).
    pub async fn locate_many_async<'q>(&self, queries: impl Into<Points<'q, D>>) -> Result<Locations, Error> {
        let queries = queries.into();
        let Some(on_device) = &self.on_device else {
            queries.validate_by(Threads::All)?;
            return Ok(Locations { words: vec![NOWHERE as i32; queries.len()] });
        };
        let gpu = self.mesh.gpu();
        let mut words = Vec::with_capacity(queries.len());
        let mut batches =
            (0..queries.len()).step_by(BATCH).map(|start| queries.range(start..queries.len().min(start + BATCH)));
        let mut ahead = VecDeque::new();
        loop {
            // While the device answers one, the host uploads the next.
            while ahead.len() < BATCHES_AHEAD
                && let Some(batch) = batches.next()
            {
                let (input, answers) = self.upload(batch).await?;
                let count = batch.len();
                let input = QueryInput { buffer: input.buffer(), count, doubles: bits_of(batch).1 };
                let locating = on_device.begin_locating(self.mesh, input, &answers, count).await?;
                ahead.push_back((batch, answers, locating));
            }
            let Some((batch, answers, locating)) = ahead.pop_front() else { break };
            let (counts, mut found) = locating.end(gpu).await?;
            if self.finish_on_host(queries, batch, &counts, &answers).await? {
                found = self.mesh.readback().read(gpu, &answers, 0, batch.len()).await?;
            }
            extend(Threads::All, &mut words, bytemuck::cast_slice(&found));
        }
        Ok(Locations { words })
    }

    /// Returns the vertex that is nearest to each of many points, as
    /// [`Locator::nearest_many`] does: the lowest of those at the same distance; `None` if there
    /// are no points. The host answers for points in a plane or on a line. The first call finds the [edges](DeviceMesh::edges). Blocks the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceLocator, Triangulator};
    ///
    /// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0f64]];
    /// if let Ok(mesh) = Triangulator::new().device().and_then(|device| device.delaunay2d(&points)) {
    ///     let locator = DeviceLocator::new(&mesh, &points)?;
    ///     // The second one is at the same distance from all.
    ///     assert_eq!(locator.nearest_many(&[[1.5, 3.0], [1.0, 1.0]])?, [Some(3), Some(0)]);
    /// }
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`locate_many`](Self::locate_many) and of [`DeviceMesh::edges`].
    pub fn nearest_many<'q>(&self, queries: impl Into<Points<'q, D>>) -> Result<Vec<Option<u32>>, Error> {
        pollster::block_on(self.nearest_many_async(queries))
    }

    /// Does the same as [`nearest_many`](Self::nearest_many) without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`nearest_many`](Self::nearest_many).
    pub async fn nearest_many_async<'q>(&self, queries: impl Into<Points<'q, D>>) -> Result<Vec<Option<u32>>, Error> {
        let queries = queries.into();
        let Some(on_device) = &self.on_device else {
            return self.host_locator().await?.nearest_many(queries);
        };
        let edges = self.edges().await?;
        let gpu = self.mesh.gpu();
        let mut found = Vec::with_capacity(queries.len());
        for start in (0..queries.len()).step_by(BATCH) {
            let batch = queries.range(start..queries.len().min(start + BATCH));
            let (input, answers) = self.upload(batch).await?;
            let input = QueryInput { buffer: input.buffer(), count: batch.len(), doubles: bits_of(batch).1 };
            let counts = on_device.nearest(self.mesh, edges, input, &answers).await?;
            if counts.not_finite.is_some() {
                queries.validate_by(Threads::All)?;
            }
            let words: Vec<u32> = self.mesh.readback().read(gpu, &answers, 0, batch.len()).await?;
            let mut nearest: Vec<Option<u32>> = words.iter().map(|&word| Some(word)).collect();
            if counts.open > 0 {
                let (open, open_queries) = open_among(batch, &words);
                let locator = self.host_locator().await?;
                for (&i, vertex) in open.iter().zip(locator.nearest_many(Points::F64(&open_queries))?) {
                    nearest[i] = vertex;
                }
                self.host_answers.fetch_add(open.len(), Ordering::Relaxed);
            }
            found.append(&mut nearest);
        }
        Ok(found)
    }

    /// Returns the vertex that is nearest to each of the points in a buffer, in a buffer. Blocks the
    /// thread.
    ///
    /// `queries` is as for [`locate_buffer`](Self::locate_buffer). Each answer is an `i32`: the
    /// vertex, or −1 if the mesh has no simplices.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`nearest_many`](Self::nearest_many) and of
    /// [`locate_buffer`](Self::locate_buffer).
    pub fn nearest_buffer(&self, queries: &wgpu::Buffer) -> Result<wgpu::Buffer, Error> {
        pollster::block_on(self.nearest_buffer_async(queries))
    }

    /// Does the same as [`nearest_buffer`](Self::nearest_buffer) without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`nearest_buffer`](Self::nearest_buffer).
    pub async fn nearest_buffer_async(&self, queries: &wgpu::Buffer) -> Result<wgpu::Buffer, Error> {
        let count = count_in::<D>(queries)?;
        let gpu = self.mesh.gpu();
        let answers = gpu.with_error_scope("answers", || Storage::for_caller(gpu, "nearest vertices", count)).await?;
        let Some(on_device) = &self.on_device else {
            self.read_queries(queries, count).await?;
            answers.write(gpu, 0, &vec![u32::MAX; count]);
            return Ok(answers.buffer().clone());
        };
        let input = QueryInput { buffer: queries, count, doubles: false };
        let counts = on_device.nearest(self.mesh, self.edges().await?, input, &answers).await?;
        if counts.not_finite.is_some() || counts.open > 0 {
            let queries = self.read_queries(queries, count).await?;
            let mut words: Vec<u32> = self.mesh.readback().read(gpu, &answers, 0, count).await?;
            let (open, open_queries) = open_among(Points::F32(&queries), &words);
            let nearest = self.host_locator().await?.nearest_many(Points::F64(&open_queries))?;
            for (&i, vertex) in open.iter().zip(nearest) {
                words[i] = vertex.unwrap_or(u32::MAX);
            }
            answers.write(gpu, 0, &words);
            self.host_answers.fetch_add(open.len(), Ordering::Relaxed);
        }
        Ok(answers.buffer().clone())
    }

    /// Interpolates values at the points linearly, and returns the value at each of many queries;
    /// NaN outside the hull. Blocks the thread.
    ///
    /// The simplex is the one that contains the query, exactly, and the value is that of the vertex
    /// at a vertex. The host answers for points in a plane or on a line, within these. Otherwise it is
    /// computed in single precision: with an error of at most 2⁻¹⁸
    /// times the largest value at the vertices of the simplex, if that is thicker than 2⁻³⁵ times the
    /// extent of the points. [`Interpolator`](crate::Interpolator) has other
    /// methods, and double precision.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceLocator, Triangulator};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0f32]];
    /// if let Ok(mesh) = Triangulator::new().device().and_then(|device| device.delaunay2d(&points)) {
    ///     let locator = DeviceLocator::new(&mesh, &points)?;
    ///     let found = locator.interpolate_many(&[0.0, 4.0, 8.0], &[[1.0, 2.0], [0.0, 4.0], [4.0, 4.0f32]])?;
    ///     assert!((found[0] - 5.0).abs() < 1e-5);
    ///     assert_eq!(found[1], 8.0);
    ///     assert!(found[2].is_nan());
    /// }
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::ValueCount`] if there are not as many values as points, and the errors of
    /// [`locate_many`](Self::locate_many).
    pub fn interpolate_many<'q>(&self, values: &[f32], queries: impl Into<Points<'q, D>>) -> Result<Vec<f32>, Error> {
        pollster::block_on(self.interpolate_many_async(values, queries))
    }

    /// Does the same as [`interpolate_many`](Self::interpolate_many) without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`interpolate_many`](Self::interpolate_many).
    pub async fn interpolate_many_async<'q>(
        &self,
        values: &[f32],
        queries: impl Into<Points<'q, D>>,
    ) -> Result<Vec<f32>, Error> {
        let queries = queries.into();
        self.check_values(values.len())?;
        let Some(on_device) = &self.on_device else {
            let values: Vec<f64> = values.iter().map(|&value| value.into()).collect();
            let locator = self.host_locator().await?;
            let found = Interpolator::new(&locator, &values)?.interpolate_many(Interpolation::Linear, queries)?;
            return Ok(found.values.into_iter().map(|value| value as f32).collect());
        };
        let gpu = self.mesh.gpu();
        let values = gpu.with_error_scope("values", || Storage::with_contents(gpu, "values", values)).await?;
        let mut found = Vec::with_capacity(queries.len());
        for start in (0..queries.len()).step_by(BATCH) {
            let batch = queries.range(start..queries.len().min(start + BATCH));
            let (input, answers) = self.locate_batch(on_device, queries, batch).await?;
            let input = QueryInput { buffer: input.buffer(), count: batch.len(), doubles: bits_of(batch).1 };
            let results = gpu.with_error_scope("results", || Storage::new(gpu, "results", batch.len())).await?;
            on_device.interpolate(self.mesh, input, &answers, values.buffer(), &results).await?;
            found.append(&mut self.mesh.readback().read(gpu, &results, 0, batch.len()).await?);
        }
        Ok(found)
    }

    /// Returns where each of the points in a buffer lies, in a buffer. Blocks the thread.
    ///
    /// `queries` is an array of `f32` on the mesh's device, `D` per query and nothing else, of the
    /// usages [`STORAGE`](wgpu::BufferUsages::STORAGE) and
    /// [`COPY_SRC`](wgpu::BufferUsages::COPY_SRC). Commands that write it have to be submitted
    /// before. Each answer is an `i32`: the simplex that contains the query; or, for one outside of
    /// the hull, `~(4 * simplex + facet)`; or the lowest number, if there are no simplices.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceLocator, Error, Triangulator, wgpu};
    ///
    /// # fn locate(device: &wgpu::Device, queue: wgpu::Queue) -> Result<wgpu::Buffer, Error> {
    /// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f32]];
    /// let mesh = Triangulator::from_device(device.clone(), queue).device()?.delaunay3d(&points)?;
    /// let queries = device.create_buffer(&wgpu::BufferDescriptor {
    ///     label: None,
    ///     size: 12,
    ///     usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    ///     mapped_at_creation: false,
    /// });
    /// DeviceLocator::new(&mesh, &points)?.locate_buffer(&queries)
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`locate_many`](Self::locate_many), [`Error::NotWholePoints`], and
    /// [`Error::Gpu`] for a buffer of another device or usage.
    pub fn locate_buffer(&self, queries: &wgpu::Buffer) -> Result<wgpu::Buffer, Error> {
        pollster::block_on(self.locate_buffer_async(queries))
    }

    /// Does the same as [`locate_buffer`](Self::locate_buffer) without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`locate_buffer`](Self::locate_buffer).
    pub async fn locate_buffer_async(&self, queries: &wgpu::Buffer) -> Result<wgpu::Buffer, Error> {
        Ok(self.locate_in_buffer(queries).await?.buffer().clone())
    }

    /// Does the same as [`interpolate_many`](Self::interpolate_many) between buffers of the mesh's
    /// device. Blocks the thread.
    ///
    /// `values` is an array of `f32`, one per point, of the usage
    /// [`STORAGE`](wgpu::BufferUsages::STORAGE), `queries` as for
    /// [`locate_buffer`](Self::locate_buffer). The results are an array of `f32`, all NaN if the mesh has no
    /// simplices.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`interpolate_many`](Self::interpolate_many) and of
    /// [`locate_buffer`](Self::locate_buffer).
    pub fn interpolate_buffer(&self, values: &wgpu::Buffer, queries: &wgpu::Buffer) -> Result<wgpu::Buffer, Error> {
        pollster::block_on(self.interpolate_buffer_async(values, queries))
    }

    /// Does the same as [`interpolate_buffer`](Self::interpolate_buffer) without blocking the
    /// thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`interpolate_buffer`](Self::interpolate_buffer).
    pub async fn interpolate_buffer_async(
        &self,
        values: &wgpu::Buffer,
        queries: &wgpu::Buffer,
    ) -> Result<wgpu::Buffer, Error> {
        self.check_values((values.size() / 4) as usize)?;
        let answers = self.locate_in_buffer(queries).await?;
        let (gpu, count) = (self.mesh.gpu(), answers.len());
        let results = gpu.with_error_scope("results", || Storage::for_caller(gpu, "values of queries", count)).await?;
        match &self.on_device {
            Some(on_device) => {
                let queries = QueryInput { buffer: queries, count, doubles: false };
                on_device.interpolate(self.mesh, queries, &answers, values, &results).await?;
            }
            None => results.write(gpu, 0, &vec![f32::NAN; count]),
        }
        Ok(results.buffer().clone())
    }

    /// Returns the circumscribed sphere of each tetrahedron, or the circumscribed circle of each
    /// triangle: the centre relative to the first vertex, and the radius. Blocks the thread.
    ///
    /// Centres are relative because they would lose their precision otherwise, where the points are
    /// far from the origin. However flat a simplex is, the errors of each coordinate and of the
    /// radius are at most 2⁻¹⁹ times the radius. What exceeds the range of `f32` is infinite, and what
    /// is below its normal numbers may be 0. [`Mesh3::circumcenters`](crate::Mesh3::circumcenters)
    /// has double precision.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceLocator, Outputs, Triangulator};
    ///
    /// let points = [[10.0, 0.0], [16.0, 0.0], [10.0, 8.0f64]];
    /// if let Ok(mesh) = Triangulator::new().device().and_then(|device| device.delaunay2d(&points)) {
    ///     let circles = DeviceLocator::new(&mesh, &points)?.circumspheres()?;
    ///     let first = points[mesh.read(Outputs::SIMPLICES)?.triangles[0][0] as usize];
    ///     let [x, y, radius] = circles[0].map(f64::from);
    ///     assert!((first[0] + x - 13.0).abs() < 1e-5 && (first[1] + y - 4.0).abs() < 1e-5);
    ///     assert!((radius - 5.0).abs() < 1e-5);
    /// }
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::BufferTooLarge`], and the other errors of the device.
    pub fn circumspheres(&self) -> Result<Vec<[f32; N]>, Error> {
        pollster::block_on(self.circumspheres_async())
    }

    /// Does the same as [`circumspheres`](Self::circumspheres) without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`circumspheres`](Self::circumspheres).
    pub async fn circumspheres_async(&self) -> Result<Vec<[f32; N]>, Error> {
        let (spheres, open) = self.spheres_of_device().await?;
        let mut found = self.read_spheres(&spheres).await?;
        if open > 0 {
            self.finish_spheres(&mut found).await?;
        }
        Ok(found)
    }

    /// Returns the circumscribed spheres or circles in a buffer. Blocks the thread.
    ///
    /// It is an array of `f32`: four per tetrahedron (`vec4<f32>`), or three per triangle, as
    /// [`circumspheres`](Self::circumspheres) returns them.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`circumspheres`](Self::circumspheres).
    pub fn circumspheres_buffer(&self) -> Result<wgpu::Buffer, Error> {
        pollster::block_on(self.circumspheres_buffer_async())
    }

    /// Does the same as [`circumspheres_buffer`](Self::circumspheres_buffer) without blocking the
    /// thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`circumspheres`](Self::circumspheres).
    pub async fn circumspheres_buffer_async(&self) -> Result<wgpu::Buffer, Error> {
        let (spheres, open) = self.spheres_of_device().await?;
        if open > 0 {
            let mut found = self.read_spheres(&spheres).await?;
            self.finish_spheres(&mut found).await?;
            spheres.write(self.mesh.gpu(), 0, found.as_flattened());
        }
        Ok(spheres.buffer().clone())
    }

    /// Returns how many queries the host has answered so far, and how many circumscribed spheres it
    /// has computed.
    pub fn host_answers(&self) -> usize {
        self.host_answers.load(Ordering::Relaxed)
    }

    /// Returns the edges, which it finds the first time.
    async fn edges(&self) -> Result<&DeviceEdges, Error> {
        if let Some(edges) = self.edges.get() {
            return Ok(edges);
        }
        let edges = self.mesh.edges_async().await?;
        Ok(self.edges.get_or_init(|| edges))
    }

    fn check_values(&self, values: usize) -> Result<(), Error> {
        let points = self.mesh.point_count();
        if values == points { Ok(()) } else { Err(Error::ValueCount { values, points }) }
    }

    /// Locates a part of the queries of a host. Returns these on the device, and their locations.
    async fn locate_batch(
        &self,
        on_device: &QueryPoints<D>,
        queries: Points<'_, D>,
        batch: Points<'_, D>,
    ) -> Result<(Storage<u32>, Storage<u32>), Error> {
        let (input, answers) = self.upload(batch).await?;
        let on_input = QueryInput { buffer: input.buffer(), count: batch.len(), doubles: bits_of(batch).1 };
        let counts = on_device.locate(self.mesh, on_input, &answers).await?;
        self.finish_on_host(queries, batch, &counts, &answers).await?;
        Ok((input, answers))
    }

    /// Does what the device has left of a batch to the host, and returns whether that was anything.
    /// The indices of errors are those among all `queries`.
    async fn finish_on_host(
        &self,
        queries: Points<'_, D>,
        batch: Points<'_, D>,
        counts: &QueryCounts,
        answers: &Storage<u32>,
    ) -> Result<bool, Error> {
        if counts.not_finite.is_some() {
            queries.validate_by(Threads::All)?;
        }
        if counts.open > 0 {
            self.finish(batch, answers).await?;
        }
        Ok(counts.open > 0)
    }

    /// Uploads queries, and makes room for their answers.
    async fn upload(&self, queries: Points<'_, D>) -> Result<(Storage<u32>, Storage<u32>), Error> {
        let gpu = self.mesh.gpu();
        let create = || {
            let input = Storage::with_contents(gpu, "queries", bits_of(queries).0)?;
            Ok((input, Storage::new(gpu, "answers", queries.len())?))
        };
        gpu.with_error_scope("queries", create).await
    }

    /// Returns the mesh on the host, which is read the first time.
    async fn host_mesh(&self) -> Result<&MeshOf<D>, Error> {
        if let Some(mesh) = self.on_host.get() {
            return Ok(mesh);
        }
        let mesh = self.mesh.read_all().await?;
        Ok(self.on_host.get_or_init(|| mesh))
    }

    /// Returns the locator of the host.
    async fn host_locator(&self) -> Result<Locator<'_, D, N>, Error> {
        Ok(Locator::new(self.host_mesh().await?, self.points)?.exact())
    }

    /// Locates the queries in a buffer.
    async fn locate_in_buffer(&self, queries: &wgpu::Buffer) -> Result<Storage<u32>, Error> {
        let count = count_in::<D>(queries)?;
        let gpu = self.mesh.gpu();
        let answers = gpu.with_error_scope("answers", || Storage::for_caller(gpu, "locations", count)).await?;
        let Some(on_device) = &self.on_device else {
            self.read_queries(queries, count).await?;
            answers.write(gpu, 0, &vec![NOWHERE; count]);
            return Ok(answers);
        };
        let input = QueryInput { buffer: queries, count, doubles: false };
        let counts = on_device.locate(self.mesh, input, &answers).await?;
        if counts.not_finite.is_some() || counts.open > 0 {
            let queries = self.read_queries(queries, count).await?;
            self.finish(Points::F32(&queries), &answers).await?;
        }
        Ok(answers)
    }

    /// Computes the circumscribed spheres, and returns how many are left to the host.
    async fn spheres_of_device(&self) -> Result<(Storage<f32>, usize), Error> {
        let gpu = self.mesh.gpu();
        let create = || Storage::for_caller(gpu, "circumspheres", N * self.mesh.simplex_count());
        let spheres = gpu.with_error_scope("circumspheres", create).await?;
        let open = match &self.on_device {
            Some(on_device) => on_device.circumspheres(self.mesh, &spheres).await?,
            None => 0,
        };
        Ok((spheres, open))
    }

    /// Reads the circumscribed spheres.
    async fn read_spheres(&self, spheres: &Storage<f32>) -> Result<Vec<[f32; N]>, Error> {
        self.mesh.readback().read(self.mesh.gpu(), &spheres.cast(), 0, self.mesh.simplex_count()).await
    }

    /// Computes the circumscribed spheres that the device has left open.
    async fn finish_spheres(&self, spheres: &mut [[f32; N]]) -> Result<(), Error> {
        let mesh = self.host_mesh().await?;
        let mut open = 0;
        for (sphere, corners) in spheres.iter_mut().zip(mesh.simplices()) {
            if sphere[D].to_bits() == OPEN_RADIUS {
                let (center, radius) = geometry::circumsphere(&corners.map(|v| self.points.get(v as usize)));
                for (to, x) in sphere.iter_mut().zip(center.into_iter().chain([radius])) {
                    *to = x as f32;
                }
                open += 1;
            }
        }
        self.host_answers.fetch_add(open, Ordering::Relaxed);
        Ok(())
    }

    /// Reads queries, and checks that they are finite.
    async fn read_queries(&self, queries: &wgpu::Buffer, count: usize) -> Result<Vec<[f32; D]>, Error> {
        let mut array = vec![[0.0; D]; count];
        let target: &mut [u8] = bytemuck::cast_slice_mut(&mut array);
        self.mesh.readback().read_into(self.mesh.gpu(), vec![(queries, target)]).await?;
        Points::F32(&array).validate_by(Threads::All)?;
        Ok(array)
    }

    /// Answers the queries that the device has left open.
    async fn finish(&self, queries: Points<'_, D>, answers: &Storage<u32>) -> Result<(), Error> {
        let gpu = self.mesh.gpu();
        let mut words: Vec<u32> = self.mesh.readback().read(gpu, answers, 0, queries.len()).await?;
        let (open, open_queries) = open_among(queries, &words);
        let locations = self.host_locator().await?.locate_many(Points::F64(&open_queries))?;
        for (&i, location) in open.iter().zip(locations) {
            words[i] = word_of(location) as u32;
        }
        answers.write(gpu, 0, &words);
        self.host_answers.fetch_add(open.len(), Ordering::Relaxed);
        Ok(())
    }
}

/// Returns the numbers and the coordinates of the queries that the device has left open.
fn open_among<const D: usize>(queries: Points<'_, D>, words: &[u32]) -> (Vec<usize>, Vec<[f64; D]>) {
    let open = words.iter().enumerate().filter(|&(_, &word)| word == OPEN);
    open.map(|(i, _)| (i, queries.get(i))).unzip()
}

/// Returns the number of queries in a buffer.
fn count_in<const D: usize>(queries: &wgpu::Buffer) -> Result<usize, Error> {
    let point_bytes = (D * size_of::<f32>()) as u64;
    if !queries.size().is_multiple_of(point_bytes) {
        return Err(Error::NotWholePoints { length: (queries.size() / 4) as usize, dimension: D });
    }
    Ok((queries.size() / point_bytes) as usize)
}
