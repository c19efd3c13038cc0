//! Queries of a mesh on the device: where points lie in it.
//!
//! 1. The points of the mesh become vertices on a lattice that extends beyond them, so that queries
//!    have a place on it, too.
//! 2. Some simplices are sorted along the Hilbert curve: places for walks to start from.
//! 3. `query_walk` walks to each query as far as the filter decides, and lists where it does not.
//! 4. `query_settle` goes on from there with exact signs.
//!
//! Both kernels walk as [`Locator`](crate::Locator) does, and give the same answers. A query that they
//! leave open ([`OPEN`]), because its sign depends on rounding or it is far away, is answered by the host.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Kernel, Readback, Recorder, Storage,
        device_edges::DeviceEdges,
        device_mesh::DeviceMesh,
        dim::Dim,
        points::bits_of,
        primitives::sort::Sort,
        readback::Pending,
        shader::{assert_layout, constants::common as constants},
        workgroups,
    },
    input::{
        lattice::{Lattice, Width},
        points::Points,
    },
};
use bytemuck::{Pod, Zeroable};

/// The answer for a query that is left to the host.
pub const OPEN: u32 = constants::OPEN;
/// The answer if there are no simplices.
pub const NOWHERE: u32 = constants::NOWHERE;
/// One simplex in so many is a place to start from.
pub const START_STRIDE: usize = constants::START_STRIDE as usize;
/// The bits of the radius of a sphere that is left to the host.
pub const OPEN_RADIUS: u32 = constants::OPEN_RADIUS;

/// The bits of a place along the curve.
const KEY_BITS: u32 = 30;
/// The steps after which a walk is left to the host.
const MAX_STEPS: u32 = 10_000;

/// The parameters of the kernels, and what they count: `not_finite`, `undecided` and `open`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct QueryParams {
    /// The number of queries, or of points.
    pub count: u32,
    /// The lattice's *k*: coordinates are multiplied by 2ᵏ.
    pub exponent: i32,
    /// 1 for `f64` input, 0 for `f32`.
    pub doubles: u32,
    /// Bit *a* is set where the points do not all agree on axis *a*.
    pub varies: u32,
    /// The lowest 32 bits of what is taken off.
    pub origin_low: [u32; 3],
    /// The number of simplices to start from.
    pub starts: u32,
    /// The next 32 bits of what is taken off.
    pub origin_high: [u32; 3],
    /// The bits of a lattice coordinate.
    pub width: u32,
    /// *k* of the curve's cells, for each axis.
    pub cell_exponents: [i32; 3],
    /// The coordinates of a point: 2 or 3.
    pub dimension: u32,
    /// The lowest 32 bits of what is taken off the cells.
    pub cell_origin_low: [u32; 3],
    /// The steps after which a walk is left to the host.
    pub max_steps: u32,
    /// The next 32 bits.
    pub cell_origin_high: [u32; 3],
    /// The first query that is not finite.
    pub not_finite: u32,
    /// The lowest coordinates of queries on the lattice, as integers in their order: low words.
    pub nearest_low: [u32; 3],
    /// Queries that the filter does not decide.
    pub undecided: u32,
    /// High words.
    pub nearest_high: [u32; 3],
    /// Queries that are left to the host.
    pub open: u32,
    /// The highest coordinates.
    pub farthest_low: [u32; 3],
    /// Zero.
    pub unused: u32,
    /// High words.
    pub farthest_high: [u32; 3],
    /// Zero.
    pub padding: u32,
}
assert_layout!(QueryParams);

/// What the device has counted among some queries.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct QueryCounts {
    /// The first one that is not finite.
    pub not_finite: Option<usize>,
    /// Those that the filter did not decide.
    pub undecided: usize,
    /// Those that are left to the host.
    pub open: usize,
}

/// The coordinates of queries on the device.
#[derive(Debug, Clone, Copy)]
pub struct QueryInput<'a> {
    /// The bits, `D` coordinates per query.
    pub buffer: &'a wgpu::Buffer,
    /// The number of queries.
    pub count: usize,
    /// Whether they are of type `f64`.
    pub doubles: bool,
}

/// The points of a mesh on its device, and its places to start from.
#[derive(Debug)]
pub struct QueryPoints<const D: usize> {
    /// The parameters that do not depend on the queries.
    params: QueryParams,
    /// The box within which queries are on the lattice.
    near: [[f64; D]; 2],
    vertices: Storage<i32>,
    starts: Storage<[u32; 2]>,
    walk: Kernel,
    settle: Kernel,
    interpolate: Kernel,
    nearest: Kernel,
    circumspheres: Kernel,
}

impl<const D: usize> QueryPoints<D>
where
    Dimension<D>: Dim<D>,
{
    /// Uploads the points of `mesh`, which has simplices. `bounds` are those of the points, and
    /// `cells` the exponents and the origin of the curve's cells.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`] and [`Gpu::with_error_scope`].
    pub async fn new(
        mesh: &DeviceMesh<D>,
        points: Points<'_, D>,
        bounds: [[f64; D]; 2],
        cells: [(i32, u64); D],
    ) -> Result<Self, Error> {
        let gpu = mesh.gpu();
        let compiler = Compiler::keeping(gpu);
        let kernel = |name| compiler.kernel(Dimension::<D>::SHADERS.get(name), Width::Wide);
        let [vertices, starts, walk, settle, interpolate] =
            ["query_vertices", "query_starts", "query_walk", "query_settle", "query_interpolate"].map(kernel);
        // Compiled when they are used.
        let [nearest, circumspheres] = ["query_nearest", "query_circumspheres"]
            .map(|name| compiler.on_demand(Dimension::<D>::SHADERS.get(name), Width::Wide));
        let sort = Sort::new(&compiler);
        compiler.finish().await?;

        let (lattice, near) = Lattice::with_room(bounds);
        let origin: [u64; 3] =
            std::array::from_fn(|axis| lattice.origin().get(axis).copied().flatten().unwrap_or(0) as u64);
        let cells: [(i32, u64); 3] = std::array::from_fn(|axis| cells.get(axis).copied().unwrap_or_default());
        let params = QueryParams {
            exponent: lattice.exponent(),
            varies: lattice.varies().iter().zip(0..).map(|(&varies, axis)| u32::from(varies) << axis).sum(),
            origin_low: origin.map(|origin| origin as u32),
            starts: mesh.simplex_count().div_ceil(START_STRIDE) as u32,
            origin_high: origin.map(|origin| (origin >> 32) as u32),
            width: Width::Wide.bits(),
            cell_exponents: cells.map(|(exponent, _)| exponent),
            dimension: D as u32,
            cell_origin_low: cells.map(|(_, origin)| origin as u32),
            cell_origin_high: cells.map(|(_, origin)| (origin >> 32) as u32),
            max_steps: MAX_STEPS,
            ..QueryParams::default()
        };
        gpu.with_error_scope("the points of the mesh", || {
            let (words, doubles) = bits_of(points);
            let input = Storage::with_contents(gpu, "points of the mesh", words)?;
            let of_points = QueryParams { count: points.len() as u32, doubles: u32::from(doubles), ..params };
            let of_points = Storage::with_contents(gpu, "point parameters", &[of_points])?;
            let vertex_words = Dimension::<D>::vertex_words(Width::Wide);
            let placed = Storage::new(gpu, "vertices of the mesh", vertex_words * points.len())?;
            let mut pairs = Storage::new(gpu, "places to start from", params.starts as usize)?;
            let mut scratch = Storage::new(gpu, "sort scratch", params.starts as usize)?;
            let buffers = [
                ("params", of_points.buffer()),
                ("input", input.buffer()),
                ("vertices", placed.buffer()),
                ("simplices", mesh.simplices()),
                ("pairs", pairs.buffer()),
            ];
            let bound = [&vertices, &starts].map(|kernel| kernel.bind(&buffers));
            let sorted = sort.bind(gpu, &mut pairs, &mut scratch, KEY_BITS)?;
            let mut recorder = Recorder::new(gpu, None);
            recorder.dispatch(&vertices, &bound[0], gpu.workgroups(points.len()));
            recorder.dispatch(&starts, &bound[1], gpu.workgroups(params.starts as usize));
            sort.record(&mut recorder, &sorted);
            recorder.submit(gpu);
            let (vertices, starts) = (placed, pairs);
            Ok(QueryPoints { params, near, vertices, starts, walk, settle, interpolate, nearest, circumspheres })
        })
        .await
    }

    /// Locates queries in `mesh`. Writes the answers to `answers`: a simplex; for queries outside, the
    /// complement of 4·simplex + the number of its facet on the hull; or [`OPEN`].
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`] and of
    /// [`Readback::receive`](crate::gpu::Readback::receive).
    pub async fn locate(
        &self,
        mesh: &DeviceMesh<D>,
        queries: QueryInput<'_>,
        answers: &Storage<u32>,
    ) -> Result<QueryCounts, Error> {
        Ok(self.begin_locating(mesh, queries, answers, 0).await?.end(mesh.gpu()).await?.0)
    }

    /// Begins to locate queries, and to read the first `read` answers.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`].
    pub async fn begin_locating(
        &self,
        mesh: &DeviceMesh<D>,
        queries: QueryInput<'_>,
        answers: &Storage<u32>,
        read: usize,
    ) -> Result<Locating, Error> {
        let gpu = mesh.gpu();
        let mut readback = mesh.readback();
        gpu.with_error_scope("queries", || {
            let params = Storage::with_contents(gpu, "query parameters", &[self.params_of(queries)])?;
            let undecided = Storage::<u32>::new(gpu, "undecided queries", queries.count)?;
            let buffers = [
                ("params", params.buffer()),
                ("input", queries.buffer),
                ("vertices", self.vertices.buffer()),
                ("simplices", mesh.simplices()),
                ("neighbors", mesh.neighbors()),
                ("starts", self.starts.buffer()),
                ("answers", answers.buffer()),
                ("undecided", undecided.buffer()),
            ];
            let mut recorder = Recorder::new(gpu, None);
            for kernel in [&self.walk, &self.settle] {
                // One invocation per query on every device: software devices end loops after 65,535
                // steps, counted over all loops of an invocation.
                recorder.dispatch(kernel, &kernel.bind(&buffers), workgroups(queries.count as u32));
            }
            let counts = readback.copy(gpu, recorder.encoder(), &params, 0, 1);
            let answers = (read > 0).then(|| readback.copy(gpu, recorder.encoder(), answers, 0, read));
            Ok(Locating { submission: recorder.submit(gpu), counts, answers, readback })
        })
        .await
    }

    /// Finds the vertex nearest to each query, and writes it or [`OPEN`] to `answers`.
    ///
    /// # Errors
    ///
    /// Those of [`locate`](Self::locate).
    pub async fn nearest(
        &self,
        mesh: &DeviceMesh<D>,
        edges: &DeviceEdges,
        queries: QueryInput<'_>,
        answers: &Storage<u32>,
    ) -> Result<QueryCounts, Error> {
        let gpu = mesh.gpu();
        let mut readback = mesh.readback();
        let (submission, pending) = gpu
            .with_error_scope("queries", || {
                let params = Storage::with_contents(gpu, "query parameters", &[self.params_of(queries)])?;
                let buffers = [
                    ("params", params.buffer()),
                    ("input", queries.buffer),
                    ("vertices", self.vertices.buffer()),
                    ("simplices", mesh.simplices()),
                    ("ring_offsets", edges.neighbor_offsets()),
                    ("starts", self.starts.buffer()),
                    ("ring", edges.neighbors()),
                    ("answers", answers.buffer()),
                ];
                let mut recorder = Recorder::new(gpu, None);
                recorder.dispatch(&self.nearest, &self.nearest.bind(&buffers), workgroups(queries.count as u32));
                let pending = readback.copy(gpu, recorder.encoder(), &params, 0, 1);
                Ok((recorder.submit(gpu), pending))
            })
            .await?;
        Ok(counts_of(&readback.receive(gpu, &submission, pending).await?[0]))
    }

    /// Interpolates `values`, an `f32` per point, linearly at queries that are located in `answers`. Writes
    /// the results to `results`: NaN outside of all simplices.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`].
    pub async fn interpolate(
        &self,
        mesh: &DeviceMesh<D>,
        queries: QueryInput<'_>,
        answers: &Storage<u32>,
        values: &wgpu::Buffer,
        results: &Storage<f32>,
    ) -> Result<(), Error> {
        let gpu = mesh.gpu();
        gpu.with_error_scope("interpolation", || {
            let params = Storage::with_contents(gpu, "query parameters", &[self.params_of(queries)])?;
            let buffers = [
                ("params", params.buffer()),
                ("input", queries.buffer),
                ("vertices", self.vertices.buffer()),
                ("simplices", mesh.simplices()),
                ("answers", answers.buffer()),
                ("values", values),
                ("results", results.buffer()),
            ];
            let mut recorder = Recorder::new(gpu, None);
            recorder.dispatch(&self.interpolate, &self.interpolate.bind(&buffers), gpu.workgroups(queries.count));
            recorder.submit(gpu);
            Ok(())
        })
        .await
    }

    /// Computes the circumcentre of each simplex relative to its first vertex, and the circumradius:
    /// `D` + 1 numbers, of which the last is [`OPEN_RADIUS`] where they are left to the host.
    /// Returns how many are.
    ///
    /// # Errors
    ///
    /// Those of [`locate`](Self::locate).
    pub async fn circumspheres(&self, mesh: &DeviceMesh<D>, results: &Storage<f32>) -> Result<usize, Error> {
        let gpu = mesh.gpu();
        let mut readback = mesh.readback();
        let (submission, pending) = gpu
            .with_error_scope("circumspheres", || {
                let params = QueryParams { count: mesh.simplex_count() as u32, ..self.params };
                let params = Storage::with_contents(gpu, "parameters", &[params])?;
                let buffers = [
                    ("params", params.buffer()),
                    ("vertices", self.vertices.buffer()),
                    ("simplices", mesh.simplices()),
                    ("results", results.buffer()),
                ];
                let mut recorder = Recorder::new(gpu, None);
                let bound = self.circumspheres.bind(&buffers);
                recorder.dispatch(&self.circumspheres, &bound, gpu.workgroups(mesh.simplex_count()));
                let pending = readback.copy(gpu, recorder.encoder(), &params, 0, 1);
                Ok((recorder.submit(gpu), pending))
            })
            .await?;
        Ok(counts_of(&readback.receive(gpu, &submission, pending).await?[0]).open)
    }

    /// Returns the parameters for queries.
    fn params_of(&self, queries: QueryInput<'_>) -> QueryParams {
        let QueryInput { count, doubles, .. } = queries;
        let mut params =
            QueryParams { count: count as u32, doubles: u32::from(doubles), not_finite: u32::MAX, ..self.params };
        let [nearest, farthest] = self.near;
        for axis in 0..D {
            let near = ordered_low(nearest[axis], doubles);
            (params.nearest_low[axis], params.nearest_high[axis]) = (near as u32, (near >> 32) as u32);
            // The largest coordinate that is not above is the negative of the smallest that is not below.
            let far = !ordered_low(-farthest[axis], doubles);
            (params.farthest_low[axis], params.farthest_high[axis]) = (far as u32, (far >> 32) as u32);
        }
        params
    }
}

/// Queries that the device locates.
#[derive(Debug)]
pub struct Locating {
    submission: wgpu::SubmissionIndex,
    counts: Pending<QueryParams>,
    answers: Option<Pending<u32>>,
    readback: Readback,
}

impl Locating {
    /// Waits for the counts, and for the answers that are read.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    pub async fn end(mut self, gpu: &Gpu) -> Result<(QueryCounts, Vec<u32>), Error> {
        let params = self.readback.receive(gpu, &self.submission, self.counts).await?;
        let answers = match self.answers {
            Some(answers) => self.readback.receive(gpu, &self.submission, answers).await?,
            None => Vec::new(),
        };
        Ok((counts_of(&params[0]), answers))
    }
}

/// Returns what the kernels have counted.
fn counts_of(params: &QueryParams) -> QueryCounts {
    let &QueryParams { not_finite, undecided, open, .. } = params;
    let not_finite = (not_finite != u32::MAX).then_some(not_finite as usize);
    QueryCounts { not_finite, undecided: undecided as usize, open: open as usize }
}

/// Returns the rank of the smallest coordinate, of type `f64` or `f32`, that is not below `x`. Ranks are
/// integers in the order of the coordinates, made as the kernels make them: the words of an `f32` are 0
/// and its bits.
fn ordered_low(x: f64, doubles: bool) -> u64 {
    let bits = if doubles {
        x.to_bits()
    } else {
        let nearest = x as f32;
        let low = if f64::from(nearest) < x { nearest.next_up() } else { nearest };
        u64::from(low.to_bits()) << 32
    };
    if bits >> 63 == 0 { bits ^ 1 << 63 } else { !bits }
}
