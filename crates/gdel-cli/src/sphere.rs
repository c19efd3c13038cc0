//! `--sphere`: points and queries that are longitudes and latitudes in degrees.

use super::{
    derive::{Common, Found, GridFormat, Number, Queries, write, write_table},
    failure::Failure,
};
use gdel::{Csr, Error, Mesh3, Points, Sphere, lon_lat, on_sphere};
use gdel_io::{
    CellShape, Column, Grid, PointCloud, Table, TableFormat,
    files::{Input, ResultOutput},
};

/// The points and the queries of a command, on the unit sphere.
struct Places {
    points: Vec<[f64; 3]>,
    queries: Vec<[f64; 3]>,
    /// The queries as they are given.
    given: Vec<[f64; 2]>,
}

impl Places {
    fn new(cloud: &PointCloud<2>, input: &Input, queries: &Input) -> Result<Self, Failure> {
        let points = places(cloud, input)?;
        let cloud = Queries::read::<2>(queries)?;
        Ok(Places { points, queries: places(&cloud, queries)?, given: Points::from(&cloud).iter().collect() })
    }
}

fn places(cloud: &PointCloud<2>, input: &Input) -> Result<Vec<[f64; 3]>, Failure> {
    on_sphere(cloud).map_err(|source| Failure::Points { path: input.path().into(), source })
}

/// Takes the hull of a mesh, whose triangles keep their order.
fn sphere<'a>(mesh: &Mesh3, points: &'a [[f64; 3]]) -> Result<Sphere<'a>, Error> {
    Sphere::from_hull(mesh.hull.clone(), mesh.duplicate_of.clone(), points)
}

pub(super) fn locate(common: &Common, queries: &Queries, output: &ResultOutput<TableFormat>) -> Result<(), Failure> {
    let input = common.input()?;
    let query_input = queries.input(&input)?;
    common.check(output, &[input.path(), query_input.path()])?;
    let Places { points, queries, .. } = Places::new(&common.read::<2>(&input)?, &input, &query_input)?;
    let (_, table) = common.run::<Mesh3, 3, 4, _>(Points::F64(&points), "locate", |mesh| {
        let sphere = sphere(mesh, &points)?;
        let (located, nearest) = (sphere.locate_many(&queries)?, sphere.nearest_many(&queries)?);
        let outside = located.iter().filter(|triangle| triangle.is_none()).count();
        let numbers = vec![("queries", Number::Count(queries.len())), ("outside", Number::Count(outside))];
        let triangle = located.iter().map(|t| t.map_or(-1, |t| t as i64)).collect();
        let mut table = Table::default().with("triangle", Column::Indices(triangle));
        for (k, name) in ["v0", "v1", "v2"].into_iter().enumerate() {
            let vertices = located.iter().map(|t| t.map_or(-1, |t| sphere.triangles()[t][k].into())).collect();
            table = table.with(name, Column::Indices(vertices));
        }
        let nearest = nearest.iter().map(|v| v.map_or(-1, i64::from)).collect();
        Ok(Found { result: table.with("nearest", Column::Indices(nearest)), numbers })
    })?;
    write_table(output, &table)
}

/// Returns the queries as they are given, and the value at each.
pub(super) fn interpolate<F: Copy>(
    common: &Common,
    queries: &Queries,
    values: &str,
    output: &ResultOutput<F>,
) -> Result<(Vec<[f64; 2]>, Vec<f64>), Failure> {
    let input = common.input()?;
    let query_input = queries.input(&input)?;
    common.check(output, &[input.path(), query_input.path()])?;
    let (cloud, values) = common.read_with_values::<2>(&input, values)?;
    let Places { points, queries, given } = Places::new(&cloud, &input, &query_input)?;
    let (_, found) = common.run::<Mesh3, 3, 4, _>(Points::F64(&points), "interpolate", |mesh| {
        let found = sphere(mesh, &points)?.interpolate_many(&values, &queries)?;
        let numbers = vec![("queries", Number::Count(queries.len())), ("outside", Number::Count(found.outside))];
        Ok(Found { result: found.values, numbers })
    })?;
    Ok((given, found))
}

pub(super) fn voronoi(common: &Common, output: &ResultOutput<GridFormat>) -> Result<(), Failure> {
    let cloud = common.read_for::<2, _>(output)?;
    let points = places(&cloud, &common.input()?)?;
    let (_, (grid, table)) = common.run::<Mesh3, 3, 4, _>(Points::F64(&points), "voronoi", |mesh| {
        let sphere = sphere(mesh, &points)?;
        let areas = sphere.areas();
        let cells = areas.iter().filter(|&&area| area > 0.0).count();
        let sum = areas.iter().fold(0.0, |sum, area| sum + area);
        let numbers = vec![("cells", Number::Count(cells)), ("area", Number::Real(sum))];
        let result = match output.format() {
            GridFormat::Vtu => (Some(polygons(&sphere, &areas)), Table::default()),
            GridFormat::Csv => (None, rows(&sphere, areas)),
            GridFormat::Npz => (None, arrays(&sphere, areas)?),
        };
        Ok(Found { result, numbers })
    })?;
    write(output, |to| match (&grid, output.format()) {
        (Some(grid), _) => grid.write_vtu(to),
        (None, GridFormat::Npz) => table.write_npz(to),
        (None, _) => table.write_csv(to),
    })
}

/// Returns the cells as polygons in space.
fn polygons(sphere: &Sphere<'_>, areas: &[f64]) -> Grid {
    let (corners, cells) = sphere.polygons();
    let mut grid = Grid::new(Points::F64(&corners), CellShape::Polygon);
    let drawn: Vec<usize> = (0..cells.len()).filter(|&v| !cells.of(v as u32).is_empty()).collect();
    drawn.iter().for_each(|&v| grid.push(cells.of(v as u32).iter().copied()));
    grid.values = Table::default()
        .with("point", Column::Indices(drawn.iter().map(|&v| v as i64).collect()))
        .with("area", Column::Numbers(drawn.iter().map(|&v| areas[v]).collect()));
    grid
}

/// Returns a row for each point's cell, with the points that it has an edge to.
fn rows(sphere: &Sphere<'_>, areas: Vec<f64>) -> Table {
    let mut neighbors = Csr::default();
    for v in 0..areas.len() as u32 {
        let after = |&t: &u32| {
            let triangle = sphere.triangles()[t as usize];
            let place = triangle.iter().position(|&w| w == v).unwrap_or(0);
            triangle[(place + 1) % 3]
        };
        neighbors.indices.extend(sphere.cells().of(v).iter().map(after));
        neighbors.offsets.push(neighbors.indices.len());
    }
    Table::default()
        .with("point", Column::Indices((0..areas.len() as i64).collect()))
        .with("area", Column::Numbers(areas))
        .with("neighbors", Column::Lists(neighbors))
}

/// Returns the cells as arrays.
fn arrays(sphere: &Sphere<'_>, areas: Vec<f64>) -> Result<Table, Error> {
    let (corners, cells) = sphere.polygons();
    Ok(Table::default()
        .with_points("corner_", &lon_lat(&corners)?)
        .with("cells", Column::Lists(cells))
        .with("areas", Column::Numbers(areas)))
}
