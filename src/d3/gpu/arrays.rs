//! The arrays of the mesh, which the host reads while other threads splay.
//!
//! Only the calling thread works with the device: it copies the pieces of the arrays as they arrive, and
//! submits the gathers of stars in between. WebAssembly has no other thread and little memory, so it does
//! not use this.

use crate::{
    d3::{
        gpu::{
            exchange::Device,
            pool::{inside, listen},
        },
        splay::Terms,
    },
    error::Error,
    gpu::{
        Pace, Reading, ReadingArrays, Words,
        phase1::{Ended, Slot},
    },
};
use pollster::block_on;
use std::sync::mpsc::{Receiver, TryRecvError};

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

    /// Runs a step of splaying on these terms as [`inside`] does. The calling thread reads the arrays
    /// meanwhile, if it reads them at all.
    ///
    /// # Errors
    ///
    /// What the report returns, and those of [`Run::advance`](crate::gpu::phase1::Run::advance).
    pub(crate) fn beside<R: Send>(
        &mut self,
        terms: Terms<'_>,
        step: impl FnOnce(Terms<'_>) -> R + Send,
    ) -> Result<R, Error> {
        let reads = self.arrays.is_some();
        inside(
            terms,
            step,
            |reports, report| {
                if reads { self.take_during(reports, report) } else { listen(reports, report) }
            },
        )
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
                        return listen(reports, report);
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
