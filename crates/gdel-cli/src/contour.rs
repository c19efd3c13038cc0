//! `gdel contour`: values at the points in, contour lines or isosurfaces out.

use super::{
    derive::{Common, Found, Number, write, write_triangles},
    dimension::{Dimension, Triangulation, in_dimension},
    failure::Failure,
};
use clap::{Args, error::ErrorKind};
use gdel::{
    Contour, Contours, Points,
    internals::geometry::{Euclidean, Geometry},
};
use gdel_io::{CellShape, Column, Grid, SurfaceFormat, Table, files::ResultOutput};
use serde_json::{Value, json};
use std::{io, path::Path};

/// Find contour lines, or isosurfaces in 3D, of values that are given at points.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// The column of the points' file with the values, by its name or its number, counted from 1. The file must be text,
    /// CSV, .ply, .node, .npz or .vtu
    #[arg(long, value_name = "COLUMN")]
    values: String,
    /// The levels
    #[arg(long, value_name = "LEVEL,…", required = true, value_delimiter = ',', value_parser = parse_level)]
    #[arg(allow_negative_numbers = true)]
    levels: Vec<f64>,
    /// Close them along the hull: the boundary of where values are the level or higher
    #[arg(long)]
    closed: bool,
    /// Where to write: the lines as .geojson, with the property `level`; the triangles in 3D as .ply,
    /// .obj, .stl, .glb or .3mf; both as .vtu, with the level of each cell, or as .csv, one row per
    /// corner
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<Format>,
}

#[derive(Debug, Clone, Copy)]
enum Format {
    GeoJson,
    Vtu,
    Csv,
    Surface(SurfaceFormat),
}

fn parse_level(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|level: &f64| level.is_finite()).ok_or_else(|| "a finite number is needed".into())
}

fn parse_output(path: &str) -> Result<ResultOutput<Format>, String> {
    let format_of = |extension: &str| match extension.to_ascii_lowercase().as_str() {
        "geojson" => Some(Format::GeoJson),
        "vtu" => Some(Format::Vtu),
        "csv" => Some(Format::Csv),
        other => SurfaceFormat::from_extension(other).map(Format::Surface),
    };
    let known = ["geojson", "vtu", "csv", "ply", "obj", "stl", "glb", "3mf"];
    ResultOutput::new(Path::new(path), "contours", format_of, &known).map_err(|error| error.to_string())
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let needed = match (arguments.output.format(), arguments.common.dim) {
        (Format::GeoJson, Dimension::Three) => ".geojson has lines: it needs --dim 2",
        (Format::Surface(_), Dimension::Two) => "this format has triangles: it needs --dim 3",
        _ => return in_dimension!(arguments.common.dim, run_in, arguments),
    };
    Err(Failure::Usage(ErrorKind::ArgumentConflict, needed.into()))
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: Geometry<D, N>,
{
    let Arguments { common, values, levels, closed, output } = arguments;
    let input = common.input()?;
    common.check(output, &[input.path()])?;
    let (points, values) = common.read_with_values::<D>(&input, values)?;
    let points = Points::from(&points);
    let (_, all) = common.run::<M, D, N, _>(points, "contour", |mesh| {
        let contours = Contours::new(mesh, points, &values)?;
        let all = levels.iter().map(|&level| if *closed { contours.closed_at(level) } else { contours.at(level) });
        let all: Vec<Contour<D>> = all.collect();
        let facets = if D == 2 { "segments" } else { "triangles" };
        let found = all.iter().map(|contour| contour.facets.len()).sum();
        let numbers = vec![("levels", Number::Count(levels.len())), (facets, Number::Count(found))];
        Ok(Found { result: all, numbers })
    })?;
    if let Format::GeoJson = output.format() {
        let collection = geojson(levels, &all);
        return write(output, |to| serde_json::to_writer(to, &collection).map_err(io::Error::from));
    }
    let All { vertices, facets, levels } = joined(levels, &all);
    match output.format() {
        Format::Surface(format) => write_triangles(output, format, Points::F64(&vertices), &facets, "isosurface"),
        Format::Vtu => {
            let shape = if D == 2 { CellShape::Line } else { CellShape::Triangle };
            let mut grid = Grid::new(Points::F64(&vertices), shape);
            facets.iter().for_each(|facet| grid.push(*facet));
            grid.values = Table::default().with("level", Column::Numbers(levels));
            write(output, |to| grid.write_vtu(to))
        }
        _ => {
            let corners: Vec<[f64; D]> = facets.as_flattened().iter().map(|&v| vertices[v as usize]).collect();
            let numbers = (0..facets.len() as i64).flat_map(|facet| [facet; D]).collect();
            let table = Table::default()
                .with("level", Column::Numbers(levels.iter().flat_map(|&level| [level; D]).collect()))
                .with(if D == 2 { "segment" } else { "triangle" }, Column::Indices(numbers))
                .with_points("", &corners);
            write(output, |to| table.write_csv(to))
        }
    }
}

/// The contours of all levels together.
struct All<const D: usize> {
    vertices: Vec<[f64; D]>,
    facets: Vec<[u32; D]>,
    /// The level of each facet.
    levels: Vec<f64>,
}

fn joined<const D: usize>(levels: &[f64], contours: &[Contour<D>]) -> All<D> {
    let mut all = All { vertices: Vec::new(), facets: Vec::new(), levels: Vec::new() };
    for (&level, contour) in levels.iter().zip(contours) {
        let first = all.vertices.len() as u32;
        all.facets.extend(contour.facets.iter().map(|facet| facet.map(|v| first + v)));
        all.levels.resize(all.facets.len(), level);
        all.vertices.extend(&contour.vertices);
    }
    all
}

/// Returns the lines of each level as a feature.
fn geojson<const D: usize>(levels: &[f64], contours: &[Contour<D>]) -> Value {
    let feature = |(&level, contour): (&f64, &Contour<D>)| {
        let lines = contour.lines();
        let line =
            |line: u32| lines.of(line).iter().map(|&v| contour.vertices[v as usize].to_vec()).collect::<Vec<_>>();
        let coordinates: Vec<_> = (0..lines.len() as u32).map(line).collect();
        let geometry = json!({ "type": "MultiLineString", "coordinates": coordinates });
        json!({ "type": "Feature", "properties": { "level": level }, "geometry": geometry })
    };
    let features: Vec<Value> = levels.iter().zip(contours).map(feature).collect();
    // The mark by which the program knows its own files.
    json!({ "type": "FeatureCollection", "generator": "Generated by gdel", "features": features })
}
