//! Temporary files, which get their names when they are complete.

use crate::files::FileError;
use std::{
    fs::{self, File, OpenOptions},
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};
use tempfile::{Builder, NamedTempFile};

/// The temporary files of this process; locked, too, while files get their names.
static TEMPORARY_FILES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn temporary_files() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARY_FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the temporary files of incomplete outputs, for a program that is about to exit on a
/// signal. Outputs that are being renamed are finished first; later ones block forever.
pub fn remove_temporary_files() {
    let mut files = temporary_files();
    for path in files.drain(..) {
        // A file that no longer exists needs no removal.
        let _ = fs::remove_file(path);
    }
    std::mem::forget(files);
}

/// Creates a temporary file in the folder of `path`.
pub(super) fn create(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // The system's own error: the crate adds the temporary name, which tells the user nothing.
    let mut bare = None;
    let file = Builder::new().prefix(".gdel-").suffix(".tmp").make_in(folder, |path| {
        let mut files = temporary_files();
        // With the permissions of any new file; those of the crate are private.
        let file = OpenOptions::new().write(true).create_new(true).open(path);
        match &file {
            Ok(_) => files.push(path.into()),
            Err(error) => bare = error.raw_os_error(),
        }
        file
    });
    file.map_err(|error: io::Error| bare.map_or(error, io::Error::from_raw_os_error))
}

/// Checks that a file can be created in the folder of `path`.
pub(super) fn probe(path: &Path) -> io::Result<()> {
    drop(create(path)?);
    forget_gone(&mut temporary_files());
    Ok(())
}

/// Forgets the temporary files that are gone.
fn forget_gone(files: &mut Vec<PathBuf>) {
    files.retain(|path| path.symlink_metadata().is_ok());
}

/// A file that is written but does not have its name yet.
pub(super) struct Prepared {
    path: PathBuf,
    file: NamedTempFile,
}

/// Writes the content that `path` will have.
pub(super) fn prepare(path: &Path, content: impl Fn(&mut dyn Write) -> io::Result<()>) -> Result<Prepared, FileError> {
    let write = || {
        let mut file = create(path)?;
        let mut buffer = BufWriter::with_capacity(1 << 16, file.as_file_mut() as &mut File);
        content(&mut buffer)?;
        buffer.flush()?;
        drop(buffer);
        Ok(Prepared { path: path.into(), file })
    };
    write().map_err(|source| FileError::Write { path: path.into(), source })
}

/// Gives the files their names: all of them, or on failure none.
pub(super) fn publish(prepared: Vec<Prepared>) -> Result<(), FileError> {
    let mut files = temporary_files();
    let is_single = prepared.len() == 1;
    // The paths, with the files that had these names before.
    let mut done: Vec<(PathBuf, Option<PathBuf>)> = Vec::new();
    let mut result = Ok(());
    for Prepared { path, file } in prepared {
        let replace = || {
            if path.is_dir() {
                return Err(io::ErrorKind::IsADirectory.into());
            }
            if !is_single {
                let aside = file.path().with_extension("old");
                let exists = path.symlink_metadata().is_ok();
                if exists {
                    fs::rename(&path, &aside)?;
                }
                done.push((path.clone(), exists.then_some(aside)));
            }
            file.persist(&path).map(drop).map_err(|error| error.error)
        };
        if let Err(source) = replace() {
            result = Err(FileError::Write { path, source });
            break;
        }
    }
    for (path, aside) in done.iter().rev() {
        // A failure to restore cannot be handled further.
        let _ = match (aside, &result) {
            (Some(aside), Err(_)) => fs::rename(aside, path),
            (None, Err(_)) => fs::remove_file(path),
            (Some(aside), Ok(())) => fs::remove_file(aside),
            (None, Ok(())) => Ok(()),
        };
    }
    forget_gone(&mut files);
    result
}
