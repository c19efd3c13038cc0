//! The text files of Triangle and TetGen: `.node`, `.ele` and `.neigh`.

use crate::{
    FormatError, Mesh, PointBuf, PointCloud,
    error::quote,
    mesh::WEIGHT,
    surface::MARK,
    text::{by_number, fields, lines, number},
};
use gdel::{NONE, Points};
use std::{
    fmt::{self, Display},
    io::{self, Write},
};

/// Writes the points: a line of counts, then a line per point, numbered from 0.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_node<const D: usize>(to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    write_weighted_node(to, points, &[])
}

/// Writes the points as [`write_node`] does, each with its weight as the attribute, which TetGen's and Triangle's option
/// `-w` take; without weights, as that does. A comment after the counts names the columns.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_weighted_node<const D: usize>(
    mut to: impl Write,
    points: Points<'_, D>,
    weights: &[f64],
) -> io::Result<()> {
    if weights.is_empty() {
        write_node_rows(&mut to, points)?;
        return writeln!(to, "# {MARK}");
    }
    writeln!(to, "{} {D} 1 0 # index {} {WEIGHT}", points.len(), ["x", "y", "z"][..D].join(" "))?;
    for (i, (p, &weight)) in points.iter().zip(weights).enumerate() {
        write!(to, "{i}")?;
        p.iter().chain([&weight]).try_for_each(|&x| write!(to, " {}", Shortest(x)))?;
        writeln!(to)?;
    }
    writeln!(to, "# {MARK}")
}

/// Writes the counts and the points.
pub(super) fn write_node_rows<const D: usize>(mut to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    writeln!(to, "{} {D} 0 0", points.len())?;
    write_numbered(to, points.iter().map(|p| p.map(Shortest)))
}

/// A number, written with the digits needed to read it back.
pub(super) struct Shortest(pub(super) f64);

impl Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

/// Writes the tetrahedra, or for Triangle the triangles, numbered from 0.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_ele<const D: usize, const N: usize, M: Mesh<D, N>>(mut to: impl Write, mesh: &M) -> io::Result<()> {
    writeln!(to, "{} {N} 0", mesh.simplices().len())?;
    write_rows(to, mesh.simplices().iter().copied())
}

/// Writes the neighbours: the *k*-th is opposite the *k*-th vertex in [`write_ele`]'s file, -1
/// outside.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_neigh<const D: usize, const N: usize, M: Mesh<D, N>>(mut to: impl Write, mesh: &M) -> io::Result<()> {
    let opposites = mesh.opposites();
    writeln!(to, "{} {N}", opposites.len())?;
    // Outside is −1.
    write_rows(to, opposites.iter().map(|row| row.map(|t| t as i32)))
}

/// Writes the rows, numbered from 0, and a comment where TetGen and Triangle have theirs.
fn write_rows<T: Display, const N: usize>(mut to: impl Write, rows: impl Iterator<Item = [T; N]>) -> io::Result<()> {
    write_numbered(&mut to, rows)?;
    writeln!(to, "# {MARK}")
}

/// Writes the rows, numbered from 0.
fn write_numbered<T: Display, const N: usize>(
    mut to: impl Write,
    rows: impl Iterator<Item = [T; N]>,
) -> io::Result<()> {
    for (i, row) in rows.enumerate() {
        write!(to, "{i}")?;
        row.iter().try_for_each(|entry| write!(to, " {entry}"))?;
        writeln!(to)?;
    }
    Ok(())
}

/// Reads the points of a `.node` file, numbered from 0 or 1; of 2D points the third coordinate is
/// dropped.
pub(super) fn read_node<const D: usize>(bytes: &[u8]) -> Result<PointCloud<D>, FormatError> {
    let (first_line, header) = content(bytes).next().ok_or_else(|| FormatError::line(1, "the file is empty"))?;
    match integer(fields(header).nth(1), first_line)? {
        2 if D == 2 => PointCloud::new(PointBuf::F64(read_points(bytes)?)),
        3 => Ok(PointCloud::new(PointBuf::F64(read_points::<3>(bytes)?))?.resize()),
        2 => Err(FormatError::line(first_line, "2D points: they have two coordinates each")),
        other => Err(FormatError::line(first_line, format!("points of {other} coordinates"))),
    }
}

/// Reads the points of a `.node` file, and the column of a name or a number, counted from 1. It has names if those of all
/// columns are in a comment after the counts, as [`write_weighted_node`] writes them.
pub(super) fn read_node_with_values<const D: usize>(
    bytes: &[u8],
    column: &str,
) -> Result<(PointCloud<D>, Vec<f64>), FormatError> {
    let cloud = read_node(bytes)?;
    let place = match place_of(bytes, column) {
        Some(place) => place,
        None => by_number(column, 1)?,
    };
    Ok((cloud, read_column(bytes, place)?))
}

/// Reads the weights of a `.node` file, if it names a column so.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn read_weights(bytes: &[u8]) -> Result<Option<Vec<f64>>, FormatError> {
    place_of(bytes, WEIGHT).map(|place| read_column(bytes, place)).transpose()
}

/// Returns the place of the column with a name.
fn place_of(bytes: &[u8], name: &str) -> Option<usize> {
    let (first_line, _) = content(bytes).next()?;
    let (_, counts) = lines(bytes).nth(first_line - 1)?;
    let comment = counts.splitn(2, |&b| b == b'#').nth(1)?;
    fields(comment).position(|word| word == name.as_bytes())
}

/// Reads a column of the rows of a `.node` file.
fn read_column(bytes: &[u8], place: usize) -> Result<Vec<f64>, FormatError> {
    let value = |(line, row)| {
        let field = fields(row).nth(place);
        number(field.ok_or_else(|| FormatError::line(line, format!("there is no column {}", place + 1)))?, line)
    };
    content(bytes).skip(1).map(value).collect()
}

fn read_points<const E: usize>(bytes: &[u8]) -> Result<Vec<[f64; E]>, FormatError> {
    read_numbered_points(bytes).map(|(points, _)| points)
}

/// Reads the points of a `.node` file, and the number of the first.
pub(super) fn read_numbered_points<const E: usize>(bytes: &[u8]) -> Result<(Vec<[f64; E]>, i64), FormatError> {
    let rows = read_rows(bytes, "points", |field, line| {
        number(field.ok_or_else(|| FormatError::line(line, "a coordinate is missing"))?, line)
    })?;
    Ok((rows.rows.into_iter().map(|row| row.entries).collect(), rows.base))
}

/// Reads the vertices of the tetrahedra, or of the triangles in the orientation of
/// [`Mesh2`](gdel::Mesh2), counted from 0. A file whose first row is number 1 counts from 1.
///
/// # Errors
///
/// Returns where the file is broken, and how.
pub fn read_ele<M: Mesh<D, N>, const D: usize, const N: usize>(bytes: &[u8]) -> Result<Vec<[u32; N]>, FormatError> {
    let Rows { rows, base } = read_rows(bytes, M::NAMES.simplices, integer)?;
    let index = |v: i64| u32::try_from(v.checked_sub(base)?).ok();
    rows.into_iter().map(|row: Row<i64, N>| row.resolve(index)).collect()
}

/// Reads the neighbours, counted as in [`read_ele`]; −1 in the file is [`NONE`].
///
/// # Errors
///
/// Returns where the file is broken, and how.
pub fn read_neigh<M: Mesh<D, N>, const D: usize, const N: usize>(bytes: &[u8]) -> Result<Vec<[u32; N]>, FormatError> {
    let Rows { rows, base } = read_rows(bytes, M::NAMES.simplices, integer)?;
    // "None" is -1 in files that count from 1 as well.
    let index = |t: i64| match t {
        -1 => Some(NONE),
        _ => u32::try_from(t.checked_sub(base)?).ok().filter(|&t| t <= i32::MAX as u32),
    };
    rows.into_iter().map(|row: Row<i64, N>| row.resolve(index)).collect()
}

/// Numbered rows, and the number of the first.
struct Rows<T, const N: usize> {
    rows: Vec<Row<T, N>>,
    base: i64,
}

/// The numbers of a line after that of the row.
struct Row<T, const N: usize> {
    line: usize,
    entries: [T; N],
}

impl<const N: usize> Row<i64, N> {
    fn resolve<T: Copy + Default>(&self, index: impl Fn(i64) -> Option<T>) -> Result<[T; N], FormatError> {
        let mut result = [T::default(); N];
        for (to, &entry) in result.iter_mut().zip(&self.entries) {
            *to = index(entry).ok_or_else(|| FormatError::line(self.line, format!("{entry} is out of range")))?;
        }
        Ok(result)
    }
}

/// Returns the lines that are neither empty nor comments, with their numbers.
pub(super) fn content(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    lines(bytes)
        .map(|(line, content)| (line, content.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii()))
        .filter(|(_, content)| !content.is_empty())
}

/// Reads the rows under a line with their count: a number, `N` entries, and anything after them.
fn read_rows<T: Copy + Default, const N: usize>(
    bytes: &[u8],
    what: &str,
    parse: impl Fn(Option<&[u8]>, usize) -> Result<T, FormatError>,
) -> Result<Rows<T, N>, FormatError> {
    let mut content = content(bytes);
    let (first_line, header) = content.next().ok_or_else(|| FormatError::line(1, "the file is empty"))?;
    let mut header = fields(header);
    let count = integer(header.next(), first_line)?;
    if integer(header.next(), first_line)? < N as i64 {
        return Err(FormatError::line(first_line, format!("{what} have at least {N} entries per line")));
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
        let mut entries = [T::default(); N];
        for entry in &mut entries {
            *entry = parse(fields.next(), line)?;
        }
        rows.push(Row { line, entries });
    }
    if i64::try_from(rows.len()) != Ok(count) {
        let what = format!("the first line promises {count} rows, the file holds {}", rows.len());
        return Err(FormatError::line(last_line, what));
    }
    Ok(Rows { rows, base })
}

pub(super) fn integer(field: Option<&[u8]>, line: usize) -> Result<i64, FormatError> {
    let field = field.ok_or_else(|| FormatError::line(line, "a number is missing"))?;
    std::str::from_utf8(field)
        .ok()
        .and_then(|text| text.parse().ok())
        .ok_or_else(|| FormatError::line(line, format!("{} is not a whole number", quote(field))))
}
