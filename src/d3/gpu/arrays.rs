//! The arrays of the mesh, which the host reads while other threads splay.
//!
//! Only the calling thread works with the device: it copies the pieces of the arrays as they arrive, and
//! submits the gathers of stars in between. WebAssembly has no other thread and little memory, so it does
//! not use this.

use crate::{
    d3::{gpu::exchange::Device, splay::Terms},
    error::Error,
    gpu::{
        Pace, Reading, ReadingArrays, Words,
        phase1::{Ended, Slot},
    },
    parallel,
};
use pollster::block_on;
use std::sync::{
    atomic::{AtomicBool, Ordering::Relaxed},
    mpsc::{Receiver, TryRecvError, channel},
};

/// The tetrahedra of the mesh as Phase 1 leaves it, and their neighbours, on their way to the host.
pub(super) type Arrays<'a> = ReadingArrays<'a, Slot>;

impl Device<'_> {
    /// Begins to read the arrays. Ghosts come last, and are no neighbours in the mesh.
    pub(super) fn begin_reading(&mut self) {
        self.arrays = Some(self.ended.reading([Words::Same, Words::Numbers(self.ended.finite as u32)]));
        self.send_pieces(Pace::BESIDE);
    }

    /// Waits for the arrays. Returns the tetrahedra, and the numbers of their neighbours.
    ///
    /// # Errors
    ///
    /// Those of [`Run::advance`](crate::gpu::phase1::Run::advance).
    pub(super) async fn read_arrays(&mut self) -> Result<[Vec<Slot>; 2], Error> {
        self.ended.stats.stalls += 1;
        loop {
            self.send_pieces(Pace::ALONE);
            if !self.take_piece().await? {
                return Ok(self.arrays.take().map_or_else(Default::default, Reading::lists));
            }
        }
    }

    /// Runs a step of splaying on these terms: in another thread, if the calling one reads the arrays, which
    /// also receives the reports.
    ///
    /// # Errors
    ///
    /// What the report returns, and those of [`Run::advance`](crate::gpu::phase1::Run::advance).
    pub(crate) fn beside<R: Send>(
        &mut self,
        terms: Terms<'_>,
        step: impl FnOnce(Terms<'_>) -> R + Send,
    ) -> Result<R, Error> {
        if self.arrays.is_none() || !parallel::is_outside() {
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
            let read = self.take_during(&reports, report);
            is_stopped.store(read.is_err(), Relaxed);
            read
        };
        let (read, mut results) = parallel::beside(own, vec![step]);
        read?;
        Ok(results.swap_remove(0))
    }

    /// Takes pieces as they arrive, until nobody can send `reports` any more, which `report` receives.
    fn take_during(&mut self, reports: &Receiver<f64>, report: &dyn Fn(f64) -> Result<(), Error>) -> Result<(), Error> {
        loop {
            match reports.try_recv() {
                Ok(share) => report(share)?,
                Err(TryRecvError::Disconnected) => return Ok(()),
                Err(TryRecvError::Empty) => {
                    let has_arrived =
                        self.arrays.as_ref().map_or(Ok(true), |arrays| arrays.has_arrived(self.ended.gpu));
                    if !has_arrived? {
                        std::thread::yield_now();
                    } else if !block_on(self.take_piece())? {
                        // All of the arrays is there.
                        return reports.iter().try_for_each(report);
                    } else {
                        self.send_pieces(Pace::BESIDE);
                    }
                }
            }
        }
    }

    /// Takes the pieces that were sent before what was submitted last, while the device carries that out.
    pub(super) async fn take_earlier_pieces(&mut self) -> Result<(), Error> {
        for _ in 0..self.arrays.as_ref().map_or(0, Reading::pieces_ahead) {
            self.take_piece().await?;
            self.send_pieces(Pace::BESIDE);
        }
        Ok(())
    }

    /// Waits for the first piece that is on its way, and takes it. Returns whether there was one.
    async fn take_piece(&mut self) -> Result<bool, Error> {
        let Ended { gpu, kernels, .. } = &mut self.ended;
        match &mut self.arrays {
            Some(arrays) => kernels.readback.take(gpu, arrays).await,
            None => Ok(false),
        }
    }

    /// Sends as many pieces on their way as the pace allows.
    fn send_pieces(&mut self, pace: Pace) {
        let Ended { gpu, kernels, stats, .. } = &mut self.ended;
        if let Some(arrays) = &mut self.arrays {
            stats.submits += arrays.send(gpu, &mut kernels.readback, pace);
        }
    }
}
