//! Natural neighbours on the boundary of the hull.
//!
//! Towards a facet of the convex hull the Voronoi cell of a point grows beyond all bounds, and all
//! that counts of it is between the vertices in the facet's plane. At height *H* above the plane, a
//! point that is *h* below it has as its cell the places *x* of the plane where 2·H·h ≤ |x − v|² −
//! |x − p|² for all vertices *v* in the plane. So in the limit the volume taken from *v* is the
//! integral of this difference over the area that the point would take from *v* in the plane, and
//! the facet between both is that area times their distance: natural neighbours of the next higher
//! order (Hiyoshi and Sugihara 2000). On an edge of the convex hull only the two vertices beside
//! the point are left.
//!
//! Everything is in twice the precision, because near an edge of the convex hull the areas are
//! long, and nothing is urgent here.

use super::{
    super::{Interpolation, Locator, complex::Complex},
    numeric::{MAX_ERROR, difference, dot, length},
};
use crate::{
    geometry::{
        Euclidean, Geometry, facet, precise_triangle_circumcenter_offset,
        real::{Double, Real},
        vector,
    },
    predicates::{Sign, exact},
};
use rustc_hash::FxHashMap;

/// Appends the weights of the ends of an edge that contains a query.
pub(super) fn linear_on_edge<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    edge: [u32; 2],
    query: [f64; D],
    weights: &mut Vec<(u32, f64)>,
) {
    let [to_a, to_b] = edge.map(|v| vector::norm(vector::minus(complex.point(v), query)));
    let length = to_a + to_b;
    weights.extend([(edge[0], to_b / length), (edge[1], to_a / length)]);
}

/// Appends the weights of the natural neighbours of a query on the facets of the hull that are
/// listed; nothing where an edge of the convex hull is too near for twice the precision.
pub(super) fn weights(
    locator: &Locator<'_, 3, 4>,
    method: Interpolation,
    query: [f64; 3],
    facets: &[(usize, usize)],
    weights: &mut Vec<(u32, f64)>,
) {
    let complex = &locator.complex;
    let Some(&first) = facets.first() else { return };
    // Facets of the hull meet in an edge where they do not share a plane.
    let corners = facet_points(complex, first);
    if let Some(&(t, k)) = facets.iter().find(|&&other| !are_coplanar(corners, facet_points(complex, other))) {
        let other = facet(&complex.simplices[t], k);
        let mut common = facet(&complex.simplices[first.0], first.1).into_iter().filter(|v| other.contains(v));
        if let (Some(a), Some(b)) = (common.next(), common.next()) {
            linear_on_edge(complex, [a, b], query, weights);
        }
        return;
    }
    Cavity::gather(locator, query, first).weights(method, Projection::of(corners), weights);
}

fn facet_points(complex: &Complex<'_, 3, 4>, (t, k): (usize, usize)) -> [[f64; 3]; 3] {
    facet(&complex.simplices[t], k).map(|v| complex.point(v))
}

fn are_coplanar(facet: [[f64; 3]; 3], others: [[f64; 3]; 3]) -> bool {
    others.into_iter().all(|p| Euclidean::side(&facet, p) == 0)
}

/// A projection of a plane along an axis, which keeps the ratios of areas.
#[derive(Debug, Clone, Copy)]
struct Projection {
    axes: [usize; 2],
    /// The orientation of what was counter-clockwise in the plane.
    sign: Sign,
}

impl Projection {
    /// Returns the projection that shrinks the plane of a triangle least, of those that rounding
    /// allows to tell apart.
    fn of([a, b, c]: [[f64; 3]; 3]) -> Self {
        let projections = [[1, 2], [2, 0], [0, 1]].map(|axes| {
            let [a, b, c] = [a, b, c].map(|p| axes.map(|axis| p[axis]));
            let area = Euclidean::determinant(&[vector::minus(b, a), vector::minus(c, a)]).abs();
            (Projection { axes, sign: exact::orient2d(a, b, c) }, area)
        });
        // A triangle is not flat along every axis.
        let usable = projections.iter().filter(|(projection, _)| projection.sign != 0);
        usable.max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or(&projections[0]).0
    }
}

/// The facets of the hull that have a query in their planes and within their circumcircles.
#[derive(Default)]
struct Cavity {
    vertices: Vec<Vertex>,
    edges: Vec<Edge>,
}

struct Vertex {
    index: u32,
    /// Relative to the query.
    position: [Double; 3],
    /// A corner of the area that is taken from this vertex.
    origin: [Double; 3],
}

/// An edge of a facet, and the centres of the facet and of the next one or, around the cavity, of
/// the edge and the query.
struct Edge {
    corners: [u32; 2],
    inside: [Double; 3],
    beyond: [Double; 3],
    is_boundary: bool,
}

impl Cavity {
    /// Gathers the cavity of a query around a facet that contains it.
    fn gather(locator: &Locator<'_, 3, 4>, query: [f64; 3], first: (usize, usize)) -> Self {
        let complex = &locator.complex;
        // Scaled so that no measure overflows.
        let scaled = |p: [f64; 3]| vector::times(locator.scale, p);
        let scaled_query = scaled(query);
        let relative = |p: [f64; 3]| difference::<Double, 3>(scaled(p), scaled_query);
        let center = |corners: [[f64; 3]; 3]| {
            let first = relative(corners[0]);
            let offset = precise_triangle_circumcenter_offset(&corners.map(scaled));
            offset.map_or([Double::infinity(); 3], |offset| std::array::from_fn(|axis| first[axis] + offset[axis]))
        };
        // A facet's circumcircle is what its plane cuts out of the tetrahedron's circumsphere.
        let in_conflict = |(t, k): (usize, usize)| {
            Euclidean::side(&facet_points(complex, (t, k)), query) == 0
                && Euclidean::in_sphere(&complex.corners(t), query) > 0
        };
        let mut conflict = vec![(first, center(facet_points(complex, first)))];
        let mut place = FxHashMap::from_iter([(first, Some(0))]);
        let mut local = FxHashMap::default();
        let mut cavity = Cavity::default();
        let mut next = 0;
        while let Some(&((t, k), inside)) = conflict.get(next) {
            next += 1;
            let [a, b, c] = facet(&complex.simplices[t], k);
            for [from, to, apex] in [[a, b, c], [b, c, a], [c, a, b]] {
                let corners = [from, to].map(|v| {
                    *local.entry(v).or_insert_with(|| {
                        let position = relative(complex.point(v));
                        cavity.vertices.push(Vertex { index: v, position, origin: [Double::infinity(); 3] });
                        cavity.vertices.len() as u32 - 1
                    })
                });
                let other = complex.hull_neighbor((t, k), apex).and_then(|other| {
                    *place.entry(other).or_insert_with(|| {
                        in_conflict(other).then(|| {
                            conflict.push((other, center(facet_points(complex, other))));
                            conflict.len() - 1
                        })
                    })
                });
                match other {
                    // The facet that was found first lists the edge.
                    Some(other) if other >= next => {
                        let beyond = conflict[other].1;
                        cavity.edges.push(Edge { corners, inside, beyond, is_boundary: false });
                    }
                    Some(_) => {}
                    None => {
                        let beyond = center([query, complex.point(from), complex.point(to)]);
                        cavity.edges.push(Edge { corners, inside, beyond, is_boundary: true });
                        // The nearer one of two, as the other one may be far away.
                        for corner in corners {
                            let origin = &mut cavity.vertices[corner as usize].origin;
                            if length(*origin).is_nan() || length(beyond) < length(*origin) {
                                *origin = beyond;
                            }
                        }
                    }
                }
            }
        }
        cavity
    }

    /// Appends the weights of the vertices, unless their errors might be too large.
    fn weights(&self, method: Interpolation, projection: Projection, weights: &mut Vec<(u32, f64)>) {
        let Projection { axes: [x, y], sign } = projection;
        let minus = |p: [Double; 3], q: [Double; 3]| -> [Double; 3] { std::array::from_fn(|axis| p[axis] - q[axis]) };
        let mut measures = vec![Double::from(0); self.vertices.len()];
        let mut magnitude = 0.0;
        for &Edge { corners: [a, b], inside, beyond, is_boundary } in &self.edges {
            for (corner, from, to) in [(a, beyond, inside), (b, inside, beyond)] {
                let Vertex { position: v, origin, .. } = self.vertices[corner as usize];
                let (from, to) = (minus(from, origin), minus(to, origin));
                let area = from[x] * to[y] - from[y] * to[x];
                let height = |p: [Double; 3]| dot(v, minus(v, p)) - dot(v, p);
                let height = match method {
                    Interpolation::Sibson if is_boundary => height(inside),
                    // The centres around the cavity are as near to the query as to the vertices.
                    Interpolation::Sibson => height(inside) + height(beyond),
                    _ => Double::from(1),
                };
                measures[corner as usize] = measures[corner as usize] + area * height;
                magnitude += length(from) * length(to) * height.to_f64().abs();
            }
        }
        let measures: Vec<f64> = measures.into_iter().map(|measure| f64::from(sign) * measure.to_f64()).collect();
        let sum: f64 = measures.iter().sum();
        if magnitude * Double::EPSILON <= sum * MAX_ERROR && sum < f64::MAX && sum > 0.0 {
            let share = |measure: f64| if measure < 0.0 { 0.0 } else { measure / sum };
            weights.extend(self.vertices.iter().zip(measures).map(|(vertex, measure)| (vertex.index, share(measure))));
        }
    }
}
