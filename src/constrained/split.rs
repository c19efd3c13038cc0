//! Points where segments cross.

use super::Constraints;
use crate::predicates::big::{Big, common_exponent, quotient};

/// Points and constraints between them, with points that were put at crossings.
pub(crate) struct Split {
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) constraints: Constraints,
    /// The number of points that were given.
    pub(crate) given: usize,
    /// The greatest distance of a point from the crossing that it was put at.
    pub(crate) moved: f64,
}

impl Split {
    pub(crate) fn new(points: Vec<[f64; 2]>, constraints: Constraints) -> Self {
        Split { given: points.len(), points, constraints, moved: 0.0 }
    }

    /// Cuts segments where pairs of them cross.
    pub(crate) fn cut(&mut self, pairs: &[[u32; 2]]) {
        let segments = self.constraints.segments();
        let mut cuts: Vec<(u32, u32)> = Vec::new();
        for &pair in pairs {
            let ends = pair.map(|i| segments[i as usize].map(|v| self.points[v as usize]));
            let (point, moved) = crossing(ends);
            cuts.extend(pair.map(|i| (i, self.points.len() as u32)));
            self.points.push(point);
            self.moved = self.moved.max(moved);
        }
        cuts.sort_unstable();
        let mut chains = Vec::new();
        let mut first_boundary = 0;
        for (i, &[from, to]) in segments.iter().enumerate() {
            if i == self.constraints.edges.len() {
                first_boundary = chains.len();
            }
            let start = cuts.partition_point(|&(segment, _)| (segment as usize) < i);
            let own = cuts[start..].iter().take_while(|&&(segment, _)| segment as usize == i);
            let mut chain: Vec<u32> = own.map(|&(_, v)| v).collect();
            self.sort_along([from, to], &mut chain);
            chain.insert(0, from);
            chain.push(to);
            chains.extend(chain.windows(2).map(|pair| [pair[0], pair[1]]));
        }
        if self.constraints.boundary.is_empty() {
            first_boundary = chains.len();
        }
        self.constraints.boundary = chains.split_off(first_boundary);
        self.constraints.edges = chains;
    }

    /// Sorts points near a segment along it: by the axis in which it extends farthest, then by the other.
    fn sort_along(&self, ends: [u32; 2], chain: &mut [u32]) {
        let [from, to] = ends.map(|v| self.points[v as usize]);
        // Halves, since the difference could overflow.
        let extent = [0, 1].map(|axis| to[axis] / 2.0 - from[axis] / 2.0);
        let first = usize::from(extent[1].abs() > extent[0].abs());
        let key = |v: u32| [first, 1 - first].map(|axis| self.points[v as usize][axis] * extent[axis].signum());
        chain.sort_by(|&v, &w| key(v).partial_cmp(&key(w)).unwrap_or(std::cmp::Ordering::Equal));
    }
}

/// Returns where two segments cross, rounded, and how far that is from the crossing.
pub(super) fn crossing([[a, b], [c, d]]: [[[f64; 2]; 2]; 2]) -> ([f64; 2], f64) {
    let exponent = common_exponent([a, b, c, d].as_flattened());
    let big = |p: [f64; 2]| p.map(|x| Big::new(x, exponent));
    let minus = |p: [f64; 2], q: [f64; 2]| {
        let ([px, py], [qx, qy]) = (big(p), big(q));
        [px - qx, py - qy]
    };
    let cross = |[ux, uy]: &[Big; 2], [vx, vy]: &[Big; 2]| ux * vy - uy * vx;
    let [ab, cd, ac] = [minus(b, a), minus(d, c), minus(c, a)];
    let (mut over, mut under) = (cross(&ac, &cd), cross(&ab, &cd));
    if under.sign() < 0 {
        (over, under) = (Big::default() - over, Big::default() - under);
    }
    let (mut point, mut moved) = ([0.0; 2], [0.0; 2]);
    for (axis, start) in big(a).into_iter().enumerate() {
        let numerator = &start * &under + &ab[axis] * &over;
        point[axis] = quotient(&numerator, &under, exponent);
        let finer = exponent.min(common_exponent(&point[axis..=axis]));
        let offset = (numerator << (exponent - finer) as u32) - &Big::new(point[axis], finer) * &under;
        moved[axis] = quotient(&offset, &under, finer);
    }
    (point, moved[0].hypot(moved[1]))
}
