//! ASTM E57, by the crate `e57`.
//!
//! The crate does not panic, but allocates what a broken file promises, so sizes are checked here
//! first. Of its two readers, the one of raw values is used: the other stops at a packet that does
//! not complete a point.

use crate::{
    FormatError, PointCloud,
    colors::{CHANNELS, Colors, INTENSITY, NORMAL, Range, Sample},
    point_cloud::narrow,
};
use ::e57::{E57Reader, Error, Header, PointCloud as Scan, RecordDataType, RecordName, RecordValue};
use glam::{DAffine3, DQuat, DVec3};
use std::io::Cursor;

/// The bytes of the header.
const HEADER: usize = 48;

/// Reads the points of all scans in the coordinate system of the file.
pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    if bytes.len() < HEADER {
        return Err(FormatError::byte(bytes.len(), "the file ends within its header: it is truncated"));
    }
    let header = Header::read(&mut &*bytes).map_err(|error| in_header(&error))?;
    if header.xml_length > bytes.len() as u64 {
        let what = format!("the file ends here, but its header promises {} bytes of XML", header.xml_length);
        return Err(FormatError::byte(bytes.len(), what));
    }
    let mut reader = E57Reader::new(Cursor::new(bytes)).map_err(|error| in_header(&error))?;
    let scans: Vec<Scan> = reader.pointclouds().into_iter().filter(|scan| scan.records > 0).collect();
    check_counts(&scans, bytes.len())?;

    let mut points = Vec::new();
    let has_normals = scans.iter().any(|scan| normal_columns(scan).is_some());
    let has = std::array::from_fn(|channel| channel <= INTENSITY || has_normals);
    let mut colors = Colors::new(has, Range::Fractions);
    let mut sensors = Sensors::new(&scans);
    let mut no_return = 0;
    let mut is_single = true;
    for scan in &scans {
        let start = points.len() + no_return;
        let columns = Columns::find(scan).map_err(|what| FormatError::point(start, what))?;
        let tints = Tints::find(scan);
        let pose = pose(scan).map_err(|what| FormatError::point(start, what))?;
        is_single &= pose.is_none() && columns.are_single(scan);
        let in_points = |error: Error, place| FormatError::point(place, described(&error));
        let records = reader.pointcloud_raw(scan).map_err(|error| in_points(error, start))?;
        for record in records {
            let place = points.len() + no_return;
            let record = record.map_err(|error| in_points(error, place))?;
            match columns.point(scan, &record).map_err(|error| in_points(error, place))? {
                Some(point) => {
                    points.push(pose.map_or(point, |pose| pose.transform_point3(point.into()).into()));
                    let mut sample = tints.sample(scan, &record);
                    if let Some(pose) = pose {
                        let normal = sample[NORMAL..].first_chunk().copied().unwrap_or_default();
                        let turned: [f64; 3] = pose.transform_vector3(DVec3::from_array(normal)).into();
                        sample[NORMAL..].copy_from_slice(&turned);
                    }
                    colors.push(&sample);
                    sensors.push(pose);
                }
                None => no_return += 1,
            }
        }
    }
    let cloud = PointCloud::new(narrow(points, is_single))?.colored(colors);
    Ok(PointCloud { no_return, sensors: sensors.finish(), ..cloud })
}

/// The positions of the scanner, which is at the origin of each scan. They are taken only if the file
/// has poses that are not all the identity, or spherical coordinates: clouds of many scans have neither.
struct Sensors {
    are_known: bool,
    all: Vec<[f64; 3]>,
}

impl Sensors {
    fn new(scans: &[Scan]) -> Self {
        let has_column = |scan: &Scan, name| scan.prototype.iter().any(|column| column.name == name);
        let is_spherical = |scan: &Scan| has_column(scan, RecordName::SphericalRange);
        let has_pose = |scan: &Scan| matches!(pose(scan), Ok(Some(_)));
        // In a file of several scans, the system of one of them may be that of the file.
        let are_known = scans.iter().any(|scan| has_pose(scan) || is_spherical(scan))
            && scans.iter().all(|scan| scan.transform.is_some() || is_spherical(scan));
        Sensors { are_known, all: Vec::new() }
    }

    /// Adds the position for the next point.
    fn push(&mut self, pose: Option<DAffine3>) {
        if self.are_known {
            self.all.push(pose.map_or([0.0; 3], |pose| pose.translation.into()));
        }
    }

    fn finish(mut self) -> Vec<[f64; 3]> {
        if self.all.iter().all(|position| *position == self.all[0]) {
            // One for all.
            self.all.truncate(1);
        }
        self.all
    }
}

/// Returns the columns of the normals, which are an extension of the format.
fn normal_columns(scan: &Scan) -> Option<[usize; 3]> {
    let column = |wanted: &str| {
        let is_wanted = |name: &RecordName| match name {
            RecordName::Unknown { name, .. } => name.eq_ignore_ascii_case(wanted),
            _ => false,
        };
        scan.prototype.iter().position(|column| is_wanted(&column.name))
    };
    let [x, y, z] = ["normalX", "normalY", "normalZ"].map(column);
    Some([x?, y?, z?])
}

/// Compares the numbers of points that the scans promise with the file's `size`, which bounds the
/// memory for them.
fn check_counts(scans: &[Scan], size: usize) -> Result<(), FormatError> {
    let mut promised: u128 = 0;
    for scan in scans {
        let bits: u64 = scan.prototype.iter().map(|column| bits(&column.data_type)).sum();
        // A column whose values are all the same takes no bits in the file, but as much memory as
        // any other.
        if 4 * bits < scan.prototype.len() as u64 {
            let what = format!("points of {} columns cannot be made of {bits} bits", scan.prototype.len());
            return Err(FormatError::byte(0, what));
        }
        promised += u128::from(scan.records) * u128::from(bits);
    }
    if promised.div_ceil(8) > size as u128 {
        let points: u128 = scans.iter().map(|scan| u128::from(scan.records)).sum();
        return Err(FormatError::byte(size, format!("the file ends here, but its header promises {points} points")));
    }
    Ok(())
}

/// Returns how many bits a value of a column takes in the file.
fn bits(kind: &RecordDataType) -> u64 {
    match *kind {
        RecordDataType::Single { .. } => 32,
        RecordDataType::Double { .. } => 64,
        RecordDataType::Integer { min, max } | RecordDataType::ScaledInteger { min, max, .. } => {
            max.abs_diff(min).checked_ilog2().map_or(0, |bits| u64::from(bits) + 1)
        }
    }
}

/// Returns the transformation from a scan's coordinates to those of the file, unless they are the
/// same.
fn pose(scan: &Scan) -> Result<Option<DAffine3>, &'static str> {
    let Some(pose) = &scan.transform else { return Ok(None) };
    let (q, t) = (&pose.rotation, &pose.translation);
    let rotation = DQuat::from_xyzw(q.x, q.y, q.z, q.w);
    let length = rotation.length();
    if !(length > 0.0 && length.is_finite()) {
        return Err("the pose of the scan that starts here has no rotation");
    }
    let pose = DAffine3::from_rotation_translation(rotation / length, DVec3::new(t.x, t.y, t.z));
    Ok((pose != DAffine3::IDENTITY).then_some(pose))
}

/// The columns of three coordinates, and the one that says which of them are meaningful.
struct System {
    axes: [usize; 3],
    state: Option<usize>,
}

impl System {
    fn find(scan: &Scan, axes: [RecordName; 3], state: RecordName) -> Option<Self> {
        let column = |name| scan.prototype.iter().position(|column| column.name == name);
        let [a, b, c] = axes.map(column);
        Some(System { axes: [a?, b?, c?], state: column(state) })
    }

    /// Returns the coordinates of a point, or `None` where the file says that one of them means
    /// nothing.
    fn coordinates(&self, scan: &Scan, record: &[RecordValue]) -> Result<Option<[f64; 3]>, Error> {
        let kind = |column: usize| &scan.prototype[column].data_type;
        if let Some(state) = self.state
            && record[state].to_i64(kind(state))? != 0
        {
            return Ok(None);
        }
        let [a, b, c] = self.axes.map(|axis| record[axis].to_f64(kind(axis)));
        Ok(Some([a?, b?, c?]))
    }
}

/// Where a scan has the coordinates of its points: a point may have those of either system.
struct Columns {
    cartesian: Option<System>,
    /// Range, azimuth, elevation.
    spherical: Option<System>,
}

impl Columns {
    fn find(scan: &Scan) -> Result<Self, &'static str> {
        use RecordName::*;
        let cartesian = System::find(scan, [CartesianX, CartesianY, CartesianZ], CartesianInvalidState);
        let spherical =
            System::find(scan, [SphericalRange, SphericalAzimuth, SphericalElevation], SphericalInvalidState);
        if cartesian.is_none() && spherical.is_none() {
            return Err("the scan that starts here has neither Cartesian nor spherical coordinates");
        }
        Ok(Columns { cartesian, spherical })
    }

    /// Returns whether single precision holds all coordinates.
    fn are_single(&self, scan: &Scan) -> bool {
        let is_single = |&axis: &usize| matches!(scan.prototype[axis].data_type, RecordDataType::Single { .. });
        self.spherical.is_none() && self.cartesian.as_ref().is_some_and(|system| system.axes.iter().all(is_single))
    }

    /// Returns a point in the coordinate system of its scan, unless it has no return.
    fn point(&self, scan: &Scan, record: &[RecordValue]) -> Result<Option<[f64; 3]>, Error> {
        let of = |system: &Option<System>| match system {
            Some(system) => system.coordinates(scan, record),
            None => Ok(None),
        };
        if let Some(point) = of(&self.cartesian)? {
            return Ok(Some(point));
        }
        Ok(of(&self.spherical)?.map(|[range, azimuth, elevation]| {
            // `libm` gives the same results on every machine, unlike the standard library.
            let ((sin_a, cos_a), (sin_e, cos_e)) = (libm::sincos(azimuth), libm::sincos(elevation));
            [range * cos_e * cos_a, range * cos_e * sin_a, range * sin_e]
        }))
    }
}

/// The columns of a scan that say something about the colours of its points, with the numbers that
/// stand for no and for full light.
struct Tints {
    /// Red, green, blue and intensity.
    columns: [Option<(usize, f64, f64)>; INTENSITY + 1],
    /// The columns that say which colours and intensities mean nothing.
    invalid: [Option<usize>; 2],
    normal: Option<[usize; 3]>,
}

impl Tints {
    fn find(scan: &Scan) -> Self {
        use RecordName::*;
        let column = |name| scan.prototype.iter().position(|column| column.name == name);
        let columns = [ColorRed, ColorGreen, ColorBlue, Intensity].map(|name| {
            let column = column(name)?;
            let (low, high) = match scan.prototype[column].data_type {
                RecordDataType::Integer { min, max } => (min as f64, max as f64),
                RecordDataType::ScaledInteger { min, max, scale, offset } => {
                    (min as f64 * scale + offset, max as f64 * scale + offset)
                }
                RecordDataType::Single { min, max } => (min.unwrap_or(0.0).into(), max.map_or(1.0, f64::from)),
                RecordDataType::Double { min, max } => (min.unwrap_or(0.0), max.unwrap_or(1.0)),
            };
            Some((column, low, high))
        });
        Tints { columns, invalid: [column(IsColorInvalid), column(IsIntensityInvalid)], normal: normal_columns(scan) }
    }

    /// Returns the colours of a record as shares of full light, and its intensity and normal unchanged.
    fn sample(&self, scan: &Scan, record: &[RecordValue]) -> Sample {
        let kind = |column: usize| &scan.prototype[column].data_type;
        let invalid = self.invalid.map(|column| {
            column.is_some_and(|column| record[column].to_i64(kind(column)).is_ok_and(|invalid| invalid != 0))
        });
        let mut sample = [f64::NAN; CHANNELS];
        for (channel, column) in self.columns.iter().enumerate() {
            let Some((column, low, high)) = *column else { continue };
            let is_intensity = channel == INTENSITY;
            if invalid[usize::from(is_intensity)] {
                continue;
            }
            let Ok(value) = record[column].to_f64(kind(column)) else { continue };
            sample[channel] = if is_intensity { value } else { ((value - low) / (high - low)).clamp(0.0, 1.0) };
        }
        for (axis, &column) in self.normal.iter().flatten().enumerate() {
            sample[NORMAL + axis] = record[column].to_f64(kind(column)).unwrap_or(f64::NAN);
        }
        sample
    }
}

/// Describes an error of the crate before the points.
fn in_header(error: &Error) -> FormatError {
    FormatError::byte(0, format!("not an E57 file that can be read: {}", described(error)))
}

/// Returns the text of an error without its kind, and short, since it may quote the file.
fn described(error: &Error) -> String {
    let text = error.to_string();
    text.split_once(": ").map_or(text.as_str(), |(_, what)| what).chars().take(300).collect()
}
