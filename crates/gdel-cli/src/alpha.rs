//! `gdel alpha`: the alpha shape of points, or of balls.

use super::{
    derive::{Common, Found, Number, SolidFormat, parse_solid, write, write_triangles},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
    weights::Weights,
};
use clap::{Args, builder::TypedValueParser, error::ErrorKind};
use gdel::{
    AlphaShape, BallComplex, Error, FaceClass, Points,
    internals::{
        derived::{SingularEdges, singular},
        geometry::Euclidean,
    },
};
use gdel_io::{CellShape, Grid, files::ResultOutput};
use std::num::NonZeroUsize;

/// Compute the alpha shape of points: a solid for a radius alpha, and its surface; with `--weights` or `--radii` that of
/// balls.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    weights: Weights,
    /// The radius; `auto`, the default, is the smallest one with which all points belong to the solid and the
    /// solid has no more components than `--components`. Either takes what is as large up to rounding. With weights, its
    /// square is added to them, exactly, and the default is 0: the dual complex of the balls, with the components,
    /// tunnels and voids of their union
    #[arg(long, allow_negative_numbers = true)]
    #[arg(value_parser = clap::builder::StringValueParser::new().try_map(|text| parse_alpha(&text)))]
    alpha: Option<Alpha>,
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
    let Arguments { common, weights, alpha, components, singular, output } = arguments;
    let default = if weights.are_given() { Alpha::Radius(0.0) } else { Alpha::Auto };
    let alpha = alpha.unwrap_or(default);
    let conflict = |what: &str| Err(Failure::Usage(ErrorKind::ArgumentConflict, what.into()));
    match alpha {
        Alpha::Radius(_) if components.is_some() => return conflict("--components needs --alpha auto"),
        Alpha::Auto if weights.are_given() => return conflict("with weights, --alpha has to be a number"),
        _ => {}
    }
    if *singular && !matches!(output.format(), SolidFormat::Vtu) {
        return conflict("--singular needs an output that ends in .vtu");
    }
    let wanted = Wanted { alpha, components: components.map_or(1, NonZeroUsize::get), singular: *singular };
    let input = common.input()?;
    common.check(output, &[input.path()])?;
    let (cloud, weights) = weights.read::<D>(&input)?;
    let (points, weights) = (Points::from(&cloud), weights.as_deref());
    let (_, parts) = common.run_weighted::<M, D, N, _>((points, weights), "alpha", |mesh| {
        let complex = match (weights, wanted.alpha) {
            (Some(weights), Alpha::Radius(radius)) => {
                of_balls(&BallComplex::new(mesh, points, weights, radius)?, radius)
            }
            _ => of_points(mesh, points, wanted)?,
        };
        Ok(found(complex, mesh, wanted))
    })?;
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

/// A complex for a radius.
struct Complex<const D: usize> {
    radius: f64,
    /// The numbers of the simplices that are part of it.
    solid: Vec<usize>,
    surface: Vec<[u32; D]>,
    components: usize,
    /// The faces that belong to nothing larger.
    facets: Vec<[u32; D]>,
    edges: Vec<[u32; 2]>,
    vertices: Vec<u32>,
    /// Whether there are facets at all.
    has_facets: bool,
}

fn of_points<M: gdel::Mesh<D, N>, const D: usize, const N: usize>(
    mesh: &M,
    points: Points<'_, D>,
    wanted: Wanted,
) -> Result<Complex<D>, Error>
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
    let mut found = Complex {
        radius,
        solid: complex.solid().collect(),
        surface: complex.surface().collect(),
        components: complex.components().1,
        facets: Vec::new(),
        edges: Vec::new(),
        vertices: Vec::new(),
        has_facets: shape.facets().next().is_some(),
    };
    // They take longer than all else.
    if wanted.singular || mesh.simplices().is_empty() {
        found.facets = singular(complex.facets());
        found.edges = Euclidean::singular_edges(&complex);
        found.vertices = singular(complex.vertices());
    }
    Ok(found)
}

fn of_balls<const D: usize, const N: usize>(complex: &BallComplex<D, N>, radius: f64) -> Complex<D>
where
    Euclidean: SingularEdges<D, N>,
{
    fn copied<F: Copy>(faces: &[(F, FaceClass)]) -> Vec<F> {
        singular(faces.iter().copied())
    }
    Complex {
        radius,
        solid: complex.solid().collect(),
        surface: complex.surface().to_vec(),
        components: complex.components().1,
        facets: copied(complex.facets()),
        edges: copied(complex.edges()),
        vertices: copied(complex.vertices()),
        has_facets: !complex.facets().is_empty(),
    }
}

/// Returns what files hold of a complex, and what is printed.
fn found<M: gdel::Mesh<D, N>, const D: usize, const N: usize>(
    complex: Complex<D>,
    mesh: &M,
    wanted: Wanted,
) -> Found<Parts<D, N>> {
    let mut parts = Parts {
        solid: complex.solid.iter().map(|&t| mesh.simplices()[t]).collect(),
        surface: complex.surface,
        singular: Vec::new(),
    };
    let mut numbers = vec![
        ("alpha", Number::Real(complex.radius)),
        ("solid", Number::Count(parts.solid.len())),
        ("surface", Number::Count(parts.surface.len())),
        ("components", Number::Count(complex.components)),
    ];
    fn lists<const K: usize>(faces: &[[u32; K]]) -> Vec<Vec<u32>> {
        faces.iter().map(|face| face.to_vec()).collect()
    }
    if mesh.simplices().is_empty() && !wanted.singular {
        // What points in a plane or on a line have instead of simplices.
        let is_plane = D == 3 && complex.has_facets;
        let cells = if is_plane { lists(&complex.facets) } else { lists(&complex.edges) };
        numbers.push((if is_plane { "triangles" } else { "segments" }, Number::Count(cells.len())));
        parts.singular.push((if is_plane { CellShape::Triangle } else { CellShape::Line }, cells));
    }
    if wanted.singular {
        let vertices = complex.vertices.iter().map(|&v| vec![v]).collect();
        if D == 3 {
            parts.singular.push((CellShape::Triangle, lists(&complex.facets)));
        }
        parts.singular.extend([(CellShape::Line, lists(&complex.edges)), (CellShape::Vertex, vertices)]);
        let names = ["singular_triangles", "singular_edges", "singular_vertices"];
        let counts = parts.singular.iter().map(|(_, faces)| Number::Count(faces.len()));
        numbers.extend(names[3 - parts.singular.len()..].iter().copied().zip(counts));
    }
    Found { result: parts, numbers }
}
