//! The Laplacian of a graph with weighted edges, and conjugate gradients.

use crate::parallel::{self, Threads};

/// The number of entries whose sum is found by one thread. Sums of these come in order, so that no result depends on
/// the number of threads.
const BLOCK: usize = 1 << 11;

/// Without rounding, there would be at most one step for each unknown. Where cells differ much, there are several.
const MAX_STEPS_PER_UNKNOWN: usize = 50;

/// Up to so many blocks, one thread is as fast as several.
const FEW: usize = 8;

/// The matrix that maps *x* to the sums of c·(xᵢ − xⱼ) over the edges of each vertex *i*: symmetric, positive
/// semidefinite, and zero for constants.
#[derive(Debug, Default)]
pub(super) struct Laplacian {
    /// Where the edges of each vertex start, and one more entry.
    offsets: Vec<usize>,
    /// The other vertex of each edge, and c.
    edges: Vec<(u32, f64)>,
    diagonal: Vec<f64>,
}

impl Laplacian {
    /// Creates the matrix from the edges of each vertex, in order.
    pub(super) fn new<'a>(vertices: impl Iterator<Item = &'a [(u32, f64)]>) -> Self {
        let mut laplacian = Laplacian { offsets: vec![0], ..Laplacian::default() };
        for edges in vertices {
            laplacian.edges.extend_from_slice(edges);
            laplacian.offsets.push(laplacian.edges.len());
            laplacian.diagonal.push(edges.iter().map(|&(_, c)| c).sum());
        }
        laplacian
    }

    /// Returns *x* with L·x = b, up to a constant, where the sum of b is zero, by conjugate gradients that are
    /// preconditioned by the diagonal. The residual is at most `tolerance` times as long as b, and none of its entries
    /// larger than the `limits`, unless rounding keeps it from becoming so small.
    ///
    /// # Errors
    ///
    /// Returns the errors of `check`, which is called with every step.
    pub(super) fn solve<E>(
        &self,
        threads: Threads,
        b: &[f64],
        (tolerance, limits): (f64, &[f64]),
        check: impl Fn() -> Result<(), E>,
    ) -> Result<Vec<f64>, E> {
        let n = b.len();
        let scaled = |i: usize, r: f64| if self.diagonal[i] > 0.0 { r / self.diagonal[i] } else { 0.0 };
        let mut x = vec![0.0; n];
        let mut residual = b.to_vec();
        let mut direction: Vec<f64> = b.iter().enumerate().map(|(i, &r)| scaled(i, r)).collect();
        let mut image = vec![0.0; n];
        let [mut product, mut squared] = sums(threads, &mut residual, |start, block| {
            fold(block.iter().enumerate(), |(k, &r)| [r * scaled(start + k, r), r * r])
        });
        let goal = squared * tolerance * tolerance;
        for _ in 0..MAX_STEPS_PER_UNKNOWN.saturating_mul(n) {
            if squared <= goal && residual.iter().zip(limits).all(|(r, limit)| r.abs() <= *limit) {
                break;
            }
            check()?;
            let [curvature] = sums(threads, &mut image, |start, block| {
                self.multiply(start, &direction, block);
                fold(block.iter().zip(&direction[start..]), |(&q, &p)| [q * p])
            });
            if curvature <= 0.0 {
                break;
            }
            let length = product / curvature;
            sums(threads, &mut x, |start, block| {
                block.iter_mut().zip(&direction[start..]).for_each(|(x, p)| *x += length * p);
                [0.0; 0]
            });
            let before = product;
            [product, squared] = sums(threads, &mut residual, |start, block| {
                fold(block.iter_mut().enumerate(), |(k, r)| {
                    *r -= length * image[start + k];
                    [*r * scaled(start + k, *r), *r * *r]
                })
            });
            let share = product / before;
            sums(threads, &mut direction, |start, block| {
                block.iter_mut().enumerate().for_each(|(k, p)| {
                    *p = scaled(start + k, residual[start + k]) + share * *p;
                });
                [0.0; 0]
            });
        }
        Ok(x)
    }

    /// Multiplies rows from `start` on with a vector.
    fn multiply(&self, start: usize, x: &[f64], block: &mut [f64]) {
        for (k, y) in block.iter_mut().enumerate() {
            let i = start + k;
            let edges = &self.edges[self.offsets[i]..self.offsets[i + 1]];
            *y = edges.iter().fold(self.diagonal[i] * x[i], |sum, &(j, c)| sum - c * x[j as usize]);
        }
    }
}

/// Returns the sums of what `of` makes of items.
fn fold<T, const K: usize>(items: impl Iterator<Item = T>, mut of: impl FnMut(T) -> [f64; K]) -> [f64; K] {
    items.fold([0.0; K], |sum, item| add(sum, of(item)))
}

fn add<const K: usize>(mut a: [f64; K], b: [f64; K]) -> [f64; K] {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
    a
}

/// Calls `work` with each block of a vector and the index of its first entry. Returns the sums of what it returns, in
/// order.
fn sums<const K: usize>(
    threads: Threads,
    vector: &mut [f64],
    work: impl Fn(usize, &mut [f64]) -> [f64; K] + Sync,
) -> [f64; K] {
    let mut blocks: Vec<&mut [f64]> = vector.chunks_mut(BLOCK).collect();
    let threads = if blocks.len() > FEW { threads } else { Threads::One };
    let sums = parallel::map_mut(threads, &mut blocks, |i, block| work(i * BLOCK, block));
    sums.into_iter().fold([0.0; K], add)
}

/// Returns the squared length of a vector.
pub(super) fn squared_norm(threads: Threads, vector: &mut [f64]) -> f64 {
    let [sum] = sums(threads, vector, |_, block| fold(block.iter(), |&x| [x * x]));
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn a_solution_has_the_image_that_was_asked_for_on_any_number_of_threads() {
        // A ring with chords, in several blocks.
        let n = 3 * BLOCK as u32 + 17;
        let c = |i: u32, j: u32| 1.0 + f64::from((i + j) % 7);
        let edges: Vec<Vec<(u32, f64)>> = (0..n)
            .map(|i| [1, n - 1, n / 3, n - n / 3].map(|step| (i + step) % n).map(|j| (j, c(i, j))).to_vec())
            .collect();
        let laplacian = Laplacian::new(edges.iter().map(Vec::as_slice));
        let mut b: Vec<f64> = (0..n).map(|i| f64::from(i * i % 101)).collect();
        let mean = b.iter().sum::<f64>() / f64::from(n);
        b.iter_mut().for_each(|b| *b -= mean);
        let limits = vec![1.0; n as usize];
        let solve = |threads| laplacian.solve(threads, &b, (1e-9, &limits), || Ok::<_, Infallible>(())).unwrap();
        let x = solve(Threads::One);
        let mut image = vec![0.0; n as usize];
        laplacian.multiply(0, &x, &mut image);
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let left: Vec<f64> = image.iter().zip(&b).map(|(y, b)| y - b).collect();
        assert!(norm(&left) < 2e-9 * norm(&b));
        assert_eq!(x, solve(Threads::All));
        assert!(laplacian.solve(Threads::One, &b, (1e-9, &limits), || Err(())).is_err());
    }
}
