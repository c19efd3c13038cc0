//! Facets of a surface that intersect others, exactly.

use crate::{
    geometry::{Euclidean, Geometry},
    parallel::{self, Threads},
};

/// Ranges of so few facets are looked at one by one.
const LEAF: usize = 8;

/// The number of facets that is worth handing to another thread.
const GRAIN: usize = 1 << 10;

/// The smallest and the largest coordinates.
type Bounds<const D: usize> = [[f64; D]; 2];

/// Returns the facets that intersect facets with which they share at most one corner. Coplanar facets do not
/// count.
pub fn facets<const D: usize, const N: usize>(facets: &[[u32; D]], vertices: &[[f64; D]]) -> Vec<u32>
where
    Euclidean: Geometry<D, N>,
{
    let corners: Vec<[[f64; D]; D]> = facets.iter().map(|facet| facet.map(|v| vertices[v as usize])).collect();
    let tree = Tree::new(&corners);
    let parts = parallel::map_grains(Threads::All, corners.len(), GRAIN, |range| {
        let mut stack = Vec::new();
        let crosses = |&f: &usize| tree.any_near(f, &mut stack, |other| cross(&corners[f], &corners[other]));
        range.filter(crosses).map(|f| f as u32).collect::<Vec<u32>>()
    });
    parallel::joined(parts)
}

/// Returns whether two facets intersect that share at most one corner.
fn cross<const D: usize, const N: usize>(a: &[[f64; D]; D], b: &[[f64; D]; D]) -> bool
where
    Euclidean: Geometry<D, N>,
{
    let is_shared = |p: &[f64; D], facet: &[[f64; D]; D]| facet.contains(p);
    let count = a.iter().filter(|p| is_shared(p, b)).count();
    if D == 2 {
        return count == 0 && is_crossed(a, b[0], b[1]) && is_crossed(b, a[0], a[1]);
    }
    // Of facets that share a corner, only the edges opposite it may reach into the other.
    let edges = |facet: &[[f64; D]; D], other: &[[f64; D]; D]| {
        let facet = *facet;
        let is_free: Vec<bool> = facet.iter().map(|p| !is_shared(p, other)).collect();
        (0..D)
            .map(move |k| (k, (k + 1) % D))
            .filter(move |&(k, l)| is_free[k] && is_free[l])
            .map(move |(k, l)| [facet[k], facet[l]])
    };
    count <= 1 && (edges(a, b).any(|[p, q]| is_crossed(b, p, q)) || edges(b, a).any(|[p, q]| is_crossed(a, p, q)))
}

/// Returns whether an edge from `p` to `q` meets a facet in one point; in 2D, whether it meets its line.
fn is_crossed<const D: usize, const N: usize>(facet: &[[f64; D]; D], p: [f64; D], q: [f64; D]) -> bool
where
    Euclidean: Geometry<D, N>,
{
    let sides = [p, q].map(|p| Euclidean::side(facet, p));
    if sides[0] * sides[1] > 0 || sides == [0, 0] {
        return false;
    }
    // The edge passes all edges of the facet on the same side.
    let turns = |k: usize| {
        let mut plane = *facet;
        (plane[0], plane[1], plane[D - 1]) = (p, q, facet[k]);
        Euclidean::side(&plane, facet[(k + 1) % D])
    };
    D == 2 || {
        let signs = [turns(0), turns(1 % D), turns(2 % D)];
        signs.iter().all(|&sign| sign >= 0) || signs.iter().all(|&sign| sign <= 0)
    }
}

/// A tree of boxes around facets.
struct Tree<const D: usize> {
    bounds: Vec<Bounds<D>>,
    order: Vec<u32>,
    nodes: Vec<Node<D>>,
}

/// A range of facets. The first half of it is the next node, unless it is small.
struct Node<const D: usize> {
    bounds: Bounds<D>,
    start: usize,
    end: usize,
    /// The node of the second half.
    second: usize,
}

impl<const D: usize> Tree<D> {
    fn new(corners: &[[[f64; D]; D]]) -> Self {
        let around = |facet: &[[f64; D]; D]| facet.iter().fold(nowhere(), |bounds, &p| joined(&bounds, &[p, p]));
        let mut tree = Tree {
            bounds: corners.iter().map(around).collect(),
            order: (0..corners.len() as u32).collect(),
            nodes: Vec::new(),
        };
        // Ranges, and the nodes whose second halves they are.
        let mut ranges = vec![(0, corners.len(), usize::MAX)];
        while let Some((start, end, parent)) = ranges.pop() {
            let number = tree.nodes.len();
            if let Some(parent) = tree.nodes.get_mut(parent) {
                parent.second = number;
            }
            let range = &mut tree.order[start..end];
            let bounds = range.iter().fold(nowhere(), |all, &f| joined(&all, &tree.bounds[f as usize]));
            tree.nodes.push(Node { bounds, start, end, second: 0 });
            if end - start > LEAF {
                let extent = |axis: usize| bounds[1][axis] - bounds[0][axis];
                let axis = (1..D).fold(0, |widest, axis| if extent(axis) > extent(widest) { axis } else { widest });
                let middle = |f: u32| tree.bounds[f as usize][0][axis] + tree.bounds[f as usize][1][axis];
                let half = range.len() / 2;
                range.select_nth_unstable_by(half, |&f, &g| middle(f).total_cmp(&middle(g)));
                ranges.extend([(start + half, end, number), (start, start + half, usize::MAX)]);
            }
        }
        tree
    }

    /// Returns whether one of the facets whose boxes touch that of facet `f` satisfies a condition.
    fn any_near(&self, f: usize, stack: &mut Vec<usize>, is: impl Fn(usize) -> bool) -> bool {
        let bounds = &self.bounds[f];
        stack.clear();
        stack.push(0);
        while let Some(number) = stack.pop() {
            let node = &self.nodes[number];
            if !touch(&node.bounds, bounds) {
                continue;
            }
            if node.end - node.start > LEAF {
                stack.extend([number + 1, node.second]);
                continue;
            }
            let others = self.order[node.start..node.end].iter().map(|&other| other as usize);
            if others.filter(|&other| other != f && touch(&self.bounds[other], bounds)).any(&is) {
                return true;
            }
        }
        false
    }
}

/// Returns the bounds of no points.
fn nowhere<const D: usize>() -> Bounds<D> {
    [[f64::INFINITY; D], [f64::NEG_INFINITY; D]]
}

fn joined<const D: usize>(a: &Bounds<D>, b: &Bounds<D>) -> Bounds<D> {
    let extreme = |side: usize, of: fn(f64, f64) -> f64| std::array::from_fn(|axis| of(a[side][axis], b[side][axis]));
    [extreme(0, f64::min), extreme(1, f64::max)]
}

fn touch<const D: usize>(a: &Bounds<D>, b: &Bounds<D>) -> bool {
    (0..D).all(|axis| a[0][axis] <= b[1][axis] && b[0][axis] <= a[1][axis])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_that_meet_in_other_places_than_corners_cross() {
        let vertices = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [0.0, 4.0, 0.0],
            [1.0, 1.0, -1.0],
            [1.0, 1.0, 1.0],
            [2.0, 1.0, 1.0],
            [9.0, 9.0, -1.0],
            [1.0, 1.0, 0.0],
            [-3.0, -3.0, 3.0],
        ];
        let found = |others: &[[u32; 3]]| facets(&[&[[0, 1, 2]], others].concat(), &vertices);
        assert_eq!(found(&[[3, 4, 5]]), [0, 1]);
        assert_eq!(found(&[[4, 5, 6]]), [0; 0]);
        // A corner on the triangle.
        assert_eq!(found(&[[7, 4, 5]]), [0, 1]);
        // A common corner, with the other edge beside the triangle and through it; a common edge.
        assert_eq!(found(&[[0, 4, 8]]), [0; 0]);
        assert_eq!(found(&[[0, 3, 4]]), [0, 1]);
        assert_eq!(found(&[[1, 0, 3]]), [0; 0]);
        let many: Vec<[u32; 3]> = (0..40).flat_map(|_| [[1, 0, 3], [0, 1, 4]]).collect();
        assert_eq!(found(&many), [0; 0]);
        let plane = [[0.0, 0.0], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0], [3.0, 0.0]];
        assert_eq!(facets(&[[0, 1], [2, 3]], &plane), [0, 1]);
        assert_eq!(facets(&[[0, 1], [1, 2], [3, 4]], &plane), [0; 0]);
    }
}
