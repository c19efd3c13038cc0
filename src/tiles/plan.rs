//! Which point belongs to which tile.

use super::{
    bytes::{Reader, TOO_LONG, Writer},
    survey::{Indexed, Survey},
};
use crate::{cpu::Incremental, dimension::Dimension, error::Error, input::points::Points};

/// How points are split into tiles: by planes across the axes, each of which halves a sample.
///
/// Equal points are always in the same tile. A tile can be empty.
///
/// # Examples
///
/// ```
/// use gdel::tiles::{Plan, Survey};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 9.0], [1.0, 9.0f64]];
/// let plan = Plan::new(Survey::<2>::new(&points, 0, 1)?, 2);
/// assert_eq!(points.map(|p| plan.tile_of(p)), [0, 0, 1, 1]);
/// let parts = plan.split(&points, 0);
/// assert_eq!(parts[1], (vec![[0.0, 9.0], [1.0, 9.0]], vec![2, 3]));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Plan<const D: usize> {
    tiles: u32,
    /// The affine dimension of all points.
    dimension: u8,
    /// The first one is the root.
    nodes: Vec<Node>,
    /// The points that every tile knows from the start, in the order of their indices.
    pub(super) common: Vec<Indexed<D>>,
}

/// More tiles than this would know more of each other than of themselves.
const MAX_TILES: u32 = 1 << 16;

const PLAN: u32 = u32::from_le_bytes(*b"gdtp");

/// A part of space.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Node {
    /// It is cut: coordinates below `at` are in the next node, the others in the node `above`.
    Cut { axis: usize, at: f64, above: usize },
    /// It is a tile.
    Tile(u32),
}

impl<const D: usize> Plan<D>
where
    Dimension<D>: Incremental<D>,
{
    /// Plans so many tiles: at least one, and at most 65,536.
    pub fn new(survey: Survey<D>, tiles: u32) -> Self {
        let mut sample: Vec<[f64; D]> = survey.sample().collect();
        let mut plan = Plan {
            tiles: tiles.clamp(1, MAX_TILES),
            dimension: survey.dimension(),
            nodes: Vec::new(),
            common: survey.into_common(),
        };
        plan.cut(&mut sample, 0..plan.tiles);
        plan
    }

    /// Returns the affine dimension of all points. If it is less than `D`, tiles have no simplices.
    pub fn dimension(&self) -> u8 {
        self.dimension
    }

    /// Returns the number of tiles.
    pub fn tiles(&self) -> u32 {
        self.tiles
    }

    /// Returns the number of the tile that a point belongs to.
    pub fn tile_of(&self, p: [f64; D]) -> u32 {
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Cut { axis, at, above } => node = if p[axis] < at { node + 1 } else { above },
                Node::Tile(tile) => return tile,
            }
        }
    }

    /// Returns for each tile its points and their indices. The first point has the index `first`.
    pub fn split<'a>(&self, points: impl Into<Points<'a, D>>, first: u32) -> Vec<(Vec<[f64; D]>, Vec<u32>)> {
        let points = points.into();
        let room = points.len() / self.tiles as usize;
        let part = || (Vec::with_capacity(room + room / 8), Vec::with_capacity(room + room / 8));
        let mut parts: Vec<_> = std::iter::repeat_with(part).take(self.tiles as usize).collect();
        for (index, p) in (first..).zip(points.iter()) {
            let (own, indices) = &mut parts[self.tile_of(p) as usize];
            own.push(p);
            indices.push(index);
        }
        parts
    }

    /// Returns the plan as bytes, the same on every machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Writer(Vec::new());
        bytes.words(&[PLAN, D as u32, self.tiles, u32::from(self.dimension)]);
        bytes.words(&[self.nodes.len() as u32, self.common.len() as u32]);
        for node in &self.nodes {
            let (axis, number, at) = match *node {
                Node::Cut { axis, at, above } => (axis as u32, above as u32, at),
                Node::Tile(tile) => (D as u32, tile, 0.0),
            };
            bytes.words(&[axis, number]);
            bytes.numbers(&[at]);
        }
        for p in &self.common {
            bytes.words(&[p.index, 0]);
            bytes.numbers(&p.at);
        }
        bytes.0
    }

    /// Reads a plan.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BadMessage`] if that is not one, or one of another dimension.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let mut bytes = Reader(bytes);
        let (kind, in_dimensions) = (bytes.word()?, bytes.word()?);
        if kind != PLAN || in_dimensions as usize != D {
            return Err(Error::BadMessage { reason: "it is not a plan of this dimension" });
        }
        let (tiles, dimension, nodes, common) = (bytes.word()?, bytes.word()?, bytes.word()?, bytes.word()?);
        let mut plan = Plan {
            tiles,
            dimension: dimension.min(D as u32) as u8,
            nodes: vec![Node::Tile(0); bytes.count(nodes, 16)?],
            common: vec![Indexed { index: 0, at: [0.0; D] }; bytes.count(common, 8 + 8 * D)?],
        };
        for (i, node) in plan.nodes.iter_mut().enumerate() {
            let (axis, number, [at]) = (bytes.word()?, bytes.word()?, bytes.point()?);
            // Every way down ends, since numbers of nodes grow.
            *node = match axis as usize {
                axis if axis < D && number as usize > i && number < nodes => {
                    Node::Cut { axis, at, above: number as usize }
                }
                axis if axis == D && number < tiles => Node::Tile(number),
                _ => return Err(Error::BadMessage { reason: "it cuts off a part that is not there" }),
            };
        }
        let leaves = plan.nodes.iter().filter(|node| matches!(node, Node::Tile(_))).count();
        if !matches!(plan.nodes.last(), Some(Node::Tile(_))) || leaves != tiles as usize {
            return Err(Error::BadMessage { reason: "its parts are not as many as it says" });
        }
        for p in &mut plan.common {
            (p.index, _, p.at) = (bytes.word()?, bytes.word()?, bytes.point()?);
        }
        if bytes.0.is_empty() { Ok(plan) } else { Err(TOO_LONG) }
    }

    /// Appends the nodes of a part of space with these points of the sample and these tiles.
    fn cut(&mut self, sample: &mut [[f64; D]], tiles: std::ops::Range<u32>) {
        let count = tiles.end - tiles.start;
        if count == 1 {
            return self.nodes.push(Node::Tile(tiles.start));
        }
        let half = count / 2;
        let (axis, at, below) = halved(sample, f64::from(half) / f64::from(count));
        let node = self.nodes.len();
        self.nodes.push(Node::Cut { axis, at, above: 0 });
        let middle = tiles.start + half;
        let (lower, upper) = sample.split_at_mut(below);
        self.cut(lower, tiles.start..middle);
        let above = self.nodes.len();
        self.nodes[node] = Node::Cut { axis, at, above };
        self.cut(upper, middle..tiles.end);
    }
}

/// Sorts points along their longest axis, and returns it, a coordinate that about this share of the points is below,
/// and how many are.
fn halved<const D: usize>(sample: &mut [[f64; D]], share: f64) -> (usize, f64, usize) {
    let extent = |axis: usize| {
        let values = sample.iter().map(|p| p[axis]);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    };
    let axis = (0..D).max_by(|&i, &j| extent(i).total_cmp(&extent(j))).unwrap_or(0);
    sample.sort_unstable_by(|p, q| p[axis].total_cmp(&q[axis]));
    let middle = (sample.len() as f64 * share) as usize;
    let Some(&lowest) = sample.first() else { return (axis, 0.0, 0) };
    // Nothing is below the lowest one, so the cut is where the next one begins.
    let at = sample[middle..].iter().map(|p| p[axis]).find(|&x| x > lowest[axis]).unwrap_or(lowest[axis]);
    (axis, at, sample.partition_point(|p| p[axis] < at))
}
