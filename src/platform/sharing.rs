//! Which threads share work, and from which size on.

use std::ops::Range;

/// Which threads share a piece of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Threads {
    /// The calling thread only.
    One,
    /// The threads of rayon's pool, or the calling thread if there are no others, as in the
    /// browser.
    All,
}

/// The number of elements that is worth handing to another thread if the work per element is a few
/// instructions.
pub(crate) const CHUNK: usize = 1 << 13;

/// Calls `work` for the ranges of `size` numbers that 0 … `len` consists of, one after the other; once if `len` is 0.
///
/// Engines of WebAssembly replace code by faster code only when it is called again, which a loop is not.
#[inline(never)]
pub(crate) fn in_pieces(len: usize, size: usize, work: &mut dyn FnMut(Range<usize>)) {
    for start in (0..len.max(1)).step_by(size) {
        work(start..len.min(start + size));
    }
}
