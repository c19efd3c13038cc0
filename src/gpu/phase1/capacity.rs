//! How large the buffers of a run are, and how large they can become.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Parts,
        dim::{Dim, Flip},
        layout::{BLOCK, DONE, SLOT_SHIFT},
        phase1::{
            buffers::{Sizes, largest_bytes},
            settings::Settings,
        },
    },
};

/// The status of a simplex has 30 bits for the number of a node, plus 1.
const MAX_NODES: u64 = (1 << 30) - 1;

/// Simplices are numbered in 30 bits.
pub(crate) const MAX_SIMPLICES: u32 = 1 << 30;
const _: () = assert!(DONE >> SLOT_SHIFT >= MAX_SIMPLICES, "a flip notes the slot that it gives back");

/// Nodes of the history, however few the points are.
const MIN_HISTORY: u64 = 64;

/// Returns the sizes of the buffers for so many points at the beginning of a run.
///
/// # Errors
///
/// Returns [`Error::TooManyPoints`] and [`Error::BufferTooLarge`].
pub(crate) fn first_sizes<const D: usize>(
    gpu: &Gpu,
    parts: Option<Parts>,
    settings: &Settings<D>,
    count: usize,
) -> Result<Sizes, Error>
where
    Dimension<D>: Dim<D>,
{
    let limit = Dimension::<D>::MAX_POINTS;
    if count > limit {
        return Err(Error::TooManyPoints { points: count, limit });
    }
    let points = count as u32;
    let blocks = settings.first_blocks(points);
    let (bytes, limit) = (largest_bytes(blocks), largest_array(gpu, parts));
    if bytes > limit.into() {
        let points = Some(max_points(limit, settings));
        return Err(Error::BufferTooLarge { label: Dimension::<D>::SIMPLICES, bytes, limit, points });
    }
    let bindable = MAX_NODES.min(limit / size_of::<Flip<D>>() as u64);
    let wanted = u64::from(settings.memory.history) * u64::from(points);
    let history = wanted.clamp(MIN_HISTORY, bindable.max(MIN_HISTORY)) as u32;
    Ok(Sizes { blocks, history, start_points: settings.start_points(count), parts })
}

/// Returns how many blocks there can be in place of `before`, if `wanted` are.
///
/// # Errors
///
/// Returns [`Error::TooManySimplices`], and [`Error::BufferTooLarge`] with the number of points for which
/// there would be room if they lay like these `points`.
pub(crate) fn more_blocks<const D: usize>(
    gpu: &Gpu,
    parts: Option<Parts>,
    points: u32,
    before: u32,
    wanted: u32,
) -> Result<u32, Error>
where
    Dimension<D>: Dim<D>,
{
    let blocks = wanted.min(MAX_SIMPLICES / BLOCK - 1);
    if blocks <= before {
        return Err(Error::TooManySimplices { limit: MAX_SIMPLICES as usize });
    }
    let (bytes, limit) = (largest_bytes(blocks), largest_array(gpu, parts));
    if bytes > limit.into() {
        let points = Some((u128::from(points) * u128::from(limit) / bytes) as usize);
        return Err(Error::BufferTooLarge { label: Dimension::<D>::SIMPLICES, bytes, limit, points });
    }
    Ok(blocks)
}

/// Returns the largest number of points whose buffers a device can bind.
fn max_points<const D: usize>(limit: u64, settings: &Settings<D>) -> usize
where
    Dimension<D>: Dim<D>,
{
    let fits = |points: &u32| largest_bytes(settings.first_blocks(*points)) <= limit.into();
    let (mut fitting, mut too_many) = (0, Dimension::<D>::MAX_POINTS as u32 + 1);
    while too_many - fitting > 1 {
        let middle = fitting + (too_many - fitting) / 2;
        *(if fits(&middle) { &mut fitting } else { &mut too_many }) = middle;
    }
    fitting as usize
}

/// Returns the size of the largest array, in bytes: of one buffer, or of all its parts.
fn largest_array(gpu: &Gpu, parts: Option<Parts>) -> u64 {
    parts.map_or_else(|| gpu.max_storage_bytes(), Parts::limit)
}
