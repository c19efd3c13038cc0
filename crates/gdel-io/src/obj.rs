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
    let mut normals = Normals::default();
    let mut has_content = false;
    for (line, content) in lines(bytes) {
        has_content |= !content.is_empty() && !content.starts_with(b"#");
        let mut words = fields(content);
        match words.next() {
            Some(b"v") => {}
            Some(b"vn") => {
                normals.add(words);
                continue;
            }
            Some(b"f") => {
                normals.check(words);
                continue;
            }
            _ => continue,
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
    let normals = normals.finish(points.len());
    let cloud = PointCloud::new(PointBuf::F64(points))?;
    let cloud = if are_colored { cloud.colored(colors) } else { cloud };
    Ok(PointCloud { normals, ..cloud })
}

/// The normals of a file. Its faces may combine any with any vertex, but where each vertex has its own,
/// as scans do, they are in the same order.
#[derive(Default)]
struct Normals {
    all: Vec<[f32; 3]>,
    /// Whether something else was found.
    are_others: bool,
}

impl Normals {
    /// Adds the components of a normal.
    fn add<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) {
        let numbers: Vec<f64> = words.filter_map(|word| std::str::from_utf8(word).ok()?.parse().ok()).collect();
        let length = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
        let is_known = numbers.len() >= 3 && length > 0.0 && length.is_finite();
        self.all.push(if is_known { [0, 1, 2].map(|axis| (numbers[axis] / length) as f32) } else { [0.0; 3] });
    }

    /// Checks that the corners of a face have the normals with the numbers of their vertices.
    fn check<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) {
        for word in words {
            let mut indices = word.split(|&b| b == b'/');
            let (vertex, normal) = (indices.next(), indices.nth(1));
            self.are_others |= normal.is_some() && normal != vertex;
        }
    }

    /// Returns the normals if there is one for each of the points.
    fn finish(self, points: usize) -> Option<Vec<[f32; 3]>> {
        let are_known = !self.are_others && self.all.len() == points && self.all.iter().any(|n| *n != [0.0; 3]);
        are_known.then_some(self.all)
    }
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
