//! `gdel voronoi`: the Voronoi cells of points.

use super::{
    Failure,
    derive::{Common, Found, write},
    dimension::{Dimension, Triangulation},
};
use clap::{Args, ValueEnum};
use gdel::{
    Cell, Clip, Mesh2, Mesh3, Points, Voronoi,
    internals::{
        derived::VoronoiShapes,
        geometry::Euclidean,
        io::{CellShape, Column, Grid, Table, files::ResultOutput},
    },
};
use std::{collections::BTreeMap, path::Path};

/// Compute the Voronoi cells of points.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// What the cells are clipped to
    #[arg(long, value_enum, default_value_t = ClipName::Box)]
    clip: ClipName,
    /// Where to write: the cells as .vtu (those that are bounded); the volume, the centre of mass
    /// and the neighbours of each point's cell as .csv; all arrays as .npz
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<Format>,
}

#[derive(Clone, Copy, ValueEnum)]
enum ClipName {
    /// Nothing
    None,
    /// The smallest box that contains all points
    Box,
    /// The convex hull of the points
    Hull,
}

#[derive(Debug, Clone, Copy)]
enum Format {
    Vtu,
    Csv,
    Npz,
}

fn parse_output(path: &str) -> Result<ResultOutput<Format>, String> {
    let format_of = |extension: &str| match extension.to_ascii_lowercase().as_str() {
        "vtu" => Some(Format::Vtu),
        "csv" => Some(Format::Csv),
        "npz" => Some(Format::Npz),
        _ => None,
    };
    let output = ResultOutput::new(Path::new(path), "Voronoi cells", format_of, &["vtu", "csv", "npz"]);
    output.map_err(|error| error.to_string())
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match arguments.common.dim {
        Dimension::Three => run_in::<Mesh3, 3, 4>(arguments),
        Dimension::Two => run_in::<Mesh2, 2, 3>(arguments),
    }
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: VoronoiShapes<D, N>,
{
    let Arguments { common, clip, output } = arguments;
    let input = common.input()?;
    common.check(output, &[input.path()])?;
    let cloud = common.read::<D>(&input)?;
    let points = Points::from(&cloud);
    let (_, result) = common.run::<M, D, N, _>(points, "voronoi", |mesh| {
        let clip = match clip {
            ClipName::None => Clip::None,
            ClipName::Hull => Clip::Hull,
            // Flat points, whose box may have no inside, have no cells.
            ClipName::Box if mesh.simplices().is_empty() => Clip::None,
            ClipName::Box => Clip::Box(bounds(points)),
        };
        let voronoi = Voronoi::new(mesh, points, clip)?;
        let result = match output.format() {
            Format::Npz => Derived::Arrays(arrays(&voronoi)),
            Format::Csv => Derived::Rows(rows(&voronoi)),
            Format::Vtu => Derived::Cells(cells(&voronoi)),
        };
        Ok(Found { result, numbers: BTreeMap::new() })
    })?;
    write(output, |to| match &result {
        Derived::Arrays(table) => table.write_npz(to),
        Derived::Rows(table) => table.write_csv(to),
        Derived::Cells(grid) => grid.write_vtu(to),
    })
}

/// What is written.
enum Derived {
    Arrays(Table),
    Rows(Table),
    Cells(Grid),
}

/// Returns the smallest box that contains all points.
fn bounds<const D: usize>(points: Points<'_, D>) -> [[f64; D]; 2] {
    let corner = |pick: fn(f64, f64) -> f64| {
        points.iter().reduce(|p, q| std::array::from_fn(|axis| pick(p[axis], q[axis]))).unwrap_or([0.0; D])
    };
    [corner(f64::min), corner(f64::max)]
}

fn rows<const D: usize, const N: usize>(voronoi: &Voronoi<'_, D, N>) -> Table
where
    Euclidean: VoronoiShapes<D, N>,
{
    let cells = voronoi.map_cells(|_, cell| (cell.volume, cell.centroid));
    let (volumes, centroids): (Vec<f64>, Vec<[f64; D]>) = cells.into_iter().unzip();
    Table::default()
        .with("point", Column::Indices((0..volumes.len() as i64).collect()))
        .with(if D == 2 { "area" } else { "volume" }, Column::Numbers(volumes))
        .with_points("centroid_", &centroids)
        .with("neighbors", Column::Lists(voronoi.neighbors()))
}

fn arrays<const D: usize, const N: usize>(voronoi: &Voronoi<'_, D, N>) -> Table
where
    Euclidean: VoronoiShapes<D, N>,
{
    let diagram = voronoi.diagram();
    let neighbors = diagram.neighbors.iter().map(|&v| v.into()).collect();
    Table::default()
        .with_points("vertex_", &diagram.vertices)
        .with("facets", Column::Lists(diagram.facets))
        .with("facet_neighbors", Column::Indices(neighbors))
        .with("facet_areas", Column::Numbers(diagram.areas))
        .with("cells", Column::Indices(diagram.cells.iter().map(|&start| start as i64).collect()))
        .with("volumes", Column::Numbers(diagram.volumes))
        .with_points("centroid_", &diagram.centroids)
}

fn cells<const D: usize, const N: usize>(voronoi: &Voronoi<'_, D, N>) -> Grid
where
    Euclidean: VoronoiShapes<D, N>,
{
    let shape = if D == 2 { CellShape::Polygon } else { CellShape::Polyhedron };
    let mut grid = Grid::new::<D>(Points::F64(&[]), shape);
    let (mut points, mut volumes) = (Vec::new(), Vec::new());
    for (point, cell) in voronoi.map_cells(|point, cell| (point, cell.clone())) {
        if cell.is_empty() || !cell.is_bounded {
            continue;
        }
        let first = grid.points.len() as u32;
        let padded = |p: &[f64; D]| std::array::from_fn(|axis| p.get(axis).copied().unwrap_or(0.0));
        grid.points.extend(cell.vertices.iter().map(padded));
        if D == 2 {
            grid.push(polygon(&cell).into_iter().map(|v| first + v));
        } else {
            let corners: Vec<u32> = cell.facets.indices.iter().map(|v| first + v).collect();
            let faces = cell.facets.offsets.windows(2).map(|ends| &corners[ends[0]..ends[1]]);
            let mut vertices = corners.clone();
            vertices.sort_unstable();
            vertices.dedup();
            grid.push_polyhedron(vertices, faces);
        }
        points.push(point.into());
        volumes.push(cell.volume);
    }
    let name = if D == 2 { "area" } else { "volume" };
    grid.values = Table::default().with("point", Column::Indices(points)).with(name, Column::Numbers(volumes));
    grid
}

/// Returns the vertices of a polygon, counter-clockwise around its centre of mass.
fn polygon<const D: usize>(cell: &Cell<D>) -> Vec<u32> {
    let mut starts: Vec<u32> = (0..cell.facets.len() as u32).map(|f| cell.facets.of(f)[0]).collect();
    let angle = |v: u32| {
        let [x, y] = [0, 1].map(|axis| cell.vertices[v as usize][axis] - cell.centroid[axis]);
        libm::atan2(y, x)
    };
    starts.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
    starts
}
