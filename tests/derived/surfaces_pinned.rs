//! The surfaces that `tests/data/surfaces.txt` pins: the tests of the npm package compare with them, too.

use crate::inputs::{mesh2, mesh3};
use gdel::{
    Mesh, Points, Surface, SurfaceOptions,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        derived::SurfaceMesh,
        geometry::Euclidean,
    },
};

/// Returns the number of facets and a fingerprint: FNV-1a, 64 bits, of the facets, the sources and the
/// coordinates, as little-endian bytes.
fn fingerprint<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>, points: &[[f64; D]], smooth: &str) -> String
where
    Euclidean: SurfaceMesh<D, N>,
{
    let mut options = SurfaceOptions::default();
    options.smooth = smooth.parse().ok();
    let surface = Surface::new(mesh, Points::F64(points), &options).unwrap();
    let words = surface.facets().as_flattened().iter().chain(surface.sources()).flat_map(|v| v.to_le_bytes());
    // JavaScript has the other orientation in 2D, and no negative zero.
    let upright =
        |p: &[f64; D]| std::array::from_fn::<_, D, _>(|axis| if D == 2 && axis == 1 { 0.0 - p[1] } else { p[axis] });
    let coordinates = surface.vertices().iter().flat_map(upright).flat_map(f64::to_le_bytes);
    let hash = words
        .chain(coordinates)
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3_u64));
    format!("{} {hash:016x}", surface.facets().len())
}

#[test]
fn surfaces_have_their_fingerprints() {
    let mut found = String::new();
    let pinned = include_str!("../data/surfaces.txt");
    for line in pinned.lines() {
        let fields: Vec<&str> = line.split(' ').collect();
        if line.starts_with('#') {
            found += line;
        } else {
            let &[dimension, name, count, seed, smooth, ..] = &fields[..] else { panic!("{line}") };
            let (points, start) = (count.parse().unwrap(), seed.parse().unwrap());
            let fingerprint = if dimension == "3" {
                let distribution = Distribution3::ALL.into_iter().find(|d| d.name() == name).unwrap();
                let points = generate3d(distribution, points, start);
                fingerprint(&mesh3(&points), &points, smooth)
            } else {
                let distribution = Distribution2::ALL.into_iter().find(|d| d.name() == name).unwrap();
                let points: Vec<_> = generate2d(distribution, points, start).iter().map(|&[x, y]| [x, -y]).collect();
                fingerprint(&mesh2(&points), &points, smooth)
            };
            found += &format!("{dimension} {name} {count} {seed} {smooth} {fingerprint}");
        }
        found += "\n";
    }
    assert_eq!(found, pinned, "found:\n{found}");
}
