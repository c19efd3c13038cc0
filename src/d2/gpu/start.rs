//! The first triangle.

use crate::predicates::integer::orient2d_wide;

/// The first triangle, and a point inside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Start {
    /// Three vertices, positively oriented: never flat.
    pub first: [u32; 3],
    /// The kernel point: strictly inside.
    pub kernel: [i64; 2],
}

/// Points that are looked at for a large first triangle.
const SAMPLE: usize = 4096;

/// A first triangle for `count` points of a lattice, as large as a sample of them gives.
///
/// Nothing if all points are collinear, or if the lattice has no point inside the triangle that was found.
pub fn first_triangle(count: usize, position: impl Fn(usize) -> [i64; 2]) -> Option<Start> {
    let stride = count.div_ceil(SAMPLE).max(1);
    largest(count, stride, &position).or_else(|| if stride > 1 { largest(count, 1, &position) } else { None })
}

fn largest(count: usize, stride: usize, position: &dyn Fn(usize) -> [i64; 2]) -> Option<Start> {
    let sample = || (0..count).step_by(stride);
    let float = |i: usize| position(i).map(|x| x as f64);
    let from_to = |i: usize, j: usize| [float(j)[0] - float(i)[0], float(j)[1] - float(i)[1]];
    let farthest = |measure: &dyn Fn(usize) -> f64| sample().max_by(|&i, &j| measure(i).total_cmp(&measure(j)));

    let a = farthest(&|i| -float(i)[0] - float(i)[1])?;
    let b = farthest(&|i| from_to(a, i).iter().map(|x| x * x).sum())?;
    let [x, y] = from_to(a, b);
    let c = farthest(&|i| {
        let [p, q] = from_to(a, i);
        (x * q - y * p).abs()
    })?;
    let mut first = [a, b, c];
    let orient = |three: [usize; 3]| {
        let [a, b, c] = three.map(position);
        orient2d_wide(a, b, c)
    };
    // Where the area is lost in rounding, any point that is not collinear with the two will do.
    if orient(first) == 0 {
        first[2] = sample().find(|&c| orient([a, b, c]) != 0)?;
    }
    if orient(first) < 0 {
        first.swap(0, 1);
    }
    let corners = first.map(position);
    let kernel: [i64; 2] = std::array::from_fn(|axis| {
        let sum: i128 = corners.iter().map(|q| i128::from(q[axis])).sum();
        (sum / 3) as i64
    });
    let inside = |k: usize| {
        let mut three = corners;
        three[k] = kernel;
        orient2d_wide(three[0], three[1], three[2]) > 0
    };
    (0..3).all(inside).then(|| Start { first: first.map(|i| i as u32), kernel })
}
