//! Milliseconds per stage, from timestamp queries.

use crate::error::Error;
use crate::gpu::{Gpu, Pending, Readback, Storage};

/// The stages that one submission can time; WebGPU allows no more queries in a set than twice this.
/// Later stages of the submission count as part of the last timed one.
const CAPACITY: usize = 2048;

/// Times the stages of submissions.
#[derive(Debug)]
pub struct Profiler {
    queries: wgpu::QuerySet,
    ticks: Storage<u64>,
    /// Nanoseconds per tick.
    period: f64,
    readback: Readback,
    /// The stages of the submission that is being recorded.
    recording: Vec<&'static str>,
    /// Submissions whose timestamps are on their way.
    waiting: Vec<(Vec<&'static str>, Pending<u64>)>,
    milliseconds: Vec<(&'static str, f64)>,
}

impl Profiler {
    /// Creates a profiler, or returns `None` where the device has no timestamps.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`], on no real device.
    pub fn new(gpu: &Gpu) -> Result<Option<Self>, Error> {
        if !gpu.device().features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Ok(None);
        }
        let count = 2 * CAPACITY;
        let queries = gpu.device().create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("stages"),
            ty: wgpu::QueryType::Timestamp,
            count: count as u32,
        });
        Ok(Some(Profiler {
            queries,
            ticks: Storage::for_queries(gpu, "timestamps", count)?,
            period: f64::from(gpu.queue().get_timestamp_period()),
            readback: Readback::default(),
            recording: Vec::new(),
            waiting: Vec::new(),
            milliseconds: Vec::new(),
        }))
    }

    /// Returns the queries for the compute pass of a stage.
    pub(crate) fn begin(&mut self, name: &'static str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let slot = self.recording.len();
        (slot < CAPACITY).then(|| {
            self.recording.push(name);
            wgpu::ComputePassTimestampWrites {
                query_set: &self.queries,
                beginning_of_pass_write_index: Some(2 * slot as u32),
                end_of_pass_write_index: Some(2 * slot as u32 + 1),
            }
        })
    }

    /// Ends a submission's recording.
    pub(crate) fn resolve(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) {
        let stages = std::mem::take(&mut self.recording);
        if stages.is_empty() {
            return;
        }
        let used = 2 * stages.len();
        encoder.resolve_query_set(&self.queries, 0..used as u32, self.ticks.buffer(), 0);
        let pending = self.readback.copy(gpu, encoder, &self.ticks, 0, used);
        self.waiting.push((stages, pending));
    }

    /// Returns the milliseconds per stage since the profiler was made, in the order in which the
    /// stages first ran. Waits for `last`, the last submission that it has timed.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::receive`].
    pub async fn milliseconds(
        &mut self,
        gpu: &Gpu,
        last: &wgpu::SubmissionIndex,
    ) -> Result<&[(&'static str, f64)], Error> {
        for (stages, pending) in std::mem::take(&mut self.waiting) {
            let ticks = self.readback.receive(gpu, last, pending).await?;
            for (name, [begin, end]) in stages.into_iter().zip(ticks.as_chunks::<2>().0) {
                // Some drivers let the clock run backwards between power states.
                let elapsed = end.saturating_sub(*begin) as f64 * self.period / 1e6;
                match self.milliseconds.iter_mut().find(|(stage, _)| *stage == name) {
                    Some((_, sum)) => *sum += elapsed,
                    None => self.milliseconds.push((name, elapsed)),
                }
            }
        }
        Ok(&self.milliseconds)
    }
}
