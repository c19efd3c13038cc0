//! STL, ASCII and binary.
//!
//! Read here because the errors of `stl_io` name no line, and because it refuses solids without a
//! name, stops after the first of several solids, and takes binary files whose header begins with
//! `solid` for text.

use crate::{
    FormatError, PointBuf, PointCloud,
    error::quote,
    surface::{MARK, Surface},
    text::{fields, lines, number},
};
use std::{
    collections::HashMap,
    io::{self, Write},
};

/// A header and the number of triangles; then 12 numbers and 2 unused bytes for each.
const HEADER: usize = 80;
const TRIANGLE: usize = 50;

/// Reads the corners, each of those with equal coordinates once, in the order of their first
/// appearance.
pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    if is_ascii(bytes) { read_ascii(bytes) } else { read_binary(bytes) }
}

/// Returns whether a file is text. Programs also write binary files that begin with `solid`, so the
/// size decides, where it can.
fn is_ascii(bytes: &[u8]) -> bool {
    let text = bytes.trim_ascii_start();
    if !text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) {
        return false;
    }
    let has_binary_size =
        triangle_count(bytes).is_some_and(|count| bytes.len() as u64 == (HEADER + 4) as u64 + count * TRIANGLE as u64);
    !has_binary_size && !bytes[..bytes.len().min(HEADER)].contains(&0)
}

fn triangle_count(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER..)?.first_chunk()?;
    Some(u32::from_le_bytes(*count).into())
}

fn read_binary(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let Some(count) = triangle_count(bytes) else {
        return Err(FormatError::byte(
            bytes.len(),
            "neither an ASCII STL, which starts with `solid`, nor a binary one",
        ));
    };
    let (triangles, _) = bytes[HEADER + 4..].as_chunks::<TRIANGLE>();
    if (triangles.len() as u64) < count {
        let what = format!("the file ends here, but its header promises {count} triangles");
        return Err(FormatError::byte(bytes.len(), what));
    }
    // Some programs pad the file with zeros.
    if triangles[count as usize..].iter().flatten().any(|&b| b != 0) {
        let what = format!("the file goes on after the {count} triangles that its header promises");
        return Err(FormatError::byte(HEADER + 4 + TRIANGLE * count as usize, what));
    }
    let mut points = Distinct::default();
    for triangle in &triangles[..count as usize] {
        let (numbers, _) = triangle.as_chunks::<4>();
        let numbers: [f32; 12] = std::array::from_fn(|i| f32::from_le_bytes(numbers[i]));
        let (_normal, corners) = numbers.split_at(3);
        let (corners, _) = corners.as_chunks::<3>();
        for &corner in corners {
            points.insert(corner, corner.map(|x| (x + 0.0).to_bits()));
        }
    }
    PointCloud::new(PointBuf::F32(points.list))
}

fn read_ascii(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let mut points = Distinct::default();
    let (mut open, mut corners, mut last) = (None, 0, 1);
    for (line, content) in lines(bytes) {
        let mut words = fields(content);
        let Some(keyword) = words.next() else { continue };
        last = line;
        match keyword.to_ascii_lowercase().as_slice() {
            b"solid" => open = Some(line),
            b"endsolid" => open = None,
            b"outer" => corners = 0,
            b"vertex" => {
                let mut corner = [0.0; 3];
                for x in &mut corner {
                    let word = words.next().ok_or_else(|| FormatError::line(line, "a vertex needs x, y and z"))?;
                    *x = number(word, line)?;
                }
                points.insert(corner, corner.map(|x| (x + 0.0).to_bits()));
                corners += 1;
            }
            b"endloop" if corners != 3 => {
                return Err(FormatError::line(line, format!("a facet has three vertices, this one has {corners}")));
            }
            b"facet" | b"endloop" | b"endfacet" => {}
            _ => return Err(FormatError::line(line, format!("{} is not a keyword of STL", quote(keyword)))),
        }
    }
    match open {
        Some(start) => Err(FormatError::line(last, format!("the file ends within the solid of line {start}"))),
        None => PointCloud::new(PointBuf::F64(points.list)),
    }
}

/// Points with equal coordinates once, in the order of their first appearance.
struct Distinct<T, Bits> {
    list: Vec<[T; 3]>,
    seen: HashMap<[Bits; 3], ()>,
}

impl<T, Bits> Default for Distinct<T, Bits> {
    fn default() -> Self {
        Distinct { list: Vec::new(), seen: HashMap::new() }
    }
}

impl<T, Bits: Eq + std::hash::Hash> Distinct<T, Bits> {
    /// `bits` are equal for equal points, so have no negative zeros.
    fn insert(&mut self, point: [T; 3], bits: [Bits; 3]) {
        if self.seen.insert(bits, ()).is_none() {
            self.list.push(point);
        }
    }
}

/// Writes binary STL if single precision holds the coordinates exactly, else ASCII.
pub(super) fn write_surface<const D: usize>(mut to: impl Write, surface: &Surface<'_, D>) -> io::Result<()> {
    let is_single = surface.vertices().flatten().all(|x| f64::from(x as f32) == x);
    let name = format!("{MARK}: {}", surface.name);
    match u32::try_from(surface.corners().len()) {
        Ok(count) if is_single => {
            to.write_all(format!("{name:\0<HEADER$}").as_bytes())?;
            to.write_all(&count.to_le_bytes())?;
            for corners in surface.corners() {
                for x in [normal(corners)].iter().chain(&corners).flatten() {
                    to.write_all(&(*x as f32).to_le_bytes())?;
                }
                to.write_all(&[0; 2])?;
            }
            Ok(())
        }
        _ => {
            writeln!(to, "solid {name}")?;
            for corners in surface.corners() {
                let [x, y, z] = normal(corners);
                writeln!(to, "facet normal {x:?} {y:?} {z:?}\n outer loop")?;
                for [x, y, z] in corners {
                    writeln!(to, "  vertex {x:?} {y:?} {z:?}")?;
                }
                writeln!(to, " endloop\nendfacet")?;
            }
            writeln!(to, "endsolid {name}")
        }
    }
}

/// Returns the unit normal, or zero if it cannot be computed; readers then compute it themselves.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let [a, b, c] = [a, b, c].map(glam::DVec3::from);
    (b - a).cross(c - a).normalize_or_zero().to_array()
}
