//! `gdel voronoi`: the Voronoi cells of points.

use super::{
    clip::ClipShape,
    derive::{Common, Found, GridFormat, Number, parse_grid, write},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
    sphere,
    weights::Weights,
};
use clap::Args;
use gdel::{
    Csr, NONE, Points, Voronoi,
    internals::{derived::VoronoiShapes, geometry::Euclidean},
};
use gdel_io::{CellShape, Column, Grid, Table, files::ResultOutput};

/// Compute the Voronoi cells of points, or the cells of the power diagram if they have weights.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    weights: Weights,
    /// What the cells are clipped to: `none`, the smallest `box` that contains all points, their convex
    /// `hull`, a box by its lowest and its highest coordinates (xmin,ymin,xmax,ymax or
    /// xmin,ymin,zmin,xmax,ymax,zmax), or a file with the corners of a convex polygon or polyhedron
    #[arg(long, value_name = "SHAPE", default_value = "box", value_parser = ClipShape::parse)]
    #[arg(allow_hyphen_values = true)]
    clip: ClipShape,
    /// Take points as longitude and latitude in degrees: the cells cover the sphere. Areas are
    /// in steradians; .vtu has the cells on the unit sphere, .npz the longitudes and latitudes of corners
    #[arg(long, conflicts_with_all = ["dim", "clip", "weights", "radii"])]
    sphere: bool,
    /// Where to write: the cells as .vtu (those that are bounded); the volume, the centre of mass
    /// and the neighbours of each point's cell as .csv; all arrays as .npz
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<GridFormat>,
}

fn parse_output(path: &str) -> Result<ResultOutput<GridFormat>, String> {
    parse_grid(path, "Voronoi cells", &["vtu", "csv", "npz"])
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.sphere {
        return sphere::voronoi(&arguments.common, &arguments.output);
    }
    in_dimension!(arguments.common.dim, run_in, arguments)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: VoronoiShapes<D, N>,
{
    let Arguments { common, weights, clip, output, .. } = arguments;
    let shape = clip.read::<D>()?;
    let input = common.input()?;
    common.check(output, &[input.path()])?;
    let (cloud, weights) = weights.read::<D>(&input)?;
    let points = Points::from(&cloud);
    let (_, result) = common.run_weighted::<M, D, N, _>((points, weights.as_deref()), "voronoi", |mesh| {
        let voronoi = Voronoi::new(mesh, points, shape.clip(points))?;
        let (result, volumes) = match output.format() {
            GridFormat::Npz => arrays(&voronoi),
            GridFormat::Csv => rows(&voronoi),
            GridFormat::Vtu => cells(&voronoi),
        };
        let cells = volumes.iter().filter(|&&volume| volume > 0.0).count();
        let numbers = vec![
            ("cells", Number::Count(cells)),
            (measure::<D>(), Number::Real(volumes.iter().fold(0.0, |sum, volume| sum + volume))),
        ];
        Ok(Found { result, numbers })
    })?;
    write(output, |to| match &result {
        Derived::Arrays(table) => table.write_npz(to),
        Derived::Rows(table) => table.write_csv(to),
        Derived::Cells(grid) => grid.write_vtu(to),
    })
}

/// The data of the output.
enum Derived {
    Arrays(Table),
    Rows(Table),
    Cells(Grid),
}

/// Returns what the size of a cell is called.
fn measure<const D: usize>() -> &'static str {
    if D == 2 { "area" } else { "volume" }
}

/// Returns a row for each point's cell, and the volumes.
fn rows<const D: usize, const N: usize>(voronoi: &Voronoi<'_, D, N>) -> (Derived, Vec<f64>)
where
    Euclidean: VoronoiShapes<D, N>,
{
    let mut neighbors = Csr::default();
    let (mut volumes, mut centroids) = (Vec::new(), Vec::new());
    for (volume, centroid, of_cell) in voronoi.map_cells(|_, cell| (cell.volume, cell.centroid, cell.neighbors())) {
        volumes.push(volume);
        centroids.push(centroid);
        neighbors.indices.extend(of_cell);
        neighbors.offsets.push(neighbors.indices.len());
    }
    let table = Table::default()
        .with("point", Column::Indices((0..volumes.len() as i64).collect()))
        .with(measure::<D>(), Column::Numbers(volumes.clone()))
        .with_points("centroid_", &centroids)
        .with("neighbors", Column::Lists(neighbors));
    (Derived::Rows(table), volumes)
}

/// Returns the diagram as arrays, and the volumes.
fn arrays<const D: usize, const N: usize>(voronoi: &Voronoi<'_, D, N>) -> (Derived, Vec<f64>)
where
    Euclidean: VoronoiShapes<D, N>,
{
    let diagram = voronoi.diagram();
    let neighbors = diagram.neighbors.iter().map(|&v| if v == NONE { -1 } else { v.into() }).collect();
    let table = Table::default()
        .with_points("vertex_", &diagram.vertices)
        .with("facets", Column::Lists(diagram.facets))
        .with("facet_neighbors", Column::Indices(neighbors))
        .with("facet_areas", Column::Numbers(diagram.areas))
        .with("cells", Column::Indices(diagram.cells.iter().map(|&start| start as i64).collect()))
        .with("volumes", Column::Numbers(diagram.volumes.clone()))
        .with_points("centroid_", &diagram.centroids);
    (Derived::Arrays(table), diagram.volumes)
}

/// Returns the bounded cells, and the volumes of all.
fn cells<const D: usize, const N: usize>(voronoi: &Voronoi<'_, D, N>) -> (Derived, Vec<f64>)
where
    Euclidean: VoronoiShapes<D, N>,
{
    let found = voronoi.map_cells(|point, cell| (point, cell.clone()));
    // The facets have vertices enough, except for points in a plane or on a line.
    let shape = match found
        .iter()
        .filter(|(_, cell)| cell.is_bounded && !cell.is_empty())
        .map(|(_, cell)| cell.facets.of(0).len())
        .next()
    {
        Some(1) => CellShape::Line,
        Some(2) => CellShape::Polygon,
        Some(_) => CellShape::Polyhedron,
        None if D == 2 => CellShape::Polygon,
        None => CellShape::Polyhedron,
    };
    let mut grid = Grid::new::<D>(Points::F64(&[]), shape);
    let (mut points, mut volumes, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for (point, cell) in found {
        all.push(cell.volume);
        if cell.is_empty() || !cell.is_bounded {
            continue;
        }
        let first = grid.points.len() as u32;
        let padded = |p: &[f64; D]| std::array::from_fn(|axis| p.get(axis).copied().unwrap_or(0.0));
        grid.points.extend(cell.vertices.iter().map(padded));
        let corners: Vec<u32> = cell.facets.indices.iter().map(|v| first + v).collect();
        let facets = cell.facets.offsets.windows(2).map(|ends| &corners[ends[0]..ends[1]]);
        if shape != CellShape::Polyhedron {
            // The edges are in order, and each begins with a vertex.
            grid.push(facets.map(|ends| ends[0]));
        } else {
            let mut vertices = corners.clone();
            vertices.sort_unstable();
            vertices.dedup();
            grid.push_polyhedron(vertices, facets);
        }
        points.push(point.into());
        volumes.push(cell.volume);
    }
    grid.values =
        Table::default().with("point", Column::Indices(points)).with(measure::<D>(), Column::Numbers(volumes));
    (Derived::Cells(grid), all)
}
