//! Inputs on which other libraries failed, as the reports in their public trackers have them: each gives a mesh that is
//! proven, with all segments as edges.

use gdel::{Backend, Constrained2, Constraints, Error, Fill, MeshView2, Triangulator, verify2d};

fn constrained(points: &[[f64; 2]], constraints: &Constraints) -> Result<Constrained2, Error> {
    Triangulator::new().backend(Backend::Cpu).constrained2d(points, constraints)
}

/// Proves the mesh of points and constraints, and returns it.
fn prove(name: &str, points: &[[f64; 2]], constraints: &Constraints) -> Constrained2 {
    let found = constrained(points, constraints).unwrap_or_else(|error| panic!("{name}: {error}"));
    let all = [points, &found.added].concat();
    let mut view = MeshView2::from(&found.mesh);
    view.segments = Some(&found.segments);
    let report = verify2d(&all, view).unwrap();
    assert!(report.passed(), "{name}: {report}");
    found
}

/// Returns the area inside, which is to be that of the ring.
fn check_ring(name: &str, ring: &[[f64; 2]]) {
    let indices: Vec<u32> = (0..ring.len() as u32).collect();
    let found = prove(name, ring, &Constraints::new().ring(&indices).fill(Fill::EvenOdd));
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let of = |v: u32| ring[v as usize];
    let area: f64 =
        found.inside_triangles().map(|[a, b, c]| cross(of(a), of(b)) + cross(of(b), of(c)) + cross(of(c), of(a))).sum();
    let expected: f64 = (0..ring.len()).map(|i| cross(ring[i], ring[(i + 1) % ring.len()])).sum();
    assert!((area.abs() - expected.abs()).abs() <= 1e-12 * expected.abs(), "{name}: {area} and {expected}");
}

/// Splits crossings of segments with these ends.
fn check_split(name: &str, segments: &[[[f64; 2]; 2]]) {
    let points = segments.as_flattened();
    let edges: Vec<[u32; 2]> = (0..segments.len() as u32).map(|i| [2 * i, 2 * i + 1]).collect();
    let found = prove(name, points, &Constraints::new().edges(&edges).split_crossings());
    assert!(found.moved < 1e-13, "{name}: {}", found.moved);
}

#[test]
fn constrainautor() {
    // Issue 4: the Delaunay condition was not restored after each edge.
    let points = [
        [544.0, 480.0],
        [512.0, 192.0],
        [544.0, 160.0],
        [512.0, 384.0],
        [512.0, 224.0],
        [544.0, 320.0],
        [704.0, 128.0],
        [576.0, 352.0],
        [672.0, 352.0],
        [576.0, 128.0],
        [608.0, 384.0],
        [672.0, 96.0],
        [640.0, 96.0],
        [608.0, 160.0],
        [672.0, 160.0],
        [608.0, 288.0],
    ];
    let edges = [[1, 2], [4, 5], [5, 0], [6, 8], [8, 7], [7, 9]];
    prove("4", &points, &Constraints::new().edges(&edges));
    // Issue 15: a loop without an end at an edge that is nearly degenerate.
    let points = [
        [0.0, 0.0],
        [0.05626429153399996, 0.0],
        [0.024093852080076722, 4.80267923973791e-18],
        [0.01379050745122589, 0.1463775332929564],
        [0.05177587092034522, 0.015468457826306506],
        [0.024093852080076705, -5.204170427930421e-18],
    ];
    prove("15", &points, &Constraints::new().edges(&[[0, 5], [5, 2]]));
    // Issue 16: an edge twice, and in both directions.
    prove("16", &points, &Constraints::new().edges(&[[5, 2], [2, 5], [5, 2]]));
    // Issue 2: a grid, and the outline of a polygon with points inside.
    let grid: Vec<[f64; 2]> = (1..9).flat_map(|y| (2..14).map(move |x| [f64::from(x), f64::from(y)])).collect();
    let outline = [0, 11, 95, 84];
    let found = prove("2", &grid, &Constraints::new().ring(&outline).fill(Fill::EvenOdd));
    assert_eq!((found.mesh.constraints.len(), found.inside_triangles().count()), (2 * 11 + 2 * 7, 2 * 11 * 7));
}

#[test]
fn poly2tri() {
    // Issue 49: "collinear not supported".
    check_ring(
        "49",
        &[
            [50.0, 120.5],
            [37.5, 118.70000457763672],
            [25.0, 113.30000305175781],
            [14.050000190734863, 105.1500015258789],
            [6.25, 95.25],
            [1.5500000715255737, 83.5],
            [0.0, 70.0],
            [1.5500000715255737, 56.45000076293945],
            [6.25, 44.70000076293945],
            [14.050000190734863, 34.79999923706055],
            [25.0, 26.649999618530273],
            [37.5, 21.25],
            [50.0, 19.450000762939453],
            [62.5, 21.25],
            [75.0, 26.649999618530273],
            [85.9000015258789, 34.79999923706055],
            [93.75, 44.70000076293945],
            [98.4000015258789, 56.45000076293945],
            [100.0, 70.0],
            [98.4000015258789, 83.5],
            [93.75, 95.25],
            [85.9000015258789, 105.1500015258789],
            [75.0, 113.30000305175781],
            [62.5, 118.70000457763672],
        ],
    );
    // Issue 15: quadrilaterals with edges that are near each other in direction.
    check_ring("15a", &[[-10.0, -10.6426], [-28.3133, -5.98394], [19.8795, 21.6466], [18.4337, -5.02008]]);
    check_ring("15b", &[[-4.61211, -11.3371], [-44.477, -3.90043], [25.2674, 20.9521], [23.8216, -5.71459]]);
    // The fork by jhasse, issue 10: corners that differ in the last bits.
    check_ring(
        "10",
        &[
            [-0.61158088, 0.01042355654119509],
            [-0.61158088, 0.1483950316905975],
            [-0.5788995968987625, 0.22729462858935943],
            [-0.5, 0.2599759116905976],
            [0.5, 0.2599759116905976],
            [0.5788995968987625, 0.22729462858935943],
            [0.61158088, 0.1483950316905975],
            [0.61158088, 0.010423556541195062],
            [0.38841912, 0.01042355654119509],
            [0.38841912, 0.03681415169059751],
            [-0.38841912, 0.03681415169059753],
            [-0.38841912, 0.01042355654119509],
        ],
    );
    // The port to C#, issue 7: a polygon that leads to the same points twice.
    let bridged = [
        [0.0, 0.0],
        [26.1011, 0.0],
        [26.3587, 16.8932],
        [22.9269, 14.909],
        [22.5945, 1.7841],
        [3.3232, 1.7841],
        [3.3232, 15.0749],
        [22.9269, 14.909],
        [26.3587, 16.8932],
        [-0.219999999999999, 17.0728],
    ];
    check_ring("7", &bridged);
}

#[test]
fn spade() {
    // Issue 77: bulk loading lost the order of the vertices.
    let points = [
        [60.0, 20.0],
        [84.0, 20.0],
        [236.0, 20.0],
        [60.0, 36.0],
        [84.0, 36.0],
        [92.0, 28.0],
        [60.0, 44.0],
        [92.0, 44.0],
        [212.0, 44.0],
        [20.0, 60.0],
        [156.0, 68.0],
    ];
    prove("77", &points, &Constraints::new().edges(&[[1, 2], [0, 3]]));
    // Issue 109: a panic where edges overlap and cross in single precision.
    let single = |[a, b]: [[f32; 2]; 2]| [a, b].map(|p| p.map(f64::from));
    check_split(
        "109",
        &[
            single([[17.064112, -17.96008], [16.249594, -17.145563]]),
            single([[-25.290726, -24.435482], [-5.6608872, -24.435482]]),
            single([[17.878626, -18.774595], [15.435078, -16.331045]]),
            single([[16.331045, -21.951208], [-3.29879, -24.435482]]),
        ],
    );
    // Issue 116: edges that are collinear up to rounding.
    check_split(
        "116",
        &[
            [[15.435077667236328, 16.331045150756836], [20.322175979614258, 21.218143463134766]],
            [[18.69314193725586, 19.589109420776367], [19.507659912109375, 20.40362548828125]],
            [[19.507659912109375, 21.218143463134766], [19.507659912109375, 20.40362548828125]],
            [[17.878625869750977, 18.774595260620117], [19.507659912109375, 20.40362548828125]],
        ],
    );
    // Issue 113: a ring whose edges meet at equal points.
    check_split(
        "113",
        &[
            single([[7.9910984, -59.344463], [15.484455, -48.762936]]),
            single([[15.484455, -48.762936], [-11.673287, -28.37192]]),
            single([[-11.673287, -28.37192], [-16.214716, -43.81278]]),
            single([[-16.214716, -43.81278], [-3.657666, -51.41967]]),
            single([[-3.657666, -51.41967], [7.9910984, -59.344463]]),
        ],
    );
}

#[test]
fn cdt() {
    // Issue 62: a boundary that is open says where.
    let points = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [50.0, 50.0], [0.0, 100.0]];
    let open = Constraints::new().boundary(&[[0, 4], [0, 1], [1, 2], [3, 4]]).fill(Fill::EvenOdd);
    assert_eq!(constrained(&points, &open).unwrap_err(), Error::OpenBoundary { point: 2 });
    check_ring("62", &points);
    // Issue 95: the diagonals of a square.
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let found = prove("95", &square, &Constraints::new().edges(&[[0, 2], [1, 3]]).split_crossings());
    assert_eq!((found.added.as_slice(), found.mesh.triangles.len()), (&[[0.5, 0.5]][..], 4));
    // Issue 20: a butterfly.
    let butterfly = Constraints::new().ring(&[0, 1, 3, 2]).fill(Fill::EvenOdd).split_crossings();
    assert_eq!(prove("20", &square, &butterfly).inside_triangles().count(), 2);
    // Issue 134: duplicates.
    let doubled = [square, square].concat();
    prove("134", &doubled, &Constraints::new().ring(&[0, 5, 2, 7]).edges(&[[4, 6], [1, 5]]));
}

#[test]
fn baby_shark() {
    // Issue 18: a panic at edges that meet in a point.
    let points = [
        [-100.0, 0.0],
        [-100.0, 100.0],
        [0.0, 100.0],
        [0.0, 0.0],
        [0.0, -100.0],
        [100.578125, 42.601563],
        [100.0, -100.0],
    ];
    prove("18", &points, &Constraints::new().edges(&[[0, 1], [1, 2], [2, 3], [3, 0], [4, 3], [3, 5], [5, 6], [6, 4]]));
}
