//! Gradients at the vertices, for interpolation that is smooth.
//!
//! Along each edge, the values and slopes of its ends determine a cubic. The gradients are those for
//! which the sum of the integrals of the squares of their second derivatives is least (Nielson 1983;
//! Renka and Cline 1984), as in SciPy. Solved for one vertex after the other, the system converges: the
//! matrix of such a step has eigenvalues of at most 1/2. So Chebyshev's iteration needs 28 steps,
//! whatever the mesh, and the result does not depend on the number of threads.

use super::super::{
    Locator,
    complex::Complex,
    flat::{Flat, Shape, in_space},
    queries::order_along_curve,
};
use crate::{
    geometry::{Euclidean, Geometry, vector},
    mesh::Csr,
    parallel::{self, Threads},
};

/// The number of steps after which the error is below rounding: 2·0.268²⁸ is 2⁻⁵².
const STEPS: usize = 28;

/// The largest eigenvalue of a step that solves for each vertex.
const RADIUS: f64 = 0.5;

/// Returns the gradient at each vertex; 0 at other points, and where there are too few edges between
/// finite values.
pub(super) fn gradients<const D: usize, const N: usize>(locator: &Locator<'_, D, N>, values: &[f64]) -> Vec<[f64; D]>
where
    Euclidean: Geometry<D, N>,
{
    let system = System::new(locator, values);
    let mut last = vec![[0.0; D]; values.len()];
    let mut now = system.map(|i| system.solve(i, &last));
    let mut weight = 1.0 / (1.0 - RADIUS * RADIUS / 2.0);
    for _ in 1..STEPS {
        let next = system.map(|i| {
            let (solved, before) = (system.solve(i, &now), last[i]);
            std::array::from_fn(|axis| before[axis] + weight * (solved[axis] - before[axis]))
        });
        (last, now) = (now, next);
        weight = 1.0 / (1.0 - RADIUS * RADIUS / 4.0 * weight);
    }
    let mut gradients = vec![[0.0; D]; values.len()];
    for (&i, gradient) in system.order.iter().zip(now) {
        gradients[i as usize] = vector::times(locator.scale, gradient);
    }
    gradients
}

/// One system of equations per vertex, in an order in which neighbours are near each other in memory.
struct System<const D: usize> {
    /// The index of each point in the input.
    order: Vec<u32>,
    /// The places of the neighbours of each.
    neighbors: Csr,
    /// For each of these, the unit vector towards it, times the root of the weight of the edge.
    ways: Vec<[f64; D]>,
    /// For each point the gradient if those of its neighbours were 0, and the inverse of its matrix.
    vertices: Vec<([f64; D], [[f64; D]; D])>,
}

impl<const D: usize> System<D> {
    fn new<const N: usize>(locator: &Locator<'_, D, N>, values: &[f64]) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        let order = order_along_curve(locator.complex.points(), locator.key);
        let mut place_of = vec![0; order.len()];
        for (place, &i) in (0..).zip(&order) {
            place_of[i as usize] = place;
        }
        let mut neighbors = Csr::default();
        let of_points = locator.vertex_neighbors();
        for &i in &order {
            neighbors.push(of_points.of(i).iter().map(|&j| place_of[j as usize]));
        }
        let beside = locator.flat.as_ref().map_or([[0.0; D]; D], |flat| beside(flat, &locator.complex));
        let mut system = System { order, neighbors, ways: Vec::new(), vertices: Vec::new() };
        let point = |place: usize| vector::times(locator.scale, locator.complex.point(system.order[place]));
        let value = |place: usize| values[system.order[place] as usize];
        let parts = parallel::map_ranges(Threads::All, values.len(), |range| {
            let (mut ways, mut vertices) = (Vec::new(), Vec::with_capacity(range.len()));
            for i in range {
                let (from, own) = (point(i), value(i));
                let edges = system.neighbors.of(i as u32).iter().map(|&j| {
                    let way = vector::minus(point(j as usize), from);
                    (way, vector::norm(way), value(j as usize) - own)
                });
                let shortest = edges.clone().map(|(_, length, _)| length).fold(f64::INFINITY, f64::min);
                let (mut matrix, mut sum) = (beside, [0.0; D]);
                for (way, length, difference) in edges {
                    // Where a value is missing, or the slope is beyond all bounds, there is no edge.
                    let slope = difference / length;
                    let root = if slope.is_finite() { (shortest / length).sqrt() } else { 0.0 };
                    let slope = if slope.is_finite() { slope } else { 0.0 };
                    let way = way.map(|x| x / length * root);
                    for (row, x) in matrix.iter_mut().zip(way) {
                        *row = vector::plus(*row, vector::times(2.0 * x, way));
                    }
                    sum = vector::plus(sum, vector::times(3.0 * slope * root, way));
                    ways.push(way);
                }
                let inverse = inverse_of(matrix).unwrap_or([[0.0; D]; D]);
                vertices.push((inverse.map(|row| vector::dot(row, sum)), inverse));
            }
            (ways, vertices)
        });
        let (ways, vertices): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        (system.ways, system.vertices) = (parallel::joined(ways), parallel::joined(vertices));
        system
    }

    /// Returns what `f` returns for each place.
    fn map<R: Send + Clone>(&self, f: impl Fn(usize) -> R + Sync) -> Vec<R> {
        let parts = parallel::map_ranges(Threads::All, self.order.len(), |range| range.map(&f).collect::<Vec<_>>());
        parallel::joined(parts)
    }

    /// Returns the gradient at a vertex for which the sum of the integrals over its edges is least, if the
    /// gradients of its neighbours are these.
    fn solve(&self, i: usize, gradients: &[[f64; D]]) -> [f64; D] {
        let mut sum = [0.0; D];
        let range = self.neighbors.offsets[i]..self.neighbors.offsets[i + 1];
        for (&j, &way) in self.neighbors.indices[range.clone()].iter().zip(&self.ways[range]) {
            sum = vector::plus(sum, vector::times(vector::dot(way, gradients[j as usize]), way));
        }
        let (alone, inverse) = &self.vertices[i];
        std::array::from_fn(|row| alone[row] - vector::dot(inverse[row], sum))
    }
}

/// Returns the projection onto what is perpendicular to flat points.
fn beside<const D: usize, const N: usize>(flat: &Flat, complex: &Complex<'_, D, N>) -> [[f64; D]; D] {
    let mut projection: [[f64; D]; D] =
        std::array::from_fn(|row| std::array::from_fn(|column| f64::from(u8::from(row == column))));
    let axes = match &flat.shape {
        Shape::Line { vertices, .. } => {
            let [first, last] = [vertices[0], vertices[vertices.len() - 1]].map(|v| in_space(complex.point(v)));
            let way = vector::minus(vector::times(0.5, last), vector::times(0.5, first));
            let length = vector::norm(way);
            if length > 0.0 { vec![way.map(|x| x / length)] } else { Vec::new() }
        }
        Shape::Plane(plane) => plane.frame.axes().to_vec(),
    };
    for axis in axes {
        for (row, x) in projection.iter_mut().zip(axis) {
            for (entry, y) in row.iter_mut().zip(axis) {
                *entry -= x * y;
            }
        }
    }
    projection
}

/// Returns the inverse of a symmetric matrix; `None` if it is not positive definite.
fn inverse_of<const D: usize>(matrix: [[f64; D]; D]) -> Option<[[f64; D]; D]> {
    // The Cholesky factor, which no scale of an axis makes less precise.
    let mut factor = [[0.0; D]; D];
    for row in 0..D {
        for column in 0..=row {
            let known: f64 = (0..column).map(|k| factor[row][k] * factor[column][k]).sum();
            let rest = matrix[row][column] - known;
            factor[row][column] = if row == column {
                // Neither for NaN.
                let is_positive = rest > 0.0;
                is_positive.then_some(rest)?.sqrt()
            } else {
                rest / factor[column][column]
            };
        }
    }
    let mut inverse = [[0.0; D]; D];
    for (k, column) in inverse.iter_mut().enumerate() {
        for row in 0..D {
            let known: f64 = (0..row).map(|j| factor[row][j] * column[j]).sum();
            column[row] = (f64::from(u8::from(row == k)) - known) / factor[row][row];
        }
        for row in (0..D).rev() {
            let known: f64 = (row + 1..D).map(|j| factor[j][row] * column[j]).sum();
            column[row] = (column[row] - known) / factor[row][row];
        }
    }
    Some(inverse)
}
