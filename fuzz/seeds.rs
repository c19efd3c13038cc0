//! Writes the samples of the tests as seeds for the fuzz targets.

#[path = "../tests/io/samples.rs"]
mod samples;

use gdel::internals::io::{MeshFormat, PointFormat};
use std::{fs, io, path::Path};

fn main() -> io::Result<()> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let write = |target: &str, number: usize, choice: Option<usize>, bytes: Vec<u8>| {
        let choice = choice.and_then(|choice| u8::try_from(choice).ok()).unwrap_or_default();
        fs::create_dir_all(corpus.join(target))?;
        fs::write(corpus.join(target).join(format!("seed-{number}")), [vec![choice], bytes].concat())
    };
    for (i, (format, _, bytes)) in samples::point_clouds().into_iter().enumerate() {
        write("points", i, PointFormat::ALL.iter().position(|&other| other == format), bytes)?;
    }
    for (i, (format, _, bytes)) in samples::meshes().into_iter().enumerate() {
        write("meshes", i, MeshFormat::ALL.iter().position(|&other| other == format), bytes)?;
    }
    Ok(())
}
