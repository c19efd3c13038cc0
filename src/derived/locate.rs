//! Point location by a remembering visibility walk (Devillers, Pion and Teillaud, *Walking in a
//! triangulation*, 2002).

use super::{
    complex::Complex,
    flat::Flat,
    queries::{CurveKey, map_along_curve},
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    input::points::Points,
    mesh::Csr,
    mesh::Mesh,
    predicates::{Sign, filter::unscaled_orientation_bound},
};
use rustc_hash::FxHashSet;
use std::sync::OnceLock;

/// Where a point lies in a mesh.
///
/// # Examples
///
/// ```
/// use gdel::{Location, Locator};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let locator = Locator::new(&mesh, &points)?;
/// assert_eq!(locator.locate([0.25, 0.25])?, Location::Inside(0));
/// match locator.locate([0.25, -1.0])? {
///     Location::Outside { simplex, facet } => assert_eq!(mesh.edge(simplex, facet), [0, 1]),
///     location => panic!("{location:?}"),
/// }
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Location {
    /// The simplex with this index contains the point. If the point lies on a facet, an edge or a
    /// vertex, several simplices do; it is then the one whose vertices come first if they are
    /// sorted.
    Inside(usize),
    /// The point lies outside the convex hull, and beyond this facet of it, from where the point
    /// can be seen. Which facet it is if there are several depends on the order of the mesh's
    /// simplices.
    Outside {
        /// The simplex that has the facet.
        simplex: usize,
        /// The number of the facet or, in 2D, the edge: [`Mesh3::facet`](crate::Mesh3::facet) and
        /// [`Mesh2::edge`](crate::Mesh2::edge) return its vertices.
        facet: usize,
    },
    /// The mesh has no simplices, because its points are flat, and so no inside.
    Nowhere,
}

impl Location {
    /// Returns the simplex that contains the point, if any.
    pub fn simplex(self) -> Option<usize> {
        match self {
            Location::Inside(simplex) => Some(simplex),
            _ => None,
        }
    }
}

/// Locates points in a mesh, and finds the vertices nearest to them.
///
/// Create one for a mesh with its points and use it for many queries: it holds a few places to
/// start from, and after the first search for nearest vertices also the neighbours of each vertex.
/// All answers are exact for all finite `f64` queries, `f32` included. Those for many queries are
/// found by all threads, and are the same as for the queries one by one, if these are as precise.
///
/// Queries on the border of the hull are rounded, and so may be outside by a little. A query that is
/// so near to the hull counts as inside: the box around it meets the hull that reaches along each
/// axis as far as four units in the last place of the largest coordinate of the points there (2⁻⁵⁰
/// of it; 2⁻²¹ if the points or the queries are in single precision). [`exact`](Self::exact) gives
/// that up. Whether the box meets the hull is decided exactly.
///
/// In a mesh of [weighted](crate::Triangulator::regular3d) points, the nearest vertices are those with the least power
/// distance, |x − p|² − *w*, which may be negative. Hidden points are never nearest.
///
#[cfg_attr(doc, doc = concat!("<div>\n", include_str!("../../docs/answers/locate.svg"), "</div>"))]
///
/// # Examples
///
/// ```
/// use gdel::Locator;
///
/// let points: Vec<[f64; 3]> = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect();
/// let mesh = gdel::delaunay3d(&points)?;
/// let locator = Locator::new(&mesh, &points)?;
///
/// let queries = [[4.5, 2.25, 7.75], [0.5, 0.5, -1.0f32]];
/// let [inside, outside] = locator.locate_many(&queries)?[..] else { unreachable!("one location per query") };
/// assert!(mesh.tetrahedra[inside.simplex().unwrap()].iter().all(|&v| points[v as usize][0] >= 4.0));
/// assert_eq!(outside.simplex(), None);
///
/// assert_eq!(locator.nearest([4.4, 2.25, 7.75])?, Some(824));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct Locator<'a, const D: usize = 3, const N: usize = 4> {
    pub(super) complex: Complex<'a, D, N>,
    /// The minimum and the maximum of each axis.
    pub(super) bounds: [[f64; D]; 2],
    /// A bound of the error of orientations with a query within `bounds`.
    orientation_bound: f64,
    /// A power of two that makes the extent of the points neither large nor small.
    pub(super) scale: f64,
    pub(super) key: CurveKey<D>,
    /// Some simplices, in the lower half, by the places of their first vertices along the curve, in
    /// the upper half.
    starts: Vec<u64>,
    /// The neighbours of each vertex, once they have been asked for.
    pub(super) neighbors: OnceLock<Csr>,
    /// The points in their own dimension, if these are fewer.
    pub(super) flat: Option<Flat>,
    /// Whether queries outside the hull count as such, however near they are.
    pub(super) is_exact: bool,
}

/// Locates points in a 2D mesh.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f32]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let locator: gdel::Locator2 = gdel::Locator::new(&mesh, &points)?;
/// assert_eq!(locator.nearest([3.0, 1.0])?, Some(1));
/// # Ok::<(), gdel::Error>(())
/// ```
pub type Locator2<'a> = Locator<'a, 2, 3>;

/// One simplex out of this many is a place to start from.
const START_STRIDE: usize = 64;

impl<'a, const D: usize, const N: usize> Locator<'a, D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Creates a locator for a mesh and its points.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`] if these are not the points of the mesh, [`Error::NotFinite`] if one
    /// of them is not finite, [`Error::BadWeight`] if a weight is not, and [`Error::BrokenMesh`] if the
    /// mesh's arrays contradict each other.
    pub fn new(mesh: &'a impl Mesh<D, N>, points: impl Into<Points<'a, D>>) -> Result<Self, Error> {
        let mut complex = Complex::new(mesh, points.into())?;
        let mut flat = Flat::new(&complex)?;
        if let Some(flat) = &mut flat {
            complex.hide(std::mem::take(&mut flat.hidden));
        }
        Ok(Locator::of(complex, flat))
    }

    /// Creates a locator for a mesh whose points are flat in this way, if they are.
    pub(super) fn of(complex: Complex<'a, D, N>, flat: Option<Flat>) -> Self {
        let bounds = complex.bounds();
        let key = CurveKey::new(bounds);
        let start = |(t, simplex): (usize, &[u32; N])| {
            let place = key.of::<N>(complex.point(simplex[0]));
            u64::from(place) << 32 | t as u64
        };
        let mut starts: Vec<u64> = complex.simplices.iter().enumerate().step_by(START_STRIDE).map(start).collect();
        starts.sort_unstable();
        let orientation_bound = orientation_bound(bounds);
        let scale = vector::scale_of(bounds);
        let neighbors = OnceLock::new();
        Locator { complex, bounds, orientation_bound, scale, key, starts, neighbors, flat, is_exact: false }
    }

    /// Returns the locator without a tolerance: queries outside the hull count as such, however near
    /// they are.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Location, Locator};
    ///
    /// let points = [[0.0, 0.0], [0.3, 0.1], [0.0, 1.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let locator = Locator::new(&mesh, &points)?;
    /// // A tenth of the way from the first point to the second, and outside by 10⁻¹⁸.
    /// let query = [0.03, 0.01];
    /// assert_eq!(locator.locate(query)?, Location::Inside(0));
    /// assert_eq!(locator.exact().locate(query)?.simplex(), None);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[must_use]
    pub fn exact(mut self) -> Self {
        self.is_exact = true;
        self
    }

    /// Returns where a point lies.
    ///
    /// The walk from the nearest place to start from takes some ten steps on average. For many
    /// queries [`locate_many`](Self::locate_many) is faster.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`], or [`Error::BrokenMesh`] if the walk does not end because the mesh is
    /// not the Delaunay, regular or constrained Delaunay triangulation of the points.
    pub fn locate(&self, query: [f64; D]) -> Result<Location, Error> {
        Points::F64(&[query]).validate()?;
        let reach = self.reach(Points::F64(&[]));
        Ok(self.place(query, reach)?.map_or(Location::Nowhere, |place| self.name(place)))
    }

    /// Returns where each of many points lies.
    ///
    /// # Errors
    ///
    /// The same as for [`locate`](Self::locate).
    pub fn locate_many<'q>(&self, queries: impl Into<Points<'q, D>>) -> Result<Vec<Location>, Error> {
        let queries = queries.into();
        let reach = self.reach(queries);
        map_along_curve(queries, self.key, |run| match self.places(run, reach)? {
            Some(places) => Ok(places.into_iter().map(|place| self.name(place)).collect()),
            None => Ok(vec![Location::Nowhere; run.len()]),
        })
    }

    /// Returns the place of a query; `None` if there are no simplices.
    pub(super) fn place(&self, query: [f64; D], reach: Option<[f64; D]>) -> Result<Option<Place<D>>, Error> {
        let Some(start) = self.start(query) else { return Ok(None) };
        let place = self.walk(query, start)?;
        if place.beyond.is_some() { self.place_outside(query, reach).map(Some) } else { Ok(Some(place)) }
    }

    /// Returns the places of queries of which consecutive ones are near each other; `None` if there
    /// are no simplices.
    ///
    /// Each step of a walk waits for memory whose address the step before has read. Several walks
    /// take turns, so that they wait at the same time.
    pub(super) fn places(&self, queries: &[[f64; D]], reach: Option<[f64; D]>) -> Result<Option<Vec<Place<D>>>, Error> {
        if self.complex.is_constrained() {
            return queries.iter().map(|&query| self.place(query, reach)).collect();
        }
        let mut places = vec![Place { at: [0.0; D], simplex: 0, beyond: None, on_facet: false }; queries.len()];
        let mut walks = Vec::with_capacity(WALKS);
        let share = queries.len().div_ceil(WALKS).max(1);
        for (w, part) in queries.chunks(share).enumerate() {
            let Some(start) = self.start(part[0]) else { return Ok(None) };
            let (step, end) = (self.first_step(part[0], start), w * share + part.len());
            walks.push((w * share, end, step, self.complex.row(start)));
        }
        let mut corners = [[[0.0; D]; N]; WALKS];
        while !walks.is_empty() {
            for (.., step, row) in &mut walks {
                *row = self.complex.row(step.simplex);
            }
            for ((.., row), corners) in walks.iter().zip(&mut corners) {
                *corners = self.complex.corners_of(&row.0);
            }
            let mut w = 0;
            // Walks that end are removed.
            for corners in corners.iter().take(walks.len()) {
                let (at, end, step, (_, neighbors)) = &mut walks[w];
                let Some(place) = self.take(step, corners, neighbors)? else {
                    w += 1;
                    continue;
                };
                let is_outside = place.beyond.is_some();
                places[*at] = if is_outside { self.place_outside(step.query, reach)? } else { place };
                *at += 1;
                if at < end {
                    *step = self.first_step(queries[*at], place.simplex);
                    w += 1;
                } else {
                    walks.remove(w);
                }
            }
        }
        Ok(Some(places))
    }

    /// Returns the public form of a place.
    fn name(&self, place: Place<D>) -> Location {
        match place.beyond {
            None | Some(Beyond { near: true, .. }) => Location::Inside(place.simplex),
            Some(Beyond { facet, .. }) => {
                Location::Outside { simplex: place.simplex, facet: <Euclidean as Geometry<D, N>>::FACET_NUMBERS[facet] }
            }
        }
    }

    /// Returns a simplex that is probably near a point.
    pub(super) fn start(&self, query: [f64; D]) -> Option<usize> {
        let place = u64::from(self.key.of::<N>(query)) << 32;
        let after = self.starts.partition_point(|&start| start < place);
        let start = self.starts.get(after).or(self.starts.last())?;
        Some(*start as u32 as usize)
    }

    /// Returns a bound of the error of orientations with this query.
    #[inline(always)]
    fn bound_with(&self, query: [f64; D]) -> f64 {
        let [low, high] = self.bounds;
        let mut is_within = true;
        for axis in 0..D {
            is_within &= low[axis] <= query[axis] && query[axis] <= high[axis];
        }
        if is_within {
            return self.orientation_bound;
        }
        let extended = |corner: [f64; D], f: fn(f64, f64) -> f64| std::array::from_fn(|a| f(corner[a], query[a]));
        orientation_bound::<D>([extended(low, f64::min), extended(high, f64::max)])
    }

    /// Walks from a simplex to the place of a query.
    pub(super) fn walk(&self, query: [f64; D], start: usize) -> Result<Place<D>, Error> {
        if self.complex.is_constrained() {
            return self.walk_straight(query, start);
        }
        let mut step = self.first_step(query, start);
        loop {
            let (simplex, neighbors) = self.complex.row(step.simplex);
            if let Some(place) = self.take(&mut step, &self.complex.corners_of(&simplex), &neighbors)? {
                return Ok(place);
            }
        }
    }

    /// Returns the place of a query outside the convex hull.
    ///
    /// Which facet sees it depends on the way. This one depends on exact signs alone: from the
    /// nearest place to start from, it crosses the first facet that separates a simplex from the
    /// query. Kernels walk the same way (`shaders/common/query_walk.wgsl`).
    #[inline(never)]
    fn place_outside(&self, query: [f64; D], reach: Option<[f64; D]>) -> Result<Place<D>, Error> {
        let start = self.start(query).expect("a query is outside only if there are simplices");
        if self.complex.is_constrained() {
            let place = self.walk_straight(query, start)?;
            let (Some(reach), Some(beyond)) = (reach, place.beyond) else { return Ok(place) };
            return self.place_near(query, (place.simplex, beyond.facet), reach);
        }
        let mut step = self.first_step(query, start);
        loop {
            let (simplex, neighbors) = self.complex.row(step.simplex);
            let corners = self.complex.corners_of(&simplex);
            let rows = vector::relative(&corners, query);
            let separates = |&k: &usize| neighbors[k] != step.before && side(step.bound, &corners, &rows, k, query) < 0;
            let Some(k) = (0..N).find(separates) else { return Err(ENDLESS) };
            if let Some(place) = self.cross(&mut step, k, neighbors[k])? {
                return reach.map_or(Ok(place), |reach| self.place_near(query, (place.simplex, k), reach));
            }
        }
    }

    /// Continues a walk across facet `k`, or returns that it ends there, outside the hull.
    #[inline(always)]
    fn cross(&self, step: &mut Step<D>, k: usize, across: u32) -> Result<Option<Place<D>>, Error> {
        let &mut Step { query, simplex, left, .. } = step;
        if across == NONE {
            let beyond = Some(Beyond { facet: k, near: false });
            return Ok(Some(Place { at: query, simplex, beyond, on_facet: false }));
        }
        if left == 0 {
            return Err(ENDLESS);
        }
        *step = Step { simplex: across as usize, before: simplex as u32, left: left - 1, ..*step };
        Ok(None)
    }

    /// Returns the beginning of the walk from a simplex to a query.
    fn first_step(&self, query: [f64; D], start: usize) -> Step<D> {
        Step {
            query,
            bound: self.bound_with(query),
            simplex: start,
            before: NO_SIMPLEX,
            left: self.complex.simplices.len(),
        }
    }

    /// Takes a step of a walk, from a simplex with these corners and neighbours, or returns where
    /// the walk has ended.
    ///
    /// The walk crosses a facet that separates the current simplex from the query, about the one that
    /// spans the largest simplex with it: that takes fewer steps than the first one, and a branch
    /// less that nothing could predict. With every step the power distance of the query to the
    /// circumsphere decreases, perturbed as the triangulation's ties are, so it ends.
    #[inline(always)]
    fn take(
        &self,
        step: &mut Step<D>,
        corners: &[[f64; D]; N],
        neighbors: &[u32; N],
    ) -> Result<Option<Place<D>>, Error> {
        let &mut Step { query, bound, simplex, before, .. } = step;
        let determinants = Euclidean::facet_determinants(&vector::relative(corners, query));
        let (mut exit, mut least, mut is_open) = (None, -bound, false);
        for k in 0..N {
            let is_new = neighbors[k] != before;
            // NaN is neither less than one bound nor greater than the other.
            let is_less = is_new & (determinants[k] < least);
            least = if is_less { determinants[k] } else { least };
            exit = if is_less { Some(k) } else { exit };
            let is_inside = determinants[k] > bound;
            is_open |= is_new & !is_inside;
        }
        let mut on_facet = false;
        if exit.is_none() && is_open {
            (exit, on_facet) = self.exact_exit(query, corners, |k| neighbors[k] != before);
        }
        if let Some(k) = exit {
            return self.cross(step, k, neighbors[k]);
        }
        Ok(Some(self.inside(query, simplex, on_facet)))
    }

    /// Returns the place of a query that a simplex contains.
    #[inline(always)]
    pub(super) fn inside(&self, query: [f64; D], simplex: usize, on_facet: bool) -> Place<D> {
        let simplex = if on_facet { self.first_around(query, simplex) } else { simplex };
        Place { at: query, simplex, beyond: None, on_facet }
    }

    /// Returns the first of some facets that separates a simplex with these corners from a query,
    /// and whether the query is on one before it, exactly.
    #[inline(never)]
    fn exact_exit(
        &self,
        query: [f64; D],
        corners: &[[f64; D]; N],
        is_asked: impl Fn(usize) -> bool,
    ) -> (Option<usize>, bool) {
        let mut on_facet = false;
        for k in (0..N).filter(|&k| is_asked(k)) {
            match Euclidean::side(&facet(corners, k), query) {
                1 => {}
                0 => on_facet = true,
                _ => return (Some(k), on_facet),
            }
        }
        (None, on_facet)
    }

    /// Returns the facets that contain a query, which simplex `t` contains, as (simplex, opposite
    /// vertex): all facets of the hull, and those between simplices from both sides.
    pub(super) fn facets_at(&self, query: [f64; D], t: usize) -> Vec<(usize, usize)> {
        let bound = self.bound_with(query);
        let mut facets = Vec::new();
        let mut around = vec![t];
        let mut seen = FxHashSet::from_iter([t]);
        while let Some(t) = around.pop() {
            let corners = self.complex.corners(t);
            let rows = vector::relative(&corners, query);
            for k in 0..N {
                if side(bound, &corners, &rows, k, query) == 0 {
                    facets.push((t, k));
                    around.extend(self.complex.across(t, k).filter(|&across| seen.insert(across)));
                }
            }
        }
        facets
    }

    /// Returns the facets of the hull and the constrained edges that contain a query, which simplex `t` contains, as
    /// (simplex, opposite vertex).
    pub(super) fn hull_facets_at(&self, query: [f64; D], t: usize) -> Vec<(usize, usize)> {
        let mut facets = self.facets_at(query, t);
        facets.retain(|&(t, k)| self.complex.visible_across(t, k).is_none());
        facets
    }

    /// Returns the simplex with the first vertices, if they are sorted, of those that contain a
    /// query that lies on the boundary of `t`.
    #[inline(never)]
    fn first_around(&self, query: [f64; D], t: usize) -> usize {
        let sorted = |t: usize| {
            let mut vertices = self.complex.simplices[t];
            vertices.sort_unstable();
            vertices
        };
        let around = self.facets_at(query, t).into_iter().map(|(t, _)| t);
        around.min_by_key(|&t| sorted(t)).unwrap_or(t)
    }
}

/// Why a walk does not end.
pub(super) const ENDLESS: Error = Error::BrokenMesh { reason: "a walk over it does not end" };

/// The number of walks that take turns.
const WALKS: usize = 16;

/// No simplex that a walk has come from: neither one of the mesh nor [`NONE`].
const NO_SIMPLEX: u32 = NONE - 1;

/// Where a walk to a query is.
#[derive(Debug, Clone, Copy)]
struct Step<const D: usize> {
    query: [f64; D],
    /// A bound of the error of orientations with the query.
    bound: f64,
    simplex: usize,
    /// The simplex that it has come from.
    before: u32,
    /// The number of steps that it may take.
    left: usize,
}

/// A simplex that contains a point, or one of whose facets sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<const D: usize> {
    /// The point: the query, or a place inside the hull that is so near to it that it stands for it.
    pub(super) at: [f64; D],
    pub(super) simplex: usize,
    /// What a point outside the hull is beyond.
    pub(super) beyond: Option<Beyond>,
    /// Whether a point that is inside lies on a facet of the simplex.
    pub(super) on_facet: bool,
}

/// A facet of the hull that sees a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beyond {
    /// The facet is opposite vertex *k*.
    pub(super) facet: usize,
    /// Whether the point is so near to the facet that it counts as inside.
    pub(super) near: bool,
}

/// Returns a bound of the error of orientations of points within a box.
fn orientation_bound<const D: usize>([low, high]: [[f64; D]; 2]) -> f64 {
    // Rounding is monotone, so no rounded difference of coordinates exceeds the rounded extent.
    unscaled_orientation_bound::<D>(std::array::from_fn(|axis| high[axis] - low[axis]))
}

/// Returns on which side of facet `k` a query is: see [`Geometry::side`]. `rows` are the corners
/// minus the query.
#[inline(always)]
fn side<const D: usize, const N: usize>(
    bound: f64,
    corners: &[[f64; D]; N],
    rows: &[[f64; D]; N],
    k: usize,
    query: [f64; D],
) -> Sign
where
    Euclidean: Geometry<D, N>,
{
    let det = Euclidean::determinant(&facet(rows, k));
    if det.abs() > bound {
        return if det > 0.0 { 1 } else { -1 };
    }
    Euclidean::side(&facet(corners, k), query)
}
