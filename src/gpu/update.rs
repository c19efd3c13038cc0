//! When it pays to repair a mesh on a device whose points have moved.

use crate::stats::Restart;

/// Repairing so few simplices always pays.
const FEW: f64 = 8.0;

/// One in so many points is the most that may have been duplicates and are none any more: one
/// thread of the host inserts these.
pub(crate) const PARTED: usize = 16;

/// What it pays to repair; beyond that, a run from scratch is faster.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The number of flat or inverted simplices, by that of all.
    pub inverted: f64,
    /// The number of facets that are not locally Delaunay, by that of simplices.
    pub changed: f64,
    /// The number of restarts in a row after which only every fourth update looks at the mesh.
    pub attempts: u32,
}

impl Limits {
    /// No limits, for tests of the repair.
    pub const NONE: Limits = Limits { inverted: f64::INFINITY, changed: f64::INFINITY, attempts: u32::MAX };

    /// Returns the measured limits in `dimension` dimensions.
    ///
    /// In 3D they are reached by a million uniform points that move by 1.5 % of their mean spacing:
    /// beyond that, star splaying often gives up. In 2D, flips leave one inverted triangle in ten,
    /// and nothing repairs it.
    pub fn measured(dimension: usize) -> Self {
        match dimension {
            2 => Limits { inverted: 0.0, changed: 0.06, attempts: 2 },
            _ => Limits { inverted: 0.001, changed: 0.12, attempts: 2 },
        }
    }

    /// Returns the largest numbers of inverted simplices and changed facets, of so many simplices,
    /// that [`check`](Self::check) accepts.
    pub(crate) fn most(&self, simplices: f64) -> [u32; 2] {
        [self.inverted, self.changed].map(|share| (FEW + share * simplices) as u32)
    }

    /// Returns whether an update looks at the mesh, after this number of restarts in a row. Looking
    /// at a mesh whose points have moved too far takes a tenth of a run from scratch.
    pub(crate) fn looks_after(&self, restarts: u32) -> bool {
        restarts < self.attempts || restarts.is_multiple_of(4)
    }

    /// Returns an error if a run from scratch is faster than repairing so much of so many simplices.
    pub(crate) fn check(&self, inverted: f64, changed: f64, simplices: f64) -> Result<(), Restart> {
        if inverted > FEW + self.inverted * simplices {
            Err(Restart::Inverted)
        } else if changed > FEW + self.changed * simplices {
            Err(Restart::Changed)
        } else {
            Ok(())
        }
    }
}
