//! Ties of the in-sphere and in-circle tests: simulation of simplicity on the lifted heights
//! (Edelsbrunner and Mücke 1990; the paper's §4.4).
//!
//! Point *i* counts as if its lifted height were |pᵢ|² + δᵢ with δ₀ ≫ δ₁ ≫ … > 0. The derivative of
//! the in-sphere determinant with respect to a point's height is, up to a sign that alternates
//! along the argument list, the orientation of the other four points. So the first point in index
//! order whose removal leaves four points that are not coplanar decides; in 2D, three points that
//! are not collinear.

use crate::predicates::Sign;

/// Returns the sign of an in-sphere or in-circle determinant that vanishes without the
/// perturbation.
///
/// `indices` are the input indices of the arguments. `orient(k)` is the orientation of the other
/// arguments, in their order, when argument *k* is left out. The sign is zero only if all points
/// are coplanar, or collinear in 2D.
#[inline]
pub fn break_tie<const N: usize>(indices: [u32; N], mut orient: impl FnMut(usize) -> Sign) -> Sign {
    let mut order: [usize; N] = std::array::from_fn(|k| k);
    // By insertion: the standard library's sorts would be compiled for lists of any length.
    for i in 1..N {
        let mut j = i;
        while j > 0 && indices[order[j - 1]] > indices[order[j]] {
            order.swap(j - 1, j);
            j -= 1;
        }
    }
    // Raising the last argument's height moves it outside.
    let cofactor = |k: usize| if (N - k) % 2 == 1 { -orient(k) } else { orient(k) };
    order.into_iter().map(cofactor).find(|&sign| sign != 0).unwrap_or(0)
}

/// Returns the other items, in order, when item `k` is left out. `M` is `N` − 1.
#[inline]
pub fn without<T: Copy, const N: usize, const M: usize>(all: [T; N], k: usize) -> [T; M] {
    std::array::from_fn(|i| all[i + usize::from(i >= k)])
}
