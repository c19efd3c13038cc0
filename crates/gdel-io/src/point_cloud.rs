//! Points as a file gives them.

use crate::{FormatError, PointColors, colors::Colors};
use gdel::{Error, Points};

/// Owned points in the precision of their file.
#[derive(Debug, Clone, PartialEq)]
pub enum PointBuf<const D: usize = 3> {
    /// Single precision.
    F32(Vec<[f32; D]>),
    /// Double precision.
    F64(Vec<[f64; D]>),
}

impl<const D: usize> PointBuf<D> {
    /// Returns the number of points.
    pub fn len(&self) -> usize {
        Points::from(self).len()
    }

    /// Returns whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Keeps the first `E` coordinates of each point; those that a point lacks become 0.
    pub(super) fn resize<const E: usize>(self) -> PointBuf<E> {
        match self {
            PointBuf::F32(points) => PointBuf::F32(points.into_iter().map(resized).collect()),
            PointBuf::F64(points) => PointBuf::F64(points.into_iter().map(resized).collect()),
        }
    }
}

impl<'a, const D: usize> From<&'a PointBuf<D>> for Points<'a, D> {
    fn from(points: &'a PointBuf<D>) -> Self {
        match points {
            PointBuf::F32(p) => Points::F32(p),
            PointBuf::F64(p) => Points::F64(p),
        }
    }
}

/// The points of a file, with finite coordinates, and what else was found in the file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PointCloud<const D: usize = 3> {
    /// The points, in the file's order.
    pub points: PointBuf<D>,
    /// How many points of the file are not in `points`, because it says that they have no
    /// coordinates: by NaN in PCD, by their state in E57, by three zeros in PTX. Always 0 for other formats; NaN is an
    /// error in all but PCD.
    pub no_return: usize,
    /// How many columns of a text file were ignored: those after the coordinates. Always 0 for
    /// formats that name their columns.
    pub ignored_columns: usize,
    /// Whether these are 2D points of a file whose *z* coordinates are not all 0.
    pub dropped_z: bool,
    /// The points' colours, or values that can stand for them; `None` if the file has none, or if
    /// all points have the same.
    pub colors: Option<PointColors>,
    /// The points' normals, of length 1, or zero where one is unknown; `None` if the file has none.
    pub normals: Option<Vec<[f32; D]>>,
    /// The positions of the sensor: one for each point, or one for all; empty if the file has none.
    pub sensors: Vec<[f64; D]>,
}

impl<const D: usize> PointCloud<D> {
    /// Creates the cloud of all of `points`.
    pub(super) fn new(points: PointBuf<D>) -> Result<Self, FormatError> {
        match Points::from(&points).validate() {
            Ok(()) => Ok(PointCloud {
                points,
                no_return: 0,
                ignored_columns: 0,
                dropped_z: false,
                colors: None,
                normals: None,
                sensors: Vec::new(),
            }),
            Err(Error::NotFinite { index, axis, value }) => Err(FormatError::point(
                index,
                format!("the {axis} coordinate is {value}, which is not a finite number"),
            )),
            Err(other) => Err(FormatError::point(0, other.to_string())),
        }
    }

    /// Adds the colours and normals of the points.
    pub(super) fn colored(self, mut colors: Colors) -> Self {
        let found = colors.finish();
        let normals = colors.take_normals().map(|normals| normals.into_iter().map(resized).collect());
        PointCloud { colors: found, normals, ..self }
    }

    /// Returns the cloud with other points for the same rows of the file, without normals and sensors.
    pub fn with_points<const E: usize>(self, points: Vec<[f64; E]>) -> PointCloud<E> {
        PointCloud {
            points: PointBuf::F64(points),
            no_return: self.no_return,
            ignored_columns: self.ignored_columns,
            dropped_z: self.dropped_z,
            colors: self.colors,
            normals: None,
            sensors: Vec::new(),
        }
    }

    /// Keeps the first `E` coordinates of each point.
    pub(super) fn resize<const E: usize>(self) -> PointCloud<E> {
        let loses_z = E < 3 && Points::from(&self.points).iter().any(|p| p.get(2).is_some_and(|&z| z != 0.0));
        PointCloud {
            points: self.points.resize(),
            no_return: self.no_return,
            ignored_columns: self.ignored_columns,
            dropped_z: self.dropped_z || loses_z,
            colors: self.colors,
            normals: self.normals.map(|normals| normals.into_iter().map(resized).collect()),
            sensors: self.sensors.into_iter().map(resized).collect(),
        }
    }
}

impl<'a, const D: usize> From<&'a PointCloud<D>> for Points<'a, D> {
    fn from(cloud: &'a PointCloud<D>) -> Self {
        (&cloud.points).into()
    }
}

/// Returns the first `E` coordinates; those that are lacking are 0.
fn resized<T: Copy + Default, const D: usize, const E: usize>(p: [T; D]) -> [T; E] {
    std::array::from_fn(|k| p.get(k).copied().unwrap_or_default())
}

/// Collects points as `f64` and hands them out as `f32` when their file's type fits that exactly.
pub(super) fn narrow<const D: usize>(points: Vec<[f64; D]>, single: bool) -> PointBuf<D> {
    if single {
        PointBuf::F32(points.into_iter().map(|p| p.map(|x| x as f32)).collect())
    } else {
        PointBuf::F64(points)
    }
}
