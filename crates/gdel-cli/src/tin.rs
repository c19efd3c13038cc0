//! `gdel tin`: terrain of few triangles from a scan.

use super::{
    constrain::{FillRule, read_breaklines},
    derive::{Number, Runs, SolidFormat, as_map, numbers, parse_solid, write_cells, write_triangles},
    dimension::{format_parser, read},
    failure::Failure,
    progress::Progress,
    report::print,
};
use clap::{ArgGroup, Args, error::ErrorKind};
use gdel::{
    Constraints, Error, Fill, Interpolation, Interpolator, Locator, NONE, Outside, Points, Tin, TinOptions,
    Triangulator,
};
use gdel_io::{
    CellShape, PointBuf, PointFormat, ShapeFormat, Shapes,
    files::{Input, ResultOutput},
};
use serde::Serialize;
use std::{
    fmt, io,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// Make terrain of a scan: triangles between few of its points that are near to all of them, above or below.
///
/// The surface begins with the corners of the convex hull, as seen from above, and the ends of breaklines. Then the point
/// that is farthest from it becomes a vertex, until the error is as small as asked for. Of points with the same x and y,
/// the lowest counts, or the end of a breakline.
#[derive(Args)]
#[command(group = ArgGroup::new("aim").required(true).multiple(true))]
pub(super) struct Arguments {
    /// The scan, in any format that `triangulate` reads, or `-` for standard input, with `--format`; z is up
    points: PathBuf,
    /// How far points may be above or below the surface, in the unit of their heights
    #[arg(long, value_name = "ERROR", group = "aim")]
    max_error: Option<f64>,
    /// The largest number of vertices. Corners of the hull and ends of breaklines always are some
    #[arg(long, value_name = "N", group = "aim")]
    max_points: Option<usize>,
    /// Lines that become edges of the triangles: .geojson or .json, .svg, or .poly of the program Triangle. A third number
    /// of GeoJSON's positions is the height there; where there is none, it is that of the surface through all points of
    /// the scan, and beside them that of the nearest one
    #[arg(long, value_name = "FILE")]
    breaklines: Option<PathBuf>,
    /// Keep what is inside the breaklines: `evenodd` and `nonzero` take their polygons as boundaries, outer ones and those of
    /// holes, and `enclosed` all lines. Points outside do not count
    #[arg(long, value_enum, default_value_t = FillRule::All, requires = "breaklines")]
    fill: FillRule,
    /// Put a vertex where breaklines cross, at the mean of their heights, instead of an error
    #[arg(long, requires = "breaklines")]
    split: bool,
    /// The format of the scan, whatever the extension of its file
    #[arg(long, value_parser = format_parser())]
    format: Option<PointFormat>,
    /// Replace the output even if it is not marked as an earlier output of gdel
    #[arg(short, long)]
    force: bool,
    /// How many threads are used [default: all]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    #[command(flatten)]
    runs: Runs,
    /// Where to write the triangles: .stl, .ply, .obj, .glb, .3mf or .vtu
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<SolidFormat>,
}

fn parse_output(path: &str) -> Result<ResultOutput<SolidFormat>, String> {
    parse_solid(path, "terrain")
}

/// The report of a run: as JSON by `serde`, for people by `Display`.
#[derive(Serialize)]
struct Report {
    #[serde(flatten, serialize_with = "as_map")]
    numbers: Vec<(&'static str, Number)>,
    /// Without reading and writing files.
    seconds: f64,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        numbers(f, &self.numbers)?;
        write!(f, "{:<16}{:.3}", "seconds", self.seconds)
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { points, breaklines, output, .. } = arguments;
    let input = Input::new(points, arguments.format)?;
    let inputs = [Some(input.path()), breaklines.as_deref()];
    output.check(&inputs.into_iter().flatten().collect::<Vec<&Path>>(), arguments.force)?;
    let shapes = breaklines.as_deref().map(|path| read_breaklines(path, format_of(path)?)).transpose()?;
    let cloud = {
        let _progress = Progress::new("reading");
        read::<3>(&input)?
    };
    let scan = Points::from(&cloud);
    let failure = |source| Failure::Points { path: points.clone(), source };
    scan.validate().map_err(failure)?;
    let triangulator = match arguments.threads {
        Some(threads) => Triangulator::new().threads(threads),
        None => Triangulator::new(),
    };
    let Terrain { points, constraints, interpolated } =
        terrain(scan, shapes.unwrap_or_default(), arguments, &triangulator).map_err(failure)?;
    let mut options = TinOptions::default();
    options.max_error = arguments.max_error.unwrap_or(0.0);
    options.max_points = arguments.max_points;
    let all = Points::F64(&points);
    let tin = arguments.runs.repeated(|| {
        let progress = Progress::new("terrain");
        let start = Instant::now();
        let tin = triangulator.tin(all, &constraints, &options).map_err(failure)?;
        let time = start.elapsed();
        drop(progress);
        let is_read = report(arguments, scan.len(), &constraints, interpolated, &tin, time)?;
        Ok((tin, is_read))
    })?;
    let (vertices, triangles) = used(&tin);
    // Vertices of the scan have its precision: some formats are smaller for single precision.
    let vertices = match scan {
        Points::F32(_) if points.len() == scan.len() => {
            PointBuf::F32(vertices.iter().map(|p| p.map(|x| x as f32)).collect())
        }
        _ => PointBuf::F64(vertices),
    };
    let vertices = Points::from(&vertices);
    match output.format() {
        SolidFormat::Vtu => write_cells(output, vertices, CellShape::Triangle, &triangles),
        SolidFormat::Surface(format) => write_triangles(output, format, vertices, &triangles, "terrain"),
    }
}

/// Returns the format of breaklines.
fn format_of(path: &Path) -> Result<ShapeFormat, Failure> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let what = "breaklines are .geojson, .json, .svg or .poly files";
    let unknown = || Failure::Usage(ErrorKind::InvalidValue, what.into());
    extension.and_then(ShapeFormat::from_extension).ok_or_else(unknown)
}

fn report(
    arguments: &Arguments,
    scan: usize,
    constraints: &Constraints,
    interpolated: usize,
    tin: &Tin,
    time: Duration,
) -> Result<bool, io::Error> {
    let (mesh, stats) = (&tin.constrained.mesh, tin.stats);
    let mut numbers = vec![
        ("points", Number::Count(scan)),
        ("duplicates", Number::Count(stats.duplicates)),
        ("other_heights", Number::Count(stats.other_heights)),
    ];
    if arguments.breaklines.is_some() {
        numbers.extend([
            ("segments", Number::Count(constraints.segments().len())),
            ("interpolated", Number::Count(interpolated)),
            ("breakline_edges", Number::Count(mesh.constraints.len())),
            ("crossings", Number::Count(tin.constrained.added.len())),
            ("outside", Number::Count(stats.outside)),
        ]);
    }
    numbers.extend([
        ("vertices", Number::Count(tin.vertices.len())),
        ("triangles", Number::Count(tin.triangles().count())),
        ("max_error", Number::Real(tin.max_error)),
        ("limited", Number::Truth(stats.limited)),
    ]);
    print(arguments.runs.stats, &Report { numbers, seconds: time.as_secs_f64() })
}

/// The points of a scan and of breaklines, and the segments between them.
struct Terrain {
    points: Vec<[f64; 3]>,
    constraints: Constraints,
    /// The number of points of breaklines that have heights from the scan.
    interpolated: usize,
}

fn terrain(
    scan: Points<'_, 3>,
    shapes: Shapes,
    arguments: &Arguments,
    triangulator: &Triangulator,
) -> Result<Terrain, Error> {
    let mut points: Vec<[f64; 3]> = scan.iter().collect();
    let heights = if shapes.heights.is_empty() { vec![None; shapes.points.len()] } else { shapes.heights.clone() };
    let without: Vec<[f64; 2]> =
        shapes.points.iter().zip(&heights).filter(|(_, height)| height.is_none()).map(|(&place, _)| place).collect();
    let mut found = heights_of_scan(&points, &without, triangulator)?.into_iter();
    let first = points.len() as u32;
    for (&[x, y], height) in shapes.points.iter().zip(heights) {
        points.push([x, y, height.or_else(|| found.next()).unwrap_or(f64::NAN)]);
    }
    let moved = |segment: [u32; 2]| segment.map(|v| first + v);
    let edges: Vec<[u32; 2]> = shapes.edges.iter().copied().map(moved).collect();
    let rings = shapes.rings.iter().map(|ring| ring.iter().map(|v| first + v).collect::<Vec<u32>>());
    let constraints = Constraints::new().edges(&edges).fill(Fill::from(arguments.fill));
    let constraints = rings.fold(constraints, |constraints, ring| constraints.ring(&ring));
    let constraints = match arguments.fill {
        FillRule::All => constraints,
        _ => shapes.holes.iter().fold(constraints, |constraints, &hole| constraints.hole(hole)),
    };
    let constraints = if arguments.split { constraints.split_crossings() } else { constraints };
    Ok(Terrain { points, constraints, interpolated: without.len() })
}

/// Returns the heights of the surface through all points of a scan; beside it, that of the nearest point.
fn heights_of_scan(scan: &[[f64; 3]], places: &[[f64; 2]], triangulator: &Triangulator) -> Result<Vec<f64>, Error> {
    if places.is_empty() {
        return Ok(Vec::new());
    }
    let _progress = Progress::new("heights of breaklines");
    let seen: Vec<[f64; 2]> = scan.iter().map(|&[x, y, _]| [x, y]).collect();
    let mut heights: Vec<f64> = scan.iter().map(|&[_, _, z]| z).collect();
    let mesh = triangulator.delaunay2d(&seen)?;
    for (i, &first) in mesh.duplicate_of.iter().enumerate().filter(|&(_, &first)| first != NONE) {
        heights[first as usize] = heights[first as usize].min(heights[i]);
    }
    let locator = Locator::new(&mesh, &seen)?;
    let interpolator = Interpolator::new(&locator, &heights)?.outside(Outside::Nearest);
    Ok(interpolator.interpolate_many(Interpolation::Linear, places)?.values)
}

/// Returns the triangles inside, and the vertices that they have.
fn used(tin: &Tin) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut names = vec![NONE; tin.vertices.len()];
    tin.triangles().flatten().for_each(|v| names[v as usize] = v);
    let mut vertices = Vec::new();
    for name in names.iter_mut().filter(|name| **name != NONE) {
        vertices.push(tin.vertices[*name as usize]);
        *name = vertices.len() as u32 - 1;
    }
    (vertices, tin.triangles().map(|triangle| triangle.map(|v| names[v as usize])).collect())
}
