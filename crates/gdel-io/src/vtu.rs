//! VTK's XML unstructured grid.
//!
//! Written and read here, with `quick-xml` for the XML: the newest `vtkio` (0.7) is a
//! release candidate.

use crate::{
    FormatError, Mesh, MeshData, PointBuf,
    error::quote,
    mesh::{HIDDEN, WEIGHT},
    point_cloud::narrow,
    scalar::Scalar,
    surface::{MARK, padded},
};
use base64::{
    Engine, alphabet,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use flate2::read::ZlibDecoder;
use gdel::Points;
use quick_xml::{
    Reader,
    events::{BytesStart, Event},
};
use std::io::{self, Read, Write};

/// Writes points and tetrahedra or triangles, as binary data appended to the XML, which is exact
/// and the fastest to load. 2D points get *z* = 0. Weighted points have the data `weight` and `hidden`, which is 1 for
/// those that are no vertices because of their weights, else 0.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_vtu<const D: usize, const N: usize, M: Mesh<D, N>>(
    to: impl Write,
    points: Points<'_, D>,
    mesh: &M,
) -> io::Result<()> {
    let (number, size) = match points {
        Points::F32(_) => ("Float32", 4),
        Points::F64(_) => ("Float64", 8),
    };
    let cells = mesh.simplices().len() as u64;
    let coordinates = |to: &mut dyn Write| {
        points.iter().flat_map(padded).try_for_each(|x| match points {
            Points::F32(_) => to.write_all(&(x as f32).to_le_bytes()),
            Points::F64(_) => to.write_all(&x.to_le_bytes()),
        })
    };
    let connectivity = |to: &mut dyn Write| {
        let mut vertices = mesh.simplices().as_flattened().iter();
        vertices.try_for_each(|&v| to.write_all(&u64::from(v).to_le_bytes()))
    };
    let offsets = |to: &mut dyn Write| (1..=cells).try_for_each(|cell| to.write_all(&(N as u64 * cell).to_le_bytes()));
    let types = |to: &mut dyn Write| (0..cells).try_for_each(|_| to.write_all(&[M::NAMES.vtk]));
    let weights = |to: &mut dyn Write| mesh.weights().iter().try_for_each(|weight| to.write_all(&weight.to_le_bytes()));
    let mut arrays = Vec::new();
    if !mesh.weights().is_empty() {
        let mut is_hidden = vec![0; points.len()];
        for &i in mesh.hidden() {
            if let Some(flag) = is_hidden.get_mut(i as usize) {
                *flag = 1;
            }
        }
        arrays.push(Array::written("PointData", WEIGHT, "Float64", 1, mesh.weights().len() as u64 * 8, &weights));
        arrays.push(Array::new("PointData", HIDDEN, "UInt8", 1, is_hidden));
    }
    arrays.extend([
        Array::written("Points", "Points", number, 3, points.len() as u64 * 3 * size, &coordinates),
        Array::written("Cells", "connectivity", "Int64", 1, cells * N as u64 * 8, &connectivity),
        Array::written("Cells", "offsets", "Int64", 1, cells * 8, &offsets),
        Array::written("Cells", "types", "UInt8", 1, cells, &types),
    ]);
    write_arrays(to, points.len(), mesh.simplices().len(), &arrays)
}

/// An array of a grid.
pub(super) struct Array<'a> {
    /// The XML element that it belongs to; those of one element come one after the other.
    element: &'a str,
    name: &'a str,
    /// The type of its numbers.
    kind: &'a str,
    components: u32,
    /// In bytes.
    length: u64,
    content: Content<'a>,
}

/// The bytes of an array: kept, or written when they are needed.
enum Content<'a> {
    Bytes(Vec<u8>),
    Written(&'a dyn Fn(&mut dyn Write) -> io::Result<()>),
}

impl<'a> Array<'a> {
    pub(super) fn new(element: &'a str, name: &'a str, kind: &'a str, components: u32, bytes: Vec<u8>) -> Self {
        Array { element, name, kind, components, length: bytes.len() as u64, content: Content::Bytes(bytes) }
    }

    /// Creates an array of `length` bytes that is written when it is needed.
    pub(super) fn written(
        element: &'a str,
        name: &'a str,
        kind: &'a str,
        components: u32,
        length: u64,
        write: &'a dyn Fn(&mut dyn Write) -> io::Result<()>,
    ) -> Self {
        Array { element, name, kind, components, length, content: Content::Written(write) }
    }
}

/// Writes a grid whose arrays are appended to the XML, each after its length in eight bytes.
pub(super) fn write_arrays(mut to: impl Write, points: usize, cells: usize, arrays: &[Array<'_>]) -> io::Result<()> {
    write!(
        to,
        r#"<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <!-- {MARK} -->
  <UnstructuredGrid>
    <Piece NumberOfPoints="{points}" NumberOfCells="{cells}">
"#
    )?;
    let mut offset = 0;
    for of_element in arrays.chunk_by(|a, b| a.element == b.element) {
        writeln!(to, "      <{}>", of_element[0].element)?;
        for Array { name, kind, components, length, .. } in of_element {
            write!(to, r#"        <DataArray type="{kind}" Name="{name}""#)?;
            if *components > 1 {
                write!(to, r#" NumberOfComponents="{components}""#)?;
            }
            writeln!(to, r#" format="appended" offset="{offset}"/>"#)?;
            offset += 8 + length;
        }
        writeln!(to, "      </{}>", of_element[0].element)?;
    }
    write!(
        to,
        r#"    </Piece>
  </UnstructuredGrid>
  <AppendedData encoding="raw">
_"#
    )?;
    for Array { length, content, .. } in arrays {
        to.write_all(&length.to_le_bytes())?;
        match content {
            Content::Bytes(bytes) => to.write_all(bytes)?,
            Content::Written(write) => write(&mut to)?,
        }
    }
    to.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
}

/// Reads points and tetrahedra or triangles, in all encodings: ASCII, base64, appended, compressed
/// with zlib.
///
/// # Errors
///
/// Returns where the file is broken, and how. Cells of other types are errors, as are 2D points
/// with a *z* other than 0.
pub fn read_vtu<M: Mesh<D, N>, const D: usize, const N: usize>(bytes: &[u8]) -> Result<MeshData<D, N>, FormatError> {
    let names = M::NAMES;
    let file = File::parse(bytes)?;
    let types = file.integers("types")?;
    if let Some(cell) = types.iter().position(|&t| t != i64::from(names.vtk)) {
        let what = format!("cell {cell} is not a {}, but of VTK's type {}", names.simplex, types[cell]);
        return Err(FormatError::byte(0, what));
    }
    let connectivity = file.integers("connectivity")?;
    let (cells, rest) = connectivity.as_chunks::<N>();
    if !rest.is_empty() || cells.len() != types.len() {
        let name = if types.len() == 1 { names.simplex } else { names.simplices };
        let what = format!("{} {name} cannot have {} vertices", types.len(), connectivity.len());
        return Err(FormatError::byte(0, what));
    }
    if let Some(v) = connectivity.iter().find(|&&v| u32::try_from(v).is_err()) {
        return Err(FormatError::byte(0, format!("{v} is not the index of a point")));
    }
    let simplices = cells.iter().map(|cell| cell.map(|v| v as u32)).collect();
    let points = file.points()?.map(|points| {
        if let Some(i) = Points::from(&points).iter().position(|p| D == 2 && p[2] != 0.0) {
            return Err(FormatError::point(i, "z is not 0, as it is in a 2D mesh"));
        }
        Ok(points.resize())
    });
    let mut mesh = MeshData { points: points.transpose()?, ..M::from_arrays(simplices, None) };
    // What other programs call a weight may be anything; none has both.
    if let (Some(weights), Some(hidden)) = (file.point_data(WEIGHT), file.point_data(HIDDEN)) {
        let is_hidden = file.numbers(hidden)?.into_iter();
        mesh.hidden = Some((0..).zip(is_hidden).filter(|&(_, flag)| flag != 0.0).map(|(i, _)| i).collect());
        mesh.weights = Some(file.numbers(weights)?);
    }
    Ok(mesh)
}

/// Reads points whatever the cells, and their data of that name, if any is wanted.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn read_points<const D: usize>(
    bytes: &[u8],
    wanted: Option<&str>,
) -> Result<(crate::PointCloud<D>, Vec<f64>), FormatError> {
    let file = File::parse(bytes)?;
    let points = file.points()?.ok_or_else(|| FormatError::byte(0, "there are no points"))?;
    let values = match wanted {
        Some(name) => {
            let data = file.point_data(name);
            let what = || FormatError::byte(0, format!("the points have no data {}", quote(name.as_bytes())));
            file.numbers(data.ok_or_else(what)?)?
        }
        None => Vec::new(),
    };
    Ok((crate::PointCloud::new(points)?.resize(), values))
}

/// Reads arrays of numbers of 32 bits.
pub(super) fn read_words<const N: usize>(bytes: &[u8], names: [&str; N]) -> Result<[Vec<u32>; N], FormatError> {
    let file = File::parse(bytes)?;
    let mut arrays = [const { Vec::new() }; N];
    for (array, name) in arrays.iter_mut().zip(names) {
        let words = file.integers(name)?.into_iter().map(|x| u32::try_from(x).ok()).collect();
        let what = || FormatError::byte(0, format!("data array `{name}`: not all of its values have 32 bits"));
        *array = Option::ok_or_else(words, what)?;
    }
    Ok(arrays)
}

/// The data arrays of a file, not yet decoded.
struct File<'a> {
    arrays: Vec<DataArray<'a>>,
    big_endian: bool,
    /// Bytes of the lengths that go before binary data.
    length_size: usize,
    is_compressed: bool,
    /// What follows the underscore of the appended data, and whether it is base64.
    appended: Option<(&'a [u8], bool)>,
}

struct DataArray<'a> {
    name: String,
    /// Whether it stands in `Points`.
    is_points: bool,
    /// Whether it stands in `PointData`.
    is_point_data: bool,
    scalar: String,
    format: String,
    offset: usize,
    text: &'a [u8],
    /// Where the array stands in the file, for errors.
    at: usize,
}

impl DataArray<'_> {
    /// Returns the type of the numbers.
    fn scalar(&self) -> Result<Scalar, FormatError> {
        Ok(match self.scalar.as_str() {
            "Int8" => Scalar::I8,
            "Int16" => Scalar::I16,
            "Int32" => Scalar::I32,
            "Int64" => Scalar::I64,
            "UInt8" => Scalar::U8,
            "UInt16" => Scalar::U16,
            "UInt32" => Scalar::U32,
            "UInt64" => Scalar::U64,
            "Float32" => Scalar::F32,
            "Float64" => Scalar::F64,
            other => return Err(self.broken(&format!("values of type {} are not read", quote(other.as_bytes())))),
        })
    }

    fn broken(&self, what: &str) -> FormatError {
        let name = if self.is_points { "Points" } else { &self.name };
        FormatError::byte(self.at, format!("data array `{name}`: {what}"))
    }
}

fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

impl<'a> File<'a> {
    fn parse(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let mut file =
            File { arrays: Vec::new(), big_endian: false, length_size: 4, is_compressed: false, appended: None };
        let mut xml = Reader::from_reader(bytes);
        let (mut in_points, mut in_point_data, mut pieces) = (false, false, 0);
        loop {
            let at = position(&xml);
            let event = xml.read_event().map_err(|error| FormatError::byte(at, error.to_string()))?;
            let is_empty = matches!(event, Event::Empty(_));
            match event {
                Event::Start(tag) | Event::Empty(tag) => match tag.name().as_ref() {
                    "VTKFile" => {
                        file.big_endian = attribute(&tag, "byte_order") == "BigEndian";
                        file.length_size = if attribute(&tag, "header_type") == "UInt64" { 8 } else { 4 };
                        file.is_compressed = match attribute(&tag, "compressor").as_str() {
                            "" => false,
                            "vtkZLibDataCompressor" => true,
                            other => {
                                let what = format!("{} is not supported", quote(other.as_bytes()));
                                return Err(FormatError::byte(at, what));
                            }
                        };
                    }
                    "Points" => in_points = !is_empty,
                    "PointData" => in_point_data = !is_empty,
                    "Piece" => {
                        pieces += 1;
                        if pieces > 1 {
                            return Err(FormatError::byte(at, "a second `Piece`: only one is read"));
                        }
                    }
                    "DataArray" => {
                        let start = position(&xml);
                        let length =
                            if is_empty { 0 } else { bytes[start..].iter().take_while(|&&b| b != b'<').count() };
                        let offset = attribute(&tag, "offset").parse().unwrap_or(0);
                        file.arrays.push(DataArray {
                            name: attribute(&tag, "Name"),
                            is_points: in_points,
                            is_point_data: in_point_data,
                            scalar: attribute(&tag, "type"),
                            format: attribute(&tag, "format"),
                            offset,
                            text: &bytes[start..start + length],
                            at,
                        });
                    }
                    "AppendedData" => {
                        // What follows may be raw bytes, which are not XML.
                        let data = &bytes[position(&xml)..];
                        let start = data.iter().position(|&b| b == b'_').map_or(data.len(), |at| at + 1);
                        file.appended = Some((&data[start..], attribute(&tag, "encoding") == "base64"));
                        return Ok(file);
                    }
                    _ => {}
                },
                Event::End(tag) if tag.name().as_ref() == "Points" => in_points = false,
                Event::End(tag) if tag.name().as_ref() == "PointData" => in_point_data = false,
                Event::Eof => return Ok(file),
                _ => {}
            }
        }
    }

    /// Returns the array of that name as integers.
    fn integers(&self, name: &str) -> Result<Vec<i64>, FormatError> {
        let array = self
            .arrays
            .iter()
            .find(|array| array.name == name)
            .ok_or_else(|| FormatError::byte(0, format!("there is no data array `{name}`")))?;
        let values = match self.bytes(array)? {
            Some(bytes) => self.decode_integers(&bytes, &array.scalar),
            None => words(array.text).map(|word| std::str::from_utf8(word).ok()?.parse().ok()).collect(),
        };
        values.ok_or_else(|| array.broken("not all of its values are integers"))
    }

    /// Returns the array of that name with a value for each point.
    fn point_data(&self, name: &str) -> Option<&DataArray<'a>> {
        self.arrays.iter().find(|array| array.is_point_data && array.name == name)
    }

    /// Returns the points, where the file has them.
    fn points(&self) -> Result<Option<PointBuf>, FormatError> {
        let Some(array) = self.arrays.iter().find(|array| array.is_points) else { return Ok(None) };
        let scalar = array.scalar()?;
        if scalar.is_integer() {
            return Err(array.broken(&format!("points of type {} are not read", quote(array.scalar.as_bytes()))));
        }
        match self.numbers(array)?.as_chunks::<3>() {
            (points, []) => Ok(Some(narrow(points.to_vec(), scalar.is_single()))),
            _ => Err(array.broken("its values are not three for each point")),
        }
    }

    /// Returns the array as numbers.
    fn numbers(&self, array: &DataArray<'_>) -> Result<Vec<f64>, FormatError> {
        let scalar = array.scalar()?;
        let values: Option<Vec<f64>> = match self.bytes(array)? {
            Some(bytes) => {
                let values = bytes.chunks_exact(scalar.size());
                let is_whole = values.remainder().is_empty();
                is_whole.then(|| values.map(|value| scalar.decode(value, self.big_endian)).collect())
            }
            None => words(array.text).map(|word| scalar.parse(word)).collect(),
        };
        values.ok_or_else(|| array.broken("not all of its values are numbers"))
    }

    /// Returns the binary data of an array; `None` where it is text.
    fn bytes(&self, array: &DataArray<'_>) -> Result<Option<Vec<u8>>, FormatError> {
        let broken = |what: &str| array.broken(what);
        let block = match array.format.as_str() {
            "ascii" => return Ok(None),
            "binary" => self.unpack(&decode_base64(array.text).ok_or_else(|| broken("its base64 is broken"))?),
            "appended" => {
                let (data, is_base64) = self.appended.ok_or_else(|| broken("there is no appended data"))?;
                let data = data.get(array.offset..).ok_or_else(|| broken("its offset is behind the file's end"))?;
                if is_base64 {
                    let end = data.iter().position(|&b| b == b'<').unwrap_or(data.len());
                    self.unpack(&decode_base64(&data[..end]).ok_or_else(|| broken("its base64 is broken"))?)
                } else {
                    self.unpack(data)
                }
            }
            other => return Err(broken(&format!("the format {} is not known", quote(other.as_bytes())))),
        };
        block.map(Some).ok_or_else(|| broken("its data is broken or ends too early"))
    }

    /// Returns the length (4 or 8 bytes) at the start of `data`, and what follows it.
    fn length<'d>(&self, data: &'d [u8]) -> Option<(usize, &'d [u8])> {
        let (bytes, rest) = data.split_at_checked(self.length_size)?;
        let value = bytes.iter().enumerate().fold(0u64, |value, (i, &byte)| {
            let shift = if self.big_endian { self.length_size - 1 - i } else { i };
            value | u64::from(byte) << (8 * shift)
        });
        Some((usize::try_from(value).ok()?, rest))
    }

    /// Returns the array's bytes: after their length, or in compressed blocks after the number of
    /// blocks, the size of a block, of the last one, and the compressed sizes of all.
    fn unpack(&self, data: &[u8]) -> Option<Vec<u8>> {
        let (length, mut rest) = self.length(data)?;
        if !self.is_compressed {
            return rest.get(..length).map(<[u8]>::to_vec);
        }
        let sizes = rest.split_off(..2 * self.length_size)?;
        let (block_size, _) = self.length(sizes)?;
        let mut compressed_sizes = rest.split_off(..length.checked_mul(self.length_size)?)?;
        let mut result = Vec::new();
        for _ in 0..length {
            let (size, others) = self.length(compressed_sizes)?;
            compressed_sizes = others;
            let block = rest.split_off(..size)?;
            ZlibDecoder::new(block).take(block_size as u64).read_to_end(&mut result).ok()?;
        }
        Some(result)
    }

    fn decode_integers(&self, block: &[u8], scalar: &str) -> Option<Vec<i64>> {
        let size = match scalar {
            "Int8" | "UInt8" => 1,
            "Int32" | "UInt32" => 4,
            "Int64" | "UInt64" => 8,
            _ => return None,
        };
        let is_signed = scalar.starts_with('I');
        let values = block.chunks_exact(size);
        if !values.remainder().is_empty() {
            return None;
        }
        let value = |bytes: &[u8]| {
            let mut wide = [0; 8];
            wide[..size].copy_from_slice(bytes);
            if self.big_endian {
                wide[..size].reverse();
            }
            // Shifts to the top and back, which extends the sign.
            let unused = 64 - 8 * size as u32;
            let value = i64::from_le_bytes(wide) << unused;
            if is_signed { value >> unused } else { (value as u64 >> unused) as i64 }
        };
        Some(values.map(value).collect())
    }
}

fn position(xml: &Reader<&[u8]>) -> usize {
    xml.buffer_position() as usize
}

/// Returns the attribute's value, or an empty one if it is absent. The attributes that are used
/// contain nothing to unescape.
fn attribute(tag: &BytesStart<'_>, name: &str) -> String {
    tag.try_get_attribute(name).ok().flatten().map(|attribute| attribute.value.into_owned()).unwrap_or_default()
}

/// Decodes base64 that may consist of several pieces, each with its padding: VTK encodes a length
/// and the data after it one by one.
fn decode_base64(text: &[u8]) -> Option<Vec<u8>> {
    const ENGINE: GeneralPurpose = GeneralPurpose::new(
        &alphabet::STANDARD,
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
    );
    let text: Vec<u8> = text.iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
    let mut result = Vec::with_capacity(text.len() / 4 * 3);
    for piece in text.split(|&b| b == b'=').filter(|piece| !piece.is_empty()) {
        ENGINE.decode_vec(piece, &mut result).ok()?;
    }
    Some(result)
}
