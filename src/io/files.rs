//! Files by path: formats by extension, and writing that leaves nothing half-written.

use crate::io::{FormatError, HullFormat, MeshData, MeshData2, MeshFormat, PointCloud, PointFormat, tetgen};
use crate::{Mesh2, Mesh3, Points, Points2};
use std::{
    fs,
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
};
use tempfile::{Builder, NamedTempFile};

/// Why a file was not read or written. Its text is one line that starts with the file's name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The file system refused to read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file system refused to write.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The content is broken.
    #[error("{}: {source}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Where and why.
        source: FormatError,
    },
    /// The extension names no format that serves.
    #[error("{}: unknown extension, {what} end in {known}", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
        /// What was to be read or written.
        what: &'static str,
        /// The extensions that serve.
        known: String,
    },
}

/// The format of `path` among those that `format_of` knows by extension.
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
    fs::read(path).map_err(|source| FileError::Read { path: path.into(), source })
}

/// Reads a point cloud; the extension says in which format.
///
/// # Errors
///
/// [`FileError`].
pub fn read_points(path: &Path) -> Result<PointCloud, FileError> {
    if path.is_dir() {
        return Err(FileError::Read { path: path.into(), source: io::ErrorKind::IsADirectory.into() });
    }
    let known = PointFormat::ALL.iter().flat_map(|f| f.extensions()).copied();
    let format = by_extension(path, "point clouds", PointFormat::from_extension, known)?;
    format.read(read(path)?).map_err(|source| FileError::Format { path: path.into(), source })
}

/// Reads a mesh; the extension says in which format. For any of TetGen's three files the `.ele` is read, and the
/// `.neigh` beside it where there is one.
///
/// # Errors
///
/// [`FileError`].
pub fn read_mesh(path: &Path) -> Result<MeshData, FileError> {
    let known = MeshFormat::ALL.iter().flat_map(|f| f.extensions()).copied();
    let format = by_extension(path, "meshes", MeshFormat::from_extension, known)?;
    let path = if format == MeshFormat::TetGen { &path.with_extension("ele") } else { path };
    let in_file = |path: &Path, source| FileError::Format { path: path.into(), source };
    let mut mesh = format.read(&read(path)?).map_err(|source| in_file(path, source))?;
    let neigh = path.with_extension("neigh");
    if format == MeshFormat::TetGen && neigh.exists() {
        mesh.neighbors = Some(tetgen::read_neigh(&read(&neigh)?).map_err(|source| in_file(&neigh, source))?);
    }
    Ok(mesh)
}

/// Reads a mesh of the plane; the extension says in which format. For any of Triangle's three files the `.ele` is read.
///
/// # Errors
///
/// [`FileError`].
pub fn read_mesh2(path: &Path) -> Result<MeshData2, FileError> {
    let known = MeshFormat::ALL.iter().flat_map(|f| f.extensions());
    let format = by_extension(path, "meshes", MeshFormat::from_extension, known.copied())?;
    let path = if format == MeshFormat::TetGen { &path.with_extension("ele") } else { path };
    format.read2(&read(path)?).map_err(|source| FileError::Format { path: path.into(), source })
}

/// A file to write, with a format that takes what a triangulation gives.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    path: PathBuf,
    format: OutputFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum OutputFormat {
    Mesh(MeshFormat),
    Hull(HullFormat),
}

impl Output {
    /// The output at `path`; the extension says in which format.
    ///
    /// # Errors
    ///
    /// [`FileError::Extension`].
    pub fn new(path: &Path) -> Result<Self, FileError> {
        let format_of = |extension: &str| {
            let mesh = MeshFormat::from_extension(extension).map(OutputFormat::Mesh);
            mesh.or_else(|| HullFormat::from_extension(extension).map(OutputFormat::Hull))
        };
        let meshes = MeshFormat::ALL.iter().flat_map(|f| f.extensions());
        let hulls = HullFormat::ALL.iter().flat_map(|f| f.extensions());
        let format = by_extension(path, "meshes and hulls", format_of, meshes.chain(hulls).copied())?;
        Ok(Output { path: path.into(), format })
    }

    /// Finds out early whether the file can be written, before the work whose result goes there.
    ///
    /// # Errors
    ///
    /// [`FileError::Write`].
    pub fn check(&self) -> Result<(), FileError> {
        let in_file = |source| FileError::Write { path: self.path.clone(), source };
        if self.path.is_dir() {
            return Err(in_file(io::ErrorKind::IsADirectory.into()));
        }
        temporary(&self.path).map(drop).map_err(in_file)
    }

    /// Writes the mesh, or its hull. Files of the same name are replaced once all is written; on failure they stay as
    /// they are.
    ///
    /// # Errors
    ///
    /// [`FileError::Write`].
    pub fn write(&self, points: Points<'_>, mesh: &Mesh3) -> Result<(), FileError> {
        let part = |extension: &str, content: Content<'_>| prepare(&self.path.with_extension(extension), content);
        let parts = match self.format {
            OutputFormat::Mesh(MeshFormat::TetGen) => vec![
                part("node", &|to| tetgen::write_node(to, points))?,
                part("ele", &|to| tetgen::write_ele(to, mesh))?,
                part("neigh", &|to| tetgen::write_neigh(to, mesh))?,
            ],
            OutputFormat::Mesh(MeshFormat::Vtu) => {
                vec![prepare(&self.path, &|to| crate::io::write_vtu(to, points, mesh))?]
            }
            OutputFormat::Mesh(MeshFormat::Npz) => {
                vec![prepare(&self.path, &|to| crate::io::write_npz(to, points, mesh))?]
            }
            OutputFormat::Hull(format) => vec![prepare(&self.path, &|to| format.write(to, points, mesh))?],
        };
        parts.into_iter().try_for_each(publish)
    }

    /// Writes the mesh of the plane, also in the formats of surfaces; those of space get z = 0. Files of the same name are
    /// replaced once all is written; on failure they stay as they are.
    ///
    /// # Errors
    ///
    /// [`FileError::Write`].
    pub fn write2(&self, points: Points2<'_>, mesh: &Mesh2) -> Result<(), FileError> {
        let part = |extension: &str, content: Content<'_>| prepare(&self.path.with_extension(extension), content);
        let whole = |content: Content<'_>| Ok(vec![prepare(&self.path, content)?]);
        let parts = match self.format {
            OutputFormat::Mesh(MeshFormat::TetGen) => vec![
                part("node", &|to| tetgen::write_node(to, points))?,
                part("ele", &|to| crate::io::write_ele2(to, mesh))?,
                part("neigh", &|to| crate::io::write_neigh2(to, mesh))?,
            ],
            OutputFormat::Mesh(MeshFormat::Vtu) => whole(&|to| crate::io::write_vtu2(to, points, mesh))?,
            OutputFormat::Mesh(MeshFormat::Npz) => whole(&|to| crate::io::write_npz2(to, points, mesh))?,
            OutputFormat::Hull(HullFormat::Ply) => whole(&|to| crate::io::write_ply2(to, points, mesh))?,
            OutputFormat::Hull(HullFormat::Obj) => whole(&|to| crate::io::write_obj2(to, points, mesh))?,
            OutputFormat::Hull(HullFormat::Stl) => whole(&|to| crate::io::write_stl2(to, points, mesh))?,
            OutputFormat::Hull(HullFormat::Glb) => whole(&|to| crate::io::write_glb2(to, points, mesh))?,
        };
        parts.into_iter().try_for_each(publish)
    }
}

/// Writes a point cloud; the extension says in which format.
///
/// # Errors
///
/// [`FileError`].
pub fn write_points(path: &Path, points: Points<'_>) -> Result<(), FileError> {
    let known = PointFormat::ALL.iter().filter(|f| f.is_written()).flat_map(|f| f.extensions()).copied();
    let format_of = |extension: &str| PointFormat::from_extension(extension).filter(|f| f.is_written());
    let format = by_extension(path, "point clouds that can be written", format_of, known)?;
    publish(prepare(path, &|to| format.write(to, points))?)
}

type Content<'c> = &'c dyn Fn(&mut dyn Write) -> io::Result<()>;

/// A file that is written but does not have its name yet.
struct Prepared {
    path: PathBuf,
    file: NamedTempFile,
}

fn temporary(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = Builder::new();
    builder.prefix(".gdel-").suffix(".tmp");
    // As any new file, less what the umask takes; temporary files are private otherwise.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(|error| {
        // The bare error of the system: the crate adds the temporary name, which tells the user nothing.
        let bare =
            error.get_ref().and_then(|outer| outer.source()).and_then(|source| source.downcast_ref::<io::Error>());
        bare.and_then(io::Error::raw_os_error).map_or(error, io::Error::from_raw_os_error)
    })
}

fn prepare(path: &Path, content: Content<'_>) -> Result<Prepared, FileError> {
    let write = || {
        let mut file = temporary(path)?;
        let mut buffer = BufWriter::with_capacity(1 << 16, file.as_file_mut());
        content(&mut buffer)?;
        buffer.flush()?;
        drop(buffer);
        Ok(Prepared { path: path.into(), file })
    };
    write().map_err(|source| FileError::Write { path: path.into(), source })
}

fn publish(prepared: Prepared) -> Result<(), FileError> {
    let Prepared { path, file } = prepared;
    match file.persist(&path) {
        Ok(_) => Ok(()),
        Err(error) => Err(FileError::Write { path, source: error.error }),
    }
}
