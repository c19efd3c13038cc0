//! `gdel locate`: which simplex contains each query, and which vertex is nearest.

use super::{
    derive::{Common, Found, Number, Queries, parse_table, write_table},
    dimension::{Triangulation, in_dimension},
    failure::Failure,
    sphere,
    weights::Weights,
};
use clap::Args;
use gdel::{
    Location, Locator, Points,
    internals::geometry::{Euclidean, Geometry},
};
use gdel_io::{Column, Table, TableFormat, files::ResultOutput};

/// Find the simplex that contains each query point, and the nearest vertex.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    queries: Queries,
    #[command(flatten)]
    weights: Weights,
    /// Take points and queries as longitude and latitude in degrees: `simplex` is then `triangle`, the number of a
    /// triangle in the hull that `triangulate --sphere` writes
    #[arg(long, conflicts_with_all = ["dim", "exact", "weights", "radii"])]
    sphere: bool,
    /// Leave queries outside that are outside the hull by no more than coordinates are rounded: four
    /// units in the last place of the largest coordinate of each axis
    #[arg(long)]
    exact: bool,
    /// Where to write, one row per query: .csv or .npz. `simplex` is the number of the simplex in
    /// the mesh that `triangulate` writes, −1 outside the hull; `v0`, `v1`, … are its vertices, or
    /// outside those of a facet of the hull that sees the query, and −1; `nearest` is the nearest
    /// vertex, with weights that with the least power distance
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_table)]
    output: ResultOutput<TableFormat>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.sphere {
        return sphere::locate(&arguments.common, &arguments.queries, &arguments.output);
    }
    in_dimension!(arguments.common.dim, run_in, arguments)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: Geometry<D, N>,
{
    let Arguments { common, queries, weights, exact, output, .. } = arguments;
    let input = common.input()?;
    let query_input = queries.input(&input)?;
    common.check(output, &[input.path(), query_input.path()])?;
    let (points, weights) = weights.read::<D>(&input)?;
    let queries = Queries::read::<D>(&query_input)?;
    let (points, queries) = (Points::from(&points), Points::from(&queries));
    let (mesh, (located, nearest)) =
        common.run_weighted::<M, D, N, _>((points, weights.as_deref()), "locate", |mesh| {
            let locator = locator(mesh, points, *exact)?;
            let located = locator.locate_many(queries)?;
            let nearest = locator.nearest_many(queries)?;
            let outside = located.iter().filter(|location| location.simplex().is_none()).count();
            let numbers = vec![("queries", Number::Count(queries.len())), ("outside", Number::Count(outside))];
            Ok(Found { result: (located, nearest), numbers })
        })?;
    let simplex = |location: &Location| location.simplex().map_or(-1, |t| t as i64);
    let mut table = Table::default().with("simplex", Column::Indices(located.iter().map(simplex).collect()));
    let vertices: Vec<[i64; N]> = located.iter().map(|&location| vertices(&mesh, location)).collect();
    for k in 0..N {
        table = table.with(&format!("v{k}"), Column::Indices(vertices.iter().map(|v| v[k]).collect()));
    }
    let nearest = nearest.iter().map(|v| v.map_or(-1, i64::from)).collect();
    write_table(output, &table.with("nearest", Column::Indices(nearest)))
}

/// Creates a locator, without a tolerance if it is to be exact.
pub(super) fn locator<'a, const D: usize, const N: usize>(
    mesh: &'a impl gdel::Mesh<D, N>,
    points: Points<'a, D>,
    exact: bool,
) -> Result<Locator<'a, D, N>, gdel::Error>
where
    Euclidean: Geometry<D, N>,
{
    let locator = Locator::new(mesh, points)?;
    Ok(if exact { locator.exact() } else { locator })
}

/// Returns the vertices of the simplex or facet where a query is, and −1 in the places without one.
fn vertices<M: gdel::Mesh<D, N>, const D: usize, const N: usize>(mesh: &M, location: Location) -> [i64; N]
where
    Euclidean: Geometry<D, N>,
{
    match location {
        Location::Inside(t) => mesh.simplices()[t].map(i64::from),
        Location::Outside { simplex, facet } => {
            let numbers = <Euclidean as Geometry<D, N>>::FACET_NUMBERS;
            let opposite = numbers.iter().position(|&number| number == facet).unwrap_or(0);
            let mut vertices = [-1; N];
            let corners = <Euclidean as Geometry<D, N>>::FACETS[opposite];
            for (vertex, corner) in vertices.iter_mut().zip(corners) {
                *vertex = mesh.simplices()[simplex][corner].into();
            }
            vertices
        }
        _ => [-1; N],
    }
}
