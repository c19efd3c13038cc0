//! Words and numbers as bytes, the same on every machine.

use crate::error::Error;

/// Appends to bytes.
pub(super) struct Writer(pub(super) Vec<u8>);

impl Writer {
    pub(super) fn words(&mut self, words: &[u32]) {
        words.iter().for_each(|word| self.0.extend(word.to_le_bytes()));
    }

    pub(super) fn numbers(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|number| self.0.extend(number.to_le_bytes()));
    }
}

/// Reads bytes, of which these are left.
pub(super) struct Reader<'a>(pub(super) &'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let (first, rest) = self.0.split_first_chunk().ok_or(TOO_SHORT)?;
        self.0 = rest;
        Ok(*first)
    }

    pub(super) fn word(&mut self) -> Result<u32, Error> {
        self.take().map(u32::from_le_bytes)
    }

    /// Reads a point, which must be finite.
    pub(super) fn point<const D: usize>(&mut self) -> Result<[f64; D], Error> {
        let mut point = [0.0; D];
        for x in &mut point {
            *x = self.take().map(f64::from_le_bytes)?;
        }
        let is_finite = point.iter().all(|x| x.is_finite());
        if is_finite { Ok(point) } else { Err(Error::BadMessage { reason: "a coordinate is not finite" }) }
    }

    /// Reads so many words.
    pub(super) fn words(&mut self, count: u32) -> Result<Vec<u32>, Error> {
        Ok(self.rows::<1>(count)?.into_flattened())
    }

    /// Reads so many rows of words.
    pub(super) fn rows<const M: usize>(&mut self, count: u32) -> Result<Vec<[u32; M]>, Error> {
        let (rows, rest) = self.0.split_at_checked(4 * M * self.count(count, 4 * M)?).ok_or(TOO_SHORT)?;
        self.0 = rest;
        let row = |k: usize| &rows.as_chunks::<4>().0[M * k..][..M];
        let row = |k: usize| std::array::from_fn(|i| u32::from_le_bytes(row(k)[i]));
        Ok((0..count as usize).map(row).collect())
    }

    /// Reads so many points, which must be finite.
    pub(super) fn points<const D: usize>(&mut self, count: u32) -> Result<Vec<[f64; D]>, Error> {
        let count = self.count(count, 8 * D)?;
        (0..count).map(|_| self.point()).collect()
    }

    /// Returns a number of items of so many bytes, if the rest is long enough for them.
    pub(super) fn count(&self, count: u32, size: usize) -> Result<usize, Error> {
        let is_there = (count as usize).checked_mul(size).is_some_and(|bytes| bytes <= self.0.len());
        if is_there { Ok(count as usize) } else { Err(TOO_SHORT) }
    }
}

const TOO_SHORT: Error = Error::BadMessage { reason: "it is too short" };
pub(super) const TOO_LONG: Error = Error::BadMessage { reason: "it is too long" };
