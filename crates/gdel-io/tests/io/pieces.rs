//! Point clouds that are read a few points at a time, and the files of tiles.

use crate::samples;
use gdel::{
    Mesh2, Mesh3, Points,
    tiles::{Link, Piece},
};
use gdel_io::{
    PointBuf, append_links,
    files::{FileError, Input},
    read_tile, read_tile_vtu, write_tile, write_tile_vtu,
};
use std::{fs, io::Cursor, path::Path};

fn all<const D: usize>(points: &PointBuf<D>) -> Vec<[f64; D]> {
    Points::from(points).iter().collect()
}

/// Reads a file in pieces of at most `most` points.
fn in_pieces<const D: usize>(input: &Input, most: usize) -> Result<Vec<[f64; D]>, FileError> {
    let mut points = Vec::new();
    input.read_in_pieces::<D, FileError>(most, &mut |piece: PointBuf<D>| {
        points.extend(all(&piece));
        Ok(())
    })?;
    Ok(points)
}

fn check<const D: usize>(path: &Path, what: &str) {
    let Ok(input) = Input::new(path, None) else { panic!("{what}") };
    let whole = input.read::<D>().map(|cloud| all(&cloud.points)).map_err(|error| error.to_string());
    for most in [1, 2, 1000] {
        let pieces = in_pieces::<D>(&input, most).map_err(|error| error.to_string());
        match (&whole, &pieces) {
            (Ok(whole), Ok(pieces)) => assert_eq!(whole, pieces, "{what}, {most} at a time"),
            (Err(whole), Err(pieces)) => assert_eq!(whole, pieces, "{what}, {most} at a time"),
            _ => panic!("{what}, {most} at a time: {whole:?}, {pieces:?}"),
        }
    }
}

#[test]
fn pieces_are_the_points_of_the_whole_file_or_the_same_error() {
    let folder = tempfile::tempdir().unwrap();
    for (format, name, bytes) in samples::point_clouds() {
        let path = folder.path().join(format!("points.{}", format.extensions()[0]));
        for cut in [bytes.len(), bytes.len() - 1, bytes.len() - 5, bytes.len() / 2, 10, 0] {
            fs::write(&path, &bytes[..cut.min(bytes.len())]).unwrap();
            check::<3>(&path, &format!("{format:?} {name}, {cut} of {} bytes", bytes.len()));
            check::<2>(&path, &format!("{format:?} {name} in 2D, {cut} of {} bytes", bytes.len()));
        }
    }
    // Arrays of other types and orders.
    for (name, header, data) in [
        ("two columns", "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 2), }", vec![0; 24]),
        ("by columns", "{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }", (0..24).collect()),
        ("whole numbers", "{'descr': '>i2', 'fortran_order': False, 'shape': (4, 3), }", (0..24).collect()),
        ("more than it says", "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3), }", vec![0; 24]),
        ("less than it says", "{'descr': '<f4', 'fortran_order': False, 'shape': (9, 3), }", vec![0; 24]),
        ("no rows", "{'descr': '<f4', 'fortran_order': False, 'shape': (0, 3), }", vec![]),
        ("no columns", "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 0), }", vec![]),
        ("large numbers", "{'descr': '<u8', 'fortran_order': False, 'shape': (1, 3), }", vec![255; 24]),
    ] {
        let path = folder.path().join("array.npy");
        let start = [&b"\x93NUMPY\x01\x00"[..], &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat();
        fs::write(&path, [start, data].concat()).unwrap();
        check::<3>(&path, name);
        check::<2>(&path, name);
    }
}

#[test]
fn a_number_that_is_not_finite_has_its_place_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.f64");
    let mut numbers = vec![0.5; 30];
    numbers[25] = f64::INFINITY;
    fs::write(&path, numbers.iter().flat_map(|x: &f64| x.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    let error = in_pieces::<3>(&Input::new(&path, None).unwrap(), 3).unwrap_err().to_string();
    assert!(error.contains("point 8: the y coordinate is inf"), "{error}");
}

fn piece() -> Piece<3, 4> {
    let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
    let arrays = [vec![[0, 1, 2, 3]], vec![[u32::MAX; 4]]];
    Piece::from_arrays(points, [vec![2, 3, 5, 7, 4_000_000_000], vec![1, 1, 0, 1, 1]], arrays, vec![[4_000_000_000, 7]])
}

#[test]
fn files_of_tiles_are_read_as_they_were_written() {
    let piece = piece();
    let links = [Link { place: 2, tile: 0, entry: 9 }, Link { place: 3, tile: 5, entry: u32::MAX - 1 }];
    let mut file = Cursor::new(Vec::new());
    write_tile::<Mesh3, 3, 4>(&mut file, &piece).unwrap();
    assert!(read_tile::<Mesh3, 3, 4>(&mut file).unwrap_err().to_string().contains("no array `links`"));
    append_links(&mut file, &links).unwrap();
    let read = read_tile::<Mesh3, 3, 4>(&mut file).unwrap();
    assert_eq!(read, (piece.clone(), links.to_vec()));
    let bytes = file.into_inner();
    for length in 0..bytes.len() {
        assert!(read_tile::<Mesh3, 3, 4>(Cursor::new(&bytes[..length])).is_err(), "{length} bytes");
    }
    assert!(read_tile::<Mesh2, 2, 3>(Cursor::new(&bytes)).is_err());

    let mut bytes = Vec::new();
    write_tile_vtu::<Mesh3, 3, 4>(&mut bytes, &piece).unwrap();
    let mut without_neighbors = piece;
    without_neighbors.part.neighbors.clear();
    assert_eq!(read_tile_vtu::<Mesh3, 3, 4>(&bytes).unwrap(), without_neighbors);
    for length in (0..bytes.len() - 40).step_by(7) {
        assert!(read_tile_vtu::<Mesh3, 3, 4>(&bytes[..length]).is_err(), "{length} of {} bytes", bytes.len());
    }
}
