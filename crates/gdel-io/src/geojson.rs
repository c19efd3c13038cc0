//! GeoJSON (RFC 7946): the shapes of all features.

use crate::{FormatError, shapes::Shapes, text::without_mark};
use ::geojson::{GeoJson, GeometryValue};
use gdel::Fill;

/// Reads polygons as rings, lines as edges, and points.
pub(super) fn read(bytes: &[u8]) -> Result<Shapes, FormatError> {
    let wrong = |error: serde_json::Error| {
        let (text, at) = (error.to_string(), format!(" at line {} column {}", error.line(), error.column()));
        FormatError::line(error.line().max(1), text.strip_suffix(&at).unwrap_or(&text))
    };
    let content = GeoJson::from_reader(without_mark(bytes)).map_err(wrong)?;
    // Neighbours share a border, which then bounds nothing.
    let mut shapes = Shapes { fill: Fill::EvenOdd, ..Shapes::default() };
    let geometries: Vec<_> = match content {
        GeoJson::Geometry(geometry) => vec![geometry],
        GeoJson::Feature(feature) => feature.geometry.into_iter().collect(),
        GeoJson::FeatureCollection(all) => all.features.into_iter().filter_map(|feature| feature.geometry).collect(),
    };
    geometries.iter().try_for_each(|geometry| add(&geometry.value, &mut shapes))?;
    if shapes.rings.is_empty() {
        shapes.fill = Fill::All;
    }
    if shapes.heights.iter().all(Option::is_none) {
        shapes.heights.clear();
    }
    Ok(shapes)
}

fn add(geometry: &GeometryValue, shapes: &mut Shapes) -> Result<(), FormatError> {
    match geometry {
        GeometryValue::Point { coordinates } => add_points(std::slice::from_ref(coordinates), shapes),
        GeometryValue::MultiPoint { coordinates } => add_points(coordinates, shapes),
        GeometryValue::LineString { coordinates } => add_line(coordinates, shapes),
        GeometryValue::MultiLineString { coordinates } => {
            coordinates.iter().try_for_each(|line| add_line(line, shapes))
        }
        GeometryValue::Polygon { coordinates } => add_polygon(coordinates, shapes),
        GeometryValue::MultiPolygon { coordinates } => {
            coordinates.iter().try_for_each(|polygon| add_polygon(polygon, shapes))
        }
        GeometryValue::GeometryCollection { geometries } => {
            geometries.iter().try_for_each(|geometry| add(&geometry.value, shapes))
        }
    }
}

fn add_points(positions: &[::geojson::Position], shapes: &mut Shapes) -> Result<(), FormatError> {
    add_with_heights(positions, shapes, |shapes, points| shapes.points.extend(points))
}

fn add_line(positions: &[::geojson::Position], shapes: &mut Shapes) -> Result<(), FormatError> {
    add_with_heights(positions, shapes, Shapes::add_line)
}

fn add_polygon(rings: &[Vec<::geojson::Position>], shapes: &mut Shapes) -> Result<(), FormatError> {
    rings.iter().try_for_each(|ring| add_with_heights(ring, shapes, Shapes::add_ring))
}

/// Adds positions, or all but the last one of a ring, and their heights.
fn add_with_heights(
    positions: &[::geojson::Position],
    shapes: &mut Shapes,
    add: impl Fn(&mut Shapes, &[[f64; 2]]),
) -> Result<(), FormatError> {
    let points = points(positions, shapes)?;
    let first = shapes.points.len();
    add(shapes, &points);
    let added = &positions[..shapes.points.len() - first];
    shapes.heights.extend(added.iter().map(|position| position.as_slice().get(2).copied()));
    Ok(())
}

/// Returns positions without what follows *x* and *y*.
fn points(positions: &[::geojson::Position], shapes: &mut Shapes) -> Result<Vec<[f64; 2]>, FormatError> {
    let first = shapes.points.len();
    let point = |(i, position): (usize, &::geojson::Position)| match *position.as_slice() {
        [x, y, ref rest @ ..] => {
            shapes.dropped_z |= !rest.is_empty();
            Ok([x, y])
        }
        _ => Err(FormatError::point(first + i, "a position must have two numbers or more")),
    };
    positions.iter().enumerate().map(point).collect()
}
