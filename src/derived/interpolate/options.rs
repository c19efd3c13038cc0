//! What is to be chosen for an interpolation.

/// How values are interpolated between vertices.
///
/// # Examples
///
/// ```
/// use gdel::{Interpolation, Interpolator, Locator};
///
/// // The centre of a square: linear interpolation sees only one of its two triangles.
/// let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let locator = Locator::new(&mesh, &points)?;
/// let interpolator = Interpolator::new(&locator, &[1.0, 0.0, 0.0, 0.0])?;
/// let at = |method| interpolator.interpolate(method, [0.5, 0.5]);
/// assert_eq!(at(Interpolation::Sibson)?, 0.25);
/// assert_eq!(at(Interpolation::Laplace)?, 0.25);
/// assert!([0.0, 0.5].contains(&at(Interpolation::Linear)?));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Interpolation {
    /// Barycentric coordinates in the simplex that contains the point: continuous, and the fastest.
    Linear,
    /// Natural neighbours, weighted by the measures of the facets that the point's Voronoi cell
    /// would have, divided by the distances (Belikov et al. 1997; Sugihara 1999): continuous, and
    /// smooth except where natural neighbours change and at the vertices.
    Laplace,
    /// Natural neighbours, weighted by what the point's Voronoi cell would take from theirs (Sibson
    /// 1981): smooth except at the vertices.
    Sibson,
    /// Sibson's C¹ interpolant (Sibson 1981), which adds gradients to his weights: smooth everywhere.
    SibsonC1,
    /// The Clough–Tocher interpolant (Alfeld 1984), a cubic in each third of a triangle: smooth everywhere, faster than
    /// natural neighbours, and what SciPy's `CloughTocher2DInterpolator` computes. In 2D, and for points in a
    /// plane or on a line.
    CloughTocher,
}

impl Interpolation {
    /// Returns whether the gradient of the interpolated values is continuous. Such a method uses the
    /// [gradients](crate::Interpolator::gradients) at the vertices, which depend on all values.
    pub fn is_smooth(self) -> bool {
        matches!(self, Interpolation::SibsonC1 | Interpolation::CloughTocher)
    }

    /// Returns the method whose weights this one uses.
    pub(super) fn of_weights(self) -> Self {
        match self {
            Interpolation::SibsonC1 => Interpolation::Sibson,
            Interpolation::CloughTocher => Interpolation::Linear,
            method => method,
        }
    }
}

/// Which value there is outside the convex hull, whatever the method.
///
/// # Examples
///
/// ```
/// use gdel::{Interpolation, Interpolator, Locator, Outside};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let locator = Locator::new(&mesh, &points)?;
/// let at = |outside| {
///     let interpolator = Interpolator::new(&locator, &[0.0, 1.0, 2.0])?.outside(outside);
///     interpolator.interpolate(Interpolation::Linear, [2.0, -1.0])
/// };
/// assert!(at(Outside::default())?.is_nan());
/// assert_eq!(at(Outside::Value(-1.0))?, -1.0);
/// assert_eq!(at(Outside::Nearest)?, 1.0);
/// assert_eq!(at(Outside::Linear)?, 0.0);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Outside {
    /// The same value everywhere, such as NaN, the default.
    Value(f64),
    /// The value of the nearest vertex; of several, that with the lowest index.
    Nearest,
    /// The value at the nearest place of the hull, and from there on along the gradient. That of a
    /// vertex is the mean of those of its simplices, weighted by their volumes, and within a facet it
    /// is interpolated. So the values are continuous, and linear functions go on as such.
    Linear,
}

impl Default for Outside {
    fn default() -> Self {
        Outside::Value(f64::NAN)
    }
}

/// Which value a vertex has if there are several points with its coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Duplicates {
    /// That of the first point, the one that stands for the others.
    #[default]
    First,
    /// The mean of the values of all.
    Mean,
    /// None: values that differ are an error.
    Error,
}
