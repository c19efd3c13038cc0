//! Binary glTF 2.0 (Khronos, §4.4), which viewers, engines and browsers read.
//!
//! Written here, since two chunks and a few lines of JSON need no library.

use crate::surface::{MARK, Surface};
use std::io::{self, Write};

/// The file's header, and that of a chunk, which is its length and type.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// Writes binary glTF.
///
/// Numbers have single precision. Coordinates that it does not hold exactly are relative to the
/// centre of the surface, and the translation of the node is that centre in double precision.
/// Coordinates beyond the range of single precision are scaled as well. Axes are not exchanged,
/// though *y* points up in glTF.
///
/// Returns [`io::ErrorKind::FileTooLarge`] beyond 4 GB, the limit of the format.
pub(super) fn write_surface<const D: usize>(mut to: impl Write, surface: &Surface<'_, D>) -> io::Result<()> {
    let name = surface.name;
    let triangles = surface.triangles().len();
    let place = Place::of(surface);
    let positions = || surface.vertices().map(|p| place.relative(p));
    let position_bytes = 12 * surface.vertices().len();
    let binary_bytes = position_bytes + 12 * triangles;
    let mut json = match triangles {
        // A mesh may not be empty, but a node may.
        0 => format!(
            r#"{{"asset":{{"version":"2.0","generator":"{MARK}"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"name":"{name}"}}]}}"#
        ),
        count => {
            let [min, max] = bounds(positions().map(|p| p.map(f64::from)));
            let node = place.json();
            format!(r#"{{"asset":{{"version":"2.0","generator":"{MARK}"}},"scene":0,"scenes":[{{"nodes":[0]}}],"#)
                + &format!(r#""nodes":[{{"mesh":0,"name":"{name}"{node}}}],"#)
                + r#""meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"#
                + &format!(r#""buffers":[{{"byteLength":{binary_bytes}}}],"bufferViews":["#)
                + &format!(r#"{{"buffer":0,"byteLength":{position_bytes},"target":34962}},"#)
                + &format!(
                    r#"{{"buffer":0,"byteOffset":{position_bytes},"byteLength":{},"target":34963}}],"#,
                    12 * count
                )
                + &format!(
                    r#""accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":{min:?},"max":{max:?}}},"#,
                    surface.vertices().len()
                )
                + &format!(r#"{{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}]}}"#, 3 * count)
        }
    };
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let chunk = |len: usize, kind: &[u8; 4]| Ok::<_, io::Error>([length(len)?.to_le_bytes(), *kind].concat());
    to.write_all(b"glTF\x02\0\0\0")?;
    // An empty chunk is left out.
    let binary_chunk = if binary_bytes > 0 { CHUNK_HEADER + binary_bytes } else { 0 };
    to.write_all(&length(HEADER + CHUNK_HEADER + json.len() + binary_chunk)?.to_le_bytes())?;
    to.write_all(&chunk(json.len(), b"JSON")?)?;
    to.write_all(json.as_bytes())?;
    if binary_bytes > 0 {
        to.write_all(&chunk(binary_bytes, b"BIN\0")?)?;
    }
    for x in positions().flatten() {
        to.write_all(&x.to_le_bytes())?;
    }
    for v in surface.triangles().flatten() {
        to.write_all(&v.to_le_bytes())?;
    }
    Ok(())
}

fn length(bytes: usize) -> io::Result<u32> {
    u32::try_from(bytes).map_err(|_| io::Error::new(io::ErrorKind::FileTooLarge, "a .glb file holds at most 4 GB"))
}

/// Returns the lowest and the highest coordinates of at least one point.
fn bounds(points: impl Iterator<Item = [f64; 3]>) -> [[f64; 3]; 2] {
    points.fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[low, high], p| {
        [std::array::from_fn(|i| low[i].min(p[i])), std::array::from_fn(|i| high[i].max(p[i]))]
    })
}

/// The coordinates are `middle` + `scale`·number.
struct Place {
    middle: [f64; 3],
    scale: f64,
}

impl Place {
    fn of<const D: usize>(surface: &Surface<'_, D>) -> Self {
        if surface.vertices().flatten().all(|x| f64::from(x as f32) == x) {
            return Place { middle: [0.0; 3], scale: 1.0 };
        }
        let [low, high] = bounds(surface.vertices());
        let middle = std::array::from_fn(|i| low[i] / 2.0 + high[i] / 2.0);
        let radius = (0..3).map(|i| high[i] / 2.0 - low[i] / 2.0).fold(0.0, f64::max);
        // Far within the range of single precision, so that no coordinate that matters underflows.
        let is_ordinary = (1e-30..1e30).contains(&radius);
        Place { middle, scale: if is_ordinary || radius == 0.0 { 1.0 } else { radius } }
    }

    fn relative(&self, p: [f64; 3]) -> [f32; 3] {
        std::array::from_fn(|i| ((p[i] - self.middle[i]) / self.scale) as f32)
    }

    /// Returns the node's properties.
    fn json(&self) -> String {
        let mut json = String::new();
        if self.middle != [0.0; 3] {
            json += &format!(r#","translation":{:?}"#, self.middle);
        }
        if self.scale != 1.0 {
            json += &format!(r#","scale":{:?}"#, [self.scale; 3]);
        }
        json
    }
}
