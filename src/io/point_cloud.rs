//! Points as a file gives them.

use crate::io::FormatError;
use crate::{Error, Points};

/// Owned points in the precision of their file.
#[derive(Debug, Clone, PartialEq)]
pub enum PointBuf {
    /// Single precision.
    F32(Vec<[f32; 3]>),
    /// Double precision.
    F64(Vec<[f64; 3]>),
}

impl PointBuf {
    /// The number of points.
    pub fn len(&self) -> usize {
        Points::from(self).len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl<'a> From<&'a PointBuf> for Points<'a> {
    fn from(points: &'a PointBuf) -> Self {
        match points {
            PointBuf::F32(p) => p.into(),
            PointBuf::F64(p) => p.into(),
        }
    }
}

/// What a reader returns: all coordinates are finite.
#[derive(Debug, Clone, PartialEq)]
pub struct PointCloud {
    /// The points, in the file's order.
    pub points: PointBuf,
    /// How many points of the file are not in `points`, because their coordinates are NaN, which is how PCD marks
    /// "no return". Always 0 for other formats, where NaN is an error.
    pub no_return: usize,
}

impl PointCloud {
    /// The cloud of all of `points`.
    pub(crate) fn new(points: PointBuf) -> Result<Self, FormatError> {
        Self::without_no_return(points, 0)
    }

    /// The cloud of `points` where `no_return` others were left out.
    pub(crate) fn without_no_return(points: PointBuf, no_return: usize) -> Result<Self, FormatError> {
        match Points::from(&points).validate() {
            Ok(()) => Ok(PointCloud { points, no_return }),
            Err(Error::NotFinite { index, axis, value }) => Err(FormatError::point(
                index,
                format!("the {axis} coordinate is {value}, which is not a finite number"),
            )),
            Err(other) => Err(FormatError::point(0, other.to_string())),
        }
    }
}

impl<'a> From<&'a PointCloud> for Points<'a> {
    fn from(cloud: &'a PointCloud) -> Self {
        (&cloud.points).into()
    }
}

/// Collects points as `f64` and hands them out as `f32` when their file's type fits that exactly.
pub(crate) fn narrow(points: Vec<[f64; 3]>, single: bool) -> PointBuf {
    if single {
        PointBuf::F32(points.into_iter().map(|p| p.map(|x| x as f32)).collect())
    } else {
        PointBuf::F64(points)
    }
}
