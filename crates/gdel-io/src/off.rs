//! OFF, the Object File Format of Geomview, in text.
//!
//! Read here because no crate that reads it is maintained.

use crate::{
    FormatError, PointBuf, PointCloud,
    error::quote,
    text::{fields, lines, number},
};

/// Reads the vertices. The faces are checked as well, so that a truncated file is an error.
pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let mut last = 1;
    let mut rows = lines(bytes)
        .map(|(line, content)| (line, content.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii()))
        .filter(|(_, content)| !content.is_empty())
        .inspect(|(line, _)| last = *line);
    let (line, first) = rows.next().ok_or_else(|| FormatError::line(1, "not OFF: the first word is not `OFF`"))?;
    let end = first.iter().position(u8::is_ascii_whitespace).unwrap_or(first.len());
    // Some programs have no line end after the keyword, nor even a space.
    let end = first[..end].windows(3).position(|word| word == b"OFF").map_or(end, |at| at + 3);
    let (keyword, counts) = first.split_at(end);
    if !matches!(keyword, b"OFF" | b"COFF" | b"NOFF" | b"CNOFF" | b"STOFF" | b"STCOFF" | b"STNOFF" | b"STCNOFF") {
        let what = match keyword {
            [.., b'O', b'F', b'F'] => format!("{}: only OFF with x, y and z is read", quote(keyword)),
            _ => format!("not OFF: the first word is not `OFF`, but {}", quote(keyword)),
        };
        return Err(FormatError::line(line, what));
    }
    let mut counts = (line, counts.trim_ascii());
    if counts.1.starts_with(b"BINARY") {
        return Err(FormatError::line(line, "binary OFF is not read: save it as text"));
    }
    if counts.1.is_empty() {
        counts = rows.next().ok_or_else(|| FormatError::line(line, "the counts of vertices and faces are missing"))?;
    }
    let mut numbers = fields(counts.1);
    let mut count = |what: &str| {
        let word = numbers.next().unwrap_or_default();
        let count: Option<usize> = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
        count.ok_or_else(|| FormatError::line(counts.0, format!("{} is not a count of {what}", quote(word))))
    };
    let (vertices, faces) = (count("vertices")?, count("faces")?);

    let mut points = Vec::new();
    while points.len() < vertices
        && let Some((line, content)) = rows.next()
    {
        let mut words = fields(content);
        let mut point = [0.0; 3];
        for x in &mut point {
            *x = number(words.next().ok_or_else(|| FormatError::line(line, "a vertex needs x, y and z"))?, line)?;
        }
        points.push(point);
    }
    let mut read = 0;
    while points.len() == vertices
        && read < faces
        && let Some((line, content)) = rows.next()
    {
        let mut words = fields(content).map(|word| std::str::from_utf8(word).ok()?.parse::<usize>().ok());
        let size = words.next().flatten();
        let corners = size.map(|size| words.take(size).flatten().filter(|&v| v < vertices).count());
        if size.is_none() || corners != size {
            let what = format!("a face needs the number of its vertices and their indices, each below {vertices}");
            return Err(FormatError::line(line, what));
        }
        read += 1;
    }
    let more = rows.next();
    drop(rows);
    match more {
        _ if points.len() < vertices || read < faces => {
            let what = format!(
                "the file ends after {} of {vertices} vertices and {read} of {faces} faces that it promises, each on a \
                 line of its own",
                points.len()
            );
            Err(FormatError::line(last, what))
        }
        Some((line, _)) => {
            let what = format!("the file goes on after its {vertices} vertices and {faces} faces, one on each line");
            Err(FormatError::line(line, what))
        }
        None => PointCloud::new(PointBuf::F64(points)),
    }
}
