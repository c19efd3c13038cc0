//! Interpolation at many places at once: weights for many columns of values, and grids.

use super::{Interpolated, Interpolation, Interpolator, Query, State, StolenMeasures, check_weights};
use crate::{
    derived::{queries::along_curve, voronoi::check_box},
    error::Error,
    geometry::Euclidean,
    input::points::Points,
    parallel::{self, Threads},
};

/// The weights of the points at many queries, as a sparse matrix in compressed rows, for many columns of
/// values: see [`Interpolator::weights_many`].
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct WeightTable {
    /// Where the entries of each query start, and one more that says where the last ones end.
    pub offsets: Vec<usize>,
    /// The point of each entry.
    pub points: Vec<u32>,
    /// The weight of each entry.
    pub weights: Vec<f64>,
    /// How many queries were outside the hull.
    pub outside: usize,
    /// The value of queries without entries, which are outside.
    constant: f64,
    /// The number of points of the mesh.
    point_count: usize,
}

impl WeightTable {
    /// Returns the interpolated value at each query of values at the points. What the interpolator was
    /// told about [duplicates](Interpolator::duplicates) does not count: the values are those of the vertices.
    ///
    /// # Errors
    ///
    /// [`Error::ValueCount`] if there are not as many values as points.
    pub fn apply(&self, values: &[f64]) -> Result<Vec<f64>, Error> {
        if values.len() != self.point_count {
            return Err(Error::ValueCount { values: values.len(), points: self.point_count });
        }
        Ok(parallel::joined(parallel::map_ranges(Threads::All, self.offsets.len().saturating_sub(1), |range| {
            let value = |query: usize| {
                let entries = self.offsets[query]..self.offsets[query + 1];
                if entries.is_empty() {
                    return self.constant;
                }
                // A weight of 0 does not spread NaN and infinities.
                let terms = self.points[entries.clone()].iter().zip(&self.weights[entries]);
                terms.filter(|(_, weight)| **weight != 0.0).map(|(&v, weight)| weight * values[v as usize]).sum()
            };
            range.map(value).collect::<Vec<f64>>()
        })))
    }
}

/// Queries in the centres of the cells of a regular grid, the pixels of a raster in 2D.
///
/// In 2D, as in images, the first row is the one with the largest *y*. In 3D, the first layer is that with
/// the lowest *z*, and in it the first row that with the lowest *y*. In a row *x* grows.
///
/// # Examples
///
/// ```
/// use gdel::{Grid, Interpolation, Interpolator, Locator};
///
/// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 2.0], [4.0, 2.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let locator = Locator::new(&mesh, &points)?;
/// let interpolator = Interpolator::new(&locator, &[0.0, 4.0, 20.0, 24.0])?;
/// let grid = Grid { size: [4, 2], bounds: [[0.0, 0.0], [4.0, 2.0]] };
/// let raster = interpolator.interpolate_grid(Interpolation::Linear, &grid)?;
/// assert_eq!(raster.values, [15.5, 16.5, 17.5, 18.5, 5.5, 6.5, 7.5, 8.5]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid<const D: usize = 2> {
    /// The number of cells along each axis.
    pub size: [usize; D],
    /// The lowest and the highest corner of the grid.
    pub bounds: [[f64; D]; 2],
}

impl<const D: usize> Grid<D> {
    /// Returns the number of cells.
    ///
    /// # Errors
    ///
    /// [`Error::EmptyBox`] if the lowest corner is not below the highest, or not finite, and
    /// [`Error::BadOption`] if there are 2³² cells or more.
    pub fn check(&self) -> Result<usize, Error> {
        check_box(self.bounds, |_| false)?;
        let cells = self.size.iter().try_fold(1usize, |cells, &size| cells.checked_mul(size));
        cells
            .filter(|&cells| cells <= u32::MAX as usize)
            .ok_or(Error::BadOption { option: "the number of cells of a grid", range: "below 2³²" })
    }

    /// Returns the centre of a cell.
    pub fn center(&self, cell: usize) -> [f64; D] {
        let [low, high] = self.bounds;
        let mut rest = cell;
        std::array::from_fn(|axis| {
            let mut place = rest % self.size[axis];
            rest /= self.size[axis];
            if D == 2 && axis == 1 {
                place = self.size[1] - 1 - place;
            }
            // The halves do not overflow, and the same part of each side has the same place on all machines.
            let part = (place as f64 + 0.5) / self.size[axis] as f64;
            low[axis] + part * (high[axis] - low[axis])
        })
    }
}

/// The cells of a tile along each axis: as many as one thread takes at a time.
const fn tile_size<const D: usize>() -> [usize; D] {
    let mut size = [16; D];
    if D == 2 {
        size = [32; D];
    }
    size
}

impl<const D: usize> Grid<D> {
    /// Returns the first cell along each axis of each tile.
    fn tiles(&self) -> Vec<[usize; D]> {
        let size = tile_size::<D>();
        let counts: [usize; D] = std::array::from_fn(|axis| self.size[axis].div_ceil(size[axis]));
        let first = |tile: usize| {
            let mut rest = tile;
            std::array::from_fn(|axis| {
                let place = rest % counts[axis];
                rest /= counts[axis];
                place * size[axis]
            })
        };
        (0..counts.iter().product()).map(first).collect()
    }

    /// Returns the cells of a tile, of which consecutive ones are near each other.
    fn cells_of(&self, first: &[usize; D]) -> impl Iterator<Item = usize> + '_ {
        let first = *first;
        let counts: [usize; D] = std::array::from_fn(|axis| tile_size::<D>()[axis].min(self.size[axis] - first[axis]));
        (0..counts.iter().product::<usize>()).map(move |i| {
            let (mut rest, mut cell, mut stride) = (i, 0, 1);
            let row = i / counts[0];
            for axis in 0..D {
                let mut place = rest % counts[axis];
                rest /= counts[axis];
                // Rows are there and back.
                if axis == 0 && row % 2 == 1 {
                    place = counts[0] - 1 - place;
                }
                cell += (first[axis] + place) * stride;
                stride *= self.size[axis];
            }
            cell
        })
    }
}

impl<const D: usize, const N: usize> Interpolator<'_, D, N>
where
    Euclidean: StolenMeasures<D, N>,
{
    /// Returns the interpolated value at the centre of each cell of a grid: the same as
    /// [`interpolate_many`](Self::interpolate_many) of these, in less time.
    ///
    /// # Errors
    ///
    /// Those of [`interpolate`](Self::interpolate) and of [`Grid::check`].
    pub fn interpolate_grid(&self, method: Interpolation, grid: &Grid<D>) -> Result<Interpolated, Error> {
        self.check(method)?;
        let mut values = vec![0.0; grid.check()?];
        let mut outside = 0;
        let tiles = grid.tiles();
        let reach = self.locator.reach(Points::F64(&[]));
        let found = parallel::map_grains(Threads::All, tiles.len(), 1, |range| {
            let (mut run, mut state) = (Vec::new(), State::default());
            let mut found = Vec::new();
            for tile in &tiles[range] {
                run.clear();
                run.extend(grid.cells_of(tile).map(|cell| grid.center(cell)));
                let places = self.locator.places(&run, reach)?;
                for (i, &at) in run.iter().enumerate() {
                    let query = Query { at, reach, place: places.as_ref().map(|places| places[i]) };
                    found.push(self.value_at(method, &query, &mut state)?);
                }
            }
            Ok(found)
        });
        let mut cells = tiles.iter().flat_map(|tile| grid.cells_of(tile));
        for part in found {
            for ((value, is_outside), cell) in part?.into_iter().zip(&mut cells) {
                values[cell] = value;
                outside += usize::from(is_outside);
            }
        }
        Ok(Interpolated { values, outside })
    }

    /// Returns the weights of the points at many queries.
    ///
    /// # Errors
    ///
    /// The same as for [`weights`](Self::weights).
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Interpolation, Interpolator, Locator};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let locator = Locator::new(&mesh, &points)?;
    /// let interpolator = Interpolator::new(&locator, &[0.0; 3])?;
    /// let table = interpolator.weights_many(Interpolation::Linear, &[[1.0, 2.0], [9.0, 9.0], [4.0, 0.0f64]])?;
    /// assert_eq!(table.offsets, [0, 3, 3, 4]);
    /// let heights = table.apply(&[0.0, 4.0, 8.0])?;
    /// assert!(heights[0] == 5.0 && heights[1].is_nan() && heights[2] == 4.0);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn weights_many<'q>(
        &self,
        method: Interpolation,
        queries: impl Into<Points<'q, D>>,
    ) -> Result<WeightTable, Error> {
        check_weights(method)?;
        let queries = queries.into();
        let reach = self.locator.reach(queries);
        let (order, runs) = along_curve(queries, self.locator.key, |run| {
            let mut state = State::default();
            let places = self.locator.places(run, reach)?;
            let (mut ends, mut entries, mut outside) = (Vec::with_capacity(run.len()), Vec::new(), 0);
            for (i, &at) in run.iter().enumerate() {
                let query = Query { at, reach, place: places.as_ref().map(|places| places[i]) };
                outside += usize::from(self.find_weights(method, &query, &mut state)?);
                entries.extend_from_slice(&state.weights);
                ends.push(entries.len());
            }
            Ok((ends, entries, outside))
        })?;
        let mut table = WeightTable {
            offsets: vec![0; queries.len() + 1],
            constant: self.constant(),
            point_count: self.values.len(),
            ..WeightTable::default()
        };
        let mut in_order = order.iter();
        for (ends, _, outside) in &runs {
            table.outside += outside;
            let starts = std::iter::once(&0).chain(ends);
            for ((start, end), &query) in starts.zip(ends).zip(&mut in_order) {
                table.offsets[query as usize + 1] = end - start;
            }
        }
        for query in 0..queries.len() {
            table.offsets[query + 1] += table.offsets[query];
        }
        let count = table.offsets[queries.len()];
        (table.points, table.weights) = (vec![0; count], vec![0.0; count]);
        let mut in_order = order.iter();
        for (ends, entries, _) in &runs {
            let starts = std::iter::once(&0).chain(ends);
            for ((&start, &end), &query) in starts.zip(ends).zip(&mut in_order) {
                let to = table.offsets[query as usize]..;
                for (place, &(v, weight)) in to.zip(&entries[start..end]) {
                    (table.points[place], table.weights[place]) = (v, weight);
                }
            }
        }
        Ok(table)
    }
}
