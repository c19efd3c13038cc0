//! Splaying in the threads of the pool.
//!
//! It shares its work some twenty times, each time for a fraction of a millisecond. A thread outside of
//! the pool would have to be woken after each of these.

use crate::{d3::splay::Terms, error::Error, parallel};
use std::sync::{
    atomic::{AtomicBool, Ordering::Relaxed},
    mpsc::{Receiver, channel},
};

/// Runs a step of splaying on these terms in a thread of the pool, unless the calling thread is one.
/// The calling thread does `own` meanwhile, which gets the reports, and passes them to the report of the terms,
/// until nobody can send any more.
///
/// # Errors
///
/// Those of `own`.
pub(super) fn inside<R: Send>(
    terms: Terms<'_>,
    step: impl FnOnce(Terms<'_>) -> R + Send,
    own: impl FnOnce(&Receiver<f64>, &dyn Fn(f64) -> Result<(), Error>) -> Result<(), Error>,
) -> Result<R, Error> {
    if !parallel::is_outside() {
        return Ok(step(terms));
    }
    let Terms { max_evaluations, threads, report } = terms;
    let (sender, reports) = channel();
    let is_stopped = &AtomicBool::new(false);
    let step = move || {
        let report = |share| {
            // Who stops does not listen any more.
            let _ = sender.send(share);
            if is_stopped.load(Relaxed) { Err(Error::Cancelled) } else { Ok(()) }
        };
        step(Terms { max_evaluations, threads, report: &report })
    };
    let own = || {
        let done = own(&reports, report);
        is_stopped.store(done.is_err(), Relaxed);
        done
    };
    let (done, mut results) = parallel::beside(own, vec![step]);
    done?;
    Ok(results.swap_remove(0))
}

/// Passes the reports on, and does nothing else.
///
/// # Errors
///
/// Those of `report`.
pub(super) fn listen(reports: &Receiver<f64>, report: &dyn Fn(f64) -> Result<(), Error>) -> Result<(), Error> {
    reports.iter().try_for_each(report)
}
