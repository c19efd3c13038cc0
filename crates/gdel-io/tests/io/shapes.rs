//! Drawings and maps: GeoJSON, SVG and `.poly`.

use crate::samples;
use gdel::{Constrained2, Fill, MeshView2, Triangulator, verify2d};
use gdel_io::{ShapeFormat, Shapes, files::read_shapes};
use std::fs;

fn read(format: ShapeFormat, text: &str) -> Shapes {
    format.read(text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn error(format: ShapeFormat, text: &str) -> String {
    format.read(text.as_bytes()).expect_err(text).to_string()
}

/// Triangulates shapes, proves the mesh, and returns it with the area inside.
fn mesh(shapes: &Shapes) -> (Constrained2, f64) {
    let found = Triangulator::new().constrained2d(&shapes.points, &shapes.constraints()).unwrap();
    let mut view = MeshView2::from(&found.mesh);
    view.segments = Some(&found.segments);
    assert!(verify2d(&shapes.points, view).unwrap().passed());
    let doubled = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| shapes.points[v as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let area = found.inside_triangles().map(doubled).sum::<f64>() / 2.0;
    (found, area)
}

#[test]
fn geojson_of_all_kinds() {
    let shapes = read(ShapeFormat::GeoJson, samples::GEOJSON);
    // Closed rings and lines do not repeat their first points.
    assert_eq!(shapes.points.len(), 4 + 3 + 1 + 2 + 3 + 2 + 3);
    assert_eq!(shapes.rings, [vec![0, 1, 2, 3], vec![4, 5, 6], vec![15, 16, 17]].map(|ring| ring.to_vec()));
    assert_eq!(shapes.edges, [[10, 11], [11, 12], [12, 10], [13, 14]]);
    assert_eq!(shapes.points[7..10], [[1.0, 1.0], [0.5, 2.0], [1e-3, -250.0]]);
    assert!(shapes.dropped_z && shapes.fill == Fill::EvenOdd && shapes.left_out.is_empty());
    let heights = (0..).zip(&shapes.heights).filter_map(|(i, height)| Some((i, (*height)?)));
    assert_eq!(heights.collect::<Vec<(usize, f64)>>(), [0, 1, 2, 3].map(|i| (i, 5.0)));
    assert_eq!(shapes.heights.len(), shapes.points.len());
    assert_eq!(mesh(&shapes).1, 81.0 - 4.5 + 0.5);
}

#[test]
fn geojson_that_is_a_geometry_a_feature_or_nothing() {
    let geometry = r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[0,1],[0,0]]]}"#;
    let feature = format!(r#"{{"type":"Feature","geometry":{geometry},"properties":{{}}}}"#);
    assert_eq!(read(ShapeFormat::GeoJson, geometry), read(ShapeFormat::GeoJson, &format!("\u{feff}{feature}")));
    for nothing in [
        r#"{"type":"FeatureCollection","features":[]}"#,
        r#"{"type":"Feature","geometry":null,"properties":null}"#,
        r#"{"type":"GeometryCollection","geometries":[]}"#,
        r#"{"type":"MultiPolygon","coordinates":[]}"#,
    ] {
        assert_eq!(read(ShapeFormat::GeoJson, nothing), Shapes::default(), "{nothing}");
    }
    // A ring without an inside is one edge, twice.
    let flat = r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[0,0]],[[5,5]],[]]}"#;
    let (found, area) = mesh(&read(ShapeFormat::GeoJson, flat));
    assert_eq!((found.mesh.constraints.as_slice(), found.zero_length, area), (&[[0, 1]][..], 1, 0.0));
}

#[test]
fn holes_that_touch_and_neighbours_with_a_common_border() {
    let lake = r#"{"type":"MultiPolygon","coordinates":[
        [[[0,0],[10,0],[10,8],[0,8],[0,0]], [[2,2],[2,6],[5,4],[2,2]], [[5,4],[8,6],[8,2],[5,4]]],
        [[[10,0],[14,0],[14,8],[10,8],[10,0]]]]}"#;
    let shapes = read(ShapeFormat::GeoJson, lake);
    let (found, area) = mesh(&shapes);
    assert_eq!(area, 80.0 - 6.0 - 6.0 + 32.0);
    assert_eq!(found.mesh.duplicate_of.iter().filter(|&&of| of != gdel::NONE).count(), 3);
    // The border is an edge, with the inside on both of its sides.
    assert!(found.mesh.is_constrained([1, 2]));
}

#[test]
fn bad_geojson_says_where() {
    let error = |text: &str| error(ShapeFormat::GeoJson, text);
    assert!(error("").starts_with("line 1: EOF"), "{}", error(""));
    assert!(error("{\n\"type\": \"Topology\"}").starts_with("line 2: unknown variant `Topology`"));
    assert!(error("{\"type\": \"Point\"}").contains("line 1: "));
    for (position, what) in [
        ("1", "line 1: Encountered geometry type: `LineString` with unexpected coordinates dimensions: 0"),
        ("[1]", "point 0: a position must have two numbers or more"),
        ("[1, 2], [1e999, 0]", "line 3: number out of range"),
        ("[null, 1]", "line 3: invalid type: null, expected a coordinate element (number or array)"),
    ] {
        assert_eq!(error(&format!("{{\"type\":\"LineString\",\n\"coordinates\":[\n{position}\n]}}")), what);
    }
}

#[test]
fn svg_of_all_shapes() {
    let shapes = read(ShapeFormat::Svg, samples::SVG);
    assert_eq!(shapes.left_out, ["2 text", "1 use"]);
    assert_eq!((shapes.fill, shapes.rings.len()), (Fill::NonZero, 2 + 1 + 1 + 2 + 1));
    let corners =
        |ring: usize| -> Vec<[f64; 2]> { shapes.rings[ring].iter().map(|&v| shapes.points[v as usize]).collect() };
    // y points up, and transforms are exact where they can be.
    assert_eq!(corners(0), [[0.0, 0.0], [9.0, 0.0], [9.0, -9.0], [0.0, -9.0]]);
    assert_eq!(corners(2), [[12.0, -22.0], [16.0, -22.0], [16.0, -28.0], [12.0, -28.0]]);
    assert_eq!(corners(6), [[1.0, -30.0], [2.0, -30.0], [2.0, -31.0]]);
    let line = shapes.edges[0].map(|v| shapes.points[v as usize]);
    assert_eq!(line, [[10.0, -20.0], [12.0, -22.0]]);
    let size = 40.0;
    for [x, y] in corners(4) {
        let radius = (x - 20.0).hypot(y + 20.0);
        assert!((radius - 3.0).abs() < size / 5000.0, "{radius}");
    }
    assert!(corners(4).len() > 16);
    let (_, area) = mesh(&shapes);
    let rounded = 48.0 - (4.0 - std::f64::consts::PI) * 4.0;
    let ellipse = 2.0 * 96.0 / 25.4;
    let all = 81.0 - 4.5 + 24.0 + rounded + (9.0 + ellipse) * std::f64::consts::PI + 0.5;
    assert!((area - all).abs() < 0.5, "{area} {all}");
}

#[test]
fn svg_outlines_that_overlap_become_one() {
    let shapes = read(
        ShapeFormat::Svg,
        "<svg><rect width='2' height='2'/><rect x='2' width='2' height='2'/><path d='M0 0H4V2H0Z'/></svg>",
    );
    assert_eq!(mesh(&shapes).1, 8.0);
    // Open lines bound nothing; an outline of two points does neither.
    let open = read(ShapeFormat::Svg, "<svg><path d='M0 0L1 0L1 1M5 5H6Z M7 7'/></svg>");
    assert_eq!((open.edges.len(), open.rings.len(), mesh(&open).1), (2, 1, 0.0));
}

/// Rounding had some curves end in two points, one unit in the last place apart.
#[test]
fn curves_of_svg_have_no_point_beside_their_end() {
    let letter = "<svg><path d='M90 0H71V9C63 1 54-2 44-2C18-2 2 18 2 46C2 74 18 94 44 94C54 94 63 90 71 82V92
        C71 108 60 116 44 116C32 116 24 112 19 104L4 114C12 126 26 132 45 132C73 132 90 116 90 90Z
        M71 46C71 64 62 77 46 77C30 77 21 64 21 46C21 28 30 15 46 15C62 15 71 28 71 46Z
        M0 0Q5 9 10 0T20 0'/></svg>";
    let shapes = read(ShapeFormat::Svg, letter);
    let lengths = shapes.rings.iter().flat_map(|ring| {
        let points: Vec<_> = ring.iter().map(|&v| shapes.points[v as usize]).collect();
        (0..points.len()).map(move |i| {
            let [p, q] = [points[i], points[(i + 1) % points.len()]];
            (p[0] - q[0]).hypot(p[1] - q[1])
        })
    });
    let shortest = lengths.fold(f64::INFINITY, f64::min);
    assert!(shortest > 0.5, "{shortest}");
    for end in [[44.0, 2.0], [21.0, -46.0], [10.0, 0.0], [20.0, 0.0]] {
        assert!(shapes.points.contains(&end), "{end:?}");
    }
    mesh(&shapes);
}

#[test]
fn bad_svg_says_where() {
    let error = |text: &str| error(ShapeFormat::Svg, text);
    assert_eq!(error("<html/>"), "line 1: this is not an SVG file");
    assert!(error("<svg>\n<path d='M0 0L1'/>\n</svg>").starts_with("line 2: path data: "));
    assert!(error("<svg>\n\n<g transform='turn(1)'/>\n</svg>").starts_with("line 3: transform: "));
    assert!(error("<svg>\n<rect width='50%' height='1'/></svg>").starts_with("line 2: width: the length 50% depends"));
    assert!(error("<svg>\n<g>\n</svg>").starts_with("line 3: "), "{}", error("<svg>\n<g>\n</svg>"));
    assert!(
        error("<svg>\n<path transform='scale(1e300)' d='M0 0L1e300 0'/></svg>").starts_with("line 2: a coordinate")
    );
    assert!(error("<svg><path d='M0 0Q1e200 0 0 1'/></svg>").contains("cannot be flattened"));
}

#[test]
fn poly_files_of_triangle() {
    let shapes = read(ShapeFormat::Poly, samples::POLY);
    assert_eq!((shapes.points.len(), shapes.edges.len()), (8, 8));
    assert_eq!((shapes.edges[3], shapes.holes.as_slice(), shapes.fill), ([3, 0], &[[4.5, 4.5]][..], Fill::Enclosed));
    assert_eq!(shapes.left_out, ["1 regional attributes"]);
    assert_eq!(mesh(&shapes).1, 72.0);
    // Counted from 0, without the section of regions; concave corners are no inside.
    let text = "4 2 0 0\n0 0 0\n1 4 0\n2 1 1\n3 0 4\n4 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n0\n";
    let shapes = read(ShapeFormat::Poly, text);
    assert_eq!((shapes.edges.as_slice(), mesh(&shapes).1), (&[[0, 1], [1, 2], [2, 3], [3, 0]][..], 4.0));
}

#[test]
fn points_of_poly_files_in_node_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.poly");
    fs::write(&path, "0 2 0 0\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n").unwrap();
    let message = |path| read_shapes(path, ShapeFormat::Poly).unwrap_err().to_string();
    assert!(message(&path).contains("a.node: cannot be read"), "{}", message(&path));
    fs::write(folder.path().join("a.node"), "3 2 0 0\n1 0 0\n2 1 0\n3 0\n").unwrap();
    assert!(message(&path).contains("a.node: line 4: "), "{}", message(&path));
    fs::write(folder.path().join("a.node"), "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n").unwrap();
    let shapes = read_shapes(&path, ShapeFormat::Poly).unwrap();
    assert_eq!((shapes.edges.as_slice(), mesh(&shapes).1), (&[[0, 1], [1, 2], [2, 0]][..], 0.5));
}

#[test]
fn bad_poly_files_say_where() {
    let error = |text: &str| error(ShapeFormat::Poly, text);
    assert_eq!(error(""), "line 1: the number of points is missing after this line");
    assert_eq!(error("0 2 0 0\n0\n0\n"), "line 1: the points are not in this file");
    assert_eq!(error("2 2 0 0\n1 0 0\n"), "line 2: 2 points are promised, 1 are there");
    assert_eq!(error("2 2 0 0\n1 0 0\n3 1 1\n"), "line 3: row 1 is numbered 3");
    let points = "2 2 0 0\n1 0 0\n2 1 1\n";
    assert_eq!(error(points), "line 3: the number of segments is missing after this line");
    assert_eq!(error(&format!("{points}1 0\n1 0 1\n0\n")), "line 5: there is no point 0");
    assert_eq!(error(&format!("{points}1 0\n1 1 2.5\n0\n")), "line 5: there is no point 2.5");
    assert_eq!(error(&format!("{points}1 0\n1 1\n0\n")), "line 5: a number is missing");
    assert_eq!(error(&format!("{points}-1 0\n0\n")), "line 4: -1 is not a number of segments");
    assert_eq!(error(&format!("{points}0\n0\n0\n7\n")), "line 7: there is more after the last section");
}
