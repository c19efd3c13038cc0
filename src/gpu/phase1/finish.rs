//! The end of Phase 1: the mesh without gaps, what is open about it, and the one large readback.

use std::fmt::Debug;

use bytemuck::Pod;

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Binding, Compiler, Gpu, Kernel, Pending, Readback, Recorder, Storage,
        dim::{Corners, Dim},
        layout::Counters,
        phase1::buffers::Buffers,
        primitives::scan::{BoundScan, Scan, ScanParams},
    },
    input::lattice::Width,
};

/// A step of the end of Phase 1, with its kernel in the form `K`.
#[derive(Debug, Clone, Copy)]
pub enum Step<K> {
    /// Times the steps from here on under this name.
    Stage(&'static str),
    /// Runs a kernel.
    Kernel(K),
    /// Numbers the simplices of the mesh by a scan of [`Buffers::marks`].
    Scan,
}

impl<K> Step<K> {
    fn map<L>(&self, kernel: impl FnOnce(&K) -> L) -> Step<L> {
        match self {
            Step::Stage(name) => Step::Stage(name),
            Step::Kernel(k) => Step::Kernel(kernel(k)),
            Step::Scan => Step::Scan,
        }
    }
}

/// How Phase 1 ends in `D` dimensions.
#[expect(async_fn_in_trait, reason = "only this crate implements it, and no caller is generic over threads")]
pub trait Finish<const D: usize>: Dim<D>
where
    Dimension<D>: Dim<D>,
{
    /// The names of the buffers of the rounds that the end writes over.
    type Aliases: Aliases<D>;
    /// The readbacks beside those of the simplices and their neighbours.
    type Reading;
    /// The mesh, and what is to be repaired or checked of it.
    type Result: Debug + Clone + PartialEq;
    /// The kernels that make the arrays of the caller's mesh.
    type Outputs: Debug;
    /// The memory of the host that a run leaves to the next one.
    type Host: Debug + Default + Send;

    /// The steps, with the names of the kernels.
    const STEPS: &'static [Step<&'static str>];
    /// The steps that gather parts of the mesh.
    const GATHER: &'static [Step<&'static str>];
    /// The steps that write changed parts back.
    const PATCH: &'static [Step<&'static str>];

    /// Creates the kernels that make the arrays of the caller's mesh.
    fn outputs(compiler: &Compiler<'_>) -> Self::Outputs;

    /// Returns the number of simplices that the mesh has, of which `finite` are finite.
    fn mesh_len(finite: usize, counters: &Counters) -> usize;

    /// Records the readbacks of all but the simplices and their neighbours.
    fn copy(copies: &mut Copies<'_>, b: &Buffers<D>, aliases: &Self::Aliases, counters: &Counters) -> Self::Reading;

    /// Receives these readbacks and returns the result with the simplices, of which `finite` are finite, and
    /// their neighbours.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    async fn receive(
        copied: &mut Copied<'_>,
        reading: Self::Reading,
        arrays: [Vec<Corners<D>>; 2],
        finite: usize,
    ) -> Result<Self::Result, Error>;
}

/// Buffers of the rounds under the names that they have at the end.
pub trait Aliases<const D: usize>: Debug
where
    Dimension<D>: Dim<D>,
{
    /// Returns the second lives of these buffers.
    fn new(b: &Buffers<D>) -> Self;

    /// Returns the simplices of the mesh, and their neighbours.
    fn arrays(&self) -> [Storage<Corners<D>>; 2];

    /// Returns the buffers under the names that they have in shaders.
    fn bindings(&self) -> Vec<Binding<'_>>;
}

/// Records readbacks in one submission.
pub struct Copies<'a> {
    pub(crate) readback: &'a mut Readback,
    pub(crate) gpu: &'a Gpu,
    pub(crate) recorder: Recorder<'a>,
}

impl Copies<'_> {
    /// Records the readback of the first `len` elements of `source`.
    pub fn copy<T: Pod>(&mut self, source: &Storage<T>, len: usize) -> Pending<T> {
        self.copy_from(source, 0, len)
    }

    /// Records the readback of `len` elements of `source`, from element `start`.
    pub(crate) fn copy_from<T: Pod>(&mut self, source: &Storage<T>, start: usize, len: usize) -> Pending<T> {
        self.readback.copy(self.gpu, self.recorder.encoder(), source, start, len)
    }
}

/// Receives the readbacks of one submission.
pub struct Copied<'a> {
    pub(crate) readback: &'a mut Readback,
    pub(crate) gpu: &'a Gpu,
    pub(crate) submission: wgpu::SubmissionIndex,
}

impl Copied<'_> {
    /// Waits for a readback.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    pub fn receive<T: Pod>(&mut self, pending: Pending<T>) -> impl Future<Output = Result<Vec<T>, Error>> {
        self.readback.receive(self.gpu, &self.submission, pending)
    }

    /// Waits for a readback, as [`Readback::receive_into`] does.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn receive_into<T: Pod>(
        &mut self,
        pending: Pending<T>,
        list: Vec<T>,
    ) -> impl Future<Output = Result<Vec<T>, Error>> {
        self.readback.receive_into(self.gpu, &self.submission, pending, list)
    }
}

/// The kernels of the end of Phase 1.
#[derive(Debug)]
pub(crate) struct FinishStage {
    steps: Vec<Step<Kernel>>,
    gather: Vec<Step<Kernel>>,
    patch: Vec<Step<Kernel>>,
    scan: Scan,
}

/// The kernels with their bind groups.
#[derive(Debug)]
pub(crate) struct BoundFinish<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    /// The end of Phase 1.
    pub(crate) steps: BoundSteps,
    /// Gathers what is wanted.
    pub(crate) gather: BoundSteps,
    /// Writes changed parts back.
    pub(crate) patch: BoundSteps,
    scan: BoundScan,
    aliases: <Dimension<D> as Finish<D>>::Aliases,
}

/// Steps with their bind groups.
pub(crate) type BoundSteps = Vec<Step<(Kernel, wgpu::BindGroup)>>;

impl FinishStage {
    /// Creates the kernels.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width) -> Self
    where
        Dimension<D>: Finish<D>,
    {
        let kernel = |name: &&str| compiler.kernel(Dimension::<D>::SHADERS.get(name), width);
        let kernels = |steps: &[Step<&str>]| steps.iter().map(|step| step.map(kernel)).collect();
        FinishStage {
            steps: kernels(Dimension::<D>::STEPS),
            gather: kernels(Dimension::<D>::GATHER),
            patch: kernels(Dimension::<D>::PATCH),
            scan: Scan::new(compiler),
        }
    }

    /// Binds the kernels to these buffers.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub(crate) fn bind<const D: usize>(&self, gpu: &Gpu, b: &Buffers<D>) -> Result<BoundFinish<D>, Error>
    where
        Dimension<D>: Finish<D>,
    {
        let count = ScanParams { count: b.simplices.len() as u32 };
        let params = Storage::with_contents(gpu, "scan parameters", &[count])?;
        let scan = self.scan.bind(gpu, &params, &b.marks, &b.numbers)?;
        let aliases = <Dimension<D> as Finish<D>>::Aliases::new(b);
        let mut buffers = b.bindings();
        buffers.extend(aliases.bindings());
        buffers.push(("sums", scan.sums().buffer()));
        let bind = |kernel: &Kernel| (kernel.clone(), kernel.bind(gpu, &buffers));
        let bind = |steps: &[Step<Kernel>]| steps.iter().map(|step| step.map(bind)).collect();
        let [steps, gather, patch] = [&self.steps, &self.gather, &self.patch].map(|steps| bind(steps));
        Ok(BoundFinish { steps, gather, patch, scan, aliases })
    }

    /// Records these steps of `bound`.
    pub(crate) fn record<const D: usize>(
        &self,
        recorder: &mut Recorder<'_>,
        bound: &BoundFinish<D>,
        steps: &BoundSteps,
        workgroups: u32,
    ) where
        Dimension<D>: Finish<D>,
    {
        for step in steps {
            match step {
                Step::Stage(name) => recorder.stage(name),
                Step::Kernel((kernel, bindings)) => recorder.dispatch(kernel, bindings, workgroups),
                Step::Scan => self.scan.record(recorder, &bound.scan),
            }
        }
    }
}

impl<const D: usize> BoundFinish<D>
where
    Dimension<D>: Finish<D>,
{
    /// How often [`BoundFinish::read`] waits while the device has nothing to do: for the last submission.
    pub(crate) const STALLS: usize = 1;

    /// Returns the sums of the scan; their entry [`GROUPS`](crate::gpu::primitives::scan::GROUPS)
    /// is the number of finite simplices.
    pub(crate) fn sums(&self) -> &Storage<u32> {
        self.scan.sums()
    }

    /// Returns the names that buffers have at the end.
    pub(crate) fn aliases(&self) -> &<Dimension<D> as Finish<D>>::Aliases {
        &self.aliases
    }

    /// Reads the mesh back, of which `finite` simplices are finite. There are `rooms` for the simplices and
    /// for their neighbours. Returns the number of submissions as well.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`] and [`Readback::receive`].
    pub(crate) async fn read(
        &self,
        gpu: &Gpu,
        readback: &mut Readback,
        b: &Buffers<D>,
        finite: usize,
        counters: &Counters,
        rooms: [Vec<Corners<D>>; 2],
    ) -> Result<(<Dimension<D> as Finish<D>>::Result, usize), Error> {
        let len = Dimension::<D>::mesh_len(finite, counters);
        let (submission, reading) = gpu
            .with_error_scope("the result of Phase 1", || {
                let mut copies = Copies { readback, gpu, recorder: Recorder::new(gpu, None) };
                let reading = Dimension::<D>::copy(&mut copies, b, &self.aliases, counters);
                Ok((copies.recorder.submit(gpu), reading))
            })
            .await?;
        let before = readback.count();
        let arrays = readback.read_arrays(gpu, &self.aliases.arrays(), rooms, len).await?;
        let submissions = 1 + readback.count() - before;
        let mut copied = Copied { readback, gpu, submission };
        let result = Dimension::<D>::receive(&mut copied, reading, arrays, finite).await?;
        Ok((result, submissions))
    }
}
