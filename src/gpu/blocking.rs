//! The forms of [`DeviceMesh`]'s methods that block the calling thread.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::device_mesh::{DeviceMesh, MeshArrays, Outputs},
};
use pollster::block_on;

impl<const D: usize> DeviceMesh<D>
where
    Dimension<D>: MeshArrays<D>,
{
    /// Does what [`read_vertex_simplex_async`](Self::read_vertex_simplex_async) does, and blocks the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of `read`.
    pub fn read_vertex_simplex(&self) -> Result<Vec<u32>, Error> {
        block_on(self.read_vertex_simplex_async())
    }
}

macro_rules! reading {
    ($D:literal, $mesh:ident) => {
        impl DeviceMesh<$D> {
            /// Does what [`read_async`](Self::read_async) does, and blocks the thread.
            ///
            /// # Errors
            ///
            /// Returns [`Error::DeviceLost`], for a device of the caller's [`Error::Gpu`], and
            /// [`Error::OutOfMemory`].
            pub fn read(&self, outputs: Outputs) -> Result<crate::$mesh, Error> {
                block_on(self.read_async(outputs))
            }

            /// Does what [`read_into_async`](Self::read_into_async) does, and blocks the thread.
            ///
            /// # Errors
            ///
            /// Returns the errors of `read`.
            pub fn read_into(&self, outputs: Outputs, mesh: &mut crate::$mesh) -> Result<(), Error> {
                block_on(self.read_into_async(outputs, mesh))
            }
        }
    };
}
reading!(3, Mesh3);
reading!(2, Mesh2);
