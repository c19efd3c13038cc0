//! The first simplex.

use bytemuck::Zeroable;

use crate::dimension::Dimension;
use crate::gpu::dim::{Corners, Dim};
use crate::input::lattice::Width;

/// The first simplex, and a point inside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Start<const D: usize>
where
    Dimension<D>: Dim<D>,
{
    /// The vertices, positively oriented: never flat.
    pub first: Corners<D>,
    /// The interior point: strictly inside.
    pub interior_point: [i64; D],
}

/// Points that are looked at for a large first simplex: enough for one that most points lie in, and
/// so few that looking takes no time.
const SAMPLE: usize = 4096;

/// Returns a first simplex for `count` points of a lattice, as large as a sample of them gives.
///
/// Returns `None` if all points lie in a line (2D) or plane (3D), or if the lattice has no point
/// inside the simplex that was found.
pub fn first_simplex<const D: usize>(
    width: Width,
    count: usize,
    position: impl Fn(usize) -> [i64; D],
) -> Option<Start<D>>
where
    Dimension<D>: Dim<D>,
{
    let stride = count.div_ceil(SAMPLE).max(1);
    largest(width, count, stride, &position)
        .or_else(|| if stride > 1 { largest(width, count, 1, &position) } else { None })
}

fn largest<const D: usize>(
    width: Width,
    count: usize,
    stride: usize,
    position: &dyn Fn(usize) -> [i64; D],
) -> Option<Start<D>>
where
    Dimension<D>: Dim<D>,
{
    let sample = || (0..count).step_by(stride);
    let mut first = Vec::with_capacity(D + 1);
    let mut chosen = Vec::with_capacity(D);
    for _ in 0..=D {
        let measured = sample().map(|i| {
            let p = position(i).map(|x| x as f64);
            (<Dimension<D>>::spread(&chosen, p), i, p)
        });
        let (_, i, p) = measured.max_by(|(m, ..), (n, ..)| m.total_cmp(n))?;
        first.push(i);
        chosen.push(p);
    }
    let orient = |corners: &[usize]| {
        let positions: Vec<[i64; D]> = corners.iter().map(|&i| position(i)).collect();
        <Dimension<D>>::orient(width, &positions)
    };
    // Where the volume is lost in rounding, any point that is not in a line or plane with the
    // others will do.
    if orient(&first) == 0 {
        first[D] = sample().find(|&i| orient(&[&first[..D], &[i]].concat()) != 0)?;
    }
    if orient(&first) < 0 {
        first.swap(0, 1);
    }
    let corners: Vec<[i64; D]> = first.iter().map(|&i| position(i)).collect();
    let interior_point: [i64; D] = std::array::from_fn(|axis| {
        let sum: i128 = corners.iter().map(|q| i128::from(q[axis])).sum();
        (sum / (D as i128 + 1)) as i64
    });
    let is_inside = (0..=D).all(|k| {
        let mut corners = corners.clone();
        corners[k] = interior_point;
        <Dimension<D>>::orient(width, &corners) > 0
    });
    is_inside.then(|| {
        let mut vertices = Corners::<D>::zeroed();
        vertices.as_mut().iter_mut().zip(first).for_each(|(v, i)| *v = i as u32);
        Start { first: vertices, interior_point }
    })
}
