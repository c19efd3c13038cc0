//! PCD, the Point Cloud Library's format.
//!
//! Read here because `pcd-rs` allocates what a header says (4 GiB for eight bytes) and panics when the sizes of
//! compressed data disagree with its header, and because the `lzf` crate is deprecated.

use crate::io::{
    FormatError, PointCloud,
    error::quote,
    point_cloud::narrow,
    text::{fields, lines},
};

/// The type of a field.
#[derive(Clone, Copy, PartialEq)]
enum Scalar {
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
    F32,
    F64,
}

impl Scalar {
    fn new(kind: &[u8], size: usize) -> Option<Self> {
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

    /// Whether `f32` holds every value.
    fn is_single(self) -> bool {
        !matches!(self, Scalar::I32 | Scalar::I64 | Scalar::U32 | Scalar::U64 | Scalar::F64)
    }

    /// The value at the start of `bytes`, which hold at least one.
    fn decode(self, bytes: &[u8]) -> f64 {
        fn at<const N: usize>(bytes: &[u8]) -> [u8; N] {
            std::array::from_fn(|i| bytes[i])
        }
        match self {
            Scalar::I8 => i8::from_le_bytes(at(bytes)).into(),
            Scalar::I16 => i16::from_le_bytes(at(bytes)).into(),
            Scalar::I32 => i32::from_le_bytes(at(bytes)).into(),
            Scalar::I64 => i64::from_le_bytes(at(bytes)) as f64,
            Scalar::U8 => bytes[0].into(),
            Scalar::U16 => u16::from_le_bytes(at(bytes)).into(),
            Scalar::U32 => u32::from_le_bytes(at(bytes)).into(),
            Scalar::U64 => u64::from_le_bytes(at(bytes)) as f64,
            Scalar::F32 => f32::from_le_bytes(at(bytes)).into(),
            Scalar::F64 => f64::from_le_bytes(at(bytes)),
        }
    }

    fn parse(self, field: &[u8], line: usize) -> Result<f64, FormatError> {
        let text = std::str::from_utf8(field).ok();
        let value = match self {
            Scalar::F32 => text.and_then(|t| t.parse::<f32>().ok()).map(f64::from),
            _ => text.and_then(|t| t.parse().ok()),
        };
        value.ok_or_else(|| FormatError::line(line, format!("{} is not a number", quote(field))))
    }
}

struct Field {
    is_axis: Option<usize>,
    scalar: Scalar,
    size: usize,
    count: usize,
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
    /// Where the data starts: the byte, and the number of the line.
    offset: usize,
    line: usize,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Self, FormatError> {
        let mut names: Vec<&[u8]> = Vec::new();
        let [mut sizes, mut kinds, mut counts] = [const { Vec::<&[u8]>::new() }; 3];
        let [mut width, mut height, mut points] = [None; 3];
        let mut offset = 0;
        for (line, content) in lines(bytes) {
            offset += bytes[offset..].iter().position(|&b| b == b'\n').map_or(bytes.len() - offset, |at| at + 1);
            let mut words = content.split(|b| b.is_ascii_whitespace()).filter(|word| !word.is_empty());
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
                    let grid = width.and_then(|w| w.checked_mul(height.unwrap_or(1)));
                    let points = points
                        .or(grid)
                        .ok_or_else(|| FormatError::line(line, "the header gives no number of POINTS"))?;
                    let fields =
                        declare(&names, &sizes, &kinds, &counts).map_err(|what| FormatError::line(line, what))?;
                    return Ok(Header { fields, points, encoding, offset, line: line + 1 });
                }
                b"VERSION" | b"VIEWPOINT" => {}
                comment if comment.starts_with(b"#") => {}
                other => {
                    return Err(FormatError::line(line, format!("{} is no keyword of a PCD header", quote(other))));
                }
            }
        }
        Err(FormatError::byte(bytes.len(), "the file ends within its header: there is no DATA line"))
    }

    /// The bytes of one point.
    fn record(&self) -> usize {
        self.fields.iter().map(|f| f.size * f.count).sum()
    }

    fn is_single(&self) -> bool {
        self.fields.iter().filter(|f| f.is_axis.is_some()).all(|f| f.scalar.is_single())
    }
}

fn integer(word: &[u8]) -> Option<usize> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

fn declare(names: &[&[u8]], sizes: &[&[u8]], kinds: &[&[u8]], counts: &[&[u8]]) -> Result<Vec<Field>, String> {
    /// More than any real record has, so that sums stay small.
    const LARGEST_COUNT: usize = 1 << 20;
    if sizes.len() != names.len() || kinds.len() != names.len() || !(counts.is_empty() || counts.len() == names.len()) {
        return Err("FIELDS, SIZE, TYPE and COUNT have different numbers of entries".into());
    }
    let axes: [&[u8]; 3] = [b"x", b"y", b"z"];
    let mut fields = Vec::new();
    for (i, name) in names.iter().enumerate() {
        let size = integer(sizes[i]).ok_or_else(|| format!("SIZE {} is not a number", quote(sizes[i])))?;
        let scalar = Scalar::new(kinds[i], size)
            .ok_or_else(|| format!("a field of TYPE {} and SIZE {size} is not known", quote(kinds[i])))?;
        let count = match counts.get(i).map(|word| (word, integer(word))) {
            // PCL takes 0 for 1.
            None | Some((_, Some(0))) => 1,
            Some((_, Some(count))) if count <= LARGEST_COUNT => count,
            Some((word, _)) => return Err(format!("COUNT {} is not a sensible number", quote(word))),
        };
        fields.push(Field { is_axis: axes.iter().position(|axis| axis == name), scalar, size, count });
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
    let all = match header.encoding {
        Encoding::Ascii => read_ascii(data, &header)?,
        Encoding::Binary => {
            let size = header.points.checked_mul(header.record());
            let records = size.and_then(|size| data.get(..size)).ok_or_else(|| {
                let what = format!("the file ends here, but its header promises {} points", header.points);
                FormatError::byte(bytes.len(), what)
            })?;
            let mut start = 0;
            let columns = header.fields.iter().map(|field| {
                let column = Column { field, start, stride: header.record() };
                start += field.size * field.count;
                column
            });
            decode(records, columns, header.points)
        }
        Encoding::Compressed => {
            let (compressed, size) = compressed_block(bytes, &header)?;
            let records = decompress_lzf(compressed, size)
                .ok_or_else(|| FormatError::byte(header.offset + 8, "the compressed data is broken"))?;
            let mut start = 0;
            let columns = header.fields.iter().map(|field| {
                let column = Column { field, start, stride: field.size * field.count };
                start += field.size * field.count * header.points;
                column
            });
            decode(&records, columns, header.points)
        }
    };
    let read = all.len();
    let points: Vec<_> = all.into_iter().filter(|p| !p.iter().any(|x| x.is_nan())).collect();
    let no_return = read - points.len();
    PointCloud::without_no_return(narrow(points, header.is_single()), no_return)
}

fn read_ascii(data: &[u8], header: &Header) -> Result<Vec<[f64; 3]>, FormatError> {
    let mut points = Vec::new();
    let mut last = header.line;
    for (line, content) in lines(data).map(|(line, content)| (line - 1 + header.line, content)) {
        if content.is_empty() || points.len() == header.points {
            continue;
        }
        last = line;
        let row: Vec<&[u8]> = fields(content).collect();
        let mut point = [0.0; 3];
        let mut at = 0;
        for field in &header.fields {
            if let Some(axis) = field.is_axis {
                let word = row.get(at).ok_or_else(|| {
                    FormatError::line(line, format!("only {} values where the header promises more", row.len()))
                })?;
                point[axis] = field.scalar.parse(word, line)?;
            }
            at += field.count;
        }
        points.push(point);
    }
    if points.len() < header.points {
        let what =
            format!("the file ends after {} of the {} points that its header promises", points.len(), header.points);
        return Err(FormatError::line(last, what));
    }
    Ok(points)
}

/// Where a field's values are: the first, and how far it is from one to the next.
struct Column<'a> {
    field: &'a Field,
    start: usize,
    stride: usize,
}

/// The points in `records`, which hold `count` values of each column.
fn decode<'a>(records: &[u8], columns: impl Iterator<Item = Column<'a>>, count: usize) -> Vec<[f64; 3]> {
    let mut points = vec![[0.0; 3]; count];
    for column in columns {
        if let Some(axis) = column.field.is_axis {
            for (i, point) in points.iter_mut().enumerate() {
                point[axis] = column.field.scalar.decode(&records[column.start + i * column.stride..]);
            }
        }
    }
    points
}

/// The compressed data, and its size when decompressed: all points, a field after the other.
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
    // Nothing larger can come of it, and is not allocated.
    if size > compressed.saturating_mul(LARGEST_LZF_RATIO) {
        return Err(FormatError::byte(header.offset + 4, format!("{compressed} bytes cannot expand to {size}")));
    }
    Ok((data, size))
}

/// Three bytes of LZF stand for at most 264.
const LARGEST_LZF_RATIO: usize = 88;

/// Decompresses LZF: literal runs of up to 32 bytes (a byte below 32 goes before them) and matches of up to 264 bytes
/// at a distance of up to 8192. `None` when the data is broken or does not make `size` bytes.
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
