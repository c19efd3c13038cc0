//! Flip-Flop (Gao, Cao, Tan, Huang 2013; §3.2.1): flips make a star of the triangulation convex.
//!
//! 1. *Flip* an edge whose two tetrahedra are in conflict, if the result surrounds the star's
//!    vertex as before: the star, lifted, becomes wider.
//! 2. If it would not, one end of the edge is enclosed by the other three vertices, and is not a
//!    vertex of the convex star. *Flop* its edges away, whichever can be flipped, until three are
//!    left; then remove it.
//!
//! Every vertex is removed at most once, and between two removals the star only becomes wider; so
//! Flip-Flop ends. Where four points are coplanar with the star's vertex, there may be no edge to
//! flop: such a star is built from its points instead.

use crate::d3::splay::{
    predicates::StarPredicates,
    star::{Star, Triangle},
};
use crate::index::NONE;

/// The maximum number of flips per triangle of the link. A star that needs more is built from its
/// points.
const MAX_FLIPS_PER_TRIANGLE: usize = 16;

/// Makes a star convex whose tetrahedra are positively oriented, and whose edges are locally convex
/// unless both ends `may_fail`. Returns the number of flips, or `None` if it gets stuck or exceeds
/// its bound.
///
/// New triangles have no tetrahedron of the triangulation. Triangles that had one and no longer
/// exist are added to `removed`. The contents of `edges` are discarded.
pub(super) fn flip_flop(
    star: &mut Star,
    predicates: &StarPredicates<'_>,
    may_fail: impl Fn(u32) -> bool,
    edges: &mut Vec<u32>,
    removed: &mut Vec<Triangle>,
) -> Option<usize> {
    edges.clear();
    let mut work = Flipping { budget: MAX_FLIPS_PER_TRIANGLE * star.triangles.len(), flips: 0, edges, removed };
    for (t, triangle) in star.triangles.iter().enumerate() {
        let t = t as u32;
        let may_fail = triangle.vertices.map(&may_fail);
        let is_open = |&k: &usize| triangle.neighbors[k] >> 2 > t && may_fail[(k + 1) % 3] && may_fail[(k + 2) % 3];
        work.edges.extend((0..3).filter(is_open).map(|k| 4 * t + k as u32));
    }
    while let Some(edge) = work.edges.pop() {
        let Some(corners) = Corners::of(star, edge) else { continue };
        let Corners { a, b, c, d } = corners;
        if predicates.conflict(star.tetrahedron([c, a, b]), d) <= 0 {
            continue;
        }
        // The end that c, d and the other end enclose, if there is one.
        let a_inside = predicates.orient(star.tetrahedron([c, a, d])) <= 0;
        let b_inside = predicates.orient(star.tetrahedron([d, b, c])) <= 0;
        match (a_inside, b_inside) {
            (false, false) => work.flip(star, edge)?,
            (true, false) => work.remove(star, predicates, edge >> 2, a)?,
            (false, true) => work.remove(star, predicates, edge >> 2, b)?,
            (true, true) => return None,
        }
    }
    let used = star.triangles.iter().position(Triangle::is_used)?;
    star.set_recent(used as u32);
    Some(work.flips)
}

/// The ends of an edge, and the corners opposite it: the triangles are (c, a, b) and (d, b, a).
struct Corners {
    a: u32,
    b: u32,
    c: u32,
    d: u32,
}

impl Corners {
    /// Returns `None` for an edge of a triangle that no longer exists.
    fn of(star: &Star, edge: u32) -> Option<Self> {
        let (t, k) = (star.triangles[edge as usize / 4], edge as usize % 4);
        let across = t.neighbors[k];
        let v = t.vertices;
        t.is_used().then(|| Corners {
            a: v[(k + 1) % 3],
            b: v[(k + 2) % 3],
            c: v[k],
            d: star.triangles[across as usize / 4].vertices[across as usize % 4],
        })
    }
}

/// A run of Flip-Flop.
struct Flipping<'a> {
    budget: usize,
    flips: usize,
    /// Edges that may be in conflict; some no longer exist.
    edges: &'a mut Vec<u32>,
    /// Triangles of the triangulation that no longer exist.
    removed: &'a mut Vec<Triangle>,
}

impl Flipping<'_> {
    /// Counts a flip. Returns `None` if the budget is exceeded.
    fn count(&mut self) -> Option<()> {
        self.flips += 1;
        (self.flips <= self.budget).then_some(())
    }

    /// Replaces (c, a, b), (d, b, a) by (c, a, d), (d, b, c), in the same slots. Returns `None` if
    /// the budget is exceeded.
    fn flip(&mut self, star: &mut Star, edge: u32) -> Option<()> {
        self.count()?;
        let across = star.triangles[edge as usize / 4].neighbors[edge as usize % 4];
        let (i, k) = (edge as usize / 4, edge as usize % 4);
        let (j, l) = (across as usize / 4, across as usize % 4);
        let (ti, tj) = (star.triangles[i], star.triangles[j]);
        let Corners { a, b, c, d } = Corners::of(star, edge)?;
        self.removed.extend([ti, tj].iter().filter(|t| t.tetrahedron != NONE));
        let (bc, ca) = (ti.neighbors[(k + 1) % 3], ti.neighbors[(k + 2) % 3]);
        let (ad, db) = (tj.neighbors[(l + 1) % 3], tj.neighbors[(l + 2) % 3]);
        star.triangles[i] = Triangle::new([c, a, d]);
        star.triangles[j] = Triangle::new([d, b, c]);
        let (i, j) = (4 * i as u32, 4 * j as u32);
        star.join(i + 1, j + 1);
        for (edge, beyond) in [(i, ad), (i + 2, ca), (j, bc), (j + 2, db)] {
            star.join(edge, beyond);
            self.edges.push(edge);
        }
        Some(())
    }

    /// Removes vertex `x` of triangle `t` from the link. Returns `None` if none of its edges can be
    /// flipped, or if the budget is exceeded.
    fn remove(&mut self, star: &mut Star, predicates: &StarPredicates<'_>, t: u32, x: u32) -> Option<()> {
        // The edges at x, each given by the triangle (x, v, q) on its left and the opposite corner
        // q.
        let mut spokes = Vec::new();
        let mut at = t;
        loop {
            let triangle = star.triangles[at as usize];
            let k = triangle.vertices.iter().position(|&v| v == x)?;
            spokes.push(4 * at + (k as u32 + 2) % 3);
            at = triangle.neighbors[(k + 1) % 3] >> 2;
            if at == t {
                break;
            }
            if spokes.len() > star.triangles.len() {
                return None;
            }
        }
        while spokes.len() > 3 {
            let can_flip = |&edge: &u32| {
                Corners::of(star, edge).is_some_and(|Corners { a: x, b: v, c: q, d: p }| {
                    predicates.orient(star.tetrahedron([p, v, q])) > 0
                        && predicates.orient(star.tetrahedron([q, x, p])) > 0
                })
            };
            let at = spokes.iter().position(can_flip)?;
            let edge = spokes[at];
            self.flip(star, edge)?;
            // The triangle (x, p, q) is now in the slot of (x, v, q); its edge from x to q belongs
            // to the next triangle.
            spokes.remove(at);
            let previous = (at + spokes.len() - 1) % spokes.len();
            spokes[previous] = 4 * (edge >> 2);
        }
        self.take_out(star, predicates, [spokes[0], spokes[1], spokes[2]])
    }

    /// Replaces the three triangles (x, v, q) around a vertex x by one.
    fn take_out(&mut self, star: &mut Star, predicates: &StarPredicates<'_>, spokes: [u32; 3]) -> Option<()> {
        self.count()?;
        let triangles = spokes.map(|edge| star.triangles[edge as usize / 4]);
        // In triangle i, corner q is at `spokes[i] % 4`, then follow x and v.
        let corner = |i: usize| spokes[i] as usize % 4;
        let v: [u32; 3] = std::array::from_fn(|i| triangles[i].vertices[(corner(i) + 2) % 3]);
        let beyond: [u32; 3] = std::array::from_fn(|i| triangles[i].neighbors[(corner(i) + 1) % 3]);
        let outside = beyond.iter().all(|&edge| spokes.iter().all(|spoke| spoke >> 2 != edge >> 2));
        if !outside || predicates.orient(star.tetrahedron(v)) <= 0 {
            return None;
        }
        self.removed.extend(triangles.iter().filter(|t| t.tetrahedron != NONE));
        let slot = spokes[0] >> 2;
        star.release(spokes[1] >> 2);
        star.release(spokes[2] >> 2);
        star.triangles[slot as usize] = Triangle::new(v);
        for i in 0..3u32 {
            // Beyond spoke i is the edge from vᵢ to vᵢ₊₁, opposite vᵢ₊₂.
            let edge = 4 * slot + (i + 2) % 3;
            star.join(edge, beyond[i as usize]);
            self.edges.push(edge);
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        cpu::insert_all,
        d3::{
            splay::star::{Changes, LinkFinder},
            triangulation::Triangulation3,
        },
        input::lattice::Lattice,
        options::Options,
        parallel::Threads,
        predicates::filter::PredicateContext,
    };

    fn link(star: &Star) -> Vec<[u32; 3]> {
        let mut link: Vec<[u32; 3]> = star.used().map(|t| t.vertices).collect();
        for t in &mut link {
            let least = (0..3).min_by_key(|&k| t[k]).unwrap();
            t.rotate_left(least);
        }
        link.sort_unstable();
        link
    }

    /// Flips edges of each convex star wherever it remains a star, then undoes that by Flip-Flop.
    /// Returns how often Flip-Flop was stuck.
    fn spoil_and_mend(points: &[[f64; 3]]) -> usize {
        let lattice = Lattice::fit(points.into());
        let vertices = PredicateContext::<3>::new(points.into(), &lattice, (0..points.len() as u32).collect());
        assert!(vertices.orient3d(0, 1, 2, 3) > 0);
        let mesh: Triangulation3 = insert_all(Threads::One, &vertices, &[], &Options::default()).unwrap();
        let predicates = StarPredicates::new(&vertices, mesh.infinite, [0, 1, 2, 3]);
        let mut stuck = 0;
        let mut flips = 0;
        for v in 0..vertices.len() as u32 {
            let start = (0..mesh.tetrahedra.len() as u32).find(|&t| mesh.vertices(t).contains(&v)).unwrap();
            let mut star = LinkFinder::default().star(&mesh, v, start).unwrap();
            let convex = link(&star);
            let (mut edges, mut removed) = (Vec::new(), Vec::new());
            let mut spoiling = Flipping { budget: usize::MAX, flips: 0, edges: &mut edges, removed: &mut removed };
            let mut random = v;
            for _ in 0..100 {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let edge = 4 * ((random >> 8) % star.triangles.len() as u32) + (random >> 4) % 3;
                let Corners { a, b, c, d } = Corners::of(&star, edge).unwrap();
                if [[c, a, d], [d, b, c]].iter().all(|&t| predicates.orient(star.tetrahedron(t)) > 0) {
                    spoiling.flip(&mut star, edge).unwrap();
                }
            }
            flips += spoiling.flips;
            match flip_flop(&mut star, &predicates, |_| true, &mut edges, &mut removed) {
                Some(_) => assert_eq!(link(&star), convex, "vertex {v}"),
                None => stuck += 1,
            }
            let neighbors = convex.iter().flatten().copied();
            let star = Star::from_points(&predicates, v, neighbors, &mut Changes::default()).unwrap();
            assert_eq!(link(&star), convex, "vertex {v}, from points");
        }
        assert!(flips > 0);
        stuck
    }

    #[test]
    fn flips_are_undone() {
        let mut x = 1u64;
        let mut random = || {
            x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (x >> 33) as f64 / 2f64.powi(31)
        };
        let mut points: Vec<[f64; 3]> = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        points.extend((0..300).map(|_| [random(), random(), random()]));
        assert_eq!(spoil_and_mend(&points), 0);
    }

    #[test]
    fn flips_on_a_grid_are_undone() {
        let mut points: Vec<[f64; 3]> = (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
        // The corner and its three neighbours first.
        points.swap(2, 4);
        points.swap(3, 16);
        assert_eq!(spoil_and_mend(&points), 0);
    }
}
