//! The steps from a mesh to its surface.

use super::{
    super::{
        complex::{Complex, Coordinates},
        sorted::Sorted,
    },
    Cleaning, Side, Surface, SurfaceOptions, Topology,
    beyond::{Extended, INFINITY},
    boundary::{self, Boundary},
    capacity, constraints, cut,
    evidence::{Evidence, Hints},
    open::{self, Gaps, Open, Unseen},
    poles::Poles,
    refine, solid,
    spheres::Spheres,
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    mesh::Csr,
    parallel::{self, Threads},
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
        options: &SurfaceOptions<'_, D>,
        position: &(dyn Fn(u32) -> [f64; D] + Sync),
    ) -> Surface<D, N> {
        let complex = &self.mesh.complex;
        let hints = Hints::new(complex.points(), &self.mesh.points, self.scale, options);
        let (is_inside, dropped) = self.inside(stars, options, &hints);
        let solid = || {
            let solid = parallel::map_ranges(Threads::All, is_inside.len(), |range| {
                range.filter(|&t| is_inside[t]).map(|t| self.mesh.given(complex.simplices[t])).collect()
            });
            (parallel::joined(solid), solid::volume(complex, &is_inside))
        };
        let shell = || self.shell(&is_inside, &hints, options.open, position);
        let (Shell { mut boundary, mut vertices, evidence }, (solid, volume)) =
            parallel::both(Threads::All, shell, solid);
        let topology = Topology::new(&boundary, vertices.len());
        let sides = self.sides(&is_inside, &boundary.sources);
        let mut gain = 0.0;
        if options.refine {
            let refined = refine::refine(&boundary, &mut vertices, self.scale);
            (boundary.facets, gain) = (refined.facets, refined.gain);
            boundary.sources.resize(vertices.len(), NONE);
        }
        // The power of the scale may underflow.
        let unscaled = |measure: f64, power: usize| (0..power).fold(measure, |measure, _| measure / self.scale);
        Surface {
            solid,
            sides,
            volume: unscaled(volume + gain, D),
            area: unscaled(boundary::area(&boundary.facets, &vertices, self.scale), D - 1),
            topology,
            vertices,
            sources: boundary.sources,
            facets: boundary.facets,
            cleaning: Cleaning { dropped, isolated: 0, noise: 0.0 },
            evidence,
            moved: None,
        }
    }

    /// Returns the boundary of the solid, and what its side is known by; on request without the facets that
    /// close gaps, if those are many.
    fn shell(
        &self,
        is_inside: &[bool],
        hints: &Hints<D>,
        open: Open,
        position: &(dyn Fn(u32) -> [f64; D] + Sync),
    ) -> Shell<D> {
        let Sorted { complex, points: names, .. } = &self.mesh;
        let boundary = Boundary::new(complex, names, is_inside);
        let mut shell = Shell::new(boundary, hints.kind().unwrap_or(Evidence::Hull), position);
        let find = |shell: &Shell<D>, beyond: &Unseen<D>| {
            let scaled: Vec<[f64; D]> = shell.vertices.iter().map(|&p| vector::times(self.scale, p)).collect();
            Gaps::find(&shell.boundary, &scaled, beyond)
        };
        if hints.kind().is_none() {
            let gaps = find(&shell, &Unseen::default());
            if gaps.is_open {
                shell.evidence = Evidence::Guess;
                if open == Open::Auto {
                    open::remove(&mut shell.boundary, &mut shell.vertices, &gaps.is_gap);
                }
            }
        } else if open == Open::Auto && find(&shell, &Unseen::new(&self.mesh, is_inside, hints)).is_open {
            let Extended { complex, names, is_inside } = Extended::new(complex, names, is_inside, hints);
            shell = Shell::new(Boundary::new(&complex, &names, &is_inside), shell.evidence, position);
            shell.remove_infinite();
            let gaps = find(&shell, &Unseen::default());
            open::remove(&mut shell.boundary, &mut shell.vertices, &gaps.is_gap);
        }
        shell
    }

    /// Returns whether each simplex is inside, and how many pieces and cavities were dropped.
    fn inside(&self, stars: &Csr, options: &SurfaceOptions<'_, D>, hints: &Hints<D>) -> (Vec<bool>, [usize; 2]) {
        let complex = &self.mesh.complex;
        let spheres = Spheres::new(complex);
        let poles = Poles::of_all(&self.mesh, &spheres, stars, hints);
        let votes = constraints::votes(complex, &spheres, stars, &poles, hints);
        let costs = capacity::costs(complex, &spheres);
        drop((spheres, poles));
        let evident = hints.votes(complex, stars);
        let hull_excess = |t: usize, k: usize| hints.hull_excess(complex, facet(&complex.simplices[t], k), costs[t][k]);
        let mut excess = vec![0; votes.len()];
        parallel::for_chunks(Threads::All, &mut excess, |start, chunk| {
            for (excess, t) in chunk.iter_mut().zip(start..) {
                let votes = i32::from(votes[t]) + evident.get(t).copied().unwrap_or(0);
                let hull = (0..N).filter(|&k| complex.across(t, k).is_none()).map(|k| hull_excess(t, k));
                *excess = capacity::UNIT * votes + hull.sum::<i32>();
            }
        });
        let mut is_inside = cut::inside(complex, &costs, &excess);
        let dropped = solid::drop_small(complex, &mut is_inside, options.min_part);
        (is_inside, dropped)
    }

    /// Returns where each point lies.
    fn sides(&self, is_inside: &[bool], vertices: &[u32]) -> Vec<Side> {
        let Sorted { complex, points: names, .. } = &self.mesh;
        let mut sides = vec![Side::Outside; self.count];
        for (simplex, _) in complex.simplices.iter().zip(is_inside).filter(|&(_, &is_inside)| is_inside) {
            simplex.iter().for_each(|&v| sides[names[v as usize] as usize] = Side::Inside);
        }
        let points = vertices.iter().filter(|&&point| point != NONE);
        points.for_each(|&point| sides[point as usize] = Side::On);
        for (&point, &vertex) in names.iter().zip(&*complex.duplicate_of) {
            if vertex != NONE {
                sides[point as usize] = sides[names[vertex as usize] as usize];
            }
        }
        sides
    }
}

/// The facets between inside and outside with the positions of their vertices.
struct Shell<const D: usize> {
    /// With one source for each vertex: [`NONE`] for the middle of an edge.
    boundary: Boundary<D>,
    vertices: Vec<[f64; D]>,
    evidence: Evidence,
}

impl<const D: usize> Shell<D> {
    fn new(mut boundary: Boundary<D>, evidence: Evidence, position: &(dyn Fn(u32) -> [f64; D] + Sync)) -> Self {
        let finite = |point: u32| if point == INFINITY { [f64::INFINITY; D] } else { position(point) };
        let mut vertices: Vec<[f64; D]> = boundary.sources.iter().map(|&point| finite(point)).collect();
        for &[a, b] in &boundary.middles {
            let halves = [a, b].map(|v| vector::times(0.5, vertices[v as usize]));
            vertices.push(vector::plus(halves[0], halves[1]));
        }
        boundary.sources.resize(vertices.len(), NONE);
        Shell { boundary, vertices, evidence }
    }

    /// Removes the facets that reach to infinity.
    fn remove_infinite(&mut self) {
        let is_infinite = |v: &u32| !self.vertices[*v as usize][0].is_finite();
        let is_removed: Vec<bool> = self.boundary.facets.iter().map(|facet| facet.iter().any(is_infinite)).collect();
        open::remove(&mut self.boundary, &mut self.vertices, &is_removed);
    }
}
