//! Outputs: what they would replace is checked first, and they are written atomically.

use super::{
    FileError, by_extension,
    temporary::{self, Prepared, prepare, publish},
};
use crate::{
    Mesh, MeshFormat, PointFormat, SolverFormat, SurfaceFormat,
    surface::MARK,
    tetgen::{write_ele, write_neigh, write_weighted_node},
    write_msh, write_npz, write_poly, write_vtu,
};
use gdel::Points;
use std::{
    fs::File,
    io::{self, Read, Seek, SeekFrom},
    path::{Path, PathBuf},
};

/// A file for a mesh or its hull.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    path: PathBuf,
    format: OutputFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum OutputFormat {
    Mesh(MeshFormat),
    Solver(SolverFormat),
    Surface(SurfaceFormat),
}

impl Output {
    /// Creates the output at `path`; the extension says in which format.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Extension`].
    pub fn new(path: &Path) -> Result<Self, FileError> {
        let format_of = |extension: &str| {
            let mesh = MeshFormat::from_extension(extension).map(OutputFormat::Mesh);
            let mesh = mesh.or_else(|| SolverFormat::from_extension(extension).map(OutputFormat::Solver));
            mesh.or_else(|| SurfaceFormat::from_extension(extension).map(OutputFormat::Surface))
        };
        let meshes = MeshFormat::ALL.iter().flat_map(|f| f.extensions());
        let solvers = SolverFormat::ALL.iter().flat_map(|f| f.extensions());
        let surfaces = SurfaceFormat::ALL.iter().flat_map(|f| f.extensions());
        let format = by_extension(path, "meshes and hulls", format_of, meshes.chain(solvers).chain(surfaces).copied())?;
        Ok(Output { path: path.into(), format })
    }

    /// Returns the files that are written: three for TetGen and Triangle.
    fn paths(&self) -> Vec<PathBuf> {
        match self.format {
            OutputFormat::Mesh(MeshFormat::TetGen) => {
                ["node", "ele", "neigh"].map(|e| self.path.with_extension(e)).into()
            }
            _ => vec![self.path.clone()],
        }
    }

    /// Checks that the output can be written, before the work begins.
    ///
    /// The files `inputs` are never replaced, and others only if they are earlier outputs of this
    /// format, or with `force`.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Write`], [`FileError::IsInput`] or [`FileError::Exists`].
    pub fn check(&self, inputs: &[&Path], force: bool) -> Result<(), FileError> {
        for path in self.paths() {
            check(&path, inputs)?;
            if !force && path.symlink_metadata().is_ok() && !is_generated(&path) {
                let what = match self.format {
                    OutputFormat::Mesh(_) | OutputFormat::Solver(_) => "a mesh that gdel wrote",
                    OutputFormat::Surface(_) => "a hull or triangulation that gdel wrote",
                };
                return Err(FileError::Exists { path, what: what.into() });
            }
        }
        Ok(())
    }

    /// Writes the mesh, or its hull, which is all of a 2D mesh. Files of the same name are replaced
    /// once all is written; on failure they stay as they are.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Write`].
    pub fn write<const D: usize, const N: usize, M: Mesh<D, N>>(
        &self,
        points: Points<'_, D>,
        mesh: &M,
    ) -> Result<(), FileError> {
        let paths = self.paths();
        let parts: Vec<Prepared> = match (self.format, &paths[..]) {
            (OutputFormat::Mesh(MeshFormat::TetGen), [node, ele, neigh]) => vec![
                prepare(node, |to| write_weighted_node(to, points, mesh.weights()))?,
                prepare(ele, |to| write_ele(to, mesh))?,
                prepare(neigh, |to| write_neigh(to, mesh))?,
            ],
            (OutputFormat::Mesh(MeshFormat::Npz), _) => vec![prepare(&self.path, |to| write_npz(to, points, mesh))?],
            (OutputFormat::Mesh(_), _) => vec![prepare(&self.path, |to| write_vtu(to, points, mesh))?],
            (OutputFormat::Solver(SolverFormat::Msh), _) => {
                vec![prepare(&self.path, |to| write_msh(to, points, mesh))?]
            }
            (OutputFormat::Solver(SolverFormat::Poly), _) => {
                vec![prepare(&self.path, |to| write_poly(to, points, mesh))?]
            }
            (OutputFormat::Surface(format), _) => vec![prepare(&self.path, |to| format.write(to, points, mesh))?],
        };
        publish(parts)
    }
}

/// A point cloud to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PointOutput {
    path: PathBuf,
    format: PointFormat,
}

impl PointOutput {
    /// Creates the output at `path`; the extension says in which format.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Extension`].
    pub fn new(path: &Path) -> Result<Self, FileError> {
        let known = PointFormat::ALL.iter().filter(|f| f.is_written()).flat_map(|f| f.extensions()).copied();
        let format_of = |extension: &str| PointFormat::from_extension(extension).filter(|f| f.is_written());
        let format = by_extension(path, "point clouds that can be written", format_of, known)?;
        Ok(PointOutput { path: path.into(), format })
    }

    /// Checks that the file can be written, before the work begins. An existing file is replaced
    /// only with `force`, since nothing tells generated points from measured ones.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Write`] or [`FileError::Exists`].
    pub fn check(&self, force: bool) -> Result<(), FileError> {
        check(&self.path, &[])?;
        if !force && self.path.symlink_metadata().is_ok() {
            return Err(FileError::Exists { path: self.path.clone(), what: "replaced without asking".into() });
        }
        Ok(())
    }

    /// Writes the points. A file of the same name is replaced once all is written; on failure it
    /// stays as it is.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Write`].
    pub fn write<const D: usize>(&self, points: Points<'_, D>) -> Result<(), FileError> {
        publish(vec![prepare(&self.path, |to| self.format.write(to, points))?])
    }
}

/// A file for results of another kind: tables, grids and surfaces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResultOutput<F> {
    path: PathBuf,
    format: F,
}

impl<F: Copy> ResultOutput<F> {
    /// Creates the output at `path`, with the format that `format_of` returns for its extension.
    /// Errors quote the extensions in `known` and the kind of result, `what`.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Extension`].
    pub fn new(
        path: &Path,
        what: &'static str,
        format_of: impl Fn(&str) -> Option<F>,
        known: &[&'static str],
    ) -> Result<Self, FileError> {
        let format = by_extension(path, what, format_of, known.iter().copied())?;
        Ok(ResultOutput { path: path.into(), format })
    }

    /// Returns the format.
    pub fn format(&self) -> F {
        self.format
    }

    /// Checks that the output can be written, before the work begins.
    ///
    /// The files `inputs` are never replaced, and others only if they are marked as an output of
    /// gdel, or with `force`.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Write`], [`FileError::IsInput`] or [`FileError::Exists`].
    pub fn check(&self, inputs: &[&Path], force: bool) -> Result<(), FileError> {
        check(&self.path, inputs)?;
        if !force && self.path.symlink_metadata().is_ok() && !is_generated(&self.path) {
            return Err(FileError::Exists { path: self.path.clone(), what: "marked as an output of gdel".into() });
        }
        Ok(())
    }

    /// Writes what `write` writes. A file of the same name is replaced once all is written; on
    /// failure it stays as it is.
    ///
    /// # Errors
    ///
    /// Returns [`FileError::Write`].
    pub fn write(&self, write: impl Fn(&mut dyn io::Write) -> io::Result<()>) -> Result<(), FileError> {
        publish(vec![prepare(&self.path, write)?])
    }
}

/// Checks that a file can be written at `path`, and that it is none of `inputs` under another name.
fn check(path: &Path, inputs: &[&Path]) -> Result<(), FileError> {
    let in_file = |source| FileError::Write { path: path.into(), source };
    if path.is_dir() {
        return Err(in_file(io::ErrorKind::IsADirectory.into()));
    }
    // Files of which one does not exist are not the same.
    if let Some(input) = inputs.iter().find(|input| same_file::is_same_file(path, input).unwrap_or(false)) {
        return Err(FileError::IsInput { path: path.into(), input: input.into() });
    }
    temporary::probe(path).map_err(in_file)
}

/// Returns whether the file has the mark of one that was written here.
fn is_generated(path: &Path) -> bool {
    /// The mark is at most so many bytes from the begin or the end.
    const REACH: u64 = 512;
    let has_mark = || -> io::Result<bool> {
        // Opening anything else, such as a pipe, might wait.
        if !path.metadata()?.is_file() {
            return Ok(false);
        }
        let mut file = File::open(path)?;
        let mut ends = Vec::new();
        file.by_ref().take(REACH).read_to_end(&mut ends)?;
        let length = file.seek(SeekFrom::End(0))?;
        file.seek(SeekFrom::Start(length.saturating_sub(REACH)))?;
        file.read_to_end(&mut ends)?;
        Ok(ends.windows(MARK.len()).any(|window| window == MARK.as_bytes()))
    };
    has_mark().unwrap_or(false)
}
