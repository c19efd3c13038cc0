//! Wavefront OBJ.
//!
//! Read here because `tobj` returns only the vertices of faces, so nothing for a point cloud, and
//! `obj` reads only single precision.

use crate::{
    FormatError, PointBuf, PointCloud,
    colors::{CHANNELS, Colors, Range, Sample},
    surface::{MARK, Surface, padded},
    text::{fields, lines, number},
};
use gdel::Points;
use std::io::{self, Write};

pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let mut points = Vec::new();
    let mut colors = Colors::new(std::array::from_fn(|channel| channel < 3), Range::Fractions);
    let mut are_colored = true;
    let mut has_content = false;
    for (line, content) in lines(bytes) {
        has_content |= !content.is_empty() && !content.starts_with(b"#");
        let mut words = fields(content);
        if words.next() != Some(b"v") {
            continue;
        }
        let mut point = [0.0; 3];
        for x in &mut point {
            let word = words.next().ok_or_else(|| FormatError::line(line, "a vertex needs x, y and z"))?;
            *x = number(word, line)?;
        }
        let mut more = 0;
        let mut sample: Sample = [f64::NAN; CHANNELS];
        for word in words.take_while(|word| !word.starts_with(b"#")) {
            let value = number(word, line)?;
            if let Some(channel) = sample.get_mut(more) {
                *channel = value;
            }
            more += 1;
        }
        // A weight, a color, or both; or a color with its opacity.
        if !matches!(more, 0 | 1 | 3 | 4) {
            let what = format!("{} numbers in one vertex: there must be one vertex per line", 3 + more);
            return Err(FormatError::line(line, what));
        }
        points.push(point);
        // Four may be a color with its opacity or with a weight before it.
        are_colored &= more == 3;
        if are_colored {
            colors.push(&sample);
        }
    }
    if points.is_empty() && has_content {
        return Err(FormatError::line(1, "the file has no vertices (lines that start with `v`)"));
    }
    let colors = if are_colored { colors.finish() } else { None };
    Ok(PointCloud { colors, ..PointCloud::new(PointBuf::F64(points))? })
}

pub(super) fn write_points<const D: usize>(mut to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    write_vertices(&mut to, points.iter().map(padded))
}

fn write_vertices(to: &mut impl Write, mut vertices: impl Iterator<Item = [f64; 3]>) -> io::Result<()> {
    vertices.try_for_each(|[x, y, z]| writeln!(to, "v {x:?} {y:?} {z:?}"))
}

pub(super) fn write_surface<const D: usize>(mut to: impl Write, surface: &Surface<'_, D>) -> io::Result<()> {
    writeln!(to, "# {MARK}: {}", surface.name)?;
    write_vertices(&mut to, surface.vertices())?;
    surface.triangles().try_for_each(|t| {
        let [a, b, c] = t.map(|v| v + 1);
        writeln!(to, "f {a} {b} {c}")
    })
}
