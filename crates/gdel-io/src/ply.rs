//! Stanford PLY.
//!
//! Read here because the errors of `serde-ply` name Rust's types where a user needs the place and
//! the cause, and because it takes no lines that end in `\r`.

use crate::{
    FormatError, PointCloud,
    colors::{CHANNELS, Colors, Range, Sample, channel},
    error::quote,
    point_cloud::narrow,
    scalar::Scalar,
    surface::{MARK, Surface, padded},
    text::{by_number, line_at, split_line},
};
use gdel::Points;
use std::io::{self, Write};

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a property.
#[derive(Clone, Copy)]
enum Kind {
    Number(Scalar),
    List { count: Scalar, item: Scalar },
}

struct Property {
    name: Vec<u8>,
    kind: Kind,
}

struct Element {
    name: Vec<u8>,
    count: usize,
    properties: Vec<Property>,
    /// The line of the header that declares it.
    line: usize,
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    /// The offset of the data, in bytes.
    offset: usize,
}

pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    read_with_values(bytes, None).map(|(cloud, _)| cloud)
}

/// Reads the same, and the property of the vertices with a name or a number, counted from 1, if one is wanted.
pub(super) fn read_with_values(bytes: &[u8], wanted: Option<&str>) -> Result<(PointCloud, Vec<f64>), FormatError> {
    let header = Header::parse(bytes)?;
    let mut vertices = header.elements.iter().filter(|element| element.name == b"vertex");
    let vertex = match (vertices.next(), vertices.next()) {
        (Some(vertex), None) => vertex,
        (None, _) => return Err(FormatError::line(1, "the header declares no element `vertex`")),
        (_, Some(second)) => return Err(FormatError::line(second.line, "a second element `vertex`")),
    };
    let is_single = vertex.coordinates_are_single()?;
    let wanted = wanted.map(|name| vertex.place_of(name)).transpose()?;
    let mut colors = vertex.colors();
    let mut data = Data { bytes, at: header.offset, encoding: header.encoding };
    let (mut points, mut values) = (Vec::new(), Vec::new());
    // Elements after the vertices are read too: a file that ends in them is broken, and its user
    // should know.
    for element in &header.elements {
        let is_vertex = element.name == b"vertex";
        let roles: Vec<Option<Role>> =
            element.properties.iter().map(|property| Role::of(&property.name).filter(|_| is_vertex)).collect();
        let mut sample: Sample = [f64::NAN; CHANNELS];
        for index in 0..element.count {
            let mut point = [0.0; 3];
            for (place, (property, role)) in element.properties.iter().zip(&roles).enumerate() {
                let ends = |data: &Data<'_>| data.ends(element, index);
                let scalar = match property.kind {
                    Kind::Number(scalar) => scalar,
                    Kind::List { count, item } => {
                        data.skip_list(count, item)?.ok_or_else(|| ends(&data))?;
                        continue;
                    }
                };
                let number = data.number(scalar)?.ok_or_else(|| ends(&data))?;
                match *role {
                    Some(Role::Axis(axis)) => point[axis] = number,
                    Some(Role::Channel(channel)) => sample[channel] = number,
                    None => {}
                }
                if is_vertex && wanted == Some(place) {
                    values.push(number);
                }
            }
            if is_vertex {
                points.push(point);
                colors.push(&sample);
            }
        }
    }
    if let Some(more) = data.word().filter(|_| header.encoding == Encoding::Ascii) {
        let what = format!("{} goes on after all that the header promises", quote(more));
        return Err(data.error(what));
    }
    Ok((PointCloud::new(narrow(points, is_single))?.colored(colors), values))
}

/// The meaning of a vertex property.
#[derive(Clone, Copy)]
enum Role {
    Axis(usize),
    Channel(usize),
}

impl Role {
    fn of(name: &[u8]) -> Option<Self> {
        let axis = [b"x", b"y", b"z"].iter().position(|axis| *axis == name);
        axis.map(Role::Axis).or_else(|| channel(name).map(Role::Channel))
    }
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Self, FormatError> {
        // The lone `\r` of old Macintosh programs: a `\n` after the header's end is data.
        let ends_in_cr = bytes.starts_with(b"ply\r") && bytes.get(4) != Some(&b'\n');
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut rest = bytes;
        for line in 1.. {
            let (content, next) = split_line(rest);
            let words: Vec<&[u8]> = content.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
            let wrong = |what: String| Err(FormatError::line(line, what));
            match words.as_slice() {
                [b"ply"] if line == 1 => {}
                _ if line == 1 => {
                    return wrong(format!("not PLY: the first line is not `ply`, but {}", quote(content)));
                }
                [b"comment" | b"obj_info", ..] | [] => {}
                [b"format", name, b"1.0"] => {
                    encoding = Some(match *name {
                        b"ascii" => Encoding::Ascii,
                        b"binary_little_endian" => Encoding::LittleEndian,
                        b"binary_big_endian" => Encoding::BigEndian,
                        _ => return wrong(format!("the format {} is not known", quote(name))),
                    });
                }
                [b"format", ..] => return wrong("`format NAME 1.0` expected".into()),
                [b"element", name, count] => {
                    let Some(count) = std::str::from_utf8(count).ok().and_then(|text| text.parse().ok()) else {
                        return wrong(format!("{} is not a count of {}", quote(count), quote(name)));
                    };
                    elements.push(Element { name: name.to_vec(), count, properties: Vec::new(), line });
                }
                [b"property", declaration @ ..] => {
                    let Some(element) = elements.last_mut() else {
                        return wrong("a property before the first element".into());
                    };
                    match property(declaration) {
                        Ok(property) => element.properties.push(property),
                        Err(what) => return wrong(what),
                    }
                }
                [b"end_header"] => {
                    let Some(encoding) = encoding else {
                        return wrong("the header ends without a line `format`".into());
                    };
                    if let Some(endless) = elements.iter().find(|e| e.properties.is_empty() && e.count > 0) {
                        // These take no bytes, so any number of them would fit.
                        let what = format!("the element {} has no properties", quote(&endless.name));
                        return Err(FormatError::line(endless.line, what));
                    }
                    let end = bytes.len() - rest.len() + content.len() + 1;
                    let offset = if ends_in_cr { end } else { bytes.len() - next.len() };
                    return Ok(Header { encoding, elements, offset: offset.min(bytes.len()) });
                }
                _ => return wrong(format!("{} is not a line of a PLY header", quote(content))),
            }
            if next.is_empty() {
                return wrong("the file ends before its header does, which is at a line `end_header`".into());
            }
            rest = next;
        }
        Err(FormatError::line(1, "the header has no end"))
    }
}

/// Parses what follows `property`.
fn property(declaration: &[&[u8]]) -> Result<Property, String> {
    let scalar = |word: &[u8]| {
        Ok(match word {
            b"char" | b"int8" => Scalar::I8,
            b"uchar" | b"uint8" => Scalar::U8,
            b"short" | b"int16" => Scalar::I16,
            b"ushort" | b"uint16" => Scalar::U16,
            b"int" | b"int32" => Scalar::I32,
            b"uint" | b"uint32" => Scalar::U32,
            b"float" | b"float32" => Scalar::F32,
            b"double" | b"float64" => Scalar::F64,
            _ => return Err(format!("the type {} is not known", quote(word))),
        })
    };
    match *declaration {
        [b"list", count, item, name] => {
            let count = Some(scalar(count)?).filter(|count| count.is_integer());
            let count = count.ok_or("the length of a list must be of a type of whole numbers")?;
            Ok(Property { name: name.to_vec(), kind: Kind::List { count, item: scalar(item)? } })
        }
        [kind, name] => Ok(Property { name: name.to_vec(), kind: Kind::Number(scalar(kind)?) }),
        _ => Err("`property TYPE NAME` or `property list TYPE TYPE NAME` expected".into()),
    }
}

impl Element {
    /// Returns whether `f32` holds every value of x, y and z.
    fn coordinates_are_single(&self) -> Result<bool, FormatError> {
        let mut are_single = true;
        for name in ["x", "y", "z"] {
            let wrong = |what: &str| FormatError::line(self.line, format!("the vertices {what} `{name}`"));
            let mut properties = self.properties.iter().filter(|property| property.name == name.as_bytes());
            are_single &= match (properties.next().map(|property| property.kind), properties.next()) {
                (Some(Kind::Number(scalar)), None) => scalar.is_single(),
                (Some(Kind::List { .. }), None) => return Err(wrong("have a list as property")),
                (None, _) => return Err(wrong("have no property")),
                (_, Some(_)) => return Err(wrong("have more than one property")),
            };
        }
        Ok(are_single)
    }

    /// Returns the place of the property of a name or a number, counted from 1, which has to be a number.
    fn place_of(&self, name: &str) -> Result<usize, FormatError> {
        let named = self.properties.iter().position(|property| property.name == name.as_bytes());
        let place = match named {
            Some(place) => place,
            None => by_number(name, self.line)?,
        };
        match self.properties.get(place).map(|property| property.kind) {
            Some(Kind::Number(_)) => Ok(place),
            Some(Kind::List { .. }) => {
                Err(FormatError::line(self.line, format!("the property {} is a list", quote(name.as_bytes()))))
            }
            None => Err(FormatError::line(self.line, format!("the vertices have no property {}", place + 1))),
        }
    }

    /// Begins to gather the vertices' colours.
    fn colors(&self) -> Colors {
        let mut kinds = [None; CHANNELS];
        for Property { name, kind } in &self.properties {
            if let (Some(channel), Kind::Number(scalar)) = (channel(name), kind) {
                kinds[channel] = Some(*scalar);
            }
        }
        let range = match kinds[0] {
            Some(Scalar::I8 | Scalar::U8) => Range::Bytes,
            Some(Scalar::F32 | Scalar::F64) => Range::Fractions,
            _ => Range::Words,
        };
        Colors::new(kinds.map(|kind| kind.is_some()), range)
    }
}

/// The numbers of a file, from the byte `at` on.
struct Data<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: Encoding,
}

impl<'a> Data<'a> {
    /// Returns the next word of text.
    fn word(&mut self) -> Option<&'a [u8]> {
        let start = self.at + self.bytes[self.at..].iter().position(|b| !b.is_ascii_whitespace())?;
        let word = &self.bytes[start..];
        let word = &word[..word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len())];
        self.at = start + word.len();
        Some(word)
    }

    /// Returns the next number; `None` where the file ends before it.
    fn number(&mut self, scalar: Scalar) -> Result<Option<f64>, FormatError> {
        if self.encoding != Encoding::Ascii {
            let Some(bytes) = self.bytes[self.at..].get(..scalar.size()) else { return Ok(None) };
            self.at += bytes.len();
            return Ok(Some(scalar.decode(bytes, self.encoding == Encoding::BigEndian)));
        }
        let Some(word) = self.word() else { return Ok(None) };
        let number = scalar.parse(word).ok_or_else(|| self.error(format!("{} is not a number", quote(word))))?;
        Ok(Some(number))
    }

    /// Skips a list; returns `None` if the file ends in it.
    fn skip_list(&mut self, count: Scalar, item: Scalar) -> Result<Option<()>, FormatError> {
        let Some(length) = self.number(count)? else { return Ok(None) };
        if length < 0.0 || length.fract() != 0.0 {
            return Err(self.error(format!("a list of {length} entries")));
        }
        let length = length as usize;
        if self.encoding != Encoding::Ascii {
            let size = length.checked_mul(item.size()).filter(|&size| size <= self.bytes.len() - self.at);
            return Ok(size.map(|size| self.at += size));
        }
        for _ in 0..length {
            if self.number(item)?.is_none() {
                return Ok(None);
            }
        }
        Ok(Some(()))
    }

    /// Creates the error of what was read last.
    fn error(&self, what: String) -> FormatError {
        match self.encoding {
            Encoding::Ascii => FormatError::line(line_at(self.bytes, self.at.saturating_sub(1)), what),
            _ => FormatError::byte(self.at, what),
        }
    }

    fn ends(&self, element: &Element, index: usize) -> FormatError {
        let (name, count) = (quote(&element.name), element.count);
        let what = format!("the file ends before all {count} of its elements {name}: only {index} are complete");
        match self.encoding {
            Encoding::Ascii => FormatError::line(line_at(self.bytes, self.bytes.len().saturating_sub(1)), what),
            _ => FormatError::byte(self.bytes.len(), what),
        }
    }
}

pub(super) fn write_points<const D: usize>(mut to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    write_header(&mut to, "gdel", matches!(points, Points::F32(_)), points.len())?;
    writeln!(to, "end_header")?;
    let vertices = points.iter().map(padded);
    write_vertices(to, vertices, matches!(points, Points::F32(_)))
}

fn write_vertices(mut to: impl Write, mut vertices: impl Iterator<Item = [f64; 3]>, is_single: bool) -> io::Result<()> {
    vertices.try_for_each(|p| {
        p.iter().try_for_each(|&x| match is_single {
            true => to.write_all(&(x as f32).to_le_bytes()),
            false => to.write_all(&x.to_le_bytes()),
        })
    })
}

pub(super) fn write_surface<const D: usize>(mut to: impl Write, surface: &Surface<'_, D>) -> io::Result<()> {
    write_header(&mut to, &format!("{MARK}: {}", surface.name), surface.is_single(), surface.vertices().len())?;
    writeln!(to, "element face {}\nproperty list uchar int vertex_indices\nend_header", surface.triangles().len())?;
    write_vertices(&mut to, surface.vertices(), surface.is_single())?;
    for triangle in surface.triangles() {
        to.write_all(&[3])?;
        triangle.iter().try_for_each(|v| to.write_all(&v.to_le_bytes()))?;
    }
    Ok(())
}

fn write_header(mut to: impl Write, comment: &str, is_single: bool, vertices: usize) -> io::Result<()> {
    writeln!(to, "ply\nformat binary_little_endian 1.0\ncomment {comment}\nelement vertex {vertices}")?;
    let number = if is_single { "float" } else { "double" };
    ["x", "y", "z"].iter().try_for_each(|axis| writeln!(to, "property {number} {axis}"))
}
