//! The triangulation on the CPU gives the meshes that `tests/data/fingerprints.txt` pins. The tests
//! of the npm package compare with the same file.

use gdel::{
    Backend, Triangulator,
    internals::d3::generate::{Distribution3, generate3d},
};

/// FNV-1a, 64 bits, over the indices of the canonical tetrahedra as little-endian words.
fn fingerprint(tetrahedra: &[[u32; 4]]) -> u64 {
    let bytes = tetrahedra.as_flattened().iter().flat_map(|v| v.to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[test]
fn meshes_have_their_fingerprints() {
    let mut found = String::new();
    let pinned = include_str!("../data/fingerprints.txt");
    for line in pinned.lines() {
        let fields: Vec<&str> = line.split(' ').collect();
        if line.starts_with('#') {
            found += line;
        } else {
            let &[name, count, seed, ..] = &fields[..] else { panic!("{line}") };
            let distribution = Distribution3::ALL.into_iter().find(|d| d.name() == name).unwrap();
            let points = generate3d(distribution, count.parse().unwrap(), seed.parse().unwrap());
            let mesh = Triangulator::new().backend(Backend::Cpu).delaunay3d(&points).unwrap();
            let canonical = mesh.canonical();
            found += &format!("{name} {count} {seed} {} {:016x}", canonical.len(), fingerprint(&canonical));
        }
        found += "\n";
    }
    assert_eq!(found, pinned, "found:\n{found}");
}
