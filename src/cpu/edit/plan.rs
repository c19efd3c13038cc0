//! The points that an edit removes and inserts, and their order.

use crate::{
    cpu::Incremental,
    dimension::Dimension,
    error::Error,
    index::NONE,
    input::{
        lattice::Lattice,
        order::{Distinct, Order, insertion_order},
        points::Points,
    },
    parallel::Threads,
};
use rustc_hash::{FxHashMap, FxHashSet};

/// What an edit does with the points of a mesh.
#[derive(Default)]
pub(super) struct Plan {
    /// The vertices to be removed.
    pub(super) removed: Vec<u32>,
    /// The duplicates that take the place of one of these, to be inserted.
    pub(super) heirs: Vec<u32>,
    /// The field `duplicate_of` afterwards, without what the new points duplicate.
    pub(super) duplicate_of: Vec<u32>,
}

impl Plan {
    /// Plans to remove points, and to add some until there are so many. If the field `before` is
    /// not one of a mesh, returns as an error which points are unused.
    pub(super) fn new(before: &[u32], points: usize, removed: &[u32]) -> Result<Self, Vec<u32>> {
        let mut duplicate_of = Vec::with_capacity(points);
        duplicate_of.extend_from_slice(before);
        duplicate_of.resize(points, NONE);
        for &i in removed {
            duplicate_of[i as usize] = i;
        }
        let mut plan = Plan::default();
        let mut heir_of = FxHashMap::default();
        for &i in removed.iter().filter(|&&i| before[i as usize] == NONE) {
            plan.removed.push(i);
            heir_of.insert(i, NONE);
        }
        let mut is_valid = true;
        for (i, &first) in (0..).zip(before) {
            // Of the duplicates, the lowest index stands for a point.
            if first == NONE || first == i {
                continue;
            }
            is_valid &= (0..i).contains(&first) && before[first as usize] == NONE;
            if let Some(heir) = heir_of.get_mut(&first)
                && duplicate_of[i as usize] != i
            {
                if *heir == NONE {
                    *heir = i;
                    plan.heirs.push(i);
                    duplicate_of[i as usize] = NONE;
                } else {
                    duplicate_of[i as usize] = *heir;
                }
            }
        }
        if !is_valid {
            // What is unused is still known.
            let unused = |(i, first): (u32, &mut u32)| *first = if *first == i { i } else { NONE };
            (0..).zip(&mut duplicate_of).for_each(unused);
            return Err(duplicate_of);
        }
        plan.duplicate_of = duplicate_of;
        Ok(plan)
    }
}

/// Checks that the points with these indices can be removed from a mesh with this field
/// `duplicate_of`.
///
/// # Errors
///
/// Returns [`Error::BadIndex`].
pub(super) fn check_indices(duplicate_of: &[u32], removed: &[u32]) -> Result<(), Error> {
    let mut seen = FxHashSet::default();
    for &index in removed {
        let reason = match duplicate_of.get(index as usize) {
            None => "there is no such point",
            Some(&first) if first == index => "it was removed before",
            Some(_) if !seen.insert(index) => "it is given twice",
            Some(_) => continue,
        };
        return Err(Error::BadIndex { index, reason });
    }
    Ok(())
}

/// Returns these points in an order in which each is near the one before; `None` if two are equal.
pub(super) fn in_order<const D: usize>(
    threads: Threads,
    points: Points<'_, D>,
    lattice: &Lattice<D>,
    indices: &[u32],
) -> Option<Vec<u32>>
where
    Dimension<D>: Incremental<D>,
{
    let points: Vec<[f64; D]> = indices.iter().map(|&i| points.get(i as usize)).collect();
    let Distinct { order, .. } =
        insertion_order(threads, Points::F64(&points), lattice, Dimension::<D>::CURVE, Order::Brio);
    (order.len() == indices.len()).then(|| order.into_iter().map(|i| indices[i as usize]).collect())
}

/// Returns the new points in an order in which each is near the one before, without those that
/// duplicate another new one, which are noted.
pub(super) fn order_of_new<const D: usize>(
    threads: Threads,
    points: Points<'_, D>,
    lattice: &Lattice<D>,
    known: usize,
    duplicate_of: &mut [u32],
) -> Vec<u32>
where
    Dimension<D>: Incremental<D>,
{
    let new = points.range(known..points.len());
    let Distinct { order, duplicate_of: of_new, .. } =
        insertion_order(threads, new, lattice, Dimension::<D>::CURVE, Order::Brio);
    for (first, of_new) in duplicate_of[known..].iter_mut().zip(of_new) {
        *first = if of_new == NONE { NONE } else { of_new + known as u32 };
    }
    order.into_iter().map(|i| i + known as u32).collect()
}
