//! Geometric predicates: exact signs.
//!
//! Conventions, everywhere in this crate:
//!
//! * `orient3d(a, b, c, d)` is the sign of det(b − a, c − a, d − a): positive when a, b, c appear clockwise as seen
//!   from d; a tetrahedron is *positively oriented* when it is positive. (Shewchuk's `orient3d` has the opposite sign.)
//! * `insphere(a, b, c, d, e)` is positive when e lies inside the sphere through the positively oriented a, b, c, d;
//!   it changes sign with the orientation.
//! * `orient2d(a, b, c)` is positive when a, b, c turn counter-clockwise; `incircle(a, b, c, d)` is positive when d lies
//!   inside the circle through the counter-clockwise a, b, c.
//!
//! A sign is an `i8`: −1, 0 or 1.

/// −1, 0 or 1.
pub type Sign = i8;

/// The sign of det(b − a, c − a, d − a), exactly, for all finite coordinates.
pub fn orient3d(_a: [f64; 3], _b: [f64; 3], _c: [f64; 3], _d: [f64; 3]) -> Sign {
    todo!()
}

/// Positive when e is inside the sphere through the positively oriented a, b, c, d; exactly, for all finite coordinates.
pub fn insphere(_a: [f64; 3], _b: [f64; 3], _c: [f64; 3], _d: [f64; 3], _e: [f64; 3]) -> Sign {
    todo!()
}

/// Like [`insphere`], but never zero for distinct points that are not all coplanar: ties are broken as if point *i* had
/// the lifted height |pᵢ|² + δᵢ, δ₀ ≫ δ₁ ≫ …. `points` are (index, coordinates) with distinct indices.
pub fn insphere_symbolic(_points: [(u32, [f64; 3]); 5]) -> Sign {
    todo!()
}
