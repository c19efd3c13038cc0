//! `gdel surface`: one closed surface through the points of a scan.

use super::{
    derive::{Common, Found, Number, SolidFormat, parse_solid, write_cells, write_triangles},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
};
use clap::{Args, ValueEnum, error::ErrorKind};
use gdel::{
    Error, Evidence, Open, Points, Side, Surface, SurfaceOptions,
    internals::{derived::SurfaceMesh, geometry::Euclidean},
};
use gdel_io::{
    CellShape, PointBuf,
    files::{ResultOutput, shown},
};

/// Find the closed surface that points of a scan lie on: no normals are needed.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// Drop pieces and cavities of less than this share of the largest piece's volume
    #[arg(long, value_name = "SHARE", default_value = "0.01")]
    min_part: f64,
    /// Keep points that are far from all others
    #[arg(long)]
    keep_isolated: bool,
    /// How often points are moved onto quadrics through their neighbours; `auto` is twice if there is
    /// noise, else never
    #[arg(long, value_name = "N", default_value = "auto", value_parser = parse_smooth)]
    smooth: Smooth,
    /// The position of the scanner, as X,Y,Z, instead of those that the file has: what it saw the points through is outside
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_position)]
    sensor: Option<Position>,
    /// Do without the normals that the file has
    #[arg(long)]
    no_normals: bool,
    /// Do without the positions of scanners that the file has
    #[arg(long, conflicts_with = "sensor")]
    no_sensors: bool,
    /// What is below all points is inside, as in airborne scans of the ground; z is up, in 2D y
    #[arg(long, visible_alias = "airborne")]
    below: bool,
    /// Whether triangles that only close gaps between the points are left out if they are many, as in
    /// terrain or a scan from one side; without, the surface is closed
    #[arg(long, value_enum, default_value_t = OpenName::Never)]
    open: OpenName,
    /// Split each triangle into four, with the new vertices on quadrics through the points around them
    #[arg(long)]
    refine: bool,
    /// Decimate the surface to about so many triangles, or more where fewer would not be a closed manifold. In
    /// places they may then intersect: the number of those is printed
    #[cfg(feature = "decimate")]
    #[arg(long, value_name = "N")]
    triangles: Option<std::num::NonZeroUsize>,
    /// Where to write: the surface as .stl, .ply, .obj, .glb or .3mf, the tetrahedra of the solid as
    /// .vtu; in 2D, .vtu has the curves, and all others have the triangles between them
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<SolidFormat>,
}

/// How often points are moved; `None` if noise decides.
#[derive(Debug, Clone, Copy)]
struct Smooth(Option<u32>);

fn parse_smooth(text: &str) -> Result<Smooth, String> {
    match text.parse() {
        _ if text == "auto" => Ok(Smooth(None)),
        Ok(times) if times <= 100 => Ok(Smooth(Some(times))),
        _ => Err("`auto` or a number up to 100 is needed".into()),
    }
}

/// Which surfaces may be open.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum OpenName {
    Never,
    Auto,
}

/// The coordinates of a position: two or three.
#[derive(Debug, Clone)]
struct Position(Vec<f64>);

impl Position {
    /// Returns the position in a dimension.
    fn in_dimension<const D: usize>(&self) -> Result<[f64; D], Failure> {
        self.0.as_slice().try_into().map_err(|_| {
            Failure::Usage(ErrorKind::ValueValidation, format!("--sensor needs {D} coordinates, not {}", self.0.len()))
        })
    }
}

fn parse_position(text: &str) -> Result<Position, String> {
    let coordinates: Option<Vec<f64>> =
        text.split(',').map(|x| x.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
    let coordinates = coordinates.filter(|coordinates| matches!(coordinates.len(), 2 | 3));
    coordinates.map(Position).ok_or_else(|| "numbers with commas between them are needed, as in 1.5,0,-2".into())
}

fn parse_output(path: &str) -> Result<ResultOutput<SolidFormat>, String> {
    parse_solid(path, "surfaces")
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    in_dimension!(arguments.common.dim, run_in, arguments)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: SurfaceMesh<D, N>,
{
    let Arguments { common, output, .. } = arguments;
    let sensor = arguments.sensor.as_ref().map(Position::in_dimension::<D>).transpose()?;
    let cloud = common.read_for::<D, _>(output)?;
    let points = Points::from(&cloud);
    let mut options = SurfaceOptions::default();
    let sensors = match &sensor {
        Some(sensor) => std::slice::from_ref(sensor),
        None if arguments.no_sensors => &[],
        None => &cloud.sensors,
    };
    options.sensors = (!sensors.is_empty()).then_some(Points::F64(sensors));
    options.normals = cloud.normals.as_deref().filter(|_| !arguments.no_normals).map(Points::F32);
    options.up = arguments.below.then(|| std::array::from_fn(|axis| if axis == D - 1 { 1.0 } else { 0.0 }));
    options.refine = arguments.refine;
    options.open = match arguments.open {
        OpenName::Never => Open::Never,
        OpenName::Auto => Open::Auto,
    };
    options.min_part = arguments.min_part;
    options.drop_isolated = !arguments.keep_isolated;
    options.smooth = arguments.smooth.0;
    #[cfg(feature = "decimate")]
    let triangles = arguments.triangles.map(std::num::NonZeroUsize::get);
    #[cfg(not(feature = "decimate"))]
    let triangles = None;
    if triangles.is_some() && (D == 2 || matches!(output.format(), SolidFormat::Vtu)) {
        let what = "--triangles needs 3D points and a file of triangles";
        return Err(Failure::Usage(ErrorKind::ArgumentConflict, what.into()));
    }
    let find = |mesh: &M| find(mesh, points, &options, triangles);
    let (_, (surface, facets)) = common.run::<M, D, N, _>(points, "surface", find)?;
    if surface.evidence() == Evidence::Guess {
        eprintln!(
            "gdel: {}: the points enclose little, so that which side is inside is a guess; `--below` says that what is \
             below all points is, as in airborne scans, and `--sensor X,Y,Z` from where they were seen",
            shown(&common.points)
        );
    }
    let moved = surface.moved_points().map_or(points, Points::F64);
    match output.format() {
        SolidFormat::Vtu if D == 2 => {
            write_cells(output, Points::F64(surface.vertices()), CellShape::Line, surface.facets())
        }
        SolidFormat::Vtu => write_cells(output, moved, CellShape::Tetrahedron, surface.solid()),
        SolidFormat::Surface(format) if D == 2 => write_triangles(output, format, moved, surface.solid(), "surface"),
        SolidFormat::Surface(format) => {
            let vertices = in_precision_of(points, surface.vertices());
            write_triangles(
                output,
                format,
                (&vertices).into(),
                facets.as_deref().unwrap_or(surface.facets()),
                "surface",
            )
        }
    }
}

/// A surface, and its facets if they were decimated.
type Parts<const D: usize, const N: usize> = (Surface<D, N>, Option<Vec<[u32; D]>>);

fn find<M: gdel::Mesh<D, N>, const D: usize, const N: usize>(
    mesh: &M,
    points: Points<'_, D>,
    options: &SurfaceOptions<'_, D>,
    triangles: Option<usize>,
) -> Result<Found<Parts<D, N>>, Error>
where
    Euclidean: SurfaceMesh<D, N>,
{
    let surface = Surface::new(mesh, points, options)?;
    let count = |side: Side| Number::Count(surface.sides().iter().filter(|&&other| other == side).count());
    let [facets, volume, area] = match D {
        2 => ["curve_edges", "area", "length"],
        _ => ["surface_triangles", "volume", "area"],
    };
    let [pieces, cavities] = surface.dropped();
    let mut numbers = vec![
        ("vertices", Number::Count(surface.vertices().len())),
        (facets, Number::Count(surface.facets().len())),
        (volume, Number::Real(surface.volume())),
        (area, Number::Real(surface.area())),
        ("components", Number::Count(surface.components())),
        ("closed", Number::Truth(surface.is_closed())),
        ("on_surface", count(Side::On)),
        ("inside", count(Side::Inside)),
        ("outside", count(Side::Outside)),
        ("dropped_pieces", Number::Count(pieces)),
        ("filled_cavities", Number::Count(cavities)),
        ("isolated", Number::Count(surface.isolated())),
        ("noise", Number::Real(surface.noise())),
        ("side_by", Number::Name(surface.evidence().name())),
        ("smoothed", Number::Truth(surface.moved_points().is_some())),
    ];
    if D == 3 {
        numbers.insert(5, ("genus", Number::Count(surface.genus())));
        numbers.insert(6, ("boundaries", Number::Count(surface.boundaries())));
    }
    #[cfg(feature = "decimate")]
    let facets = triangles.map(|count| decimated(&surface, count, &mut numbers));
    #[cfg(not(feature = "decimate"))]
    let facets = triangles.and(None);
    Ok(Found { result: (surface, facets), numbers })
}

/// Returns fewer facets of a surface, and adds what became of them to the numbers.
#[cfg(feature = "decimate")]
fn decimated<const D: usize, const N: usize>(
    surface: &Surface<D, N>,
    count: usize,
    numbers: &mut Vec<(&'static str, Number)>,
) -> Vec<[u32; D]>
where
    Euclidean: SurfaceMesh<D, N>,
{
    let in_space: Vec<[f64; 3]> = surface.vertices().iter().map(|p| std::array::from_fn(|k| p[k])).collect();
    let triangles: Vec<[u32; 3]> = surface.facets().iter().map(|facet| std::array::from_fn(|k| facet[k])).collect();
    let fewer = super::decimate::decimated(&in_space, &triangles, count);
    let facets: Vec<[u32; D]> = fewer.iter().map(|triangle| std::array::from_fn(|k| triangle[k])).collect();
    numbers.push(("decimated", Number::Count(facets.len())));
    numbers.push((
        "intersecting",
        Number::Count(gdel::internals::derived::crossing_facets(&facets, surface.vertices()).len()),
    ));
    facets
}

/// Returns the vertices in the precision of the points: some formats are smaller for single precision.
fn in_precision_of<const D: usize>(points: Points<'_, D>, vertices: &[[f64; D]]) -> PointBuf<D> {
    match points {
        Points::F32(_) => PointBuf::F32(vertices.iter().map(|p| p.map(|x| x as f32)).collect()),
        Points::F64(_) => PointBuf::F64(vertices.to_vec()),
    }
}
