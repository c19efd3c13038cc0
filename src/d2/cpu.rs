//! What the CPU engine of 2D has of its own.

use crate::{
    cpu::Incremental,
    d2::{Mesh2, Triangulation2, insert},
    dimension::Dimension,
    input::{hilbert, order::Curve, points::Points2},
    options::Options,
    predicates::orient2d,
};

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

    fn mesh(triangulation: Triangulation2, names: &[u32], options: &Options) -> Mesh2 {
        let (triangles, halfedges, hull) = triangulation.into_mesh(names, options.winding);
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
