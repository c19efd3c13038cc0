//! `gdel alpha`: the alpha shape of points.

use super::{
    derive::{Common, Found, Number, SolidFormat, parse_solid, write_cells, write_triangles},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
};
use clap::{Args, builder::TypedValueParser, error::ErrorKind};
use gdel::{
    AlphaShape, Error, Points,
    internals::{derived::AlphaEdges, geometry::Euclidean},
};
use gdel_io::{CellShape, files::ResultOutput};
use std::num::NonZeroUsize;

/// Compute the alpha shape of points: a solid for a radius alpha, and its surface.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// The radius; `auto` is the smallest one with which all points belong to the solid and the
    /// solid has no more components than `--components`. Either takes what is as large up to rounding
    #[arg(long, default_value = "auto", allow_negative_numbers = true)]
    #[arg(value_parser = clap::builder::StringValueParser::new().try_map(|text| parse_alpha(&text)))]
    alpha: Alpha,
    /// With `--alpha auto`: the largest number of components, 1 if not given
    #[arg(long, value_name = "N")]
    components: Option<NonZeroUsize>,
    /// Where to write: the surface as .ply, .obj, .stl, .glb or .3mf, the tetrahedra of the solid
    /// as .vtu; in 2D, all have the triangles of the solid
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<SolidFormat>,
}

#[derive(Debug, Clone, Copy)]
enum Alpha {
    Auto,
    Radius(f64),
}

fn parse_alpha(text: &str) -> Result<Alpha, String> {
    match text.parse::<f64>() {
        Ok(radius) if radius >= 0.0 => Ok(Alpha::Radius(radius)),
        _ if text == "auto" => Ok(Alpha::Auto),
        _ => Err("`auto` or a number that is not negative is needed".into()),
    }
}

fn parse_output(path: &str) -> Result<ResultOutput<SolidFormat>, String> {
    parse_solid(path, "alpha shapes")
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    in_dimension!(arguments.common.dim, run_in, arguments)
}

/// The parts of the alpha shape that files hold.
struct Parts<const D: usize, const N: usize> {
    solid: Vec<[u32; N]>,
    surface: Vec<[u32; D]>,
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: AlphaEdges<D, N>,
{
    let Arguments { common, alpha, components, output } = arguments;
    if let (Alpha::Radius(_), Some(_)) = (alpha, components) {
        return Err(Failure::Usage(ErrorKind::ArgumentConflict, "--components needs --alpha auto".into()));
    }
    let components = components.map_or(1, NonZeroUsize::get);
    let cloud = common.read_for::<D, _>(output)?;
    let points = Points::from(&cloud);
    let (_, parts) = common.run::<M, D, N, _>(points, "alpha", |mesh| find(mesh, points, *alpha, components))?;
    let Parts { solid, surface } = parts;
    match output.format() {
        SolidFormat::Vtu => {
            let shape = if D == 2 { CellShape::Triangle } else { CellShape::Tetrahedron };
            write_cells(output, points, shape, &solid)
        }
        SolidFormat::Surface(format) if D == 2 => write_triangles(output, format, points, &solid, "alpha shape"),
        SolidFormat::Surface(format) => write_triangles(output, format, points, &surface, "alpha shape"),
    }
}

fn find<M: gdel::Mesh<D, N>, const D: usize, const N: usize>(
    mesh: &M,
    points: Points<'_, D>,
    alpha: Alpha,
    components: usize,
) -> Result<Found<Parts<D, N>>, Error>
where
    Euclidean: AlphaEdges<D, N>,
{
    let shape = AlphaShape::new(mesh, points)?;
    let radius = match alpha {
        Alpha::Radius(radius) => shape.up_to_rounding(radius),
        // Flat points have no solid for any radius.
        Alpha::Auto => shape.auto_alpha(components).unwrap_or(0.0),
    };
    let complex = shape.at(radius)?;
    let parts =
        Parts { solid: complex.solid().map(|t| mesh.simplices()[t]).collect(), surface: complex.surface().collect() };
    let numbers = vec![
        ("alpha", Number::Real(radius)),
        ("solid", Number::Count(parts.solid.len())),
        ("surface", Number::Count(parts.surface.len())),
        ("components", Number::Count(complex.components().1)),
    ];
    Ok(Found { result: parts, numbers })
}
