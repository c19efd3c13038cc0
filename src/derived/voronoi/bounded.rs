//! Bounded Voronoi diagrams, the duals of constrained Delaunay triangulations (Lee and Lin 1986; Seidel 1988).
//!
//! A cell is star-shaped around its site, and convex between two walls that begin there. Walls are constrained edges, the
//! hull, and where what is inside ends. Each such part of a cell is cut out of a box: by the bisectors with the neighbours
//! of the site that are not behind a wall, then by all walls that cross what is left. No wall ends within a cell, since
//! what is near its end is nearer to that than to the site: so a wall that does not lead through the whole part
//! is hidden behind another one, which cuts it off.

use super::{
    Clip, Diagram, Voronoi,
    cell::Cell,
    frame::Frame,
    polytope::{Polygon, Polytope},
};
use crate::{
    constrained::Constrained2,
    d2::Mesh2,
    derived::complex::{Complex, Coordinates},
    error::Error,
    geometry::{Euclidean, Geometry, circumcenter, vector},
    index::NONE,
    input::points::Points2,
    mesh::Csr,
    parallel::{self, Threads},
};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;

/// The name of the edge of a part that is no edge of the cell: another part is beyond it.
const SEAM: u32 = NONE - 1;

/// Edges that are shorter than this share of their cell are left out: they come from ties.
const SHORTEST: f64 = 1.0 / (1u64 << 40) as f64;

/// The number of cells that is worth handing to another thread.
const GRAIN: usize = 1 << 8;

impl Constrained2 {
    /// Returns the bounded Voronoi diagram of the vertices: for each, the places inside the boundaries that can see it, and
    /// that are nearer to it than to any other vertex that they can see. Constrained edges and the hull block the view. `points`
    /// are those of the mesh, the ones at crossings included.
    ///
    /// The areas of all cells add up to that of the triangles inside. A cell ends at a constrained edge, with no neighbour
    /// there, unless its site is on the edge: then it reaches to both sides. Vertices of cells that lie on a wall, or in
    /// which a cell was cut, follow the circumcentres of the triangles in [`Diagram::vertices`]; everything is rounded, and edges
    /// that are empty because of a tie are left out.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`], [`Error::NotFinite`] or [`Error::BrokenMesh`] as for [`Locator::new`](crate::Locator::new).
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Constraints, Triangulator};
    ///
    /// // A wall between the left and the right two points, with a gap below and above.
    /// let points = [[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0], [2.0, 1.0], [2.0, 3.0f64]];
    /// let wall = Constraints::new().edges(&[[4, 5]]);
    /// let cells = Triangulator::new().constrained2d(&points, &wall)?.bounded_voronoi(&points)?;
    /// assert!((cells.volumes.iter().sum::<f64>() - 24.0).abs() < 1e-12);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn bounded_voronoi<'p>(&self, points: impl Into<Points2<'p>>) -> Result<Diagram<2>, Error> {
        let points = points.into();
        let mut complex = Complex::new(&self.mesh, points)?;
        if complex.simplices.is_empty() {
            let plain = Mesh2 { constraints: Vec::new(), ..self.mesh.clone() };
            return Ok(Voronoi::new(&plain, points, Clip::Hull)?.diagram());
        }
        if self.inside.len() != complex.simplices.len() {
            return Err(Error::BrokenMesh { reason: "not every triangle is known to be inside or outside" });
        }
        let frame = Frame::of(complex.bounds());
        if let Some(frame) = frame {
            complex.points = Coordinates::Owned(frame.inner_points(points));
        }
        let sites = Sites { bounds: complex.bounds(), complex: &complex, inside: &self.inside };
        let stars = Csr::stars(&complex.simplices, complex.points().len());
        let cells = parallel::map_grains(Threads::All, complex.points().len(), GRAIN, |range| {
            let cell = |v: usize| {
                let mut cell = sites.cell(v as u32, stars.of(v as u32));
                if let Some(frame) = frame {
                    frame.restore(&mut cell);
                }
                cell
            };
            range.map(cell).collect::<Vec<_>>()
        });
        let center = |t: usize| {
            let center = circumcenter(&complex.corners(t));
            frame.map_or(center, |frame| frame.outer(center))
        };
        let centers = (0..complex.simplices.len()).map(center).collect();
        Ok(Diagram::new(centers, cells.into_iter().flatten()))
    }
}

/// A mesh in the coordinates of the frame, and which of its triangles are inside.
struct Sites<'a> {
    complex: &'a Complex<'a, 2, 3>,
    inside: &'a [bool],
    bounds: [[f64; 2]; 2],
}

/// A corner of a triangle: the triangle, and the place of the corner.
type Corner = (usize, usize);

/// The triangles around a vertex from one wall to the next, counter-clockwise.
struct Sector {
    corners: Vec<Corner>,
    /// The neighbours of the vertex, one more than triangles.
    around: Vec<u32>,
    /// Whether the last neighbour is the first one, since there is no wall.
    is_full: bool,
}

impl Sites<'_> {
    /// Returns the triangle beyond the edge opposite corner `k` of triangle `t`; `None` if the edge is a wall.
    fn across(&self, t: usize, k: usize) -> Option<usize> {
        self.complex.visible_across(t, k).filter(|&across| self.inside[across])
    }

    /// Returns whether there is a triangle inside on the other side of a wall.
    fn is_between(&self, t: usize, k: usize) -> bool {
        self.complex.across(t, k).is_some_and(|across| self.inside[across])
    }

    /// Returns the cell of a vertex with these triangles around it.
    fn cell(&self, v: u32, star: &[u32]) -> Cell<2> {
        let mut edges: Vec<Edge> = Vec::new();
        let (mut volume, mut moment) = (0.0, [0.0; 2]);
        let site = self.complex.point(v);
        for sector in self.sectors(v, star) {
            let mut start = 0;
            while start < sector.corners.len() {
                let end = self.part_end(v, &sector, start);
                let part = self.part(v, &sector, start..end);
                let corners = part.polygon.vertices();
                let names: Vec<u32> = part.polygon.names().collect();
                // From the site, if that is a corner.
                let squared = |&k: &usize| vector::squared_norm(corners[k]);
                let first = (0..corners.len()).min_by(|j, k| squared(j).total_cmp(&squared(k))).unwrap_or(0);
                for k in first..first + corners.len() {
                    let [p, q] = [k, k + 1].map(|k| corners[k % corners.len()]);
                    let name = names[k % corners.len()];
                    let doubled = vector::cross2d(p, q);
                    volume += doubled / 2.0;
                    moment = vector::plus(moment, vector::times(doubled / 6.0, vector::plus(p, q)));
                    edges.push(Edge { ends: [p, q], name });
                }
                start = end;
            }
        }
        cell_of(site, edges, volume, moment)
    }

    /// Returns the sectors around a vertex.
    fn sectors(&self, v: u32, star: &[u32]) -> Vec<Sector> {
        let corner = |t: usize| (t, self.complex.simplices[t].iter().position(|&w| w == v).unwrap_or(0));
        let inside = star.iter().map(|&t| t as usize).filter(|&t| self.inside[t]);
        // The edge that a triangle's turn begins with is opposite the corner before.
        let starts = inside.clone().map(corner).filter(|&(t, k)| self.across(t, (k + 2) % 3).is_none());
        let mut starts: Vec<Corner> = starts.collect();
        let is_full = starts.is_empty();
        starts.extend(inside.take(1).filter(|_| is_full).map(corner));
        let turn = |start: Corner| {
            let mut sector = Sector { corners: vec![start], around: Vec::new(), is_full };
            let (mut t, mut k) = start;
            sector.around.push(self.complex.simplices[t][(k + 1) % 3]);
            loop {
                sector.around.push(self.complex.simplices[t][(k + 2) % 3]);
                match self.across(t, (k + 1) % 3) {
                    // As often as there are triangles, in a mesh that is broken, too.
                    Some(next) if next != start.0 && sector.corners.len() < star.len() => (t, k) = corner(next),
                    _ => return sector,
                }
                sector.corners.push((t, k));
            }
        };
        in_order(starts.into_iter().map(turn).collect())
    }

    /// Returns where the part of a sector ends that begins with a corner: as far as it is convex.
    fn part_end(&self, v: u32, sector: &Sector, start: usize) -> usize {
        if sector.is_full {
            return sector.corners.len();
        }
        let [site, first] = [v, sector.around[start]].map(|v| self.complex.point(v));
        let is_convex = |end: &usize| {
            <Euclidean as Geometry<2, 3>>::side(&[site, first], self.complex.point(sector.around[*end])) > 0
        };
        (start + 1..=sector.corners.len()).take_while(is_convex).last().unwrap_or(start + 1)
    }

    /// Returns the part of a cell between the first edge of a sector's triangles and the last one, relative to the site.
    fn part(&self, v: u32, sector: &Sector, range: Range<usize>) -> Part {
        let site = self.complex.point(v);
        let away = |w: u32| vector::minus(self.complex.point(w), site);
        let mut part = Part::new(self.bounds.map(|corner| vector::minus(corner, site)));
        if !sector.is_full {
            // A seam, unless there is nothing inside beyond the wall.
            let ends_there = |place: usize, (t, k): Corner, opposite: usize| {
                let is_wall = place == 0 || place == sector.corners.len();
                if is_wall && !self.is_between(t, (k + opposite) % 3) { NONE } else { SEAM }
            };
            let [from, to] = [range.start, range.end].map(|place| away(sector.around[place]));
            let name = ends_there(range.start, sector.corners[range.start], 2);
            part.halve([from[1], -from[0]], 0.0, name);
            let name = ends_there(range.end, sector.corners[range.end - 1], 1);
            part.halve([-to[1], to[0]], 0.0, name);
        }
        for &w in self.neighbors(v, sector, &range) {
            part.halve(away(w), 0.5 * vector::squared_norm(away(w)), w);
        }
        let mut walls = FxHashSet::default();
        while self.cut_off(site, &sector.corners[range.clone()], &mut part, &mut walls) {}
        part.sharpen();
        part
    }

    /// Returns the neighbours of a vertex whose bisectors can bound a part of its cell: those in the sector that are less than
    /// a right angle from the part. Others are farther from it than it reaches, or behind a wall.
    fn neighbors<'s>(&self, v: u32, sector: &'s Sector, part: &Range<usize>) -> &'s [u32] {
        let around = &sector.around;
        if sector.is_full {
            return &around[1..];
        }
        let site = self.complex.point(v);
        let away = |place: usize| vector::minus(self.complex.point(around[place]), site);
        let is_near = |place: usize, end: usize| vector::dot(away(place), away(end)) > 0.0;
        let first = (0..part.start).rev().take_while(|&place| is_near(place, part.start)).last().unwrap_or(part.start);
        let last = (part.end + 1..around.len()).take_while(|&place| is_near(place, part.end)).last();
        &around[first..=last.unwrap_or(part.end)]
    }

    /// Cuts a part off at a wall that crosses it and is none of `walls`, to which it is added. Returns whether there was one.
    fn cut_off(&self, site: [f64; 2], corners: &[Corner], part: &mut Part, walls: &mut FxHashSet<Corner>) -> bool {
        let mut pending = corners.to_vec();
        let mut seen: FxHashSet<usize> = corners.iter().map(|&(t, _)| t).collect();
        while let Some((t, k)) = pending.pop() {
            let simplex = self.complex.simplices[t];
            let ends = [1, 2].map(|i| vector::minus(self.complex.point(simplex[(k + i) % 3]), site));
            let Some([from, to]) = part.shares_of(ends) else { continue };
            match self.across(t, k) {
                Some(across) if seen.insert(across) => {
                    let entry = self.complex.facet_towards(across, t);
                    pending.extend((0..3).filter(|&k| k != entry).map(|k| (across, k)));
                }
                Some(_) => {}
                None if from > 0.0 && from < to && to < 1.0 && walls.insert((t, k)) => {
                    let along = vector::minus(ends[1], ends[0]);
                    // The site is on the other side.
                    let normal = [along[1], -along[0]];
                    let offset = vector::dot(ends[0], normal);
                    let away = if offset < 0.0 { -1.0 } else { 1.0 };
                    part.halve(vector::times(away, normal), away * offset, NONE);
                    return true;
                }
                None => {}
            }
        }
        false
    }
}

/// Returns the sectors around a vertex, counter-clockwise as far as there is something inside between them.
fn in_order(sectors: Vec<Sector>) -> Vec<Sector> {
    if sectors.len() < 2 {
        return sectors;
    }
    let ends: FxHashSet<u32> = sectors.iter().filter_map(|sector| sector.around.last().copied()).collect();
    let firsts: Vec<u32> = sectors.iter().map(|sector| sector.around[0]).collect();
    let mut left: FxHashMap<u32, Sector> = firsts.iter().copied().zip(sectors).collect();
    let mut ordered: Vec<Sector> = Vec::with_capacity(firsts.len());
    // Those that nothing leads to come first.
    let (open, others): (Vec<u32>, Vec<u32>) = firsts.iter().partition(|first| !ends.contains(first));
    for first in open.into_iter().chain(others) {
        let mut next = Some(first);
        while let Some(sector) = next.and_then(|first| left.remove(&first)) {
            next = sector.around.last().copied();
            ordered.push(sector);
        }
    }
    ordered
}

/// A convex part of a cell, relative to the site.
struct Part {
    polygon: Polygon<2>,
    /// The half-planes that it is the intersection of, as x·normal ≤ offset, and the names of their edges.
    halves: Vec<([f64; 2], f64, u32)>,
}

impl Part {
    /// Returns a box.
    fn new([low, high]: [[f64; 2]; 2]) -> Self {
        let mut polygon = Polygon::default();
        polygon.reset([low, high], NONE);
        let sides = [([-1.0, 0.0], -low[0]), ([0.0, -1.0], -low[1]), ([1.0, 0.0], high[0]), ([0.0, 1.0], high[1])];
        Part { polygon, halves: sides.map(|(normal, offset)| (normal, offset, NONE)).into() }
    }

    /// Keeps what is in a half-plane. The edge along its border has this name.
    fn halve(&mut self, normal: [f64; 2], offset: f64, name: u32) {
        self.polygon.halve(normal, offset, name);
        self.halves.push((normal, offset, name));
    }

    /// Returns which shares of a segment are in the part, up to rounding; `None` if there are none.
    ///
    /// The half-planes say that, since edges of the polygon may be so short that rounding makes their directions.
    fn shares_of(&self, [from, to]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
        let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
        for &(normal, offset, _) in &self.halves {
            let [at_from, at_to] = [from, to].map(|p| vector::dot(p, normal) - offset);
            if at_from > 0.0 && at_to > 0.0 {
                return None;
            }
            let share = at_from / (at_from - at_to);
            if at_from > at_to {
                first = share.max(first);
            } else if at_from < at_to {
                last = share.min(last);
            }
        }
        (first <= last && first <= 1.0 && last >= 0.0).then_some([first, last])
    }

    /// Cuts the part out of a box of its own size, since places on edges of a much larger one are less precise.
    fn sharpen(&mut self) {
        let corners = self.polygon.vertices();
        let extreme = |f: fn(f64, f64) -> f64| {
            let all = corners.iter().copied().reduce(|a, b| [f(a[0], b[0]), f(a[1], b[1])]);
            all.unwrap_or([0.0; 2])
        };
        let (low, high) = (extreme(f64::min), extreme(f64::max));
        let margin = vector::minus(high, low).into_iter().fold(0.0, f64::max);
        let around = [low.map(|x| x - margin), high.map(|x| x + margin)];
        self.polygon.reset(around, NONE);
        for &(normal, offset, name) in &self.halves {
            self.polygon.halve(normal, offset, name);
        }
    }
}

/// An edge of a cell, relative to its site.
struct Edge {
    ends: [[f64; 2]; 2],
    name: u32,
}

/// Returns a cell with these edges of its parts, in order.
fn cell_of(site: [f64; 2], mut edges: Vec<Edge>, volume: f64, moment: [f64; 2]) -> Cell<2> {
    let length = |[p, q]: [[f64; 2]; 2]| vector::norm(vector::minus(q, p));
    let reach = edges.iter().map(|edge| vector::norm(edge.ends[0])).fold(0.0, f64::max);
    edges.retain(|edge| edge.name != SEAM && length(edge.ends) > SHORTEST * reach);
    // What seams have cut in two.
    edges.dedup_by(|edge, before| {
        let is_same = edge.name == before.name && edge.name != NONE;
        if is_same {
            before.ends[1] = edge.ends[1];
        }
        is_same
    });
    if let [first, .., last] = &mut edges[..]
        && first.name == last.name
        && first.name != NONE
    {
        first.ends[0] = last.ends[0];
        edges.pop();
    }
    let mut closed: Vec<Edge> = Vec::with_capacity(edges.len());
    let starts: Vec<[f64; 2]> = edges.iter().map(|edge| edge.ends[0]).collect();
    for (i, edge) in edges.into_iter().enumerate() {
        // On a wall of its own site, a cell may reach farther on one side than on the other.
        let gap = [edge.ends[1], starts[(i + 1) % starts.len()]];
        closed.push(edge);
        if length(gap) > SHORTEST * reach {
            closed.push(Edge { ends: gap, name: NONE });
        }
    }
    let mut cell = Cell::default();
    let count = closed.len() as u32;
    for (i, edge) in (0..).zip(&closed) {
        cell.vertices.push(vector::plus(site, edge.ends[0]));
        cell.facets.push([i, (i + 1) % count]);
        cell.neighbors.push(edge.name);
        cell.areas.push(length(edge.ends));
    }
    cell.simplices = vec![NONE; cell.vertices.len()];
    cell.volume = volume;
    if volume > 0.0 {
        cell.centroid = vector::plus(site, vector::times(1.0 / volume, moment));
    }
    cell
}
