//! Point sets and queries of both dimensions, degenerate ones first.

use crate::clouds;
use gdel::{
    Backend, Mesh2, Mesh3, Triangulator,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
    },
};

pub fn mesh3(points: &[[f64; 3]]) -> Mesh3 {
    Triangulator::new().backend(Backend::Cpu).delaunay3d(points).unwrap()
}

pub fn mesh2(points: &[[f64; 2]]) -> Mesh2 {
    Triangulator::new().backend(Backend::Cpu).delaunay2d(points).unwrap()
}

/// Returns point sets of some hundred points in 3D, with names.
pub fn inputs3() -> Vec<(&'static str, Vec<[f64; 3]>)> {
    let mut inputs: Vec<_> = Distribution3::ALL.map(|d| (d.name(), generate3d(d, 120, 1))).into();
    let doubled = clouds::grid(3).iter().chain(&clouds::grid(2)).copied().collect();
    let flat = clouds::grid(3).iter().map(|&[x, y, _]| [x, y, 1.0]).collect();
    let scaled =
        |factor: f64| generate3d(Distribution3::Uniform, 60, 4).iter().map(|p| p.map(|x| x * factor)).collect();
    inputs.extend([
        ("grid of 5³", clouds::grid(5)),
        ("shuffled grid", clouds::shuffled(&clouds::grid(4), 1)),
        ("doubled grid", doubled),
        ("two skew lines", clouds::two_skew_lines(12)),
        ("circle and axis", clouds::circle_and_its_axis(20)),
        ("circle of integers", clouds::circle_of_integers_and_its_axis()),
        ("clusters", clouds::clusters_at_1e_9_spacing(200)),
        ("grids at 1e-9", clouds::grids_at_1e_9_spacing(3)),
        ("survey", clouds::survey(150)),
        ("flat ground", clouds::flat_ground(60)),
        ("tiny", scaled(1e-300)),
        ("small", scaled(1e-100)),
        ("large", scaled(1e100)),
        ("huge", scaled(1e300)),
        ("one tetrahedron", vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        ("coplanar", flat),
        ("two equal points", vec![[1.0; 3]; 2]),
        ("nothing", vec![]),
    ]);
    inputs
}

/// Returns point sets of some hundred points in 2D, with names.
pub fn inputs2() -> Vec<(&'static str, Vec<[f64; 2]>)> {
    let mut inputs: Vec<_> = Distribution2::ALL.map(|d| (d.name(), generate2d(d, 300, 1))).into();
    let grid = |side: u32| (0..side * side).map(|i| [i % side, i / side].map(f64::from)).collect::<Vec<_>>();
    // A wheel: one vertex has all triangles.
    let wheel = (0..16).map(|i| f64::from(i) * 0.39).map(|t| [libm::cos(t), libm::sin(t)]).chain([[0.0; 2]]).collect();
    let scaled =
        |factor: f64| generate2d(Distribution2::Uniform, 60, 4).iter().map(|p| p.map(|x| x * factor)).collect();
    let circle = clouds::circle_of_integers_and_its_axis()[..36].iter().map(|&[x, y, _]| [x, y]).collect();
    inputs.extend([
        ("grid of 9²", grid(9)),
        ("doubled grid", [grid(4), grid(3)].concat()),
        ("wheel", wheel),
        ("circle of integers", circle),
        ("tiny", scaled(1e-300)),
        ("small", scaled(1e-100)),
        ("large", scaled(1e100)),
        ("huge", scaled(1e300)),
        ("one triangle", vec![[0.0; 2], [1.0, 0.0], [0.0, 1.0]]),
        ("collinear", (0..9).map(|i| [f64::from(i % 5), 1.0]).collect()),
        ("two equal points", vec![[1.0; 2]; 2]),
        ("nothing", vec![]),
    ]);
    inputs
}

/// Returns queries around and between the points: random ones inside the bounding box and around
/// it, the points, the middles of some pairs, and all of these moved by one unit in the last place.
pub fn queries<const D: usize>(points: &[[f64; D]]) -> Vec<[f64; D]> {
    let random = generate3d(Distribution3::Uniform, 100, 77);
    let mut queries = vec![[0.0; D], [0.5; D], [-1.0; D]];
    let Some(&first) = points.first() else { return queries };
    let bounds: [[f64; 2]; D] = std::array::from_fn(|axis| {
        let all = || points.iter().map(|p| p[axis]);
        [all().fold(first[axis], f64::min), all().fold(first[axis], f64::max)]
    });
    for (i, r) in random.iter().enumerate() {
        // Every second one from a box of twice the size, as far as that does not overflow.
        let margin = if i % 2 == 0 { 0.0 } else { 0.5 };
        queries.push(std::array::from_fn(|axis| {
            let [low, high] = bounds[axis];
            let at = r[axis] * (1.0 + 2.0 * margin) - margin;
            (low * (1.0 - at) + high * at).clamp(f64::MIN, f64::MAX)
        }));
    }
    for (i, &p) in points.iter().enumerate().take(40) {
        queries.push(p);
        for step in [1, 7, 31] {
            let q = points[(i + step) % points.len()];
            let r = points[(i + 2 * step) % points.len()];
            queries.push(std::array::from_fn(|axis| p[axis] / 2.0 + q[axis] / 2.0));
            queries.push(std::array::from_fn(|axis| p[axis] / 2.0 + q[axis] / 4.0 + r[axis] / 4.0));
        }
    }
    let nudge = |q: &[f64; D]| {
        let mut q = *q;
        q[0] = q[0].next_up();
        q[D - 1] = q[D - 1].next_down();
        q
    };
    let nudged: Vec<_> = queries.iter().map(nudge).filter(|q| q.iter().all(|x| x.is_finite())).collect();
    queries.extend(nudged);
    queries
}
