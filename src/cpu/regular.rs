//! Weighted points: the regular triangulation, whose dual is the power diagram (Aurenhammer 1987).
//!
//! Point *i* is lifted to the height |pᵢ|² − wᵢ, and the triangulation is the lower side of the convex hull of the
//! lifted points. Ties are those of points without weights, so that the answer is unique, too. A point above that hull
//! is *hidden*: it is no vertex. Of equal points only the heaviest counts; of those, the one with the lowest index.

use crate::{
    cpu::{Incremental, MeshOf, triangulate_in_order},
    dimension::Dimension,
    error::Error,
    index::NONE,
    input::{order::Order, points::Points},
    options::Options,
};

/// Returns the regular triangulation of `points`, which is the Delaunay triangulation if all weights are equal.
///
/// # Errors
///
/// Returns the errors of [`Triangulator::regular3d`](crate::Triangulator::regular3d).
pub fn regular<const D: usize>(points: Points<'_, D>, weights: &[f64], options: &Options) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Incremental<D>,
{
    regular_in_order(points, weights, options, Order::default())
}

/// Returns the regular triangulation of `points`, by insertion in a given order.
///
/// # Errors
///
/// Returns the errors of [`Triangulator::regular3d`](crate::Triangulator::regular3d).
pub fn regular_in_order<const D: usize>(
    points: Points<'_, D>,
    weights: &[f64],
    options: &Options,
    order: Order,
) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Incremental<D>,
{
    if are_equal(points.len(), weights)? {
        triangulate_in_order::<D, false>(points, &[], options, order)
    } else {
        triangulate_in_order::<D, true>(points, weights, options, order)
    }
}

/// Checks weights, and returns whether all are equal, so that they change nothing.
///
/// # Errors
///
/// Returns [`Error::ValueCount`] unless there is one per point, and [`Error::BadWeight`] with the first that is not
/// finite.
pub(crate) fn are_equal(points: usize, weights: &[f64]) -> Result<bool, Error> {
    if weights.len() != points {
        return Err(Error::ValueCount { values: weights.len(), points });
    }
    match weights.iter().position(|w| !w.is_finite()) {
        Some(index) => Err(Error::BadWeight { index }),
        None => Ok(weights.windows(2).all(|pair| pair[0] == pair[1])),
    }
}

/// Returns the weights of balls with these radii, which are rounded.
///
/// # Errors
///
/// Returns [`Error::BadRadius`] with the first that is negative or NaN.
pub fn weights_of_radii(radii: &[f64]) -> Result<Vec<f64>, Error> {
    let is_bad = |r: &f64| r.is_nan() || *r < 0.0;
    match radii.iter().position(is_bad) {
        Some(index) => Err(Error::BadRadius { index }),
        None => Ok(radii.iter().map(|r| r * r).collect()),
    }
}

/// Lets the heaviest of equal points stand for the others, in place of the first, as in `order` of the distinct points.
pub(super) fn keep_heaviest(weights: &[f64], order: &mut [u32], duplicate_of: &mut [u32]) {
    if duplicate_of.iter().all(|&first| first == NONE) {
        return;
    }
    let mut heaviest: Vec<u32> = (0..duplicate_of.len() as u32).collect();
    for (i, &first) in (0..).zip(&*duplicate_of).filter(|&(_, &first)| first != NONE) {
        let so_far = &mut heaviest[first as usize];
        if weights[i as usize] > weights[*so_far as usize] {
            *so_far = i;
        }
    }
    for (i, entry) in (0..).zip(&mut *duplicate_of) {
        let first = if *entry == NONE { i } else { *entry };
        let stands = heaviest[first as usize];
        *entry = if stands == i { NONE } else { stands };
    }
    order.iter_mut().for_each(|v| *v = heaviest[*v as usize]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mesh2, Mesh3, random::Random};
    use proptest::prelude::*;
    use std::num::NonZeroUsize;

    fn options(threads: usize) -> Options {
        Options { threads: NonZeroUsize::new(threads), ..Options::default() }
    }

    /// Checks that any number of threads makes the mesh of one thread.
    fn check3(points: &[[f64; 3]], weights: &[f64]) -> Result<(), TestCaseError> {
        let expected: Mesh3 = regular::<3>(points.into(), weights, &options(1))?;
        for threads in [2, 3, 8, 16] {
            for order in [Order::Brio, Order::Shuffled(1)] {
                let mesh: Mesh3 = regular_in_order::<3>(points.into(), weights, &options(threads), order)?;
                prop_assert!(mesh.canonical() == expected.canonical(), "{} threads, {:?}", threads, order);
                prop_assert_eq!((&mesh.hidden, &mesh.duplicate_of), (&expected.hidden, &expected.duplicate_of));
                let report = crate::verify3d(points, &mesh)?;
                prop_assert!(report.passed(), "{} threads, {:?}:\n{}", threads, order, report);
            }
        }
        Ok(())
    }

    /// Checks that any number of threads makes the mesh of one thread.
    fn check2(points: &[[f64; 2]], weights: &[f64]) -> Result<(), TestCaseError> {
        let expected: Mesh2 = regular::<2>(points.into(), weights, &options(1))?;
        for threads in [2, 3, 8, 16] {
            for order in [Order::Brio, Order::Shuffled(1)] {
                let mesh: Mesh2 = regular_in_order::<2>(points.into(), weights, &options(threads), order)?;
                prop_assert!(mesh.canonical() == expected.canonical(), "{} threads, {:?}", threads, order);
                prop_assert_eq!((&mesh.hidden, &mesh.duplicate_of), (&expected.hidden, &expected.duplicate_of));
                let report = crate::verify2d(points, &mesh)?;
                prop_assert!(report.passed(), "{} threads, {:?}:\n{}", threads, order, report);
            }
        }
        Ok(())
    }

    /// At most `max` points of an integer grid with few points along some axes, and their weights, of which some hide all
    /// points near.
    fn grid<const D: usize>(max: usize) -> impl Strategy<Value = (Vec<[f64; D]>, Vec<f64>)> {
        let sides = prop::array::uniform::<_, D>(prop::sample::select(vec![2u32, 3, 7, 40]));
        let heaviest = prop::sample::select(vec![1.0, 4.0, 50.0, 1000.0]);
        (sides, heaviest, 0..=max, any::<u64>()).prop_map(|(sides, heaviest, count, seed)| {
            let mut random = Random::new(seed);
            let points = (0..count).map(|_| sides.map(|side| (random.unit() * f64::from(side)).floor())).collect();
            let mut weight = || (random.unit() * random.unit() * heaviest * 4.0).floor() / 4.0;
            (points, (0..count).map(|_| weight()).collect())
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn threads_agree_on_grids((points, weights) in grid::<3>(600)) { check3(&points, &weights)?; }

        #[test]
        fn threads_agree_on_2d_grids((points, weights) in grid::<2>(900)) { check2(&points, &weights)?; }
    }

    /// Points of the parabola's shape and its opposite: each vertex hides many, or none.
    #[test]
    fn threads_agree_where_each_point_hides_the_last_ones() {
        let mut random = Random::new(3);
        let points: Vec<[f64; 2]> = (0..3000).map(|_| [random.unit(), random.unit()]).collect();
        // Later ones along the diagonal are much heavier.
        let weights: Vec<f64> = points.iter().map(|[x, y]| 5.0 * (x + y) * (x + y) * random.unit()).collect();
        check2(&points, &weights).unwrap();
        let points: Vec<[f64; 3]> = (0..2000).map(|_| [random.unit(), random.unit(), random.unit()]).collect();
        let weights: Vec<f64> = points.iter().map(|p| 0.1 * p[0] * random.unit()).collect();
        check3(&points, &weights).unwrap();
    }
}
