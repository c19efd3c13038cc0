//! ZIP archives, which NumPy's `.npz` and 3MF are.

use crate::surface::MARK;
use std::io::{self, BufWriter, Read, Seek, Write};
use zip::{
    CompressionMethod, ZipWriter,
    write::{SimpleFileOptions, StreamWriter},
};

/// Writes an archive.
pub(super) fn write(to: impl Write, files: impl FnOnce(&mut Archive<'_>) -> io::Result<()>) -> io::Result<()> {
    let mut failure = None;
    let result = write_files(&mut Latch { to, failure: &mut failure }, files);
    failure.map_or(result, Err)
}

/// A file that reports no error after its first one. A `ZipWriter` that is dropped early tries to
/// write the end of the archive, and would print the error.
struct Latch<'f, W> {
    to: W,
    failure: &'f mut Option<io::Error>,
}

impl<W: Write> Write for Latch<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.failure.is_some() {
            return Ok(bytes.len());
        }
        match self.to.write(bytes) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Err(error),
            Err(error) => {
                *self.failure = Some(error);
                Ok(bytes.len())
            }
            Ok(0) if !bytes.is_empty() => {
                *self.failure = Some(io::ErrorKind::WriteZero.into());
                Ok(bytes.len())
            }
            written => written,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.failure.is_none()
            && let Err(error) = self.to.flush()
        {
            *self.failure = Some(error);
        }
        Ok(())
    }
}

/// Adds a file to an archive.
pub(super) fn append(
    archive: impl Read + Write + Seek,
    name: &str,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut archive = ZipWriter::new_append(archive)?;
    archive.start_file(name, options(CompressionMethod::Stored))?;
    write_blocks(&mut archive, write)?;
    archive.finish()?.flush()
}

/// Writes in large blocks, since each write updates a checksum.
fn write_blocks(to: impl Write, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut blocks = BufWriter::with_capacity(1 << 16, to);
    write(&mut blocks)?;
    blocks.flush()
}

/// 64-bit sizes allow for meshes of any size. Without dates, equal meshes give equal files.
fn options(compression: CompressionMethod) -> SimpleFileOptions {
    SimpleFileOptions::default()
        .compression_method(compression)
        .large_file(true)
        .last_modified_time(zip::DateTime::default())
}

/// An archive that is being written.
pub(super) struct Archive<'w>(ZipWriter<StreamWriter<&'w mut dyn Write>>);

impl<'w> Archive<'w> {
    /// Writes the file of that name.
    pub(super) fn file(
        &mut self,
        name: &str,
        compression: CompressionMethod,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        self.0.start_file(name, options(compression))?;
        write_blocks(&mut self.0, write)
    }
}

fn write_files(to: &mut dyn Write, files: impl FnOnce(&mut Archive<'_>) -> io::Result<()>) -> io::Result<()> {
    let mut archive = Archive(ZipWriter::new_stream(to));
    files(&mut archive)?;
    archive.0.set_comment(MARK).map_err(io::Error::from)?;
    archive.0.finish()?.into_inner().flush()
}
