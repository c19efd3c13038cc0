//! What meshes of both dimensions have in common.

use crate::{
    index::NONE,
    parallel::{self, CHUNK, Threads},
    stats::Stats,
};
use std::{
    borrow::Cow,
    sync::atomic::{AtomicU32, AtomicUsize, Ordering::Relaxed},
};

/// Lists of indices, one after the other in one array: compressed sparse rows.
///
/// List *i* is `indices[offsets[i]..offsets[i + 1]]`. The simplices around each vertex
/// ([`Mesh3::stars`](crate::Mesh3::stars), [`Mesh2::stars`](crate::Mesh2::stars)) and the
/// neighbours of each vertex ([`Mesh3::vertex_neighbors`](crate::Mesh3::vertex_neighbors),
/// [`Mesh2::vertex_neighbors`](crate::Mesh2::vertex_neighbors)) have this form. Build them once for
/// many vertices.
///
/// # Examples
///
/// ```
/// // A square around its centre.
/// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0f64]];
/// let neighbors = gdel::delaunay2d(&points)?.vertex_neighbors();
/// assert_eq!(neighbors.len(), 5);
/// assert_eq!(neighbors.of(4), [0, 1, 2, 3]);
/// assert_eq!(neighbors.of(0), [1, 3, 4]);
/// assert_eq!((neighbors.offsets[1], neighbors.indices.len()), (3, 16));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Csr {
    /// Where each list starts in `indices`; one more entry says where the last one ends.
    pub offsets: Vec<usize>,
    /// The lists.
    pub indices: Vec<u32>,
}

/// Returns no lists.
impl Default for Csr {
    fn default() -> Self {
        Csr { offsets: vec![0], indices: Vec::new() }
    }
}

impl Csr {
    /// Sorts simplices by their vertices, which are below `points`: list *v* has the simplices
    /// around *v*, in ascending order.
    pub(crate) fn stars<const N: usize>(simplices: &[[u32; N]], points: usize) -> Self {
        if parallel::count(Threads::All) > 1 && simplices.len() > CHUNK {
            return Csr::stars_by_all(simplices, points);
        }
        // Entry v + 1 counts the simplices of v, then says where the next of them goes, and at last
        // where they end.
        let mut offsets = vec![0; points + 1];
        for &v in simplices.as_flattened() {
            offsets[v as usize + 1] += 1;
        }
        let mut before = 0;
        for offset in &mut offsets[1..] {
            before += std::mem::replace(offset, before);
        }
        let mut indices = vec![0; simplices.as_flattened().len()];
        for (t, simplex) in (0..).zip(simplices) {
            for &v in simplex {
                let next = &mut offsets[v as usize + 1];
                indices[*next] = t;
                *next += 1;
            }
        }
        Csr { offsets, indices }
    }

    /// Does what [`stars`](Self::stars) does on all threads.
    fn stars_by_all<const N: usize>(simplices: &[[u32; N]], points: usize) -> Self {
        let for_all = |work: &(dyn Fn(usize, u32) + Sync)| {
            parallel::map_ranges(Threads::All, simplices.len(), |range| {
                range.for_each(|t| simplices[t].iter().for_each(|&v| work(t, v)));
            });
        };
        let mut ends: Vec<AtomicUsize> = (0..=points).map(|_| AtomicUsize::new(0)).collect();
        for_all(&|_, v| _ = ends[v as usize + 1].fetch_add(1, Relaxed));
        let mut before = 0;
        for end in &mut ends[1..] {
            before += std::mem::replace(end.get_mut(), before);
        }
        let indices: Vec<AtomicU32> = (0..before).map(|_| AtomicU32::new(0)).collect();
        for_all(&|t, v| indices[ends[v as usize + 1].fetch_add(1, Relaxed)].store(t as u32, Relaxed));
        let mut stars = Csr {
            offsets: ends.into_iter().map(AtomicUsize::into_inner).collect(),
            indices: indices.into_iter().map(AtomicU32::into_inner).collect(),
        };
        // Threads put simplices into the lists in any order.
        let (mut left, mut parts) = (&mut stars.indices[..], Vec::new());
        for start in (0..points).step_by(CHUNK) {
            let ends = &stars.offsets[start..=points.min(start + CHUNK)];
            let part = left.split_off_mut(..ends[ends.len() - 1] - ends[0]).unwrap_or_default();
            parts.push((ends, part));
        }
        parallel::map_mut(Threads::All, &mut parts, |_, (ends, part)| {
            ends.windows(2).for_each(|pair| part[pair[0] - ends[0]..pair[1] - ends[0]].sort_unstable());
        });
        stars
    }

    /// Lists the vertices that share a simplex with each vertex, in ascending order. The vertices
    /// are below `points`.
    pub(crate) fn vertex_neighbors<const N: usize>(simplices: &[[u32; N]], points: usize) -> Self {
        let stars = Csr::stars(simplices, points);
        let mut neighbors = Csr { offsets: Vec::with_capacity(points + 1), indices: Vec::new() };
        neighbors.offsets.push(0);
        // The last vertex whose list each vertex was put into.
        let mut listed_by = vec![NONE; points];
        for v in 0..points as u32 {
            let start = neighbors.indices.len();
            listed_by[v as usize] = v;
            for &t in stars.of(v) {
                for &w in &simplices[t as usize] {
                    if listed_by[w as usize] != v {
                        listed_by[w as usize] = v;
                        neighbors.indices.push(w);
                    }
                }
            }
            neighbors.indices[start..].sort_unstable();
            neighbors.offsets.push(neighbors.indices.len());
        }
        neighbors
    }

    /// Appends a list.
    pub(crate) fn push(&mut self, list: impl IntoIterator<Item = u32>) {
        self.indices.extend(list);
        self.offsets.push(self.indices.len());
    }

    /// Removes all lists.
    pub(crate) fn clear(&mut self) {
        self.offsets.truncate(1);
        self.indices.clear();
    }

    /// Gives each list to `arrange`, which may change the order within it.
    pub(crate) fn arrange(&mut self, mut arrange: impl FnMut(u32, &mut [u32])) {
        for (i, ends) in (0..).zip(self.offsets.windows(2)) {
            arrange(i, &mut self.indices[ends[0]..ends[1]]);
        }
    }

    /// Returns the number of lists.
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Returns whether there are no lists.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns list `i`.
    ///
    /// # Panics
    ///
    /// Panics if there is no list `i`.
    #[inline]
    pub fn of(&self, i: u32) -> &[u32] {
        &self.indices[self.offsets[i as usize]..self.offsets[i as usize + 1]]
    }
}

/// A mesh of either dimension: [`Mesh3`](crate::Mesh3) with `D` = 3 coordinates per point and `N` =
/// 4 vertices per tetrahedron, or [`Mesh2`](crate::Mesh2) with 2 and 3.
///
/// It is what functions and types that take both ask for, and cannot be implemented for others.
///
/// # Examples
///
/// ```
/// fn simplices<const D: usize, const N: usize>(mesh: &impl gdel::Mesh<D, N>) -> usize {
///     mesh.simplices().len()
/// }
///
/// let mesh = gdel::delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]])?;
/// assert_eq!(simplices(&mesh), 1);
/// # Ok::<(), gdel::Error>(())
/// ```
pub trait Mesh<const D: usize, const N: usize>: sealed::Sealed {
    /// Returns the vertices of the tetrahedra or triangles.
    fn simplices(&self) -> &[[u32; N]];

    /// Returns for each simplex the simplices opposite its vertices, or [`NONE`](crate::NONE)
    /// outside the hull.
    fn opposites(&self) -> Cow<'_, [[u32; N]]>;

    /// Returns for each point the one that stands for it, or [`NONE`](crate::NONE) if it is a
    /// vertex itself; for points that were [removed](crate::Triangulator::remove), these themselves.
    fn duplicate_of(&self) -> &[u32];

    /// Returns the weights of the points; none if the mesh is the Delaunay triangulation.
    fn weights(&self) -> &[f64];

    /// Returns the constrained edges, the lower vertex first, in ascending order; none if the mesh is not a
    /// [constrained](crate::Triangulator::constrained2d) Delaunay triangulation.
    fn constraints(&self) -> &[[u32; 2]];
}

pub(crate) mod sealed {
    /// Only this crate's meshes implement [`Mesh`](super::Mesh).
    pub trait Sealed {}
}

/// Returns for each vertex a simplex that has it, that with the lowest index; [`NONE`] for
/// duplicates and vertices without simplices.
pub(crate) fn vertex_simplex<const N: usize>(simplices: &[[u32; N]], points: usize) -> Vec<u32> {
    let mut simplex = vec![NONE; points];
    for (t, vertices) in simplices.iter().enumerate().rev() {
        for &v in vertices {
            simplex[v as usize] = t as u32;
        }
    }
    simplex
}

/// Returns the distinct points that are no vertices of the simplices, in ascending order.
pub(crate) fn hidden<const N: usize>(simplices: &[[u32; N]], duplicate_of: &[u32]) -> Vec<u32> {
    let mut is_vertex = vec![false; duplicate_of.len()];
    for &v in simplices.as_flattened() {
        is_vertex[v as usize] = true;
    }
    let distinct = (0..).zip(duplicate_of).filter(|&(_, &d)| d == NONE).map(|(i, _)| i);
    distinct.filter(|&i| !is_vertex[i as usize]).collect()
}

/// Returns the index behind an entry of `neighbors` or `duplicate_of`.
pub(crate) fn index(entry: u32) -> Option<usize> {
    (entry != NONE).then_some(entry as usize)
}

/// Returns the simplices in a form that is equal for equal meshes.
pub fn canonical<const N: usize>(simplices: &[[u32; N]]) -> Vec<[u32; N]> {
    let mut simplices = simplices.to_vec();
    for simplex in &mut simplices {
        simplex.sort_unstable();
    }
    simplices.sort_unstable();
    simplices
}

/// What meshes of both dimensions say of their points and of their run.
pub trait MeshInfo {
    /// Sets what the mesh says of its points.
    fn set_input(&mut self, duplicate_of: Vec<u32>, dimension: u8);

    /// Sets the weights of the points, and which of them are hidden, after all else has been set.
    fn set_weights(&mut self, weights: &[f64]);

    /// Returns for each point the one that stands for it.
    fn duplicate_of(&self) -> &[u32];

    /// Makes vertex *v* `names[v]`, and leaves what has no name, by `threads`.
    fn rename(&mut self, threads: Threads, names: &[u32]);

    /// Returns the number of points that are duplicates.
    fn duplicates(&self) -> usize;

    /// Returns the number of hidden points, if the points are weighted.
    fn hidden_count(&self) -> Option<usize>;

    /// Returns the affine dimension of the points.
    fn dimension(&self) -> u8;

    /// Returns the statistics.
    fn stats(&self) -> &Stats;

    /// Returns the statistics, to be changed.
    fn stats_mut(&mut self) -> &mut Stats;

    /// Returns what the mesh says of its points (the duplicates and the dimension) and of its run.
    fn into_info(self) -> (Vec<u32>, u8, Stats);
}

/// Implements [`Mesh`], [`MeshInfo`], and methods on `duplicate_of`, which both meshes have, for
/// `$mesh<$D, $N>` with the simplices in `$simplices`. Its methods `opposites` and `constrained_edges` are
/// those of [`Mesh`].
macro_rules! common_methods {
    ($mesh:ident<$D:literal, $N:literal>, $simplices:ident) => {
        impl $crate::mesh::sealed::Sealed for $mesh {}

        impl $crate::mesh::Mesh<$D, $N> for $mesh {
            fn simplices(&self) -> &[[u32; $N]] {
                &self.$simplices
            }

            fn opposites(&self) -> std::borrow::Cow<'_, [[u32; $N]]> {
                self.opposites()
            }

            fn duplicate_of(&self) -> &[u32] {
                &self.duplicate_of
            }

            fn weights(&self) -> &[f64] {
                &self.weights
            }

            fn constraints(&self) -> &[[u32; 2]] {
                self.constrained_edges()
            }
        }

        impl $crate::mesh::MeshInfo for $mesh {
            fn set_input(&mut self, duplicate_of: Vec<u32>, dimension: u8) {
                (self.duplicate_of, self.dimension) = (duplicate_of, dimension);
            }

            fn set_weights(&mut self, weights: &[f64]) {
                self.weights = weights.to_vec();
                let is_spanned = self.dimension == $D;
                self.hidden =
                    if is_spanned { $crate::mesh::hidden(&self.$simplices, &self.duplicate_of) } else { Vec::new() };
            }

            fn duplicate_of(&self) -> &[u32] {
                &self.duplicate_of
            }

            fn rename(&mut self, threads: $crate::parallel::Threads, names: &[u32]) {
                let rename = |_: usize, vertices: &mut [u32]| {
                    for v in vertices {
                        *v = names.get(*v as usize).copied().unwrap_or(*v);
                    }
                };
                $crate::parallel::for_chunks(threads, self.$simplices.as_flattened_mut(), rename);
                $crate::parallel::for_chunks(threads, bytemuck::cast_slice_mut(&mut self.hull), rename);
            }

            fn duplicates(&self) -> usize {
                self.duplicate_count()
            }

            fn hidden_count(&self) -> Option<usize> {
                (!self.weights.is_empty()).then_some(self.hidden.len())
            }

            fn dimension(&self) -> u8 {
                self.dimension
            }

            fn stats(&self) -> &$crate::stats::Stats {
                &self.stats
            }

            fn stats_mut(&mut self) -> &mut $crate::stats::Stats {
                &mut self.stats
            }

            fn into_info(self) -> (Vec<u32>, u8, $crate::stats::Stats) {
                (self.duplicate_of, self.dimension, self.stats)
            }
        }

        impl $mesh {
            /// Returns the vertices: the distinct points in ascending order, each by the lowest
            /// index of its coordinates, without the hidden ones of weighted points.
            pub fn vertices(&self) -> impl Iterator<Item = u32> + Clone + '_ {
                let distinct =
                    (0..).zip(&self.duplicate_of).filter(|&(_, &d)| d == $crate::index::NONE).map(|(i, _)| i);
                distinct.filter(|&i| !self.is_hidden(i))
            }

            /// Returns whether point `i` is one of the [`hidden`](Self::hidden) ones. A duplicate of one is not.
            pub fn is_hidden(&self, i: u32) -> bool {
                !self.hidden.is_empty() && self.hidden.binary_search(&i).is_ok()
            }

            /// Returns whether an earlier point has the same coordinates as point `i`, which
            /// therefore is not a vertex.
            ///
            /// # Panics
            ///
            /// Panics if there is no point `i`.
            pub fn is_duplicate(&self, i: u32) -> bool {
                self.duplicate_of[i as usize] != $crate::index::NONE && !self.is_unused(i)
            }

            /// Returns whether point `i` was [removed](crate::Triangulator::remove), so that it is no
            /// vertex, and stands for nothing. It is then its own duplicate in `duplicate_of`.
            ///
            /// # Panics
            ///
            /// Panics if there is no point `i`.
            pub fn is_unused(&self, i: u32) -> bool {
                self.duplicate_of[i as usize] == i
            }

            /// Returns the vertex that stands for point `i`: `i` itself unless it is a duplicate.
            ///
            /// # Panics
            ///
            /// Panics if there is no point `i`.
            pub fn representative(&self, i: u32) -> u32 {
                $crate::mesh::index(self.duplicate_of[i as usize]).map_or(i, |d| d as u32)
            }

            /// Returns the number of points that are duplicates.
            pub fn duplicate_count(&self) -> usize {
                (0..self.duplicate_of.len() as u32).filter(|&i| self.is_duplicate(i)).count()
            }

            /// Returns the number of points that were [removed](crate::Triangulator::remove).
            pub fn unused_count(&self) -> usize {
                (0..self.duplicate_of.len() as u32).filter(|&i| self.is_unused(i)).count()
            }

            /// Makes the mesh one of the points that were not
            /// [removed](crate::Triangulator::remove), numbered in their order. Returns what their
            /// indices were, with which the caller does the same to the points, and to values that
            /// belong to them.
            ///
            /// # Examples
            ///
            /// ```
            /// use gdel::{Backend, Triangulator};
            ///
            /// let points = [[0.0, 0.0], [0.5, 0.5], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0f64]];
            /// let triangulator = Triangulator::new().backend(Backend::Cpu);
            /// let mut mesh = triangulator.delaunay2d(&points)?;
            /// triangulator.remove(&mut mesh, &points, &[1])?;
            /// assert_eq!((mesh.unused_count(), mesh.hull.as_slice()), (1, &[0, 2, 3, 4][..]));
            ///
            /// let kept = mesh.compact();
            /// assert_eq!(kept, [0, 2, 3, 4]);
            /// let points: Vec<_> = kept.iter().map(|&i| points[i as usize]).collect();
            /// assert_eq!((mesh.unused_count(), mesh.hull.as_slice()), (0, &[0, 1, 2, 3][..]));
            /// assert!(gdel::verify2d(&points, &mesh)?.passed());
            /// # Ok::<(), gdel::Error>(())
            /// ```
            pub fn compact(&mut self) -> Vec<u32> {
                let kept: Vec<u32> = (0..self.duplicate_of.len() as u32).filter(|&i| !self.is_unused(i)).collect();
                let mut places = vec![$crate::index::NONE; self.duplicate_of.len()];
                (0..).zip(&kept).for_each(|(place, &i)| places[i as usize] = place);
                $crate::mesh::MeshInfo::rename(self, $crate::parallel::Threads::All, &places);
                let place = |first: u32| places.get(first as usize).copied().unwrap_or(first);
                self.duplicate_of = kept.iter().map(|&i| place(self.duplicate_of[i as usize])).collect();
                self.hidden.iter_mut().for_each(|i| *i = place(*i));
                self.weights = kept.iter().filter_map(|&i| self.weights.get(i as usize).copied()).collect();
                kept
            }
        }
    };
}
pub(crate) use common_methods;
