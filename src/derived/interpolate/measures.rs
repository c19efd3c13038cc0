//! The measures of what a Voronoi cell would take from others, by the divergence theorem with the
//! point as origin.

use super::{
    super::{Interpolation, Locator},
    cavity::{Cavity, CavityFacet},
    hull,
    numeric::{dot, length},
};
use crate::{
    geometry::{Euclidean, Geometry, real::Real},
    predicates::polynomial::cross,
};
use rustc_hash::FxHashMap;

/// What differs between the dimensions in natural neighbours.
#[doc(hidden)]
pub trait StolenMeasures<const D: usize, const N: usize>: Geometry<D, N> {
    /// Fills in the measures of the vertices of a cavity, except for a factor that is the same for
    /// all.
    fn measure<T: Real>(cavity: &mut Cavity<T, D>);

    /// Appends the natural neighbours of a query on the facets of the hull that are listed, as
    /// (simplex, opposite vertex), with their weights.
    fn weights_on_hull(
        locator: &Locator<'_, D, N>,
        method: Interpolation,
        query: [f64; D],
        facets: &[(usize, usize)],
        weights: &mut Vec<(u32, f64)>,
    );
}

impl StolenMeasures<2, 3> for Euclidean {
    /// Fills in the areas, times 2.
    ///
    /// An edge of a triangle of the cavity from *a* to *b* is dual to the Voronoi edge between the
    /// circumcentres on its left and its right, which runs clockwise around *a* and
    /// counter-clockwise around *b*.
    fn measure<T: Real>(Cavity { vertices, facets, magnitude }: &mut Cavity<T, 2>) {
        let area = |p: [T; 2], q: [T; 2]| p[0] * q[1] - p[1] * q[0];
        // The centre on the edge of the cavity's boundary that ends at each vertex, and on that
        // which starts there.
        let mut ends = vec![[[T::from(0); 2]; 2]; vertices.len()];
        for &CavityFacet { corners: [a, b], inside, beyond, is_boundary } in facets.iter() {
            let [a, b] = [a as usize, b as usize];
            let area = area(inside, beyond);
            vertices[a].stolen = vertices[a].stolen - area;
            vertices[b].stolen = vertices[b].stolen + area;
            *magnitude += 2.0 * length(inside) * length(beyond);
            if is_boundary {
                ends[a][1] = beyond;
                ends[b][0] = beyond;
            }
        }
        for (vertex, [before, after]) in vertices.iter_mut().zip(ends) {
            vertex.pyramid = area(before, after);
            vertex.stolen = vertex.stolen + vertex.pyramid;
            vertex.pyramid_magnitude = length(before) * length(after);
            *magnitude += vertex.pyramid_magnitude;
        }
    }

    fn weights_on_hull(
        locator: &Locator<'_, 2, 3>,
        _method: Interpolation,
        query: [f64; 2],
        facets: &[(usize, usize)],
        weights: &mut Vec<(u32, f64)>,
    ) {
        // No vertex is within the edge: all methods are linear there.
        if let Some(&(t, k)) = facets.first() {
            let edge = crate::geometry::facet(&locator.complex.simplices[t], k);
            hull::linear_on_edge(&locator.complex, edge, query, weights);
        }
    }
}

impl StolenMeasures<3, 4> for Euclidean {
    /// Fills in the volumes, times 12.
    ///
    /// A facet of a tetrahedron of the cavity is dual to the Voronoi edge from the tetrahedron's
    /// circumcentre to that on the other side, which turns counter-clockwise around each edge of
    /// the facet, seen along the edge. The edge from *a* to *b* is dual to the Voronoi polygon
    /// between the cells of *a* and *b*; its triangles with a corner in the middle of *a* and *b*
    /// are the bases of pyramids with their apex at the query.
    fn measure<T: Real>(Cavity { vertices, facets, magnitude }: &mut Cavity<T, 3>) {
        let six_volumes = |o: [T; 3], p: [T; 3], q: [T; 3]| dot(o, cross(&p, &q));
        let reach = vertices.iter().map(|vertex| length(vertex.position)).fold(0.0, f64::max);
        let mut add = |a: u32, b: u32, from: [T; 3], to: [T; 3]| {
            let [a, b] = [a as usize, b as usize];
            let twice_middle = std::array::from_fn(|axis| vertices[a].position[axis] + vertices[b].position[axis]);
            let volume = six_volumes(twice_middle, from, to);
            vertices[a].stolen = vertices[a].stolen + volume;
            vertices[b].stolen = vertices[b].stolen - volume;
        };
        // Around the cavity, the centre of the facet that has each directed edge.
        let mut around = FxHashMap::default();
        for &CavityFacet { corners: [a, b, c], inside, beyond, is_boundary } in facets.iter() {
            // Three edges with two vertices each, whose middle is counted twice.
            *magnitude += 12.0 * reach * length(inside) * length(beyond);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                add(from, to, inside, beyond);
                if is_boundary {
                    around.insert((from, to), beyond);
                }
            }
        }
        // The Voronoi edges around the facets of the query's cell close the polygons around the
        // edges of the cavity.
        let boundary = |&&CavityFacet { is_boundary, .. }: &&CavityFacet<T, 3>| is_boundary;
        let edges = facets.iter().filter(boundary).flat_map(|&CavityFacet { corners: [a, b, c], beyond, .. }| {
            [(a, b), (b, c), (c, a)].map(|(from, to)| (from, to, beyond))
        });
        for (from, to, beyond) in edges.clone() {
            if from < to
                && let Some(&other) = around.get(&(to, from))
            {
                add(from, to, beyond, other);
            }
        }
        // And they are the facets' own boundaries.
        for (from, to, beyond) in edges {
            if let Some(&other) = around.get(&(to, from)) {
                let vertex = &mut vertices[from as usize];
                let volume = six_volumes(vertex.position, other, beyond);
                vertex.stolen = vertex.stolen + volume;
                vertex.pyramid = vertex.pyramid + volume;
                let product = length(other) * length(beyond);
                vertex.pyramid_magnitude += length(vertex.position) * product;
                // With what closes the polygons: each edge is here twice.
                *magnitude += 3.0 * reach * product;
            }
        }
    }

    fn weights_on_hull(
        locator: &Locator<'_, 3, 4>,
        method: Interpolation,
        query: [f64; 3],
        facets: &[(usize, usize)],
        weights: &mut Vec<(u32, f64)>,
    ) {
        hull::weights(locator, method, query, facets, weights);
    }
}
