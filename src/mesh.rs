//! What meshes of both dimensions have in common.

use crate::{index::NONE, stats::Stats};

/// The simplices around each vertex of a mesh: tetrahedra in 3D, triangles in 2D.
///
/// [`Mesh3::stars`](crate::Mesh3::stars) and [`Mesh2::stars`](crate::Mesh2::stars) create it in one
/// pass over the mesh. Build it once for many vertices.
///
/// # Examples
///
/// ```
/// // A square around its centre: the star of the centre has four triangles.
/// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let stars = mesh.stars();
/// assert_eq!(stars.of(4).len(), 4);
/// assert_eq!(stars.of(0).len(), 2);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Stars {
    /// Where the star of each vertex starts in `simplices`; one more entry says where the last one
    /// ends.
    starts: Vec<usize>,
    simplices: Vec<u32>,
}

impl Stars {
    /// Sorts simplices by their vertices, which are below `points`. Within a star they ascend.
    pub(crate) fn new<const N: usize>(simplices: &[[u32; N]], points: usize) -> Self {
        // Entry v + 1 counts the simplices of v, then says where the next of them goes, and at last
        // where they end.
        let mut starts = vec![0; points + 1];
        for &v in simplices.as_flattened() {
            starts[v as usize + 1] += 1;
        }
        let mut before = 0;
        for start in &mut starts[1..] {
            before += std::mem::replace(start, before);
        }
        let mut sorted = vec![0; simplices.as_flattened().len()];
        for (t, simplex) in (0..).zip(simplices) {
            for &v in simplex {
                let next = &mut starts[v as usize + 1];
                sorted[*next] = t;
                *next += 1;
            }
        }
        Stars { starts, simplices: sorted }
    }

    /// Gives each star to `arrange`, which may change the order within it.
    pub(crate) fn arrange(&mut self, mut arrange: impl FnMut(u32, &mut [u32])) {
        for (v, ends) in (0..).zip(self.starts.windows(2)) {
            arrange(v, &mut self.simplices[ends[0]..ends[1]]);
        }
    }

    /// Returns the indices of the simplices that have vertex `v`. In 2D they turn counter-clockwise
    /// around it, and the first one lies behind the hull edge that starts at `v` if there is one. A
    /// duplicate has none.
    ///
    /// # Panics
    ///
    /// Panics if there is no point `v`.
    pub fn of(&self, v: u32) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        self.simplices[self.starts[v as usize]..self.starts[v as usize + 1]].iter().map(|&t| t as usize)
    }
}

/// Returns the index behind an entry of `neighbors` or `duplicate_of`.
pub(crate) fn index(entry: i32) -> Option<usize> {
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
pub trait Mesh {
    /// Sets what the mesh says of its points.
    fn set_input(&mut self, duplicate_of: Vec<i32>, dimension: u8);

    /// Returns the number of points that are duplicates.
    fn duplicates(&self) -> usize;

    /// Returns the affine dimension of the points.
    fn dimension(&self) -> u8;

    /// Returns the statistics.
    fn stats(&self) -> &Stats;

    /// Returns the statistics, to be changed.
    fn stats_mut(&mut self) -> &mut Stats;
}

/// Implements [`Mesh`], and methods on `duplicate_of`, which both meshes have.
macro_rules! common_methods {
    ($mesh:ident) => {
        impl $crate::mesh::Mesh for $mesh {
            fn set_input(&mut self, duplicate_of: Vec<i32>, dimension: u8) {
                (self.duplicate_of, self.dimension) = (duplicate_of, dimension);
            }

            fn duplicates(&self) -> usize {
                self.duplicate_count()
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
        }

        impl $mesh {
            /// Returns the vertices: the distinct points in ascending order, each by the lowest
            /// index of its coordinates.
            pub fn vertices(&self) -> impl Iterator<Item = u32> + Clone + '_ {
                (0..).zip(&self.duplicate_of).filter(|&(_, &d)| d == $crate::index::NONE).map(|(i, _)| i)
            }

            /// Returns whether an earlier point has the same coordinates as point `i`, which
            /// therefore is not a vertex.
            ///
            /// # Panics
            ///
            /// Panics if there is no point `i`.
            pub fn is_duplicate(&self, i: u32) -> bool {
                self.duplicate_of[i as usize] != $crate::index::NONE
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
                self.duplicate_of.iter().filter(|&&d| d != $crate::index::NONE).count()
            }
        }
    };
}
pub(crate) use common_methods;
