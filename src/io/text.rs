//! Points as text: XYZ, PTS and CSV, and what all readers of text share.

use crate::Points;
use crate::io::{FormatError, PointBuf, PointCloud, error::quote};
use std::io::{self, Write};

/// The lines of a text file with their numbers, without line ends and a byte order mark.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.split(|&b| b == b'\n').map(|line| line.trim_ascii()).zip(1..).map(|(line, number)| (number, line))
}

/// The fields of a line: separated by semicolons or commas where it has any, else by white space.
pub(super) fn fields(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let separator = [b';', b','].into_iter().find(|separator| line.contains(separator));
    line.split(move |b| separator.map_or(b.is_ascii_whitespace(), |s| *b == s))
        .map(|field| field.trim_ascii())
        .filter(move |field| separator.is_some() || !field.is_empty())
}

/// A finite number.
pub(super) fn number(field: &[u8], line: usize) -> Result<f64, FormatError> {
    match parse(field) {
        Some(x) if x.is_finite() => Ok(x),
        Some(_) => Err(FormatError::line(line, format!("{} is not a finite number", quote(field)))),
        None => Err(FormatError::line(line, format!("{} is not a number", quote(field)))),
    }
}

fn parse(field: &[u8]) -> Option<f64> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

/// Which fields of a row are x, y and z.
struct Columns([usize; 3]);

impl Columns {
    const FIRST_THREE: Columns = Columns([0, 1, 2]);

    /// The columns that a first row names, or `None` when it holds numbers, so is a point itself.
    fn from_names(row: &[&[u8]]) -> Option<Self> {
        if row.iter().any(|field| parse(field).is_some()) {
            return None;
        }
        let column = |name: &[u8]| row.iter().position(|field| field.eq_ignore_ascii_case(name));
        Some(Columns([column(b"x")?, column(b"y")?, column(b"z")?]))
    }

    fn point(&self, row: &[&[u8]], line: usize) -> Result<[f64; 3], FormatError> {
        let mut point = [0.0; 3];
        for (x, &column) in point.iter_mut().zip(&self.0) {
            let field = row.get(column).ok_or_else(|| {
                FormatError::line(line, format!("x, y and z expected, but there are only {} values", row.len()))
            })?;
            *x = number(field, line)?;
        }
        Ok(point)
    }
}

/// XYZ, and PTS, where a line with nothing but a count goes before the points of each scan.
pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let mut columns = None;
    let mut points = Vec::new();
    // The line of the count before the points of the current scan, and what `points.len()` will be after them.
    let mut scan: Option<(usize, usize)> = None;
    let mut row = Vec::new();
    for (line, content) in lines(bytes) {
        if content.is_empty() || content.starts_with(b"#") || content.starts_with(b"//") {
            continue;
        }
        row.clear();
        row.extend(fields(content));
        let between_scans = scan.map_or(points.is_empty(), |(_, end)| end == points.len());
        if let (true, [count]) = (between_scans, row.as_slice())
            && let Some(end) = whole_number(count).and_then(|n| n.checked_add(points.len()))
        {
            scan = Some((line, end));
            continue;
        }
        if columns.is_none() {
            columns = Columns::from_names(&row);
            if columns.is_some() {
                continue;
            }
        }
        points.push(columns.get_or_insert(Columns::FIRST_THREE).point(&row, line)?);
    }
    match scan {
        Some((line, end)) if end != points.len() => Err(FormatError::line(
            line,
            format!("the count promises {end} points in all, the file holds {}", points.len()),
        )),
        _ => PointCloud::new(PointBuf::F64(points)),
    }
}

fn whole_number(field: &[u8]) -> Option<usize> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

/// Comma-, semicolon- or tab-separated values with quoted fields; text with white space between is taken too.
pub(super) fn read_csv(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let first = lines(bytes).map(|(_, line)| line).find(|line| !line.is_empty()).unwrap_or_default();
    let Some(delimiter) = [b';', b',', b'\t'].into_iter().find(|d| first.contains(d)) else {
        return read(bytes);
    };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .delimiter(delimiter)
        .trim(csv::Trim::All)
        .from_reader(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut columns = None;
    let mut points = Vec::new();
    let mut record = csv::ByteRecord::new();
    loop {
        let line = reader.position().line() as usize;
        match reader.read_byte_record(&mut record) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => return Err(FormatError::line(line, error.to_string())),
        }
        let line = record.position().map_or(line, |position| position.line() as usize);
        let row: Vec<&[u8]> = record.iter().collect();
        if columns.is_none() {
            columns = Columns::from_names(&row);
            if columns.is_some() {
                continue;
            }
        }
        points.push(columns.get_or_insert(Columns::FIRST_THREE).point(&row, line)?);
    }
    PointCloud::new(PointBuf::F64(points))
}

/// One point a line, with digits enough to read back the same numbers: those of the `f64` of the same value, as a
/// reader of decimals cannot know that single precision is meant.
pub(super) fn write<W: Write>(mut to: W, points: Points<'_>) -> io::Result<()> {
    points.iter().try_for_each(|[x, y, z]| writeln!(to, "{x:?} {y:?} {z:?}"))
}

pub(super) fn write_csv<W: Write>(mut to: W, points: Points<'_>) -> io::Result<()> {
    writeln!(to, "x,y,z")?;
    points.iter().try_for_each(|[x, y, z]| writeln!(to, "{x:?},{y:?},{z:?}"))
}
