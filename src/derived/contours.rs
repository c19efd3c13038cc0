//! Contours and isosurfaces: where values that are linear within each simplex have a level, by
//! marching triangles and tetrahedra (Doi and Koide 1991).
//!
//! A vertex counts as above the level if its value is the level: so every simplex is cut in its
//! interior or not at all, and the facets of all of them close up. Afterwards, what was cut at a
//! vertex is that vertex, and what thereby has lost its extent is left out.

use super::{complex::Complex, voronoi::THIRD};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet},
    index::NONE,
    input::points::Points,
    mesh::{Csr, Mesh},
    parallel::{self, Threads},
};
use rustc_hash::{FxHashMap, FxHashSet};

/// The number of simplices that is worth handing to another thread.
const GRAIN: usize = 1 << 12;

/// Finds contours in 2D and isosurfaces in 3D of values that are given at the points of a mesh.
///
/// # Examples
///
/// ```
/// use gdel::Contours;
///
/// let points: Vec<[f64; 3]> = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect();
/// let values: Vec<f64> = points.iter().map(|p| -p.iter().map(|x| (x - 4.5).powi(2)).sum::<f64>().sqrt()).collect();
/// let mesh = gdel::delaunay3d(&points)?;
/// let contours = Contours::new(&mesh, &points, &values)?;
///
/// // A sphere, with its triangles counter-clockwise as seen from where values are lower.
/// let sphere = contours.at(-3.0);
/// let radius = |p: &[f64; 3]| p.iter().map(|x| (x - 4.5).powi(2)).sum::<f64>().sqrt();
/// assert!(sphere.vertices.iter().all(|p| (radius(p) - 3.0).abs() < 0.2));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct Contours<'a, const D: usize = 3, const N: usize = 4> {
    complex: Complex<'a, D, N>,
    values: &'a [f64],
}

/// Finds contours of values that are given at the points of a 2D mesh.
pub type Contours2<'a> = Contours<'a, 2, 3>;

/// The contour of a level, or the isosurface in 3D, which [`Contours::at`] and
/// [`Contours::closed_at`] return.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Contour<const D: usize = 3> {
    /// The vertices, each of which is on an edge of the mesh or is a point of it.
    pub vertices: Vec<[f64; D]>,
    /// The triangles in 3D, counter-clockwise as seen from where values are lower; in 2D the
    /// segments, with higher values on their left. In 2D they come line by line.
    pub facets: Vec<[u32; D]>,
}

/// A vertex of a contour: on the edge from a vertex with a value above the level to one below; twice
/// the same if it is a vertex of the mesh.
type Cut = [u32; 2];

impl<'a, const D: usize, const N: usize> Contours<'a, D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Takes the values at the points of a mesh, one per point. Those of duplicates are not used.
    /// Simplices with a value that is not finite are left out, as if the mesh had a hole there.
    ///
    /// # Errors
    ///
    /// [`Error::ValueCount`] if there are not as many values as points; [`Error::PointCount`],
    /// [`Error::NotFinite`] or [`Error::BrokenMesh`] as for [`Locator::new`](crate::Locator::new).
    pub fn new(mesh: &'a impl Mesh<D, N>, points: impl Into<Points<'a, D>>, values: &'a [f64]) -> Result<Self, Error> {
        let complex = Complex::unweighted(mesh, points.into())?;
        if values.len() != complex.points().len() {
            return Err(Error::ValueCount { values: values.len(), points: complex.points().len() });
        }
        Ok(Contours { complex, values })
    }

    /// Returns where the values are the level. Contours end at the hull, and at holes.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::Contours;
    ///
    /// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let contour = Contours::new(&mesh, &points, &[0.0, 2.0, 2.0])?.at(1.0);
    /// assert_eq!(contour.vertices, [[0.0, 1.0], [1.0, 0.0]]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn at(&self, level: f64) -> Contour<D> {
        self.find(level, false)
    }

    /// Returns the boundary of the part of the mesh where values are the level or higher: the
    /// contour, closed along the hull and along holes.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::Contours;
    ///
    /// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let contour = Contours::new(&mesh, &points, &[2.0, 0.0, 0.0])?.closed_at(1.0);
    /// // The three vertices of a triangle, and the first one again.
    /// assert_eq!(contour.lines().of(0).len(), 4);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn closed_at(&self, level: f64) -> Contour<D> {
        self.find(level, true)
    }

    fn find(&self, level: f64, is_closed: bool) -> Contour<D> {
        let facets = parallel::map_grains(Threads::All, self.complex.simplices.len(), GRAIN, |range| {
            let mut facets = Vec::new();
            for t in range {
                let simplex = &self.complex.simplices[t];
                if !self.is_finite(t) {
                    continue;
                }
                let is_above = simplex.map(|v| self.values[v as usize] >= level);
                push_facets(&section(simplex, &is_above), &mut facets);
                for k in (0..N).filter(|&k| is_closed && self.is_border(t, k)) {
                    push_facets(&above(facet(simplex, k), facet(&is_above, k)), &mut facets);
                }
            }
            facets
        });
        let snapped = |cut| self.snapped(level, cut);
        self.number(
            level,
            if D == 2 { in_lines(&facets.concat(), snapped) } else { without_flat(&facets.concat(), snapped) },
        )
    }

    /// Returns whether all values of a simplex are finite.
    fn is_finite(&self, t: usize) -> bool {
        self.complex.simplices[t].iter().all(|&v| self.values[v as usize].is_finite())
    }

    /// Returns whether a facet of a simplex belongs to the hull, or to a hole.
    fn is_border(&self, t: usize, k: usize) -> bool {
        let across = self.complex.neighbors[t][k];
        across == NONE || !self.is_finite(across as usize)
    }

    /// Returns the vertex of the mesh where a cut is that is at the level there.
    fn snapped(&self, level: f64, [above, below]: Cut) -> Cut {
        if self.values[above as usize] == level { [above; 2] } else { [above, below] }
    }

    /// Numbers the vertices of facets, and finds their coordinates.
    fn number(&self, level: f64, facets: Vec<[Cut; D]>) -> Contour<D> {
        let mut contour = Contour::default();
        let mut numbers: FxHashMap<Cut, u32> = FxHashMap::default();
        for facet in facets {
            let numbered = facet.map(|cut| {
                *numbers.entry(cut).or_insert_with(|| {
                    contour.vertices.push(self.position(level, cut));
                    contour.vertices.len() as u32 - 1
                })
            });
            contour.facets.push(numbered);
        }
        contour
    }

    /// Returns where the values along an edge are the level.
    fn position(&self, level: f64, [above, below]: Cut) -> [f64; D] {
        let [p, q] = [above, below].map(|v| self.complex.point(v));
        if above == below {
            return p;
        }
        // The halves do not overflow.
        let [high, low] = [above, below].map(|v| self.values[v as usize] / 2.0);
        let share = (high - level / 2.0) / (high - low);
        let between = |axis: usize| p[axis] * (1.0 - share) + q[axis] * share;
        std::array::from_fn(|axis| if p[axis] == q[axis] { p[axis] } else { between(axis) })
    }
}

impl<const D: usize> Contour<D> {
    /// Returns the lines of a contour in 2D as lists of vertices. Closed lines have the first vertex again at the end.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::Contours;
    ///
    /// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let contour = Contours::new(&mesh, &points, &[0.0, 0.0, 0.0, 0.0, 1.0])?.at(0.5);
    /// let lines = contour.lines();
    /// assert_eq!((lines.len(), lines.of(0).len()), (1, 5));
    /// assert_eq!(lines.of(0)[0], lines.of(0)[4]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn lines(&self) -> Csr {
        let mut lines = Csr::default();
        let mut line: Vec<u32> = Vec::new();
        for (i, facet) in self.facets.iter().enumerate() {
            let [from, to] = [facet[0], facet[D - 1]];
            if line.is_empty() {
                line.push(from);
            }
            line.push(to);
            let is_continued = line[0] != to && self.facets.get(i + 1).is_some_and(|next| next[0] == to);
            if !is_continued {
                lines.push(line.drain(..));
            }
        }
        lines
    }
}

/// Returns the cuts through the edges of a simplex, in order around the section: in 2D with the
/// higher values on the left, in 3D counter-clockwise as seen from where values are lower.
fn section<const D: usize, const N: usize>(simplex: &[u32; N], is_above: &[bool; N]) -> Vec<Cut>
where
    Euclidean: Geometry<D, N>,
{
    let corners = |above: bool| (0..N).filter(move |&k| is_above[k] == above);
    let (mut high, mut low) = (corners(true), corners(false));
    match (corners(true).count(), corners(false).count()) {
        (0, _) | (_, 0) => Vec::new(),
        (1, _) => {
            let k = high.next().unwrap_or(0);
            facet(simplex, k).into_iter().map(|below| [simplex[k], below]).collect()
        }
        (_, 1) => {
            let k = low.next().unwrap_or(0);
            facet(simplex, k).into_iter().rev().map(|above| [above, simplex[k]]).collect()
        }
        // Two on both sides of a tetrahedron.
        _ => {
            let [i, j] = [high.next(), high.next()].map(Option::unwrap_or_default);
            // The permutation (i, j, k, l) is even.
            let k = THIRD[i][j];
            let l = 6 - i - j - k;
            [[i, k], [i, l], [j, l], [j, k]].map(|edge| edge.map(|corner| simplex[corner])).to_vec()
        }
    }
}

/// Returns the part of a facet with higher values, in the order of its vertices.
fn above<const D: usize>(facet: [u32; D], is_above: [bool; D]) -> Vec<Cut> {
    let mut part = Vec::with_capacity(4);
    for (i, &v) in facet.iter().enumerate() {
        let next = (i + 1) % D;
        if is_above[i] {
            part.push([v; 2]);
        }
        // An edge is not closed.
        if is_above[i] != is_above[next] && (D > 2 || next > 0) {
            part.push(if is_above[i] { [v, facet[next]] } else { [facet[next], v] });
        }
    }
    part
}

/// Appends a segment, or the triangles of a convex polygon.
fn push_facets<const D: usize>(polygon: &[Cut], facets: &mut Vec<[Cut; D]>) {
    for last in D..=polygon.len() {
        facets.push(std::array::from_fn(|k| if k == 0 { polygon[0] } else { polygon[last - D + k] }));
    }
}

/// Returns the facets as `snapped` moves their vertices, without those that lose their extent, and
/// without pairs that are the same facet from both sides, as where all values of a facet are the level.
fn without_flat<const D: usize>(facets: &[[Cut; D]], snapped: impl Fn(Cut) -> Cut) -> Vec<[Cut; D]> {
    let sorted = |facet: &[Cut; D]| {
        let mut facet = *facet;
        facet.sort_unstable();
        facet
    };
    let moved = facets.iter().map(|facet| facet.map(&snapped));
    let mut kept: Vec<[Cut; D]> =
        moved.filter(|facet| sorted(facet).windows(2).all(|pair| pair[0] != pair[1])).collect();
    // Only what consists of vertices of the mesh can lie in a facet of it.
    let is_doubtful = |facet: &[Cut; D]| facet.iter().all(|&[above, below]| above == below);
    let mut counts: FxHashMap<[Cut; D], u32> = FxHashMap::default();
    for facet in kept.iter().filter(|facet| is_doubtful(facet)) {
        *counts.entry(sorted(facet)).or_default() += 1;
    }
    kept.retain(|facet| !is_doubtful(facet) || counts[&sorted(facet)] == 1);
    kept
}

/// Returns segments line by line, as `snapped` moves their vertices, without those that lose their
/// length, and without what leads somewhere and back.
fn in_lines<const D: usize>(segments: &[[Cut; D]], snapped: impl Fn(Cut) -> Cut) -> Vec<[Cut; D]> {
    let mut found = Vec::new();
    for line in lines_of(segments) {
        let is_closed = line[0] == line[line.len() - 1];
        let mut straight: Vec<Cut> = Vec::with_capacity(line.len());
        for cut in line.into_iter().map(&snapped) {
            match straight[..] {
                [.., last] if last == cut => {}
                [.., before, _] if before == cut => {
                    straight.pop();
                }
                _ => straight.push(cut),
            }
        }
        let mut line = &straight[..];
        while is_closed && line.len() > 2 && line[1] == line[line.len() - 2] {
            line = &line[1..line.len() - 1];
        }
        found.extend(line.windows(2).map(|pair| std::array::from_fn(|k| pair[k])));
    }
    found
}

/// Joins segments where one begins with the end of another.
fn lines_of<const D: usize>(segments: &[[Cut; D]]) -> Vec<Vec<Cut>> {
    // The segments that begin at each cut: the last one, and for each segment the one before.
    let mut leaving: FxHashMap<Cut, usize> = FxHashMap::default();
    let before: Vec<Option<usize>> =
        segments.iter().enumerate().map(|(s, segment)| leaving.insert(segment[0], s)).collect();
    let ends: FxHashSet<Cut> = segments.iter().map(|segment| segment[D - 1]).collect();
    let mut lines = Vec::new();
    // Those that begin at the hull first.
    let open = segments.iter().map(|segment| segment[0]).filter(|start| !ends.contains(start));
    for start in open.chain(segments.iter().map(|segment| segment[0])) {
        let mut line = vec![start];
        let mut at = start;
        while let Some(s) = leaving.remove(&at) {
            if let Some(other) = before[s] {
                leaving.insert(at, other);
            }
            at = segments[s][D - 1];
            line.push(at);
            if at == start {
                break;
            }
        }
        if line.len() > 1 {
            lines.push(line);
        }
    }
    lines
}
