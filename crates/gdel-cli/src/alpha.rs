//! `gdel alpha`: the alpha shape of points.

use super::{
    derive::{Common, Found, Number, SolidFormat, parse_solid, write, write_triangles},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
};
use clap::{Args, builder::TypedValueParser, error::ErrorKind};
use gdel::{
    AlphaShape, Error, Points,
    internals::{
        derived::{SingularEdges, singular},
        geometry::Euclidean,
    },
};
use gdel_io::{CellShape, Grid, files::ResultOutput};
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
    /// Also write the triangles, edges and vertices of the alpha complex that belong to nothing larger in it, to
    /// .vtu: the faces that have an empty sphere of this radius or less through their vertices
    #[arg(long)]
    singular: bool,
    /// Where to write: the surface as .ply, .obj, .stl, .glb or .3mf, the tetrahedra of the solid
    /// as .vtu; in 2D, all have the triangles of the solid. Points in a plane have triangles instead of
    /// tetrahedra, whose both sides are the surface, and points on a line have edges, in .vtu only
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
    /// The singular faces, if they are wanted: in 3D facets, then edges and vertices.
    singular: Vec<(CellShape, Vec<Vec<u32>>)>,
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: SingularEdges<D, N>,
{
    let Arguments { common, alpha, components, singular, output } = arguments;
    if let (Alpha::Radius(_), Some(_)) = (alpha, components) {
        return Err(Failure::Usage(ErrorKind::ArgumentConflict, "--components needs --alpha auto".into()));
    }
    if *singular && !matches!(output.format(), SolidFormat::Vtu) {
        return Err(Failure::Usage(ErrorKind::ArgumentConflict, "--singular needs an output that ends in .vtu".into()));
    }
    let wanted = Wanted { alpha: *alpha, components: components.map_or(1, NonZeroUsize::get), singular: *singular };
    let cloud = common.read_for::<D, _>(output)?;
    let points = Points::from(&cloud);
    let (_, parts) = common.run::<M, D, N, _>(points, "alpha", |mesh| find(mesh, points, wanted))?;
    let Parts { solid, surface, singular } = parts;
    match output.format() {
        SolidFormat::Vtu => {
            let mut grid = Grid::new(points, if D == 2 { CellShape::Triangle } else { CellShape::Tetrahedron });
            solid.iter().for_each(|cell| grid.push(*cell));
            for (shape, faces) in singular {
                grid.shape = shape;
                faces.into_iter().for_each(|face| grid.push(face));
            }
            write(output, |to| grid.write_vtu(to))
        }
        SolidFormat::Surface(format) if D == 2 => write_triangles(output, format, points, &solid, "alpha shape"),
        SolidFormat::Surface(format) => write_triangles(output, format, points, &surface, "alpha shape"),
    }
}

/// What to find.
#[derive(Debug, Clone, Copy)]
struct Wanted {
    alpha: Alpha,
    components: usize,
    singular: bool,
}

fn find<M: gdel::Mesh<D, N>, const D: usize, const N: usize>(
    mesh: &M,
    points: Points<'_, D>,
    wanted: Wanted,
) -> Result<Found<Parts<D, N>>, Error>
where
    Euclidean: SingularEdges<D, N>,
{
    let shape = AlphaShape::new(mesh, points)?;
    let radius = match wanted.alpha {
        Alpha::Radius(radius) => shape.up_to_rounding(radius),
        // A single point has no radius.
        Alpha::Auto => shape.auto_alpha(wanted.components).unwrap_or(0.0),
    };
    let complex = shape.at(radius)?;
    let mut parts = Parts {
        solid: complex.solid().map(|t| mesh.simplices()[t]).collect(),
        surface: complex.surface().collect(),
        singular: Vec::new(),
    };
    let mut numbers = vec![
        ("alpha", Number::Real(radius)),
        ("solid", Number::Count(parts.solid.len())),
        ("surface", Number::Count(parts.surface.len())),
        ("components", Number::Count(complex.components().1)),
    ];
    let lists = |faces: Vec<[u32; D]>| faces.into_iter().map(Vec::from).collect();
    if mesh.simplices().is_empty() && !wanted.singular {
        // What points in a plane or on a line have instead of simplices.
        let edges = || Euclidean::singular_edges(&complex).into_iter().map(Vec::from).collect();
        let is_plane = D == 3 && shape.facets().next().is_some();
        let cells: Vec<_> = if is_plane { lists(singular(complex.facets())) } else { edges() };
        numbers.push((if is_plane { "triangles" } else { "segments" }, Number::Count(cells.len())));
        parts.singular.push((if is_plane { CellShape::Triangle } else { CellShape::Line }, cells));
    }
    if wanted.singular {
        let edges = Euclidean::singular_edges(&complex).into_iter().map(Vec::from).collect();
        let vertices = singular(complex.vertices()).into_iter().map(|v| vec![v]).collect();
        if D == 3 {
            parts.singular.push((CellShape::Triangle, lists(singular(complex.facets()))));
        }
        parts.singular.extend([(CellShape::Line, edges), (CellShape::Vertex, vertices)]);
        let names = ["singular_triangles", "singular_edges", "singular_vertices"];
        let counts = parts.singular.iter().map(|(_, faces)| Number::Count(faces.len()));
        numbers.extend(names[3 - parts.singular.len()..].iter().copied().zip(counts));
    }
    Ok(Found { result: parts, numbers })
}
