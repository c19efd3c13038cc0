//! The first tetrahedron.

use crate::input::lattice::Width;
use crate::predicates::{Sign, integer};

/// The first tetrahedron, and a point inside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Start {
    /// Four vertices, positively oriented: never flat.
    pub first: [u32; 4],
    /// The kernel point: strictly inside.
    pub kernel: [i64; 3],
}

/// Points that are looked at for a large first tetrahedron.
const SAMPLE: usize = 4096;

fn orient3d(width: Width, [a, b, c, d]: [[i64; 3]; 4]) -> Sign {
    match width {
        Width::Narrow => integer::orient3d_narrow(a, b, c, d),
        Width::Wide => integer::orient3d_wide(a, b, c, d),
    }
}

/// A first tetrahedron for `count` points, as large as a sample of them gives.
///
/// Nothing if all points are coplanar, or if the lattice has no point inside the tetrahedron that was found.
pub fn first_tetrahedron(width: Width, count: usize, position: impl Fn(usize) -> [i64; 3]) -> Option<Start> {
    let stride = count.div_ceil(SAMPLE).max(1);
    largest(width, count, stride, &position)
        .or_else(|| if stride > 1 { largest(width, count, 1, &position) } else { None })
}

fn largest(width: Width, count: usize, stride: usize, position: &dyn Fn(usize) -> [i64; 3]) -> Option<Start> {
    let mut sample = (0..count).step_by(stride);
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let cross =
        |u: [f64; 3], v: [f64; 3]| [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let square = |u: [f64; 3]| dot(u, u);
    // The number and the position of the point with the largest measure.
    let farthest = |measure: &dyn Fn([f64; 3]) -> f64| {
        let measured = sample.clone().map(|i| {
            let p = position(i).map(|x| x as f64);
            (measure(p), i, p)
        });
        measured.max_by(|(m, ..), (n, ..)| m.total_cmp(n)).map(|(_, i, p)| (i, p))
    };

    let (a, at) = farthest(&|p| -p[0] - p[1] - p[2])?;
    let (b, to_b) = farthest(&|p| square(minus(p, at)))?;
    let u = minus(to_b, at);
    let (c, to_c) = farthest(&|p| square(cross(u, minus(p, at))))?;
    let normal = cross(u, minus(to_c, at));
    let (d, _) = farthest(&|p| dot(normal, minus(p, at)).abs())?;
    let mut first = [a, b, c, d];
    let corners = |first: [usize; 4]| first.map(position);
    // Where the volume is lost in rounding, any point that is not coplanar with the three will do.
    if orient3d(width, corners(first)) == 0 {
        first[3] = sample.find(|&d| orient3d(width, corners([a, b, c, d])) != 0)?;
    }
    if orient3d(width, corners(first)) < 0 {
        first.swap(0, 1);
    }
    let four = corners(first);
    let kernel: [i64; 3] = std::array::from_fn(|axis| {
        let sum: i128 = four.iter().map(|q| i128::from(q[axis])).sum();
        (sum / 4) as i64
    });
    let inside = |k: usize| {
        let mut four = four;
        four[k] = kernel;
        orient3d(width, four) > 0
    };
    (0..4).all(inside).then(|| Start { first: first.map(|i| i as u32), kernel })
}
