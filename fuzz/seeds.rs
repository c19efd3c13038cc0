//! Writes the samples of the tests as seeds for the fuzz targets.

#[path = "../crates/gdel-io/tests/io/samples.rs"]
mod samples;

use gdel_io::{MeshFormat, PointFormat, ShapeFormat};
use std::{fs, io, path::Path};

fn main() -> io::Result<()> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let write = |target: &str, number: usize, choice: Option<usize>, bytes: Vec<u8>| {
        let choice = choice.and_then(|choice| u8::try_from(choice).ok()).unwrap_or_default();
        fs::create_dir_all(corpus.join(target))?;
        fs::write(corpus.join(target).join(format!("seed-{number}")), [vec![choice], bytes].concat())
    };
    // The highest bit chooses 2D.
    for (i, (format, _, bytes)) in samples::point_clouds().into_iter().enumerate() {
        let choice = PointFormat::ALL.iter().position(|&other| other == format);
        write("points", 2 * i, choice, bytes.clone())?;
        write("points", 2 * i + 1, choice.map(|choice| choice | 0x80), bytes)?;
    }
    let (meshes, meshes2) = (samples::meshes(), samples::meshes2());
    let of_2d = meshes2.into_iter().map(|sample| (0x80, sample));
    let meshes = meshes.into_iter().map(|sample| (0, sample)).chain(of_2d);
    for (i, (dimension, (format, _, bytes))) in meshes.enumerate() {
        let choice = MeshFormat::ALL.iter().position(|&other| other == format);
        write("meshes", i, choice.map(|choice| choice | dimension), bytes)?;
    }
    for (i, (format, bytes)) in samples::shapes().into_iter().enumerate() {
        write("shapes", i, ShapeFormat::ALL.iter().position(|&other| other == format), bytes)?;
    }
    let [of_3d, of_2d] = samples::neighbors();
    write("meshes", 100, Some(MeshFormat::ALL.len()), of_3d)?;
    write("meshes", 101, Some(MeshFormat::ALL.len() | 0x80), of_2d)
}
