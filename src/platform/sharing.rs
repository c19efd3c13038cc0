//! Which threads share work, and from which size on.

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
