//! File formats, the verifier, and synthetic points.

mod d2;
mod d3;

use gdel::{
    Fill, Points,
    verify::{Check, Outcome, Report},
};
use gdel_io::{
    Mesh, PointBuf, PointCloud, PointFormat, ShapeFormat, SurfaceFormat, write_ele, write_neigh, write_npz, write_vtu,
    write_weighted_node,
};
use js_sys::{Array, Float32Array, Float64Array, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    objects::{Thrown, error, object},
    points::{room, zeros},
};

/// Returns the extensions of the files that `read_points` can read.
#[wasm_bindgen]
pub fn point_extensions() -> Vec<String> {
    PointFormat::ALL.iter().flat_map(|format| format.extensions()).map(|&extension| extension.to_owned()).collect()
}

/// Reads a point cloud in the format of files with this extension, of 2 or 3 dimensions.
#[wasm_bindgen]
pub fn read_points(bytes: &Uint8Array, extension: &str, dimension: u32) -> Result<JsValue, Thrown> {
    if dimension == 2 { read::<2>(bytes, extension) } else { read::<3>(bytes, extension) }
}

fn read<const D: usize>(bytes: &Uint8Array, extension: &str) -> Result<JsValue, Thrown> {
    let format = PointFormat::from_extension(extension)
        .ok_or_else(|| error("UNKNOWN_FORMAT", &format!("{extension:?} is not a known format of point clouds")))?;
    let mut content = zeros(bytes.length())?;
    bytes.copy_to(&mut content);
    let cloud: PointCloud<D> = format.read(content).map_err(|e| error("BAD_FILE", &e.to_string()))?;
    let points = match &cloud.points {
        PointBuf::F32(points) => Float32Array::new_from_slice(points.as_flattened()).into(),
        PointBuf::F64(points) => Float64Array::new_from_slice(points.as_flattened()).into(),
    };
    let (colors, source) = match &cloud.colors {
        Some(colors) => (Uint8Array::new_from_slice(colors.rgb.as_flattened()).into(), colors.source.name().into()),
        None => (JsValue::NULL, JsValue::NULL),
    };
    let normals = match &cloud.normals {
        Some(normals) => Float32Array::new_from_slice(normals.as_flattened()).into(),
        None => JsValue::NULL,
    };
    let sensors = match cloud.sensors.as_slice() {
        [] => JsValue::NULL,
        sensors => Float64Array::new_from_slice(sensors.as_flattened()).into(),
    };
    Ok(object([
        ("points", points),
        ("noReturn", (cloud.no_return as f64).into()),
        ("colors", colors),
        ("colorSource", source),
        ("normals", normals),
        ("sensors", sensors),
    ]))
}

/// Reads shapes in the format of files with this extension.
#[wasm_bindgen]
pub fn read_shapes(bytes: &Uint8Array, extension: &str) -> Result<JsValue, Thrown> {
    let format = ShapeFormat::from_extension(extension)
        .ok_or_else(|| error("UNKNOWN_FORMAT", &format!("{extension:?} is not a known format of shapes")))?;
    let mut content = zeros(bytes.length())?;
    bytes.copy_to(&mut content);
    let shapes = format.read(&content).map_err(|e| error("BAD_FILE", &e.to_string()))?;
    let fill = match shapes.fill {
        Fill::EvenOdd => "evenodd",
        Fill::NonZero => "nonzero",
        Fill::Enclosed => "enclosed",
        _ => "all",
    };
    let rings: Array = shapes.rings.iter().map(|ring| Uint32Array::new_from_slice(ring)).collect();
    let holes: Array = shapes.holes.iter().map(|&[x, y]| Array::of2(&x.into(), &y.into())).collect();
    let left_out: Array = shapes.left_out.iter().map(|what| JsValue::from(what.as_str())).collect();
    Ok(object([
        ("points", Float64Array::new_from_slice(shapes.points.as_flattened()).into()),
        ("edges", Uint32Array::new_from_slice(shapes.edges.as_flattened()).into()),
        ("rings", rings.into()),
        ("holes", holes.into()),
        ("fill", fill.into()),
        ("droppedZ", shapes.dropped_z.into()),
        ("leftOut", left_out.into()),
    ]))
}

/// Returns `count` points, interleaved, of the distribution in `all` whose name is `kind`.
fn generated<T: Copy, const D: usize>(
    all: &[T],
    name: fn(T) -> &'static str,
    generate: fn(T, usize, u64) -> Vec<[f64; D]>,
    kind: &str,
    count: u32,
    seed: u64,
) -> Result<Float64Array, Thrown> {
    let distribution = all.iter().copied().find(|&distribution| name(distribution) == kind).ok_or_else(|| {
        let names: Vec<_> = all.iter().map(|&distribution| name(distribution)).collect();
        error("BAD_INPUT", &format!("{kind:?} is not a {D}D distribution; these are: {}", names.join(", ")))
    })?;
    // Fails here, and not half-way, if memory does not suffice for the points and their copy.
    drop(room::<[[f64; D]; 2]>(count as usize)?);
    let points = generate(distribution, count as usize, seed);
    Ok(Float64Array::new_from_slice(points.as_flattened()))
}

/// Returns what the verifier found, with the counts that its dimension has.
fn report_object<const N: usize>(report: &Report, counts: [(&str, usize); N]) -> JsValue {
    let check = |(check, outcome): &(Check, Outcome)| {
        let (state, detail, count) = match outcome {
            Outcome::Passed => ("passed", String::new(), 0),
            Outcome::Failed { first, count } => ("failed", first.to_string(), *count),
            Outcome::NotStated => ("not stated", "the mesh does not state it".to_owned(), 0),
            Outcome::Blocked(required) => ("not decided", format!("not decided without {required}"), 0),
            _ => ("not decided", String::new(), 0),
        };
        object([
            ("name", check.name().into()),
            ("outcome", state.into()),
            ("passed", matches!(outcome, Outcome::Passed).into()),
            ("detail", detail.into()),
            ("defects", count.into()),
        ])
    };
    let checks: Array = report.outcomes.iter().map(check).collect();
    object([
        ("passed", report.passed().into()),
        ("dimension", report.dimension.into()),
        ("checks", checks.into()),
        ("counts", object(counts.map(|(name, count)| (name, count.into())))),
    ])
}

/// Returns the content of a file, with its extension.
fn file(
    extension: &'static str,
    write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>,
) -> Result<(&'static str, JsValue), Thrown> {
    let mut bytes = Vec::new();
    write(&mut bytes).map_err(|e| error("OUT_OF_MEMORY", &e.to_string()))?;
    Ok((extension, Uint8Array::new_from_slice(&bytes).into()))
}

/// Returns a mesh as files of a format: `{ extension: bytes }`. The format `triple` is the three
/// text files of TetGen or Triangle.
fn files<M: Mesh<D, N>, const D: usize, const N: usize>(
    points: Points<'_, D>,
    mesh: &M,
    format: &str,
    triple: &str,
) -> Result<JsValue, Thrown> {
    match format {
        "vtu" => Ok(object([file("vtu", |to| write_vtu(to, points, mesh))?])),
        "npz" => Ok(object([file("npz", |to| write_npz(to, points, mesh))?])),
        _ if format == triple => Ok(object([
            file("node", |to| write_weighted_node(to, points, mesh.weights()))?,
            file("ele", |to| write_ele(to, mesh))?,
            file("neigh", |to| write_neigh(to, mesh))?,
        ])),
        _ => {
            let surface = SurfaceFormat::from_extension(format)
                .ok_or_else(|| error("UNKNOWN_FORMAT", &format!("{format:?} is not a known format of meshes")))?;
            Ok(object([file(surface.extensions()[0], |to| surface.write(to, points, mesh))?]))
        }
    }
}
