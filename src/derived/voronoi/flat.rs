//! Cells of points in a plane or on a line, in their own dimension.

use super::{
    super::{
        Locator,
        flat::{Flat, Frame, Shape, in_space, triangulate},
    },
    Cell, Clip, Voronoi, VoronoiShapes, check_box,
};
use crate::{
    error::Error,
    geometry::{Euclidean, vector},
    index::NONE,
};

/// Returns the cell of each point, if the points do not span all dimensions and what the cells are clipped
/// to has no inside, either.
pub(super) fn cells<const D: usize, const N: usize>(
    locator: &Locator<'_, D, N>,
    clip: &Clip<'_, D>,
) -> Result<Option<Vec<Cell<D>>>, Error>
where
    Euclidean: VoronoiShapes<D, N>,
{
    let Some(Flat { shape, .. }) = &locator.flat else { return Ok(None) };
    let mut cells = vec![Cell::default(); locator.complex.points().len()];
    match (clip, shape) {
        (Clip::Convex(_), _) => return Ok(None),
        (Clip::Box([low, high]), _) => {
            let complex = &locator.complex;
            check_box([*low, *high], |axis| {
                low[axis] == high[axis] && complex.vertices().all(|v| complex.point(v)[axis] == low[axis])
            })?;
            let flat: Vec<usize> = (0..D).filter(|&axis| low[axis] == high[axis]).collect();
            match flat[..] {
                [] => return Ok(None),
                [axis] if D == 3 => in_plane(locator, axis, &[*low, *high], &mut cells)?,
                _ => on_line(locator, shape, Some(&[*low, *high]), &mut cells),
            }
        }
        (_, Shape::Line { vertices, .. }) => {
            let ends = [vertices[0], vertices[vertices.len() - 1]].map(|v| locator.complex.point(v));
            on_line(locator, shape, (*clip == Clip::Hull).then_some(&ends), &mut cells);
        }
        (_, Shape::Plane(plane)) => {
            let clip = if *clip == Clip::Hull { Clip::Hull } else { Clip::None };
            let voronoi = Voronoi::<2, 3>::new(&plane.mesh, &plane.points, clip)?;
            lift(&voronoi, &plane.frame, &plane.vertices, &mut cells);
        }
    }
    Ok(Some(cells))
}

/// Finds the cells within a box that has no extent along an axis of space.
fn in_plane<const D: usize, const N: usize>(
    locator: &Locator<'_, D, N>,
    axis: usize,
    bounds: &[[f64; D]; 2],
    cells: &mut [Cell<D>],
) -> Result<(), Error>
where
    Euclidean: VoronoiShapes<D, N>,
{
    let frame = Frame::Aligned { axis, at: bounds[0][axis] };
    let complex = &locator.complex;
    let vertices: Vec<u32> = complex.vertices().collect();
    let project = |p: [f64; D]| frame.project(in_space(p));
    let points: Vec<[f64; 2]> = vertices.iter().map(|&v| project(complex.point(v))).collect();
    let weights: Vec<f64> =
        if complex.weights.is_empty() { Vec::new() } else { vertices.iter().map(|&v| complex.weight(v)).collect() };
    let mesh = triangulate::<2>(&points, &weights)?;
    let voronoi = Voronoi::<2, 3>::new(&mesh, &points, Clip::Box(bounds.map(project)))?;
    lift(&voronoi, &frame, &vertices, cells);
    Ok(())
}

/// Puts the cells of a plane into space.
fn lift<const D: usize>(voronoi: &Voronoi<'_, 2, 3>, frame: &Frame, vertices: &[u32], cells: &mut [Cell<D>]) {
    let lifted = |p: [f64; 2]| {
        let p = frame.lift(p);
        std::array::from_fn(|axis| p[axis])
    };
    for (v, cell) in voronoi.map_cells(|v, cell| (v, cell.clone())) {
        let is_bounded = cell.is_bounded;
        cells[vertices[v as usize] as usize] = Cell {
            vertices: cell.vertices.iter().map(|&vertex| lifted(vertex)).collect(),
            simplices: vec![NONE; cell.vertices.len()],
            neighbors: cell.neighbors.iter().map(|&w| if w == NONE { NONE } else { vertices[w as usize] }).collect(),
            centroid: if cell.centroid[0].is_nan() { [f64::NAN; D] } else { lifted(cell.centroid) },
            facets: cell.facets,
            areas: cell.areas,
            volume: cell.volume,
            is_bounded,
        };
    }
}

/// Finds the cells of points on a line, within bounds if there are any.
fn on_line<const D: usize, const N: usize>(
    locator: &Locator<'_, D, N>,
    shape: &Shape,
    bounds: Option<&[[f64; D]; 2]>,
    cells: &mut [Cell<D>],
) where
    Euclidean: VoronoiShapes<D, N>,
{
    let Shape::Line { vertices, axis } = shape else { return };
    // Equal points have no line.
    if vertices.len() < 2 {
        return;
    }
    let point = |v: u32| locator.complex.point(v);
    let middle = |v: u32, w: u32| {
        let difference = locator.complex.weight(v) - locator.complex.weight(w);
        middle(point(v), point(w), difference)
    };
    // The bounds of the hull are its ends; those of a box have the line as their only extent.
    let (first, last) = (point(vertices[0]), point(vertices[vertices.len() - 1]));
    let [low, high] = bounds.map_or([first, last], |&[low, high]| {
        let at = |x: f64, end: [f64; D]| {
            let mut p = end;
            p[*axis] = x;
            p
        };
        [(low, first), (high, last)]
            .map(|(corner, end)| if corner[*axis] == end[*axis] { end } else { at(corner[*axis], end) })
    });
    for (place, &v) in vertices.iter().enumerate() {
        let neighbors = [place.checked_sub(1).map(|before| vertices[before]), vertices.get(place + 1).copied()];
        let cell = &mut cells[v as usize];
        let ends = [(0, low), (1, high)].map(|(side, bound): (usize, [f64; D])| {
            let Some(neighbor) = neighbors[side] else { return bounds.map(|_| (bound, NONE)) };
            // The same for both.
            let end = if side == 0 { middle(neighbor, v) } else { middle(v, neighbor) };
            let is_beyond = if side == 0 { end[*axis] < bound[*axis] } else { end[*axis] > bound[*axis] };
            Some(if bounds.is_some() && is_beyond { (bound, NONE) } else { (end, neighbor) })
        });
        if let [Some((from, _)), Some((to, _))] = ends {
            // Nothing is left of a cell beyond the bounds.
            if from[*axis] >= to[*axis] {
                continue;
            }
            cell.volume = vector::norm(vector::minus(to, from));
            cell.centroid = vector::plus(vector::times(0.5, from), vector::times(0.5, to));
        } else {
            (cell.volume, cell.is_bounded) = (f64::INFINITY, false);
        }
        for (end, neighbor) in ends.into_iter().flatten() {
            cell.facets.push([cell.vertices.len() as u32]);
            cell.vertices.push(end);
            cell.simplices.push(NONE);
            cell.neighbors.push(neighbor);
            cell.areas.push(1.0);
        }
    }
}

/// Returns the place on the line of two points where their power distances are equal, if the weight of the first one is
/// greater by a difference. It may be infinite.
fn middle<const D: usize>(p: [f64; D], q: [f64; D], difference: f64) -> [f64; D] {
    let middle = vector::plus(vector::times(0.5, p), vector::times(0.5, q));
    if difference == 0.0 {
        return middle;
    }
    let to = vector::minus(q, p);
    let length = vector::norm(to);
    let share = 0.5 * difference / length / length;
    // Not 0 times infinity.
    std::array::from_fn(|axis| if to[axis] == 0.0 { middle[axis] } else { middle[axis] + share * to[axis] })
}
