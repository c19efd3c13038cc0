//! Files by path: formats by extension, and outputs that are written atomically.

use crate::{
    FormatError, Mesh, MeshData, MeshFormat, PointCloud, PointFormat, Position, ShapeFormat, Shapes, poly, printable,
    tetgen, vtu,
};
use gdel::Points;
use std::{
    fs,
    io::{self, Read},
    path::{Path, PathBuf},
};

mod archives;
mod output;
mod pieces;
mod temporary;

pub use output::{Output, PointOutput, ResultOutput};
pub use temporary::remove_temporary_files;

/// Why a file was not read or written. Its text is one line of printable characters that starts
/// with the file's name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The file system refused to read.
    #[error("{}: cannot be read: {source}", shown(path))]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file system refused to write.
    #[error("{}: cannot be written: {source}", shown(path))]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The content is broken.
    #[error("{}: {source}", shown(path))]
    Format {
        /// The file.
        path: PathBuf,
        /// The error and its position.
        source: FormatError,
    },
    /// The extension is not that of a suitable format.
    #[error("{}: unknown extension, {what} end in {known}", shown(path))]
    Extension {
        /// The file.
        path: PathBuf,
        /// A description of the files with suitable extensions.
        what: &'static str,
        /// The suitable extensions.
        known: String,
    },
    /// The format of standard input is not given.
    #[error("standard input has no extension: give its format with `--format`, as in `--format xyz`")]
    NoFormat,
    /// An output would replace an input.
    #[error("{}: this is the input {}: choose another name for the output", shown(path), shown(input))]
    IsInput {
        /// The output.
        path: PathBuf,
        /// The input.
        input: PathBuf,
    },
    /// An output would replace a file that is not marked as an earlier output of its kind.
    #[error("{}: this file exists, and is not {what}: add `--force` to replace it", shown(path))]
    Exists {
        /// The output.
        path: PathBuf,
        /// A description of the files that are replaced without `--force`.
        what: String,
    },
}

/// Returns the name of a file for messages: without control characters, and `standard input` for
/// `-`.
pub fn shown(path: &Path) -> String {
    if path == Path::new("-") { "standard input".into() } else { printable(&path.to_string_lossy()) }
}

/// Finds the format of `path` among those that `format_of` knows by extension.
fn by_extension<F: Copy>(
    path: &Path,
    what: &'static str,
    format_of: impl Fn(&str) -> Option<F>,
    known: impl Iterator<Item = &'static str>,
) -> Result<F, FileError> {
    path.extension().and_then(|extension| format_of(extension.to_str()?)).ok_or_else(|| FileError::Extension {
        path: path.into(),
        what,
        known: known.map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", "),
    })
}

fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    let in_file = |source| FileError::Read { path: path.into(), source };
    if path.is_dir() {
        return Err(in_file(io::ErrorKind::IsADirectory.into()));
    }
    fs::read(path).map_err(in_file)
}

/// A point cloud to read: a file, or standard input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    path: PathBuf,
    format: InputFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum InputFormat {
    Points(PointFormat),
    /// The arrays of a mesh, or of a table, which hold points.
    Npz,
    Vtu,
}

impl InputFormat {
    fn from_extension(extension: &str) -> Option<Self> {
        let points = PointFormat::from_extension(extension).map(InputFormat::Points);
        points.or_else(|| match MeshFormat::from_extension(extension)? {
            MeshFormat::Npz => Some(InputFormat::Npz),
            MeshFormat::Vtu => Some(InputFormat::Vtu),
            MeshFormat::TetGen => None,
        })
    }
}

impl Input {
    /// Creates the input at `path`, where `-` is standard input. Without a `format`, the extension
    /// says which it is.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Extension`] or [`FileError::NoFormat`] if the format is not known.
    pub fn new(path: &Path, format: Option<PointFormat>) -> Result<Self, FileError> {
        let format = match format {
            Some(format) => InputFormat::Points(format),
            None if path == Path::new("-") => return Err(FileError::NoFormat),
            // "Is a directory" says more than that `.` is not a known extension.
            None if path.is_dir() => InputFormat::Points(PointFormat::Text),
            None => {
                let known = PointFormat::ALL.iter().flat_map(|f| f.extensions()).copied().chain(["npz", "vtu"]);
                by_extension(path, "point clouds", InputFormat::from_extension, known)?
            }
        };
        Ok(Input { path: path.into(), format })
    }

    /// Returns the file; `-` is standard input.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Reads all points.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Read`] or [`FileError::Format`].
    pub fn read<const D: usize>(&self) -> Result<PointCloud<D>, FileError> {
        let bytes = self.bytes()?;
        let cloud = match self.format {
            InputFormat::Points(format) => format.read(bytes),
            InputFormat::Npz => archives::read_points(&bytes, None).map(|(cloud, _)| cloud),
            InputFormat::Vtu => vtu::read_points(&bytes, None).map(|(cloud, _)| cloud),
        };
        cloud.map_err(|source| FileError::Format { path: self.path.clone(), source })
    }

    /// Reads all points, and the values in a column of the file: see
    /// [`PointFormat::read_with_values`]. Columns of NumPy's archives are arrays, and those of VTK's grids the data of points.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Read`] or [`FileError::Format`].
    pub fn read_with_values<const D: usize>(&self, column: &str) -> Result<(PointCloud<D>, Vec<f64>), FileError> {
        let bytes = self.bytes()?;
        let found = match self.format {
            InputFormat::Points(format) => format.read_with_values(&bytes, column),
            InputFormat::Npz => archives::read_points(&bytes, Some(column)),
            InputFormat::Vtu => vtu::read_points(&bytes, Some(column)),
        };
        let one_per_point = found.and_then(|(cloud, values)| match Points::from(&cloud).len() {
            points if points == values.len() => Ok((cloud, values)),
            points => {
                let what = format!("there are {} values of {} for {points} points", values.len(), printable(column));
                Err(FormatError { at: Position::Byte(0), what })
            }
        });
        one_per_point.map_err(|source| FileError::Format { path: self.path.clone(), source })
    }

    fn bytes(&self) -> Result<Vec<u8>, FileError> {
        if self.path == Path::new("-") { read_standard_input() } else { read(&self.path) }
    }
}

fn read_standard_input() -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    let read = io::stdin().lock().read_to_end(&mut bytes);
    read.map_err(|source| FileError::Read { path: "-".into(), source })?;
    Ok(bytes)
}

/// Reads a 3D point cloud; the extension says in which format. [`Input`] reads 2D points, too.
///
/// # Errors
///
/// Returns a [`FileError`].
pub fn read_points(path: &Path) -> Result<PointCloud, FileError> {
    Input::new(path, None)?.read()
}

/// Reads edges between points: see [`read_edges`](crate::read_edges()).
///
/// # Errors
///
/// Returns [`FileError::Read`] or [`FileError::Format`].
pub fn read_edges(path: &Path) -> Result<Vec<[u32; 2]>, FileError> {
    crate::read_edges(&read(path)?).map_err(|source| FileError::Format { path: path.into(), source })
}

/// Reads the shapes of a file, where `-` is standard input. The points of a `.poly` file may be in the `.node` file
/// beside it.
///
/// # Errors
///
/// Returns [`FileError::Read`] or [`FileError::Format`].
pub fn read_shapes(path: &Path, format: ShapeFormat) -> Result<Shapes, FileError> {
    let in_file = |path: &Path, source| FileError::Format { path: path.into(), source };
    let bytes = if path == Path::new("-") { read_standard_input()? } else { read(path)? };
    if format != ShapeFormat::Poly {
        return format.read(&bytes).map_err(|source| in_file(path, source));
    }
    // An error of the other file has that one's name.
    let mut other = None;
    let shapes = poly::read(&bytes, || {
        let node = path.with_extension("node");
        let points =
            read(&node).and_then(|bytes| tetgen::read_numbered_points(&bytes).map_err(|source| in_file(&node, source)));
        points.map_err(|error| {
            other = Some(error);
            FormatError { at: Position::Line(1), what: "the points are in another file".into() }
        })
    });
    shapes.map_err(|source| other.unwrap_or_else(|| in_file(path, source)))
}

/// Reads a mesh; the extension says in which format. For any of the three files of TetGen or
/// Triangle the `.ele` is read, and the `.neigh` and `.node` beside it if there are any.
///
/// # Errors
///
/// Returns a [`FileError`].
pub fn read_mesh<M: Mesh<D, N>, const D: usize, const N: usize>(path: &Path) -> Result<MeshData<D, N>, FileError> {
    let known = MeshFormat::ALL.iter().flat_map(|f| f.extensions()).copied();
    let format = by_extension(path, "meshes", MeshFormat::from_extension, known)?;
    let path = if format == MeshFormat::TetGen { &path.with_extension("ele") } else { path };
    let in_file = |path: &Path, source| FileError::Format { path: path.into(), source };
    let mut mesh = format.read::<M, D, N>(&read(path)?).map_err(|source| in_file(path, source))?;
    if format == MeshFormat::TetGen {
        let [neigh, node] = ["neigh", "node"].map(|extension| path.with_extension(extension));
        if neigh.exists() {
            let neighbors = tetgen::read_neigh::<M, D, N>(&read(&neigh)?);
            mesh.neighbors = Some(neighbors.map_err(|source| in_file(&neigh, source))?);
        }
        if node.exists() {
            let bytes = read(&node)?;
            let in_node = |source| in_file(&node, source);
            mesh.points = Some(tetgen::read_node(&bytes).map_err(in_node)?.points);
            mesh.weights = tetgen::read_weights(&bytes).map_err(in_node)?;
        }
    }
    Ok(mesh)
}

/// Writes a file: one of the same name is replaced once all is written, and stays as it is on failure.
///
/// # Errors
///
/// Returns [`FileError::Write`].
pub fn write_file(path: &Path, content: impl Fn(&mut dyn io::Write) -> io::Result<()>) -> Result<(), FileError> {
    temporary::publish(vec![temporary::prepare(path, content)?])
}

/// Writes a point cloud; the extension says in which format. A file of the same name is replaced.
///
/// # Errors
///
/// Returns a [`FileError`].
pub fn write_points<const D: usize>(path: &Path, points: Points<'_, D>) -> Result<(), FileError> {
    PointOutput::new(path)?.write(points)
}
