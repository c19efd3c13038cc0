//! What Phase 1 starts with: the first simplex, and the triangulation of some of the points.

use std::sync::Arc;

use bytemuck::Zeroable;

use crate::cpu::{Grow, Incremental};
use crate::dimension::Dimension;
use crate::error::Error;
use crate::gpu::dim::{Corners, Dim};
use crate::index::NONE;
use crate::input::lattice::{Coordinate, Lattice, Width};
use crate::input::order::{Distinct, Order, insertion_order, mix};
use crate::input::points::Points;
use crate::options::Options;
use crate::parallel::Threads;
use crate::predicates::filter::PredicateContext;

/// The first simplex, and a point inside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StartSimplex<const D: usize>
where
    Dimension<D>: Dim<D>,
{
    /// The vertices, positively oriented: never flat.
    pub first: Corners<D>,
    /// The interior point: strictly inside.
    pub interior_point: [i64; D],
}

impl<const D: usize> StartSimplex<D>
where
    Dimension<D>: Dim<D>,
{
    /// Returns the simplex of these vertices with a point inside it, if it is positively oriented and
    /// the lattice has such a point.
    pub(crate) fn of(width: Width, vertices: &[u32], position: &dyn Fn(usize) -> [i64; D]) -> Option<Self> {
        let corners: Vec<[i64; D]> = vertices.iter().map(|&v| position(v as usize)).collect();
        let interior_point: [i64; D] = std::array::from_fn(|axis| {
            let sum: i128 = corners.iter().map(|q| i128::from(q[axis])).sum();
            (sum / (D as i128 + 1)) as i64
        });
        let is_inside = (0..=D).all(|k| {
            let mut corners = corners.clone();
            corners[k] = interior_point;
            <Dimension<D>>::orient(width, &corners) > 0
        });
        is_inside.then(|| {
            let mut first = Corners::<D>::zeroed();
            first.as_mut().copy_from_slice(vertices);
            StartSimplex { first, interior_point }
        })
    }
}

/// The sample in which a large first simplex is searched: enough points for one that contains most of
/// the input, and so few that the search takes no time.
const SAMPLE: usize = 4096;

/// Returns a first simplex for `count` points of a lattice, as large as a sample of them gives.
///
/// Returns `None` if all points lie in a line (2D) or plane (3D), or if the lattice has no point
/// inside the simplex that was found.
pub fn first_simplex<const D: usize>(
    width: Width,
    count: usize,
    position: impl Fn(usize) -> [i64; D],
) -> Option<StartSimplex<D>>
where
    Dimension<D>: Dim<D>,
{
    let stride = count.div_ceil(SAMPLE).max(1);
    largest(width, count, stride, &position)
        .or_else(|| if stride > 1 { largest(width, count, 1, &position) } else { None })
}

fn largest<const D: usize>(
    width: Width,
    count: usize,
    stride: usize,
    position: &dyn Fn(usize) -> [i64; D],
) -> Option<StartSimplex<D>>
where
    Dimension<D>: Dim<D>,
{
    let sample = || (0..count).step_by(stride);
    // Computing a position takes longer than all that follows.
    let places: Vec<[f64; D]> = sample().map(|i| position(i).map(|x| x as f64)).collect();
    let mut first = Vec::with_capacity(D + 1);
    let mut chosen = Vec::with_capacity(D);
    for _ in 0..=D {
        let measured = sample().zip(&places).map(|(i, &p)| (<Dimension<D>>::spread(&chosen, p), i, p));
        let (_, i, p) = measured.max_by(|(m, ..), (n, ..)| m.total_cmp(n))?;
        first.push(i);
        chosen.push(p);
    }
    let orient = |corners: &[usize]| {
        let positions: Vec<[i64; D]> = corners.iter().map(|&i| position(i)).collect();
        <Dimension<D>>::orient(width, &positions)
    };
    // Where the volume is lost in rounding, any point that is not in a line or plane with the
    // others will do.
    if orient(&first) == 0 {
        first[D] = sample().find(|&i| orient(&[&first[..D], &[i]].concat()) != 0)?;
    }
    if orient(&first) < 0 {
        first.swap(0, 1);
    }
    let vertices: Vec<u32> = first.into_iter().map(|i| i as u32).collect();
    StartSimplex::of(width, &vertices, position)
}

/// The simplices that Phase 1 starts with: the Delaunay triangulation of some of the points, or of
/// the corners of the first simplex.
///
/// The CPU engine makes it while the device orders the points. The first rounds of the device would
/// insert as many points, and take longer.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct StartMesh {
    /// The points, by place in the input, each with one of its simplices.
    pub points: Vec<[u32; 2]>,
    /// The corners of each simplex, by place among `points`, where
    /// [`NONE`](crate::index::NONE) is infinity; and its neighbours, 4·simplex + facet. In
    /// 2D the last of them is 0. All are positively oriented if infinity lies opposite to the
    /// interior point. There are no more of them than the points have slots.
    pub simplices: Vec<[[u32; 4]; 2]>,
}

/// What the CPU engine makes.
type Grown<const D: usize> = <Dimension<D> as Incremental<D>>::Triangulation;

impl StartMesh {
    /// Triangulates `wanted` of the points, evenly spaced in the input, beside the corners of the
    /// first simplex. Where that is no triangulation of their places on the lattice, to which some are
    /// rounded, or where the simplices are too many, the first simplex has to do.
    pub fn new<const D: usize>(
        points: Points<'_, D>,
        lattice: &Lattice<D>,
        start: &StartSimplex<D>,
        wanted: usize,
    ) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        Self::of_sample(points, lattice, start, wanted).unwrap_or_else(|| Self::of_first(start))
    }

    /// Returns the first simplex alone, with those at infinity around it.
    pub fn of_first<const D: usize>(start: &StartSimplex<D>) -> Self
    where
        Dimension<D>: Dim<D>,
    {
        Self::of_triangulation(Grown::<D>::initial(D as u32 + 1), start.first.as_ref().iter().copied())
    }

    /// Returns how many of so many vertices make up a stretch, for which a simplex nearby is looked
    /// up: so many that few stretches have no point of the start.
    pub fn stride(&self, vertices: u32) -> u32 {
        let stretches = (self.points.len() as u32 / 2).max(1);
        vertices.div_ceil(stretches).max(1)
    }

    fn of_sample<const D: usize>(
        points: Points<'_, D>,
        lattice: &Lattice<D>,
        start: &StartSimplex<D>,
        wanted: usize,
    ) -> Option<Self>
    where
        Dimension<D>: Dim<D>,
    {
        let first = start.first.as_ref();
        if wanted <= first.len() {
            return None;
        }
        let wanted = (wanted - first.len()).min(points.len());
        let mut sample: Vec<u32> = first.to_vec();
        // One of each stretch, so that no regularity of the input comes through.
        let place = |k: usize| (k as u64 * points.len() as u64 / wanted as u64) as u32;
        sample.extend((0..wanted).map(|k| {
            let stretch = place(k + 1) - place(k);
            place(k) + (mix(k as u64) % u64::from(stretch)) as u32
        }));
        sample.sort_unstable();
        sample.dedup();
        let Triangulated { triangulation, vertices } = match points {
            Points::F32(p) => triangulate_few(Points::F32(&taken(p, &sample))),
            Points::F64(p) => triangulate_few(Points::F64(&taken(p, &sample))),
        }
        .ok()
        .flatten()?;
        // The device breaks ties by the lowest of the points at one place. Where even a sample shows
        // that there are many such, it would have to undo much of what was triangulated here.
        if vertices.len() < sample.len() {
            return None;
        }
        let mesh = Self::of_triangulation(triangulation, vertices.iter().map(|&i| sample[i as usize]));
        let slots = mesh.points.len() * Dimension::<D>::SLOTS_PER_POINT as usize;
        (mesh.simplices.len() <= slots && mesh.is_on_lattice(points, lattice, start)).then_some(mesh)
    }

    /// Returns whether the simplices are positively oriented on the lattice, to which points may be
    /// rounded. Where none was rounded, flat ones are allowed: the device orients them by its perturbation.
    fn is_on_lattice<const D: usize>(
        &self,
        points: Points<'_, D>,
        lattice: &Lattice<D>,
        start: &StartSimplex<D>,
    ) -> bool
    where
        Dimension<D>: Dim<D>,
    {
        let places = self.points.iter().map(|&[i, _]| lattice.coordinates(points.get(i as usize)));
        let places: Vec<[Coordinate; D]> = places.collect();
        if places.as_flattened().iter().all(|c| c.exact) {
            return true;
        }
        self.simplices.iter().all(|[corners, _]| {
            let place = |&v: &u32| places.get(v as usize).map_or(start.interior_point, |place| place.map(|c| c.value));
            let corners = &corners[..=D];
            let orientation = Dimension::<D>::orient(lattice.width(), &corners.iter().map(place).collect::<Vec<_>>());
            // The interior point takes the place of infinity, which is on the other side.
            if corners.contains(&NONE) { orientation < 0 } else { orientation > 0 }
        })
    }

    fn of_triangulation<const D: usize>(triangulation: impl Grow<D>, points: impl Iterator<Item = u32>) -> Self {
        let simplices = triangulation.into_simplices();
        let mut points: Vec<[u32; 2]> = points.map(|i| [i, 0]).collect();
        for (k, [corners, _]) in (0..).zip(&simplices) {
            if !corners.contains(&NONE) {
                corners[..=D].iter().for_each(|&v| points[v as usize][1] = k);
            }
        }
        StartMesh { points, simplices }
    }
}

/// Returns the items at these places.
fn taken<T: Copy>(items: &[T], places: &[u32]) -> Vec<T> {
    places.iter().map(|&i| items[i as usize]).collect()
}

/// The triangulation of a few points.
struct Triangulated<const D: usize>
where
    Dimension<D>: Incremental<D>,
{
    /// The triangulation.
    triangulation: <Dimension<D> as Incremental<D>>::Triangulation,
    /// The points that are its vertices.
    vertices: Arc<Vec<u32>>,
}

/// Triangulates a few points by the calling thread. Returns `None` if they span fewer dimensions.
///
/// # Errors
///
/// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
fn triangulate_few<const D: usize>(points: Points<'_, D>) -> Result<Option<Triangulated<D>>, Error>
where
    Dimension<D>: Incremental<D>,
{
    let lattice = Lattice::fit_by(Threads::One, points)?;
    let Distinct { mut order, rounds, .. } =
        insertion_order(Threads::One, points, &lattice, Dimension::<D>::CURVE, Order::default());
    if usize::from(Dimension::<D>::spanning_first(points, &mut order)) < D {
        return Ok(None);
    }
    let vertices = PredicateContext::new(points, &lattice, order);
    let triangulation = Dimension::<D>::triangulate(Threads::One, &vertices, &rounds, &Options::default())?;
    Ok(Some(Triangulated { triangulation, vertices: vertices.into_input_indices() }))
}
