//! The arrays of a triangulation under construction: the vertices and the neighbours of each slot.

use crate::error::Error;

/// Reserves memory for this many slots in all.
///
/// # Errors
///
/// Returns [`Error::OutOfMemory`].
pub(crate) fn reserve<const N: usize>(
    simplices: &mut Vec<[u32; N]>,
    neighbors: &mut Vec<[u32; N]>,
    slots: usize,
) -> Result<(), Error> {
    let more = slots.saturating_sub(simplices.len());
    simplices
        .try_reserve_exact(more)
        .and_then(|()| neighbors.try_reserve_exact(more))
        .map_err(|_| Error::OutOfMemory { simplices: slots })
}

/// Appends an unused slot to fewer than `limit` ones, and returns its number.
///
/// # Errors
///
/// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub(crate) fn push<const N: usize>(
    simplices: &mut Vec<[u32; N]>,
    neighbors: &mut Vec<[u32; N]>,
    limit: usize,
) -> Result<u32, Error> {
    let count = simplices.len();
    if count == limit {
        return Err(Error::TooManySimplices { limit });
    }
    if count == simplices.capacity() {
        reserve(simplices, neighbors, (count + count / 2).min(limit))?;
    }
    simplices.push([0; N]);
    neighbors.push([0; N]);
    Ok(count as u32)
}
