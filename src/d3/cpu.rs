//! The 3D parts of the CPU engine.

use crate::{
    cpu::{Grow, Incremental, SharedRun, insert_all, insert_by_workers},
    d3::{
        Mesh3, insert,
        mesh::FACETS,
        triangulation::{FiniteMesh, MAX_TETRAHEDRA, Triangulation3, state},
    },
    dimension::Dimension,
    error::Error,
    index::NONE,
    input::{hilbert, order::Curve, points::Points3},
    options::Options,
    parallel::{self, Threads},
    predicates::{
        collinear,
        filter::{PredicateContext, PredicateContext3},
        orient3d,
    },
    slots::{self, SharedSlots},
};
use std::ops::Range;

impl Incremental<3> for Dimension<3> {
    type Mesh = Mesh3;
    type Triangulation = Triangulation3;

    const MAX_POINTS: usize = insert::MAX_POINTS;
    const CURVE: Curve<3> = hilbert::index3d;

    fn spanning_first(points: Points3<'_>, order: &mut [u32]) -> u8 {
        let point = |i: u32| points.get(i as usize);
        // A rotation keeps the order of the points that are jumped over.
        let bring = |order: &mut [u32], from: usize, to: usize| order[to..=from].rotate_right(1);
        let &mut [a, b, ..] = order else { return 0 };
        let [a, b] = [a, b].map(point);
        let Some(at) = (2..order.len()).find(|&k| !collinear(a, b, point(order[k]))) else { return 1 };
        bring(order, at, 2);
        let c = point(order[2]);
        let orient = |d: u32| orient3d(a, b, c, point(d));
        let Some(at) = (3..order.len()).find(|&k| orient(order[k]) != 0) else { return 2 };
        bring(order, at, 3);
        if orient(order[3]) < 0 {
            order.swap(0, 1);
        }
        3
    }

    fn triangulate(
        threads: Threads,
        vertices: &PredicateContext3<'_>,
        rounds: &[Range<u32>],
        options: &Options,
    ) -> Result<Triangulation3, Error> {
        insert_all(threads, vertices, rounds, options)
    }

    fn triangulate_weighted(
        threads: Threads,
        vertices: &PredicateContext<'_, 3, true>,
        rounds: &[Range<u32>],
        options: &Options,
    ) -> Result<Triangulation3, Error> {
        insert_all(threads, vertices, rounds, options)
    }

    fn mesh(triangulation: Triangulation3, names: &[u32], threads: Threads, _options: &Options) -> Mesh3 {
        let FiniteMesh { tetrahedra, neighbors, hull } = triangulation.into_mesh(Some(names), threads);
        Mesh3 { tetrahedra, neighbors, hull, ..Mesh3::default() }
    }

    fn degenerate_mesh(_points: Points3<'_>, _distinct: Vec<u32>) -> Mesh3 {
        Mesh3::default()
    }
}

impl Grow<3> for Triangulation3 {
    /// 6.77 for a uniform distribution, and some ghosts.
    const SIMPLICES_PER_POINT: usize = 7;

    /// Creates one tetrahedron, and the ghosts on its four facets.
    fn initial(infinite: u32) -> Self {
        let mut mesh = Triangulation3 { tetrahedra: vec![[0, 1, 2, 3]], neighbors: vec![[0; 4]], infinite };
        for (k, facet) in FACETS.iter().enumerate() {
            let [a, b, c] = facet.map(|v| v as u32);
            mesh.tetrahedra.push([a, b, c, infinite]);
            mesh.neighbors.push([0; 4]);
            mesh.join(k as u32, 4 * (k as u32 + 1) + 3);
        }
        // Ghosts i and j share the facet opposite corner j of ghost i and corner i of ghost j.
        for i in 0..4u32 {
            for j in 0..i {
                let facet = |ghost: u32, corner: u32| {
                    let place = mesh.tetrahedra[ghost as usize + 1].iter().position(|&v| v == corner);
                    4 * (ghost + 1) + place.map_or(0, |k| k as u32)
                };
                let (f, g) = (facet(i, j), facet(j, i));
                mesh.join(f, g);
            }
        }
        mesh
    }

    fn reserve(&mut self, tetrahedra: usize) -> Result<(), Error> {
        slots::reserve(&mut self.tetrahedra, &mut self.neighbors, tetrahedra)
    }

    fn into_simplices(self) -> Vec<[[u32; 4]; 2]> {
        let is_used = |t: u32| self.state(t) != state::FREE;
        let used: Vec<u32> = (0..self.tetrahedra.len() as u32).filter(|&t| is_used(t)).collect();
        let mut number = vec![0; self.tetrahedra.len()];
        (0..).zip(&used).for_each(|(i, &t)| number[t as usize] = i);
        let corner = |v: u32| if v == self.infinite { NONE } else { v };
        let across = |f: u32| 4 * number[f as usize / 4] + f % 4;
        used.iter().map(|&t| [self.vertices(t).map(corner), self.neighbors[t as usize].map(across)]).collect()
    }

    fn insert_by_threads<const W: bool>(self, run: &SharedRun<'_, 3, W>) -> Result<(Self, Vec<u32>), Error> {
        let is_unused = |&t: &u32| self.state(t) == state::FREE;
        let unused = (0..self.tetrahedra.len() as u32).filter(is_unused).collect();
        let Triangulation3 { tetrahedra, neighbors, infinite } = self;
        // Room that is not used takes no memory, and to make more the workers have to stop.
        let room = infinite as usize * (Self::SIMPLICES_PER_POINT + 1);
        let workers = parallel::count(run.threads);
        let mut slots = SharedSlots::new([&tetrahedra, &neighbors], unused, infinite, room, MAX_TETRAHEDRA, workers)?;
        drop((tetrahedra, neighbors));
        let left = insert_by_workers(&mut slots, run)?;
        let (tetrahedra, neighbors) = slots.into_arrays();
        Ok((Triangulation3 { tetrahedra, neighbors, infinite }, left))
    }
}
