//! The poles of each vertex (Amenta and Bern, *Surface reconstruction by Voronoi
//! filtering*, 1999).
//!
//! The circumcentres around a vertex are the corners of its Voronoi cell. Near a well sampled surface
//! the cell is long and thin and perpendicular to the surface, so that its farthest corners on either
//! side, the *poles*, lie inside and outside of the solid.

use super::{
    super::{complex::Complex, sorted::Sorted},
    evidence::Hints,
    spheres::Spheres,
};
use crate::{
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    mesh::Csr,
    parallel::{self, Threads},
};

/// The two poles of a vertex, which lie on different sides of the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Poles {
    /// The simplex with the farthest circumcentre; for vertices of the hull `OUTSIDE`, or `BENEATH`
    /// or [`NONE`] if the evidence says so.
    pub(super) first: u32,
    /// The simplex with the farthest circumcentre in the opposite half-space; [`NONE`] if there
    /// is none.
    pub(super) second: u32,
    /// The cosine of the angle between the directions to both; at a vertex of the hull, the first one
    /// is the mean normal.
    pub(super) cosine: f64,
}

impl Poles {
    const UNKNOWN: Poles = Poles { first: NONE, second: NONE, cosine: 0.0 };

    /// Returns the poles of all vertices; none for what is no vertex.
    pub(super) fn of_all<const D: usize, const N: usize>(
        mesh: &Sorted<D, N>,
        spheres: &Spheres<D>,
        stars: &Csr,
        hints: &Hints<D>,
    ) -> Vec<Poles>
    where
        Euclidean: Geometry<D, N>,
    {
        let complex = &mesh.complex;
        let normals = hull_normals(complex);
        let mut poles = vec![Poles::UNKNOWN; complex.points().len()];
        parallel::for_chunks(Threads::All, &mut poles, |start, chunk| {
            for (poles, v) in chunk.iter_mut().zip(start as u32..) {
                let normal = normals[v as usize];
                let beyond = (normal != [0.0; D]).then(|| (hints.beyond_vertex(v, normal).pole(), normal));
                *poles = Poles::of(complex, spheres, stars, v, beyond);
            }
        });
        poles
    }

    /// Returns the poles of a vertex; on the hull, the first one and the normal are given.
    fn of<const D: usize, const N: usize>(
        complex: &Complex<'_, D, N>,
        spheres: &Spheres<D>,
        stars: &Csr,
        v: u32,
        beyond: Option<(u32, [f64; D])>,
    ) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        let star = stars.of(v);
        let point = complex.point(v);
        let to_center = |t: u32| vector::minus(spheres.centers[t as usize], point);
        // Equal radii are those of equal spheres: in grids many. The vertices decide.
        let is_farther = |t: u32, than: u32| {
            let [(r, row), (s, other)] = [t, than].map(|t| (spheres.radii[t as usize], &complex.simplices[t as usize]));
            r > s || r == s && row < other
        };
        let farthest = |best: Option<u32>, t: u32| match best {
            Some(best) if !is_farther(t, best) => Some(best),
            _ => Some(t),
        };
        let found = || star.iter().copied().fold(None, farthest).map(|first| (first, to_center(first)));
        let Some((first, direction)) = beyond.or_else(found) else { return Poles::UNKNOWN };
        let is_opposite = |&t: &u32| vector::dot(to_center(t), direction) < 0.0;
        let second = star.iter().copied().filter(is_opposite).fold(None, farthest);
        let cosine = second.map_or(0.0, |t| {
            vector::dot(to_center(t), direction) / (spheres.radii[t as usize] * vector::norm(direction))
        });
        Poles { first, second: second.unwrap_or(NONE), cosine }
    }
}

/// Returns for each vertex of the hull the sum of the normals of the hull's facets around it, as long
/// as these are large; zero for all others.
fn hull_normals<const D: usize, const N: usize>(complex: &Complex<'_, D, N>) -> Vec<[f64; D]>
where
    Euclidean: Geometry<D, N>,
{
    let mut normals = vec![[0.0; D]; complex.points().len()];
    for facet in hull_facets(complex) {
        let normal = Euclidean::facet_normal(&facet.map(|v| complex.point(v)));
        for v in facet {
            let sum = &mut normals[v as usize];
            *sum = vector::plus(*sum, normal);
        }
    }
    normals
}

/// Returns the facets of the hull in ascending order.
fn hull_facets<const D: usize, const N: usize>(complex: &Complex<'_, D, N>) -> Vec<[u32; D]>
where
    Euclidean: Geometry<D, N>,
{
    let parts = parallel::map_ranges(Threads::All, complex.simplices.len(), |range| {
        let facets = range.flat_map(|t| (0..N).filter(move |&k| complex.across(t, k).is_none()).map(move |k| (t, k)));
        facets.map(|(t, k)| facet(&complex.simplices[t], k)).collect::<Vec<[u32; D]>>()
    });
    // Sums of numbers that are rounded depend on their order.
    let mut facets = parallel::joined(parts);
    parallel::sort(Threads::All, &mut facets);
    facets
}
