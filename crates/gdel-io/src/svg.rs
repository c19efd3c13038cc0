//! SVG: the outlines of paths and basic shapes.
//!
//! `quick-xml` reads the XML, `svgtypes` what attributes say, and `kurbo` flattens curves. `usvg` would also find styles
//! and what `use` refers to, but has single precision.

use crate::{
    FormatError,
    shapes::Shapes,
    text::{line_at, without_mark},
};
use gdel::Fill;
use kurbo::{Affine, PathEl, Point};
use quick_xml::{
    Reader, XmlVersion,
    events::{BytesStart, Event},
};
use std::{collections::BTreeMap, str::FromStr};
use svgtypes::{Length, LengthUnit, PointsParser, SimplePathSegment, SimplifyingPathParser, Transform};

/// Curves become lines that are nearer to them than this share of the larger side of the drawing.
const TOLERANCE: f64 = 1.0 / 5000.0;

/// Points on curves that are nearer to the end than this share of the tolerance are left out.
const BESIDE: f64 = 1.0 / 1024.0;

/// Elements whose content is not drawn where it is.
const HIDDEN: [&str; 6] = ["defs", "symbol", "clipPath", "mask", "pattern", "marker"];
/// Elements that are drawn, but have no outlines here.
const LEFT_OUT: [&str; 4] = ["use", "text", "image", "foreignObject"];

/// Reads closed outlines as rings, and open ones as lines. The *y* axis points up in what is returned.
pub(super) fn read(bytes: &[u8]) -> Result<Shapes, FormatError> {
    let bytes = without_mark(bytes);
    let mut drawing = Drawing::default();
    let mut reader = Reader::from_reader(bytes);
    let mut is_svg = false;
    loop {
        let start = reader.buffer_position() as usize;
        let within = |what: String| FormatError::line(line_at(bytes, start), what);
        let event = reader.read_event().map_err(|error| within(error.to_string()))?;
        match event {
            Event::Start(element) => {
                is_svg |= element.local_name().as_ref() == "svg";
                drawing.open(&element).map_err(within)?;
            }
            Event::Empty(element) => {
                is_svg |= element.local_name().as_ref() == "svg";
                drawing.open(&element).map_err(within)?;
                drawing.close();
            }
            Event::End(_) => drawing.close(),
            Event::Eof if !is_svg => return Err(FormatError::line(1, "this is not an SVG file")),
            Event::Eof => return drawing.shapes().map_err(|what| FormatError::line(1, what)),
            _ => {}
        }
    }
}

/// The outlines so far, and the elements that are open.
#[derive(Default)]
struct Drawing {
    outlines: Vec<PathEl>,
    /// The transform within each element that is open; `None` if its content is not drawn.
    open: Vec<Option<Affine>>,
    left_out: BTreeMap<String, usize>,
}

impl Drawing {
    fn open(&mut self, element: &BytesStart<'_>) -> Result<(), String> {
        let around = self.open.last().copied().unwrap_or(Some(Affine::IDENTITY));
        let name = element.local_name();
        let name = name.as_ref();
        let Some(around) = around.filter(|_| !HIDDEN.contains(&name)) else {
            self.open.push(None);
            return Ok(());
        };
        let attributes = attributes(element)?;
        let get = |name: &str| attributes.get(name).map(String::as_str);
        let is_nested = name == "svg" && !self.open.is_empty();
        let is_left_out = is_nested || LEFT_OUT.contains(&name);
        let style: String = get("style").unwrap_or_default().split_whitespace().collect();
        if get("display") == Some("none") || style.contains("display:none") || is_left_out {
            if is_left_out {
                *self.left_out.entry(name.to_owned()).or_default() += 1;
            }
            self.open.push(None);
            return Ok(());
        }
        let transform = match get("transform") {
            Some(text) => {
                let t = Transform::from_str(text).map_err(|error| format!("transform: {error}"))?;
                around * Affine::new([t.a, t.b, t.c, t.d, t.e, t.f])
            }
            None => around,
        };
        self.open.push(Some(transform));
        let data = match name {
            "path" => get("d").unwrap_or_default().to_owned(),
            "polygon" => format!("{}Z", lines(get("points"))),
            "polyline" => lines(get("points")),
            _ => basic_shape(name, |name| length(name, get(name)))?.unwrap_or_default(),
        };
        let begin = self.outlines.len();
        for segment in SimplifyingPathParser::from(data.as_str()) {
            let element = match segment.map_err(|error| format!("path data: {error}"))? {
                SimplePathSegment::MoveTo { x, y } => PathEl::MoveTo(Point { x, y }),
                SimplePathSegment::LineTo { x, y } => PathEl::LineTo(Point { x, y }),
                SimplePathSegment::Quadratic { x1, y1, x, y } => PathEl::QuadTo(Point { x: x1, y: y1 }, Point { x, y }),
                SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => {
                    PathEl::CurveTo(Point { x: x1, y: y1 }, Point { x: x2, y: y2 }, Point { x, y })
                }
                SimplePathSegment::ClosePath => PathEl::ClosePath,
            };
            self.outlines.push(transform * element);
        }
        if points_of(&self.outlines[begin..]).any(|p| !p.is_finite()) {
            return Err("a coordinate is not finite".into());
        }
        Ok(())
    }

    fn close(&mut self) {
        self.open.pop();
    }

    /// Flattens the curves.
    fn shapes(self) -> Result<Shapes, String> {
        let mut shapes = Shapes { fill: Fill::NonZero, ..Shapes::default() };
        shapes.left_out = self.left_out.iter().map(|(name, count)| format!("{count} {name}")).collect();
        let mut path = Vec::new();
        let finish = |path: &mut Vec<[f64; 2]>, is_closed: bool, shapes: &mut Shapes| {
            let is_closed = is_closed || path.len() > 3 && path.first() == path.last();
            if is_closed && path.len() > 1 {
                shapes.add_ring(path);
            } else if path.len() > 1 {
                shapes.add_line(path);
            }
            path.clear();
        };
        // Not −0.
        let up = |p: Point| [p.x, 0.0 - p.y];
        let tolerance = self.tolerance()?;
        let mut last = None;
        for element in &self.outlines {
            match element {
                PathEl::MoveTo(p) => {
                    finish(&mut path, false, &mut shapes);
                    path.push(up(*p));
                }
                PathEl::LineTo(p) => path.push(up(*p)),
                PathEl::ClosePath => finish(&mut path, true, &mut shapes),
                PathEl::QuadTo(..) | PathEl::CurveTo(..) => {
                    let start = last.unwrap_or_default();
                    flatten(start, *element, tolerance, |p| path.push(up(p)));
                }
            }
            last = element.end_point();
        }
        finish(&mut path, false, &mut shapes);
        if shapes.rings.is_empty() {
            shapes.fill = Fill::All;
        }
        Ok(shapes)
    }

    /// Returns how far lines may be from curves, in a drawing whose size can be squared.
    fn tolerance(&self) -> Result<f64, String> {
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for p in points_of(&self.outlines) {
            for (axis, x) in [p.x, p.y].into_iter().enumerate() {
                (low[axis], high[axis]) = (low[axis].min(x), high[axis].max(x));
            }
        }
        let side = (high[0] - low[0]).max(high[1] - low[1]);
        let has_curves = self.outlines.iter().any(|e| matches!(e, PathEl::QuadTo(..) | PathEl::CurveTo(..)));
        match side {
            _ if !has_curves => Ok(1.0),
            0.0 => Ok(1.0),
            1e-50..=1e50 => Ok(TOLERANCE * side),
            _ => Err(format!("curves in a drawing of size {side:e} cannot be flattened")),
        }
    }
}

/// Calls `line_to` with the ends of lines that are at most `tolerance` away from a curve.
///
/// Rounding has kurbo put a point beside the end of some curves, which would be the corner of a needle. So points that
/// are much nearer to the end than the tolerance are left out, and kurbo gets what is left of the tolerance.
fn flatten(start: Point, curve: PathEl, tolerance: f64, mut line_to: impl FnMut(Point)) {
    let beside = BESIDE * tolerance;
    let end = curve.end_point().unwrap_or(start);
    kurbo::flatten([PathEl::MoveTo(start), curve], tolerance - beside, |element| {
        if let PathEl::LineTo(p) = element
            && (p == end || p.distance(end) > beside)
        {
            line_to(p);
        }
    });
}

/// Returns the points of a path, those that control curves as well.
fn points_of(path: &[PathEl]) -> impl Iterator<Item = Point> + '_ {
    path.iter().flat_map(|&element| {
        let points = match element {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => [Some(p), None, None],
            PathEl::QuadTo(p, q) => [Some(p), Some(q), None],
            PathEl::CurveTo(p, q, r) => [Some(p), Some(q), Some(r)],
            PathEl::ClosePath => [None; 3],
        };
        points.into_iter().flatten()
    })
}

fn attributes(element: &BytesStart<'_>) -> Result<BTreeMap<String, String>, String> {
    let text = |attribute: Result<quick_xml::events::attributes::Attribute<'_>, _>| {
        let attribute = attribute.map_err(|error: quick_xml::events::attributes::AttrError| error.to_string())?;
        let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|error| error.to_string())?;
        Ok((attribute.key.as_ref().to_owned(), value.into_owned()))
    };
    element.attributes().map(text).collect()
}

/// Returns the path data of the points of a polyline.
fn lines(points: Option<&str>) -> String {
    let points = PointsParser::from(points.unwrap_or_default());
    let line = |(i, (x, y)): (usize, (f64, f64))| format!("{}{x} {y}", if i == 0 { 'M' } else { 'L' });
    points.enumerate().map(line).collect()
}

/// Returns the path data of a shape, or none for other elements and shapes that are not drawn.
fn basic_shape(name: &str, length: impl Fn(&str) -> Result<Option<f64>, String>) -> Result<Option<String>, String> {
    let or_0 = |name: &str| Ok::<_, String>(length(name)?.unwrap_or(0.0));
    Ok(match name {
        "line" => Some(format!("M{} {}L{} {}", or_0("x1")?, or_0("y1")?, or_0("x2")?, or_0("y2")?)),
        "circle" | "ellipse" => {
            let radii = if name == "circle" { ["r", "r"] } else { ["rx", "ry"] };
            let (rx, ry) = (or_0(radii[0])?, or_0(radii[1])?);
            let (left, right, y) = (or_0("cx")? - rx, or_0("cx")? + rx, or_0("cy")?);
            let arcs = || format!("M{left} {y}A{rx} {ry} 0 1 1 {right} {y}A{rx} {ry} 0 1 1 {left} {y}Z");
            (rx > 0.0 && ry > 0.0).then(arcs)
        }
        "rect" => {
            let (x, y, width, height) = (or_0("x")?, or_0("y")?, or_0("width")?, or_0("height")?);
            let (rx, ry) = (length("rx")?, length("ry")?);
            let rx_or_ry = rx.or(ry).unwrap_or(0.0).min(width / 2.0);
            let ry_or_rx = ry.or(rx).unwrap_or(0.0).min(height / 2.0);
            let (right, bottom) = (x + width, y + height);
            if !(width > 0.0 && height > 0.0) {
                None
            } else if rx_or_ry > 0.0 && ry_or_rx > 0.0 {
                let (rx, ry) = (rx_or_ry, ry_or_rx);
                let corner = |x: f64, y: f64| format!("A{rx} {ry} 0 0 1 {x} {y}");
                Some(format!(
                    "M{} {y}H{}{}V{}{}H{}{}V{}{}Z",
                    x + rx,
                    right - rx,
                    corner(right, y + ry),
                    bottom - ry,
                    corner(right - rx, bottom),
                    x + rx,
                    corner(x, bottom - ry),
                    y + ry,
                    corner(x + rx, y),
                ))
            } else {
                Some(format!("M{x} {y}H{right}V{bottom}H{x}Z"))
            }
        }
        _ => None,
    })
}

/// Parses a length, in pixels.
fn length(name: &str, value: Option<&str>) -> Result<Option<f64>, String> {
    let Some(text) = value.filter(|&text| text != "auto") else { return Ok(None) };
    let length = Length::from_str(text).map_err(|error| format!("{name}: {error}"))?;
    let unit = match length.unit {
        LengthUnit::None | LengthUnit::Px => 1.0,
        LengthUnit::In => 96.0,
        LengthUnit::Cm => 96.0 / 2.54,
        LengthUnit::Mm => 96.0 / 25.4,
        LengthUnit::Pt => 96.0 / 72.0,
        LengthUnit::Pc => 16.0,
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => {
            return Err(format!("{name}: the length {text} depends on what is around it"));
        }
    };
    Ok(Some(length.number * unit))
}
