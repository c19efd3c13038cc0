//! The parts of the kernels' references that differ between the dimensions.

use crate::{State, dim::ReferenceDim};
use gdel::internals::dimension::Dimension;

/// The parts of the references that are mathematics of one dimension.
pub trait Kernels<const D: usize>: ReferenceDim<D>
where
    Dimension<D>: ReferenceDim<D>,
{
    /// Returns how much simplex `t` wants point `p`, at least 1, where points are not picked at
    /// random. Scores of different simplices do not compare.
    fn score(state: &State<D>, t: u32, p: u32) -> u32;

    /// Returns the outcome of checking simplex `t`, and the simplices that its proposed flip would
    /// change: none if it proposes none.
    fn proposal(state: &State<D>, t: u32) -> (u32, Vec<u32>);

    /// Carries out the flip that entry `i` of the active list proposes, if it has won.
    fn commit(state: &mut State<D>, i: usize);

    /// Finishes when all points are inserted and no flip is left. Does nothing in 2D.
    fn finish(state: &mut State<D>);

    /// Panics unless the buffers that only this dimension has agree with the others.
    fn validate_own(state: &State<D>);
}
