//! `gdel transport`: weights with which power cells have given volumes.

use super::{
    clip::ClipShape,
    derive::{Common, Found, GridFormat, Number, parse_grid, write},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
};
use clap::Args;
use gdel::{
    Points, TransportOptions, Triangulator,
    internals::{derived::VoronoiShapes, geometry::Euclidean},
};
use gdel_io::{CellShape, Column, Grid, Table, files::ResultOutput};

/// Find the weights with which the power cells of points have given volumes (in 2D areas).
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// The column of the input that holds the masses, which the volumes of the cells are to be, by its name or its number,
    /// counted from 1. The input must be text, CSV, .ply, .node, .npz or .vtu. By default all cells are to be equally large
    #[arg(long, value_name = "COLUMN")]
    masses: Option<String>,
    /// Multiply the masses so that their sum is the volume of what the cells are clipped to
    #[arg(long, requires = "masses")]
    normalize: bool,
    /// The share of its mass by which the volume of a cell may differ from it
    #[arg(long, value_name = "SHARE", default_value = "0.001")]
    tolerance: f64,
    /// What the cells are clipped to: the smallest `box` that contains all points, their convex `hull`, a
    /// box by its lowest and its highest coordinates (xmin,ymin,xmax,ymax or
    /// xmin,ymin,zmin,xmax,ymax,zmax), or a file with the corners of a convex polygon or polyhedron
    #[arg(long, value_name = "SHAPE", default_value = "box", value_parser = ClipShape::parse)]
    #[arg(allow_hyphen_values = true)]
    clip: ClipShape,
    /// Where to write the points with their weights, and the volumes of their cells: as .csv or .npz, whose column `weight`
    /// `gdel voronoi --weights weight` reads, or .vtu
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<GridFormat>,
}

fn parse_output(path: &str) -> Result<ResultOutput<GridFormat>, String> {
    parse_grid(path, "weights", &["csv", "npz", "vtu"])
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    in_dimension!(arguments.common.dim, run_in, arguments)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: VoronoiShapes<D, N>,
{
    let Arguments { common, masses: column, normalize, tolerance, clip, output } = arguments;
    let shape = clip.read::<D>()?;
    let input = common.input()?;
    common.check(output, &[input.path()])?;
    let (cloud, masses) = match column {
        Some(column) => {
            let (cloud, masses) = common.read_with_values::<D>(&input, column)?;
            (cloud, Some(masses))
        }
        None => (common.read::<D>(&input)?, None),
    };
    let points = Points::from(&cloud);
    let mut options = TransportOptions::default();
    (options.masses, options.normalize, options.tolerance) = (masses.as_deref(), *normalize, *tolerance);
    // The mesh is that without weights: it says how many points there are.
    let (_, found) = common.run::<M, D, N, _>(points, "transport", |_| {
        let found = M::transport(points, shape.clip(points), &options, &Triangulator::new())?;
        let numbers = vec![("steps", Number::Count(found.steps)), ("error", Number::Real(found.error))];
        Ok(Found { result: found, numbers })
    })?;
    let measure = if D == 2 { "area" } else { "volume" };
    let values = |table: Table| {
        table
            .with("weight", Column::Numbers(found.weights.clone()))
            .with(measure, Column::Numbers(found.volumes.clone()))
    };
    let coordinates: Vec<[f64; D]> = points.iter().collect();
    write(output, |to| match output.format() {
        GridFormat::Csv => values(Table::default().with_points("", &coordinates)).write_csv(to),
        GridFormat::Npz => values(Table::default().with_points("", &coordinates)).write_npz(to),
        GridFormat::Vtu => {
            let mut grid = Grid::new(points, CellShape::Vertex);
            (0..coordinates.len() as u32).for_each(|i| grid.push([i]));
            grid.values = values(Table::default());
            grid.write_vtu(to)
        }
    })
}
