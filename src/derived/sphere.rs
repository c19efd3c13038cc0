//! Points on a sphere: their Delaunay triangulation is the boundary of the convex hull, and the
//! vertices of their Voronoi diagram are the outer normals of its triangles (Brown 1979).

use super::{
    Interpolated,
    complex::Complex,
    nearest::walk,
    queries::{CurveKey, map_along_curve},
};
use crate::{
    error::Error,
    geometry::{compare_distances, facet, vector},
    index::NONE,
    input::points::{Points2, Points3},
    mesh::{Csr, Mesh},
    predicates::{Sign, orient3d},
};
use rustc_hash::FxHashMap;
use std::f64::consts::PI;

/// By how much coordinates on the unit sphere are taken to be off: a few roundings.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Returns the points of the unit sphere with these longitudes and latitudes in degrees.
///
/// Equal places are equal points, whatever their names: the poles have one point each, and longitudes
/// may differ by multiples of 360°. Opposite places are exactly opposite.
///
/// # Errors
///
/// [`Error::NotFinite`].
///
/// # Examples
///
/// ```
/// let points = gdel::on_sphere(&[[0.0, 0.0], [90.0, 0.0], [-135.0, 90.0]])?;
/// assert_eq!(points, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
/// # Ok::<(), gdel::Error>(())
/// ```
pub fn on_sphere<'a>(lon_lat: impl Into<Points2<'a>>) -> Result<Vec<[f64; 3]>, Error> {
    let lon_lat = lon_lat.into();
    lon_lat.validate()?;
    let point = |[lon, lat]: [f64; 2]| {
        let ([sin, cos], [z, r]) = (sin_cos(lon), sin_cos(lat));
        // Not −0.
        [r * cos + 0.0, r * sin + 0.0, z + 0.0]
    };
    Ok(lon_lat.iter().map(point).collect())
}

/// Returns the longitudes and latitudes in degrees of points, of which only the directions matter.
///
/// # Errors
///
/// [`Error::NotFinite`].
///
/// # Examples
///
/// ```
/// assert_eq!(gdel::lon_lat(&[[0.0, 2.0, 0.0], [0.0, 0.0, -1.0f64]])?, [[90.0, 0.0], [0.0, -90.0]]);
/// # Ok::<(), gdel::Error>(())
/// ```
pub fn lon_lat<'a>(points: impl Into<Points3<'a>>) -> Result<Vec<[f64; 2]>, Error> {
    let points = points.into();
    points.validate()?;
    let degrees = |[x, y, z]: [f64; 3]| [libm::atan2(y, x), libm::atan2(z, libm::hypot(x, y))].map(f64::to_degrees);
    Ok(points.iter().map(degrees).collect())
}

/// Returns the sine and the cosine of an angle in degrees; exactly for multiples of 90°.
fn sin_cos(degrees: f64) -> [f64; 2] {
    let within = degrees % 360.0;
    let quarter = libm::rint(within / 90.0);
    let rest = (within - 90.0 * quarter).to_radians();
    let (sin, cos) = (libm::sin(rest), libm::cos(rest));
    match (quarter as i32).rem_euclid(4) {
        0 => [sin, cos],
        1 => [cos, -sin],
        2 => [-sin, -cos],
        _ => [-cos, sin],
    }
}

/// The Delaunay triangulation of points on the unit sphere, and what is derived from it.
///
/// The triangles are those of the hull of a 3D mesh, and cover the sphere once: if all points are within
/// a half of it, those on the other side, too. Points on one circle have triangles on both of its
/// sides. One or two points have none.
///
/// Points that are nearer to each other than about 10⁻⁸ of the radius may be inside the hull, because
/// coordinates are rounded. They count as duplicates of the nearest vertex.
///
/// # Examples
///
/// ```
/// use gdel::Sphere;
///
/// let lon_lat = [[0.0, 0.0], [90.0, 0.0], [180.0, 0.0], [-90.0, 0.0], [0.0, 90.0], [0.0, -90.0f64]];
/// let points = gdel::on_sphere(&lon_lat)?;
/// let mesh = gdel::delaunay3d(&points)?;
/// let sphere = Sphere::new(&mesh, &points)?;
/// assert_eq!(sphere.triangles().len(), 8);
/// // Each of six points has a sixth of the sphere.
/// assert!(sphere.areas().iter().all(|area| (area - 4.0 * std::f64::consts::PI / 6.0).abs() < 1e-12));
/// let queries = gdel::on_sphere(&[[80.0, 10.0], [0.0, 60.0f64]])?;
/// assert_eq!(sphere.nearest_many(&queries)?, [Some(1), Some(4)]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Sphere<'a> {
    points: Points3<'a>,
    triangles: Vec<[u32; 3]>,
    /// The triangle across the edge opposite each vertex.
    neighbors: Vec<[u32; 3]>,
    duplicate_of: Vec<u32>,
    /// The triangles around each vertex, counter-clockwise as seen from outside.
    around: Csr,
    key: CurveKey<3>,
}

/// The centre of the sphere.
const CENTER: [f64; 3] = [0.0; 3];

impl<'a> Sphere<'a> {
    /// Takes the hull of a 3D mesh, whose points are on the unit sphere.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`], [`Error::NotFinite`] or [`Error::BrokenMesh`] as for
    /// [`Locator::new`](crate::Locator::new).
    pub fn new(mesh: &'a impl Mesh<3, 4>, points: impl Into<Points3<'a>>) -> Result<Self, Error> {
        let points = points.into();
        let complex: Complex<'_, 3, 4> = Complex::delaunay(mesh, points)?;
        let mut hull = Vec::new();
        for (simplex, neighbors) in complex.simplices.iter().zip(&*complex.neighbors) {
            hull.extend((0..4).filter(|&k| neighbors[k] == NONE).map(|k| facet(simplex, k)));
        }
        Sphere::of_hull(hull, complex.duplicate_of.into_owned(), points)
    }

    /// Takes the triangles of such a hull, counter-clockwise as seen from outside, and for each point the one
    /// that stands for it: [`Mesh3::hull`](crate::Mesh3::hull) and
    /// [`Mesh3::duplicate_of`](crate::Mesh3::duplicate_of), or what another `Sphere` returned. Triangles keep
    /// their order.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`], [`Error::NotFinite`] or [`Error::BrokenMesh`].
    pub fn from_hull(
        hull: Vec<[u32; 3]>,
        duplicate_of: Vec<u32>,
        points: impl Into<Points3<'a>>,
    ) -> Result<Self, Error> {
        let points = points.into();
        if points.len() != duplicate_of.len() {
            return Err(Error::PointCount { points: points.len(), expected: duplicate_of.len() });
        }
        points.validate()?;
        let is_index = |&v: &u32| (v as usize) < points.len();
        if !hull.as_flattened().iter().all(is_index) || !duplicate_of.iter().all(|of| *of == NONE || is_index(of)) {
            return Err(Error::BrokenMesh { reason: "a vertex does not exist" });
        }
        Sphere::of_hull(hull, duplicate_of, points)
    }

    fn of_hull(mut triangles: Vec<[u32; 3]>, duplicate_of: Vec<u32>, points: Points3<'a>) -> Result<Self, Error> {
        if triangles.is_empty() {
            triangles = both_sides(points, &duplicate_of);
        }
        let mut around = Csr::stars(&triangles, points.len());
        let neighbors = across_edges(&triangles, &around)?;
        around.arrange(|v, fan| walk_around(v, fan, &triangles, &neighbors));
        let key = CurveKey::new([[-1.0; 3], [1.0; 3]]);
        let mut sphere = Sphere { points, triangles, neighbors, duplicate_of, around, key };
        if !sphere.triangles.is_empty() {
            sphere.drop_inner_points();
        }
        Ok(sphere)
    }

    /// Makes points that are not on the hull duplicates of the nearest one that is.
    fn drop_inner_points(&mut self) {
        let mut start = self.triangles[0][0];
        for i in 0..self.points.len() as u32 {
            if self.duplicate_of[i as usize] == NONE && self.around.of(i).is_empty() {
                start = self.nearest_from(start, self.points.get(i as usize));
                self.duplicate_of[i as usize] = start;
            }
        }
        for i in 0..self.points.len() {
            let of = self.duplicate_of[i];
            if of != NONE && of as usize != i && self.duplicate_of[of as usize] != NONE {
                self.duplicate_of[i] = self.duplicate_of[of as usize];
            }
        }
    }

    /// Returns the points that are not duplicates of others.
    fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(&self.duplicate_of).filter(|&(_, &of)| of == NONE).map(|(i, _)| i)
    }

    /// Returns the triangles, counter-clockwise as seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns for each triangle those across the edges opposite its vertices.
    pub fn neighbors(&self) -> &[[u32; 3]] {
        &self.neighbors
    }

    /// Returns for each point the one that stands for it, or [`NONE`](crate::NONE) if it is a vertex.
    pub fn duplicate_of(&self) -> &[u32] {
        &self.duplicate_of
    }

    /// Returns the triangles around each point, counter-clockwise as seen from outside: the Voronoi
    /// cell of the point has their centres as its corners.
    pub fn cells(&self) -> &Csr {
        &self.around
    }

    /// Returns the vertices of the spherical convex hull if all points are inside one half of the sphere:
    /// counter-clockwise as seen from outside, from the lowest index on. Otherwise there are none.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = gdel::on_sphere(&[[10.0, 0.0], [10.0, 10.0], [3.0, 5.0], [-2.0, 5.0], [0.0, 0.0f64]])?;
    /// let mesh = gdel::delaunay3d(&points)?;
    /// assert_eq!(gdel::Sphere::new(&mesh, &points)?.hull(), [0, 1, 3, 4]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn hull(&self) -> Vec<u32> {
        let is_outer: Vec<bool> = (0..self.triangles.len()).map(|t| self.is_outer(t)).collect();
        let mut next = FxHashMap::default();
        for (t, triangle) in self.triangles.iter().enumerate().filter(|&(t, _)| !is_outer[t]) {
            let border = (0..3).filter(|&k| is_outer[self.neighbors[t][k] as usize]);
            next.extend(border.map(|k| (triangle[(k + 1) % 3], triangle[(k + 2) % 3])));
        }
        let mut at = next.keys().min().copied();
        let mut hull = Vec::with_capacity(next.len());
        while let Some((v, w)) = at.and_then(|v| next.remove_entry(&v)) {
            hull.push(v);
            at = Some(w);
        }
        hull
    }

    /// Returns whether triangle `t` is outside the spherical convex hull, where it only closes the sphere:
    /// whether its circumcircle is larger than a half.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle `t`.
    pub fn is_outer(&self, t: usize) -> bool {
        let [a, b, c] = self.corners(self.triangles[t]);
        orient3d(a, b, c, CENTER) > 0
    }

    /// Returns the centre of each triangle's circumcircle: a vertex of the Voronoi diagram. No point is
    /// nearer to it than the triangle's corners.
    pub fn centers(&self) -> Vec<[f64; 3]> {
        self.triangles.iter().map(|&triangle| unit(self.normal(triangle))).collect()
    }

    /// Returns the corners of Voronoi cells, and for each point those of its cell, counter-clockwise as seen
    /// from outside. First come the centres of all triangles. Edges of cells that are longer than a quarter of
    /// a great circle have a corner in their middle, so that no two ends are opposite each other. The cell of
    /// a single point is the whole sphere, which has no corners.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = gdel::on_sphere(&[[0.0, 0.0], [180.0, 0.0f64]])?;
    /// let mesh = gdel::delaunay3d(&points)?;
    /// let (corners, cells) = gdel::Sphere::new(&mesh, &points)?.polygons();
    /// // Two halves, with the same great circle in two directions.
    /// assert_eq!((corners.len(), cells.of(0), cells.of(1)), (4, &[0, 1, 2, 3][..], &[0, 3, 2, 1][..]));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn polygons(&self) -> (Vec<[f64; 3]>, Csr) {
        if self.triangles.is_empty() {
            return self.halves();
        }
        let mut cells = Csr::default();
        let centers = self.centers();
        let mut corners = centers.clone();
        // The corner in the middle of a long edge, by the points on both sides.
        let mut middles: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        let mut cell = Vec::new();
        for v in 0..self.points.len() as u32 {
            cell.clear();
            let fan = self.around.of(v);
            for (i, &t) in fan.iter().enumerate() {
                cell.push(t);
                let [from, to] = [t, fan[(i + 1) % fan.len()]].map(|t| centers[t as usize]);
                if vector::dot(from, to) >= 0.0 {
                    continue;
                }
                let w = before(self.triangles[t as usize], v);
                let middle = *middles.entry([v.min(w), v.max(w)]).or_insert_with(|| {
                    let [site, other] = [v, w].map(|v| self.points.get(v as usize));
                    corners.push(middle(from, to, vector::minus(site, other)));
                    corners.len() as u32 - 1
                });
                cell.push(middle);
            }
            cells.push(cell.iter().copied());
        }
        (corners, cells)
    }

    /// Returns the cells of one or two points.
    fn halves(&self) -> (Vec<[f64; 3]>, Csr) {
        let sites: Vec<u32> = self.vertices().collect();
        let mut corners = Vec::new();
        if let [a, b] = sites[..] {
            let [a, b] = [a, b].map(|v| self.points.get(v as usize));
            let normal = vector::minus(a, b);
            let axis = (0..3).min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs())).unwrap_or(0);
            let mut other = [0.0; 3];
            other[axis] = 1.0;
            let x = unit(vector::cross(normal, other));
            let y = unit(vector::cross(normal, x));
            corners.extend([x, y, vector::times(-1.0, x), vector::times(-1.0, y)]);
        }
        let mut cells = Csr::default();
        for v in 0..self.points.len() as u32 {
            cells.push(match sites[..] {
                [a, _] if a == v => vec![0, 1, 2, 3],
                [_, b] if b == v => vec![0, 3, 2, 1],
                _ => Vec::new(),
            });
        }
        (corners, cells)
    }

    /// Returns the area of each point's Voronoi cell on the unit sphere; 0 for duplicates. The sum of
    /// all is 4π.
    pub fn areas(&self) -> Vec<f64> {
        if self.triangles.is_empty() {
            let share = 4.0 * PI / self.vertices().count() as f64;
            return self.duplicate_of.iter().map(|&of| if of == NONE { share } else { 0.0 }).collect();
        }
        let centers = self.centers();
        (0..self.points.len() as u32).map(|v| self.area(v, &centers)).collect()
    }

    fn area(&self, v: u32, centers: &[[f64; 3]]) -> f64 {
        let (site, fan) = (self.points.get(v as usize), self.around.of(v));
        let mut area = 0.0;
        for (i, &t) in fan.iter().enumerate() {
            let [from, to] = [t, fan[(i + 1) % fan.len()]].map(|t| centers[t as usize]);
            // In two parts, as the ends of a long edge may be opposite each other.
            if vector::dot(from, to) < 0.0 {
                let other = self.points.get(before(self.triangles[t as usize], v) as usize);
                let middle = middle(from, to, vector::minus(site, other));
                area += signed_area(site, from, middle) + signed_area(site, middle, to);
            } else {
                area += signed_area(site, from, to);
            }
        }
        area
    }

    /// Returns the point that is nearest to each query, of several the one with the lowest index; `None`
    /// if there are no points. Only the directions of queries matter.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`].
    pub fn nearest_many<'q>(&self, queries: impl Into<Points3<'q>>) -> Result<Vec<Option<u32>>, Error> {
        map_along_curve::<3, 4, _>(queries.into(), self.key, |run| {
            let mut last = self.triangles.first().map(|triangle| triangle[0]);
            let nearest = |&query: &[f64; 3]| {
                let query = unit(query);
                match last {
                    Some(start) => last = Some(self.nearest_from(start, query)),
                    // One or two points.
                    None => {
                        return self.vertices().reduce(|a, b| if self.compare(query, b, a) < 0 { b } else { a });
                    }
                }
                last
            };
            Ok(run.iter().map(nearest).collect())
        })
    }

    /// Returns the sign of the difference of the distances of two points from a query.
    fn compare(&self, query: [f64; 3], a: u32, b: u32) -> Sign {
        let [p, q] = [a, b].map(|v| self.points.get(v as usize));
        compare_distances(query, p, q)
    }

    /// Walks to the nearest vertex, of several the one with the lowest index.
    fn nearest_from(&self, start: u32, query: [f64; 3]) -> u32 {
        let neighbors = |v| self.neighbors_of(v).filter(move |&w| w != v);
        walk(start, neighbors, |v| self.points.get(v as usize), |&p, &q| compare_distances(query, p, q))
    }

    /// Returns the vertices that vertex `v` has an edge to.
    fn neighbors_of(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        self.around.of(v).iter().map(move |&t| before(self.triangles[t as usize], v))
    }

    /// Returns the triangle that contains each query; `None` for those outside the spherical convex hull
    /// of points within a half of the sphere, by more than coordinates are rounded. Only the directions of
    /// queries matter.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`].
    pub fn locate_many<'q>(&self, queries: impl Into<Points3<'q>>) -> Result<Vec<Option<usize>>, Error> {
        map_along_curve::<3, 4, _>(queries.into(), self.key, |run| {
            let mut last = self.triangles.first().map(|triangle| triangle[0]);
            let locate = |&query: &[f64; 3]| {
                last = last.map(|start| self.nearest_from(start, unit(query)));
                last.and_then(|vertex| self.locate_from(vertex, query))
            };
            Ok(run.iter().map(locate).collect())
        })
    }

    /// Walks from the vertex that is nearest to the triangle that contains a query.
    fn locate_from(&self, vertex: u32, query: [f64; 3]) -> Option<usize> {
        let fan = self.around.of(vertex).iter().map(|&t| t as usize).filter(|&t| self.is_front(t));
        let mut at = fan.clone().find(|&t| self.exits(t, query).next().is_none());
        at = at.or_else(|| fan.clone().next());
        let mut t = at?;
        // Rounding could not make it endless, as the signs are exact; a broken mesh could.
        for _ in 0..=self.triangles.len() {
            match self.exits(t, query).find(|&k| self.is_front(self.neighbors[t][k] as usize)) {
                Some(k) => t = self.neighbors[t][k] as usize,
                None => return self.exits(t, query).all(|k| self.is_near(t, k, query)).then_some(t),
            }
        }
        None
    }

    /// Returns whether the centre is on the inner side of a triangle's plane.
    fn is_front(&self, t: usize) -> bool {
        let [a, b, c] = self.corners(self.triangles[t]);
        orient3d(a, b, c, CENTER) < 0
    }

    /// Returns the vertices of a triangle opposite the edges that separate it from a query.
    fn exits(&self, t: usize, query: [f64; 3]) -> impl Iterator<Item = usize> {
        let corners = self.corners(self.triangles[t]);
        (0..3).filter(move |&k| orient3d(CENTER, corners[(k + 1) % 3], corners[(k + 2) % 3], query) < 0)
    }

    /// Returns whether a query is beyond the edge opposite vertex `k` by no more than rounding.
    fn is_near(&self, t: usize, k: usize, query: [f64; 3]) -> bool {
        let corners = self.corners(self.triangles[t]);
        let normal = vector::cross(corners[(k + 1) % 3], corners[(k + 2) % 3]);
        vector::dot(normal, query) >= -ROUNDING * vector::norm(normal) * vector::norm(query)
    }

    /// Returns the interpolated value at each query, given one value per point, and how many queries are
    /// outside. Values are linear in the plane of the triangle that contains the query, seen from the centre,
    /// and NaN where no triangle does.
    ///
    /// # Errors
    ///
    /// [`Error::ValueCount`] or [`Error::NotFinite`].
    pub fn interpolate_many<'q>(&self, values: &[f64], queries: impl Into<Points3<'q>>) -> Result<Interpolated, Error> {
        if values.len() != self.points.len() {
            return Err(Error::ValueCount { values: values.len(), points: self.points.len() });
        }
        let queries = queries.into();
        let located = self.locate_many(queries)?;
        let value = |(query, t): ([f64; 3], Option<usize>)| {
            let Some(t) = t else { return f64::NAN };
            let corners = self.corners(self.triangles[t]);
            let weight =
                |k: usize| vector::dot(query, vector::cross(corners[(k + 1) % 3], corners[(k + 2) % 3])).max(0.0);
            let weights = [0, 1, 2].map(weight);
            let sum: f64 = weights.iter().sum();
            let terms = weights.iter().zip(self.triangles[t]).filter(|&(&weight, _)| weight > 0.0);
            terms.map(|(weight, v)| weight / sum * values[v as usize]).sum()
        };
        let outside = located.iter().filter(|triangle| triangle.is_none()).count();
        Ok(Interpolated { values: queries.iter().zip(located).map(value).collect(), outside })
    }

    fn corners(&self, triangle: [u32; 3]) -> [[f64; 3]; 3] {
        triangle.map(|v| self.points.get(v as usize))
    }

    fn normal(&self, triangle: [u32; 3]) -> [f64; 3] {
        let [a, b, c] = self.corners(triangle);
        vector::cross(vector::minus(b, a), vector::minus(c, a))
    }
}

/// Returns the vector of the length 1 with this direction.
fn unit(p: [f64; 3]) -> [f64; 3] {
    vector::times(1.0 / vector::norm(p), p)
}

/// Returns the area of a spherical triangle, positive if it is counter-clockwise as seen from outside
/// (Van Oosterom and Strackee 1983).
fn signed_area(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    let numerator = vector::dot(a, vector::cross(b, c));
    2.0 * libm::atan2(numerator, 1.0 + vector::dot(a, b) + vector::dot(b, c) + vector::dot(c, a))
}

/// Returns the triangles on both sides of a polygon, if all points are on one circle.
fn both_sides(points: Points3<'_>, duplicate_of: &[u32]) -> Vec<[u32; 3]> {
    let mut polygon: Vec<u32> = (0..points.len() as u32).filter(|&i| duplicate_of[i as usize] == NONE).collect();
    if polygon.len() < 3 {
        return Vec::new();
    }
    let at = |v: u32| points.get(v as usize);
    let middle = polygon.iter().fold([0.0; 3], |sum, &v| vector::plus(sum, at(v)));
    let middle = vector::times(1.0 / polygon.len() as f64, middle);
    let [a, b, c] = [polygon[0], polygon[1], polygon[2]].map(at);
    let normal = vector::cross(vector::minus(b, a), vector::minus(c, a));
    let x = vector::minus(a, middle);
    let y = vector::cross(normal, x);
    let [x, y] = [x, y].map(unit);
    let angle = |v: u32| {
        let from_middle = vector::minus(at(v), middle);
        libm::atan2(vector::dot(from_middle, y), vector::dot(from_middle, x))
    };
    polygon.sort_by(|&v, &w| angle(v).total_cmp(&angle(w)));
    // From two of the points, so that no edge within the polygon is on both sides.
    let fan = |polygon: &[u32]| polygon[1..].windows(2).map(|pair| [polygon[0], pair[0], pair[1]]).collect();
    let mut triangles: Vec<[u32; 3]> = fan(&polygon);
    polygon.rotate_left(1);
    polygon[1..].reverse();
    triangles.extend::<Vec<[u32; 3]>>(fan(&polygon));
    triangles
}

/// Returns the vertex of a counter-clockwise triangle before another one.
fn before(triangle: [u32; 3], v: u32) -> u32 {
    let place = triangle.iter().position(|&w| w == v).unwrap_or(0);
    triangle[(place + 2) % 3]
}

/// Returns the middle of an arc of a quarter to a half of a great circle, which has `left` on its left.
fn middle(from: [f64; 3], to: [f64; 3], left: [f64; 3]) -> [f64; 3] {
    let cos = vector::dot(from, to).max(-1.0);
    let ahead = unit(vector::cross(left, from));
    let [along, up] = [(1.0 + cos) / 2.0, (1.0 - cos) / 2.0].map(f64::sqrt);
    unit(vector::plus(vector::times(along, from), vector::times(up, ahead)))
}

/// Returns for each triangle of a closed surface those across the edges opposite its vertices, given the
/// triangles around each vertex.
fn across_edges(triangles: &[[u32; 3]], stars: &Csr) -> Result<Vec<[u32; 3]>, Error> {
    let across = |triangle: &[u32; 3], k: usize| {
        let [from, to] = [triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
        let has_opposite = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].contains(&[to, from]);
        stars.of(from).iter().copied().find(|&t| has_opposite(triangles[t as usize]))
    };
    let broken = Error::BrokenMesh { reason: "the hull is not closed" };
    let row = |triangle| Some([across(triangle, 0)?, across(triangle, 1)?, across(triangle, 2)?]);
    triangles.iter().map(row).collect::<Option<_>>().ok_or(broken)
}

/// Puts the triangles around a vertex in their order, counter-clockwise as seen from outside.
fn walk_around(v: u32, fan: &mut [u32], triangles: &[[u32; 3]], neighbors: &[[u32; 3]]) {
    let Some(&first) = fan.first() else { return };
    let mut t = first;
    for place in fan {
        *place = t;
        // Of a counter-clockwise triangle (v, a, b), the next one is across (v, b), opposite a.
        let own = triangles[t as usize].iter().position(|&w| w == v).unwrap_or(0);
        t = neighbors[t as usize][(own + 1) % 3];
    }
}
