//! The faces of an alpha complex that belong to nothing larger in it.

use super::{AlphaComplex, AlphaEdges, FaceClass};
use crate::geometry::Euclidean;

/// What differs between the dimensions in singular faces.
#[doc(hidden)]
pub trait SingularEdges<const D: usize, const N: usize>: AlphaEdges<D, N> {
    /// Returns the edges that are part of a complex, but no face of a larger one that is. In 2D they are facets.
    fn singular_edges(complex: &AlphaComplex<'_, D, N>) -> Vec<[u32; 2]>;
}

impl SingularEdges<2, 3> for Euclidean {
    fn singular_edges(complex: &AlphaComplex<'_, 2, 3>) -> Vec<[u32; 2]> {
        singular(complex.facets())
    }
}

impl SingularEdges<3, 4> for Euclidean {
    fn singular_edges(complex: &AlphaComplex<'_, 3, 4>) -> Vec<[u32; 2]> {
        singular(complex.edges())
    }
}

/// Returns those of some faces that are singular.
pub fn singular<F>(faces: impl Iterator<Item = (F, FaceClass)>) -> Vec<F> {
    faces.filter(|(_, class)| *class == FaceClass::Singular).map(|(face, _)| face).collect()
}
