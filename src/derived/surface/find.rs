//! The steps from a mesh to its surface.

use super::{
    super::{
        complex::{Complex, Coordinates},
        sorted::Sorted,
    },
    Side, Surface, SurfaceOptions,
    boundary::{self, Boundary},
    capacity, constraints, cut,
    poles::{Poles, Spheres},
    solid,
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, vector},
    index::NONE,
    mesh::Csr,
};

/// A sorted mesh whose coordinates are neither large nor small.
pub(super) struct Prepared<const D: usize, const N: usize> {
    /// The mesh; its points have the names that they have in the surface.
    pub(super) mesh: Sorted<D, N>,
    /// What the coordinates are multiplied by.
    pub(super) scale: f64,
    /// The number of points that have names.
    count: usize,
}

impl<const D: usize, const N: usize> Prepared<D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Prepares a mesh with its points.
    ///
    /// # Errors
    ///
    /// [`Error::TooManySimplices`].
    pub(super) fn new(complex: &Complex<'_, D, N>) -> Result<Self, Error> {
        if complex.simplices.len() > cut::MAX_NODES {
            return Err(Error::TooManySimplices { limit: cut::MAX_NODES });
        }
        let mut mesh = Sorted::new(complex);
        mesh.arrange_rows();
        let scale = vector::scale_of(complex.bounds());
        if scale != 1.0
            && let Coordinates::Owned(points) = &mut mesh.complex.points
        {
            points.iter_mut().for_each(|p| *p = vector::times(scale, *p));
        }
        Ok(Prepared { count: mesh.points.len(), mesh, scale })
    }

    /// Gives the points other names, which are below `count`.
    pub(super) fn named(mut self, names: &[u32], count: usize) -> Self {
        self.mesh.points.iter_mut().for_each(|point| *point = names[*point as usize]);
        Prepared { count, ..self }
    }

    /// Returns the simplices around each vertex.
    pub(super) fn stars(&self) -> Csr {
        Csr::stars(&self.mesh.complex.simplices, self.mesh.points.len())
    }

    /// Finds the surface. `position` returns the coordinates of a point by its name.
    pub(super) fn surface(
        &self,
        stars: &Csr,
        options: &SurfaceOptions,
        position: &dyn Fn(u32) -> [f64; D],
    ) -> Surface<D, N> {
        let complex = &self.mesh.complex;
        let (is_inside, dropped) = self.inside(stars, options);
        let boundary = Boundary::new(complex, &self.mesh.points, &is_inside);
        let mut vertices: Vec<[f64; D]> = boundary.sources.iter().map(|&point| position(point)).collect();
        for &[a, b] in &boundary.middles {
            let halves = [a, b].map(|v| vector::times(0.5, vertices[v as usize]));
            vertices.push(vector::plus(halves[0], halves[1]));
        }
        let components = boundary.components();
        let mut sources = boundary.sources;
        let sides = self.sides(&is_inside, &sources);
        sources.resize(vertices.len(), NONE);
        // The power of the scale may underflow.
        let unscaled = |measure: f64, power: usize| (0..power).fold(measure, |measure, _| measure / self.scale);
        let inside = || (0..is_inside.len()).filter(|&t| is_inside[t]);
        Surface {
            solid: inside().map(|t| self.mesh.given(complex.simplices[t])).collect(),
            sides,
            volume: unscaled(solid::volume(complex, inside()), D),
            area: unscaled(boundary::area(&boundary.facets, &vertices, self.scale), D - 1),
            vertices,
            components,
            sources,
            facets: boundary.facets,
            dropped,
            isolated: 0,
            noise: 0.0,
            moved: None,
        }
    }

    /// Returns whether each simplex is inside, and how many pieces and cavities were dropped.
    fn inside(&self, stars: &Csr, options: &SurfaceOptions) -> (Vec<bool>, [usize; 2]) {
        let complex = &self.mesh.complex;
        let spheres = Spheres::new(complex);
        let poles = Poles::of_all(&self.mesh, &spheres, stars);
        let votes = constraints::votes(complex, &spheres, stars, &poles);
        let costs = capacity::costs(complex, &spheres);
        drop((spheres, poles));
        let excess: Vec<i32> = votes
            .iter()
            .zip(&costs)
            .enumerate()
            .map(|(t, (&votes, costs))| {
                let hull = (0..N).filter(|&k| complex.across(t, k).is_none()).map(|k| i32::from(costs[k]));
                capacity::UNIT * i32::from(votes) - hull.sum::<i32>()
            })
            .collect();
        let mut is_inside = cut::inside(complex, &costs, &excess);
        let dropped = solid::drop_small(complex, &mut is_inside, options.min_part);
        (is_inside, dropped)
    }

    /// Returns where each point lies.
    fn sides(&self, is_inside: &[bool], vertices: &[u32]) -> Vec<Side> {
        let Sorted { complex, points, .. } = &self.mesh;
        let mut sides = vec![Side::Outside; self.count];
        for (simplex, _) in complex.simplices.iter().zip(is_inside).filter(|&(_, &is_inside)| is_inside) {
            simplex.iter().for_each(|&v| sides[points[v as usize] as usize] = Side::Inside);
        }
        vertices.iter().for_each(|&point| sides[point as usize] = Side::On);
        for (&point, &vertex) in points.iter().zip(&*complex.duplicate_of) {
            if vertex != NONE {
                sides[point as usize] = sides[points[vertex as usize] as usize];
            }
        }
        sides
    }
}
