//! `gdel interpolate`: values at the points in, values at queries out.

use super::{
    derive::{Common, Found, Number, Queries},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
    locate::{parse_table, write_table},
};
use clap::{Args, ValueEnum};
use gdel::{
    Interpolation, Interpolator, Locator, Points,
    internals::{derived::StolenMeasures, geometry::Euclidean},
};
use gdel_io::{Column, Table, TableFormat, files::ResultOutput};

/// Interpolate values that are given at points.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    queries: Queries,
    /// The column of the points' file with the values: its name in the first line, or its number,
    /// counted from 1. The file must be text or CSV
    #[arg(long, value_name = "COLUMN")]
    values: String,
    /// How to interpolate
    #[arg(long, value_enum, default_value_t = Method::Linear)]
    method: Method,
    /// Where to write, one row per query with its coordinates and the value, NaN outside the hull:
    /// .csv or .npz
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_table)]
    output: ResultOutput<TableFormat>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Method {
    /// Within each simplex
    Linear,
    /// Natural neighbours, weighted by areas and distances
    Laplace,
    /// Natural neighbours, weighted by volumes
    Sibson,
}

impl From<Method> for Interpolation {
    fn from(method: Method) -> Self {
        match method {
            Method::Linear => Interpolation::Linear,
            Method::Laplace => Interpolation::Laplace,
            Method::Sibson => Interpolation::Sibson,
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    in_dimension!(arguments.common.dim, run_in, arguments)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: StolenMeasures<D, N>,
{
    let Arguments { common, queries, values, method, output } = arguments;
    let input = common.input()?;
    let query_input = queries.input(&input)?;
    common.check(output, &[input.path(), query_input.path()])?;
    let (points, values) = common.read_with_values::<D>(&input, values)?;
    let queries = Queries::read::<D>(&query_input)?;
    let (points, queries) = (Points::from(&points), Points::from(&queries));
    let (_, found) = common.run::<M, D, N, _>(points, "interpolate", |mesh| {
        let locator = Locator::new(mesh, points)?;
        let result = Interpolator::new(&locator, &values)?.interpolate_many((*method).into(), queries)?;
        let with_value = result.iter().filter(|value| !value.is_nan()).count();
        let numbers = vec![("queries", Number::Count(queries.len())), ("with_value", Number::Count(with_value))];
        Ok(Found { result, numbers })
    })?;
    let coordinates: Vec<[f64; D]> = queries.iter().collect();
    write_table(output, &Table::default().with_points("", &coordinates).with("value", Column::Numbers(found)))
}
