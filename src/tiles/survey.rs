//! What has to be known of all points before they are split.

use super::bytes::{Reader, TOO_LONG, Writer};
use crate::{
    cpu::Incremental,
    dimension::Dimension,
    error::Error,
    index::NONE,
    input::{order::mix, points::Points},
    parallel::Threads,
};

/// A point and its index in the whole input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indexed<const D: usize> {
    /// The index.
    pub index: u32,
    /// The coordinates.
    pub at: [f64; D],
}

/// What has to be known of points before they are split into [tiles](super::Tile): a sample of them, and some that span
/// as many dimensions as all. Surveys of the parts of an input are [merged](Survey::merge).
///
/// # Examples
///
/// ```
/// use gdel::tiles::Survey;
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0f64]];
/// let mut survey = Survey::<2>::new(&points[..2], 0, 1)?;
/// assert_eq!(survey.dimension(), 1);
/// survey.merge(Survey::new(&points[2..], 2, 1)?);
/// assert_eq!(survey.dimension(), 2);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Survey<const D: usize> {
    /// Points that a hash of their indices chooses.
    sample: Vec<Indexed<D>>,
    /// Affinely independent points, as many as all points have.
    frame: Vec<Indexed<D>>,
}

impl<const D: usize> Survey<D>
where
    Dimension<D>: Incremental<D>,
{
    /// Surveys points, of which the first has the index `first` in the whole input. One of `every` points is in the
    /// sample; all if that is 1 or less.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotFinite`] with the first point that has a coordinate that is not finite, by its index in
    /// the whole input, and [`Error::TooManyPoints`] if the indices do not fit into 32 bits.
    pub fn new<'a>(points: impl Into<Points<'a, D>>, first: u32, every: u32) -> Result<Self, Error> {
        let points = points.into();
        // One of the indices of 32 bits means none.
        let end = u64::from(first) + points.len() as u64;
        if end > u64::from(NONE) {
            return Err(Error::TooManyPoints { points: end as usize, limit: NONE as usize });
        }
        points.finite_bounds(Threads::All).map_err(|error| match error {
            Error::NotFinite { index, axis, value } => Error::NotFinite { index: index + first as usize, axis, value },
            error => error,
        })?;
        let all = || (first..).zip(points.iter()).map(|(index, at)| Indexed { index, at });
        let is_chosen = |p: &Indexed<D>| every <= 1 || mix(p.index.into()).is_multiple_of(every.into());
        // Most of a few points span what all do.
        let few = frame(all().take(FEW));
        let frame = if few.len() > D { few } else { frame(all()) };
        Ok(Survey { sample: all().filter(is_chosen).collect(), frame })
    }

    /// Adds what is known of other points of the same input.
    pub fn merge(&mut self, other: Self) {
        self.sample.extend(other.sample);
        self.frame = frame(self.frame.iter().copied().chain(other.frame));
    }

    /// Returns the survey as bytes, the same on every machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Writer(Vec::new());
        bytes.words(&[SURVEY, D as u32, self.sample.len() as u32, self.frame.len() as u32]);
        for p in self.sample.iter().chain(&self.frame) {
            bytes.words(&[p.index]);
            bytes.numbers(&p.at);
        }
        bytes.0
    }

    /// Reads a survey.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BadMessage`] if that is not one, or one of another dimension.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let bad = |reason| Err(Error::BadMessage { reason });
        let mut bytes = Reader(bytes);
        if bytes.word()? != SURVEY || bytes.word()? as usize != D {
            return bad("it is not a survey of this dimension");
        }
        let counts = [bytes.word()?, bytes.word()?];
        let mut read = |count: u32| -> Result<Vec<Indexed<D>>, Error> {
            let count = bytes.count(count, 4 + 8 * D)?;
            (0..count).map(|_| Ok(Indexed { index: bytes.word()?, at: bytes.point()? })).collect()
        };
        let (sample, given) = (read(counts[0])?, read(counts[1])?);
        if !bytes.0.is_empty() {
            return Err(TOO_LONG);
        }
        let frame = frame(given.iter().copied());
        if frame.len() == given.len() { Ok(Survey { sample, frame }) } else { bad("its points depend on each other") }
    }

    /// Returns the affine dimension of all points: `D`, or less if they are coplanar, collinear or equal.
    pub fn dimension(&self) -> u8 {
        self.frame.len().saturating_sub(1) as u8
    }

    /// Returns the points that every tile is to know, each once, in the order of their indices.
    pub(super) fn into_common(self) -> Vec<Indexed<D>> {
        let mut common = [self.sample, self.frame].concat();
        common.sort_unstable_by_key(|p| p.index);
        common.dedup_by_key(|p| p.index);
        common
    }

    /// Returns the coordinates of the sample.
    pub(super) fn sample(&self) -> impl Iterator<Item = [f64; D]> + '_ {
        self.sample.iter().map(|p| p.at)
    }
}

const SURVEY: u32 = u32::from_le_bytes(*b"gdtv");

/// So many points nearly always span all dimensions that there are.
const FEW: usize = 1 << 10;

/// Returns affinely independent points, as many as all points have.
fn frame<const D: usize>(points: impl Iterator<Item = Indexed<D>>) -> Vec<Indexed<D>>
where
    Dimension<D>: Incremental<D>,
{
    let mut points = points.peekable();
    let Some(&first) = points.peek() else { return Vec::new() };
    let mut all = vec![first];
    all.extend(points.filter(|p| p.at != first.at));
    let coordinates: Vec<[f64; D]> = all.iter().map(|p| p.at).collect();
    let mut order: Vec<u32> = (0..all.len() as u32).collect();
    let dimension = Dimension::<D>::spanning_first(Points::F64(&coordinates), &mut order);
    order.truncate(usize::from(dimension) + 1);
    order.into_iter().map(|i| all[i as usize]).collect()
}
