//! `gdel interpolate`: values at the points in, values at queries out.

use super::{
    derive::{Common, Found, Number, Queries, write},
    dimension::{Rescale, Triangulation, in_dimension},
    failure::Failure,
    locate::locator,
    sphere,
};
use clap::{Args, ValueEnum, error::ErrorKind};
use gdel::{
    Duplicates, Grid, Interpolated, Interpolation, Interpolator, Outside, Points,
    internals::{derived::StolenMeasures, geometry::Euclidean},
};
use gdel_io::{
    Column, Raster, Table, TableFormat,
    files::{Input, ResultOutput},
};
use std::path::Path;

/// Interpolate values that are given at points, at other points or on a grid.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    queries: Option<Queries>,
    /// Interpolate at the centres of the cells of a grid instead of at query points: so many cells along each axis, such
    /// as 500x400 or, in 3D, 50x40x30. In 2D the first row is the one with the largest y, as in images
    #[arg(long, value_name = "SIZE", value_parser = parse_size, conflicts_with = "queries")]
    grid: Option<Size>,
    /// The lowest and the highest coordinates of the grid: xmin,ymin,xmax,ymax or xmin,ymin,zmin,xmax,ymax,zmax
    /// [default: the smallest box that contains all points]
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', allow_hyphen_values = true, requires = "grid")]
    bounds: Vec<f64>,
    /// The column of the points' file with the values, by its name or its number, counted from 1. The file must be text,
    /// CSV, .ply, .node, .npz or .vtu
    #[arg(long, value_name = "COLUMN")]
    values: String,
    /// Take points and queries as longitude and latitude in degrees; `linear` is the method
    #[arg(long, conflicts_with_all = ["dim", "method", "outside", "duplicates", "rescale", "exact"])]
    sphere: bool,
    /// How to interpolate
    #[arg(long, value_enum, default_value_t = Method::Linear)]
    method: Method,
    /// The value outside the convex hull: `nan`, that of the `nearest` point, that of the hull's nearest
    /// place plus what its gradient adds (`linear`), or a number
    #[arg(long, value_name = "VALUE", value_parser = parse_outside, default_value = "nan", allow_negative_numbers = true)]
    outside: Outside,
    /// The value of equal points
    #[arg(long, value_enum, default_value_t = DuplicatesName::First)]
    duplicates: DuplicatesName,
    /// Multiply the coordinates by these factors, one per axis, before anything is computed; without
    /// factors, by those that give each axis the same extent. What is written has the given coordinates
    #[arg(long, value_name = "X,Y,Z", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    #[arg(value_parser = Rescale::parse)]
    rescale: Option<Rescale>,
    /// Leave queries outside that are outside the hull by no more than coordinates are rounded: four
    /// units in the last place of the largest coordinate of each axis
    #[arg(long)]
    exact: bool,
    /// Where to write, one row per query with its coordinates and the value: .csv or .npz. The values of a
    /// grid also as .npy, an array of rows, and in 2D as .tif, a GeoTIFF
    #[arg(short, long = "output", value_name = "FILE", value_parser = parse_output)]
    output: ResultOutput<Format>,
}

/// The number of cells along each axis.
#[derive(Clone)]
struct Size(Vec<usize>);

fn parse_size(text: &str) -> Result<Size, String> {
    let size = text.split(['x', '×']).map(|part| part.parse().ok().filter(|&count| count > 0));
    size.collect::<Option<_>>()
        .map(Size)
        .ok_or_else(|| "numbers with `x` between them are needed, such as 500x400".into())
}

#[derive(Clone, Copy)]
enum Format {
    Table(TableFormat),
    Npy,
    Tiff,
}

fn parse_output(path: &str) -> Result<ResultOutput<Format>, String> {
    let format_of = |extension: &str| match extension.to_ascii_lowercase().as_str() {
        "npy" => Some(Format::Npy),
        "tif" | "tiff" => Some(Format::Tiff),
        other => TableFormat::from_extension(other).map(Format::Table),
    };
    let output = ResultOutput::new(Path::new(path), "values", format_of, &["csv", "npz", "npy", "tif"]);
    output.map_err(|error| error.to_string())
}

#[derive(Clone, Copy, ValueEnum)]
enum Method {
    /// Within each simplex
    Linear,
    /// Natural neighbours, weighted by areas and distances
    Laplace,
    /// Natural neighbours, weighted by volumes
    Sibson,
    /// The same with gradients: smooth at the points, too
    SibsonC1,
    /// A cubic in each third of a triangle, with gradients: smooth, in 2D
    CloughTocher,
}

#[derive(Clone, Copy, ValueEnum)]
enum DuplicatesName {
    /// That of the first
    First,
    /// The mean of all
    Mean,
    /// An error if they differ
    Error,
}

impl From<DuplicatesName> for Duplicates {
    fn from(name: DuplicatesName) -> Self {
        match name {
            DuplicatesName::First => Duplicates::First,
            DuplicatesName::Mean => Duplicates::Mean,
            DuplicatesName::Error => Duplicates::Error,
        }
    }
}

fn parse_outside(text: &str) -> Result<Outside, String> {
    match text {
        "nearest" => Ok(Outside::Nearest),
        "linear" => Ok(Outside::Linear),
        _ => match text.parse() {
            Ok(value) => Ok(Outside::Value(value)),
            Err(_) => Err("`nan`, `nearest`, `linear` or a number is needed".into()),
        },
    }
}

impl From<Method> for Interpolation {
    fn from(method: Method) -> Self {
        match method {
            Method::Linear => Interpolation::Linear,
            Method::Laplace => Interpolation::Laplace,
            Method::Sibson => Interpolation::Sibson,
            Method::SibsonC1 => Interpolation::SibsonC1,
            Method::CloughTocher => Interpolation::CloughTocher,
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.sphere {
        let Arguments { common, values, output, .. } = arguments;
        let (places, found) = sphere::interpolate(common, arguments.queries()?, values, output)?;
        return write_table_of(output, &places, found);
    }
    in_dimension!(arguments.common.dim, run_in, arguments)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    Euclidean: StolenMeasures<D, N>,
{
    let Arguments { common, values, output, .. } = arguments;
    let input = common.input()?;
    if arguments.grid.is_some() {
        common.check(output, &[input.path()])?;
        return on_grid::<M, D, N>(arguments, &input);
    }
    let queries = arguments.queries()?;
    let query_input = queries.input(&input)?;
    common.check(output, &[input.path(), query_input.path()])?;
    let (points, values) = common.read_with_values::<D>(&input, values)?;
    let queries = Queries::read::<D>(&query_input)?;
    let (points, queries) = (Points::from(&points), Points::from(&queries));
    let coordinates: Vec<[f64; D]> = queries.iter().collect();
    let factors = arguments.factors(points)?;
    let scaled = factors.map(|factors| [points, queries].map(|points| points.scaled(factors)));
    let [points, queries] =
        scaled.as_ref().map_or([points, queries], |scaled| scaled.each_ref().map(|all| Points::F64(all)));
    let found = arguments.interpolate::<M, D, N>(points, &values, |interpolator, method| {
        interpolator.interpolate_many(method, queries)
    })?;
    write_table_of(output, &coordinates, found)
}

/// Interpolates at the cells of a grid.
fn on_grid<M: Triangulation<D, N>, const D: usize, const N: usize>(
    arguments: &Arguments,
    input: &Input,
) -> Result<(), Failure>
where
    Euclidean: StolenMeasures<D, N>,
{
    let Arguments { common, values, grid, bounds, output, .. } = arguments;
    let size = grid.as_ref().map_or(&[][..], |Size(size)| size);
    let size: [usize; D] = size
        .try_into()
        .map_err(|_| usage(ErrorKind::WrongNumberOfValues, format!("--grid needs {D} numbers, not {}", size.len())))?;
    if D == 3 && matches!(output.format(), Format::Tiff) {
        return Err(usage(ErrorKind::ArgumentConflict, "a GeoTIFF has two dimensions: use `--dim 2`, or .npy".into()));
    }
    let (cloud, values) = common.read_with_values::<D>(input, values)?;
    let points = Points::from(&cloud);
    let bounds = match (bounds.len(), points.bounds()) {
        (0, Some(bounds)) => bounds,
        // Without points, there is no value anywhere.
        (0, None) => [[0.0; D], [1.0; D]],
        (count, _) if count == 2 * D => [0, D].map(|first| std::array::from_fn(|axis| bounds[first + axis])),
        (count, _) => {
            let what = format!("--bounds needs {} numbers, not {count}", 2 * D);
            return Err(usage(ErrorKind::WrongNumberOfValues, what));
        }
    };
    let grid = Grid { size, bounds };
    let cells = grid.check().map_err(|error| usage(ErrorKind::ValueValidation, error.to_string()))?;
    let factors = arguments.factors(points)?;
    let scaled = factors.map(|factors| points.scaled(factors));
    let scale = |p: [f64; D]| factors.map_or(p, |factors| std::array::from_fn(|axis| p[axis] * factors[axis]));
    let scaled_grid = Grid { size, bounds: bounds.map(scale) };
    let points = scaled.as_ref().map_or(points, |scaled| Points::F64(scaled));
    let found = arguments.interpolate::<M, D, N>(points, &values, |interpolator, method| {
        interpolator.interpolate_grid(method, &scaled_grid)
    })?;
    let raster = Raster { grid, values: &found };
    match output.format() {
        Format::Npy => write(output, |to| raster.write_npy(to)),
        Format::Tiff => {
            let plane = |p: [f64; D]| [p[0], p[1]];
            let grid = Grid { size: [size[0], size[1]], bounds: bounds.map(plane) };
            write(output, |to| Raster { grid, values: &found }.write_tiff(to))
        }
        Format::Table(_) => {
            let centers: Vec<[f64; D]> = (0..cells).map(|cell| grid.center(cell)).collect();
            write_table_of(output, &centers, found)
        }
    }
}

fn usage(kind: ErrorKind, what: String) -> Failure {
    Failure::Usage(kind, what)
}

/// Writes coordinates and values.
fn write_table_of<const D: usize>(
    output: &ResultOutput<Format>,
    coordinates: &[[f64; D]],
    values: Vec<f64>,
) -> Result<(), Failure> {
    let table = Table::default().with_points("", coordinates).with("value", Column::Numbers(values));
    write(output, |to| match output.format() {
        Format::Table(TableFormat::Npz) => table.write_npz(to),
        _ => table.write_csv(to),
    })
}

impl Arguments {
    /// Returns the queries, and checks that the output is for them.
    fn queries(&self) -> Result<&Queries, Failure> {
        if !matches!(self.output.format(), Format::Table(_)) {
            let what = "rasters need `--grid`; the values at queries are .csv or .npz";
            return Err(usage(ErrorKind::ArgumentConflict, what.into()));
        }
        let what = "give a file with query points, or a grid with `--grid`";
        self.queries.as_ref().ok_or_else(|| usage(ErrorKind::MissingRequiredArgument, what.into()))
    }

    /// Returns the factor of each axis, if there are any.
    fn factors<const D: usize>(&self, points: Points<'_, D>) -> Result<Option<[f64; D]>, Failure> {
        self.rescale.as_ref().map(|rescale| rescale.factors(points)).transpose()
    }

    /// Triangulates the points, and returns the values that `find` finds.
    fn interpolate<M: Triangulation<D, N>, const D: usize, const N: usize>(
        &self,
        points: Points<'_, D>,
        values: &[f64],
        find: impl Fn(&Interpolator<'_, D, N>, Interpolation) -> Result<Interpolated, gdel::Error>,
    ) -> Result<Vec<f64>, Failure>
    where
        Euclidean: StolenMeasures<D, N>,
    {
        let (_, found) = self.common.run::<M, D, N, _>(points, "interpolate", |mesh| {
            let locator = locator(mesh, points, self.exact)?;
            let interpolator = Interpolator::new(&locator, values)?.duplicates(self.duplicates.into())?;
            let Interpolated { values, outside, .. } = find(&interpolator.outside(self.outside), self.method.into())?;
            let numbers = vec![("queries", Number::Count(values.len())), ("outside", Number::Count(outside))];
            Ok(Found { result: values, numbers })
        })?;
        Ok(found)
    }
}
