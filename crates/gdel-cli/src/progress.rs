//! A progress bar for what takes longer than a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::{
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, RecvTimeoutError, Sender},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

/// The delay before the bar is shown.
const PATIENCE: Duration = Duration::from_secs(1);
const REFRESH: Duration = Duration::from_millis(100);
/// Steps of the bar.
const STEPS: u64 = 1000;

/// The state of the bar.
#[derive(Clone, Copy)]
struct State {
    what: &'static str,
    /// `None` where it is not known.
    fraction: Option<f64>,
}

/// Shows on stderr what is being done, from a second after its creation until it is dropped; shows
/// nothing where stderr is not a terminal.
pub(super) struct Progress {
    state: Arc<Mutex<State>>,
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Progress {
    pub(super) fn new(what: &'static str) -> Self {
        let state = Arc::new(Mutex::new(State { what, fraction: None }));
        let (stop, stopped) = mpsc::channel();
        let shown = Arc::clone(&state);
        let thread = thread::Builder::new().name("progress".into()).spawn(move || {
            if stopped.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
            let styles = ["{spinner} {msg}", "{msg} {wide_bar} {percent}%, {eta} left"];
            let [spinner, percent] = styles
                .map(|style| ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar()));
            loop {
                let State { what, fraction } = *shown.lock().unwrap_or_else(PoisonError::into_inner);
                bar.set_style(if fraction.is_some() { percent.clone() } else { spinner.clone() });
                bar.set_message(what);
                match fraction {
                    Some(fraction) => bar.set_position((fraction * STEPS as f64) as u64),
                    None => bar.tick(),
                }
                if stopped.recv_timeout(REFRESH) != Err(RecvTimeoutError::Timeout) {
                    bar.finish_and_clear();
                    return;
                }
            }
        });
        // Without a thread to show it there is no bar, which is no reason to fail.
        Progress { state, stop: Some(stop), thread: thread.ok() }
    }

    /// Returns the function that tells the bar how far the work has come.
    pub(super) fn reporter(&self) -> impl Fn(&'static str, f64) + Send + Sync + 'static {
        let state = Arc::clone(&self.state);
        move |what, fraction| {
            *state.lock().unwrap_or_else(PoisonError::into_inner) = State { what, fraction: Some(fraction) };
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
