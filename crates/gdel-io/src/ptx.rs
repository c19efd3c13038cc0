//! PTX, in which Leica's programs export scans: for each scan the numbers of columns and rows, the
//! position and the axes of the scanner, a matrix of 4 × 4, and a point per line, x, y, z and an intensity,
//! maybe with red, green and blue.
//!
//! The matrix takes a row x, y, z, 1 to the coordinates that all scans share. Where a scanner has seen
//! nothing, the point is the origin.

use crate::{
    FormatError, PointBuf, PointCloud,
    colors::{CHANNELS, Colors, INTENSITY, Range},
    error::quote,
    text::{fields, lines, number},
};

/// The lines of a header with numbers: the position, three axes, and four rows of the matrix.
const ROWS: usize = 8;

pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let mut rows = lines(bytes).filter(|(_, content)| !content.is_empty());
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut scans: Vec<([f64; 3], usize)> = Vec::new();
    let mut colors: Option<Colors> = None;
    let mut no_return = 0;
    let mut last = 1;
    while let Some(columns) = rows.next() {
        let mut next = |what: &str| {
            let Some((line, content)) = rows.next() else {
                return Err(FormatError::line(last, format!("the file ends here, before {what}")));
            };
            last = line;
            Ok((line, content))
        };
        let count = |(line, content): (usize, &[u8])| {
            let count = std::str::from_utf8(content).ok().and_then(|text| text.parse::<usize>().ok());
            count.ok_or_else(|| {
                FormatError::line(line, format!("{} is not a number of columns or rows", quote(content)))
            })
        };
        let (line, _) = columns;
        let size = count(columns)?.checked_mul(count(next("the number of rows")?)?);
        let size = size.ok_or_else(|| FormatError::line(line, "there are more points than can be numbered"))?;
        let mut header = [[0.0; 4]; ROWS];
        for (k, row) in header.iter_mut().enumerate() {
            let wanted = if k < 4 { 3 } else { 4 };
            let (line, content) = next("the end of a header")?;
            *row = numbers(line, content, wanted)?;
        }
        let matrix = &header[4..];
        let place = |p: [f64; 3]| {
            let axis = |axis: usize| (0..3).map(|k| p[k] * matrix[k][axis]).sum::<f64>() + matrix[3][axis];
            [axis(0), axis(1), axis(2)]
        };
        let before = points.len();
        for _ in 0..size {
            let (line, content) = next("all points that the header promises")?;
            let [x, y, z, intensity] = numbers(line, content, 4)?;
            if [x, y, z] == [0.0; 3] {
                no_return += 1;
                continue;
            }
            points.push(place([x, y, z]));
            let mut sample = [f64::NAN; CHANNELS];
            sample[INTENSITY] = intensity;
            let mut rgb = fields(content).skip(4);
            for channel in &mut sample[..3] {
                if let Some(field) = rgb.next() {
                    *channel = number(field, line)?;
                }
            }
            let has = std::array::from_fn(|channel| channel == INTENSITY || (channel < 3 && !sample[0].is_nan()));
            colors.get_or_insert_with(|| Colors::new(has, Range::Bytes)).push(&sample);
        }
        let [x, y, z, _] = header[0];
        scans.push(([x, y, z], points.len() - before));
    }
    let sensors = match &scans[..] {
        [(sensor, _)] => vec![*sensor],
        scans => scans.iter().flat_map(|&(sensor, count)| std::iter::repeat_n(sensor, count)).collect(),
    };
    let cloud = PointCloud::new(PointBuf::F64(points))?;
    let cloud = match colors {
        Some(colors) => cloud.colored(colors),
        None => cloud,
    };
    Ok(PointCloud { no_return, sensors, ..cloud })
}

/// Returns the first numbers of a line, as many as wanted; the others are 0.
fn numbers(line: usize, content: &[u8], wanted: usize) -> Result<[f64; 4], FormatError> {
    let mut found = [0.0; 4];
    let mut row = fields(content);
    for x in &mut found[..wanted] {
        let field = row.next().ok_or_else(|| {
            let have = fields(content).count();
            FormatError::line(line, format!("{wanted} numbers expected, but there are only {have}"))
        })?;
        *x = number(field, line)?;
    }
    Ok(found)
}
