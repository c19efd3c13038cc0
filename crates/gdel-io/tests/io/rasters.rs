//! Rasters, read by libraries.

use gdel::Grid;
use gdel_io::Raster;
use std::io::Cursor;
use tiff::{
    decoder::{Decoder, DecodingResult},
    tags::Tag,
};

#[test]
fn a_geotiff_says_where_it_is() {
    let values = [0.5, -1.25, f64::NAN, 4.0, 1e300, 5e-324];
    let grid = Grid { size: [3, 2], bounds: [[500_000.0, 4_000_000.0], [500_030.0, 4_000_010.0]] };
    let mut bytes = Vec::new();
    Raster { grid, values: &values }.write_tiff(&mut bytes).unwrap();
    let mut decoder = Decoder::new(Cursor::new(bytes)).unwrap();
    assert_eq!(decoder.dimensions().unwrap(), (3, 2));
    let DecodingResult::F64(read) = decoder.read_image().unwrap() else { panic!("64-bit numbers") };
    assert!(read.iter().zip(values).all(|(a, b)| a.to_bits() == b.to_bits()), "{read:?}");
    // The size of a pixel, and the upper left corner.
    assert_eq!(decoder.get_tag_f64_vec(Tag::ModelPixelScaleTag).unwrap(), [10.0, 5.0, 0.0]);
    let corner = [0.0, 0.0, 0.0, 500_000.0, 4_000_010.0, 0.0];
    assert_eq!(decoder.get_tag_f64_vec(Tag::ModelTiepointTag).unwrap(), corner);
    assert_eq!(decoder.get_tag_ascii_string(Tag::GdalNodata).unwrap(), "nan");
}

#[test]
fn numpy_has_rows_and_layers() {
    let values: Vec<f64> = (0..24).map(f64::from).collect();
    let read = |bytes: &[u8]| {
        let file = npyz::NpyFile::new(bytes).unwrap();
        (file.shape().to_vec(), file.into_vec::<f64>().unwrap())
    };
    let mut bytes = Vec::new();
    let grid = Grid { size: [6, 4], bounds: [[0.0; 2], [1.0; 2]] };
    Raster { grid, values: &values }.write_npy(&mut bytes).unwrap();
    assert_eq!(read(&bytes), (vec![4, 6], values.clone()));
    let mut bytes = Vec::new();
    let grid = Grid { size: [2, 3, 4], bounds: [[0.0; 3], [1.0; 3]] };
    Raster { grid, values: &values }.write_npy(&mut bytes).unwrap();
    assert_eq!(read(&bytes), (vec![4, 3, 2], values));
}
