//! Checks of every mesh, so that no device hands out a wrong one without anybody's notice.
//!
//! * `mesh_sum`, at the end of Phase 1, and `outputs_sum`, for the arrays of a 3D mesh that stays on the device, add up
//!   a hash of each facet with either sign from either side. The sum is 0 if neighbours are mutual, see the same three
//!   vertices, and are oriented alike, so that no simplex is missing, turned over or wrong.
//! * The numbers of points, simplices and facets of the hull have to fit each other.
//! * The host evaluates exactly whether 256 simplices are positively oriented and locally Delaunay.
//!
//! What the device counts comes with a readback that there is anyway.

use bytemuck::{Pod, Zeroable};

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Kernel, Recorder, Storage,
        device_mesh::DeviceArrays,
        dim::Dim,
        host::{Answer, Host, Report, Request, Side},
        message::message,
        shader::{self, assert_layout, constants::common},
    },
    index::NONE,
    input::lattice::Width,
    options::Winding,
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    stats::Phase,
};

/// The most simplices that the host looks at.
const SAMPLES: usize = common::CHECK_SAMPLES as usize;
/// The samples that a thread looks at.
const GRAIN: usize = SAMPLES / 8;
/// The words before them.
const WORDS: usize = common::CHECK_WORDS as usize;
/// The most workgroups: each ends with atomic additions to the same words.
const MAX_WORKGROUPS: u32 = 1 << 10;

/// What kernels have to know of the arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct CheckParams {
    count: u32,
    stride: u32,
    points: u32,
    hull: u32,
}
assert_layout!(CheckParams);

/// Returns the distance of the samples among so many simplices.
fn stride(simplices: usize) -> usize {
    simplices.div_ceil(SAMPLES).max(1)
}

/// The kernels that check the arrays of a mesh.
#[derive(Debug)]
pub(crate) struct MeshCheck {
    samples: Kernel,
    sum: Option<Kernel>,
}

impl MeshCheck {
    /// Creates the kernels.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        let samples = compiler.kernel(Dimension::<D>::SHADERS.get("mesh_samples"), Width::Narrow);
        let sum = (D == 3).then(|| compiler.kernel(shader::D3.get("outputs_sum"), Width::Narrow));
        MeshCheck { samples, sum }
    }

    /// Records the check of the arrays of a mesh, in 2D without its hull. Returns what is to be read for [`samples3`] or
    /// [`samples2`].
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub(crate) fn record<const D: usize>(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        arrays: &DeviceArrays,
    ) -> Result<Storage<u32>, Error> {
        let (count, points, hull) =
            (arrays.simplices.len() / (D + 1), arrays.vertex_simplices.len(), arrays.hull.len() / 3);
        let params = [count, stride(count), points, hull].map(|n| n as u32);
        let params = Storage::with_contents(gpu, "parameters of the check", &params)?.cast::<CheckParams>();
        let checked = Storage::new(gpu, "check", WORDS + count.div_ceil(stride(count)) * 2 * (D + 1))?;
        let mut buffers = vec![("check_params", params.buffer()), ("checked", checked.buffer())];
        let seen = Storage::<u32>::new(gpu, "vertices of the hull", if D == 3 { points.div_ceil(32) } else { 0 })?;
        if let Some(kernel) = &self.sum {
            buffers.extend([
                ("out_tetrahedra", arrays.simplices.buffer()),
                ("out_neighbors", arrays.neighbors.buffer()),
                ("out_hull", arrays.hull.buffer()),
                ("seen", seen.buffer()),
            ]);
            recorder.dispatch(kernel, &kernel.bind(&buffers), gpu.workgroups(count.max(hull)).min(MAX_WORKGROUPS));
        }
        buffers.extend([
            ("corners", arrays.simplices.buffer()),
            ("across", arrays.neighbors.buffer()),
            ("vertex_simplices", arrays.vertex_simplices.buffer()),
        ]);
        let workgroups = gpu.workgroups(points).min(MAX_WORKGROUPS);
        recorder.dispatch(&self.samples, &self.samples.bind(&buffers), workgroups);
        Ok(checked)
    }
}

/// What is wrong with what the device has counted.
const UNFIT_NEIGHBORS: &str = "neighbours of the mesh do not fit each other";
const UNFIT_COUNTS: &str = "the mesh lacks simplices, vertices, or facets of its hull";

/// Returns the samples in the words that the device has written for a 3D mesh with so many vertices and facets of the
/// hull, or what is wrong with it.
pub(crate) fn samples3(mut words: Vec<u32>, vertices: usize, hull: usize) -> Result<Samples, &'static str> {
    let [sum, outside, on_hull, with_simplex] = counts(&words);
    // Euler's relation of the hull. That of the mesh would take its edges.
    if (outside, on_hull, with_simplex) != (hull, hull / 2 + 2, vertices) {
        return Err(UNFIT_COUNTS);
    }
    if sum != 0 {
        return Err(UNFIT_NEIGHBORS);
    }
    words.drain(..WORDS);
    Ok(Samples { words })
}

/// Returns the samples in the words that the device has written for a 2D mesh with so many vertices, or what is wrong
/// with it.
pub(crate) fn samples2(mut words: Vec<u32>, vertices: usize) -> Result<Samples, &'static str> {
    if counts(&words)[common::CHECK_VERTICES as usize] != vertices {
        return Err(UNFIT_COUNTS);
    }
    words.drain(..WORDS);
    Ok(Samples { words })
}

/// Returns the words before the samples.
fn counts(words: &[u32]) -> [usize; WORDS] {
    std::array::from_fn(|i| words.get(i).map_or(usize::MAX, |&word| word as usize))
}

/// Returns what is wrong with what the device has added up for the mesh at the end of Phase 1, which has so many
/// vertices, if these were counted.
pub(crate) fn sum_of_phase1([sum, with_simplex]: [u32; 2], vertices: Option<u32>) -> Result<(), &'static str> {
    match vertices {
        Some(vertices) if vertices != with_simplex => Err(UNFIT_COUNTS),
        _ if sum != 0 => Err(UNFIT_NEIGHBORS),
        _ => Ok(()),
    }
}

/// Checks Euler's relation for a 2D mesh.
pub(crate) fn euler2(vertices: usize, triangles: usize, hull: usize) -> Result<(), &'static str> {
    if 2 * vertices == triangles + hull + 2 { Ok(()) } else { Err(UNFIT_COUNTS) }
}

/// Returns how many points are vertices.
pub(crate) fn count_vertices(duplicate_of: &[u32]) -> usize {
    let of_ranges = parallel::map_ranges(Threads::All, duplicate_of.len(), |range| {
        duplicate_of[range].iter().filter(|&&v| v == NONE).count()
    });
    of_ranges.into_iter().sum()
}

/// Has the host look at samples of a mesh.
///
/// # Errors
///
/// Returns [`Error::WrongResults`] if they are wrong, or if there are none because something else is; and the errors of
/// [`Host::ask`].
pub(crate) async fn check<const D: usize>(
    host: &mut impl Host<D>,
    gpu: &Gpu,
    samples: Result<Samples, &'static str>,
) -> Result<(), Error>
where
    Dimension<D>: Answer<D>,
{
    let samples = samples.map_err(|what| gpu.wrong(what))?;
    let is_delaunay = host.ask(samples).await?;
    if is_delaunay { Ok(()) } else { Err(gpu.wrong("a simplex of the mesh is not Delaunay")) }
}

/// Returns samples of a mesh in memory.
pub(crate) fn samples_of<const D: usize>(simplices: &[u32], neighbors: &[u32]) -> Samples {
    let corners = |t: usize| simplices.get((D + 1) * t..(D + 1) * (t + 1)).unwrap_or_default();
    let sum = |t: usize| corners(t).iter().fold(0, |sum: u32, &v| sum.wrapping_add(v));
    let count = simplices.len() / (D + 1);
    let mut words = Vec::with_capacity(SAMPLES * 2 * (D + 1));
    for t in (0..count).step_by(stride(count)) {
        words.extend_from_slice(corners(t));
        words.extend((0..=D).map(|k| match neighbors[(D + 1) * t + k] {
            NONE => NONE,
            other => {
                let (other, lacking) = if D == 2 { (other / 3, (k + 2) % 3) } else { (other, k) };
                sum(other as usize).wrapping_sub(sum(t)).wrapping_add(corners(t)[lacking])
            }
        }));
    }
    Samples { words }
}

/// Asks whether these simplices are positively oriented and locally Delaunay: the corners of each, and those beyond its
/// facets.
#[derive(Debug)]
pub(crate) struct Samples {
    words: Vec<u32>,
}
message!(Samples { words });

impl<const D: usize> Request<D> for Samples
where
    Dimension<D>: Answer<D>,
{
    type Answer = bool;

    const KIND: u32 = 7;
    const PHASE: Phase = Phase::Finish;

    fn answer(self, side: &mut Side<'_, D>, _report: Report<'_>) -> Result<bool, Error> {
        let (points, options, lattice, _) = side.parts();
        let is_vertex = |v: &u32| (*v as usize) < points.len();
        let is_delaunay = |vertices: &PredicateContext<'_, D>, sample: &[u32]| {
            let (corners, apexes) = sample.split_at(sample.len().min(D + 1));
            let mut positive = corners.to_vec();
            if D == 2 && options.winding == Winding::Clockwise {
                positive.swap(1, 2);
            }
            let fits = |&apex: &u32| apex == NONE || is_vertex(&apex) && !corners.contains(&apex);
            let differ = (1..corners.len()).all(|k| !corners[..k].contains(&corners[k]));
            corners.iter().all(is_vertex)
                && differ
                && apexes.iter().all(fits)
                && Dimension::<D>::is_delaunay(vertices, &positive, apexes)
        };
        let samples: Vec<&[u32]> = self.words.chunks(2 * (D + 1)).collect();
        let parts = parallel::map_grains(Threads::All, samples.len(), GRAIN, |range| {
            let vertices = PredicateContext::of_input(points, lattice);
            samples[range].iter().all(|sample| is_delaunay(&vertices, sample))
        });
        Ok(!parts.contains(&false))
    }
}
