//! The simplices that two meshes on the device have in common.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{Compiler, Recorder, Storage, device_mesh::DeviceMesh, dim::Dim},
    input::lattice::Width,
};

impl<const D: usize> DeviceMesh<D>
where
    Dimension<D>: Dim<D>,
{
    /// Finds for each simplex the one of another mesh that has the same vertices, in any order. Returns a buffer of one
    /// `i32` per simplex, −1 where there is none, with the usages of those of the mesh. Blocks the thread.
    ///
    /// `before` is the buffer of the [`simplices`](Self::simplices) of the other mesh, such as this one before an
    /// [update](crate::Triangulator::update), on the same device.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::Triangulator;
    ///
    /// let triangulator = Triangulator::new();
    /// let mut points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [1.0, 2.0f64]];
    /// if let Ok(mut mesh) = triangulator.device().and_then(|device| device.delaunay2d(&points)) {
    ///     let before = mesh.simplices().clone();
    ///     points[4] = [2.0, 1.0];
    ///     triangulator.update(&mut mesh, &points)?;
    ///     // One word per triangle, each of which was there before.
    ///     assert_eq!(mesh.survivors(&before)?.size(), 16);
    /// }
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`], [`Error::Gpu`] for a buffer of another device, and the other errors of the
    /// device.
    pub fn survivors(&self, before: &wgpu::Buffer) -> Result<wgpu::Buffer, Error> {
        pollster::block_on(self.survivors_async(before))
    }

    /// Does the same without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`survivors`](Self::survivors).
    pub async fn survivors_async(&self, before: &wgpu::Buffer) -> Result<wgpu::Buffer, Error> {
        let gpu = self.gpu();
        let compiler = Compiler::keeping(gpu);
        let kernel = |name| compiler.kernel(Dimension::<D>::SHADERS.get(name), Width::Narrow);
        let [put, find] = ["survivors_put", "survivors_find"].map(kernel);
        compiler.finish().await?;

        let corners = size_of::<u32>() * (D + 1);
        let others = usize::try_from(before.size()).unwrap_or(usize::MAX) / corners;
        let body = || {
            let places = Storage::<u32>::new(gpu, "table of simplices", (2 * others).next_power_of_two())?;
            let survivors = Storage::<i32>::for_caller(gpu, "survivors", self.simplex_count())?;
            let of_table = [("places", places.buffer()), ("corners", before)];
            let of_search = [
                ("places", places.buffer()),
                ("corners", self.simplices()),
                ("before", before),
                ("survivors", survivors.buffer()),
            ];
            let mut recorder = Recorder::new(gpu, None);
            recorder.dispatch(&put, &put.bind(&of_table), gpu.workgroups(others));
            if self.simplex_count() > 0 {
                recorder.dispatch(&find, &find.bind(&of_search), gpu.workgroups(self.simplex_count()));
            }
            recorder.submit(gpu);
            Ok(survivors.buffer().clone())
        };
        gpu.with_error_scope("survivors", body).await
    }
}
