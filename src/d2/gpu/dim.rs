//! What the GPU engine needs to know of two dimensions.

use crate::{
    d2::gpu::{
        layout::{EdgeFlip, SLOTS_PER_POINT, blocks},
        vertex,
    },
    dimension::Dimension,
    gpu::{
        dim::Dim,
        shader::{self, Shaders},
    },
    input::lattice::Width,
    predicates::{Sign, integer::orient2d_wide},
};

/// The most points of the start.
const MAX_START: usize = 4096;

impl Dim<2> for Dimension<2> {
    type Corners = [u32; 3];
    type Flip = EdgeFlip;
    type OwnBuffers = ();

    const SLOTS_PER_POINT: u32 = SLOTS_PER_POINT;
    const SIMPLICES: &'static str = "triangles";
    const NARROW_WORDS: usize = 2;
    const SHADERS: &'static Shaders = &shader::D2;
    /// There are two slots per point, and some.
    const MAX_POINTS: usize = 500_000_000;
    const HISTORY: u32 = 2;
    const MESH_PER_POINT: usize = 2;
    const FIRST_ITERATIONS: u32 = 30;

    fn blocks(points: u32, _tail: u32) -> u32 {
        blocks(points)
    }

    /// Returns 1.5 √count: the CPU engine takes some 1 µs per point.
    fn start_points(count: usize) -> usize {
        (9 * count / 4).isqrt().min(MAX_START) + 3
    }

    fn append_vertex(words: &mut Vec<i32>, width: Width, position: [i64; 2], _index: u32, rounded: bool) {
        vertex::append_words(words, width, position, rounded);
    }

    fn orient(_width: Width, corners: &[[i64; 2]]) -> Sign {
        let &[a, b, c] = corners else { panic!("a triangle has three corners, not {}", corners.len()) };
        orient2d_wide(a, b, c)
    }

    /// Returns, for the corners in turn: how far `p` lies in the direction (-1, -1), the square of
    /// its distance from the first corner, and the area with the first two (times 2).
    fn spread(chosen: &[[f64; 2]], p: [f64; 2]) -> f64 {
        let minus = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
        match *chosen {
            [] => -p[0] - p[1],
            [a] => minus(p, a).iter().map(|x| x * x).sum(),
            [a, b, ..] => {
                let ([x, y], [p, q]) = (minus(b, a), minus(p, a));
                (x * q - y * p).abs()
            }
        }
    }
}
