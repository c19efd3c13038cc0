//! Values on a regular grid: GeoTIFF and NumPy's `.npy`.

use crate::npy;
use std::io::{self, Cursor, Write};
use tiff::{
    TiffError,
    encoder::{TiffEncoder, TiffKind, colortype::Gray64Float},
    tags::Tag,
};

/// Values at the centres of the cells of a grid, in the order of [`gdel::Grid`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Raster<'a, const D: usize = 2> {
    /// The grid.
    pub grid: gdel::Grid<D>,
    /// The value of each cell.
    pub values: &'a [f64],
}

/// Up to so many bytes of values, offsets of 32 bits reach all of a file.
const MAX_CLASSIC: u64 = u32::MAX as u64 - (1 << 20);

impl<const D: usize> Raster<'_, D> {
    /// Writes an array of shape (rows, columns), in 3D (layers, rows, columns), of 64-bit numbers.
    ///
    /// # Errors
    ///
    /// Returns an error if `to` cannot be written.
    pub fn write_npy(&self, to: impl Write) -> io::Result<()> {
        npy::write_grid(to, &self.grid.size, self.values)
    }
}

impl Raster<'_, 2> {
    /// Writes a GeoTIFF with one band of 64-bit numbers, in which NaN says that there is no value. It
    /// says where the grid is, but not in which reference system.
    ///
    /// # Errors
    ///
    /// Returns an error if `to` cannot be written, or if there is no cell.
    pub fn write_tiff(&self, mut to: impl Write) -> io::Result<()> {
        let mut bytes = Cursor::new(Vec::new());
        let written = if size_of_val(self.values) as u64 <= MAX_CLASSIC {
            TiffEncoder::new(&mut bytes).and_then(|encoder| self.encode(encoder))
        } else {
            TiffEncoder::new_big(&mut bytes).and_then(|encoder| self.encode(encoder))
        };
        written.map_err(|error| match error {
            TiffError::IoError(error) => error,
            error => io::Error::other(error),
        })?;
        to.write_all(bytes.get_ref())
    }

    fn encode<K: TiffKind>(&self, mut encoder: TiffEncoder<&mut Cursor<Vec<u8>>, K>) -> Result<(), TiffError> {
        let [low, high] = self.grid.bounds;
        let [width, height] = self.grid.size;
        let mut image = encoder.new_image::<Gray64Float>(width as u32, height as u32)?;
        let pixel = |axis: usize| (high[axis] - low[axis]) / self.grid.size[axis] as f64;
        let tags = image.encoder();
        // ModelPixelScale, ModelTiepoint (the upper left corner), GeoKeyDirectory (a pixel is an area), and GDAL's NODATA.
        tags.write_tag(Tag::ModelPixelScaleTag, &[pixel(0), pixel(1), 0.0][..])?;
        tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, low[0], high[1], 0.0][..])?;
        tags.write_tag(Tag::GeoKeyDirectoryTag, &[1u16, 1, 0, 1, 1025, 0, 1, 1][..])?;
        tags.write_tag(Tag::GdalNodata, "nan")?;
        image.write_data(self.values)
    }
}
