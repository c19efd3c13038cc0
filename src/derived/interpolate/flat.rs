//! Interpolation between points in a plane, on a line or in one place.

use super::{
    super::{
        border::Around,
        flat::{Flat, Frame, Plane, Shape, in_space},
        locate::Place,
    },
    Interpolation, Interpolator, Outside, Query, State, StolenMeasures, natural,
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, vector},
};
use std::{borrow::Cow, sync::OnceLock};

impl<const D: usize, const N: usize> Interpolator<'_, D, N>
where
    Euclidean: StolenMeasures<D, N>,
{
    /// Appends the weights at a query if there are no simplices, none where there is a constant. Returns
    /// whether the query is outside the hull.
    pub(super) fn flat_weights(
        &self,
        method: Interpolation,
        query: &Query<D>,
        state: &mut State<D>,
    ) -> Result<bool, Error> {
        let Some(Flat { shape, .. }) = &self.locator.flat else { return Ok(true) };
        let around = Around::new(in_space(query.at), query.reach.map_or([0.0; 3], in_space));
        let is_outside = match shape {
            Shape::Line { vertices, axis } => {
                self.line_weights(query.at, &around, (vertices, *axis), &mut state.weights)
            }
            Shape::Plane(plane) => self.plane_weights(method, query, &around, plane, state)?,
        };
        if is_outside && self.outside == Outside::Nearest {
            state.weights.clear();
            state.weights.extend(self.locator.nearest(query.at)?.map(|vertex| (vertex, 1.0)));
        }
        Ok(is_outside)
    }

    /// Does so on a line, where all methods are linear.
    fn line_weights(
        &self,
        query: [f64; D],
        around: &Around<3>,
        (vertices, axis): (&[u32], usize),
        weights: &mut Vec<(u32, f64)>,
    ) -> bool {
        let point = |v: u32| in_space(self.locator.complex.point(v));
        let (first, last) = (point(vertices[0]), point(vertices[vertices.len() - 1]));
        let is_outside = !around.meets(&[first, last, last]);
        if is_outside && self.outside != Outside::Linear {
            return true;
        }
        if let [vertex] = vertices {
            weights.push((*vertex, 1.0));
            return is_outside;
        }
        let query = in_space(query);
        let after = vertices.partition_point(|&v| point(v)[axis] <= query[axis]).clamp(1, vertices.len() - 1);
        let ends = [vertices[after - 1], vertices[after]];
        let [from, to] = ends.map(point);
        if let Some(end) = [from, to].iter().position(|&end| end == query) {
            weights.push((ends[end], 1.0));
            return is_outside;
        }
        let scaled = |p: [f64; 3]| vector::times(self.locator.scale, vector::minus(p, from));
        let way = scaled(to);
        let part = vector::dot(scaled(query), way) / vector::squared_norm(way);
        let part = if is_outside { part } else { part.clamp(0.0, 1.0) };
        weights.extend([(ends[0], 1.0 - part), (ends[1], part)]);
        is_outside
    }

    /// Does so in a plane, in the triangulation there.
    fn plane_weights(
        &self,
        method: Interpolation,
        query: &Query<D>,
        around: &Around<3>,
        plane: &Plane,
        to: &mut State<D>,
    ) -> Result<bool, Error> {
        let (Some(locators), Some(triangle)) = (&self.plane, plane.triangles().next()) else { return Ok(true) };
        let [locator, in_plane] = &**locators;
        let corners = triangle.map(|v| in_space(self.locator.complex.point(v)));
        let side = |corner| <Euclidean as Geometry<3, 4>>::side(&corners, corner);
        let is_beside = [-1, 1].iter().any(|&sign| around.corners().all(|corner| side(corner) == sign));
        if is_beside && self.outside != Outside::Linear {
            return Ok(true);
        }
        // Beside the plane, the nearest place in it counts.
        let [at, foot] = match plane.frame {
            _ if !is_beside => [plane.shadow, plane.frame].map(|frame| frame.project(in_space(query.at))),
            frame => {
                let foot = frame.project(in_space(query.at));
                [plane.shadow.project(frame.lift(foot)), foot]
            }
        };
        let Frame::Aligned { axis, .. } = plane.shadow else { return Ok(true) };
        let reach = query.reach.map(|reach| [1, 2].map(|next| in_space(reach)[(axis + next) % 3]));
        // Which vertex is nearest is found in space.
        let outside = if self.outside == Outside::Linear { Outside::Linear } else { Outside::default() };
        let (values, gradients) = (Cow::Borrowed(&[][..]), OnceLock::new());
        let inner = Interpolator { locator, values, outside, inside: None, plane: None, gradients };
        let mut state = State::default();
        let query = Query { at, reach, place: locator.place(at, reach)? };
        let is_outside = inner.find_weights(Interpolation::Linear, &query, &mut state)?;
        to.simplex = state.simplex;
        let State { scratch, weights: found, .. } = &mut state;
        if let (false, true, Some(Place { simplex, beyond: None, on_facet, .. })) =
            (is_outside || method == Interpolation::Linear, found.len() > 1, query.place)
        {
            let linear = std::mem::take(found);
            // On the border of the hull, which rounding may have bent within the plane, all methods are linear, as they are
            // at vertices. Rounding may also have moved the query to another triangle.
            let is_on_hull = on_facet && !locator.hull_facets_at(at, simplex).is_empty();
            let rounded = in_plane.walk(foot, simplex).ok().filter(|place| !is_on_hull && place.beyond.is_none());
            if let Some(Place { simplex, on_facet, .. }) = rounded
                && !in_plane.complex.corners(simplex).contains(&foot)
            {
                natural::weights::<2, 3>(in_plane, method, foot, (simplex, on_facet), scratch, found);
            }
            if found.is_empty() {
                *found = linear;
            }
        }
        to.weights.extend(found.iter().map(|&(v, weight)| (plane.vertices[v as usize], weight)));
        Ok(is_outside || is_beside)
    }
}
