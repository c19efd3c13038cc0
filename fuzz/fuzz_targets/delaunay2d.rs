//! The 2D triangulation of any finite points, proven by the verifier. The first byte chooses how
//! bytes become coordinates: small integers, which are often degenerate, or numbers of all
//! exponents.
#![no_main]

use gdel::{delaunay2d, verify2d};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&choice, bytes)) = data.split_first() else { return };
    let coordinates: Vec<f64> = match choice % 3 {
        0 => bytes.iter().map(|&b| f64::from(b % 16)).collect(),
        1 => bytes.as_chunks::<4>().0.iter().map(|&b| f64::from(f32::from_le_bytes(b))).collect(),
        _ => bytes.as_chunks::<8>().0.iter().map(|&b| f64::from_le_bytes(b)).collect(),
    };
    let (points, _) = coordinates.as_chunks::<2>();
    let finite: Vec<_> = points.iter().copied().filter(|p| p.iter().all(|x| x.is_finite())).take(200).collect();
    let mesh = delaunay2d(&finite).expect("finite points");
    let report = verify2d(&finite, &mesh).expect("finite points");
    assert!(report.passed(), "{report}");
});
