//! What the WebAssembly bindings need: meshes are taken from where they were made, and points may be in another thread.

use super::{Deliver, SharedDevice, ToDevice, check_count};
use crate::{
    cpu::MeshOf,
    d2::Mesh2,
    d3::Mesh3,
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu,
        device_mesh::{DeviceMesh, DeviceMesh2, DeviceMesh3},
        engine::{Destination, MadeMesh, Outcome},
        host::Host,
    },
    input::points::{Points, Points2, Points3},
    options::Options,
    stats::{Fallback, Phase, Restart, Stats, UpdateStats},
    triangulator::{
        Triangulator,
        shared_device::shared,
        state::{Choice, Input, Setup},
    },
};

/// To a function of the caller's: from where it was made, or from the device.
struct ToCaller<'a, F, R, const D: usize> {
    to_device: Option<ToDevice<'a, D>>,
    take: F,
    result: std::marker::PhantomData<R>,
}

impl<const D: usize, F, R> ToCaller<'_, F, R, D>
where
    Dimension<D>: Choice<D>,
{
    /// Returns the mesh of the points where they were, if they have moved.
    fn moved(&self) -> Option<&DeviceMesh<D>> {
        self.to_device.as_ref()?.moved
    }
}

impl<const D: usize, R, F: AsyncFn(MadeMesh<D>) -> Result<R, Error>> Deliver<D> for ToCaller<'_, F, R, D>
where
    Dimension<D>: Choice<D>,
{
    type Output = R;

    fn destination(&mut self) -> Destination<'_, D> {
        Destination::Device(self.moved())
    }

    async fn deliver(&self, mesh: MadeMesh<D>, gpu: Option<Gpu>) -> Result<R, Error> {
        let mut mesh = match (mesh, &self.to_device) {
            (mesh @ MadeMesh::Host(_), Some(to_device)) => {
                MadeMesh::Device(Box::new(to_device.deliver(mesh, gpu).await?))
            }
            (mesh, _) => mesh,
        };
        if self.moved().is_some() {
            mesh.stats_mut().update.get_or_insert_with(|| UpdateStats::from_scratch(Restart::NotResident));
        }
        (self.take)(mesh).await
    }
}

impl SharedDevice {
    /// Triangulates `points`, and has `take` take the mesh where it was made, or, if `resident`, on
    /// the device; there it goes on from `moved`, the mesh of the points where they were, if there is
    /// one.
    pub(super) async fn deliver<const D: usize, R>(
        &self,
        points: Points<'_, D>,
        options: &Options,
        resident: bool,
        moved: Option<&DeviceMesh<D>>,
        take: impl AsyncFn(MadeMesh<D>) -> Result<R, Error>,
    ) -> Result<R, Error>
    where
        Dimension<D>: Choice<D>,
    {
        check_count(points, moved)?;
        let to_device = resident.then_some(ToDevice { device: self, moved });
        self.run(points, options, &mut ToCaller { to_device, take, result: std::marker::PhantomData }).await
    }

    /// Drives the GPU engine with a host in another thread, from `moved` on if there is such a mesh. Returns the
    /// mesh on the device, or, if the CPU engine has to make it, what was done before.
    pub(super) async fn drive<const D: usize>(
        &self,
        host: &mut impl Host<D>,
        options: &Options,
        moved: Option<&DeviceMesh<D>>,
    ) -> Result<Result<DeviceMesh<D>, Box<Stats>>, Error>
    where
        Dimension<D>: Choice<D>,
    {
        let mut state = self.state.lock().await;
        let engine = state.open::<D>(&self.setup).await?;
        let options = &options.monotone();
        let driven = async {
            Ok(match engine.drive(host, options, Destination::Device(moved)).await? {
                Outcome::Made(made) => {
                    let mut mesh = made.into_device(engine.gpu()).await?;
                    mesh.stats_mut().wrong_meshes = self.setup.known.of::<D>().wrong_meshes();
                    options.report(Phase::Finish, 1.0)?;
                    Ok(mesh)
                }
                Outcome::LeftToCpu(before) => Err(before),
            })
        };
        let result = driven.await;
        state.note_failure::<D, _>(&self.setup, &result);
        result
    }

    /// Opens the device, and compiles the kernels, or begins to.
    async fn open_for<const D: usize>(&self, meanwhile: bool) -> Result<(), Error>
    where
        Dimension<D>: Choice<D>,
    {
        self.check()?;
        let mut state = self.state.lock().await;
        match meanwhile {
            true => state.begin_opening::<D>(&self.setup).await,
            false => state.open::<D>(&self.setup).await.map(drop),
        }
    }

    /// Creates the buffers of a mesh on the device that somebody else fills.
    pub(super) async fn room<const D: usize>(&self, lens: [usize; 2], info: MeshOf<D>) -> Result<DeviceMesh<D>, Error>
    where
        Dimension<D>: Choice<D>,
    {
        let gpu = self.state.lock().await.device(&self.setup.adapter).await?;
        DeviceMesh::with_room(&gpu, lens, info).await
    }
}

impl Triangulator {
    /// Creates a triangulator. If it `compiles_meanwhile`, [`Backend::Auto`](crate::Backend::Auto) has the CPU engine make
    /// meshes while kernels are compiled, if that is sooner.
    #[doc(hidden)]
    pub fn compiling_meanwhile(compiles_meanwhile: bool) -> Self {
        let setup = Setup { compiles_meanwhile, ..Setup::default() };
        let device = shared(SharedDevice { setup, ..SharedDevice::default() });
        Triangulator { options: Options::default(), device }
    }

    /// Returns the least number of points for which the GPU engine is faster.
    #[doc(hidden)]
    pub fn least<const D: usize>(&self) -> usize
    where
        Dimension<D>: Choice<D>,
    {
        self.device.setup.known.of::<D>().least(None)
    }

    /// Returns what is known of the speed of the device, for [`recall`](Self::recall) on a later visit.
    #[doc(hidden)]
    pub fn known<const D: usize>(&self) -> Vec<u32>
    where
        Dimension<D>: Choice<D>,
    {
        self.device.setup.known.of::<D>().to_words()
    }

    /// Takes over what was known on an earlier visit.
    #[doc(hidden)]
    pub fn recall<const D: usize>(&self, known: &[u32])
    where
        Dimension<D>: Choice<D>,
    {
        self.device.setup.known.of::<D>().merge(known);
    }

    /// Says why [`Backend::Auto`](crate::Backend::Auto) has the CPU engine make the mesh of so many points, if it does. A
    /// device that is at work is not asked.
    #[doc(hidden)]
    pub fn why_cpu<const D: usize>(&self, points: usize) -> Option<Fallback>
    where
        Dimension<D>: Choice<D>,
    {
        let mut state = self.device.state.try_lock()?;
        state.why_cpu::<D>(&self.device.setup, Input { points, threads: None })
    }

    /// Opens the device, and compiles the kernels, or, if that goes on `meanwhile`, begins to.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::device`].
    #[doc(hidden)]
    pub async fn open_for<const D: usize>(&self, meanwhile: bool) -> Result<(), Error>
    where
        Dimension<D>: Choice<D>,
    {
        self.device.open_for::<D>(meanwhile).await
    }

    /// Triangulates in 3D, and has `deliver` take the mesh where it was made, or, if `resident`, on
    /// the device: [`Backend::Auto`] takes the CPU if the GPU fails before that is done. A mesh that
    /// is `resident` goes on from `moved`, the mesh of the points where they were, if there is one.
    #[doc(hidden)]
    pub async fn deliver3d<R>(
        &self,
        points: Points3<'_>,
        resident: bool,
        moved: Option<&DeviceMesh3>,
        deliver: impl AsyncFn(MadeMesh<3>) -> Result<R, Error>,
    ) -> Result<R, Error> {
        self.device.deliver(points, &self.options, resident, moved, deliver).await
    }

    /// Does the same in 2D.
    #[doc(hidden)]
    pub async fn deliver2d<R>(
        &self,
        points: Points2<'_>,
        resident: bool,
        moved: Option<&DeviceMesh2>,
        deliver: impl AsyncFn(MadeMesh<2>) -> Result<R, Error>,
    ) -> Result<R, Error> {
        self.device.deliver(points, &self.options, resident, moved, deliver).await
    }

    /// Triangulates in 3D the points that `host` has, in another thread. The mesh goes on from `moved`, and stays on
    /// the device. Returns what was done if the CPU engine has to make it.
    ///
    /// # Errors
    ///
    /// Those of a run on the device, and of `host`.
    #[doc(hidden)]
    pub async fn drive3d(
        &self,
        host: &mut impl Host<3>,
        moved: Option<&DeviceMesh3>,
    ) -> Result<Result<DeviceMesh3, Box<Stats>>, Error> {
        self.device.drive(host, &self.options, moved).await
    }

    /// Does the same in 2D.
    ///
    /// # Errors
    ///
    /// Those of [`drive3d`](Self::drive3d).
    #[doc(hidden)]
    pub async fn drive2d(
        &self,
        host: &mut impl Host<2>,
        moved: Option<&DeviceMesh2>,
    ) -> Result<Result<DeviceMesh2, Box<Stats>>, Error> {
        self.device.drive(host, &self.options, moved).await
    }

    /// Creates the buffers of a 3D mesh of so many tetrahedra and triangles of the hull, which the caller fills.
    /// `info` says the rest.
    ///
    /// # Errors
    ///
    /// Those of a run on the device.
    #[doc(hidden)]
    pub async fn room3d(&self, lens: [usize; 2], info: Mesh3) -> Result<DeviceMesh3, Error> {
        self.device.room(lens, info).await
    }

    /// Does the same in 2D, with triangles and vertices of the hull.
    ///
    /// # Errors
    ///
    /// Those of [`room3d`](Self::room3d).
    #[doc(hidden)]
    pub async fn room2d(&self, lens: [usize; 2], info: Mesh2) -> Result<DeviceMesh2, Error> {
        self.device.room(lens, info).await
    }
}
