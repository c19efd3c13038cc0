//! PCD, the Point Cloud Library's format.
//!
//! Read here because `pcd-rs` allocates what a header says (4 GiB for eight bytes) and panics when
//! the sizes of compressed data disagree with its header, and because the `lzf` crate is
//! deprecated.

use crate::{
    FormatError, PointCloud,
    colors::{CHANNELS, Colors, Range, Sample, channel},
    error::quote,
    point_cloud::narrow,
    scalar::Scalar,
    text::{fields, lines, split_line, without_mark},
};

struct Field {
    is_axis: Option<usize>,
    tint: Option<Tint>,
    scalar: Scalar,
    count: usize,
}

impl Field {
    /// Returns the number of bytes of its values in a point.
    fn size(&self) -> usize {
        self.scalar.size() * self.count
    }
}

/// How a field contributes to the colour of a point.
#[derive(Clone, Copy)]
enum Tint {
    /// A number of the sample.
    Channel(usize),
    /// Red, green and blue in the bits of four bytes, from the third to the lowest.
    Packed,
}

impl Tint {
    fn of(name: &[u8], scalar: Scalar, count: usize) -> Option<Self> {
        match name {
            _ if count != 1 => None,
            b"rgb" | b"rgba" => (scalar.size() == 4).then_some(Tint::Packed),
            _ => channel(name).map(Tint::Channel),
        }
    }

    /// Puts a value of a binary file, in `bytes`, into the sample of its point.
    fn decode(self, scalar: Scalar, bytes: &[u8], sample: &mut Sample) {
        match self {
            Tint::Channel(channel) => sample[channel] = scalar.decode(bytes, false),
            Tint::Packed => bytes.first_chunk().map_or((), |bits| unpack(u32::from_le_bytes(*bits), sample)),
        }
    }

    /// Puts a value of a text file into the sample of its point, if it makes sense.
    fn parse(self, scalar: Scalar, word: &[u8], sample: &mut Sample) {
        let Some(value) = scalar.parse(word).filter(|value| value.is_finite()) else { return };
        match self {
            Tint::Channel(channel) => sample[channel] = value,
            // The library declares the bits to be those of a floating-point number.
            Tint::Packed if scalar == Scalar::F32 => unpack((value as f32).to_bits(), sample),
            Tint::Packed => unpack(value as i64 as u32, sample),
        }
    }
}

fn unpack(bits: u32, sample: &mut Sample) {
    for (x, shift) in sample.iter_mut().zip([16, 8, 0]) {
        *x = f64::from(bits >> shift & 0xff);
    }
}

fn scalar(kind: &[u8], size: usize) -> Option<Scalar> {
    Some(match (kind, size) {
        (b"I", 1) => Scalar::I8,
        (b"I", 2) => Scalar::I16,
        (b"I", 4) => Scalar::I32,
        (b"I", 8) => Scalar::I64,
        (b"U", 1) => Scalar::U8,
        (b"U", 2) => Scalar::U16,
        (b"U", 4) => Scalar::U32,
        (b"U", 8) => Scalar::U64,
        (b"F", 4) => Scalar::F32,
        (b"F", 8) => Scalar::F64,
        _ => return None,
    })
}

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    Binary,
    Compressed,
}

struct Header {
    fields: Vec<Field>,
    points: usize,
    encoding: Encoding,
    /// The position of the sensor, if the file gives one that means something.
    sensor: Option<[f64; 3]>,
    /// Where the data starts: the byte, and the number of the line.
    offset: usize,
    line: usize,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Self, FormatError> {
        let mut names: Vec<&[u8]> = Vec::new();
        let [mut sizes, mut kinds, mut counts] = [const { Vec::<&[u8]>::new() }; 3];
        let [mut width, mut height, mut points] = [None; 3];
        let mut viewpoint = None;
        let mut rest = without_mark(bytes);
        for line in 1.. {
            if rest.is_empty() {
                break;
            }
            let content;
            (content, rest) = split_line(rest);
            let mut words = content.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            let Some(keyword) = words.next() else { continue };
            let count = || {
                let word = words.clone().next().unwrap_or_default();
                integer(word).ok_or_else(|| FormatError::line(line, format!("{} is not a count", quote(word))))
            };
            match keyword {
                b"FIELDS" | b"COLUMNS" => names = words.collect(),
                b"SIZE" => sizes = words.collect(),
                b"TYPE" => kinds = words.collect(),
                b"COUNT" => counts = words.collect(),
                b"WIDTH" => width = Some(count()?),
                b"HEIGHT" => height = Some(count()?),
                b"POINTS" => points = Some(count()?),
                b"DATA" => {
                    let encoding = match words.next().unwrap_or_default() {
                        b"ascii" => Encoding::Ascii,
                        b"binary" => Encoding::Binary,
                        b"binary_compressed" => Encoding::Compressed,
                        other => return Err(FormatError::line(line, format!("DATA {} is not known", quote(other)))),
                    };
                    let grid = width.map(|w: usize| w.checked_mul(height.unwrap_or(1)));
                    let points = match (points, grid) {
                        (Some(points), None) => points,
                        (Some(points), Some(grid)) if grid == Some(points) => points,
                        (None, Some(Some(grid))) => grid,
                        (None, None) => {
                            return Err(FormatError::line(line, "the header gives no number of POINTS"));
                        }
                        (_, Some(_)) => {
                            let [w, h, n] = [width, height, points].map(|n| n.map_or("none".into(), |n| n.to_string()));
                            let what = format!("WIDTH {w} and HEIGHT {h} do not make POINTS {n}");
                            return Err(FormatError::line(line, what));
                        }
                    };
                    let fields =
                        declare(&names, &sizes, &kinds, &counts).map_err(|what| FormatError::line(line, what))?;
                    let offset = bytes.len() - rest.len();
                    // All programs write the origin, also for clouds of many scans; a grid is one scan.
                    let is_grid = height.is_some_and(|height| height > 1);
                    let sensor = viewpoint.filter(|&at| is_grid || at != [0.0; 3]);
                    return Ok(Header { fields, points, encoding, sensor, offset, line: line + 1 });
                }
                b"VERSION" => {}
                b"VIEWPOINT" => viewpoint = position(words),
                comment if comment.starts_with(b"#") => {}
                other => {
                    return Err(FormatError::line(line, format!("{} is not a keyword of a PCD header", quote(other))));
                }
            }
        }
        Err(FormatError::byte(bytes.len(), "the file ends within its header: there is no DATA line"))
    }

    /// Returns the number of bytes of a point.
    fn record(&self) -> usize {
        self.fields.iter().map(Field::size).sum()
    }

    /// Begins to gather the points' colours.
    fn colors(&self) -> Colors {
        let mut has = [false; CHANNELS];
        let mut range = Range::Bytes;
        for field in &self.fields {
            match field.tint {
                Some(Tint::Packed) => has[..3].fill(true),
                Some(Tint::Channel(channel)) => {
                    has[channel] = true;
                    if channel == 0 {
                        range = if field.scalar.is_integer() { Range::Words } else { Range::Fractions };
                    }
                }
                None => {}
            }
        }
        Colors::new(has, range)
    }

    fn is_single(&self) -> bool {
        self.fields.iter().filter(|f| f.is_axis.is_some()).all(|f| f.scalar.is_single())
    }
}

/// Returns the position that a viewpoint begins with.
fn position<'a>(words: impl Iterator<Item = &'a [u8]>) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = words.take(3).filter_map(|word| std::str::from_utf8(word).ok()?.parse().ok()).collect();
    numbers.try_into().ok().filter(|position: &[f64; 3]| position.iter().all(|x| x.is_finite()))
}

fn integer(word: &[u8]) -> Option<usize> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

fn declare(names: &[&[u8]], sizes: &[&[u8]], kinds: &[&[u8]], counts: &[&[u8]]) -> Result<Vec<Field>, String> {
    /// A limit above that of any real record, so that sums cannot overflow.
    const LARGEST_COUNT: usize = 1 << 20;
    if sizes.len() != names.len() || kinds.len() != names.len() || !(counts.is_empty() || counts.len() == names.len()) {
        return Err("FIELDS, SIZE, TYPE and COUNT have different numbers of entries".into());
    }
    let axes: [&[u8]; 3] = [b"x", b"y", b"z"];
    let mut fields = Vec::new();
    for (i, name) in names.iter().enumerate() {
        let size = integer(sizes[i]).ok_or_else(|| format!("SIZE {} is not a number", quote(sizes[i])))?;
        let scalar = scalar(kinds[i], size)
            .ok_or_else(|| format!("a field of TYPE {} and SIZE {size} is not known", quote(kinds[i])))?;
        let is_axis = axes.iter().position(|axis| axis == name);
        let count = match counts.get(i).map(|word| (word, integer(word))) {
            None => 1,
            Some((_, Some(1))) => 1,
            // Programs disagree whether 0 means 1 or none of what is used; else it is none.
            Some((_, Some(0))) if is_axis.is_none() && Tint::of(name, scalar, 1).is_none() => 0,
            Some((_, Some(count))) if is_axis.is_none() && (1..=LARGEST_COUNT).contains(&count) => count,
            Some((word, _)) => {
                let must = if is_axis.is_some() { "must be 1" } else { "is not a sensible number" };
                return Err(format!("COUNT {} of the field {} {must}", quote(word), quote(name)));
            }
        };
        fields.push(Field { is_axis, tint: Tint::of(name, scalar, count), scalar, count });
    }
    for (k, axis) in ["x", "y", "z"].iter().enumerate() {
        if fields.iter().filter(|f| f.is_axis == Some(k)).count() != 1 {
            return Err(format!("there must be one field `{axis}`"));
        }
    }
    Ok(fields)
}

pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let header = Header::parse(bytes)?;
    let data = &bytes[header.offset..];
    let mut colors = header.colors();
    let all = match header.encoding {
        Encoding::Ascii => read_ascii(data, &header, &mut colors)?,
        Encoding::Binary => {
            let size = header.points.checked_mul(header.record());
            let records = size.and_then(|size| data.get(..size)).ok_or_else(|| {
                let what = format!("the file ends here, but its header promises {} points", header.points);
                FormatError::byte(bytes.len(), what)
            })?;
            // Some programs pad the file with zeros.
            let end = header.offset + records.len();
            if bytes.len() - end >= header.record() && bytes[end..].iter().any(|&b| b != 0) {
                return Err(goes_on(FormatError::byte, end, header.points));
            }
            let mut start = 0;
            let columns = header.fields.iter().map(|field| {
                let column = Column { field, start, stride: header.record() };
                start += field.size();
                column
            });
            decode(records, columns, header.points, &mut colors)
        }
        Encoding::Compressed => {
            let (compressed, size) = compressed_block(bytes, &header)?;
            let records = decompress_lzf(compressed, size)
                .ok_or_else(|| FormatError::byte(header.offset + 8, "the compressed data is broken"))?;
            let mut start = 0;
            let columns = header.fields.iter().map(|field| {
                let column = Column { field, start, stride: field.size() };
                start += field.size() * header.points;
                column
            });
            decode(&records, columns, header.points, &mut colors)
        }
    };
    let read = all.len();
    let points: Vec<_> = all.into_iter().filter(has_return).collect();
    let no_return = read - points.len();
    let cloud = PointCloud::new(narrow(points, header.is_single()))?.colored(colors);
    Ok(PointCloud { no_return, sensors: Vec::from_iter(header.sensor), ..cloud })
}

/// Returns whether a point has coordinates.
fn has_return(point: &[f64; 3]) -> bool {
    !point.iter().any(|x| x.is_nan())
}

fn goes_on(at: fn(usize, String) -> FormatError, place: usize, points: usize) -> FormatError {
    at(place, format!("the file goes on after the {points} points that its header promises"))
}

fn read_ascii(data: &[u8], header: &Header, colors: &mut Colors) -> Result<Vec<[f64; 3]>, FormatError> {
    let mut points = Vec::new();
    let mut last = header.line;
    for (line, content) in lines(data).map(|(line, content)| (line - 1 + header.line, content)) {
        if content.is_empty() {
            continue;
        }
        if points.len() == header.points {
            return Err(goes_on(FormatError::line, line, header.points));
        }
        last = line;
        let row: Vec<&[u8]> = fields(content).collect();
        let mut point = [0.0; 3];
        let mut sample = [f64::NAN; CHANNELS];
        let mut at = 0;
        for field in &header.fields {
            if let Some(axis) = field.is_axis {
                let word = row.get(at).ok_or_else(|| {
                    FormatError::line(line, format!("only {} values where the header promises more", row.len()))
                })?;
                let value = field.scalar.parse(word);
                point[axis] =
                    value.ok_or_else(|| FormatError::line(line, format!("{} is not a number", quote(word))))?;
            }
            if let (Some(tint), Some(word)) = (field.tint, row.get(at)) {
                tint.parse(field.scalar, word, &mut sample);
            }
            at += field.count;
        }
        points.push(point);
        if has_return(&point) {
            colors.push(&sample);
        }
    }
    if points.len() < header.points {
        let what =
            format!("the file ends after {} of the {} points that its header promises", points.len(), header.points);
        return Err(FormatError::line(last, what));
    }
    Ok(points)
}

/// The place of a field's first value, and the distance from one value to the next.
struct Column<'a> {
    field: &'a Field,
    start: usize,
    stride: usize,
}

impl Column<'_> {
    /// Returns the bytes of a point's value and of what comes after it.
    fn bytes<'r>(&self, records: &'r [u8], point: usize) -> &'r [u8] {
        &records[self.start + point * self.stride..]
    }
}

/// Decodes the points in `records`, which hold `count` values of each column, and the colours of
/// those with coordinates.
fn decode<'a>(
    records: &[u8],
    columns: impl Iterator<Item = Column<'a>>,
    count: usize,
    colors: &mut Colors,
) -> Vec<[f64; 3]> {
    let mut points = vec![[0.0; 3]; count];
    let mut tinted = Vec::new();
    for column in columns {
        if let Some(axis) = column.field.is_axis {
            for (i, point) in points.iter_mut().enumerate() {
                point[axis] = column.field.scalar.decode(column.bytes(records, i), false);
            }
        }
        tinted.extend(column.field.tint.map(|tint| (tint, column)));
    }
    if !tinted.is_empty() {
        for (i, _) in points.iter().enumerate().filter(|(_, point)| has_return(point)) {
            let mut sample = [f64::NAN; CHANNELS];
            for (tint, column) in &tinted {
                tint.decode(column.field.scalar, column.bytes(records, i), &mut sample);
            }
            colors.push(&sample);
        }
    }
    points
}

/// Returns the compressed data, and its size when decompressed: all points, field by field.
fn compressed_block<'a>(bytes: &'a [u8], header: &Header) -> Result<(&'a [u8], usize), FormatError> {
    let ends = || FormatError::byte(bytes.len(), "the file ends within its compressed data");
    let (sizes, data) = bytes[header.offset..].split_first_chunk::<8>().ok_or_else(ends)?;
    let [a, b, c, d, e, f, g, h] = *sizes;
    let [compressed, size] = [[a, b, c, d], [e, f, g, h]].map(|n| u32::from_le_bytes(n) as usize);
    let data = data.get(..compressed).ok_or_else(ends)?;
    if header.points.checked_mul(header.record()) != Some(size) {
        let what = format!("{size} bytes of data do not match {} points of {}", header.points, header.record());
        return Err(FormatError::byte(header.offset + 4, what));
    }
    // The data cannot decompress to more, so no more is allocated.
    if size > compressed.saturating_mul(LARGEST_LZF_RATIO) {
        return Err(FormatError::byte(header.offset + 4, format!("{compressed} bytes cannot expand to {size}")));
    }
    Ok((data, size))
}

/// Three bytes of LZF stand for at most 264.
const LARGEST_LZF_RATIO: usize = 88;

/// Decompresses LZF: literal runs of up to 32 bytes (a byte below 32 goes before them) and matches
/// of up to 264 bytes at a distance of up to 8192. `None` when the data is broken or does not make
/// `size` bytes.
fn decompress_lzf(mut data: &[u8], size: usize) -> Option<Vec<u8>> {
    let mut output = Vec::with_capacity(size);
    while let Some((&control, rest)) = data.split_first() {
        data = rest;
        if control < 32 {
            let (literal, rest) = data.split_at_checked(usize::from(control) + 1)?;
            data = rest;
            output.extend_from_slice(literal);
        } else {
            let mut length = usize::from(control >> 5) + 2;
            if length == 9 {
                length += usize::from(*data.split_off_first()?);
            }
            let distance = (usize::from(control & 31) << 8) + usize::from(*data.split_off_first()?) + 1;
            let start = output.len().checked_sub(distance)?;
            // A match may reach into its own output, which repeats the last `distance` bytes.
            for i in start..start + length {
                output.push(output[i]);
            }
        }
        if output.len() > size {
            return None;
        }
    }
    (output.len() == size).then_some(output)
}
