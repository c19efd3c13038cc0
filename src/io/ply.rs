//! Stanford PLY.

use crate::io::{FormatError, PointBuf, PointCloud, mesh_data::Surface};
use crate::{Mesh3, Points};
use serde::{Deserialize, de::IgnoredAny};
use serde_ply::{DeserializeError, ElementDef, PlyFormat, PlyReader, PropertyType, ScalarType};
use std::io::{self, BufRead, ErrorKind, Read, Write};

#[derive(Deserialize)]
struct Vertex<T> {
    x: T,
    y: T,
    z: T,
}

impl<T> From<Vertex<T>> for [T; 3] {
    fn from(v: Vertex<T>) -> Self {
        [v.x, v.y, v.z]
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let mut rest = bytes;
    let format = match PlyReader::from_reader(&mut rest) {
        Ok(reader) => reader.header().format,
        Err(error) => {
            let read = &bytes[..bytes.len() - rest.len()];
            return Err(FormatError::line(line_of(read), describe(&error)));
        }
    };
    // serde-ply wants white space after every number, and not all files end with a line end. Binary data gets none, so
    // that a file that lacks its last byte is still found out.
    let line_end: &[u8] = if format == PlyFormat::Ascii { b"\n" } else { b"" };
    let mut input = Read::chain(bytes, line_end);
    read_elements(&mut input)
        .map_err(|error| {
            let (rest, _) = input.get_ref();
            let offset = bytes.len() - rest.len();
            match (error, format) {
                (ElementError::Header(what), _) => FormatError::line(1, what),
                (ElementError::Data(what), PlyFormat::Ascii) => FormatError::line(line_of(&bytes[..offset]), what),
                (ElementError::Data(what), _) => FormatError::byte(offset, what),
            }
        })
        .and_then(PointCloud::new)
}

enum ElementError {
    Header(String),
    Data(String),
}

fn read_elements(input: impl BufRead) -> Result<PointBuf, ElementError> {
    let data = |element: &str, error: &DeserializeError| ElementError::Data(format!("{element}: {}", describe(error)));
    let mut reader = PlyReader::from_reader(input).map_err(|error| data("header", &error))?;
    let elements = &reader.header().elem_defs;
    if let Some(endless) = elements.iter().find(|element| element.properties.is_empty() && element.count > 0) {
        // There would be no end of these: they take no bytes.
        return Err(ElementError::Header(format!("the element `{}` has no properties", endless.name)));
    }
    let vertex = elements.iter().position(|element| element.name == "vertex");
    let vertex = vertex.ok_or_else(|| ElementError::Header("there is no element `vertex`".into()))?;
    let is_single = coordinates_are_single(&elements[vertex]).map_err(ElementError::Header)?;
    let names: Vec<String> = elements.iter().map(|element| element.name.clone()).collect();

    let mut points = PointBuf::F32(Vec::new());
    for (i, name) in names.iter().enumerate() {
        let in_element = |error| data(name, &error);
        if i != vertex {
            // Those after the vertices are read too: a file that ends in them is broken, and its user should know.
            reader.next_element::<Skipped>().map_err(in_element)?;
        } else if is_single {
            let vertices = reader.next_element::<Vec<Vertex<f32>>>().map_err(in_element)?;
            points = PointBuf::F32(vertices.into_iter().map(Into::into).collect());
        } else {
            let vertices = reader.next_element::<Vec<Vertex<f64>>>().map_err(in_element)?;
            points = PointBuf::F64(vertices.into_iter().map(Into::into).collect());
        }
    }
    Ok(points)
}

/// Whether `f32` holds every value of x, y and z.
fn coordinates_are_single(vertex: &ElementDef) -> Result<bool, String> {
    let mut all_single = true;
    for axis in ["x", "y", "z"] {
        all_single &= match vertex.get_property(axis).map(|property| &property.property_type) {
            Some(PropertyType::Scalar(ScalarType::F64 | ScalarType::I32 | ScalarType::U32)) => false,
            Some(PropertyType::Scalar(_)) => true,
            Some(PropertyType::List { .. }) => return Err(format!("the vertices' property `{axis}` is a list")),
            None => return Err(format!("the vertices have no property `{axis}`")),
        };
    }
    Ok(all_single)
}

/// Rows of whatever properties, read and dropped.
struct Skipped;

impl<'de> Deserialize<'de> for Skipped {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Rows;
        impl<'de> serde::de::Visitor<'de> for Rows {
            type Value = Skipped;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("rows")
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut rows: A) -> Result<Skipped, A::Error> {
                while rows.next_element::<SkippedRow>()?.is_some() {}
                Ok(Skipped)
            }
        }
        deserializer.deserialize_seq(Rows)
    }
}

struct SkippedRow;

impl<'de> Deserialize<'de> for SkippedRow {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Row;
        impl<'de> serde::de::Visitor<'de> for Row {
            type Value = SkippedRow;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a row")
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, mut row: A) -> Result<SkippedRow, A::Error> {
                while row.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
                Ok(SkippedRow)
            }
        }
        deserializer.deserialize_map(Row)
    }
}

/// The number of the line that was last begun in what was read; the reader stops after the white space that ends a
/// number, so a line end there still belongs to the line.
fn line_of(read: &[u8]) -> usize {
    let read = read.strip_suffix(b"\n").unwrap_or(read);
    read.iter().filter(|&&b| b == b'\n').count() + 1
}

fn describe(error: &DeserializeError) -> String {
    match error.0.kind() {
        ErrorKind::UnexpectedEof => "the file ends before all that its header promises".into(),
        _ => error.to_string(),
    }
}

pub(super) fn write_points<W: Write>(mut to: W, points: Points<'_>) -> io::Result<()> {
    write_header(&mut to, matches!(points, Points::F32(_)), points.len())?;
    writeln!(to, "end_header")?;
    match points {
        Points::F32(p) => p.as_flattened().iter().try_for_each(|x| to.write_all(&x.to_le_bytes())),
        Points::F64(p) => p.as_flattened().iter().try_for_each(|x| to.write_all(&x.to_le_bytes())),
    }
}

/// Writes the hull as binary little-endian PLY, with the vertices of the hull only, in the points' precision.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_hull_ply<W: Write>(to: W, points: Points<'_>, mesh: &Mesh3) -> io::Result<()> {
    write_surface(to, points, &mesh.hull)
}

pub(super) fn write_surface(mut to: impl Write, points: Points<'_>, triangles: &[[u32; 3]]) -> io::Result<()> {
    let surface = Surface::new(points, triangles);
    write_header(&mut to, surface.is_single(), surface.vertices().len())?;
    writeln!(to, "element face {}\nproperty list uchar int vertex_indices\nend_header", triangles.len())?;
    for x in surface.vertices().flatten() {
        if surface.is_single() { to.write_all(&(x as f32).to_le_bytes())? } else { to.write_all(&x.to_le_bytes())? }
    }
    for triangle in surface.triangles() {
        to.write_all(&[3])?;
        triangle.iter().try_for_each(|v| to.write_all(&v.to_le_bytes()))?;
    }
    Ok(())
}

fn write_header(mut to: impl Write, is_single: bool, vertices: usize) -> io::Result<()> {
    writeln!(to, "ply\nformat binary_little_endian 1.0\ncomment gdel\nelement vertex {vertices}")?;
    let number = if is_single { "float" } else { "double" };
    ["x", "y", "z"].iter().try_for_each(|axis| writeln!(to, "property {number} {axis}"))
}
