//! Where computations run: with the interpreter's lock released, on the threads that were asked for, in a process that
//! may have been forked, until somebody presses Ctrl-C.

use crate::errors::{GpuError, exception};
use gdel::{Backend, Error, Progress, Triangulator};
use pyo3::{exceptions::PyValueError, prelude::*};
use rayon::ThreadPool;
use std::{
    io,
    num::NonZeroUsize,
    ops::ControlFlow,
    sync::{
        Arc, LazyLock, Mutex, PoisonError,
        atomic::{AtomicBool, AtomicU32, Ordering::Relaxed},
        mpsc::{RecvTimeoutError, channel},
    },
    thread,
    time::Duration,
};

/// How long a computation runs between two looks for Ctrl-C.
const PERIOD: Duration = Duration::from_millis(40);

/// Runs of fewer points are over before anybody could interrupt them.
const SHORT: usize = 20_000;

/// Runs of fewer points never look for a GPU by themselves.
const NEVER_ON_GPU: usize = 5_000;

/// Queries between two looks for Ctrl-C.
const PART: usize = 1 << 18;

/// The process that has imported the module.
static IMPORTER: AtomicU32 = AtomicU32::new(0);

/// The process that may have opened the GPU; 0 if none has.
static GPU_USER: AtomicU32 = AtomicU32::new(0);

/// Shares the GPU among all runs.
static SHARED: LazyLock<Triangulator> = LazyLock::new(Triangulator::new);

/// Thread pools with their processes.
static POOLS: Mutex<Vec<(u32, usize, Arc<ThreadPool>)>> = Mutex::new(Vec::new());

/// Notes which process this is.
pub(crate) fn note_process() {
    IMPORTER.store(std::process::id(), Relaxed);
}

/// Notes that the GPU is opened.
///
/// A driver does not work in the child of the process that has opened it.
pub(crate) fn note_gpu(_: Python<'_>) -> PyResult<()> {
    let own = std::process::id();
    match GPU_USER.compare_exchange(0, own, Relaxed, Relaxed) {
        Err(user) if user != own => Err(GpuError::new_err(
            "the GPU cannot be used: this process was forked from one that has used it; start processes by 'spawn' or \
             'forkserver', or use backend=\"cpu\"",
        )),
        _ => Ok(()),
    }
}

/// How a computation runs.
pub(crate) struct Options {
    pub(crate) backend: Backend,
    pub(crate) threads: Option<usize>,
    pub(crate) progress: Option<Py<PyAny>>,
}

impl Options {
    /// Checks the options.
    pub(crate) fn new(backend: &str, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<Self> {
        let backend = match backend {
            "auto" => Backend::Auto,
            "cpu" => Backend::Cpu,
            "gpu" => Backend::Gpu,
            _ => return Err(PyValueError::new_err(format!("backend must be 'auto', 'cpu' or 'gpu', not {backend:?}"))),
        };
        if threads == Some(0) {
            return Err(PyValueError::new_err("threads must be at least 1"));
        }
        Ok(Options { backend, threads, progress })
    }

    /// Returns a triangulator for so many points.
    fn triangulator(&self, py: Python<'_>, points: usize) -> PyResult<Triangulator> {
        let may_use_gpu = match self.backend {
            Backend::Cpu => false,
            Backend::Auto => points >= NEVER_ON_GPU,
            _ => true,
        };
        let usable = if may_use_gpu { note_gpu(py) } else { Ok(()) };
        match (usable, self.backend) {
            (Err(error), Backend::Gpu) => Err(error),
            (Ok(()), Backend::Auto | Backend::Gpu) if may_use_gpu => Ok(SHARED.clone().backend(self.backend)),
            // Not the shared one, whose locks another thread of the parent may have held.
            _ => Ok(Triangulator::new().backend(Backend::Cpu)),
        }
    }
}

/// Returns the pool that work with so many threads runs in; `None` for that of the process.
fn pool(threads: Option<usize>) -> Result<Option<Arc<ThreadPool>>, Error> {
    let own = std::process::id();
    // A child has not inherited the threads of its parent's pool.
    if threads.is_none() && IMPORTER.load(Relaxed) == own {
        return Ok(None);
    }
    let number = threads.or_else(|| thread::available_parallelism().ok().map(NonZeroUsize::get)).unwrap_or(1);
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((.., pool)) = pools.iter().find(|&&(process, size, _)| (process, size) == (own, number)) {
        return Ok(Some(pool.clone()));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(number).stack_size(STACK).build();
    let pool = Arc::new(pool.map_err(|error| Error::Threads { threads: number, reason: error.to_string() })?);
    pools.push((own, number, pool.clone()));
    Ok(Some(pool))
}

/// Runs work with so many threads, with the lock released.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    work: impl FnOnce() -> Result<T, Error> + Send,
) -> PyResult<T> {
    let result = py.detach(|| in_pool(threads, work));
    py.check_signals()?;
    result.map_err(exception)
}

fn in_pool<T: Send>(threads: Option<usize>, work: impl FnOnce() -> Result<T, Error> + Send) -> Result<T, Error> {
    match pool(threads)? {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Answers queries part by part, with `missing` for those that are not finite.
pub(crate) fn answer<const D: usize, R: Copy + Send + Sync>(
    py: Python<'_>,
    threads: Option<usize>,
    queries: gdel::Points<'_, D>,
    missing: R,
    work: impl Fn(gdel::Points<'_, D>) -> Result<Vec<R>, Error> + Send + Sync,
) -> PyResult<Vec<R>> {
    if queries.len() <= PART {
        return run(py, threads, || finite(queries, missing, &work));
    }
    let mut answers = Vec::with_capacity(queries.len());
    for start in (0..queries.len()).step_by(PART) {
        let range = start..(start + PART).min(queries.len());
        let part = match queries {
            gdel::Points::F32(queries) => gdel::Points::F32(&queries[range]),
            gdel::Points::F64(queries) => gdel::Points::F64(&queries[range]),
        };
        answers.extend(run(py, threads, || finite(part, missing, &work))?);
    }
    Ok(answers)
}

/// Answers the queries that are finite.
fn finite<const D: usize, R: Copy>(
    queries: gdel::Points<'_, D>,
    missing: R,
    work: impl Fn(gdel::Points<'_, D>) -> Result<Vec<R>, Error>,
) -> Result<Vec<R>, Error> {
    if queries.validate().is_ok() {
        return work(queries);
    }
    let is_finite = |query: &[f64; D]| query.iter().all(|x| x.is_finite());
    let kept: Vec<[f64; D]> = queries.iter().filter(is_finite).collect();
    let mut found = work(gdel::Points::from_interleaved_f64(kept.as_flattened())?)?.into_iter();
    let answer = |query: [f64; D]| if is_finite(&query) { found.next() } else { None };
    Ok(queries.iter().map(answer).map(|found| found.unwrap_or(missing)).collect())
}

/// What a run and who waits for it tell each other.
#[derive(Default)]
struct Shared {
    is_cancelled: AtomicBool,
    progress: Mutex<Option<Progress>>,
}

/// What reports progress and can be cancelled.
pub(crate) trait Reporting: Sync + Sized {
    /// Sets what is called during runs, as [`Triangulator::on_progress`] does.
    fn reporting_to(self, on_progress: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static) -> Self;
}

impl Reporting for Triangulator {
    fn reporting_to(self, on_progress: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static) -> Self {
        self.on_progress(on_progress)
    }
}

/// Runs a triangulation of so many points.
pub(crate) fn triangulate<T: Send>(
    py: Python<'_>,
    options: &Options,
    points: usize,
    work: impl FnOnce(&Triangulator) -> Result<T, Error> + Send,
) -> PyResult<T> {
    triangulate_by(py, options, options.triangulator(py, points)?, points, work)
}

/// As much as the main thread has: where little is optimised, runs on the GPU need more than other threads have.
const STACK: usize = 8 << 20;

/// Runs a triangulation of so many points by what the caller has chosen. A long one runs in a thread of its own, while
/// this one looks for Ctrl-C and reports progress.
pub(crate) fn triangulate_by<B: Reporting, T: Send>(
    py: Python<'_>,
    options: &Options,
    triangulator: B,
    points: usize,
    work: impl FnOnce(&B) -> Result<T, Error> + Send,
) -> PyResult<T> {
    if points < SHORT && options.progress.is_none() {
        return run(py, options.threads, || work(&triangulator));
    }
    let shared = Arc::new(Shared::default());
    let of_run = shared.clone();
    let triangulator = triangulator.reporting_to(move |progress| {
        *of_run.progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress);
        if of_run.is_cancelled.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let ran = py.detach(|| {
        thread::scope(|scope| {
            let (end, ended) = channel::<()>();
            let (threads, triangulator) = (options.threads, &triangulator);
            let run = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, move || {
                // Is dropped when the work ends, also by a panic.
                let _end = end;
                in_pool(threads, || work(triangulator))
            })?;
            let mut interruption = None;
            while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(PERIOD) {
                if interruption.is_none() {
                    interruption = Python::attach(|py| report(py, options, &shared)).err();
                    shared.is_cancelled.store(interruption.is_some(), Relaxed);
                }
            }
            io::Result::Ok((run.join(), interruption))
        })
    });
    let (result, interruption) = ran?;
    if let Some(interruption) = interruption {
        return Err(interruption);
    }
    let result = result.unwrap_or_else(|panic| std::panic::resume_unwind(panic)).map_err(exception)?;
    if let Some(progress) = &options.progress {
        progress.call1(py, ("done", 1.0))?;
    }
    Ok(result)
}

/// Looks for Ctrl-C, and tells the caller how far the run is.
fn report(py: Python<'_>, options: &Options, shared: &Shared) -> PyResult<()> {
    py.check_signals()?;
    let progress = shared.progress.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let (Some(callback), Some(Progress { phase, fraction, .. })) = (&options.progress, progress) {
        callback.call1(py, (phase.name(), fraction))?;
    }
    Ok(())
}
