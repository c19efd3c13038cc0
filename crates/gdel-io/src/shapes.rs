//! Drawings and maps: points, and segments between them.

use crate::{PointBuf, PointCloud};
use gdel::{Constraints, Fill};

/// Points, and segments between them. Points are not merged, even if they are equal.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shapes {
    /// The points.
    pub points: Vec<[f64; 2]>,
    /// The height of each point, if there is one; an empty list if no point has one.
    pub heights: Vec<Option<f64>>,
    /// Segments that bound nothing.
    pub edges: Vec<[u32; 2]>,
    /// Closed polygons, which are boundaries; the last vertex is not the first one again.
    pub rings: Vec<Vec<u32>>,
    /// A place in each hole, as `.poly` files have them.
    pub holes: Vec<[f64; 2]>,
    /// What the format takes for the inside.
    pub fill: Fill,
    /// Whether there were heights.
    pub dropped_z: bool,
    /// What was left out, such as `2 text`.
    pub left_out: Vec<String>,
}

impl Shapes {
    /// Returns the constraints, with the fill rule of the format.
    pub fn constraints(&self) -> Constraints {
        let constraints = Constraints::new().edges(&self.edges).fill(self.fill);
        let constraints = self.rings.iter().fold(constraints, |constraints, ring| constraints.ring(ring));
        self.holes.iter().fold(constraints, |constraints, &hole| constraints.hole(hole))
    }

    /// Returns the points as those of a file.
    pub fn into_cloud(self) -> PointCloud<2> {
        PointCloud {
            points: PointBuf::F64(self.points),
            no_return: 0,
            ignored_columns: 0,
            dropped_z: self.dropped_z,
            colors: None,
            normals: None,
            sensors: Vec::new(),
        }
    }

    /// Adds points one after the other, and returns their indices.
    fn add(&mut self, points: &[[f64; 2]]) -> Vec<u32> {
        let first = self.points.len() as u32;
        self.points.extend(points);
        (first..).take(points.len()).collect()
    }

    /// Adds a closed polygon, whose last point may be the first one.
    pub(crate) fn add_ring(&mut self, points: &[[f64; 2]]) {
        let points = match points {
            [first, rest @ .., last] if first == last => &points[..=rest.len()],
            _ => points,
        };
        let ring = self.add(points);
        self.rings.push(ring);
    }

    /// Adds a line. If it is closed, its last point is the first one.
    pub(crate) fn add_line(&mut self, points: &[[f64; 2]]) {
        let is_closed = points.len() > 2 && points.first() == points.last();
        let mut line = self.add(&points[..points.len() - usize::from(is_closed)]);
        if is_closed && let Some(&first) = line.first() {
            line.push(first);
        }
        self.edges.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
    }
}
