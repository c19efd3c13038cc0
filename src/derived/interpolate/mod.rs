//! Interpolation of values at the vertices.

mod cavity;
mod flat;
mod gradients;
mod hull;
mod measures;
mod natural;
mod numeric;
mod options;
mod outside;
mod smooth;
mod table;

pub use measures::StolenMeasures;
pub use options::{Duplicates, Interpolation, Outside};
pub use table::{Grid, WeightTable};

use super::{
    Locator,
    border::{Around, nearest_place},
    flat::{Flat, Shape},
    locate::{Beyond, Place},
    queries::map_along_curve,
};
use crate::{
    error::Error,
    geometry::{Euclidean, barycentric, facet},
    input::points::Points,
};
use natural::Scratch;
use std::{borrow::Cow, sync::OnceLock};

/// Interpolates values that are given at the points of a mesh.
///
/// All methods reproduce linear functions, within an error of 10⁻¹⁰ times the largest value, and
/// the value of a vertex at the vertex. Outside the hull, the value is NaN unless
/// [`outside`](Self::outside) says otherwise. On the hull's boundary, where the point's Voronoi cell
/// would be unbounded, the weights are the limits from inside, which depend only on the vertices in the
/// same plane or on the same line. Nearer to it than about 10⁻¹⁸ times the distances of the
/// vertices, but not on it, interpolation is linear. A query that is outside by less than the
/// [tolerance](Locator) is moved inside, by no more than that; where the hull is thinner,
/// interpolation is linear within the facet.
///
/// In a mesh with [constraints](crate::Triangulator::constrained2d), no value crosses a constrained edge: the natural
/// neighbours of a place are those that it can see, and on the edge the values are linear between its ends.
///
/// Linear, Laplace and Sibson interpolation of the same values; those that are
/// [smooth](Interpolation::is_smooth) also take up the gradients at the vertices:
///
#[cfg_attr(doc, doc = concat!("<div>\n", include_str!("../../../docs/answers/interpolate.svg"), "</div>"))]
///
/// # Examples
///
/// ```
/// use gdel::{Interpolation, Interpolator, Locator};
///
/// let points: Vec<[f64; 3]> = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect();
/// let values: Vec<f64> = points.iter().map(|[x, y, z]| x + 2.0 * y - z).collect();
/// let mesh = gdel::delaunay3d(&points)?;
/// let locator = Locator::new(&mesh, &points)?;
/// let interpolator = Interpolator::new(&locator, &values)?;
///
/// let queries = [[1.25, 2.5, 3.75], [4.0, 4.0, 4.0], [9.5, 0.0, 0.0f32]];
/// let found = interpolator.interpolate_many(Interpolation::Sibson, &queries)?;
/// assert_eq!(found.outside, 1);
/// let found = found.values;
/// assert!((found[0] - 2.5).abs() < 1e-12);
/// assert_eq!(found[1], 8.0);
/// assert!(found[2].is_nan());
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct Interpolator<'a, const D: usize = 3, const N: usize = 4> {
    locator: &'a Locator<'a, D, N>,
    values: Cow<'a, [f64]>,
    outside: Outside,
    /// Which triangles count, if not all do.
    inside: Option<&'a [bool]>,
    /// If the points are in a plane of space, locators of their shadows and of themselves within it.
    plane: Option<Box<[Locator<'a, 2, 3>; 2]>>,
    /// The gradients at the points, once they are needed.
    gradients: OnceLock<Cow<'a, [[f64; D]]>>,
}

/// The values at many queries: see [`Interpolator::interpolate_many`].
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Interpolated {
    /// The value at each query.
    pub values: Vec<f64>,
    /// How many queries were outside the hull.
    pub outside: usize,
}

/// Interpolates values that are given at the points of a 2D mesh.
pub type Interpolator2<'a> = Interpolator<'a, 2, 3>;

impl<'a, const D: usize, const N: usize> Interpolator<'a, D, N>
where
    Euclidean: StolenMeasures<D, N>,
{
    /// Creates an interpolator for values at the points of a mesh, one per point. Those of
    /// duplicates are not used, unless [`duplicates`](Self::duplicates) says otherwise.
    ///
    /// # Errors
    ///
    /// [`Error::ValueCount`] if there are not as many values as points, [`Error::WeightedMesh`],
    /// [`Error::OutOfMemory`].
    pub fn new(locator: &'a Locator<'a, D, N>, values: &'a [f64]) -> Result<Self, Error> {
        if !locator.complex.weights.is_empty() {
            return Err(Error::WeightedMesh);
        }
        let points = locator.complex.points().len();
        if values.len() != points {
            return Err(Error::ValueCount { values: values.len(), points });
        }
        let plane = match &locator.flat {
            Some(Flat { shape: Shape::Plane(plane), .. }) => Some(Box::new([
                Locator::<2, 3>::new(&plane.mesh, &plane.shadows)?,
                Locator::<2, 3>::new(&plane.mesh, &plane.points)?,
            ])),
            _ => None,
        };
        let (values, outside) = (Cow::Borrowed(values), Outside::default());
        Ok(Interpolator { locator, values, outside, inside: None, plane, gradients: OnceLock::new() })
    }

    /// Says which value there is outside the hull: by default NaN.
    #[must_use]
    pub fn outside(mut self, outside: Outside) -> Self {
        self.outside = outside;
        self
    }

    /// Says which simplices count, one entry per simplex: the others are outside. For [`Outside::Value`] and
    /// [`Outside::Nearest`] they are like places outside the hull; [`Outside::Linear`] has linear interpolation there.
    ///
    /// # Errors
    ///
    /// [`Error::ValueCount`] if there are not as many entries as simplices.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Constraints, Fill, Interpolation, Interpolator, Locator, Triangulator};
    ///
    /// // A square without its right half.
    /// let points = [[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 4.0], [0.0, 4.0f64]];
    /// let half = Constraints::new().ring(&[0, 1, 4, 5]).fill(Fill::EvenOdd);
    /// let found = Triangulator::new().constrained2d(&points, &half)?;
    /// let locator = Locator::new(&found.mesh, &points)?;
    /// let interpolator = Interpolator::new(&locator, &[0.0, 2.0, 4.0, 4.0, 2.0, 0.0])?.inside(&found.inside)?;
    /// let found = interpolator.interpolate_many(Interpolation::Linear, &[[1.0, 1.0], [2.0, 1.0], [3.0, 1.0f64]])?;
    /// assert_eq!((found.values[..2].to_vec(), found.outside), (vec![1.0, 2.0], 1));
    /// assert!(found.values[2].is_nan());
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn inside(mut self, inside: &'a [bool]) -> Result<Self, Error> {
        let simplices = self.locator.complex.simplices.len();
        if inside.len() != simplices {
            return Err(Error::ValueCount { values: inside.len(), points: simplices });
        }
        self.inside = Some(inside);
        Ok(self)
    }

    /// Says which value a vertex has if there are several points with its coordinates: by default that
    /// of the first one.
    ///
    /// # Errors
    ///
    /// [`Error::DuplicateValues`] if values of equal points differ and that is to be an error. NaN
    /// differs from all but NaN.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Duplicates, Error, Interpolation, Interpolator, Locator};
    ///
    /// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0f64]];
    /// let values = [1.0, 1.0, 1.0, 9.0];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let locator = Locator::new(&mesh, &points)?;
    /// let interpolator = Interpolator::new(&locator, &values)?.duplicates(Duplicates::Mean)?;
    /// assert_eq!(interpolator.interpolate(Interpolation::Linear, [0.0, 0.0])?, 5.0);
    /// let differ = Interpolator::new(&locator, &values)?.duplicates(Duplicates::Error);
    /// assert_eq!(differ.unwrap_err(), Error::DuplicateValues { first: 0, other: 3 });
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn duplicates(mut self, duplicates: Duplicates) -> Result<Self, Error> {
        let complex = &self.locator.complex;
        let pairs = || (0..complex.points().len()).map(|i| (i, complex.representative(i as u32) as usize));
        match duplicates {
            Duplicates::First => {}
            Duplicates::Mean => {
                let mut sums = vec![(0.0, 0u32); complex.points().len()];
                for (i, vertex) in pairs() {
                    let (sum, count) = &mut sums[vertex];
                    *sum += self.values[i];
                    *count += 1;
                }
                let mean = |(i, (sum, count)): (usize, (f64, u32))| match count {
                    0 | 1 => self.values[i],
                    _ => sum / f64::from(count),
                };
                self.values = Cow::Owned(sums.into_iter().enumerate().map(mean).collect());
                self.gradients = OnceLock::new();
            }
            Duplicates::Error => {
                let bits = |i: usize| self.values[i] + 0.0;
                let differs = |&(i, vertex): &(usize, usize)| bits(i).total_cmp(&bits(vertex)).is_ne();
                if let Some((other, first)) = pairs().find(differs) {
                    return Err(Error::DuplicateValues { first, other });
                }
            }
        }
        Ok(self)
    }

    /// Takes the gradients at the points, one per point, instead of finding them: those that another interpolator
    /// of the same values has [found](Self::gradients), or others.
    ///
    /// # Errors
    ///
    /// [`Error::ValueCount`] if there are not as many gradients as points.
    pub fn with_gradients(mut self, gradients: &'a [[f64; D]]) -> Result<Self, Error> {
        let points = self.values.len();
        if gradients.len() != points {
            return Err(Error::ValueCount { values: gradients.len(), points });
        }
        self.gradients = OnceLock::from(Cow::Borrowed(gradients));
        Ok(self)
    }

    /// Returns the interpolated value at a point.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`], or [`Error::BrokenMesh`] as for [`Locator::locate`]; [`Error::BadOption`] for
    /// [`Interpolation::CloughTocher`] in a 3D mesh that has tetrahedra; [`Error::ConstrainedMesh`] for
    /// [smooth](Interpolation::is_smooth) methods in a mesh with constraints.
    pub fn interpolate(&self, method: Interpolation, query: [f64; D]) -> Result<f64, Error> {
        self.check(method)?;
        Points::F64(&[query]).validate()?;
        Ok(self.value_at(method, &self.find(query)?, &mut State::default())?.0)
    }

    /// Returns the interpolated value at each of many points, and how many of them are outside the hull.
    ///
    /// # Errors
    ///
    /// The same as for [`interpolate`](Self::interpolate).
    pub fn interpolate_many<'q>(
        &self,
        method: Interpolation,
        queries: impl Into<Points<'q, D>>,
    ) -> Result<Interpolated, Error> {
        self.check(method)?;
        let queries = queries.into();
        let reach = self.locator.reach(queries);
        let found = map_along_curve(queries, self.locator.key, |run| {
            let mut state = State::default();
            let places = self.locator.places(run, reach)?;
            let query = |(i, &at)| Query { at, reach, place: places.as_ref().map(|places| places[i]) };
            let queries = run.iter().enumerate().map(query);
            queries.map(|query| self.value_at(method, &query, &mut state)).collect()
        })?;
        let outside = found.iter().filter(|(_, is_outside)| *is_outside).count();
        Ok(Interpolated { values: found.into_iter().map(|(value, _)| value).collect(), outside })
    }

    /// Returns the vertices whose values are interpolated at a point, with their weights, which have
    /// the sum 1; `None` where a [constant](Outside::Value) is the value. None is negative, except for
    /// [`Outside::Linear`].
    ///
    /// # Errors
    ///
    /// The same as for [`interpolate`](Self::interpolate), and [`Error::BadOption`] for
    /// [smooth](Interpolation::is_smooth) methods, in which all values have a weight.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Interpolation, Interpolator, Locator};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let locator = Locator::new(&mesh, &points)?;
    /// let interpolator = Interpolator::new(&locator, &[0.0; 3])?;
    /// let mut weights = interpolator.weights(Interpolation::Linear, [1.0, 2.0])?.unwrap();
    /// weights.sort_by_key(|&(vertex, _)| vertex);
    /// assert_eq!(weights, [(0, 0.25), (1, 0.25), (2, 0.5)]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn weights(&self, method: Interpolation, query: [f64; D]) -> Result<Option<Vec<(u32, f64)>>, Error> {
        check_weights(method)?;
        Points::F64(&[query]).validate()?;
        let mut state = State::default();
        self.find_weights(method, &self.find(query)?, &mut state)?;
        Ok((!state.weights.is_empty()).then_some(state.weights))
    }

    /// Finds the place of a query.
    fn find(&self, at: [f64; D]) -> Result<Query<D>, Error> {
        let reach = self.locator.reach(Points::F64(&[]));
        Ok(Query { at, reach, place: self.locator.place(at, reach)? })
    }

    /// Returns the value at a query, and whether it is outside the hull.
    fn value_at(&self, method: Interpolation, query: &Query<D>, state: &mut State<D>) -> Result<(f64, bool), Error> {
        if method.is_smooth() {
            return self.smooth_value(method, query, state);
        }
        let is_outside = self.find_weights(method, query, state)?;
        Ok((self.weighted(&state.weights), is_outside))
    }

    /// Returns the mean of the values with these weights.
    fn weighted(&self, weights: &[(u32, f64)]) -> f64 {
        if weights.is_empty() {
            return self.constant();
        }
        // A weight of 0 does not spread NaN and infinities.
        let terms = weights.iter().filter(|&&(_, weight)| weight != 0.0);
        terms.map(|&(vertex, weight)| weight * self.values[vertex as usize]).sum()
    }

    /// Returns the value where there are no weights.
    fn constant(&self) -> f64 {
        // Without points, there is no constant.
        if let Outside::Value(value) = self.outside { value } else { f64::NAN }
    }

    /// Checks that there is such an interpolation of these points.
    fn check(&self, method: Interpolation) -> Result<(), Error> {
        if method == Interpolation::CloughTocher && D == 3 && !self.locator.complex.simplices.is_empty() {
            return Err(Error::BadOption {
                option: "the interpolation in 3D",
                range: "linear, or one by Laplace or Sibson",
            });
        }
        // Gradients would be those of both sides of a constrained edge.
        if method.is_smooth() { self.locator.complex.check_unconstrained() } else { Ok(()) }
    }

    /// Puts the weights at a query into `state`, none where there is a constant. Returns whether it is
    /// outside the hull.
    fn find_weights(&self, method: Interpolation, query: &Query<D>, state: &mut State<D>) -> Result<bool, Error> {
        state.weights.clear();
        let Some(Place { at, simplex, beyond, on_facet }) = query.place else {
            return self.flat_weights(method, query, state);
        };
        let (at, simplex, on_facet, is_outside) = match self.inside {
            Some(inside) if beyond.is_none() && !inside[simplex] => match self.place_inside(inside, query, simplex)? {
                Some(place) => (place.at, place.simplex, place.on_facet, false),
                None => (at, simplex, on_facet, true),
            },
            _ => (at, simplex, on_facet, false),
        };
        let State { scratch, weights, simplex: found_in } = state;
        *found_in = simplex;
        if is_outside && self.outside != Outside::Linear {
            // The facet does not count.
            self.weights_outside(query.at, (simplex, 0), weights)?;
            return Ok(true);
        }
        let complex = &self.locator.complex;
        let vertices = complex.simplices[simplex];
        if let Some(Beyond { facet: k, near }) = beyond {
            if near {
                let (shares, _) = nearest_place(&facet(&complex.corners(simplex), k), at, self.locator.scale);
                weights.extend(facet(&vertices, k).into_iter().zip(shares));
            } else {
                self.weights_outside(query.at, (simplex, k), weights)?;
            }
            return Ok(!near);
        }
        if on_facet && let Some(vertex) = vertices.into_iter().find(|&v| complex.point(v) == at) {
            weights.push((vertex, 1.0));
            return Ok(is_outside);
        }
        match method {
            _ if is_outside => {}
            Interpolation::Linear => {}
            _ => natural::weights(self.locator, method, at, (simplex, on_facet), scratch, weights),
        }
        // Also where the Voronoi cell of the point is too long, because the hull is too near.
        if weights.is_empty() {
            let shares = barycentric(&complex.corners(simplex), at);
            weights.extend(vertices.into_iter().zip(shares));
        }
        Ok(is_outside)
    }

    /// Returns the place of a query in a simplex that counts, if there is one no farther away than coordinates are
    /// rounded; the query is in simplex `t`, which does not count.
    fn place_inside(&self, inside: &[bool], query: &Query<D>, t: usize) -> Result<Option<Place<D>>, Error> {
        let around = query.reach.map(|reach| Around::new(query.at, reach));
        for at in std::iter::once(query.at).chain(around.iter().flat_map(Around::corners)) {
            let place = self.locator.walk(at, t)?;
            let beside = || self.locator.facets_at(at, place.simplex).into_iter().map(|(t, _)| t);
            let simplex = match place.beyond {
                None if inside[place.simplex] => Some(place.simplex),
                None if place.on_facet => beside().find(|&t| inside[t]),
                _ => None,
            };
            if let Some(simplex) = simplex {
                return Ok(Some(Place { simplex, ..place }));
            }
        }
        Ok(None)
    }
}

/// A query, and where it is.
struct Query<const D: usize> {
    at: [f64; D],
    /// How far from the hull it may be to count as inside.
    reach: Option<[f64; D]>,
    /// `None` if there are no simplices.
    place: Option<Place<D>>,
}

/// Memory that is used again from one point to the next.
struct State<const D: usize> {
    scratch: Scratch<D>,
    weights: Vec<(u32, f64)>,
    /// The simplex that the point is in, if there are any; for points in a plane, the triangle there.
    simplex: usize,
}

impl<const D: usize> Default for State<D> {
    fn default() -> Self {
        State { scratch: Scratch::default(), weights: Vec::new(), simplex: 0 }
    }
}

/// Checks that the weights of a method do not depend on the values.
fn check_weights(method: Interpolation) -> Result<(), Error> {
    if method.is_smooth() {
        return Err(Error::BadOption {
            option: "the interpolation whose weights are asked for",
            range: "linear, or Laplace's or Sibson's",
        });
    }
    Ok(())
}
