//! The text files of Triangle and TetGen: `.node`, `.ele` and `.neigh`.

use crate::io::{
    FormatError,
    error::quote,
    text::{fields, lines},
};
use crate::{Mesh3, Points};
use std::{
    fmt::{self, Debug, Display, Formatter},
    io::{self, Write},
};

/// Writes the points: a line of counts, then a line a point, counted from 0.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_node<W: Write, const D: usize>(mut to: W, points: Points<'_, D>) -> io::Result<()> {
    writeln!(to, "{} {D} 0 0", points.len())?;
    points.iter().enumerate().try_for_each(|(i, p)| writeln!(to, "{}", Numbered(i, &p)))
}

/// Writes the tetrahedra, counted from 0.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_ele<W: Write>(to: W, mesh: &Mesh3) -> io::Result<()> {
    write_rows(to, " 0", &mesh.tetrahedra)
}

/// Writes the neighbours: the *k*-th is across the facet opposite the *k*-th vertex, -1 outside.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_neigh<W: Write>(to: W, mesh: &Mesh3) -> io::Result<()> {
    write_rows(to, "", &mesh.neighbors)
}

/// The count and length of the rows, `more`, and the rows, counted from 0.
pub(super) fn write_rows<T: Debug, const N: usize>(mut to: impl Write, more: &str, rows: &[[T; N]]) -> io::Result<()> {
    writeln!(to, "{} {N}{more}", rows.len())?;
    rows.iter().enumerate().try_for_each(|(i, row)| writeln!(to, "{}", Numbered(i, row)))
}

/// The text of a row, for one call of `write!`: a call for each entry takes 1.3 times the instructions.
struct Numbered<'a, T>(usize, &'a [T]);

impl<T: Debug> Display for Numbered<'_, T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(&self.0, f)?;
        self.1.iter().try_for_each(|entry| {
            f.write_str(" ")?;
            entry.fmt(f)
        })
    }
}

/// Reads the tetrahedra's vertices, counted from 0. A file whose first tetrahedron is number 1 counts from 1.
///
/// # Errors
///
/// Where the file is broken, and how.
pub fn read_ele(bytes: &[u8]) -> Result<Vec<[u32; 4]>, FormatError> {
    read_simplices(bytes, "tetrahedra")
}

/// Likewise for the simplices with `N` vertices that `what` names.
pub(super) fn read_simplices<const N: usize>(bytes: &[u8], what: &str) -> Result<Vec<[u32; N]>, FormatError> {
    let rows = read_rows(bytes, what)?;
    rows.into_iter().map(|row| row.resolve(|v| u32::try_from(v).ok())).collect()
}

/// Reads the neighbours, counted as in [`read_ele`].
///
/// # Errors
///
/// Where the file is broken, and how.
pub fn read_neigh(bytes: &[u8]) -> Result<Vec<[i32; 4]>, FormatError> {
    let rows = read_rows(bytes, "tetrahedra")?;
    // "None" is -1 in files that count from 1 as well.
    rows.into_iter().map(|row| row.resolve(|t| i32::try_from(t.max(-1)).ok())).collect()
}

/// Numbers of a line, less the number of the first row.
struct Row<const N: usize> {
    line: usize,
    entries: [i64; N],
}

impl<const N: usize> Row<N> {
    fn resolve<T: Copy + Default>(&self, index: impl Fn(i64) -> Option<T>) -> Result<[T; N], FormatError> {
        let mut result = [T::default(); N];
        for (to, &entry) in result.iter_mut().zip(&self.entries) {
            *to = index(entry).ok_or_else(|| FormatError::line(self.line, format!("{entry} is out of range")))?;
        }
        Ok(result)
    }
}

/// The rows under a line with their count: a number, `N` entries, and whatever else.
fn read_rows<const N: usize>(bytes: &[u8], what: &str) -> Result<Vec<Row<N>>, FormatError> {
    let mut content = lines(bytes)
        .map(|(line, content)| (line, content.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii()))
        .filter(|(_, content)| !content.is_empty());
    let (first_line, header) = content.next().ok_or_else(|| FormatError::line(1, "the file is empty"))?;
    let mut header = fields(header);
    let count = integer(header.next(), first_line)?;
    if integer(header.next(), first_line)? < N as i64 {
        return Err(FormatError::line(first_line, format!("{what} have at least {N} entries a line")));
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
        let mut entries = [0; N];
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
