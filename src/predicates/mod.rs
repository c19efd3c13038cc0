//! Geometric predicates with exact signs.
//!
//! Conventions, everywhere in this crate:
//!
//! * `orient3d(a, b, c, d)` is the sign of det(b − a, c − a, d − a). A tetrahedron is *positively
//!   oriented* if it is positive: a, b, c then turn counter-clockwise as seen from d. (Shewchuk's
//!   `orient3d` has the opposite sign.)
//! * `insphere(a, b, c, d, e)` is positive if e lies inside the sphere through the positively
//!   oriented a, b, c, d; it changes sign with the orientation.
//! * `orient2d(a, b, c)` is positive if a, b, c turn counter-clockwise, the *y* axis pointing up;
//!   `incircle(a, b, c, d)` is positive if d lies inside the circle through the counter-clockwise
//!   a, b, c; it changes sign with the orientation.
//!
//! [`exact`](mod@exact) evaluates predicates for `f64` coordinates of any size, [`integer`] for
//! lattice coordinates. [`symbolic`] breaks ties. [`filter`] puts floating-point filters in front
//! of them, for a whole point set. [`polynomial`] evaluates the rarer predicates of what is derived
//! from a triangulation. [`big`] has the integers that have no bound.

pub(crate) mod big;
pub mod exact;
pub mod filter;
pub mod integer;
pub(crate) mod polynomial;
pub mod symbolic;

pub use exact::{collinear, incircle, insphere, orient2d, orient3d};

/// The sign of an exact value: −1, 0 or 1.
///
/// # Examples
///
/// ```
/// let sign: gdel::Sign = gdel::orient2d([0.0, 0.0], [1.0, 0.0], [2.0, 0.0]);
/// assert_eq!(sign, 0);
/// ```
pub type Sign = i8;
