//! The device that clones of a triangulator share, with what is compiled for it, and when
//! [`Backend::Auto`](crate::Backend::Auto) takes it.

use super::crossing::Crossing;
use crate::{
    cpu,
    dimension::Dimension,
    error::Error,
    gpu::{
        AdapterChoice, Gpu,
        device_mesh::MeshArrays,
        engine::{Complete, GpuEngine},
        phase1::Finish,
        self_test::UNIFORM,
    },
    input::points::Points,
    options::Options,
    platform::{
        Instant,
        gpu::{OPENING, PRIORS, Task},
        records,
    },
    stats::Fallback,
};
use std::sync::{
    Arc, Mutex, MutexGuard, PoisonError,
    atomic::{AtomicUsize, Ordering},
};

/// The device, and what is compiled for it.
#[derive(Debug, Default)]
pub struct State {
    pub(super) d3: Slot<3>,
    /// On the same device.
    pub(super) d2: Slot<2>,
    /// The device that was opened here, while it is open.
    pub(super) opened: Option<Gpu>,
    /// The caller's device, which [`Backend::Auto`] may take though it is software, and which is
    /// not destroyed here.
    pub(super) caller_supplied: Option<Gpu>,
    /// Why [`Backend::Auto`] does not try to open a device again.
    pub(super) unusable: Option<Fallback>,
    /// What the device has computed wrongly, if anything: it is not used until it is opened again.
    pub(super) wrong: Option<Error>,
}

/// A GPU engine whose kernels are being compiled.
#[derive(Debug)]
struct Opening<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    began: Instant,
    task: Task<Result<Opened<D>, Error>>,
}

/// A GPU engine, and what was found out while it was opened.
#[derive(Debug)]
struct Opened<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    engine: GpuEngine<D>,
    /// If the device was tested, and passed: how many milliseconds [`FEW`] points take the CPU engine, and the device.
    tested: Option<[f64; 2]>,
}

impl<const D: usize> Opened<D>
where
    Dimension<D>: Choice<D>,
{
    /// Compiles the kernels, and tests the device if it `is_new`. Runs of the CPU engine that come between are counted
    /// by `cpu_runs`.
    async fn new(gpu: Gpu, is_new: bool, cpu_runs: Arc<AtomicUsize>) -> Result<Self, Error> {
        let mut engine = GpuEngine::new(gpu).await?;
        if !is_new {
            return Ok(Opened { engine, tested: None });
        }
        engine.self_test().await?;
        let points = UNIFORM.points::<D>();
        let (points, options) = (Points::F64(&points[..FEW]), Options::default());
        let mut least = [f64::INFINITY; 2];
        // The first run takes fresh memory. One that shares its thread with another engine says nothing.
        let mut alone = 0;
        for _ in 0..MAX_TRIES {
            let began = Instant::now();
            cpu::delaunay(points, &options)?;
            least[0] = least[0].min(millis(began));
            let before = cpu_runs.load(Ordering::Relaxed);
            let began = Instant::now();
            engine.triangulate(points, &options).await?;
            if cpu_runs.load(Ordering::Relaxed) != before {
                continue;
            }
            least[1] = least[1].min(millis(began));
            alone += 1;
            if alone == 2 {
                break;
            }
        }
        Ok(Opened { engine, tested: Some(least) })
    }
}

/// The number of points by which both engines are measured: so few that nobody has to wait for them.
const FEW: usize = 8_000;

/// How often they are measured, at most.
const MAX_TRIES: usize = 4;

impl<const D: usize> Opening<D>
where
    Dimension<D>: Choice<D>,
{
    /// Estimates how long it still takes, if it takes so many milliseconds in all.
    fn milliseconds_left(&mut self, in_all: f64) -> f64 {
        let passed = millis(self.began);
        // What takes longer than the last time is not expected to end at once.
        if self.task.is_done() { 0.0 } else { (in_all - passed).max(passed / 4.0) }
    }
}

#[derive(Debug)]
pub struct Slot<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    /// The GPU engine, while it is open.
    pub(super) engine: Option<GpuEngine<D>>,
    /// What opens it, and since when, while that is going on beside other work.
    opening: Option<Opening<D>>,
    /// The milliseconds that runs so far would have been faster with it.
    lost: f64,
}

impl<const D: usize> Default for Slot<D>
where
    Dimension<D>: Finish<D>,
{
    fn default() -> Self {
        Slot { engine: None, opening: None, lost: 0.0 }
    }
}

/// What is known of an input before it is triangulated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Input {
    pub(super) points: usize,
    /// The number of threads of the CPU engine, if it was set.
    pub(super) threads: Option<usize>,
}

/// Returns the milliseconds since an instant.
pub(super) fn millis(since: Instant) -> f64 {
    1e3 * (Instant::now() - since).as_secs_f64()
}

/// What opens the device, and what is known of it.
#[derive(Debug, Default)]
pub(super) struct Setup {
    pub(super) adapter: AdapterChoice,
    pub(super) known: Known,
    /// Whether the CPU engine makes meshes while kernels are compiled.
    pub(super) compiles_meanwhile: bool,
    /// Whether devices are tested before they are used, if that was set.
    pub(super) self_test: Mutex<Option<bool>>,
    /// How many meshes the CPU engine has made.
    pub(super) cpu_runs: Arc<AtomicUsize>,
}

impl Setup {
    /// Creates the setup for another adapter, in place of this one.
    pub(super) fn with_adapter(&self, adapter: AdapterChoice) -> Self {
        Setup { adapter, self_test: Mutex::new(*self.self_test()), ..Setup::default() }
    }

    /// Sets whether devices are tested.
    pub(super) fn set_self_test(&self, self_test: bool) {
        *self.self_test() = Some(self_test);
    }

    fn self_test(&self) -> MutexGuard<'_, Option<bool>> {
        self.self_test.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns whether a device is tested. Software computes rightly, as tests of this crate show, and slowly.
    fn tests(&self, is_software: bool) -> bool {
        self.self_test().unwrap_or(!is_software)
    }
}

/// What is known of the speed of both engines.
#[derive(Debug)]
pub struct Known {
    d3: Mutex<Crossing>,
    d2: Mutex<Crossing>,
}

impl Default for Known {
    fn default() -> Self {
        let [d3, d2] = std::array::from_fn(|i| Mutex::new(Crossing::new(PRIORS[i], OPENING[i])));
        Known { d3, d2 }
    }
}

impl Known {
    /// Sets whether what runs take is noted.
    pub(super) fn set_learning(&self, learns: bool) {
        self.of::<3>().learns = learns;
        self.of::<2>().learns = learns;
    }

    /// Returns what is known of a dimension.
    pub(super) fn of<const D: usize>(&self) -> MutexGuard<'_, Crossing>
    where
        Dimension<D>: Choice<D>,
    {
        Dimension::<D>::crossing(self).lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What [`Backend::Auto`] has to know of a dimension.
pub trait Choice<const D: usize>: Complete<D> + MeshArrays<D>
where
    Dimension<D>: Complete<D>,
{
    fn slot(state: &mut State) -> &mut Slot<D>;
    fn crossing(known: &Known) -> &Mutex<Crossing>;
}

impl Choice<3> for Dimension<3> {
    fn slot(state: &mut State) -> &mut Slot<3> {
        &mut state.d3
    }

    fn crossing(known: &Known) -> &Mutex<Crossing> {
        &known.d3
    }
}

impl Choice<2> for Dimension<2> {
    fn slot(state: &mut State) -> &mut Slot<2> {
        &mut state.d2
    }

    fn crossing(known: &Known) -> &Mutex<Crossing> {
        &known.d2
    }
}

impl State {
    /// Returns the GPU engine, opened if it is not.
    pub(super) async fn open<const D: usize>(&mut self, setup: &Setup) -> Result<&mut GpuEngine<D>, Error>
    where
        Dimension<D>: Choice<D>,
    {
        self.begin_opening::<D>(setup).await?;
        let slot = Dimension::<D>::slot(self);
        if let Some(Opening { task, began }) = slot.opening.take() {
            let opened = task.result().await;
            self.note_failure::<D, _>(setup, &opened);
            let Opened { mut engine, tested } = opened?;
            let mut known = setup.known.of::<D>();
            match tested {
                Some([cpu, gpu]) => {
                    known.note_cpu(FEW, cpu);
                    known.note_gpu(FEW, gpu);
                    known.prove();
                }
                // A test takes longer than compiling later.
                None => known.note_compiling(millis(began)),
            }
            if setup.compiles_meanwhile {
                engine.compile_meanwhile();
            }
            Dimension::<D>::slot(self).engine = Some(engine);
        }
        Dimension::<D>::slot(self)
            .engine
            .as_mut()
            .ok_or_else(|| Error::NoAdapter { reason: "it is not open".to_owned() })
    }

    /// Returns the device, opened if it is not.
    pub(super) async fn device(&mut self, adapter: &AdapterChoice) -> Result<Gpu, Error> {
        match self.opened.as_ref().or(self.caller_supplied.as_ref()) {
            Some(gpu) => Ok(gpu.clone()),
            None => Ok(self.opened.insert(Gpu::open(adapter).await?).clone()),
        }
    }

    /// Forgets the device that was opened, what was compiled, and what was wrong.
    pub(super) fn close(&mut self) {
        self.wrong = None;
        self.opened = None;
        self.d3 = Slot::default();
        self.d2 = Slot::default();
    }

    /// Says why the CPU engine is to make the mesh of this input, as far as that is known without a device.
    pub(super) fn why_cpu<const D: usize>(&mut self, setup: &Setup, input: Input) -> Option<Fallback>
    where
        Dimension<D>: Choice<D>,
    {
        if self.unusable.is_some() {
            return self.unusable.clone();
        }
        if let Some(error) = &self.wrong {
            return Some(Fallback::GpuFailed(error.clone()));
        }
        if let Some(Err(why)) = self.opened.as_ref().map(|gpu| self.check_usable(gpu)) {
            return Some(why);
        }
        let Input { points, threads } = input;
        let known = setup.known.of::<D>();
        let [cpu, gpu] = known.estimates(points, threads);
        if cpu <= gpu {
            return Some(Fallback::FewPoints { points, least: known.least(threads) });
        }
        let is_callers = self.caller_supplied.is_some();
        let slot = Dimension::<D>::slot(self);
        let gain = cpu - gpu;
        // Waiting for it never costs more than was lost by not having waited.
        let most = known.compiling() - slot.lost;
        let left = match &mut slot.opening {
            _ if slot.engine.is_some() => 0.0,
            // It hardly goes on while the CPU engine keeps its thread busy.
            Some(opening) => opening.milliseconds_left(known.compiling()).min(most),
            None if is_callers || setup.compiles_meanwhile => 0.0,
            None => most,
        };
        if gain >= left {
            return None;
        }
        slot.lost += gain;
        Some(Fallback::Compiling { points })
    }

    /// Opens the GPU engine if it is to make the mesh of this input, or says why the CPU engine is.
    pub(super) async fn open_if_it_pays<const D: usize>(&mut self, setup: &Setup, input: Input) -> Result<(), Fallback>
    where
        Dimension<D>: Choice<D>,
    {
        if let Some(why) = self.why_cpu::<D>(setup, input) {
            return Err(why);
        }
        let opened = async {
            let gpu = self.device(&setup.adapter).await.map_err(Fallback::NoGpu)?;
            self.check_usable(&gpu)?;
            self.open::<D>(setup).await.map(drop).map_err(Fallback::NoGpu)
        };
        opened.await.map_err(|why| {
            self.opened = None;
            self.unusable.insert(why).clone()
        })
    }

    /// Opens the device, unless it is open, and has it compile the kernels beside other work.
    pub(super) async fn begin_opening<const D: usize>(&mut self, setup: &Setup) -> Result<(), Error>
    where
        Dimension<D>: Choice<D>,
    {
        if let Some(error) = &self.wrong {
            return Err(error.clone());
        }
        let slot = Dimension::<D>::slot(self);
        if slot.engine.is_none() && slot.opening.is_none() {
            let began = Instant::now();
            let gpu = self.device(&setup.adapter).await?;
            if let Some(name) = records::name(gpu.adapter(), D) {
                setup.known.of::<D>().recall(name);
            }
            let is_new = setup.tests(gpu.adapter().software) && !setup.known.of::<D>().is_proven();
            let task = Task::begin(Opened::new(gpu, is_new, Arc::clone(&setup.cpu_runs))).await;
            Dimension::<D>::slot(self).opening = Some(Opening { began, task });
        }
        Ok(())
    }

    /// Forgets the device if `result` says that it is lost, so that the next run opens another; or that it computes wrong
    /// results, so that it is not used again.
    pub(super) fn note_failure<const D: usize, T>(&mut self, setup: &Setup, result: &Result<T, Error>)
    where
        Dimension<D>: Choice<D>,
    {
        self.forget_if_lost(result);
        if let Err(error @ Error::WrongResults { .. }) = result {
            self.close();
            self.wrong = Some(error.clone());
            setup.known.of::<D>().note_wrong();
        }
    }

    /// Forgets the device if `result` says that it is lost: the next run opens another.
    pub(super) fn forget_if_lost<T>(&mut self, result: &Result<T, Error>) {
        if matches!(result, Err(Error::DeviceLost { .. })) {
            self.close();
            self.caller_supplied = None;
        }
    }

    /// Says why [`Backend::Auto`](crate::Backend::Auto) cannot use this device: an adapter that is software is of no use
    /// to it, unless the caller supplied it.
    fn check_usable(&self, gpu: &Gpu) -> Result<(), Fallback> {
        match gpu.adapter().software && self.caller_supplied.is_none() {
            true => Err(Fallback::SoftwareGpu(gpu.adapter().name.clone())),
            false => Ok(()),
        }
    }
}
