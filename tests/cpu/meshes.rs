//! The methods of meshes agree with the arrays, on empty and degenerate meshes too.

use crate::clouds;
use gdel::{
    Backend, Csr, Mesh2, Mesh3, Triangulator,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
    },
};
use std::collections::BTreeSet;

fn mesh3(points: &[[f64; 3]]) -> Mesh3 {
    Triangulator::new().backend(Backend::Cpu).delaunay3d(points).unwrap()
}

fn mesh2(points: &[[f64; 2]]) -> Mesh2 {
    Triangulator::new().backend(Backend::Cpu).delaunay2d(points).unwrap()
}

fn inputs3() -> Vec<Vec<[f64; 3]>> {
    let mut inputs: Vec<_> = Distribution3::ALL.map(|distribution| generate3d(distribution, 200, 1)).into();
    let doubled = clouds::grid(3).iter().chain(&clouds::grid(2)).copied().collect();
    let flat = clouds::grid(3).iter().map(|&[x, y, _]| [x, y, 1.0]).collect();
    inputs.extend([clouds::grid(4), clouds::two_skew_lines(8), doubled, flat, vec![], vec![[1.0; 3]; 2]]);
    inputs.push(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    inputs
}

fn inputs2() -> Vec<Vec<[f64; 2]>> {
    let mut inputs: Vec<_> = Distribution2::ALL.map(|distribution| generate2d(distribution, 200, 1)).into();
    // A wheel: one vertex has all triangles.
    let wheel = (0..16).map(|i| f64::from(i) * 0.39).map(|t| [t.cos(), t.sin()]).chain([[0.0; 2]]).collect();
    let line = (0..9).map(|i| [f64::from(i % 5), 1.0]).collect();
    inputs.extend([wheel, line, vec![], vec![[1.0; 2]; 2], vec![[0.0; 2], [1.0, 0.0], [0.0, 1.0]]]);
    inputs
}

fn sorted<const N: usize>(mut simplex: [u32; N]) -> [u32; N] {
    simplex.sort_unstable();
    simplex
}

/// All faces of the simplices that have `M` vertices.
fn faces<const N: usize, const M: usize>(simplices: &[[u32; N]]) -> BTreeSet<[u32; M]> {
    let mut faces = BTreeSet::new();
    for simplex in simplices {
        for mask in (0u32..1 << N).filter(|mask| mask.count_ones() as usize == M) {
            let mut corners = (0..N).filter(|&k| mask >> k & 1 == 1).map(|k| simplex[k]);
            faces.insert(sorted([(); M].map(|()| corners.next().unwrap())));
        }
    }
    faces
}

/// Each face of the mesh once.
fn assert_faces<const N: usize>(found: impl Iterator<Item = [u32; N]>, expected: &BTreeSet<[u32; N]>) {
    let found: Vec<_> = found.map(sorted).collect();
    assert_eq!(found.len(), expected.len());
    assert_eq!(&found.into_iter().collect::<BTreeSet<_>>(), expected);
}

fn assert_stars<const N: usize>(stars: &Csr, simplices: &[[u32; N]], points: usize) {
    for v in 0..points as u32 {
        let expected: Vec<_> = (0..simplices.len()).filter(|&t| simplices[t].contains(&v)).collect();
        let mut star: Vec<_> = stars.of(v).iter().map(|&t| t as usize).collect();
        star.sort_unstable();
        assert_eq!(star, expected);
    }
}

fn assert_points(
    duplicate_of: &[u32],
    vertices: impl Iterator<Item = u32>,
    is_duplicate: impl Fn(u32) -> bool,
    representative: impl Fn(u32) -> u32,
    duplicates: usize,
) {
    let all = 0..duplicate_of.len() as u32;
    assert!(vertices.eq(all.clone().filter(|&i| !is_duplicate(i))));
    assert_eq!(duplicates, all.clone().filter(|&i| is_duplicate(i)).count());
    for i in all {
        assert_eq!(representative(i) == i, !is_duplicate(i));
        assert!(!is_duplicate(representative(i)));
    }
}

#[test]
fn methods_of_3d_meshes() {
    for points in inputs3() {
        let mesh = mesh3(&points);
        assert_faces(mesh.facets(), &faces(&mesh.tetrahedra));
        assert_faces(mesh.edges(), &faces(&mesh.tetrahedra));
        assert_stars(&mesh.stars(), &mesh.tetrahedra, points.len());
        let hull: BTreeSet<u32> = mesh.hull.as_flattened().iter().copied().collect();
        assert_eq!(mesh.hull_vertices(), hull.into_iter().collect::<Vec<_>>());
        let representative = |i| mesh.representative(i);
        assert_points(
            &mesh.duplicate_of,
            mesh.vertices(),
            |i| mesh.is_duplicate(i),
            representative,
            mesh.duplicate_count(),
        );
        for t in 0..mesh.tetrahedra.len() {
            for k in 0..4 {
                let [a, b, c] = mesh.facet(t, k).map(|v| points[v as usize]);
                // Seen from outside, the opposite vertex is behind the facet.
                assert_eq!(gdel::orient3d(a, b, c, points[mesh.tetrahedra[t][k] as usize]), -1);
                match mesh.neighbor(t, k) {
                    Some(u) => {
                        assert!((0..4).any(|l| mesh.neighbor(u, l) == Some(t)));
                        assert!(mesh.facet(t, k).iter().all(|v| mesh.tetrahedra[u].contains(v)));
                    }
                    None => assert!(mesh.hull.iter().any(|&f| sorted(f) == sorted(mesh.facet(t, k)))),
                }
            }
        }
    }
}

#[test]
fn methods_of_2d_meshes() {
    for points in inputs2() {
        let mesh = mesh2(&points);
        assert_faces(mesh.edges(), &faces(&mesh.triangles));
        let stars = mesh.stars();
        assert_stars(&stars, &mesh.triangles, points.len());
        let representative = |i| mesh.representative(i);
        assert_points(
            &mesh.duplicate_of,
            mesh.vertices(),
            |i| mesh.is_duplicate(i),
            representative,
            mesh.duplicate_count(),
        );
        let mut hull = BTreeSet::new();
        for t in 0..mesh.triangles.len() {
            for k in 0..3 {
                match mesh.neighbor(t, k) {
                    Some(u) => assert!((0..3).any(|l| mesh.neighbor(u, l) == Some(t))),
                    None => assert!(hull.insert(mesh.edge(t, k))),
                }
            }
        }
        assert_eq!(mesh.hull_edges().collect::<BTreeSet<_>>(), hull);
        // Around a vertex, each triangle follows the one before across an edge, counter-clockwise.
        for v in mesh.vertices() {
            let star: Vec<_> = stars.of(v).iter().map(|&t| t as usize).collect();
            let corner = |t: usize| mesh.triangles[t].iter().position(|&w| w == v).unwrap();
            let before = |t: usize| mesh.edge(t, corner(t))[1];
            let after = |t: usize| mesh.edge(t, (corner(t) + 1) % 3)[1];
            for pair in star.windows(2) {
                assert_eq!(after(pair[0]), before(pair[1]));
            }
            if let (Some(&first), Some(&last)) = (star.first(), star.last()) {
                let on_hull = hull.contains(&[v, before(first)]);
                assert_eq!(on_hull, mesh.hull.contains(&v));
                assert!(on_hull || after(last) == before(first));
            }
        }
    }
}

/// Coordinates for which the centres are exact.
#[test]
fn circumcenters() {
    let corner = [[2.0, 1.0, 0.0], [4.0, 1.0, 0.0], [2.0, 5.0, 0.0], [2.0, 1.0, 8.0]];
    assert_eq!(mesh3(&corner).circumcenter(&corner, 0), [3.0, 3.0, 4.0]);
    let corner = [[2.0, 1.0], [4.0, 1.0], [2.0, 5.0]];
    assert_eq!(mesh2(&corner).circumcenter(&corner, 0), [3.0, 3.0]);
    let points = generate2d(Distribution2::Uniform, 100, 1);
    let mesh = mesh2(&points);
    for t in 0..mesh.triangles.len() {
        let [x, y] = mesh.circumcenter(&points, t);
        let [a, b, c] = mesh.triangles[t].map(|v| (points[v as usize][0] - x).hypot(points[v as usize][1] - y));
        assert!((a - b).abs() < 1e-9 * a && (b - c).abs() < 1e-9 * a, "{a} {b} {c}");
    }
    let points = generate3d(Distribution3::Uniform, 100, 1);
    let mesh = mesh3(&points);
    for t in 0..mesh.tetrahedra.len() {
        let center = mesh.circumcenter(&points, t);
        let distance = |v: u32| (0..3).map(|i| (points[v as usize][i] - center[i]).powi(2)).sum::<f64>().sqrt();
        let [a, rest @ ..] = mesh.tetrahedra[t].map(distance);
        assert!(rest.iter().all(|b| (a - b).abs() < 1e-6 * a), "{a} {rest:?}");
    }
}
