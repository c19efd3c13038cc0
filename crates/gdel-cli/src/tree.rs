//! `gdel tree`: the Euclidean minimum spanning tree of points.

use super::{
    derive::{Common, Found, GridFormat, Number, parse_grid, write},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
};
use clap::Args;
use gdel::{
    Points, SpanningTree,
    internals::geometry::{Euclidean, Geometry},
};
use gdel_io::{CellShape, Column, Grid, Table, files::ResultOutput};

/// Compute the Euclidean minimum spanning tree of points.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// Where to write the edges, in the order of their lengths: .csv or .npz with both vertices and
    /// the length, or .vtu
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<GridFormat>,
}

fn parse_output(path: &str) -> Result<ResultOutput<GridFormat>, String> {
    parse_grid(path, "spanning trees", &["csv", "npz", "vtu"])
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    in_dimension!(arguments.common.dim, run_in, arguments)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: Geometry<D, N>,
{
    let Arguments { common, output } = arguments;
    let cloud = common.read_for::<D, _>(output)?;
    let points = Points::from(&cloud);
    let (_, tree) = common.run::<M, D, N, _>(points, "tree", |mesh| {
        let tree = SpanningTree::new(mesh, points)?;
        let numbers =
            vec![("edges", Number::Count(tree.edges.len())), ("total_length", Number::Real(tree.total_length()))];
        Ok(Found { result: tree, numbers })
    })?;
    let ends = |end: usize| Column::Indices(tree.edges.iter().map(|edge| edge[end].into()).collect());
    let lengths = Table::default().with("length", Column::Numbers(tree.lengths.clone()));
    match output.format() {
        GridFormat::Vtu => {
            let mut grid = Grid::new(points, CellShape::Line);
            tree.edges.iter().for_each(|edge| grid.push(*edge));
            grid.values = lengths;
            write(output, |to| grid.write_vtu(to))
        }
        format => {
            let mut table = Table::default().with("v0", ends(0)).with("v1", ends(1));
            table.columns.extend(lengths.columns);
            write(output, |to| match format {
                GridFormat::Npz => table.write_npz(to),
                _ => table.write_csv(to),
            })
        }
    }
}
