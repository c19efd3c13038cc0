//! Writes what gdel derives from points, for `benches/answers.py --equal`, which compares it with
//! what CGAL, SciPy and brute force say.
//!
//! `answers DIMENSION FOLDER`, where the folder has `points.f64` and may have `queries.f64`: raw
//! coordinates. Writes arrays there and prints one JSON object.

use gdel::{
    AlphaShape, Backend, Interpolation, Interpolator, Interval, Locator, Mesh, SpanningTree, Triangulator,
    internals::derived::StolenMeasures, internals::geometry::Euclidean,
};
use std::{collections::HashMap, path::Path};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let [dimension, folder] = &words[..] else { panic!("answers DIMENSION FOLDER") };
    let folder = Path::new(folder);
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    match &**dimension {
        "2" => {
            let points = read::<2>(&folder.join("points.f64")).expect("points");
            let mesh = triangulator.delaunay2d(&points).expect("finite points");
            println!("{{{}}}", [interpolation(&mesh, &points, folder), tree(&mesh, &points)].concat().join(", "));
        }
        _ => {
            let points = read::<3>(&folder.join("points.f64")).expect("points");
            let mesh = triangulator.delaunay3d(&points).expect("finite points");
            let volume: f64 = mesh.volumes(&points).sum();
            write(&folder.join("tetrahedra.u32"), mesh.tetrahedra.as_flattened(), u32::to_le_bytes);
            let numbers = [
                vec![format!("\"hull_volume\": {volume:e}")],
                interpolation(&mesh, &points, folder),
                tree(&mesh, &points),
                alpha(&mesh, &points, folder),
            ];
            println!("{{{}}}", numbers.concat().join(", "));
        }
    }
}

fn read<const D: usize>(path: &Path) -> Option<Vec<[f64; D]>> {
    let bytes = std::fs::read(path).ok()?;
    let numbers = bytes.chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().expect("8 bytes")));
    Some(numbers.collect::<Vec<f64>>().as_chunks().0.to_vec())
}

fn write<T: Copy, const B: usize>(path: &Path, numbers: &[T], bytes: fn(T) -> [u8; B]) {
    let bytes: Vec<u8> = numbers.iter().flat_map(|&number| bytes(number)).collect();
    std::fs::write(path, bytes).expect("a folder to write to");
}

/// Writes linear interpolation at the queries, if there are any, and returns the largest errors of
/// the sum of the weights and of a linear function of the coordinates, whose largest value is 1.
fn interpolation<const D: usize, const N: usize>(
    mesh: &impl Mesh<D, N>,
    points: &[[f64; D]],
    folder: &Path,
) -> Vec<String>
where
    Euclidean: StolenMeasures<D, N>,
{
    let Some(queries) = read::<D>(&folder.join("queries.f64")) else { return vec![] };
    let locator = Locator::new(mesh, gdel::Points::F64(points)).expect("a mesh with its points");
    // The function that `benches/peers/linear.py` has.
    let values: Vec<f64> = points.iter().map(|p| p[0] * p[1] + p[D - 1]).collect();
    let interpolator = Interpolator::new(&locator, &values).expect("one value per point");
    let found = interpolator.interpolate_many(Interpolation::Linear, gdel::Points::F64(&queries));
    write(&folder.join("linear.f64"), &found.expect("finite queries"), f64::to_le_bytes);

    let largest = points.as_flattened().iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let function = |p: &[f64; D]| p.iter().zip([0.5, -0.25, 0.25]).map(|(x, factor)| factor * x).sum::<f64>() / largest;
    let mut numbers = vec![];
    for (name, method) in
        [("linear", Interpolation::Linear), ("laplace", Interpolation::Laplace), ("sibson", Interpolation::Sibson)]
    {
        let (mut inside, mut sum_error, mut linear_error) = (0, 0.0f64, 0.0f64);
        for query in queries.iter().take(10_000) {
            let Some(weights) = interpolator.weights(method, *query).expect("finite queries") else { continue };
            inside += 1;
            let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
            let value: f64 = weights.iter().map(|&(v, weight)| weight * function(&points[v as usize])).sum();
            sum_error = sum_error.max((sum - 1.0).abs());
            linear_error = linear_error.max((value - function(query)).abs());
        }
        numbers.push(format!("\"{name}\": [{inside}, {sum_error:e}, {linear_error:e}]"));
    }
    numbers
}

fn tree<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]]) -> Vec<String>
where
    Euclidean: StolenMeasures<D, N>,
{
    let tree = SpanningTree::new(mesh, gdel::Points::F64(points)).expect("a mesh with its points");
    vec![format!("\"tree_edges\": {}, \"tree_length\": {:e}", tree.edges.len(), tree.total_length())]
}

/// Writes the intervals of all simplices and faces, and returns what the `auto` surface is like.
fn alpha(mesh: &gdel::Mesh3, points: &[[f64; 3]], folder: &Path) -> Vec<String> {
    let shape = AlphaShape::new(mesh, points).expect("a mesh with its points");
    let cells: Vec<f64> = shape.simplices().collect();
    write(&folder.join("cells.f64"), &cells, f64::to_le_bytes);
    write_faces(folder, "facets", shape.facets());
    write_faces(folder, "edges", shape.edges());
    write_faces(folder, "vertices", shape.vertices().map(|(v, interval)| ([v], interval)));

    let auto = shape.find_alpha(1).expect("points that are not flat");
    let complex = shape.at(auto).expect("a radius");
    let mut directed = HashMap::<[u32; 2], [u32; 2]>::new();
    let (mut triangles, mut enclosed) = (0, 0.0);
    for [a, b, c] in complex.surface() {
        triangles += 1;
        for [v, w] in [[a, b], [b, c], [c, a]] {
            directed.entry([v.min(w), v.max(w)]).or_default()[usize::from(v > w)] += 1;
        }
        let [a, b, c] = [a, b, c].map(|v| points[v as usize]);
        enclosed += (a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))
            / 6.0;
    }
    let open = directed.values().filter(|[forth, back]| forth != back).count();
    let pinched = directed.values().filter(|[forth, _]| *forth > 1).count();
    let volumes: Vec<f64> = mesh.volumes(points).collect();
    let solid: f64 = complex.solid().map(|t| volumes[t]).sum();
    let components = complex.components().1;
    vec![
        format!("\"auto\": {auto:e}, \"components\": {components}, \"triangles\": {triangles}, \"open_edges\": {open}"),
        format!("\"edges_of_four\": {pinched}, \"enclosed\": {enclosed:e}, \"solid\": {solid:e}"),
    ]
}

fn write_faces<const K: usize>(folder: &Path, name: &str, faces: impl Iterator<Item = ([u32; K], Interval)>) {
    let (faces, intervals): (Vec<_>, Vec<_>) =
        faces.map(|(face, i)| (face, [i.singular, i.regular, i.interior])).unzip();
    write(&folder.join(name).with_extension("u32"), faces.as_flattened(), u32::to_le_bytes);
    write(&folder.join(name).with_extension("f64"), intervals.as_flattened(), f64::to_le_bytes);
}
