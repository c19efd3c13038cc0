//! Binary glTF, read back by the crate `gltf`, which also validates it.

use gdel::{Mesh2, Mesh3, Points};
use gdel_io::SurfaceFormat;

/// A file's triangles by the places of their corners in space, and the translation of its node.
fn read(file: &[u8]) -> (Vec<[[f64; 3]; 3]>, [f64; 3]) {
    let gltf = gltf::Gltf::from_slice(file).expect("valid glTF");
    let blob = gltf.blob.as_deref();
    let [scene] = &gltf.scenes().collect::<Vec<_>>()[..] else { panic!("one scene") };
    let node = scene.nodes().next().expect("a node");
    let Some(mesh) = node.mesh() else { return (Vec::new(), [0.0; 3]) };
    // The crate has single precision only; the JSON has double.
    let json: serde_json::Value = serde_json::from_slice(&file[20..20 + length(file, 12)]).expect("JSON");
    let vector = |key: &str, absent: f64| match &json["nodes"][0][key] {
        serde_json::Value::Null => [absent; 3],
        array => std::array::from_fn(|i| array[i].as_f64().expect("a number")),
    };
    let (translation, scale) = (vector("translation", 0.0), vector("scale", 1.0));
    let primitive = mesh.primitives().next().expect("a primitive");
    let reader = primitive.reader(|_| blob);
    let positions: Vec<[f32; 3]> = reader.read_positions().expect("positions").collect();
    let bounds = primitive.bounding_box();
    for axis in 0..3 {
        let coordinates = || positions.iter().map(|p| p[axis]);
        assert_eq!(coordinates().fold(f32::INFINITY, f32::min), bounds.min[axis]);
        assert_eq!(coordinates().fold(f32::NEG_INFINITY, f32::max), bounds.max[axis]);
    }
    let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
    let place = |i: u32| {
        let p = positions[i as usize];
        std::array::from_fn(|axis| translation[axis] + scale[axis] * f64::from(p[axis]))
    };
    let (triangles, rest) = indices.as_chunks::<3>();
    assert!(rest.is_empty());
    (triangles.iter().map(|t| t.map(place)).collect(), translation)
}

fn length(file: &[u8], at: usize) -> usize {
    u32::from_le_bytes(file[at..at + 4].try_into().expect("four bytes")) as usize
}

fn hull_of(points: &[[f64; 3]]) -> (Mesh3, Vec<u8>) {
    let mesh = gdel::delaunay3d(points).expect("finite points");
    let mut file = Vec::new();
    SurfaceFormat::Glb.write(&mut file, points.into(), &mesh).expect("memory");
    assert_eq!(length(&file, 8), file.len());
    (mesh, file)
}

/// Each triangle is the hull's, in order, up to `error`.
#[track_caller]
fn has_hull(points: &[[f64; 3]], error: f64) -> [f64; 3] {
    let (mesh, file) = hull_of(points);
    let (triangles, translation) = read(&file);
    assert_eq!(triangles.len(), mesh.hull.len());
    for (found, expected) in triangles.iter().zip(&mesh.hull) {
        for (found, &v) in found.iter().zip(expected) {
            for axis in 0..3 {
                let expected = points[v as usize][axis];
                assert!((found[axis] - expected).abs() <= error, "{found:?} {:?}", points[v as usize]);
            }
        }
    }
    translation
}

/// A cube's corners, its middle, and a point above one facet.
fn house(at: f64, size: f64) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> =
        (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|bit| at + size * f64::from(bit))).collect();
    points.push([at + size / 2.0; 3]);
    points.push([at + size / 2.0, at + size / 2.0, at + size * 1.25]);
    points
}

#[test]
fn single_precision_is_written_as_it_is() {
    assert_eq!(has_hull(&house(0.0, 1.0), 0.0), [0.0; 3]);
    assert_eq!(has_hull(&house(-4096.0, 0.25), 0.0), [0.0; 3]);
}

#[test]
fn double_precision_is_relative_to_the_middle() {
    // As in a national grid: single precision alone would be off by a quarter of a metre.
    let translation = has_hull(&house(5_400_000.1, 3.3), 1e-6);
    assert!((translation[0] - 5_400_001.75).abs() < 1e-6, "{translation:?}");
}

#[test]
fn numbers_beyond_single_precision_are_scaled() {
    has_hull(&house(0.0, 3e300), 1e294);
    has_hull(&house(1e-310, 1e-305), 1e-311);
    let huge = f64::MAX;
    let points = [[-huge, -huge, -huge], [huge, 0.0, 0.0], [0.0, huge, 0.0], [0.0, 0.0, huge]];
    has_hull(&points, huge / 1e6);
}

#[test]
fn no_hull_is_an_empty_scene() {
    for points in [&[][..], &[[1.0; 3]; 3]] {
        let (_, file) = hull_of(points);
        assert_eq!(read(&file).0, Vec::<[[f64; 3]; 3]>::new());
    }
}

#[test]
fn triangles_in_2d_lie_at_z_0_and_turn_counter_clockwise() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.5f64]];
    let mesh: Mesh2 = gdel::delaunay2d(&points).expect("finite points");
    let mut file = Vec::new();
    SurfaceFormat::Glb.write(&mut file, Points::from(&points), &mesh).expect("memory");
    let (triangles, _) = read(&file);
    assert_eq!(triangles.len(), 2);
    for [a, b, c] in triangles {
        assert_eq!([a[2], b[2], c[2]], [0.0; 3]);
        assert!((b[0] - a[0]) * (c[1] - a[1]) > (c[0] - a[0]) * (b[1] - a[1]));
    }
}
