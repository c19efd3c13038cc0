//! What the GPU engine needs to know of three dimensions.

use crate::{
    d3::gpu::{buffers::OwnBuffers, vertex},
    dimension::Dimension,
    gpu::{
        dim::Dim,
        layout::{BLOCK, FlipNode},
        shader::{self, Shaders},
    },
    input::lattice::Width,
    predicates::{Sign, integer},
};

/// The most points of a start. The CPU engine takes some 6 µs per point, and is done before the device
/// needs the start. With four times as many points, more vertices fail than without a start: on a grid,
/// twice as many.
const MAX_START: usize = 100;

impl Dim<3> for Dimension<3> {
    type Corners = [u32; 4];
    type Flip = FlipNode;
    type OwnBuffers = OwnBuffers;

    const SLOTS_PER_POINT: u32 = BLOCK;
    const SIMPLICES: &'static str = "tetrahedra";
    const NARROW_WORDS: usize = 4;
    const SHADERS: &'static Shaders = &shader::D3;
    /// Limited by slots: there are a few more than eight per point. This many points were verified.
    const MAX_POINTS: usize = 118_000_000;
    /// The largest round of uniform points takes 3.1 nodes per point.
    const HISTORY: u32 = 4;
    const MESH_PER_POINT: usize = 7;
    const FIRST_ITERATIONS: u32 = 32;

    /// Returns the blocks of the points, that of infinity, and the tail.
    fn blocks(points: u32, tail: u32) -> u32 {
        points + 1 + tail
    }

    /// Returns 4 ∛count, and at most [`MAX_START`].
    fn start_points(count: usize) -> usize {
        ((4.0 * libm::cbrt(count as f64)) as usize + 4).min(MAX_START)
    }

    fn append_vertex(words: &mut Vec<i32>, width: Width, position: [i64; 3], index: u32, rounded: bool) {
        vertex::append_words(words, width, position, index, rounded);
    }

    fn orient(width: Width, corners: &[[i64; 3]]) -> Sign {
        let &[a, b, c, d] = corners else { panic!("a tetrahedron has four corners, not {}", corners.len()) };
        match width {
            Width::Narrow => integer::orient3d_narrow(a, b, c, d),
            Width::Wide => integer::orient3d_wide(a, b, c, d),
        }
    }

    /// Returns, for the corners in turn: how far `p` lies in the direction (-1, -1, -1), the square
    /// of its distance from the first corner, that of the area with the first two (times 2), and
    /// the volume with all three (times 6).
    fn spread(chosen: &[[f64; 3]], p: [f64; 3]) -> f64 {
        let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let cross = |u: [f64; 3], v: [f64; 3]| {
            [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        };
        let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
        let square = |u: [f64; 3]| dot(u, u);
        match *chosen {
            [] => -p[0] - p[1] - p[2],
            [a] => square(minus(p, a)),
            [a, b] => square(cross(minus(b, a), minus(p, a))),
            [a, b, c, ..] => dot(cross(minus(b, a), minus(c, a)), minus(p, a)).abs(),
        }
    }
}
