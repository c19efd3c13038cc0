//! A tile between two steps, as bytes.

use super::{
    bytes::{Reader, TOO_LONG, Writer},
    dim::Tiled,
    plan::Plan,
    tile::Tile,
};
use crate::{
    dimension::Dimension,
    error::Error,
    geometry::{Euclidean, Geometry},
    options::Options,
};
use std::sync::Arc;

const TILE: u32 = u32::from_le_bytes(*b"gdts");

impl<const D: usize, const N: usize> Tile<D, N>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    /// Returns the tile as bytes, the same on every machine. They have its points, not its triangulation: the tile that is
    /// read from them is [suspended](Self::suspend).
    pub fn to_bytes(&self) -> Vec<u8> {
        let cloud = &self.cloud;
        let mut bytes = Writer(Vec::new());
        bytes.words(&[TILE, D as u32, self.number, self.steps, u32::from(self.is_shell)]);
        bytes.words(&[cloud.own, cloud.common, cloud.owners.len() as u32]);
        bytes.numbers(cloud.points.as_flattened());
        bytes.words(&cloud.indices);
        bytes.words(&cloud.owners);
        for bounds in &self.bounds {
            bytes.words(&[u32::from(bounds.is_some())]);
            bytes.numbers(bounds.unwrap_or([[0.0; D]; 2]).as_flattened());
        }
        for sent in &self.sent {
            let mut sent: Vec<u32> = sent.iter().copied().collect();
            sent.sort_unstable();
            bytes.words(&[sent.len() as u32]);
            bytes.words(&sent);
        }
        bytes.0
    }

    /// Reads a tile of this plan.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BadMessage`] if that is not one, or one of another dimension or plan.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::tiles::{Plan, Survey, Tile};
    ///
    /// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0f64]];
    /// let plan = Plan::new(Survey::<2>::new(&points, 0, 1)?, 1);
    /// let mut tile = Tile::<2, 3>::new(plan.clone(), 0, points.to_vec(), vec![0, 1, 2, 3])?;
    /// while tile.step(Vec::new())?.len() > 0 {}
    /// tile.step(Vec::new())?;
    /// let bytes = tile.to_bytes();
    /// let again = Tile::<2, 3>::from_bytes(plan, &bytes)?;
    /// assert_eq!(again.finish()?.simplices.len(), 2);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn from_bytes(plan: impl Into<Arc<Plan<D>>>, bytes: &[u8]) -> Result<Self, Error> {
        Self::with_options_from_bytes(plan.into(), bytes, Options::default())
    }

    /// Reads a tile with options.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Tile::from_bytes`].
    #[doc(hidden)]
    pub fn with_options_from_bytes(plan: Arc<Plan<D>>, bytes: &[u8], options: Options) -> Result<Self, Error> {
        let bad = |reason| Err(Error::BadMessage { reason });
        let mut bytes = Reader(bytes);
        if bytes.word()? != TILE || bytes.word()? as usize != D {
            return bad("it is not a tile of this dimension");
        }
        let (number, steps, is_shell) = (bytes.word()?, bytes.word()?, bytes.word()? != 0);
        let (own, common, foreign) = (bytes.word()?, bytes.word()?, bytes.word()?);
        let count = own.saturating_add(foreign);
        bytes.count(count, 8 * D + 4)?;
        let points = bytes.points(own)?;
        let others = bytes.points(foreign)?;
        let indices = bytes.words(own)?;
        let Ok(mut tile) = Tile::with_options(plan, number, points, indices, options) else {
            return bad("its points are not those of one");
        };
        let (names, owners) = (bytes.words(foreign)?, bytes.words(foreign)?);
        for (at, (index, owner)) in others.into_iter().zip(names.into_iter().zip(owners)) {
            if owner == number || owner != tile.plan.tile_of(at) {
                return bad("it has a point of another tile than it says");
            }
            tile.cloud.learn(index, owner, at);
        }
        if common > foreign || tile.cloud.owners.len() != foreign as usize {
            return bad("it has a point twice");
        }
        (tile.cloud.common, tile.steps, tile.is_shell) = (common, steps, is_shell);
        for bounds in &mut tile.bounds {
            let is_there = bytes.word()? != 0;
            let corners = [bytes.point()?, bytes.point()?];
            *bounds = is_there.then_some(corners);
        }
        for sent in &mut tile.sent {
            let count = bytes.word()?;
            *sent = bytes.words(count)?.into_iter().collect();
            if sent.len() != count as usize || sent.iter().any(|&v| v as usize >= tile.cloud.points.len()) {
                return bad("it has sent what it does not have");
            }
        }
        if bytes.0.is_empty() { Ok(tile) } else { Err(TOO_LONG) }
    }
}
