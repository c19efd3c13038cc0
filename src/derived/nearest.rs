//! Nearest vertices, by walking along the edges of the triangulation.
//!
//! In every Delaunay triangulation, for every point inside the hull or outside: the vertices
//! nearest to it are connected, and every other vertex has a neighbour that is nearer. (Shrink the
//! ball around the point that has the vertex on its boundary towards the vertex until its inside is
//! empty: all other vertices on the boundary of what is left are nearer, and the vertex has an edge
//! to one of them.) So no location is needed first.
//!
//! The same holds for power distances and regular triangulations: these are the lower sides of convex hulls, on which a
//! power distance is a linear function and the walk is that of the simplex method.

use super::{Locator, border::nearest_place, queries::map_along_curve};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, Power, facet, vector},
    input::points::Points,
    mesh::Csr,
    predicates::Sign,
};
use rustc_hash::FxHashSet;
use std::{
    cmp::{Ordering, Reverse},
    collections::BinaryHeap,
};

impl<const D: usize, const N: usize> Locator<'_, D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Returns the vertex that is nearest to a point, inside the hull or outside; `None` if there are no
    /// points. Of several vertices at the same distance it is the one with the
    /// lowest index. With weights, the distance is the power distance.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`].
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [1.0, 1.0f64]];
    /// let mesh = gdel::Triangulator::new().regular2d(&points, &[9.0, 0.0, 0.0, 1.0])?;
    /// let locator = gdel::Locator::new(&mesh, &points)?;
    /// // The ball around the first point has the largest radius.
    /// assert_eq!(locator.nearest([1.0, 1.0])?, Some(0));
    /// assert_eq!(locator.nearest([3.25, 0.0])?, Some(1));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn nearest(&self, query: [f64; D]) -> Result<Option<u32>, Error> {
        Points::F64(&[query]).validate()?;
        self.start_vertex(query).map(|start| self.nearest_to(query, start)).transpose()
    }

    /// Returns the vertex that is nearest to each of many points: see [`nearest`](Self::nearest).
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`].
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let locator = gdel::Locator::new(&mesh, &points)?;
    /// // The second one is at the same distance from all.
    /// assert_eq!(locator.nearest_many(&[[1.5, 9.0], [1.0, 1.0]])?, [Some(3), Some(0)]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn nearest_many<'q>(&self, queries: impl Into<Points<'q, D>>) -> Result<Vec<Option<u32>>, Error> {
        map_along_curve(queries.into(), self.key, |run| {
            let mut last = None;
            let nearest = |&query: &[f64; D]| {
                let start = last.or_else(|| self.start_vertex(query));
                last = start.map(|start| self.nearest_to(query, start)).transpose()?;
                Ok(last)
            };
            run.iter().map(nearest).collect()
        })
    }

    /// Returns the `k` vertices that are nearest to a point, in order of their distances, those at
    /// the same distance in order of their indices; all vertices if there are no more than `k`.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`].
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0], [0.0, 0.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let locator = gdel::Locator::new(&mesh, &points)?;
    /// assert_eq!(locator.nearest_k([2.0, 2.5], 3)?, [3, 2, 1]);
    /// // The last point is a duplicate, and so no vertex.
    /// assert_eq!(locator.nearest_k([1.0, 1.0], 9)?, [0, 1, 2, 3]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn nearest_k(&self, query: [f64; D], k: usize) -> Result<Vec<u32>, Error> {
        Points::F64(&[query]).validate()?;
        if self.is_searched_around() {
            return self.nearest_around(query, k);
        }
        let mut found = Vec::new();
        let Some(first) = self.nearest(query)?.filter(|_| k > 0) else { return Ok(found) };
        let neighbors = self.vertex_neighbors();
        let candidate = |vertex: u32| Candidate { query, power: self.power(query, vertex), vertex };
        let nearest = self.all_nearest(neighbors, query, first);
        let mut candidates: BinaryHeap<_> = nearest.iter().map(|&v| candidate(v)).collect();
        let mut seen = FxHashSet::from_iter(nearest);
        while found.len() < k
            && let Some(nearest) = candidates.pop()
        {
            found.push(nearest.vertex);
            let new = neighbors.of(nearest.vertex).iter().filter(|&&v| seen.insert(v));
            candidates.extend(new.map(|&v| candidate(v)));
        }
        Ok(found)
    }

    /// Returns the vertex that is nearest to a query, from one that is probably near it.
    #[inline]
    pub(super) fn nearest_to(&self, query: [f64; D], start: u32) -> Result<u32, Error> {
        if self.is_searched_around() {
            return Ok(self.nearest_around(query, 1)?.first().copied().unwrap_or(start));
        }
        Ok(self.nearest_from(self.vertex_neighbors(), query, start))
    }

    /// Returns whether walks from vertex to vertex may end too early, since edges between nearest vertices are missing.
    fn is_searched_around(&self) -> bool {
        self.complex.is_constrained() && !self.complex.simplices.is_empty()
    }

    /// Returns the `k` vertices that are nearest to a query, in order: those of all simplices that meet the ball around it
    /// in which they are. These hang together, since ball and hull are convex.
    fn nearest_around(&self, query: [f64; D], k: usize) -> Result<Vec<u32>, Error> {
        let complex = &self.complex;
        let Some(place) = self.place(query, None)?.filter(|_| k > 0) else { return Ok(Vec::new()) };
        let start = match place.beyond {
            Some(beyond) => self.nearest_facet(query, (place.simplex, beyond.facet)).0.0,
            None => place.simplex,
        };
        let squared = |p: [f64; D]| vector::squared_norm(vector::times(self.scale, vector::minus(p, query)));
        let mut found = BinaryHeap::new();
        let (mut pending, mut seen) = (vec![start], FxHashSet::from_iter([start]));
        let mut seen_vertices = FxHashSet::default();
        while let Some(t) = pending.pop() {
            let simplex = complex.simplices[t];
            for vertex in simplex.into_iter().filter(|&v| seen_vertices.insert(v)) {
                found.push(Reverse(Candidate { query, power: self.power(query, vertex), vertex }));
                if found.len() > k {
                    found.pop();
                }
            }
            let farthest = found.peek().filter(|_| found.len() == k);
            let reach = farthest.map_or(f64::INFINITY, |Reverse(farthest)| squared(complex.point(farthest.vertex)));
            for facet_number in 0..N {
                let Some(across) = complex.across(t, facet_number).filter(|across| !seen.contains(across)) else {
                    continue;
                };
                let corners = facet(&complex.corners(t), facet_number);
                let (_, distance) = nearest_place(&corners, query, self.scale);
                // More than rounding adds: the error of the place is a few units in the last place of the corners' distances.
                let longest = corners.iter().map(|&p| squared(p)).fold(0.0, f64::max);
                let is_beyond = distance > reach * (1.0 + 1e-9) + 1e-20 * longest;
                if !is_beyond {
                    seen.insert(across);
                    pending.push(across);
                }
            }
        }
        // The nearest is the greatest, and so the least of these.
        Ok(found.into_sorted_vec().into_iter().map(|Reverse(candidate)| candidate.vertex).collect())
    }

    /// Returns a vertex that is probably near a point.
    fn start_vertex(&self, query: [f64; D]) -> Option<u32> {
        let flat = || self.flat.as_ref().map(|flat| flat.start(&self.complex, query));
        self.start(query).map(|start| self.complex.simplices[start][0]).or_else(flat)
    }

    /// Returns the power distance of a vertex, its squared distance without weights.
    #[inline(always)]
    fn power(&self, query: [f64; D], v: u32) -> Power<D> {
        Power::new(query, self.complex.point(v), self.complex.weight(v))
    }

    /// Returns the neighbours of each vertex.
    pub(super) fn vertex_neighbors(&self) -> &Csr {
        if let Some(flat) = &self.flat {
            return &flat.neighbors;
        }
        self.neighbors.get_or_init(|| Csr::vertex_neighbors(&self.complex.simplices, self.complex.points().len()))
    }

    /// Walks from a vertex to the one nearest to a query.
    pub(super) fn nearest_from(&self, neighbors: &Csr, query: [f64; D], start: u32) -> u32 {
        let neighbors = |v| neighbors.of(v).iter().copied();
        walk(start, neighbors, |v| self.power(query, v), |a, b| a.compare(b, query))
    }

    /// Returns all vertices that are as near to a query as `v`, which is nearest.
    pub(super) fn all_nearest(&self, neighbors: &Csr, query: [f64; D], v: u32) -> Vec<u32> {
        let neighbors = |v| neighbors.of(v).iter().copied();
        tied(v, neighbors, |v| self.power(query, v), |a, b| a.compare(b, query))
    }
}

/// Walks from a vertex to the nearest one, of several that with the lowest index, by the neighbours of a vertex, its
/// distance, and the sign of the difference of two distances.
#[inline]
pub(super) fn walk<T, I: Iterator<Item = u32>>(
    start: u32,
    neighbors: impl Fn(u32) -> I,
    distance: impl Fn(u32) -> T,
    compare: impl Fn(&T, &T) -> Sign,
) -> u32 {
    let (mut best, mut least) = (start, distance(start));
    loop {
        let at = best;
        let mut is_tied = false;
        for v in neighbors(at) {
            let other = distance(v);
            let order = compare(&other, &least);
            is_tied |= order == 0;
            if order < 0 {
                (best, least) = (v, other);
                is_tied = false;
            }
        }
        if best == at {
            let all = || tied(best, neighbors, distance, compare).into_iter().min();
            return if is_tied { all().unwrap_or(best) } else { best };
        }
    }
}

/// Returns all vertices that are as near as `v`, which is nearest: they hang together.
#[inline(never)]
fn tied<T, I: Iterator<Item = u32>>(
    v: u32,
    neighbors: impl Fn(u32) -> I,
    distance: impl Fn(u32) -> T,
    compare: impl Fn(&T, &T) -> Sign,
) -> Vec<u32> {
    let least = distance(v);
    let mut tied = vec![v];
    let mut seen = FxHashSet::from_iter([v]);
    let mut next = 0;
    while let Some(&v) = tied.get(next) {
        next += 1;
        for w in neighbors(v) {
            if compare(&distance(w), &least) == 0 && seen.insert(w) {
                tied.push(w);
            }
        }
    }
    tied
}

/// A vertex on the way to the nearest ones: the greatest is the nearest, with the lowest index.
struct Candidate<const D: usize> {
    query: [f64; D],
    power: Power<D>,
    vertex: u32,
}

impl<const D: usize> Ord for Candidate<D> {
    fn cmp(&self, other: &Self) -> Ordering {
        let difference = self.power.compare(&other.power, self.query);
        difference.cmp(&0).reverse().then(other.vertex.cmp(&self.vertex))
    }
}

impl<const D: usize> PartialOrd for Candidate<D> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const D: usize> PartialEq for Candidate<D> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<const D: usize> Eq for Candidate<D> {}
