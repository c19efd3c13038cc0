//! Triangle's `.poly`: points, segments, places in holes, and places in regions.

use crate::{
    FormatError,
    shapes::Shapes,
    tetgen::{content, integer},
    text::{fields, number},
};
use gdel::Fill;

/// Points, and the number of the first.
pub(super) type Numbered = (Vec<[f64; 2]>, i64);

/// Reads a file, and its points by `nodes` if they are in a `.node` file of their own.
pub(super) fn read<E: From<FormatError>>(
    bytes: &[u8],
    nodes: impl FnOnce() -> Result<Numbered, E>,
) -> Result<Shapes, E> {
    let mut rows = Rows { content: Box::new(content(bytes)), next: None, last_line: 1 };
    let (count, line) = rows.count("points")?;
    let given = rows.numbered::<2>(count, "points", None)?;
    let (points, base) = match count {
        0 => nodes()?,
        _ => (given.rows.into_iter().map(|(_, point)| point).collect(), given.base),
    };
    if u32::try_from(points.len()).is_err() {
        return Err(FormatError::line(line, "there are too many points").into());
    }
    let mut shapes = Shapes { points, fill: Fill::Enclosed, ..Shapes::default() };
    let (count, _) = rows.count("segments")?;
    for (line, ends) in rows.numbered::<2>(count, "segments", Some(base))?.rows {
        let index = |v: f64| {
            let index = v - base as f64;
            let is_index = index >= 0.0 && index < shapes.points.len() as f64 && index.fract() == 0.0;
            if is_index { Ok(index as u32) } else { Err(FormatError::line(line, format!("there is no point {v}"))) }
        };
        shapes.edges.push([index(ends[0])?, index(ends[1])?]);
    }
    let (count, _) = rows.count("holes")?;
    shapes.holes = rows.numbered::<2>(count, "holes", Some(base))?.rows.into_iter().map(|(_, place)| place).collect();
    if rows.has_more() {
        let (count, _) = rows.count("regions")?;
        rows.numbered::<2>(count, "regions", Some(base))?;
        if count > 0 {
            shapes.left_out.push(format!("{count} regional attributes"));
        }
    }
    match rows.next() {
        Some((line, _)) => Err(FormatError::line(line, "there is more after the last section").into()),
        None => Ok(shapes),
    }
}

/// The lines that are left.
struct Rows<'a> {
    content: Box<dyn Iterator<Item = (usize, &'a [u8])> + 'a>,
    next: Option<(usize, &'a [u8])>,
    last_line: usize,
}

/// The rows of a section with their lines, and the number of the first row.
struct Section<const N: usize> {
    rows: Vec<(usize, [f64; N])>,
    base: i64,
}

impl<'a> Rows<'a> {
    fn next(&mut self) -> Option<(usize, &'a [u8])> {
        let next = self.next.take().or_else(|| self.content.next());
        self.last_line = next.map_or(self.last_line, |(line, _)| line);
        next
    }

    fn has_more(&mut self) -> bool {
        self.next = self.next.take().or_else(|| self.content.next());
        self.next.is_some()
    }

    /// Reads the first line of a section.
    fn count(&mut self, what: &str) -> Result<(usize, usize), FormatError> {
        let missing = FormatError::line(self.last_line, format!("the number of {what} is missing after this line"));
        let (line, content) = self.next().ok_or(missing)?;
        let count = integer(fields(content).next(), line)?;
        let negative = |_| FormatError::line(line, format!("{count} is not a number of {what}"));
        Ok((usize::try_from(count).map_err(negative)?, line))
    }

    /// Reads so many rows of a number, `N` entries, and anything after them.
    fn numbered<const N: usize>(
        &mut self,
        count: usize,
        what: &str,
        base: Option<i64>,
    ) -> Result<Section<N>, FormatError> {
        let mut section = Section { rows: Vec::new(), base: base.unwrap_or(0) };
        for i in 0..count {
            let last_line = self.last_line;
            let missing = || FormatError::line(last_line, format!("{count} {what} are promised, {i} are there"));
            let (line, content) = self.next().ok_or_else(missing)?;
            let mut fields = fields(content);
            let numbered = integer(fields.next(), line)?;
            if i == 0 && base.is_none() {
                section.base = numbered;
            }
            // Triangle does not look at the numbers of segments and holes.
            let is_wrong =
                numbered.checked_sub(section.base) != i64::try_from(i).ok() || !(0..=1).contains(&section.base);
            if base.is_none() && is_wrong {
                return Err(FormatError::line(line, format!("row {i} is numbered {numbered}")));
            }
            let mut entries = [0.0; N];
            for entry in &mut entries {
                let field = fields.next().ok_or_else(|| FormatError::line(line, "a number is missing"))?;
                *entry = number(field, line)?;
            }
            section.rows.push((line, entries));
        }
        Ok(section)
    }
}
