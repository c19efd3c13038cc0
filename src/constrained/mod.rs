//! Constrained Delaunay triangulation in 2D: the one that contains given segments as edges, and is as Delaunay as
//! these allow.
//!
//! A mesh of the points, by any backend, becomes that of the constraints:
//!
//! 1. `flat`: collinear points have no triangles, and segments are pieces of their line;
//! 2. `insert`: each segment becomes an edge, or several if it leads through vertices, in `topology`;
//! 3. `fill`: which triangles are inside the boundaries.
//!
//! `split` puts points where segments cross, on request; then the points are triangulated anew.
//!
//! `growing` has triangles that points are added to and removed from. With these, `refine` adds points to a mesh until its
//! triangles are well shaped, and `tin` chooses some of the points of a terrain.
//!
//! The answer is unique: all edges that are not constrained are locally Delaunay with the symbolic perturbation of the
//! heights, and for a given set of constrained edges only one triangulation is (Lee and Lin 1986). So it depends
//! neither on the order of the constraints nor on how the mesh was made.

mod fill;
mod flat;
mod growing;
mod insert;
mod refine;
mod split;
mod tin;
mod topology;

use crate::{
    cpu,
    d2::Mesh2,
    error::Error,
    index::NONE,
    input::points::Points2,
    options::Options,
    parallel::{self, Threads},
};
use insert::{Inserted, Inserter, Lost};
pub use refine::{RefineLeft, RefineOptions, RefineStats, Refined2, Size};
use split::Split;
use std::num::NonZeroUsize;
pub use tin::{Tin, TinOptions, TinStats, tin};
use topology::{Marked, Part};

/// The number of crossings that [`Error::CrossingConstraints`] lists.
const LISTED: usize = 16;

/// Which triangles are inside the boundaries of [`Constraints`].
///
/// # Examples
///
/// ```
/// use gdel::{Constraints, Fill, Triangulator};
///
/// // A square in a square, both counter-clockwise.
/// let points = [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0], [2.0, 2.0], [4.0, 2.0], [4.0, 4.0], [2.0, 4.0f64]];
/// let rings = Constraints::new().ring(&[0, 1, 2, 3]).ring(&[4, 5, 6, 7]);
/// for (fill, count) in [(Fill::All, 10), (Fill::NonZero, 10), (Fill::EvenOdd, 8)] {
///     let found = Triangulator::new().constrained2d(&points, &rings.clone().fill(fill))?;
///     assert_eq!(found.inside_triangles().count(), count);
/// }
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fill {
    /// All triangles are inside.
    #[default]
    All,
    /// Those from which a way out crosses boundaries an odd number of times. A boundary that is given twice is none.
    EvenOdd,
    /// Those around which boundaries wind, with counter-clockwise turns less clockwise ones.
    NonZero,
    /// Those from which no way leads out without crossing a segment, boundary or not, as in Triangle's `.poly` files.
    Enclosed,
}

/// Segments that are to be edges of a mesh, by the indices of their ends:
/// [`Triangulator::constrained2d`](crate::Triangulator::constrained2d).
///
/// # Examples
///
/// ```
/// use gdel::{Constraints, Fill};
///
/// let constraints = Constraints::new().ring(&[0, 1, 2, 3]).edges(&[[4, 5]]).fill(Fill::EvenOdd);
/// assert_eq!(constraints.segments(), [[4, 5], [0, 1], [1, 2], [2, 3], [3, 0]]);
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Constraints {
    edges: Vec<[u32; 2]>,
    boundary: Vec<[u32; 2]>,
    holes: Vec<[f64; 2]>,
    fill: Fill,
    is_split: bool,
}

impl Constraints {
    /// Creates no constraints.
    pub fn new() -> Self {
        Constraints::default()
    }

    /// Adds segments that bound nothing, such as the breaklines of a terrain.
    #[must_use]
    pub fn edges(mut self, edges: &[[u32; 2]]) -> Self {
        self.edges.extend(edges);
        self
    }

    /// Adds a closed polygon, whose last point is joined to the first. It is a boundary: an outer one, or that of a
    /// hole, as [`fill`](Constraints::fill) says.
    #[must_use]
    pub fn ring(mut self, ring: &[u32]) -> Self {
        let ring = match ring {
            [first, .., last] if first == last => &ring[1..],
            _ => ring,
        };
        self.boundary.extend((0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]));
        self
    }

    /// Adds segments of boundaries, in any order. For [`Fill::NonZero`], their directions count.
    #[must_use]
    pub fn boundary(mut self, edges: &[[u32; 2]]) -> Self {
        self.boundary.extend(edges);
        self
    }

    /// Marks the region around a place as a hole, whatever the fill rule: segments separate regions, boundaries or not. A
    /// place on a segment or outside the hull marks nothing.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Constraints, Fill, Triangulator};
    ///
    /// let points = [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0], [3.0, 2.0], [4.0, 4.0], [2.0, 4.0f64]];
    /// let segments = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 4]];
    /// let constraints = Constraints::new().edges(&segments).fill(Fill::Enclosed).hole([3.0, 3.0]);
    /// let found = Triangulator::new().constrained2d(&points, &constraints)?;
    /// assert_eq!((found.mesh.triangles.len(), found.inside_triangles().count()), (8, 7));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[must_use]
    pub fn hole(mut self, place: [f64; 2]) -> Self {
        self.holes.push(place);
        self
    }

    /// Sets which triangles are inside the boundaries. The default is [`Fill::All`].
    #[must_use]
    pub fn fill(mut self, fill: Fill) -> Self {
        self.fill = fill;
        self
    }

    /// Puts a point where segments cross, instead of an error: the crossing, rounded to the nearest coordinates. Both
    /// segments lead through it, and are no longer straight if it is not exactly on them. All else is exact again, but
    /// may depend on the order of the segments. That a segment bends can make new crossings, which are split, too; where
    /// segments are nearer to each other than coordinates are rounded, this can go on, and ends with
    /// [`Error::CrossingConstraints`] after a hundred rounds.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Constraints, Triangulator};
    ///
    /// let points = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0f64]];
    /// let constraints = Constraints::new().edges(&[[0, 2], [1, 3]]).split_crossings();
    /// let found = Triangulator::new().constrained2d(&points, &constraints)?;
    /// assert_eq!((found.added.as_slice(), found.moved), (&[[1.5, 1.5]][..], 0.0));
    /// assert_eq!(found.segments, [[0, 4], [4, 2], [1, 4], [4, 3]]);
    /// assert_eq!(found.mesh.triangles.len(), 4);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[must_use]
    pub fn split_crossings(mut self) -> Self {
        self.is_split = true;
        self
    }

    /// Returns all segments: the edges, then those of boundaries.
    pub fn segments(&self) -> Vec<[u32; 2]> {
        [self.edges.as_slice(), &self.boundary].concat()
    }

    /// Returns the error that says which pairs of segments cross.
    fn crossing_error(&self, pairs: &[[u32; 2]]) -> Error {
        let segments = self.segments();
        let listed = pairs.iter().take(LISTED).map(|pair| pair.map(|i| segments[i as usize])).collect();
        Error::CrossingConstraints { count: pairs.len(), pairs: listed }
    }

    /// Checks that all ends are points.
    ///
    /// # Errors
    ///
    /// [`Error::BadConstraint`].
    fn check(&self, points: usize) -> Result<(), Error> {
        let is_bad = |segment: &&[u32; 2]| segment.iter().any(|&v| v as usize >= points);
        match self.edges.iter().chain(&self.boundary).find(is_bad) {
            Some(&segment) => Err(Error::BadConstraint { segment, points }),
            None => Ok(()),
        }
    }
}

/// A constrained Delaunay triangulation.
///
/// # Examples
///
/// ```
/// use gdel::{Constraints, Triangulator};
///
/// let points = [[0.0, 0.0], [3.0, -1.0], [6.0, 0.0], [3.0, 1.0], [0.0, 0.0f64]];
/// let found = Triangulator::new().constrained2d(&points, &Constraints::new().edges(&[[4, 2], [4, 0]]))?;
/// // Point 4 is point 0.
/// assert_eq!((found.mesh.constraints.as_slice(), found.zero_length), (&[[0, 2]][..], 1));
/// assert!(found.mesh.is_constrained([2, 4]));
/// assert_eq!(found.triangle_regions().iter().max(), Some(&1));
/// assert!(gdel::verify2d(&points, &found.mesh)?.passed());
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Constrained2 {
    /// The mesh, whose triangles fill the convex hull, and whose [`constraints`](Mesh2::constraints) are the
    /// segments.
    pub mesh: Mesh2,
    /// Whether each triangle is inside the boundaries, as the fill rule says.
    pub inside: Vec<bool>,
    /// The number of segments whose ends are equal, which are ignored.
    pub zero_length: usize,
    /// The segments, in the order of [`Constraints::segments`], cut where a point was put at a crossing: what
    /// [`MeshView2::segments`](crate::MeshView2::segments) takes.
    pub segments: Vec<[u32; 2]>,
    /// The points at crossings, if these are [split](Constraints::split_crossings): points of the mesh after the given
    /// ones.
    pub added: Vec<[f64; 2]>,
    /// The greatest distance of one of these from the crossing that it was put at.
    pub moved: f64,
}

impl Constrained2 {
    /// Returns the triangles inside the boundaries.
    pub fn inside_triangles(&self) -> impl Iterator<Item = [u32; 3]> + Clone + '_ {
        self.mesh.triangles.iter().zip(&self.inside).filter(|&(_, &inside)| inside).map(|(&triangle, _)| triangle)
    }

    /// Returns the triangles inside the boundaries as a mesh, whose half-edges have no opposite where it ends. Its hull is
    /// that of the points.
    pub fn inside_mesh(&self) -> Mesh2 {
        let mut mesh = self.mesh.clone();
        if self.inside.iter().all(|&inside| inside) {
            return mesh;
        }
        let mut places = vec![NONE; self.inside.len()];
        let kept: Vec<usize> = (0..self.inside.len()).filter(|&t| self.inside[t]).collect();
        (0..).zip(&kept).for_each(|(place, &t)| places[t] = place);
        let halfedge = |e: u32| match e {
            NONE => NONE,
            e if places[e as usize / 3] == NONE => NONE,
            e => 3 * places[e as usize / 3] + e % 3,
        };
        mesh.halfedges = kept.iter().map(|&t| mesh.halfedges[t].map(halfedge)).collect();
        mesh.triangles = kept.iter().map(|&t| mesh.triangles[t]).collect();
        mesh
    }

    /// Returns the region of each triangle: two triangles are in the same one if a way from one to the other crosses
    /// no constrained edge. Regions are numbered from 0 in the order of their first triangles.
    pub fn triangle_regions(&self) -> Vec<u32> {
        fill::regions(&self.mesh)
    }
}

/// Makes a counter-clockwise Delaunay triangulation of points that of the constraints, which were
/// [checked](Constraints::check).
///
/// # Errors
///
/// [`Unconstrained::Crossings`], or [`Error::OpenBoundary`], or [`Error::BrokenMesh`] if the mesh is not that of the
/// points.
fn constrain(
    threads: Threads,
    mut mesh: Mesh2,
    points: Points2<'_>,
    constraints: &Constraints,
) -> Result<Constrained2, Unconstrained> {
    let first_boundary = constraints.edges.len() as u32;
    let named = |segment: &[u32; 2]| segment.map(|v| mesh.representative(v));
    let segments: Vec<[u32; 2]> = constraints.edges.iter().chain(&constraints.boundary).map(named).collect();
    let zero_length = segments.iter().filter(|[a, b]| a == b).count();
    if matches!(constraints.fill, Fill::EvenOdd | Fill::NonZero) {
        let boundary = segments[first_boundary as usize..].iter().copied();
        fill::check_closed(points.len(), constraints.fill, boundary)?;
    }
    if mesh.dimension < 2 {
        mesh.constraints = flat::edges(&mesh.hull, points.len(), &segments);
        return Ok(Constrained2 { mesh, zero_length, segments: constraints.segments(), ..Constrained2::default() });
    }
    let mut pieces = insert_all(threads, &mut mesh, points, &segments)?;
    parallel::sort(threads, &mut pieces);
    let weight = |&(edge, segment): &Piece| {
        let [from, to] = segments[segment as usize].map(|v| points.get(v as usize));
        let [low, high] = edge.map(|v| points.get(v as usize));
        match constraints.fill {
            _ if segment < first_boundary => 0,
            Fill::NonZero if (from < to) != (low < high) => -1,
            _ => 1,
        }
    };
    let edges = pieces.chunk_by(|a, b| a.0 == b.0);
    mesh.constraints = edges.clone().map(|pieces| pieces[0].0).collect();
    let weights: Vec<fill::Weight> = edges.map(|pieces| pieces.iter().map(weight).sum()).collect();
    let inside = fill::inside(&mesh, points, constraints, &weights);
    let segments = constraints.segments();
    Ok(Constrained2 { mesh, inside, zero_length, segments, ..Constrained2::default() })
}

/// How often crossings are split: segments that cross many others are cut in several rounds, and rounding can make new
/// crossings.
const MAX_ROUNDS: usize = 100;

/// What is left to do for a constrained triangulation: the [points](Self::points) are to be triangulated, and the mesh
/// [constrained](Self::constrain), until nothing is left.
pub(crate) struct Constraining<'a> {
    points: Points2<'a>,
    constraints: &'a Constraints,
    threads: Option<NonZeroUsize>,
    split: Option<Split>,
    rounds: usize,
}

impl<'a> Constraining<'a> {
    /// Checks the constraints, which so many threads are to insert.
    ///
    /// # Errors
    ///
    /// [`Error::BadConstraint`].
    pub(crate) fn new(
        points: Points2<'a>,
        constraints: &'a Constraints,
        threads: Option<NonZeroUsize>,
    ) -> Result<Self, Error> {
        constraints.check(points.len())?;
        Ok(Constraining { points, constraints, threads, split: None, rounds: 0 })
    }

    /// Returns the points whose counter-clockwise Delaunay triangulation is needed next.
    pub(crate) fn points(&self) -> Points2<'_> {
        self.split.as_ref().map_or(self.points, |split| Points2::F64(&split.points))
    }

    /// Makes that triangulation the result; `None` if points were put at crossings, so that another one is needed.
    ///
    /// # Errors
    ///
    /// [`Error::CrossingConstraints`], [`Error::OpenBoundary`], or [`Error::BrokenMesh`] if the mesh is not that of the
    /// points.
    pub(crate) fn constrain(&mut self, mesh: Mesh2) -> Result<Option<Constrained2>, Error> {
        let constraints = self.split.as_ref().map_or(self.constraints, |split| &split.constraints);
        let found = |threads| Ok(constrain(threads, mesh, self.points(), constraints));
        let pairs = match parallel::with_threads(self.threads, found)? {
            Ok(mut found) => {
                if let Some(mut split) = self.split.take() {
                    found.added = split.points.split_off(split.given);
                    found.moved = split.moved;
                }
                return Ok(Some(found));
            }
            Err(Unconstrained::Error(error)) => return Err(error),
            Err(Unconstrained::Crossings(pairs)) => pairs,
        };
        if !constraints.is_split || self.rounds == MAX_ROUNDS {
            return Err(constraints.crossing_error(&pairs));
        }
        self.rounds += 1;
        let split = || Split::new(self.points.iter().collect(), self.constraints.clone());
        self.split.get_or_insert_with(split).cut(&pairs);
        Ok(None)
    }
}

/// Returns the constrained Delaunay triangulation of points with the CPU engine.
///
/// # Errors
///
/// Returns the errors of [`Triangulator::constrained2d`](crate::Triangulator::constrained2d).
pub fn constrained(points: Points2<'_>, constraints: &Constraints, options: &Options) -> Result<Constrained2, Error> {
    let mut left = Constraining::new(points, constraints, options.threads)?;
    loop {
        if let Some(found) = left.constrain(cpu::delaunay::<2>(left.points(), options)?)? {
            return Ok(found);
        }
    }
}

/// Why a mesh is not that of the constraints.
enum Unconstrained {
    Error(Error),
    /// The pairs of segments that cross.
    Crossings(Vec<[u32; 2]>),
}

impl From<Error> for Unconstrained {
    fn from(error: Error) -> Self {
        Unconstrained::Error(error)
    }
}

/// A constrained edge, the lower vertex first, and the segment that it is a piece of.
type Piece = ([u32; 2], u32);

/// With fewer segments for each, threads take longer to begin than to insert them.
const MIN_SEGMENTS: usize = if cfg!(test) { 1 } else { 256 };

/// How many segments for each thread are looked at to share the triangles out.
const SAMPLED: usize = 64;

/// Inserts the segments between vertices. Returns their pieces.
///
/// # Errors
///
/// [`Unconstrained::Crossings`] or [`Error::BrokenMesh`].
fn insert_all(
    threads: Threads,
    mesh: &mut Mesh2,
    points: Points2<'_>,
    segments: &[[u32; 2]],
) -> Result<Vec<Piece>, Unconstrained> {
    let mut marked = Marked::new(mesh, points);
    let proper = (0..).zip(segments).filter(|(_, [a, b])| a != b);
    // In the order of the triangles, which are near each other in memory if they are near each other.
    let start = |v: u32| marked.start(v);
    let mut keyed: Vec<u64> = proper.clone().map(|(i, &[a, b])| u64::from(start(a).min(start(b))) << 32 | i).collect();
    parallel::sort_keyed(threads, &mut keyed);
    let lost = |_: Lost| Error::BrokenMesh { reason: "a segment leads nowhere" };
    let mut inserted = insert_in_parts(threads, &mut marked, segments, &keyed).map_err(lost)?;
    if !inserted.crossings.is_empty() {
        // Which ones cross those before them depends on the order: in that of the input, anew.
        let edges = marked.unmark_all();
        let given = proper.map(|(i, &ends)| (i as u32, ends));
        inserted = insert_in_order(marked.whole(), edges, given).map_err(lost)?.0;
        return Err(Unconstrained::Crossings(crossings(inserted)));
    }
    marked.restore(mesh);
    Ok(inserted.pieces)
}

/// Inserts the segments that are the lower halves of keys; the upper ones are half-edges at which they start. Each
/// thread takes those that start in its strip of the plane, and one thread what is left of all.
fn insert_in_parts(
    threads: Threads,
    marked: &mut Marked<'_>,
    segments: &[[u32; 2]],
    keyed: &[u64],
) -> Result<Inserted, Lost> {
    let named = |&key: &u64| (key as u32, segments[key as u32 as usize]);
    let count = parallel::count(threads).min(keyed.len() / MIN_SEGMENTS).min(usize::from(u8::MAX));
    if count < 2 {
        return Ok(insert_in_order(marked.whole(), Vec::new(), keyed.iter().map(named))?.0);
    }
    let starts = keyed.iter().step_by(keyed.len().div_ceil(SAMPLED * count)).map(|key| named(key).1[0]);
    let owners = marked.owners(threads, count, starts);
    let owner = |key: &u64| owners[(key >> 32) as usize / 3];
    let mut segments = vec![Vec::new(); count];
    keyed.iter().for_each(|key| segments[usize::from(owner(key))].push(named(key)));
    let results = parallel::map_mut(threads, &mut segments, |part, segments| {
        insert_in_order(marked.part(&owners, part as u8), Vec::new(), segments.drain(..))
    });
    let (mut inserted, mut edges) = (Inserted::default(), Vec::new());
    for (mut part, doubtful) in results.into_iter().collect::<Result<Vec<_>, _>>()? {
        inserted.append(&mut part);
        edges.extend(doubtful);
    }
    let left = std::mem::take(&mut inserted.left);
    let (mut last, _) = insert_in_order(marked.whole(), edges, left.into_iter())?;
    inserted.append(&mut last);
    Ok(inserted)
}

/// Flips the edges in doubt, and inserts segments one after the other.
fn insert_in_order(
    mut part: Part<'_>,
    doubtful: Vec<u32>,
    segments: impl Iterator<Item = (u32, [u32; 2])>,
) -> Result<(Inserted, Vec<u32>), Lost> {
    part.doubt(doubtful);
    part.flip_pending();
    let mut inserter = Inserter::new(part);
    for (segment, ends) in segments {
        inserter.insert(segment, ends)?;
    }
    Ok(inserter.finish())
}

/// Returns which segments cross, in the order of the input.
fn crossings(Inserted { mut pieces, crossings, .. }: Inserted) -> Vec<[u32; 2]> {
    pieces.sort_unstable();
    let mut pairs: Vec<[u32; 2]> = Vec::new();
    for (edge, segment) in crossings {
        let first = pieces.partition_point(|piece| piece.0 < edge);
        let same = pieces[first..].iter().take_while(|piece| piece.0 == edge);
        pairs.extend(same.map(|&(_, before)| [before.min(segment), before.max(segment)]));
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{random::Random, verify2d};

    fn by(threads: usize) -> Options {
        Options { threads: NonZeroUsize::new(threads), ..Options::default() }
    }

    /// Returns the triangles, each from its lowest vertex on, in ascending order.
    fn triangles(mesh: &Mesh2) -> Vec<[u32; 3]> {
        let from_lowest = |&[a, b, c]: &[u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap();
        let mut triangles: Vec<_> = mesh.triangles.iter().map(from_lowest).collect();
        triangles.sort_unstable();
        triangles
    }

    /// Segments that do not cross: edges of the triangulation of sheared points, some of which go on through their end.
    fn segments(points: &[[f64; 2]], random: &mut Random) -> Vec<[u32; 2]> {
        let sheared: Vec<[f64; 2]> = points.iter().map(|&[x, y]| [x + 4.0 * y, y - x]).collect();
        let mesh = cpu::delaunay::<2>(Points2::F64(&sheared), &by(1)).unwrap();
        let edges: Vec<[u32; 2]> =
            (0..mesh.triangles.len()).flat_map(|t| (0..3).map(|k| mesh.edge(t, k)).collect::<Vec<_>>()).collect();
        let mut segments = Vec::new();
        for &[a, b] in &edges {
            if random.unit() < 0.5 {
                continue;
            }
            let of = |v: u32| points[v as usize];
            let goes_on = |&&[from, to]: &&[u32; 2]| {
                let ([ax, ay], [bx, by], [cx, cy]) = (of(a), of(b), of(to));
                from == b && [cx - bx, cy - by] == [bx - ax, by - ay]
            };
            segments.push([a, edges.iter().find(goes_on).map_or(b, |&[_, to]| to)]);
        }
        segments
    }

    #[test]
    fn several_threads_find_the_triangulation_of_one() {
        let mut random = Random::new(1);
        for case in 0..400 {
            let (count, size) = (10 + case, 3 + case % 30);
            let points: Vec<[f64; 2]> = (0..count).map(|_| random.on_grid(size)).collect();
            let constraints = Constraints::new().edges(&segments(&points, &mut random));
            let one = constrained(Points2::F64(&points), &constraints, &by(1)).unwrap();
            let several = constrained(Points2::F64(&points), &constraints, &by(2 + case as usize % 6)).unwrap();
            assert_eq!(triangles(&several.mesh), triangles(&one.mesh), "case {case}");
            assert_eq!(several.mesh.constraints, one.mesh.constraints);
            assert!(verify2d(&points, &several.mesh).unwrap().passed());
        }
    }

    #[test]
    fn several_threads_find_the_crossings_of_one() {
        let mut random = Random::new(2);
        for case in 0..200 {
            let count = 5 + case % 50;
            let points: Vec<[f64; 2]> = (0..count).map(|_| random.in_cube()).collect();
            let mut vertex = || (random.unit() * f64::from(count)) as u32;
            let edges: Vec<[u32; 2]> = (0..count).map(|_| [vertex(), vertex()]).collect();
            let run = |constraints: &Constraints, threads| {
                constrained(Points2::F64(&points), constraints, &by(threads)).map(|found| triangles(&found.mesh))
            };
            let constraints = Constraints::new().edges(&edges);
            let [one, several] = [1, 4].map(|threads| run(&constraints, threads).map_err(|error| error.to_string()));
            assert_eq!(several, one, "case {case}");
            let split = constraints.split_crossings();
            assert_eq!(run(&split, 4).unwrap(), run(&split, 1).unwrap(), "case {case}");
        }
    }
}
