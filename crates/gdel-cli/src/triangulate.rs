//! `gdel triangulate`: a point cloud in, its Delaunay triangulation out, or the regular one of weighted points.

use super::{
    backend::BackendName,
    constrain::{self, Constrained, FillRule, Refine, Refined},
    dimension::{Dimension, Rescale, Triangulation, in_dimension},
    failure::{Failure, conclude},
    progress::Progress,
    report::{Report, StatsForm, print},
    tiles::{self, Request, Tiling},
    verify,
    weights::Weights,
};
use clap::{
    Args,
    builder::{PossibleValuesParser, TypedValueParser},
    error::ErrorKind,
};
use gdel::{
    Mesh3, Points, Triangulator,
    internals::{
        Options,
        geometry::{Euclidean, Geometry},
    },
    tiles::Provable,
};
use gdel_io::{
    PointCloud, PointFormat, ShapeFormat,
    files::{Input, Output},
};
use std::{
    iter,
    num::NonZeroUsize,
    ops::ControlFlow,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// Compute the Delaunay triangulation of a point cloud, the regular triangulation of weighted points, or the constrained
/// one of shapes in a plane.
#[derive(Args)]
pub(super) struct Arguments {
    /// The points: .ply, .obj, .stl, .off, .xyz, .txt, .asc, .pts, .csv, .tsv, .ptx, .pcd, .las, .laz,
    /// .e57, .npy, .node, .f32 or .f64, or those of .npz and .vtu files; or shapes: .geojson or .json, .svg, or .poly of
    /// the program Triangle; or `-` for standard input, with `--format`
    input: PathBuf,
    /// More files with points, which follow those of the first one. Need --tiles
    #[arg(value_name = "INPUT", requires = "tiles")]
    more: Vec<PathBuf>,
    /// Where to write: the mesh as .node, .ele and .neigh (TetGen, always all three), .vtu, .npz, .msh (Gmsh) or, with
    /// segments, .poly (Triangle); of these, .node, .vtu and .npz have the weights of points that have any;
    /// its hull as .ply, .obj, .stl, .glb or .3mf, for points in a plane their polygon from both sides; may
    /// be given several times
    #[arg(short, long = "output", value_name = "OUTPUT", value_parser = parse_output)]
    outputs: Vec<Output>,
    /// Replace any existing file; without this, only earlier outputs of gdel are replaced
    #[arg(short, long)]
    force: bool,
    /// The dimension of the points; in 2D, z is dropped and all outputs hold triangles [default: 3, and 2 for shapes]
    #[arg(long, value_enum, hide_default_value = true)]
    dim: Option<Dimension>,
    /// Take the points as longitude and latitude in degrees: the hull of the points of the unit sphere is
    /// their triangulation there
    #[arg(long, conflicts_with_all = ["dim", "rescale", "weights", "radii"])]
    sphere: bool,
    /// The format of the input, whatever its extension
    #[arg(long, value_parser = input_parser())]
    format: Option<InputFormat>,
    /// Multiply the coordinates by these factors, one per axis, before anything is computed; without
    /// factors, by those that give each axis the same extent. What is written has the given coordinates
    #[arg(long, value_name = "X,Y,Z", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    #[arg(value_parser = Rescale::parse, conflicts_with_all = ["weights", "radii"])]
    rescale: Option<Rescale>,
    #[command(flatten)]
    weights: Weights,
    /// Make these segments edges: a text file with the indices of two points on each line, counted from 0. The rest is
    /// as Delaunay as they allow. Needs --dim 2
    #[arg(long, value_name = "FILE", conflicts_with_all = ["rescale", "sphere", "weights", "radii"])]
    edges: Option<PathBuf>,
    /// Take the segments as boundaries, outer ones and those of holes, and write the triangles inside [default: all for
    /// --edges, and what the format means for shapes: evenodd in GeoJSON, nonzero in SVG, enclosed in .poly, less what
    /// that marks as holes]
    #[arg(long, value_enum)]
    fill: Option<FillRule>,
    /// Put a point where segments cross, rounded to the nearest coordinates, instead of an error. Such points are
    /// written after those of the input
    #[arg(long)]
    split: bool,
    #[command(flatten)]
    refine: Refine,
    #[command(flatten)]
    tiling: Tiling,
    /// Where to compute; the mesh is the same everywhere. With --tiles, all GPUs of the machine work, each on a tile of
    /// its own
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    backend: BackendName,
    /// How many threads the CPU backend uses [default: all]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    /// Print statistics instead of a summary: one line per run
    #[arg(long, value_enum)]
    stats: Option<StatsForm>,
    /// Triangulate this many times
    #[arg(long, value_name = "N", default_value = "1")]
    repeat: NonZeroUsize,
    /// Prove that the result is the triangulation that it should be; with --repeat, the last one
    #[arg(long)]
    verify: bool,
}

impl Arguments {
    /// Creates the triangulator: one device for all runs.
    fn triangulator(&self) -> Triangulator {
        let triangulator = Triangulator::new().backend(self.backend.into());
        match self.threads {
            Some(threads) => triangulator.threads(threads),
            None => triangulator,
        }
    }

    /// Returns the format of the input if it is shapes.
    fn shape_format(&self) -> Option<ShapeFormat> {
        match self.format {
            Some(InputFormat::Shapes(format)) => Some(format),
            Some(InputFormat::Points(_)) => None,
            None => ShapeFormat::from_extension(self.input.extension()?.to_str()?),
        }
    }
}

/// The format of an input: of points, or of shapes.
#[derive(Clone, Copy)]
enum InputFormat {
    Points(PointFormat),
    Shapes(ShapeFormat),
}

/// Parses the name of a format, which is one of its extensions.
fn input_parser() -> impl TypedValueParser<Value = InputFormat> {
    let points = PointFormat::ALL.iter().flat_map(|format| format.extensions());
    let all = points.chain(ShapeFormat::ALL.iter().flat_map(|format| format.extensions()));
    PossibleValuesParser::new(all).try_map(|name| {
        let shapes = ShapeFormat::from_extension(&name).map(InputFormat::Shapes);
        shapes.or_else(|| PointFormat::from_extension(&name).map(InputFormat::Points)).ok_or("no format of an input")
    })
}

fn parse_output(path: &str) -> Result<Output, String> {
    Output::new(Path::new(path)).map_err(|error| error.to_string())
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(format) = arguments.shape_format() {
        return triangulate_shapes(arguments, format);
    }
    if let Some(edges) = &arguments.edges {
        return triangulate_edges(arguments, edges);
    }
    if arguments.fill.is_some() || arguments.split || arguments.refine.is_given() {
        let what = "--fill, --split and the options of refinement need segments: --edges, or shapes";
        return usage(ErrorKind::MissingRequiredArgument, what);
    }
    if arguments.sphere {
        return triangulate_sphere(arguments);
    }
    if arguments.tiling.tiles.is_some() {
        return in_dimension!(arguments.dim.unwrap_or(Dimension::Three), tile_in, arguments);
    }
    in_dimension!(arguments.dim.unwrap_or(Dimension::Three), run_in, arguments)
}

/// Triangulates points in tiles.
fn tile_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    gdel::internals::dimension::Dimension<D>: Provable<D, N>,
    Euclidean: Geometry<D, N>,
{
    let Some(folder) = &arguments.tiling.tiles else { return Ok(()) };
    let request = Request {
        inputs: iter::once(&arguments.input).chain(&arguments.more).map(PathBuf::as_path).collect(),
        format: match arguments.format {
            Some(InputFormat::Points(format)) => Some(format),
            _ => None,
        },
        tiling: &arguments.tiling,
        force: arguments.force,
        options: Options { threads: arguments.threads, ..Options::default() },
        devices: tiles::devices(arguments.backend),
        verify: arguments.verify,
        stats: arguments.stats,
    };
    tiles::run::<M, D, N>(folder, request)
}

fn usage<T>(kind: ErrorKind, what: &str) -> Result<T, Failure> {
    Err(Failure::Usage(kind, what.into()))
}

fn triangulate_sphere(arguments: &Arguments) -> Result<(), Failure> {
    let Read { input, cloud, .. } = read_input::<2>(arguments)?;
    let failure = |source| Failure::Points { path: input.path().into(), source };
    let points = gdel::on_sphere(&cloud).map_err(failure)?;
    let cloud = cloud.with_points(points);
    run_with::<Mesh3, 3, 4>(arguments, &Read { input, cloud, weights: None })
}

fn triangulate_edges(arguments: &Arguments, edges: &Path) -> Result<(), Failure> {
    if arguments.dim != Some(Dimension::Two) {
        return usage(ErrorKind::MissingRequiredArgument, "--edges needs --dim 2");
    }
    arguments.outputs.iter().try_for_each(|output| output.check(&[edges], arguments.force))?;
    let Read { cloud, .. } = read_input::<2>(arguments)?;
    triangulate_constrained(arguments, constrain::read_edges(cloud, edges, arguments.fill)?, edges)
}

fn triangulate_shapes(arguments: &Arguments, format: ShapeFormat) -> Result<(), Failure> {
    if arguments.dim == Some(Dimension::Three) {
        return usage(ErrorKind::ArgumentConflict, "shapes are in a plane: leave out --dim 3");
    }
    let has_other = arguments.edges.is_some() || arguments.rescale.is_some() || arguments.weights.are_given();
    if has_other || arguments.sphere {
        let what = "--edges, --rescale, --sphere, --weights and --radii are for points, and the input is shapes";
        return usage(ErrorKind::ArgumentConflict, what);
    }
    let input = &arguments.input;
    arguments.outputs.iter().try_for_each(|output| output.check(&[input], arguments.force))?;
    triangulate_constrained(arguments, constrain::read_shapes(input, format, arguments.fill)?, input)
}

/// Triangulates points with the segments of a file.
fn triangulate_constrained(arguments: &Arguments, read: Constrained, of_segments: &Path) -> Result<(), Failure> {
    let Constrained { cloud, mut constraints } = read;
    if arguments.split {
        constraints = constraints.split_crossings();
    }
    let points = Points::from(&cloud);
    let failure = |source| {
        let path = if constrain::is_of_segments(&source) { of_segments } else { &arguments.input };
        Failure::Points { path: path.into(), source }
    };
    let report = |refined: &Refined, total, verified| {
        let mut report = Report::new(&cloud, &refined.found.mesh, total, verified);
        report.constraints = Some(constrain::counts(&constraints, refined));
        print(arguments.stats, &report)
    };
    let triangulator = arguments.triangulator();
    let triangulate = || {
        timed(&triangulator, |triangulator| {
            arguments.refine.refine(points, triangulator.constrained2d(points, &constraints)?)
        })
    };
    // Each run gives its memory back before the next.
    for _ in 1..arguments.repeat.get() {
        let (refined, total) = triangulate().map_err(failure)?;
        if !report(&refined, total, None)? {
            break;
        }
    }
    let (refined, total) = triangulate().map_err(failure)?;
    let found = &refined.found;
    let all: Vec<[f64; 2]>;
    let points = if found.added.is_empty() {
        points
    } else {
        all = points.iter().chain(found.added.iter().copied()).collect();
        Points::F64(&all)
    };
    let proof = arguments.verify.then(|| verify::proof(|| constrain::prove(points, found))).transpose();
    let proof = proof.map_err(failure)?;
    report(&refined, total, proof.as_ref().map(gdel::verify::Report::passed))?;
    if let Some(proof) = &proof {
        conclude(&arguments.input, proof)?;
    }
    let _progress = Progress::new("writing");
    let mesh = found.inside_mesh();
    Ok(arguments.outputs.iter().try_for_each(|output| output.write(points, &mesh))?)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure> {
    run_with::<M, D, N>(arguments, &read_input::<D>(arguments)?)
}

/// What is triangulated.
struct Read<const D: usize> {
    input: Input,
    cloud: PointCloud<D>,
    weights: Option<Vec<f64>>,
}

/// Checks the outputs, and reads the points, and their weights if there are to be any.
fn read_input<const D: usize>(arguments: &Arguments) -> Result<Read<D>, Failure> {
    let format = match arguments.format {
        Some(InputFormat::Points(format)) => Some(format),
        _ => None,
    };
    let input = Input::new(&arguments.input, format)?;
    arguments.outputs.iter().try_for_each(|output| output.check(&[input.path()], arguments.force))?;
    let (cloud, weights) = arguments.weights.read::<D>(&input)?;
    Ok(Read { input, cloud, weights })
}

fn run_with<M: Triangulation<D, N>, const D: usize, const N: usize>(
    arguments: &Arguments,
    Read { input, cloud, weights }: &Read<D>,
) -> Result<(), Failure> {
    let given = Points::from(cloud);
    let factors = arguments.rescale.as_ref().map(|rescale| rescale.factors(given)).transpose()?;
    let scaled = factors.map(|factors| given.scaled(factors));
    let (points, weights) = (scaled.as_ref().map_or(given, |scaled| Points::F64(scaled)), weights.as_deref());
    let failure = |source| Failure::Points { path: input.path().into(), source };
    let report = |mesh: &M, total, verified| print(arguments.stats, &Report::new(cloud, mesh, total, verified));
    let triangulator = arguments.triangulator();
    // Each run gives its memory back before the next.
    for _ in 1..arguments.repeat.get() {
        let (mesh, total) = triangulate::<M, D, N>(points, weights, &triangulator).map_err(failure)?;
        if !report(&mesh, total, None)? {
            break;
        }
    }
    let (mut mesh, total) = triangulate::<M, D, N>(points, weights, &triangulator).map_err(failure)?;
    let proof =
        if arguments.verify { Some(verify::proof(|| M::verify(points, &mesh)).map_err(failure)?) } else { None };
    report(&mesh, total, proof.as_ref().map(gdel::verify::Report::passed))?;
    if let Some(proof) = &proof {
        conclude(input.path(), proof)?;
    }
    let _progress = Progress::new("writing");
    if !arguments.outputs.is_empty() {
        mesh.close_hull(points).map_err(failure)?;
    }
    Ok(arguments.outputs.iter().try_for_each(|output| output.write(given, &mesh))?)
}

/// Triangulates, and measures how long that takes.
pub(super) fn triangulate<M: Triangulation<D, N>, const D: usize, const N: usize>(
    points: Points<'_, D>,
    weights: Option<&[f64]>,
    triangulator: &Triangulator,
) -> Result<(M, Duration), gdel::Error> {
    timed(triangulator, |triangulator| M::triangulate(points, weights, triangulator))
}

/// Calls `run` with a triangulator that shows its progress, and measures how long that takes.
fn timed<M>(
    triangulator: &Triangulator,
    run: impl FnOnce(&Triangulator) -> Result<M, gdel::Error>,
) -> Result<(M, Duration), gdel::Error> {
    let progress = Progress::new("triangulating");
    let show = progress.reporter();
    let triangulator = triangulator.clone().on_progress(move |progress| {
        show(progress.phase.name(), progress.fraction);
        ControlFlow::Continue(())
    });
    let start = Instant::now();
    let mesh = run(&triangulator)?;
    Ok((mesh, start.elapsed()))
}
