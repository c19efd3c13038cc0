//! Shows the progress of a triangulation, and cancels another one from a second thread.
//!
//! `cargo run --release --example cancel_and_progress`

use gdel::{Backend, Error, Triangulator};
use std::{
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

fn main() -> Result<(), Error> {
    let points: Vec<[f64; 3]> =
        (0..50_000u32).map(|i| [7, 11, 13].map(|k| f64::from(i.wrapping_mul(i) % (100_003 + k)))).collect();
    let triangulator = Triangulator::new().backend(Backend::Cpu);

    let mesh = triangulator
        .clone()
        .on_progress(|progress| {
            eprint!("\r{:8} {:3.0} %", progress.phase, 100.0 * progress.fraction);
            ControlFlow::Continue(())
        })
        .delaunay3d(&points)?;
    eprintln!();
    for (phase, time) in &mesh.stats.phases {
        println!("{phase:8} {time:.1?}");
    }

    // The callback runs in the thread that triangulates; any other thread can set the flag that it
    // reads.
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let cancellable = triangulator.on_progress(move |_| match flag.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    });
    let worker = thread::spawn(move || while cancellable.delaunay3d(&points).is_ok() {});
    stop.store(true, Ordering::Relaxed);
    worker.join().expect("the worker does not panic");
    println!("cancelled");
    Ok(())
}
