//! Geometric predicates: exact signs.
//!
//! Conventions, everywhere in this crate:
//!
//! * `orient3d(a, b, c, d)` is the sign of det(b − a, c − a, d − a). A tetrahedron is *positively oriented* when it is
//!   positive: a, b, c then turn counter-clockwise as seen from d. (Shewchuk's `orient3d` has the opposite sign.)
//! * `insphere(a, b, c, d, e)` is positive when e lies inside the sphere through the positively oriented a, b, c, d;
//!   it changes sign with the orientation.
//! * `orient2d(a, b, c)` is positive when a, b, c turn counter-clockwise; `incircle(a, b, c, d)` is positive when d lies
//!   inside the circle through the counter-clockwise a, b, c.
//!
//! [`exact`](mod@exact) decides signs of `f64` coordinates of any size, [`integer`] those of lattice coordinates,
//! [`symbolic`] breaks ties, and [`vertices`] puts a floating-point filter in front of them for a whole point set.

pub mod exact;
pub mod filter;
pub mod integer;
pub mod symbolic;

pub use exact::{collinear, incircle, insphere, orient2d, orient3d};
pub use symbolic::{incircle_symbolic, insphere_symbolic};

/// The sign of an exact value: −1, 0 or 1.
///
/// # Examples
///
/// ```
/// let sign: gdel::Sign = gdel::orient2d([0.0, 0.0], [1.0, 0.0], [2.0, 0.0]);
/// assert_eq!(sign, 0);
/// ```
pub type Sign = i8;
