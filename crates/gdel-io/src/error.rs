//! What is wrong with a file, and where in it.

use std::fmt;

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Position {
    /// A line of a text file, counted from 1.
    Line(usize),
    /// A byte, counted from 0.
    Byte(usize),
    /// A point, counted from 0, where the format's decoder does not say at which byte it is.
    Point(usize),
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Position::Line(n) => write!(f, "line {n}"),
            Position::Byte(n) => write!(f, "byte {n}"),
            Position::Point(n) => write!(f, "point {n}"),
        }
    }
}

/// Why a file's content cannot be read. The text is one line of printable characters.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{at}: {}", printable(what))]
pub struct FormatError {
    /// The position of the error in the file.
    pub at: Position,
    /// A description of the error.
    pub what: String,
}

impl FormatError {
    pub(crate) fn line(line: usize, what: impl Into<String>) -> Self {
        FormatError { at: Position::Line(line), what: what.into() }
    }

    pub(crate) fn byte(offset: usize, what: impl Into<String>) -> Self {
        FormatError { at: Position::Byte(offset), what: what.into() }
    }

    pub(crate) fn point(index: usize, what: impl Into<String>) -> Self {
        FormatError { at: Position::Point(index), what: what.into() }
    }
}

/// Quotes a piece of a file for an error message: printable, and short however long the piece is.
pub(crate) fn quote(piece: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text: String = String::from_utf8_lossy(&piece[..piece.len().min(4 * LONGEST)]).chars().take(LONGEST).collect();
    let dots = if text.len() < piece.len() { "…" } else { "" };
    format!("`{}{dots}`", printable(&text))
}

/// Returns `text` with its control characters escaped, and those that change the direction of
/// writing: in the name of a file or a message from elsewhere, they would reach the terminal as
/// commands.
pub fn printable(text: &str) -> String {
    let is_command = |c: char| {
        c.is_control() || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let mut result = String::with_capacity(text.len());
    for c in text.chars() {
        if is_command(c) { result.extend(c.escape_default()) } else { result.push(c) }
    }
    result
}
