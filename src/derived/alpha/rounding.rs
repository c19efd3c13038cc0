//! Radii that are equal up to the rounding of coordinates.

use super::{AlphaEdges, AlphaShape};
use crate::geometry::{Euclidean, Geometry, measure, vector};

/// By how much coordinates are taken to be off, in units of the largest one: a few roundings of `f64`.
pub(super) const UNIT: f64 = 2.0 * f64::EPSILON;

/// If a vertex may be off by more than this share of the inradius, the simplex is flat up to rounding, and may
/// have any radius: the root of [`UNIT`], about.
pub(super) const MAX_RATIO: f64 = 1.0 / (1u64 << 26) as f64;

impl<const D: usize, const N: usize> AlphaShape<D, N>
where
    Euclidean: AlphaEdges<D, N>,
{
    /// Returns the alpha that [`find_alpha`](Self::find_alpha) finds, raised to the largest radius that
    /// equals it up to the rounding of the points' coordinates. So the points of a sphere have its ball as
    /// their solid, although the last bits of the radii differ.
    ///
    /// # Examples
    ///
    /// ```
    /// // Cubes whose corners are rounded.
    /// let points: Vec<[f64; 3]> = (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(|x| f64::from(x) * 0.1)).collect();
    /// let mesh = gdel::delaunay3d(&points)?;
    /// let shape = gdel::AlphaShape::new(&mesh, &points)?;
    /// let alpha = shape.auto_alpha(1).unwrap();
    /// let volume: f64 = shape.at(alpha)?.solid().map(|t| mesh.volumes(&points).nth(t).unwrap()).sum();
    /// assert!((volume - 0.027).abs() < 1e-12);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn auto_alpha(&self, components: usize) -> Option<f64> {
        let t = self.first_with(components)?;
        let radius = self.radius_rounded_up(self.cell(t).0);
        Some(self.raised(radius, radius * (1.0 + self.tolerance(t))))
    }

    /// Returns the largest radius of a simplex that equals alpha up to the rounding of alpha and the
    /// points' coordinates, or alpha if it is larger. So alpha may be a radius that was written down in
    /// decimals.
    pub fn up_to_rounding(&self, alpha: f64) -> f64 {
        self.raised(alpha, alpha * (1.0 + 2.0 * f64::EPSILON))
    }

    /// Returns the largest radius of a simplex that may be as small as the limit, or alpha if it is larger.
    fn raised(&self, alpha: f64, limit: f64) -> f64 {
        let mut raised = alpha;
        for (t, (simplex, squared)) in self.cells().enumerate() {
            let is_above = |radius: f64| self.radii.compare_with(simplex, squared, self.radii.alpha(radius)) > 0;
            if is_above(raised) && !is_above(limit * (1.0 + self.tolerance(t))) {
                raised = self.radius_rounded_up(simplex);
            }
        }
        raised
    }

    /// Returns a bound of the relative difference between the circumradius of a simplex and that of the
    /// simplex whose coordinates were rounded to these; 0 if it is not small.
    ///
    /// Let each vertex p be at most η from where it was, c and r be the circumcentre and the circumradius of
    /// before, and ρ the inradius of now. Now |p − c|² = r² + s, where |s| ≤ 2·r·η + η². Let L be the affine
    /// function with these values s at the vertices, and g its gradient. Then |x − c|² − r² − L(x) is zero at
    /// all vertices, so that the circumradius of now has the square r² + L(c) + |g|²/4. Barycentric
    /// coordinates have gradients of length 1/h, where h are the heights, whose inverses add up to 1/ρ. At c
    /// they are at most (r + η)/h in size. So with x = η/ρ, |L(c)| ≤ x·(2·r + η)·(r + η) and
    /// |g| ≤ x·(2·r + η). The inscribed sphere of now is in the ball of radius r + η around c, so that
    /// η ≤ x·(r + η). For x up to 2⁻²⁶, the square is then between 1 ± 2.01·x times r², and the radius is off
    /// by less than 1.02·x times that of before and that of now.
    fn tolerance(&self, t: usize) -> f64 {
        if let Some(flat) = &self.flat {
            return flat.tolerance(t, &self.radii);
        }
        let corners = self.radii.mesh.complex.corners(t).map(|p| self.radii.scaled(p));
        let lengths = corners[1..].iter().map(|&p| vector::norm(vector::minus(p, corners[0])));
        // Less than what rounding may have added to the measure.
        let volume = measure(&corners) - 64.0 * f64::EPSILON * lengths.product::<f64>();
        let inradius = D as f64 * volume / Euclidean::boundary_measure(&corners);
        let ratio = self.radii.rounding / inradius;
        if inradius > 0.0 && ratio < MAX_RATIO { 1.02 * ratio } else { 0.0 }
    }
}
