//! Points as text (XYZ, PTS and CSV), and functions for all readers of text.

use crate::{
    FormatError, PointBuf, PointCloud,
    colors::{CHANNELS, Colors, INTENSITY, NORMAL, Range, channel},
    error::quote,
};
use gdel::Points;
use std::io::{self, Write};

/// Splits off the first line, without its end: `\n`, `\r\n`, or the lone `\r` of old Macintosh
/// programs.
pub(super) fn split_line(text: &[u8]) -> (&[u8], &[u8]) {
    let end = text.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(text.len());
    let (line, rest) = text.split_at(end);
    let rest = rest.strip_prefix(b"\r\n").or_else(|| rest.get(1..)).unwrap_or_default();
    (line, rest)
}

/// Returns the text without a byte order mark.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Returns the lines of a text file with their numbers, without the white space around them.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let mut text = without_mark(bytes);
    let lines = std::iter::from_fn(move || {
        if text.is_empty() {
            return None;
        }
        let (line, rest) = split_line(text);
        text = rest;
        Some(line.trim_ascii())
    });
    (1..).zip(lines)
}

/// Returns the number of the line that contains byte `offset`.
pub(super) fn line_at(bytes: &[u8], offset: usize) -> usize {
    let (mut line, mut rest) = (1, bytes);
    loop {
        (_, rest) = split_line(rest);
        if rest.is_empty() || bytes.len() - rest.len() > offset {
            return line;
        }
        line += 1;
    }
}

/// Returns the fields of a line: separated by semicolons or commas where it has any, else by white
/// space. Commas between digits are those of decimals if all fields are separated otherwise.
pub(super) fn fields(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let separator = [b';', b','].into_iter().find(|separator| line.contains(separator));
    let separator = separator.filter(|&separator| separator == b';' || !has_decimal_commas(line));
    line.split(move |b| separator.map_or(b.is_ascii_whitespace(), |s| *b == s))
        .map(<[u8]>::trim_ascii)
        .filter(move |field| separator.is_some() || !field.is_empty())
}

/// Parses a finite number.
pub(super) fn number(field: &[u8], line: usize) -> Result<f64, FormatError> {
    match parse(field) {
        Some(x) if x.is_finite() => Ok(x),
        Some(_) => Err(FormatError::line(line, format!("{} is not a finite number", quote(field)))),
        None => Err(FormatError::line(line, format!("{} is not a number", quote(field)))),
    }
}

/// Returns whether white space separates the fields of a line, some of which have a comma as the decimal
/// mark: split at the commas, they would be no numbers.
fn has_decimal_commas(line: &[u8]) -> bool {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let mut rest = words.clone().skip(1);
    rest.next().is_some()
        && words.clone().any(|word| word.contains(&b','))
        && words
            .all(|word| word.first().is_some_and(|&b| b != b',') && word.last() != Some(&b',') && parse(word).is_some())
}

/// Parses a number, whose decimal mark may be a comma: a field has no others.
fn parse(field: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(field).ok()?;
    text.parse().ok().or_else(|| {
        let (whole, fraction) = text.split_once(',')?;
        format!("{whole}.{fraction}").parse().ok()
    })
}

/// Returns the names of the coordinates, for messages.
pub(super) fn axes<const D: usize>() -> &'static str {
    if D == 2 { "x and y" } else { "x, y and z" }
}

/// Collects the points of a text file, row by row.
struct Table<'w, const D: usize> {
    /// Which fields of a row are the coordinates; `None` before the first row.
    columns: Option<[usize; D]>,
    /// The field of the *z* that 2D points drop.
    dropped: Option<usize>,
    points: Vec<[f64; D]>,
    dropped_z: bool,
    /// The line of the first point, its number of fields, and how many of these, from the first on,
    /// are numbers.
    first: Option<(usize, usize, usize)>,
    /// Whether the first row names the columns.
    is_named: bool,
    /// Whether the file says how many points it has.
    is_counted: bool,
    /// The column of values that is wanted, and which field of a row it is, once that is known.
    wanted: Option<(&'w str, Option<usize>)>,
    values: Vec<f64>,
    /// The colours, once a row has been seen.
    tints: Option<Tints>,
}

/// The fields of a row that say something about the colour of its point.
struct Tints {
    fields: [Option<usize>; CHANNELS],
    /// Whether the meaning was guessed from the first row: then red, green and blue must be
    /// plausible in every row.
    is_guess: bool,
    colors: Colors,
}

impl Tints {
    fn new(fields: [Option<usize>; CHANNELS], range: Range, is_guess: bool) -> Self {
        Tints { fields, is_guess, colors: Colors::new(fields.map(|field| field.is_some()), range) }
    }

    /// Takes the columns after the coordinates for what they are in files of scanners: an
    /// intensity; red, green and blue, maybe after an intensity; or a normal.
    fn guess(row: &[&[u8]], is_counted: bool) -> Self {
        let all = |range: std::ops::Range<usize>, is: fn(f64) -> bool| {
            row.get(range).is_some_and(|fields| fields.iter().all(|field| parse(field).is_some_and(is)))
        };
        let mut fields = [None; CHANNELS];
        let mut set = |channel: usize, from: usize, count: usize| {
            (0..count).for_each(|k| fields[channel + k] = Some(from + k));
        };
        let has_intensity = all(4..7, is_byte) && (is_counted || !all(3..6, is_byte));
        if has_intensity {
            set(INTENSITY, 3, 1);
            set(0, 4, 3);
        // Before colours: 0, 0, 1 may be either, and hardly any point is so dark.
        } else if row.get(3..6).is_some_and(is_normal) {
            set(NORMAL, 3, 3);
        } else if all(3..6, is_byte) {
            set(0, 3, 3);
        } else if row.len() == 4 {
            set(INTENSITY, 3, 1);
        }
        Tints::new(fields, Range::Bytes, true)
    }

    /// Adds the colour of a row. Returns whether the row agrees with a guess.
    fn add(&mut self, row: &[&[u8]]) -> bool {
        if self.colors.is_empty() {
            return true;
        }
        let sample = self.fields.map(|field| field.and_then(|field| parse(row.get(field)?)).unwrap_or(f64::NAN));
        self.colors.push(&sample);
        let [r, g, b, _, normal @ ..] = sample;
        let is_right = match (self.fields[0], self.fields[NORMAL]) {
            (Some(_), _) => [r, g, b].into_iter().all(is_byte),
            (None, Some(_)) => is_unit(normal),
            (None, None) => true,
        };
        is_right || !self.is_guess
    }
}

fn is_byte(x: f64) -> bool {
    (0.0..=255.0).contains(&x) && x.fract() == 0.0
}

/// Returns whether a vector has the length 1, as rounded as files have them, or none.
fn is_unit(vector: [f64; 3]) -> bool {
    let square: f64 = vector.iter().map(|x| x * x).sum();
    square == 0.0 || (square - 1.0).abs() < 0.01
}

/// Returns whether three fields are a vector of length 1.
fn is_normal(fields: &[&[u8]]) -> bool {
    let mut vector = [0.0; 3];
    for (x, field) in vector.iter_mut().zip(fields) {
        let Some(number) = parse(field) else { return false };
        *x = number;
    }
    is_unit(vector) && vector != [0.0; 3]
}

impl<'w, const D: usize> Table<'w, D> {
    fn new(wanted: Option<&'w str>) -> Self {
        Table {
            wanted: wanted.map(|name| (name, None)),
            values: Vec::new(),
            columns: None,
            dropped: None,
            points: Vec::new(),
            dropped_z: false,
            first: None,
            is_named: false,
            is_counted: false,
            tints: None,
        }
    }

    /// Adds the point of a row; a first row without any number holds the names of the columns.
    fn add(&mut self, row: &[&[u8]], line: usize) -> Result<(), FormatError> {
        let columns = match self.columns {
            Some(columns) => columns,
            None if row.len() > 1 && row.iter().all(|field| parse(field).is_none()) => {
                return self.name_columns(row, line);
            }
            None => {
                self.dropped = (D == 2).then_some(2);
                *self.columns.insert(std::array::from_fn(|axis| axis))
            }
        };
        let mut point = [0.0; D];
        for (x, column) in point.iter_mut().zip(columns) {
            let field = row.get(column).ok_or_else(|| {
                let what = format!("{} expected, but there are only {} values", axes::<D>(), row.len());
                FormatError::line(line, what)
            })?;
            *x = number(field, line)?;
        }
        if let Some((name, column)) = &mut self.wanted {
            let column = match column {
                Some(column) => *column,
                None => *column.insert(by_number(name, line)?),
            };
            let field = row
                .get(column)
                .ok_or_else(|| FormatError::line(line, format!("there is no column {} for the values", column + 1)))?;
            let value = parse(field);
            self.values
                .push(value.ok_or_else(|| FormatError::line(line, format!("{} is not a number", quote(field))))?);
        }
        if let Some(column) = self.dropped
            && !self.dropped_z
        {
            self.dropped_z = row.get(column).and_then(|field| parse(field)).is_some_and(|z| z != 0.0);
        }
        match self.first {
            None => self.first = Some((line, row.len(), leading_numbers(row))),
            Some((first, fields, numbers)) if !self.is_counted && row.len() != fields => {
                let here = leading_numbers(row);
                if here != numbers {
                    let what = format!(
                        "{here} numbers, but line {first} has {numbers}: there must be one point per line, with as many \
                         values on each"
                    );
                    return Err(FormatError::line(line, what));
                }
            }
            Some(_) => {}
        }
        let (is_counted, is_first) = (self.is_counted, self.points.is_empty());
        if is_first && self.tints.is_none() {
            self.tints = Some(Tints::guess(row, is_counted));
        }
        if self.tints.as_mut().is_some_and(|tints| !tints.add(row)) {
            self.tints = None;
        }
        self.points.push(point);
        Ok(())
    }

    fn name_columns(&mut self, row: &[&[u8]], line: usize) -> Result<(), FormatError> {
        /// The number of names that a message quotes.
        const QUOTED: usize = 8;
        let column = |name: &str| row.iter().position(|field| bare(field).eq_ignore_ascii_case(name.as_bytes()));
        let mut found = ["x", "y", "z"].map(column);
        if D == 2 && found[..2] == [None; 2] {
            let first = |names: &[&str]| names.iter().find_map(|name| column(name));
            found[..2].copy_from_slice(&[first(&["lon", "lng", "longitude"]), first(&["lat", "latitude"])]);
        }
        if found[..D].contains(&None) {
            let names: Vec<String> = row.iter().take(QUOTED).map(|name| quote(name)).collect();
            let more = if row.len() > QUOTED { ", …" } else { "" };
            let what = format!(
                "this line names no columns {}, in upper or lower case, but {}{more}: rename those of the coordinates, or \
                 remove the line if they are the first {D}",
                axes::<D>(),
                names.join(", ")
            );
            return Err(FormatError::line(line, what));
        }
        if let Some((name, place)) = &mut self.wanted {
            *place = column(name);
        }
        self.columns = Some(std::array::from_fn(|axis| found[axis].unwrap_or(axis)));
        self.dropped = if D == 2 { found[2] } else { None };
        self.is_named = true;
        let mut fields = [None; CHANNELS];
        for (place, name) in row.iter().enumerate() {
            if let Some(channel) = channel(bare(name)) {
                fields[channel].get_or_insert(place);
            }
        }
        self.tints = Some(Tints::new(fields, Range::Fractions, false));
        Ok(())
    }

    fn finish(self) -> Result<(PointCloud<D>, Vec<f64>), FormatError> {
        let is_bare = !self.is_named && !self.is_counted;
        let (line, fields, numbers) = self.first.unwrap_or_default();
        if is_bare && self.points.len() == 1 && numbers >= 2 * D {
            let what = format!("all {numbers} numbers of the file are on one line: there must be one point per line");
            return Err(FormatError::line(line, what));
        }
        let known = self.dropped.map_or(D, |column| column + 1);
        let ignored_columns = if self.is_named { 0 } else { fields.saturating_sub(known) };
        let cloud = PointCloud::new(PointBuf::F64(self.points))?;
        let cloud = match self.tints {
            Some(tints) => cloud.colored(tints.colors),
            None => cloud,
        };
        Ok((PointCloud { dropped_z: self.dropped_z, ignored_columns, ..cloud }, self.values))
    }
}

/// Returns the place of the column with a number, counted from 1.
pub(super) fn by_number(name: &str, line: usize) -> Result<usize, FormatError> {
    let number: Option<usize> = name.parse().ok();
    number.and_then(|number| number.checked_sub(1)).ok_or_else(|| {
        let what = "name the column of the values as the first line does, or by its number, counted from 1";
        FormatError::line(line, format!("there is no column {}: {what}", quote(name.as_bytes())))
    })
}

/// Returns a column's name without the mark of a comment that CloudCompare and others put before
/// the first.
fn bare(name: &[u8]) -> &[u8] {
    let start = name.iter().position(|b| !b"/# ".contains(b)).unwrap_or(name.len());
    &name[start..]
}

fn leading_numbers(row: &[&[u8]]) -> usize {
    row.iter().take_while(|field| parse(field).is_some()).count()
}

/// Rejects text in UTF-16, which Windows calls Unicode: its numbers have a zero byte after each
/// digit.
fn check_encoding(bytes: &[u8]) -> Result<(), FormatError> {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(FormatError::byte(0, "this is text in UTF-16: save it as UTF-8"));
    }
    Ok(())
}

/// Reads XYZ, and PTS, where a line with nothing but a count goes before the points of each scan.
pub(super) fn read<const D: usize>(bytes: &[u8]) -> Result<PointCloud<D>, FormatError> {
    read_with_values(bytes, None).map(|(cloud, _)| cloud)
}

/// Reads the same, and the column of values with a name or a number, if one is wanted.
pub(super) fn read_with_values<const D: usize>(
    bytes: &[u8],
    wanted: Option<&str>,
) -> Result<(PointCloud<D>, Vec<f64>), FormatError> {
    check_encoding(bytes)?;
    let mut table = Table::new(wanted);
    // The line of the count before the points of the current scan, and what the number of points
    // will be after them.
    let mut scan: Option<(usize, usize)> = None;
    let mut row = Vec::new();
    for (line, content) in lines(bytes) {
        if content.is_empty() || content.starts_with(b"#") || content.starts_with(b"//") {
            continue;
        }
        row.clear();
        row.extend(fields(content));
        let points = table.points.len();
        let between_scans = scan.map_or(points == 0, |(_, end)| end == points);
        if let (true, [count]) = (between_scans, row.as_slice())
            && let Some(end) = whole_number(count).and_then(|n| n.checked_add(points))
        {
            scan = Some((line, end));
            table.is_counted = true;
            continue;
        }
        table.add(&row, line)?;
    }
    match scan {
        Some((line, end)) if end != table.points.len() => Err(FormatError::line(
            line,
            format!("the count promises {end} points in all, one per line; the file holds {}", table.points.len()),
        )),
        _ => table.finish(),
    }
}

fn whole_number(field: &[u8]) -> Option<usize> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

/// Reads comma-, semicolon- or tab-separated values with quoted fields; text with white space
/// between is taken too.
pub(super) fn read_csv<const D: usize>(bytes: &[u8]) -> Result<PointCloud<D>, FormatError> {
    read_csv_with_values(bytes, None).map(|(cloud, _)| cloud)
}

/// Reads the same, and the column of values with a name or a number, if one is wanted.
pub(super) fn read_csv_with_values<const D: usize>(
    bytes: &[u8],
    wanted: Option<&str>,
) -> Result<(PointCloud<D>, Vec<f64>), FormatError> {
    check_encoding(bytes)?;
    let first = lines(bytes).map(|(_, line)| line).find(|line| !line.is_empty()).unwrap_or_default();
    // Between tabs, commas are those of decimals.
    let delimiters = if has_decimal_commas(first) { [b';', b'\t', b'\t'] } else { [b';', b',', b'\t'] };
    let Some(delimiter) = delimiters.into_iter().find(|d| first.contains(d)) else {
        return read_with_values(bytes, wanted);
    };
    let text = without_mark(bytes);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .delimiter(delimiter)
        .trim(csv::Trim::All)
        .from_reader(text);
    let mut table = Table::new(wanted);
    let mut record = csv::ByteRecord::new();
    // The crate does not count lines that end in a lone `\r`; the number of the row is used then.
    let counts_lines = text.contains(&b'\n');
    let line_of = |at: &csv::Position| if counts_lines { at.line() } else { at.record() + 1 } as usize;
    loop {
        let start = reader.position().clone();
        match reader.read_byte_record(&mut record) {
            Ok(true) => {}
            Ok(false) => return table.finish(),
            Err(error) => return Err(FormatError::line(line_of(&start), error.to_string())),
        }
        let row: Vec<&[u8]> = record.iter().collect();
        table.add(&row, line_of(record.position().unwrap_or(&start)))?;
    }
}

/// Writes one point per line, with digits enough to read back the same numbers: those of the `f64`
/// of the same value, as a reader of decimals cannot know that single precision is meant.
pub(super) fn write<const D: usize>(mut to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    points.iter().try_for_each(|p| write_row(&mut to, p, " "))
}

pub(super) fn write_csv<const D: usize>(mut to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    writeln!(to, "{}", ["x", "y", "z"][..D].join(","))?;
    points.iter().try_for_each(|p| write_row(&mut to, p, ","))
}

fn write_row<const D: usize>(to: &mut impl Write, p: [f64; D], separator: &str) -> io::Result<()> {
    for (axis, x) in p.iter().enumerate() {
        write!(to, "{}{x:?}", if axis > 0 { separator } else { "" })?;
    }
    writeln!(to)
}
