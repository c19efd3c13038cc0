//! The 2D parts of the CPU engine.

use crate::{
    cpu::{Grow, Incremental, SharedRun, insert_all, insert_by_workers},
    d2::{
        Mesh2, Triangulation2,
        insert::{self, edge_of},
        triangulation::MAX_TRIANGLES,
    },
    dimension::Dimension,
    error::Error,
    index::NONE,
    input::{hilbert, order::Curve, points::Points2},
    options::Options,
    parallel::{self, Threads},
    predicates::{
        filter::{PredicateContext, PredicateContext2},
        orient2d,
    },
    slots::{self, SharedSlots},
};
use std::ops::Range;

impl Incremental<2> for Dimension<2> {
    type Mesh = Mesh2;
    type Triangulation = Triangulation2;

    const MAX_POINTS: usize = insert::MAX_POINTS;
    const CURVE: Curve<2> = hilbert::index2d;

    fn spanning_first(points: Points2<'_>, order: &mut [u32]) -> u8 {
        let point = |i: u32| points.get(i as usize);
        let &mut [a, b, ..] = order else { return 0 };
        let orient = |c: u32| orient2d(point(a), point(b), point(c));
        let Some(at) = (2..order.len()).find(|&k| orient(order[k]) != 0) else { return 1 };
        let clockwise = orient(order[at]) < 0;
        // A rotation keeps the order of the points that are jumped over.
        order[2..=at].rotate_right(1);
        if clockwise {
            order.swap(0, 1);
        }
        2
    }

    fn triangulate(
        threads: Threads,
        vertices: &PredicateContext2<'_>,
        rounds: &[Range<u32>],
        options: &Options,
    ) -> Result<Triangulation2, Error> {
        insert_all(threads, vertices, rounds, options)
    }

    fn triangulate_weighted(
        threads: Threads,
        vertices: &PredicateContext<'_, 2, true>,
        rounds: &[Range<u32>],
        options: &Options,
    ) -> Result<Triangulation2, Error> {
        insert_all(threads, vertices, rounds, options)
    }

    fn mesh(triangulation: Triangulation2, names: &[u32], threads: Threads, options: &Options) -> Mesh2 {
        let (triangles, halfedges, hull) = triangulation.into_mesh(names, options.winding, threads);
        Mesh2 { triangles, halfedges, hull, ..Mesh2::default() }
    }

    /// Returns the mesh whose hull is the points in the order of their coordinates.
    fn degenerate_mesh(points: Points2<'_>, mut distinct: Vec<u32>) -> Mesh2 {
        distinct.sort_unstable_by(|&i, &j| {
            let [p, q] = [i, j].map(|i| points.get(i as usize));
            p.partial_cmp(&q).unwrap_or(std::cmp::Ordering::Equal)
        });
        Mesh2 { hull: distinct, ..Mesh2::default() }
    }
}

impl Grow<2> for Triangulation2 {
    const SIMPLICES_PER_POINT: usize = 2;

    /// Creates one triangle, and the ghosts on its three edges.
    fn initial(infinite: u32) -> Self {
        let triangles = vec![[0, 1, 2], [infinite, 2, 1], [0, 2, infinite], [1, 0, infinite]];
        let neighbors = vec![[0; 3]; 4];
        let mut mesh = Triangulation2 { triangles, neighbors, infinite };
        let edge = |mesh: &Triangulation2, t: u32, k: u32| edge_of(mesh.triangles[t as usize], k as usize);
        for t in 0..4 {
            for k in 0..3 {
                // The edge with the opposite direction.
                let [from, to] = edge(&mesh, t, k);
                let against = (0..12).map(|e| [e / 3, e % 3]).find(|&[u, l]| edge(&mesh, u, l) == [to, from]);
                if let Some([u, l]) = against {
                    mesh.join(4 * t + k, 4 * u + l);
                }
            }
        }
        mesh
    }

    fn reserve(&mut self, triangles: usize) -> Result<(), Error> {
        slots::reserve(&mut self.triangles, &mut self.neighbors, triangles)
    }

    fn into_simplices(self) -> Vec<[[u32; 4]; 2]> {
        let corner = |v: u32| if v == self.infinite { NONE } else { v };
        let words = |[a, b, c]: [u32; 3]| [a, b, c, 0];
        let simplices = self.triangles.iter().zip(&self.neighbors);
        simplices.map(|(t, &near)| [words(t.map(corner)), words(near)]).collect()
    }

    fn insert_by_threads<const W: bool>(self, run: &SharedRun<'_, 2, W>) -> Result<(Self, Vec<u32>), Error> {
        let Triangulation2 { triangles, neighbors, infinite } = self;
        let room = infinite as usize * Self::SIMPLICES_PER_POINT;
        let workers = parallel::count(run.threads);
        let mut slots = SharedSlots::new([&triangles, &neighbors], Vec::new(), infinite, room, MAX_TRIANGLES, workers)?;
        drop((triangles, neighbors));
        let left = insert_by_workers(&mut slots, run)?;
        let (triangles, neighbors) = slots.into_arrays();
        Ok((Triangulation2 { triangles, neighbors, infinite }, left))
    }
}
