//! How the host and a device exchange data natively.

use crate::{
    error::Error,
    platform::{
        sharing::Threads,
        threads::{for_chunks, for_parts, map_mut},
    },
};
use std::{
    cell::RefCell,
    future::{Ready, ready},
    num::NonZero,
    thread::JoinHandle,
    time::{Duration, Instant},
};

/// What an error scope reports.
pub(crate) type Report = Ready<Result<(), Error>>;

/// Returns what `report` yields, which native devices have at once.
pub(crate) fn report(report: impl Future<Output = Result<(), Error>>) -> Report {
    ready(pollster::block_on(report))
}

/// The bytes of a piece of a large array that is read: so many that its submission costs nothing, and so few that copying
/// out of it begins while most pieces are still to come.
pub(crate) const PIECE: u64 = 32 << 20;

/// How many points the rounds insert that are submitted together: the host has the counters of each in no time.
pub(crate) const INSERTED_TOGETHER: u32 = 0;

/// From this size on, threads share a copy.
const SHARED_FROM: usize = 1 << 20;

/// The bytes that a thread writes at a time.
const PART: usize = 1 << 12;

/// How long the host polls before it blocks. Most results of small runs are there by then, and waking up takes up to
/// 0.1 ms.
const SPIN: Duration = Duration::from_micros(300);

/// Waits until the device has carried out `submission`, after which `is_done`, as a rule. A software device needs the
/// processors itself, so the host does not poll it.
///
/// # Errors
///
/// Returns what [`wgpu::Device::poll`] returns.
pub fn wait(
    device: &wgpu::Device,
    is_software: bool,
    submission: &wgpu::SubmissionIndex,
    mut is_done: impl FnMut() -> bool,
) -> Result<(), wgpu::PollError> {
    let began = Instant::now();
    while !is_software && began.elapsed() < SPIN {
        // Not for the submission with a timeout: wgpu 30 panics if it passes while another thread sees the queue empty.
        device.poll(wgpu::PollType::Poll)?;
        if is_done() {
            return Ok(());
        }
        std::hint::spin_loop();
    }
    device.poll(wgpu::PollType::Wait { submission_index: Some(submission.clone()), timeout: None }).map(drop)
}

/// Copies the first bytes of a mapped buffer. Threads share the work where there is much, because fresh memory costs page
/// faults.
pub(crate) fn copy(from: &wgpu::BufferView, to: &mut [u8]) {
    let threads = if to.len() < SHARED_FROM { Threads::One } else { Threads::All };
    for_chunks(threads, to, |at, chunk| chunk.copy_from_slice(&from[at..at + chunk.len()]));
}

/// Writes to a buffer, before the commands of the next submission.
pub(crate) fn write(queue: &wgpu::Queue, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
    if bytes.len() < SHARED_FROM {
        return queue.write_buffer(buffer, offset, bytes);
    }
    // The staging memory is fresh each time, so threads share its page faults. Without a view, the size or the offset is
    // wrong, and the device has reported that.
    let view = NonZero::new(bytes.len() as u64).and_then(|size| queue.write_buffer_with(buffer, offset, size));
    let Some(mut view) = view else { return };
    let (parts, rest) = bytes.as_chunks::<PART>();
    let (targets, mut target_of_rest) = view.slice(..).into_chunks::<PART>();
    target_of_rest.copy_from_slice(rest);
    let mut copies: Vec<_> = targets.into_iter().zip(parts).map(Some).collect();
    for_parts(Threads::All, &mut copies, |_, copies| {
        copies.iter_mut().filter_map(Option::take).for_each(|(target, part)| target.write(*part));
    });
}

/// What the engines take where nothing was measured, in 3D and in 2D: nanoseconds per point of the CPU engine in one thread;
/// milliseconds and nanoseconds per point of the GPU engine. Measured on one NVIDIA H200 and the Xeon beside it
/// (2026-11-24), but for the milliseconds, which are 4 and 8 there: other devices take longer.
pub(crate) const PRIORS: [(f64, [f64; 2]); 2] = [(2000.0, [12.0, 39.0]), (430.0, [12.0, 30.0])];

/// The milliseconds that it takes to open a device and compile the kernels, in 3D and in 2D, in the same place.
pub(crate) const OPENING: [f64; 2] = [260.0, 240.0];

/// Work that is done when it begins: only browsers compile beside other work.
#[derive(Debug)]
pub(crate) struct Task<T>(T);

impl<T> Task<T> {
    /// Does the work.
    pub(crate) async fn begin(work: impl Future<Output = T>) -> Self {
        Task(work.await)
    }

    /// Returns whether the result is there.
    pub(crate) fn is_done(&mut self) -> bool {
        true
    }

    /// Returns the result.
    pub(crate) async fn result(self) -> T {
        self.0
    }
}

/// Calls `compile` for each of the kernels, in all threads.
///
/// # Errors
///
/// Returns the errors of `compile`.
pub(crate) async fn compile<K: Send>(
    mut kernels: Vec<K>,
    compile: impl AsyncFn(&[K]) -> Result<(), Error> + Sync,
) -> Result<(), Error> {
    // Error scopes belong to threads, and report at once.
    let compile = |_, kernel: &mut K| pollster::block_on(compile(std::slice::from_ref(kernel)));
    map_mut(Threads::All, &mut kernels, compile).into_iter().collect()
}

/// Whether [`compile_beside`] does anything.
pub(crate) const COMPILES_BESIDE: bool = true;

/// Lets a thread call `compile`, unless there are no kernels.
pub(crate) fn compile_beside<K: Send + 'static>(
    kernels: Vec<K>,
    compile: impl AsyncFn(&[K]) -> Result<(), Error> + Send + 'static,
) {
    if kernels.is_empty() {
        return;
    }
    // An error here comes up again where a kernel is used, and is reported there. If no thread can be started,
    // kernels are compiled when somebody waits for them.
    let compile = move || _ = pollster::block_on(compile(&kernels));
    if let Ok(thread) = std::thread::Builder::new().name("gdel pipelines".to_owned()).spawn(compile) {
        COMPILING.with_borrow_mut(|Compiling(threads)| {
            threads.retain(|thread| !thread.is_finished());
            threads.push(thread);
        });
    }
}

/// The threads that compile. The thread that has started them waits for them when it ends, which for the main
/// thread is before the process does: a driver that compiles while its library is being unloaded may crash.
struct Compiling(Vec<JoinHandle<()>>);

impl Drop for Compiling {
    fn drop(&mut self) {
        // A panic was reported where it came up.
        self.0.drain(..).for_each(|thread| _ = thread.join());
    }
}

thread_local! {
    static COMPILING: RefCell<Compiling> = const { RefCell::new(Compiling(Vec::new())) };
}
