//! The Euclidean minimum spanning tree, a subgraph of every Delaunay triangulation.

use super::{complex::Complex, flat::Flat, sets::DisjointSets};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, SquaredLength, compare_lengths, surely_larger, vector},
    index::NONE,
    input::points::Points,
    mesh::Mesh,
    parallel::{self, Threads},
};
use std::cmp::Ordering;

/// The Euclidean minimum spanning tree of the points of a mesh: the shortest connection of all of
/// them.
///
/// Of several edges of exactly the same length the one with the lower vertices comes first, so the
/// tree is unique.
///
#[cfg_attr(doc, doc = concat!("<div>\n", include_str!("../../docs/answers/tree.svg"), "</div>"))]
///
/// # Examples
///
/// ```
/// use gdel::SpanningTree;
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0], [9.0, 0.0], [9.0, 4.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let tree = SpanningTree::new(&mesh, &points)?;
/// assert_eq!(tree.edges, [[0, 1], [0, 2], [3, 4], [1, 3]]);
/// assert_eq!(tree.lengths, [1.0, 2.0, 4.0, 8.0]);
/// // Single-linkage clusters.
/// assert_eq!(tree.clusters(2), [0, 0, 0, 1, 1]);
/// assert_eq!(tree.clusters_within(1.5), [0, 0, 1, 2, 3]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct SpanningTree {
    /// The edges, the lower point first, in the order of their lengths. There is one less than points:
    /// each duplicate has an edge of length 0 to its vertex. [Unused](crate::Mesh3::is_unused) points have none.
    pub edges: Vec<[u32; 2]>,
    /// The length of each edge, with a relative error below 2⁻⁵⁰.
    pub lengths: Vec<f64>,
    /// For each point, the one that stands for it, or [`NONE`](crate::NONE) if it is a vertex
    /// itself; an unused one stands for itself.
    duplicate_of: Vec<u32>,
}

/// An edge that may be one of the tree.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    length: SquaredLength,
    edge: [u32; 2],
}

/// Fewer candidates than this are sorted rather than split.
const SORTED: usize = 1 << 14;

/// The number of candidates whose median splits the others.
const SAMPLE: usize = 1 << 8;

impl SpanningTree {
    /// Computes the minimum spanning tree of the vertices of a mesh.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`], [`Error::NotFinite`] or [`Error::BrokenMesh`] as for
    /// [`Locator::new`](crate::Locator::new).
    pub fn new<'a, const D: usize, const N: usize>(
        mesh: &'a impl Mesh<D, N>,
        points: impl Into<Points<'a, D>>,
    ) -> Result<Self, Error>
    where
        Euclidean: Geometry<D, N>,
    {
        let complex = Complex::delaunay(mesh, points.into())?;
        let compare = |a: &Candidate, b: &Candidate| {
            // Points are looked at in the rare case that rounding leaves the answer open.
            let lengths = match a.length.certain_difference(b.length) {
                // Many edges are there several times.
                0 if a.edge == b.edge => 0,
                0 => {
                    let points = |edge: [u32; 2]| edge.map(|v| complex.point(v));
                    compare_lengths((points(a.edge), a.length), (points(b.edge), b.length))
                }
                sign => sign,
            };
            lengths.cmp(&0).then(a.edge.cmp(&b.edge))
        };
        let length = |[v, w]: [u32; 2]| SquaredLength::new(complex.point(v), complex.point(w));
        let mut candidates = match Flat::new(&complex)? {
            None => candidates(&complex),
            Some(flat) => flat.edges().map(|edge| Candidate { length: length(edge), edge }).collect(),
        };
        let duplicates = (0..).zip(&*complex.duplicate_of).filter(|&(i, &of)| of != NONE && of != i);
        let to_vertices = duplicates.map(|(i, &of)| [of.min(i), of.max(i)]);
        candidates.extend(to_vertices.map(|edge| Candidate { length: length(edge), edge }));
        let edges = kruskal(complex.points().len(), candidates, compare);
        let length = |&Candidate { length, edge: [v, w] }: &Candidate| {
            let measured = || vector::norm(vector::minus(complex.point(v), complex.point(w)));
            length.root().unwrap_or_else(measured)
        };
        let lengths = edges.iter().map(length).collect();
        let edges = edges.iter().map(|candidate| candidate.edge).collect();
        Ok(SpanningTree { edges, lengths, duplicate_of: complex.duplicate_of.into_owned() })
    }

    /// Returns the sum of all lengths.
    pub fn total_length(&self) -> f64 {
        // The sum of an empty iterator would be −0.
        self.lengths.iter().fold(0.0, |sum, length| sum + length)
    }

    /// Returns the single-linkage clusters that are left without the longest edges, as many as
    /// wanted if there are enough vertices: for each point the number of its cluster, [`NONE`](crate::NONE) for
    /// [unused](crate::Mesh3::is_unused) ones. Clusters are counted in the order of their first
    /// points.
    pub fn clusters(&self, count: usize) -> Vec<u32> {
        self.label(self.edges.len().saturating_sub(count.saturating_sub(1)))
    }

    /// Returns the single-linkage clusters that are left without the edges longer than `distance`:
    /// for each point the number of its cluster, [`NONE`](crate::NONE) for [unused](crate::Mesh3::is_unused)
    /// ones. Clusters are counted in the order of their first points.
    pub fn clusters_within(&self, distance: f64) -> Vec<u32> {
        self.label(self.lengths.partition_point(|&length| length <= distance))
    }

    /// Numbers the components of the first edges.
    fn label(&self, edges: usize) -> Vec<u32> {
        let mut sets = DisjointSets::new(self.duplicate_of.len());
        for &[a, b] in &self.edges[..edges] {
            sets.unite(a, b);
        }
        let mut labels = vec![0; self.duplicate_of.len()];
        let mut count = 0;
        for (i, &duplicate_of) in (0..).zip(&self.duplicate_of) {
            let first = sets.find(if duplicate_of == NONE { i } else { duplicate_of });
            if duplicate_of == i {
                labels[i as usize] = NONE;
            } else if first == i {
                labels[i as usize] = count;
                count += 1;
            } else {
                // The lowest vertex stands for all of a cluster, and a vertex is lower than its
                // duplicates.
                labels[i as usize] = labels[first as usize];
            }
        }
        labels
    }
}

/// The edges of a tetrahedron, of which the first three are those of a triangle.
const EDGES: [[usize; 2]; 6] = [[1, 0], [2, 0], [2, 1], [3, 0], [3, 1], [3, 2]];

/// Returns the edges of a mesh, some of them several times, without most of those that are the
/// longest side of a triangle, which no minimum spanning tree has.
fn candidates<const D: usize, const N: usize>(complex: &Complex<'_, D, N>) -> Vec<Candidate>
where
    Euclidean: Geometry<D, N>,
{
    let neighbors = &*complex.neighbors;
    let ranges = parallel::map_ranges(Threads::All, complex.simplices.len(), |range| {
        let mut candidates = Vec::with_capacity(range.len());
        for t in range {
            // Of the simplices around an edge, those whose neighbours there have higher numbers.
            let is_lowest = neighbors[t].map(|across| across == NONE || t < across as usize);
            if is_lowest.iter().filter(|&&is_lowest| is_lowest).count() < N - 2 {
                continue;
            }
            let simplex = complex.simplices[t];
            let corners = complex.corners(t);
            let mut squared = [[0.0; N]; N];
            // Squared lengths that are larger surely are those of longer edges.
            let mut surely = squared;
            for i in 0..N {
                for j in 0..i {
                    squared[i][j] = vector::squared_norm(vector::minus(corners[i], corners[j]));
                    surely[i][j] = surely_larger(squared[i][j]);
                    surely[j][i] = surely[i][j];
                }
            }
            // One bit for each of `EDGES`: nothing could predict a branch for each.
            let mut found = 0u32;
            let mut bit = 1;
            for i in 0..N {
                for j in 0..i {
                    let mut is_candidate = true;
                    for k in (0..N).filter(|&k| k != i && k != j) {
                        let is_longest = (squared[i][j] > surely[i][k]) & (squared[i][j] > surely[j][k]);
                        is_candidate &= is_lowest[k] & !is_longest;
                    }
                    found |= bit * u32::from(is_candidate);
                    bit <<= 1;
                }
            }
            while found != 0 {
                let [i, j] = EDGES[found.trailing_zeros() as usize];
                found &= found - 1;
                let [v, w] = [simplex[i], simplex[j]];
                let length = SquaredLength::new(corners[i], corners[j]);
                candidates.push(Candidate { length, edge: [v.min(w), v.max(w)] });
            }
        }
        candidates
    });
    parallel::joined(ranges)
}

/// Returns the edges that connect what shorter ones do not, in their order (Osipov, Sanders and
/// Singler, *The filter-Kruskal minimum spanning tree algorithm*, 2009): the longer half is looked
/// at after the shorter one, and what that has connected is dropped before it is sorted.
///
/// Until they are sorted, candidates stay in their order, in which neighbours are near each other,
/// so that the sets that are looked up are at hand.
fn kruskal(
    vertices: usize,
    candidates: Vec<Candidate>,
    compare: impl Fn(&Candidate, &Candidate) -> Ordering,
) -> Vec<Candidate> {
    let mut sets = DisjointSets::new(vertices);
    let mut tree = Vec::with_capacity(vertices);
    // The longest edges first.
    let mut pending = vec![candidates];
    while let Some(mut edges) = pending.pop() {
        if !tree.is_empty() {
            edges.retain(|&Candidate { edge: [a, b], .. }| sets.find(a) != sets.find(b));
        }
        if edges.len() > SORTED {
            // The median of some.
            let mut sample: Vec<Candidate> = edges.iter().step_by(edges.len() / SAMPLE).copied().collect();
            let middle = sample.len() / 2;
            let (_, &mut pivot, _) = sample.select_nth_unstable_by(middle, &compare);
            let longer = split_off(&mut edges, |edge| compare(edge, &pivot).is_gt());
            // There are none where most are the same edge.
            if !longer.is_empty() {
                pending.extend([longer, edges]);
                continue;
            }
        }
        edges.sort_unstable_by(&compare);
        tree.extend(edges.into_iter().filter(|&Candidate { edge: [a, b], .. }| sets.unite(a, b)));
    }
    tree
}

/// Removes the edges that are long and returns them. All stay in their order.
fn split_off(edges: &mut Vec<Candidate>, is_long: impl Fn(&Candidate) -> bool) -> Vec<Candidate> {
    const BLOCK: usize = 1 << 8;
    let mut longer = Vec::with_capacity(edges.len() / 2 + edges.len() / 16);
    let mut block = [edges[0]; BLOCK];
    let mut short = 0;
    for start in (0..edges.len()).step_by(BLOCK) {
        let mut long = 0;
        for i in start..(start + BLOCK).min(edges.len()) {
            let edge = edges[i];
            // Without a branch, which nothing could predict.
            edges[short] = edge;
            block[long] = edge;
            let is_long = usize::from(is_long(&edge));
            short += 1 - is_long;
            long += is_long;
        }
        longer.extend_from_slice(&block[..long]);
    }
    edges.truncate(short);
    longer
}
