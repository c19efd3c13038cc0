//! NumPy's `.npy`.
//!
//! Read here because `npyz` allocates what the header promises, multiplies the shape without a
//! check for overflow, and parses the header by recursion of unlimited depth. NumPy writes the
//! header as one line in a fixed form.

use crate::{FormatError, PointBuf, PointCloud, error::quote};
use gdel::Points;
use std::io::{self, Write};

/// The header of an array, and its data.
pub(super) struct Array<'a> {
    big_endian: bool,
    /// `f`, `i` or `u`.
    kind: u8,
    /// Bytes per number.
    size: usize,
    shape: Vec<usize>,
    fortran_order: bool,
    /// The offset of the data in the file, in bytes.
    offset: usize,
    data: &'a [u8],
}

impl<'a> Array<'a> {
    pub(super) fn parse(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let array = Self::parse_header(bytes)?;
        let promised = array.shape.iter().try_fold(array.size, |n, &dimension| n.checked_mul(dimension));
        if promised.is_none_or(|n| n > array.data.len()) {
            return Err(array.truncated(bytes.len()));
        }
        Ok(array)
    }

    /// Parses a file of which not all data may be there: its beginning, or all of it.
    fn parse_header(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let Some(rest) = bytes.strip_prefix(b"\x93NUMPY") else {
            return Err(FormatError::byte(0, "not a NumPy array: it does not start with \\x93NUMPY"));
        };
        let (start, length) = match rest {
            [1, _, a, b, ..] => (10, u16::from_le_bytes([*a, *b]) as usize),
            [2 | 3, _, a, b, c, d, ..] => (12, u32::from_le_bytes([*a, *b, *c, *d]) as usize),
            _ => return Err(FormatError::byte(6, "a version of the format that is not known")),
        };
        let header = bytes[start..].get(..length).ok_or_else(|| {
            FormatError::byte(bytes.len(), format!("the file ends within its header of {length} bytes"))
        })?;
        let invalid = |what: String| FormatError::byte(start, what);
        let value = |key: &str| {
            value_of(header, key).ok_or_else(|| invalid(format!("the header has no `{key}`: {}", quote(header))))
        };
        let descr = value("descr")?;
        let (big_endian, kind, size) = match descr {
            [
                b'\'' | b'"',
                order @ (b'<' | b'>' | b'|' | b'='),
                kind @ (b'f' | b'i' | b'u'),
                size @ (b'1' | b'2' | b'4' | b'8'),
                b'\'' | b'"',
                ..,
            ] => (*order == b'>', *kind, usize::from(size - b'0')),
            _ => return Err(invalid(unsupported(descr))),
        };
        let fortran_order = value("fortran_order")?.starts_with(b"True");
        let shape = tuple(value("shape")?).ok_or_else(|| invalid("the shape is not a tuple of numbers".into()))?;
        let offset = start + length;
        Ok(Array { big_endian, kind, size, shape, fortran_order, offset, data: &bytes[offset..] })
    }

    /// The file ends before its array.
    fn truncated(&self, size: usize) -> FormatError {
        FormatError::byte(size, format!("the file ends before all of its array of shape {:?}", self.shape))
    }

    /// Returns the rows of an array of shape (n, `N`), whatever its order in memory; `decode` gets
    /// a number's bytes in little-endian order.
    fn rows<T, const N: usize, const SIZE: usize>(
        &self,
        decode: fn([u8; SIZE]) -> T,
    ) -> Result<Vec<[T; N]>, FormatError> {
        let count = match *self.shape {
            [count, columns] if columns == N => count,
            _ => {
                let what = format!("an array of shape (n, {N}) expected, found {:?}", self.shape);
                return Err(FormatError::byte(0, what));
            }
        };
        let (numbers, _) = self.data.as_chunks::<SIZE>();
        // Cannot overflow: the data holds the whole array.
        let end = count * N * SIZE;
        if self.data.len() > end {
            let what = "the file goes on after its array: only one array per file is read";
            return Err(FormatError::byte(self.offset + end, what));
        }
        let row = |i: usize| {
            std::array::from_fn(|k| {
                let mut bytes = numbers[if self.fortran_order { k * count + i } else { i * N + k }];
                if self.big_endian {
                    bytes.reverse();
                }
                decode(bytes)
            })
        };
        Ok((0..count).map(row).collect())
    }

    /// Returns the points; of 2D points the third column is dropped.
    pub(super) fn points<const D: usize>(&self) -> Result<PointCloud<D>, FormatError> {
        match *self.shape {
            [_, 3] if D == 2 => Ok(PointCloud::new(self.coordinates::<3>()?)?.resize()),
            [_, 2] if D == 3 => Err(FormatError::byte(0, format!("2D points: the array has shape {:?}", self.shape))),
            _ => PointCloud::new(self.coordinates()?),
        }
    }

    fn coordinates<const D: usize>(&self) -> Result<PointBuf<D>, FormatError> {
        Ok(match (self.kind, self.size) {
            (b'f', 2) => PointBuf::F32(self.rows(|b| half(u16::from_le_bytes(b)))?),
            (b'f', 4) => PointBuf::F32(self.rows(f32::from_le_bytes)?),
            (b'f', 8) => PointBuf::F64(self.rows(f64::from_le_bytes)?),
            (b'i', 8) => PointBuf::F64(exact(self.rows(|b| i64::from_le_bytes(b).into())?)?),
            (b'u', 8) => PointBuf::F64(exact(self.rows(|b| u64::from_le_bytes(b).into())?)?),
            (b'i', 4) => PointBuf::F64(self.rows(|b| f64::from(i32::from_le_bytes(b)))?),
            (b'u', 4) => PointBuf::F64(self.rows(|b| f64::from(u32::from_le_bytes(b)))?),
            (b'i', 2) => PointBuf::F32(self.rows(|b| f32::from(i16::from_le_bytes(b)))?),
            (b'u', 2) => PointBuf::F32(self.rows(|b| f32::from(u16::from_le_bytes(b)))?),
            (b'i', 1) => PointBuf::F32(self.rows(|b| f32::from(i8::from_le_bytes(b)))?),
            (b'u', 1) => PointBuf::F32(self.rows(|[b]| f32::from(b))?),
            _ => return Err(self.unsupported("coordinates")),
        })
    }

    /// Returns the rows as indices.
    pub(super) fn indices<const N: usize>(&self) -> Result<Vec<[i64; N]>, FormatError> {
        match (self.kind, self.size) {
            // A u64 beyond i64 becomes negative, which is rejected as an index.
            (b'i' | b'u', 8) => self.rows(i64::from_le_bytes),
            (b'i', 4) => self.rows(|b| i32::from_le_bytes(b).into()),
            (b'u', 4) => self.rows(|b| u32::from_le_bytes(b).into()),
            _ => Err(self.unsupported("indices")),
        }
    }

    /// Returns the elements of an array of shape (n,) of unsigned 32-bit numbers.
    pub(super) fn vector(&self) -> Result<Vec<u32>, FormatError> {
        let (&[count], (b'u', 4)) = (&self.shape[..], (self.kind, self.size)) else {
            let (kind, size) = (self.kind as char, self.size);
            let what = format!("a vector of type u4 expected, found type {kind}{size} and shape {:?}", self.shape);
            return Err(FormatError::byte(self.offset, what));
        };
        let column = Array { shape: vec![count, 1], ..*self };
        Ok(column.rows::<_, 1, 4>(u32::from_le_bytes)?.into_flattened())
    }

    /// Returns the elements of an array of shape (n,), of numbers of any type.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, FormatError> {
        let &[count] = &self.shape[..] else {
            return Err(FormatError::byte(
                self.offset,
                format!("an array of shape (n,) expected, found {:?}", self.shape),
            ));
        };
        let column = Array { shape: vec![count, 1], ..*self };
        Ok(match column.coordinates::<1>()? {
            PointBuf::F32(rows) => rows.into_flattened().into_iter().map(f64::from).collect(),
            PointBuf::F64(rows) => rows.into_flattened(),
        })
    }

    fn unsupported(&self, what: &str) -> FormatError {
        let what = format!("{what} of type {}{} are not supported", self.kind as char, self.size);
        FormatError::byte(self.offset, what)
    }
}

/// Returns why an element type cannot be read, and what to do about it.
fn unsupported(descr: &[u8]) -> String {
    let end = descr.iter().position(|b| b",}".contains(b)).filter(|_| !descr.starts_with(b"[")).unwrap_or(descr.len());
    let name = quote(&descr[..end]);
    let remedy = "save it with `.astype(float)`";
    match descr {
        [b'\'' | b'"', b'|', b'O', ..] => format!("an array of Python objects (type {name}), not of numbers: {remedy}"),
        [b'\'' | b'"', _, b'c', ..] => format!("an array of complex numbers (type {name})"),
        [b'[', ..] => format!("an array with named fields (type {name}): save its coordinates as columns of one array"),
        _ => format!("an array of an element type that is not read ({name}): {remedy}"),
    }
}

/// Returns the value of a half-precision number.
fn half(bits: u16) -> f32 {
    let (exponent, fraction) = (u32::from(bits >> 10 & 31), u32::from(bits & 0x3ff));
    let magnitude = match exponent {
        // Multiples of 2⁻²⁴, which single precision holds.
        0 => fraction as f32 / 16_777_216.0,
        31 if fraction > 0 => f32::NAN,
        31 => f32::INFINITY,
        // The bias of single precision is greater by 112.
        _ => f32::from_bits((exponent + 112) << 23 | fraction << 13),
    };
    if bits >> 15 == 1 { -magnitude } else { magnitude }
}

/// Converts whole numbers, all of which double precision must hold.
fn exact<const D: usize>(points: Vec<[i128; D]>) -> Result<Vec<[f64; D]>, FormatError> {
    let rounded = |&x: &i128| x as f64 as i128 != x;
    if let Some((index, x)) = points.iter().enumerate().find_map(|(i, p)| Some((i, p.iter().copied().find(rounded)?))) {
        return Err(FormatError::point(index, format!("{x} has more digits than double precision can hold")));
    }
    Ok(points.into_iter().map(|p| p.map(|x| x as f64)).collect())
}

/// Returns the text after `'key':` in the header's dictionary.
fn value_of<'a>(header: &'a [u8], key: &str) -> Option<&'a [u8]> {
    ['\'', '"'].iter().find_map(|quote| {
        let key = format!("{quote}{key}{quote}");
        let at = header.windows(key.len()).position(|window| window == key.as_bytes())?;
        Some(header[at + key.len()..].trim_ascii_start().strip_prefix(b":")?.trim_ascii_start())
    })
}

fn tuple(value: &[u8]) -> Option<Vec<usize>> {
    let inside = value.strip_prefix(b"(")?.split(|&b| b == b')').next()?;
    let text = std::str::from_utf8(inside).ok()?;
    text.split(',').map(str::trim).filter(|number| !number.is_empty()).map(|number| number.parse().ok()).collect()
}

pub(super) fn read<const D: usize>(bytes: &[u8]) -> Result<PointCloud<D>, FormatError> {
    Array::parse(bytes)?.points()
}

pub(super) fn write<const D: usize>(to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    match points {
        Points::F32(p) => write_array(to, "<f4", p, f32::to_le_bytes),
        Points::F64(p) => write_array(to, "<f8", p, f64::to_le_bytes),
    }
}

/// Writes an array of shape (n, `N`), version 1.0 of the format.
pub(super) fn write_array<T: Copy, const N: usize, const SIZE: usize>(
    mut to: impl Write,
    descr: &str,
    rows: &[[T; N]],
    encode: fn(T) -> [u8; SIZE],
) -> io::Result<()> {
    write_header(&mut to, descr, &format!("({}, {N})", rows.len()))?;
    rows.as_flattened().iter().try_for_each(|&x| to.write_all(&encode(x)))
}

/// Writes an array of shape (n,), version 1.0 of the format.
pub(super) fn write_vector<T: Copy, const SIZE: usize>(
    mut to: impl Write,
    descr: &str,
    elements: &[T],
    encode: impl Fn(T) -> [u8; SIZE],
) -> io::Result<()> {
    write_header(&mut to, descr, &format!("({},)", elements.len()))?;
    elements.iter().try_for_each(|&x| to.write_all(&encode(x)))
}

/// Writes 64-bit numbers of a grid with so many cells along each axis, of which the first changes fastest.
pub(super) fn write_grid(mut to: impl Write, size: &[usize], numbers: &[f64]) -> io::Result<()> {
    let shape: Vec<String> = size.iter().rev().map(usize::to_string).collect();
    write_header(&mut to, "<f8", &format!("({})", shape.join(", ")))?;
    numbers.iter().try_for_each(|x| to.write_all(&x.to_le_bytes()))
}

fn write_header(to: &mut impl Write, descr: &str, shape: &str) -> io::Result<()> {
    let dictionary = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    // With the ten bytes before it and the line end, the header fills a multiple of 64 bytes.
    let padded = (dictionary.len() + 11).next_multiple_of(64) - 11;
    to.write_all(b"\x93NUMPY\x01\x00")?;
    to.write_all(&(padded as u16 + 1).to_le_bytes())?;
    writeln!(to, "{dictionary:padded$}")
}

#[cfg(not(target_arch = "wasm32"))]
pub(super) use rows::Rows;

/// Rows a few at a time, for files that are larger than memory.
#[cfg(not(target_arch = "wasm32"))]
mod rows {
    use super::{Array, FormatError, PointCloud};

    /// What the header of a file of points says, for reading them a few at a time.
    pub(crate) struct Rows {
        header: Vec<u8>,
        /// The number of points.
        pub(crate) count: usize,
        /// Bytes of a point.
        pub(crate) stride: usize,
        /// The byte at which the points begin.
        pub(crate) offset: usize,
    }

    impl Rows {
        /// Returns the rows of a file of `size` bytes that begins with these bytes; `None` if they are not points of `D`
        /// dimensions, one after the other.
        pub(crate) fn new<const D: usize>(beginning: &[u8], size: u64) -> Result<Option<Self>, FormatError> {
            let array = Array::parse_header(beginning)?;
            let (false, &[count, columns]) = (array.fortran_order, &array.shape[..]) else { return Ok(None) };
            let bytes = columns.checked_mul(array.size).and_then(|stride| Some((stride, stride.checked_mul(count)?)));
            if columns != 3 && columns != D {
                return Ok(None);
            }
            let Some((stride, _)) = bytes.filter(|&(_, all)| array.offset as u64 + all as u64 == size) else {
                return Ok(None);
            };
            let header = beginning[..array.offset].to_vec();
            Ok(Some(Rows { header, count, stride, offset: array.offset }))
        }

        /// Returns the points in the bytes of some rows.
        pub(crate) fn points<const D: usize>(&self, bytes: &[u8]) -> Result<PointCloud<D>, FormatError> {
            let mut array = Array::parse_header(&self.header)?;
            array.data = bytes;
            array.shape[0] = bytes.len().checked_div(self.stride).unwrap_or(0);
            array.points()
        }
    }
}
