//! The star of a vertex, represented by its link: the triangles that form tetrahedra with the
//! vertex.
//!
//! A triangle (a, b, c) is counter-clockwise as seen from outside: s, a, b, c is positively
//! oriented for the star's vertex s. A star is *convex* if, lifted to R⁴, it is the boundary of a
//! convex cone, that is, if no tetrahedron's circumsphere contains a vertex of the link. Infinity
//! is one of the points of every star, though it is not on the link of a star that surrounds its
//! vertex.

use crate::d3::splay::{Aborted, predicates::StarPredicates};
use crate::d3::{mesh::FACETS, triangulation::Triangulation3};
use crate::index::NONE;

/// A triangle of a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Triangle {
    /// Counter-clockwise as seen from outside; all are [`NONE`] in an unused slot.
    pub(super) vertices: [u32; 3],
    /// Entry *k* is across the edge opposite corner *k*: 4·(triangle) + (corner opposite the edge
    /// there).
    pub(super) neighbors: [u32; 3],
    /// The tetrahedron of the triangulation to which it belongs, or [`NONE`].
    pub(super) tetrahedron: u32,
    /// What the insertion with number `epoch` found out: 2·epoch if the triangle is visible,
    /// 2·epoch + 1 if it is hidden.
    seen: u32,
}

impl Triangle {
    pub(super) fn new(vertices: [u32; 3]) -> Self {
        Triangle { vertices, neighbors: [NONE; 3], tetrahedron: NONE, seen: 0 }
    }

    pub(super) fn is_used(&self) -> bool {
        self.vertices[0] != NONE
    }

    /// Returns how many corners it has in common with a tetrahedron, without a branch.
    fn common(&self, tetrahedron: [u32; 4]) -> u32 {
        self.vertices.iter().map(|v| tetrahedron.iter().map(|w| u32::from(v == w)).sum::<u32>()).sum()
    }
}

/// The star of one vertex.
#[derive(Debug, Clone)]
pub(super) struct Star {
    pub(super) vertex: u32,
    pub(super) triangles: Vec<Triangle>,
    /// The unused slot that is taken next, or [`NONE`]. It has the one after that in place of a neighbour.
    free: u32,
    /// A triangle that was created recently, where the next walk starts.
    recent: u32,
    /// The number of insertions.
    epoch: u32,
}

/// What an insertion changed, and lists that insertions reuse.
#[derive(Debug, Default)]
pub(super) struct Changes {
    /// Triangles that are no longer in the link.
    pub(super) removed: Vec<Triangle>,
    /// The slots of the new triangles.
    pub(super) added: Vec<u32>,
    visible: Vec<u32>,
    /// The edges between visible and hidden triangles: start, end, and what lies beyond, packed.
    horizon: Vec<(u32, u32, u32)>,
}

/// Finds the tetrahedra around a vertex.
#[derive(Debug, Default)]
pub(super) struct LinkFinder {
    /// The memory of stars that are no longer needed.
    spare: Vec<Vec<Triangle>>,
    around: Vec<Around>,
    /// A hash table of these tetrahedra, each with its place in `around`, or [`NOTHING`]. At most half of it
    /// is used. With a map of the standard library, splaying takes 7 % longer.
    table: Vec<[u32; 2]>,
}

/// An unused entry of a table.
const NOTHING: [u32; 2] = [NONE; 2];

/// A tetrahedron around a vertex.
///
/// All of it is read when it is found, and what it is used for later does not decide branches: so the
/// processor need not wait for memory, where tetrahedra lie far from each other.
#[derive(Debug, Clone, Copy)]
struct Around {
    tetrahedron: u32,
    /// Its corner at the vertex.
    corner: u32,
    vertices: [u32; 4],
    neighbors: [u32; 4],
}

/// The place in [`FACETS`]`[k]` of each corner but *k*.
const PLACES: [[u32; 4]; 4] = {
    let mut places = [[0; 4]; 4];
    let mut i = 0;
    while i < 12 {
        places[i / 3][FACETS[i / 3][i % 3]] = (i % 3) as u32;
        i += 1;
    }
    places
};

impl LinkFinder {
    /// The entries of a table at first, a power of two: most stars have fewer than half as many tetrahedra.
    const ENTRIES: usize = 1 << 7;
    /// Tables larger than this are replaced, because clearing them takes longer than most stars do.
    const MAX_TO_CLEAR: usize = 1 << 11;

    /// Adds tetrahedron `t` to `around`, if it is new. Returns its place there.
    #[inline]
    fn visit(&mut self, mesh: &Triangulation3, t: u32, vertex: u32) -> Result<u32, Aborted> {
        let at = self.entry(t);
        let [found, place] = self.table[at];
        if found == t {
            return Ok(place);
        }
        let vertices = mesh.vertices(t);
        let corner = (1..4).map(|k| if vertices[k] == vertex { k as u32 } else { 0 }).sum::<u32>() % 4;
        if vertices[corner as usize] != vertex {
            return Err(Aborted::Inconsistent("a link leads to a tetrahedron without its vertex"));
        }
        let place = self.around.len() as u32;
        self.table[at] = [t, place];
        self.around.push(Around { tetrahedron: t, corner, vertices, neighbors: mesh.neighbors[t as usize] });
        if 2 * self.around.len() > self.table.len() {
            self.grow();
        }
        Ok(place)
    }

    /// Returns which entry of the table is that of tetrahedron `t`, or the unused one where it belongs.
    #[inline]
    fn entry(&self, t: u32) -> usize {
        let mask = self.table.len() - 1;
        let mut at = (t.wrapping_mul(0x9e37_79b9) >> (mask as u32).leading_zeros()) as usize;
        while self.table[at] != NOTHING && self.table[at][0] != t {
            at = (at + 1) & mask;
        }
        at
    }

    /// Makes the table twice as large.
    #[cold]
    fn grow(&mut self) {
        self.table = vec![NOTHING; 2 * self.table.len()];
        for place in 0..self.around.len() {
            let t = self.around[place].tetrahedron;
            let at = self.entry(t);
            self.table[at] = [t, place as u32];
        }
    }

    /// Frees the memory that no star has used.
    pub(super) fn forget_spare(&mut self) {
        self.spare.clear();
    }

    /// Keeps the memory of a star, for another one.
    pub(super) fn keep(&mut self, star: Star) {
        self.spare.push(star.triangles);
    }

    /// Returns the star of `vertex` in the triangulation, given one of its tetrahedra, `start`.
    pub(super) fn star(&mut self, mesh: &Triangulation3, vertex: u32, start: u32) -> Result<Star, Aborted> {
        if start as usize >= mesh.tetrahedra.len() {
            return Err(Aborted::Inconsistent("a vertex has no tetrahedron"));
        }
        self.around.clear();
        match self.table.len() {
            1..=Self::MAX_TO_CLEAR => self.table.fill(NOTHING),
            _ => self.table = vec![NOTHING; Self::ENTRIES],
        }
        self.visit(mesh, start, vertex)?;
        let mut triangles = self.spare.pop().unwrap_or_else(|| Vec::with_capacity(Self::ENTRIES / 2));
        triangles.clear();
        while let Some(&Around { tetrahedron, corner, vertices: v, neighbors: across }) =
            self.around.get(triangles.len())
        {
            let facet = FACETS[corner as usize % 4];
            let mut triangle = Triangle { tetrahedron, ..Triangle::new(facet.map(|k| v[k])) };
            for (neighbor, k) in triangle.neighbors.iter_mut().zip(facet) {
                let place = self.visit(mesh, across[k] >> 2, vertex)?;
                let corner = self.around[place as usize].corner;
                // The facet is not opposite the vertex, since it has it.
                *neighbor = 4 * place + PLACES[corner as usize % 4][across[k] as usize % 4];
            }
            triangles.push(triangle);
        }
        Ok(Star::new(vertex, triangles))
    }
}

impl Star {
    fn new(vertex: u32, triangles: Vec<Triangle>) -> Self {
        Star { vertex, triangles, free: NONE, recent: 0, epoch: 0 }
    }

    /// Builds the convex star of `vertex` among `points`, infinity and the spanning tetrahedron.
    pub(super) fn from_points(
        predicates: &StarPredicates<'_>,
        vertex: u32,
        points: impl Iterator<Item = u32>,
        changes: &mut Changes,
    ) -> Result<Self, Aborted> {
        let spanning = predicates.spanning();
        let infinite = predicates.infinite();
        let first = spanning.map(|w| if w == vertex { infinite } else { w });
        let mut star = Star::new(vertex, Vec::new());
        let facet = |k: usize| FACETS[k].map(|i| first[i]);
        let inverted = predicates.conflict(star.tetrahedron(facet(0)), first[0]) > 0;
        for (k, [i, j, l]) in FACETS.into_iter().enumerate() {
            // The edge that facets k and i share lies opposite corner i of one and corner k of the
            // other.
            let edge = |i: usize| {
                let corner = if inverted { [0, 2, 1].map(|c| FACETS[i][c]) } else { FACETS[i] };
                4 * i as u32 + corner.iter().position(|&c| c == k).map_or(0, |c| c as u32)
            };
            let order = if inverted { [i, l, j] } else { [i, j, l] };
            star.triangles.push(Triangle { neighbors: order.map(edge), ..Triangle::new(order.map(|i| first[i])) });
        }
        if !first.contains(&infinite) {
            // These four vertices need not surround the star's vertex, so a walk might not find the
            // way.
            if let Some(start) = star.scan(predicates, infinite) {
                star.insert_from(predicates, infinite, start, changes)?;
            }
        }
        for p in points.filter(|p| !first.contains(p) && *p != infinite) {
            star.insert(predicates, p, changes)?;
        }
        changes.removed.clear();
        changes.added.clear();
        Ok(star)
    }

    /// Returns the vertices of the tetrahedron of a triangle.
    pub(super) fn tetrahedron(&self, [a, b, c]: [u32; 3]) -> [u32; 4] {
        [self.vertex, a, b, c]
    }

    /// Returns an iterator over the triangles in use.
    pub(super) fn used(&self) -> impl Iterator<Item = &Triangle> {
        self.triangles.iter().filter(|t| t.is_used())
    }

    /// Returns whether the tetrahedra, which are positively oriented, surely go around the vertex once.
    ///
    /// Where a triangulation has inverted tetrahedra, others may go around a vertex twice: in each
    /// direction from it there are two.
    pub(super) fn winds_once(&self, predicates: &StarPredicates<'_>) -> bool {
        let count = |p: u32| -> Option<usize> {
            let mut count = 0;
            for &Triangle { vertices: [a, b, c], .. } in self.used() {
                let mut is_within = true;
                for (a, b) in [(a, b), (b, c), (c, a)] {
                    match predicates.orient([self.vertex, a, b, p]) {
                        0 => return None,
                        sign => is_within &= sign > 0,
                    }
                    if !is_within {
                        break;
                    }
                }
                count += usize::from(is_within);
            }
            Some(count)
        };
        // Where a direction meets an edge, another one decides.
        let directions = predicates.spanning().into_iter().filter(|&p| p != self.vertex && !self.has(p));
        directions.filter_map(count).next() == Some(1)
    }

    /// Returns whether a vertex is on the link. Faster than a walk to it.
    pub(super) fn has(&self, v: u32) -> bool {
        self.triangles.iter().any(|t| t.vertices.map(|w| v == w) != [false; 3])
    }

    /// Returns a vertex of the link that lies inside the circumsphere of a positively oriented
    /// tetrahedron.
    pub(super) fn witness(&self, predicates: &StarPredicates<'_>, tetrahedron: [u32; 4]) -> Option<u32> {
        let conflicts = |&v: &u32| !tetrahedron.contains(&v) && predicates.conflict(tetrahedron, v) > 0;
        // Where the link has an edge of the tetrahedron, the star's facets at that edge have all other points on
        // one side, so that the apex of one of them is such a vertex.
        let beside = self.used().filter(|t| t.common(tetrahedron) == 2);
        if let Some(v) = beside.flat_map(|t| t.vertices).find(conflicts) {
            return Some(v);
        }
        // Most vertices are the first corner of some triangle.
        let mut corners = (0..3).flat_map(|k| self.used().map(move |t| t.vertices[k]));
        corners.find(conflicts)
    }

    /// Returns a triangle of the link that has most corners in common with a tetrahedron.
    fn nearest(&self, tetrahedron: [u32; 4]) -> u32 {
        let (mut nearest, mut most) = (self.recent, 0);
        for (t, triangle) in (0..).zip(&self.triangles) {
            let common = triangle.common(tetrahedron);
            if common > most {
                (nearest, most) = (t, common);
            }
        }
        nearest
    }

    /// Adds the point `p` to the star; `changes` says how. Returns `false` if `p` is already a
    /// vertex of the link, or is enclosed by the star.
    pub(super) fn insert(
        &mut self,
        predicates: &StarPredicates<'_>,
        p: u32,
        changes: &mut Changes,
    ) -> Result<bool, Aborted> {
        let start = self.locate(predicates, p);
        self.insert_seen(predicates, p, start, changes)
    }

    /// Adds the point `p` as [`insert`](Self::insert) does. `p` is one of the vertices of `tetrahedron`, or
    /// inside its circumsphere: so the triangle that has most of its vertices is tried before a walk.
    pub(super) fn insert_near(
        &mut self,
        predicates: &StarPredicates<'_>,
        p: u32,
        tetrahedron: [u32; 4],
        changes: &mut Changes,
    ) -> Result<bool, Aborted> {
        self.recent = self.nearest(tetrahedron);
        let sees = self.sees(predicates, p, self.recent);
        let start = if sees { Some(self.recent) } else { self.locate(predicates, p) };
        self.insert_seen(predicates, p, start, changes)
    }

    /// Adds the point `p`, which sees the triangle `start`, or none.
    fn insert_seen(
        &mut self,
        predicates: &StarPredicates<'_>,
        p: u32,
        start: Option<u32>,
        changes: &mut Changes,
    ) -> Result<bool, Aborted> {
        changes.removed.clear();
        changes.added.clear();
        match start {
            None => Ok(false),
            Some(start) => self.insert_from(predicates, p, start, changes).map(|()| true),
        }
    }

    /// Returns whether `p` sees a triangle from outside, that is, lies inside the circumsphere of
    /// its tetrahedron.
    fn sees(&self, predicates: &StarPredicates<'_>, p: u32, triangle: u32) -> bool {
        let corners = self.triangles[triangle as usize].vertices;
        !corners.contains(&p) && predicates.conflict(self.tetrahedron(corners), p) > 0
    }

    /// Returns any triangle that `p` sees.
    fn scan(&self, predicates: &StarPredicates<'_>, p: u32) -> Option<u32> {
        (0..self.triangles.len() as u32).find(|&t| self.triangles[t as usize].is_used() && self.sees(predicates, p, t))
    }

    /// Returns a triangle that `p` sees. If `p` sees any, it sees the triangle that the vertical
    /// through it meets: a walk in R³ finds it, across the edges that separate a triangle from `p`.
    fn locate(&self, predicates: &StarPredicates<'_>, p: u32) -> Option<u32> {
        let mut t = self.recent;
        let mut came_through = 3;
        'walk: for _ in 0..self.triangles.len() {
            let Triangle { vertices: v, neighbors, .. } = self.triangles[t as usize];
            if v.contains(&p) {
                return None;
            }
            for k in 0..3 {
                if k != came_through && predicates.orient([self.vertex, v[(k + 1) % 3], v[(k + 2) % 3], p]) < 0 {
                    t = neighbors[k] >> 2;
                    came_through = neighbors[k] as usize & 3;
                    continue 'walk;
                }
            }
            return self.sees(predicates, p, t).then_some(t);
        }
        self.scan(predicates, p)
    }

    /// Replaces the triangles that `p` sees, of which `start` is one, by triangles from `p` to the
    /// horizon (beneath-beyond).
    fn insert_from(
        &mut self,
        predicates: &StarPredicates<'_>,
        p: u32,
        start: u32,
        changes: &mut Changes,
    ) -> Result<(), Aborted> {
        const CONVEX: Aborted = Aborted::Inconsistent("a point sees a star as if it were not convex");
        self.epoch += 1;
        let (visible, hidden) = (2 * self.epoch, 2 * self.epoch + 1);
        let Changes { removed, added, visible: list, horizon } = changes;
        list.clear();
        list.push(start);
        self.triangles[start as usize].seen = visible;
        let mut edges = 0;
        let mut first = None;
        let mut next = 0;
        while let Some(&t) = list.get(next) {
            next += 1;
            for k in 0..3 {
                let other = self.triangles[t as usize].neighbors[k] >> 2;
                if self.triangles[other as usize].seen < visible {
                    let sees = self.sees(predicates, p, other);
                    self.triangles[other as usize].seen = if sees { visible } else { hidden };
                    if sees {
                        list.push(other);
                    }
                }
                if self.triangles[other as usize].seen == hidden {
                    edges += 1;
                    first = Some((t, k));
                }
            }
        }
        // Follows the horizon, turning about its vertices on the visible side.
        let (mut t, mut k) = first.ok_or(CONVEX)?;
        horizon.clear();
        for _ in 0..edges {
            let Triangle { vertices: v, neighbors, .. } = self.triangles[t as usize];
            horizon.push((v[(k + 1) % 3], v[(k + 2) % 3], neighbors[k]));
            k = (k + 1) % 3;
            for _ in 0..=list.len() {
                let across = self.triangles[t as usize].neighbors[k];
                if self.triangles[across as usize / 4].seen == hidden {
                    break;
                }
                t = across >> 2;
                k = (across as usize % 4 + 1) % 3;
            }
        }
        if edges < 3 || first != Some((t, k)) {
            return Err(CONVEX);
        }
        for &t in list.iter() {
            removed.push(self.triangles[t as usize]);
            self.release(t);
        }
        added.clear();
        for &(from, to, beyond) in horizon.iter() {
            let new = self.push(Triangle::new([p, from, to]));
            self.join(4 * new, beyond);
            if let Some(&last) = added.last() {
                self.join(4 * last + 1, 4 * new + 2);
            }
            added.push(new);
        }
        self.join(4 * added[added.len() - 1] + 1, 4 * added[0] + 2);
        self.recent = added[0];
        Ok(())
    }

    /// Makes two edges each other's neighbours.
    pub(super) fn join(&mut self, e: u32, f: u32) {
        self.triangles[e as usize / 4].neighbors[e as usize % 4] = f;
        self.triangles[f as usize / 4].neighbors[f as usize % 4] = e;
    }

    /// Adds a triangle in an unused slot, or in a new one.
    fn push(&mut self, triangle: Triangle) -> u32 {
        match self.free {
            NONE => {
                self.triangles.push(triangle);
                self.triangles.len() as u32 - 1
            }
            slot => {
                self.free = self.triangles[slot as usize].neighbors[0];
                self.triangles[slot as usize] = triangle;
                slot
            }
        }
    }

    /// Marks the slot of triangle `t` as unused.
    pub(super) fn release(&mut self, t: u32) {
        let triangle = &mut self.triangles[t as usize];
        triangle.vertices = [NONE; 3];
        triangle.neighbors[0] = std::mem::replace(&mut self.free, t);
    }

    /// Sets the triangle at which walks start.
    pub(super) fn set_recent(&mut self, t: u32) {
        self.recent = t;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{input::lattice::Lattice, predicates::filter::PredicateContext};

    /// Returns the star of the origin whose link has two poles, and six vertices around it that go
    /// round so many times.
    fn star_of_turns(turns: u32, test: impl Fn(&StarPredicates<'_>, &Star)) {
        let mut points = vec![[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        points.extend((0..6).map(|k| {
            let (sin, cos) = (f64::from(k * turns) * std::f64::consts::TAU / 6.0).sin_cos();
            let radius = 1.0 + f64::from(k) / 8.0;
            [radius * cos, radius * sin, f64::from(k) / 64.0]
        }));
        // A spanning tetrahedron, in whose directions there are no edges.
        points.extend([[9.0, 1.0, 2.0], [-8.0, 3.0, 1.0], [1.0, -7.0, 4.0], [2.0, 3.0, -9.0]]);
        let lattice = Lattice::fit((&points).into());
        let vertices = PredicateContext::new((&points).into(), &lattice, (0..points.len() as u32).collect());
        let predicates = StarPredicates::new(&vertices, points.len() as u32, [9, 10, 11, 12]);
        let around = (0..6).map(|k| [3 + k, 3 + (k + 1) % 6]);
        let triangles = around.flat_map(|[a, b]| [Triangle::new([1, a, b]), Triangle::new([2, b, a])]).collect();
        let star = Star::new(0, triangles);
        assert!(star.used().all(|t| predicates.orient(star.tetrahedron(t.vertices)) > 0));
        test(&predicates, &star);
    }

    #[test]
    fn a_star_that_goes_round_twice_is_recognized() {
        star_of_turns(1, |predicates, star| assert!(star.winds_once(predicates)));
        star_of_turns(2, |predicates, star| assert!(!star.winds_once(predicates)));
    }
}
