//! Points in NumPy's archives: those of meshes and of tables.

use crate::{FormatError, PointBuf, PointCloud, error::quote, npz};
use std::io::Cursor;

/// Reads the array `points`, or arrays `x`, `y` and `z`, as tables have them, and the array with a name, if one is wanted.
pub(super) fn read_points<const D: usize>(
    bytes: &[u8],
    wanted: Option<&str>,
) -> Result<(PointCloud<D>, Vec<f64>), FormatError> {
    let mut archive = npz::open(Cursor::new(bytes))?;
    let cloud = match npz::read_array(&mut archive, "points", |array| array.points())? {
        Some(cloud) => cloud,
        None => {
            let mut axes = [const { None }; 3];
            for (axis, name) in axes.iter_mut().zip(["x", "y", "z"]) {
                *axis = npz::read_array(&mut archive, name, |array| array.numbers())?;
            }
            from_axes(axes)?
        }
    };
    let values = wanted.map(|name| {
        let found = npz::read_array(&mut archive, name, |array| array.numbers())?;
        found.ok_or_else(|| FormatError::byte(0, format!("the archive has no array {}", quote(name.as_bytes()))))
    });
    Ok((cloud, values.transpose()?.unwrap_or_default()))
}

/// Returns the points of coordinates per axis; of 2D points, those along the third are dropped.
fn from_axes<const D: usize>(axes: [Option<Vec<f64>>; 3]) -> Result<PointCloud<D>, FormatError> {
    let missing = || FormatError::byte(0, "the archive has no array `points`, and none for each coordinate");
    let given = axes[..D].iter().map(|axis| axis.as_deref()).collect::<Option<Vec<_>>>().ok_or_else(missing)?;
    if given.iter().any(|axis| axis.len() != given[0].len()) {
        return Err(FormatError::byte(0, "the arrays of coordinates have different lengths"));
    }
    let points = (0..given[0].len()).map(|i| std::array::from_fn(|axis| given[axis][i])).collect();
    let dropped_z = D == 2 && axes[2].iter().flatten().any(|&z| z != 0.0);
    Ok(PointCloud { dropped_z, ..PointCloud::new(PointBuf::F64(points))? })
}
