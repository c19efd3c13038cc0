//! Inputs that make other codes crash or return wrong meshes: the mesh is verified, and does not
//! depend on the insertion order.

use crate::clouds::{self, grid, shuffled, survey};
use gdel::{
    Mesh3, NONE, Points3,
    internals::{
        Options,
        cpu::delaunay_in_order,
        d3::generate::{Distribution3, generate3d},
        input::order::Order,
    },
    verify3d,
};

/// Verifies the mesh of the points, and checks that `shuffles` random insertion orders give the
/// same tetrahedra.
fn check<'a>(points: impl Into<Points3<'a>>, shuffles: u64) -> Mesh3 {
    let points = points.into();
    let triangulate = |order| delaunay_in_order::<3>(points, &Options::default(), order).unwrap();
    let mesh = triangulate(Order::default());
    let report = verify3d(points, &mesh).unwrap();
    assert!(report.passed(), "{report}");
    let canonical = mesh.canonical();
    for seed in 0..shuffles {
        let shuffled = triangulate(Order::Shuffled(seed));
        // Not by `assert_eq`, which would print them all.
        assert!(shuffled.canonical() == canonical, "order {seed} gives other tetrahedra");
        assert_eq!(shuffled.duplicate_of, mesh.duplicate_of);
        assert_eq!(shuffled.dimension, mesh.dimension);
    }
    mesh
}

fn check_flat(points: &[[f64; 3]], dimension: u8) {
    let mesh = check(points, 3);
    assert_eq!(mesh.dimension, dimension);
    assert!(mesh.tetrahedra.is_empty() && mesh.neighbors.is_empty() && mesh.hull.is_empty());
    assert_eq!(mesh.duplicate_of.len(), points.len());
}

#[test]
fn uniform() {
    check(&generate3d(Distribution3::Uniform, 20_000, 1), 3);
}

#[test]
fn gaussian() {
    check(&generate3d(Distribution3::Gaussian, 20_000, 1), 3);
}

#[test]
fn ball() {
    check(&generate3d(Distribution3::Ball, 20_000, 1), 3);
}

#[test]
fn sphere() {
    let mesh = check(&generate3d(Distribution3::Sphere, 10_000, 1), 3);
    assert_eq!(mesh.hull.len(), 2 * 10_000 - 4);
}

#[test]
fn sphere_rounded_to_f32() {
    let points: Vec<[f32; 3]> =
        generate3d(Distribution3::Sphere, 20_000, 1).iter().map(|p| p.map(|x| x as f32)).collect();
    check(&points, 3);
}

#[test]
fn thin_sphere() {
    check(&generate3d(Distribution3::ThinSphere, 20_000, 1), 3);
}

#[test]
fn grid_8() {
    check(&grid(8), 3);
    check(&shuffled(&grid(8), 1), 3);
}

#[test]
fn grid_16() {
    check(&shuffled(&grid(16), 1), 3);
}

#[test]
fn grid_32() {
    check(&shuffled(&grid(32), 1), 2);
}

#[test]
fn grid_40() {
    let mesh = check(&grid(40), 1);
    // 5 or 6 tetrahedra per cube.
    assert!((5 * 39usize.pow(3)..=6 * 39usize.pow(3)).contains(&mesh.tetrahedra.len()));
}

#[test]
fn random_subset_of_a_512_grid() {
    check(&generate3d(Distribution3::Grid, 50_000, 1), 2);
}

#[test]
fn random_points_of_a_64_grid_with_many_duplicates() {
    let mesh = check(&clouds::grid_64_with_duplicates(40_000), 2);
    assert!(mesh.duplicate_count() > 2_000);
}

#[test]
fn two_skew_lines() {
    let mesh = check(&clouds::two_skew_lines(300), 2);
    assert_eq!(mesh.tetrahedra.len(), 299 * 299);
}

#[test]
fn circle_and_its_axis() {
    check(&clouds::circle_and_its_axis(400), 2);
}

#[test]
fn circle_of_integers_and_its_axis() {
    let points = clouds::circle_of_integers_and_its_axis();
    assert_eq!(points.len(), 136);
    check(&points, 3);
}

#[test]
fn clusters_at_1e_9_spacing() {
    check(&clouds::clusters_at_1e_9_spacing(10_000), 3);
}

#[test]
fn grids_at_1e_9_spacing() {
    check(&clouds::grids_at_1e_9_spacing(8), 3);
}

#[test]
fn offset_by_1e7_in_millimetres() {
    check(&survey(20_000), 3);
}

#[test]
fn flat_ground_offset_by_1e7() {
    check(&clouds::flat_ground(5_000), 3);
}

#[test]
fn thirty_percent_duplicates() {
    let mesh = check(&clouds::thirty_percent_duplicates(2_000), 3);
    assert_eq!(mesh.duplicate_count(), 6_000);
}

#[test]
fn zero_and_minus_zero_are_the_same_coordinate() {
    let points =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-0.0, 0.0, -0.0], [1.0, -0.0, 0.0]];
    let mesh = check(&points, 3);
    assert_eq!(mesh.duplicate_of, [NONE, NONE, NONE, NONE, 0, 1]);
    assert_eq!(mesh.tetrahedra.len(), 1);
}

#[test]
fn bunny() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/bunny.ply");
    let cloud = gdel_io::files::read_points(std::path::Path::new(path)).unwrap();
    let mesh = check(&cloud, 3);
    assert_eq!(mesh.duplicate_of.len(), 35_947);
}

#[test]
#[ignore = "needs scripts/fetch-dragon.sh, and minutes"]
fn dragon() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/.cache/dragon.ply");
    let cloud = gdel_io::files::read_points(std::path::Path::new(path)).expect("run scripts/fetch-dragon.sh");
    let mesh = check(&cloud, 1);
    assert_eq!(mesh.duplicate_count(), 2_100);
}

#[test]
fn extreme_scales() {
    let cloud = generate3d(Distribution3::Uniform, 400, 1);
    let scaled = |factor: f64| cloud.iter().map(|p| p.map(|x| (x - 0.5) * factor)).collect::<Vec<_>>();
    for factor in [f64::MIN_POSITIVE, 1e-300, 1e-160, 1e160, 1e300, f64::MAX] {
        check(&scaled(factor), 2);
    }
    // All together: clouds within clouds.
    check(&[1e-310, 1e-200, 1.0, 1e200].into_iter().flat_map(scaled).collect::<Vec<_>>(), 2);
}

#[test]
fn a_box_as_long_as_numbers_go() {
    let points: Vec<_> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|bit| [-f64::MAX, f64::MAX][bit])).collect();
    assert_eq!(check(&points, 3).tetrahedra.len(), 6);
}

#[test]
fn no_point_to_four_points() {
    let corner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    check_flat(&corner[..0], 0);
    check_flat(&corner[..1], 0);
    check_flat(&corner[..2], 1);
    check_flat(&corner[..3], 2);
    let mesh = check(&corner, 3);
    assert_eq!((mesh.dimension, mesh.tetrahedra.len(), mesh.hull.len()), (3, 1, 4));
    let inside_out = [corner[0], corner[2], corner[1], corner[3]];
    assert_eq!(check(&inside_out, 3).tetrahedra.len(), 1);
}

#[test]
fn equal_points() {
    check_flat(&[[0.1, 0.2, 0.3]; 4], 0);
    check_flat(&[[-5.0; 3]; 1000], 0);
}

#[test]
fn collinear_points() {
    let multiples = |step: [f64; 3]| (0..2000).map(|i| step.map(|s| s * f64::from(i * 7 % 2000))).collect::<Vec<_>>();
    check_flat(&multiples([1.0, 0.0, 0.0]), 1);
    check_flat(&multiples([0.0, 0.0, -1.0]), 1);
    check_flat(&multiples([3.0, -2.0, 5.0]), 1);
    check_flat(&multiples([f64::from_bits(1); 3]), 1);
    // Multiples of 0.1 are rounded, but equally in each coordinate.
    check_flat(&multiples([0.1; 3]), 1);
}

#[test]
fn collinear_points_and_one_off_the_line() {
    let mut points: Vec<_> = (0..500).map(|i| [f64::from(i); 3]).collect();
    points.push([3.0, 3.0, 4.0]);
    check_flat(&points, 2);
    points.push([0.0, 1.0, 0.0]);
    assert_eq!(check(&points, 3).tetrahedra.len(), 499);
}

#[test]
fn coplanar_points() {
    let plane = |z: fn(f64, f64) -> f64| {
        let cloud = generate3d(Distribution3::Grid, 2000, 1);
        cloud.iter().map(|&[x, y, _]| [x, y, z(x, y)]).collect::<Vec<_>>()
    };
    check_flat(&plane(|_, _| 0.1), 2);
    check_flat(&plane(|x, y| x + 2.0 * y), 2);
    check_flat(&plane(|x, y| 5.0 - 3.0 * x - y), 2);
    // Not quite coplanar: one point is off by the smallest step.
    let mut points = plane(|_, _| 0.1);
    points[1234][2] = 0.1f64.next_up();
    assert_eq!(check(&points, 3).dimension, 3);
}
