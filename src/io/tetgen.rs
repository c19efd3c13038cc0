//! TetGen's text files: `.node`, `.ele` and `.neigh`.

use super::{
    FormatError,
    error::quote,
    text::{fields, lines},
};
use crate::{Mesh3, Points};
use std::io::{self, Write};

/// Writes the points: a line of counts, then a line a point, counted from 0.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_node<W: Write>(mut to: W, points: Points<'_>) -> io::Result<()> {
    writeln!(to, "{} 3 0 0", points.len())?;
    points.iter().enumerate().try_for_each(|(i, [x, y, z])| writeln!(to, "{i} {x:?} {y:?} {z:?}"))
}

/// Writes the tetrahedra, counted from 0.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_ele<W: Write>(mut to: W, mesh: &Mesh3) -> io::Result<()> {
    writeln!(to, "{} 4 0", mesh.tetrahedra.len())?;
    mesh.tetrahedra.iter().enumerate().try_for_each(|(i, [a, b, c, d])| writeln!(to, "{i} {a} {b} {c} {d}"))
}

/// Writes the neighbours: the *k*-th is across the facet opposite the *k*-th vertex, -1 outside.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_neigh<W: Write>(mut to: W, mesh: &Mesh3) -> io::Result<()> {
    writeln!(to, "{} 4", mesh.neighbors.len())?;
    mesh.neighbors.iter().enumerate().try_for_each(|(i, [a, b, c, d])| writeln!(to, "{i} {a} {b} {c} {d}"))
}

/// Reads the tetrahedra's vertices, counted from 0. A file whose first tetrahedron is number 1 counts from 1.
///
/// # Errors
///
/// Where the file is broken, and how.
pub fn read_ele(bytes: &[u8]) -> Result<Vec<[u32; 4]>, FormatError> {
    let rows = read_rows(bytes)?;
    rows.into_iter().map(|row| row.resolve(|v| u32::try_from(v).ok())).collect()
}

/// Reads the neighbours, counted as in [`read_ele`].
///
/// # Errors
///
/// Where the file is broken, and how.
pub fn read_neigh(bytes: &[u8]) -> Result<Vec<[i32; 4]>, FormatError> {
    let rows = read_rows(bytes)?;
    // "None" is -1 in files that count from 1 as well.
    rows.into_iter().map(|row| row.resolve(|t| i32::try_from(t.max(-1)).ok())).collect()
}

/// Four numbers of a line, less the number of the first row.
struct Row {
    line: usize,
    entries: [i64; 4],
}

impl Row {
    fn resolve<T: Copy + Default>(&self, index: impl Fn(i64) -> Option<T>) -> Result<[T; 4], FormatError> {
        let mut result = [T::default(); 4];
        for (to, &entry) in result.iter_mut().zip(&self.entries) {
            *to = index(entry).ok_or_else(|| FormatError::line(self.line, format!("{entry} is out of range")))?;
        }
        Ok(result)
    }
}

/// The rows under a line with their count: a number, four entries, and whatever else.
fn read_rows(bytes: &[u8]) -> Result<Vec<Row>, FormatError> {
    let mut content = lines(bytes)
        .map(|(line, content)| (line, content.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii()))
        .filter(|(_, content)| !content.is_empty());
    let (first_line, header) = content.next().ok_or_else(|| FormatError::line(1, "the file is empty"))?;
    let mut header = fields(header);
    let count = integer(header.next(), first_line)?;
    if integer(header.next(), first_line)? < 4 {
        return Err(FormatError::line(first_line, "tetrahedra have at least 4 entries a line"));
    }
    let mut rows = Vec::new();
    let mut base = 0;
    let mut last_line = first_line;
    for (line, content) in content {
        last_line = line;
        let mut fields = fields(content);
        let number = integer(fields.next(), line)?;
        if rows.is_empty() {
            base = number;
        }
        if number.checked_sub(base) != i64::try_from(rows.len()).ok() || !(0..=1).contains(&base) {
            return Err(FormatError::line(line, format!("row {} is numbered {number}", rows.len())));
        }
        let mut entries = [0; 4];
        for entry in &mut entries {
            let value = integer(fields.next(), line)?;
            *entry = value.saturating_sub(base);
        }
        rows.push(Row { line, entries });
    }
    if i64::try_from(rows.len()) != Ok(count) {
        let what = format!("the first line promises {count} rows, the file holds {}", rows.len());
        return Err(FormatError::line(last_line, what));
    }
    Ok(rows)
}

fn integer(field: Option<&[u8]>, line: usize) -> Result<i64, FormatError> {
    let field = field.ok_or_else(|| FormatError::line(line, "a number is missing"))?;
    std::str::from_utf8(field)
        .ok()
        .and_then(|text| text.parse().ok())
        .ok_or_else(|| FormatError::line(line, format!("{} is not a whole number", quote(field))))
}
