//! What the CPU engine of 3D has of its own.

use crate::{
    cpu::Incremental,
    d3::{
        Mesh3, insert,
        triangulation::{FiniteMesh, Triangulation3},
    },
    dimension::Dimension,
    input::{hilbert, order::Curve, points::Points3},
    options::Options,
    parallel::Threads,
    predicates::{collinear, orient3d},
};

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

    fn mesh(triangulation: Triangulation3, names: &[u32], _options: &Options) -> Mesh3 {
        let FiniteMesh { tetrahedra, neighbors, hull } = triangulation.into_mesh(Some(names), Threads::One);
        Mesh3 { tetrahedra, neighbors, hull, ..Mesh3::default() }
    }

    fn degenerate_mesh(_points: Points3<'_>, _distinct: Vec<u32>) -> Mesh3 {
        Mesh3::default()
    }
}
