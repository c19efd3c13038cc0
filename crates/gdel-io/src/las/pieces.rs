//! Points a few at a time, for files that are larger than memory.

use super::{Axes, EVLR, check_size, guarded, in_header, prepare, records};
use crate::{FormatError, PointBuf, PointCloud};
use las::{Header, raw};
use std::io::Cursor;

/// Reads the points without their colours, at most `most` at a time, until `take` returns `false`.
pub(crate) fn read_in_pieces(
    mut bytes: Vec<u8>,
    most: usize,
    take: &mut dyn FnMut(PointBuf) -> bool,
) -> Result<(), FormatError> {
    let start = prepare(&mut bytes)?;
    let mut points = Vec::new();
    let mut goes_on = true;
    guarded(start, || {
        records(&bytes, start, |axes, record| {
            if goes_on {
                points.push(axes.point(record));
                if points.len() == most {
                    goes_on = take(PointBuf::F64(std::mem::take(&mut points)));
                }
            }
        })
    })?;
    if goes_on && !points.is_empty() {
        take(PointBuf::F64(points));
    }
    Ok(())
}

/// The records of a file that is not compressed, for reading them a few at a time.
pub(crate) struct Records {
    axes: Axes,
    /// The number of points.
    pub(crate) count: u64,
    /// Bytes of a record.
    pub(crate) stride: usize,
    /// The byte at which the records begin.
    pub(crate) offset: usize,
}

impl Records {
    /// Returns how many bytes at the beginning of a file, which these are the first of, are before its points.
    pub(crate) fn offset(beginning: &[u8]) -> Option<usize> {
        raw::Header::read_from(beginning).ok().map(|header| header.offset_to_point_data as usize)
    }

    /// Returns the records of a file of `size` bytes, of which these are before its points; `None` if they are compressed
    /// or broken.
    pub(crate) fn new(beginning: &mut [u8], size: u64) -> Option<Self> {
        let header = raw::Header::read_from(&*beginning).ok()?;
        check_size(&header, usize::try_from(size).ok()?).ok()?;
        if header.evlr.is_some() {
            beginning.get_mut(EVLR)?.fill(0);
        }
        let header =
            guarded(0, || Header::new(Cursor::new(&*beginning)).map_err(|error| in_header(error, beginning.len())));
        let header = header.ok().filter(|header| !header.point_format().is_compressed)?;
        Some(Records {
            axes: Axes(*header.transforms()),
            count: header.number_of_points(),
            stride: header.point_format().len().into(),
            offset: beginning.len(),
        })
    }

    /// Returns the points in the bytes of some records.
    pub(crate) fn points(&self, bytes: &[u8]) -> Result<PointCloud, FormatError> {
        PointCloud::new(PointBuf::F64(bytes.chunks_exact(self.stride).map(|record| self.axes.point(record)).collect()))
    }
}
