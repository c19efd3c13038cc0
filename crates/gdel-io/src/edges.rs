//! Edges as text: two indices a line.

use crate::{
    FormatError,
    error::quote,
    text::{fields, lines},
};

/// Reads edges between points: two indices on each line, counted from 0 and separated by white space, a comma or a
/// semicolon. Empty lines are skipped, and what follows `#`.
///
/// # Errors
///
/// Returns where the file is broken, and how.
pub fn read_edges(bytes: &[u8]) -> Result<Vec<[u32; 2]>, FormatError> {
    let mut edges = Vec::new();
    for (line, text) in lines(bytes) {
        let text = text.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii();
        if text.is_empty() {
            continue;
        }
        let index = |field: &[u8]| {
            let parsed = std::str::from_utf8(field).ok().and_then(|text| text.parse().ok());
            parsed.ok_or_else(|| FormatError::line(line, format!("{} is not the index of a point", quote(field))))
        };
        let ends: Vec<u32> = fields(text).map(index).collect::<Result<_, _>>()?;
        let wrong = |_| FormatError::line(line, format!("{} instead of two indices", quote(text)));
        edges.push(ends.as_slice().try_into().map_err(wrong)?);
    }
    Ok(edges)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_indices() {
        let text = b"\xef\xbb\xbf# from to\n0 1\n\n 1,2 # a comment\r\n2;3\n4294967295\t0";
        assert_eq!(read_edges(text), Ok(vec![[0, 1], [1, 2], [2, 3], [u32::MAX, 0]]));
        assert_eq!(read_edges(b""), Ok(Vec::new()));
        for (text, what) in [
            ("0 1\n2\n", "line 2: `2` instead of two indices"),
            ("0 1 2", "line 1: `0 1 2` instead of two indices"),
            ("0 1\n-1 2", "line 2: `-1` is not the index of a point"),
            ("0.5 1", "line 1: `0.5` is not the index of a point"),
            ("from to", "line 1: `from` is not the index of a point"),
        ] {
            assert_eq!(read_edges(text.as_bytes()).unwrap_err().to_string(), what);
        }
    }
}
