//! Ties of the in-sphere test: simulation of simplicity on the lifted heights (Edelsbrunner and Mücke 1990).
//!
//! Point *i* counts as if its lifted height were |pᵢ|² + δᵢ with δ₀ ≫ δ₁ ≫ … > 0. The derivative of the in-sphere
//! determinant by a point's height is, up to a sign that alternates along the argument list, the orientation of the
//! other four points. So the first point in index order whose removal leaves four points that are not coplanar decides.

use super::{Sign, exact};

/// The sign of an in-sphere determinant that vanishes without the perturbation. `indices` are the input indices of the
/// five arguments; `orient(k)` is the orientation of the other four, in argument order, when argument *k* is left out.
/// Zero only if all five are coplanar.
#[inline]
pub fn break_tie(indices: [u32; 5], mut orient: impl FnMut(usize) -> Sign) -> Sign {
    let mut order = [0, 1, 2, 3, 4];
    order.sort_unstable_by_key(|&k: &usize| indices[k]);
    order.into_iter().map(|k| if k % 2 == 0 { -orient(k) } else { orient(k) }).find(|&sign| sign != 0).unwrap_or(0)
}

/// Like [`insphere`](exact::insphere), but never zero for distinct points that are not all coplanar. `points` are input
/// indices, all different, and coordinates.
pub fn insphere_symbolic(points: [(u32, [f64; 3]); 5]) -> Sign {
    let [a, b, c, d, e] = points.map(|(_, p)| p);
    match exact::insphere(a, b, c, d, e) {
        0 => break_tie(points.map(|(i, _)| i), |k| {
            let [a, b, c, d] = without(points, k).map(|(_, p)| p);
            exact::orient3d(a, b, c, d)
        }),
        sign => sign,
    }
}

/// The others, in order, when one of five is left out.
#[inline]
pub fn without<T: Copy>(five: [T; 5], k: usize) -> [T; 4] {
    std::array::from_fn(|i| five[i + usize::from(i >= k)])
}
