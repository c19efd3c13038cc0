//! Every reader of meshes, in 3D and in 2D, and the verifier on what they return; the first byte
//! chooses the format and the dimension.
#![no_main]

use gdel::{Mesh2, Mesh3, Points, Points2};
use gdel_io::{MeshFormat, read_neigh};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&choice, bytes)) = data.split_first() else { return };
    let format = MeshFormat::ALL.get(usize::from(choice & 0x7f) % (MeshFormat::ALL.len() + 1));
    match (format, choice & 0x80) {
        (Some(format), 0) => {
            if let Ok(mesh) = format.read::<Mesh3, _, _>(bytes) {
                let points = mesh.points.as_ref().map(Points::from);
                // Points may not be finite, and the mesh may be anything.
                points.map(|points| gdel::verify3d(points, &mesh).map(drop));
            }
        }
        (Some(format), _) => {
            if let Ok(mesh) = format.read::<Mesh2, _, _>(bytes) {
                let points = mesh.points.as_ref().map(Points2::from);
                points.map(|points| gdel::verify2d(points, &mesh).map(drop));
            }
        }
        (None, 0) => drop(read_neigh::<Mesh3, _, _>(bytes)),
        (None, _) => drop(read_neigh::<Mesh2, _, _>(bytes)),
    }
});
