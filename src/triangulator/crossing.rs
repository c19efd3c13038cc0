//! From how many points on the GPU engine is faster than the CPU engine: estimated from what runs on this device took.

use crate::{
    parallel::{self, Threads},
    platform::records,
};

/// The sizes of which times are kept: powers of two, from this one on.
const FIRST_SIZE: usize = 1 << 10;
const SIZES: usize = 14;

/// What a run takes where nothing was measured: milliseconds for the whole, and nanoseconds for each point.
pub(super) type Prior = [f64; 2];

fn prior_time([fixed, per_point]: Prior, points: usize) -> f64 {
    fixed + per_point * 1e-6 * points as f64
}

/// Returns how many times as fast as one thread so many are, about.
fn cores(threads: usize) -> f64 {
    0.4 + 0.6 * threads as f64
}

/// Returns how many times as fast as one thread all of them are.
fn all_cores() -> f64 {
    cores(parallel::count(Threads::All))
}

/// A run that was fast: its number of points, and its milliseconds.
type Fast = (usize, f64);

/// What runs took, by their size.
#[derive(Debug, Clone)]
struct Times {
    prior: Prior,
    /// The fastest run for [`FIRST_SIZE`] points or so, and for each doubling.
    fastest: [Option<Fast>; SIZES],
}

impl Times {
    fn new(prior: Prior) -> Self {
        Times { prior, fastest: [None; SIZES] }
    }

    /// Notes how long a run took. Returns whether that says much: small ones say nothing of larger ones.
    fn note(&mut self, points: usize, time: f64) -> bool {
        // A size stands for those from ¾ of it on.
        let doubled = (points + points / 3) / FIRST_SIZE;
        let Some(k) = doubled.checked_ilog2() else { return false };
        let fastest = &mut self.fastest[(k as usize).min(SIZES - 1)];
        let before = fastest.map_or(f64::INFINITY, |fast| scaled(self.prior, fast, points));
        if time < before {
            *fastest = Some((points, time));
        }
        time < 0.9 * before
    }

    /// Returns how long a run with so many points takes. Between two sizes of which the times are known, it is
    /// interpolated. Beyond them, it is the lesser of what the nearest one suggests with the growth that is usual, and
    /// with that of the last two: an estimate that is too low is corrected by the next run, one that is too high never.
    fn estimate(&self, points: usize) -> f64 {
        let known = || self.fastest.iter().flatten().copied();
        let above = known().find(|&(size, _)| size > points);
        let mut below = known().rev().filter(|&(size, _)| size <= points);
        let line = |(low, from): Fast, (high, to): Fast| {
            let share = (points - low) as f64 / (high - low) as f64;
            from + share * (to - from)
        };
        match (below.next(), above) {
            (None, None) => prior_time(self.prior, points),
            (None, Some(fast)) => scaled(self.prior, fast, points),
            (Some(low), Some(high)) => line(low, high),
            (Some(fast), None) => {
                let usual = scaled(self.prior, fast, points);
                let grown = below.next().map_or(f64::INFINITY, |low| line(low, fast));
                // More points never take less time.
                usual.min(grown).max(fast.1)
            }
        }
    }
}

/// Returns the time for so many points if that of a run is known.
fn scaled(prior: Prior, (points, time): Fast, wanted: usize) -> f64 {
    time * prior_time(prior, wanted) / prior_time(prior, points)
}

/// What the engines take on this machine, which decides between them.
#[derive(Debug, Clone)]
pub struct Crossing {
    cpu: Times,
    gpu: Times,
    /// How long it takes to compile the kernels, in milliseconds.
    compiling: f64,
    /// Whether the device has passed its test.
    is_proven: bool,
    /// How many of its meshes have failed a check.
    wrong_meshes: u32,
    /// Whether what runs take is noted.
    pub(super) learns: bool,
    /// Under which name it is kept for later processes, once the device is known.
    name: Option<String>,
}

impl Crossing {
    /// Creates the state in which nothing was measured.
    ///
    /// The CPU engine takes so many nanoseconds per point in one thread.
    pub(super) fn new((cpu, gpu): (f64, Prior), compiling: f64) -> Self {
        Crossing {
            cpu: Times::new([0.0, cpu / all_cores()]),
            gpu: Times::new(gpu),
            compiling,
            is_proven: false,
            wrong_meshes: 0,
            learns: true,
            name: None,
        }
    }

    /// Notes that the CPU engine took so many milliseconds, with all threads.
    pub(super) fn note_cpu(&mut self, points: usize, time: f64) {
        if self.learns && self.cpu.note(points, time) {
            self.keep();
        }
    }

    /// Notes that the GPU engine took so many milliseconds.
    pub(super) fn note_gpu(&mut self, points: usize, time: f64) {
        if self.learns && self.gpu.note(points, time) {
            self.keep();
        }
    }

    /// Notes that the kernels were compiled in so many milliseconds.
    pub(super) fn note_compiling(&mut self, time: f64) {
        self.compiling = time;
    }

    pub(super) fn compiling(&self) -> f64 {
        self.compiling
    }

    /// Notes that the device has passed its test.
    pub(super) fn prove(&mut self) {
        self.is_proven = true;
        self.keep();
    }

    /// Notes that a mesh has failed a check: the device has to pass its test again before it is used by a later process.
    pub(super) fn note_wrong(&mut self) {
        self.is_proven = false;
        self.wrong_meshes = self.wrong_meshes.saturating_add(1);
        self.keep();
    }

    /// Returns how many meshes have failed a check.
    pub(super) fn wrong_meshes(&self) -> u64 {
        self.wrong_meshes.into()
    }

    /// Returns whether the device has passed its test, in this process or in an earlier one.
    pub(super) fn is_proven(&self) -> bool {
        self.is_proven
    }

    /// Recalls what an earlier process has kept under this name, and keeps what is measured from now on.
    pub(super) fn recall(&mut self, name: String) {
        if self.name.as_ref() != Some(&name) {
            self.merge(&records::load(&name));
            self.name = Some(name);
        }
    }

    fn keep(&self) {
        if let Some(name) = &self.name {
            records::save(name, &self.to_words());
        }
    }

    /// Returns how many milliseconds the CPU engine and the GPU engine take, the former with this number of threads if
    /// it is not that of the pool.
    pub(super) fn estimates(&self, points: usize, threads: Option<usize>) -> [f64; 2] {
        let slower = threads.map_or(1.0, |threads| all_cores() / cores(threads));
        [slower * self.cpu.estimate(points), self.gpu.estimate(points)]
    }

    /// Returns what is to be kept: twice the number of wrong meshes, plus 1 if the test was passed; the microseconds of
    /// compiling; and those of the fastest runs with their numbers of points, which are 0 where nothing is known.
    pub(super) fn to_words(&self) -> Vec<u32> {
        // Conversions saturate.
        let micros = |time: f64| (time * 1e3) as u32;
        let runs = self.cpu.fastest.iter().chain(&self.gpu.fastest);
        let runs = runs.flat_map(|run| run.map_or([0, 0], |(points, time)| [points as u32, micros(time)]));
        let tested = self.wrong_meshes.min(u32::MAX / 2) * 2 + u32::from(self.is_proven);
        [tested, micros(self.compiling)].into_iter().chain(runs).collect()
    }

    /// Takes over what was kept. What this process has measured stays if it is less.
    pub(super) fn merge(&mut self, words: &[u32]) {
        let Some((&[tested, compiling], runs)) = words.split_first_chunk() else { return };
        let (runs, []) = runs.as_chunks() else { return };
        if runs.len() != 2 * SIZES {
            return;
        }
        self.is_proven |= tested % 2 == 1;
        self.wrong_meshes = self.wrong_meshes.max(tested / 2);
        self.compiling = f64::from(compiling) / 1e3;
        for (i, &[points, time]) in runs.iter().enumerate() {
            let times = if i < SIZES { &mut self.cpu } else { &mut self.gpu };
            times.note(points as usize, f64::from(time) / 1e3);
        }
    }

    /// Returns the least number of points for which the GPU engine is faster.
    pub(super) fn least(&self, threads: Option<usize>) -> usize {
        let pays = |points: usize| {
            let [cpu, gpu] = self.estimates(points, threads);
            gpu < cpu
        };
        let Some(pays_at) = (0..u32::BITS).map(|k| 1usize << k).find(|&points| pays(points)) else { return usize::MAX };
        let (mut low, mut high) = (pays_at / 2, pays_at);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if pays(middle) { high = middle } else { low = middle }
        }
        high
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CPU: Prior = [0.0, 2000.0];
    const GPU: Prior = [12.0, 40.0];

    /// One thread whatever the machine has.
    fn crossing() -> Crossing {
        let mut crossing = Crossing::new((CPU[1], GPU), 250.0);
        crossing.cpu = Times::new(CPU);
        crossing
    }

    #[test]
    fn what_was_not_measured_is_estimated() {
        let crossing = crossing();
        assert_eq!(crossing.estimates(10_000, None), [20.0, 12.4]);
        let least = crossing.least(None);
        let [[cpu, gpu], [sooner, later]] = [least, least - 1].map(|points| crossing.estimates(points, None));
        assert!(gpu < cpu && sooner <= later, "{least}");
        assert_eq!(least, 6_123);
    }

    /// The engine that is taken is at most 1.2 times as slow as the better one, whatever a device takes.
    #[test]
    fn the_better_engine_is_taken_once_both_were_measured() {
        let devices = [(0.5, 20.0), (4.2, 39.0), (15.0, 130.0), (40.0, 500.0), (9.0, 3000.0), (400.0, 1.0)];
        let processors = [110.0, 250.0, 2000.0, 4200.0];
        for ((fixed, per_point), slow) in devices.into_iter().flat_map(|d| processors.map(|p| (d, p))) {
            let device = [fixed, per_point];
            let processor = [0.02, slow];
            let mut crossing = crossing();
            for points in [1_000, 8_000, 30_000] {
                crossing.note_cpu(points, prior_time(processor, points));
                crossing.note_gpu(points, prior_time(device, points));
            }
            let sizes = (0..100).map(|k| (1000.0 * 1.08_f64.powi(k)) as usize);
            for (points, time_counts) in sizes.flat_map(|points| [(points, false), (points, true)]) {
                let [cpu, gpu] = crossing.estimates(points, None);
                let taken = if gpu < cpu { device } else { processor };
                let time = prior_time(taken, points);
                let better = prior_time(device, points).min(prior_time(processor, points));
                // The first run of a size may take the other engine, of which nothing was known there.
                let is_right = time <= 1.2 * better || !time_counts;
                assert!(is_right, "{points} points: {time}, {better} on {device:?}, {processor:?}");
                if gpu < cpu { crossing.note_gpu(points, time) } else { crossing.note_cpu(points, time) }
            }
        }
    }

    #[test]
    fn the_least_time_counts() {
        let mut crossing = crossing();
        for time in [90.0, 30.0, 45.0] {
            crossing.note_gpu(1 << 16, time);
        }
        assert_eq!(crossing.estimates(1 << 16, None)[1], 30.0);
    }

    #[test]
    fn fewer_threads_take_longer() {
        let mut crossing = crossing();
        crossing.note_cpu(1 << 15, 10.0);
        let all = parallel::count(Threads::All);
        assert_eq!(crossing.estimates(1 << 15, Some(all))[0], 10.0);
        assert_eq!(crossing.estimates(1 << 15, Some(1))[0], 10.0 * cores(all));
    }

    #[test]
    fn what_is_kept_comes_back() {
        let mut crossing = crossing();
        crossing.note_cpu(5_000, 12.5);
        crossing.note_gpu(1_000_000, 43.25);
        crossing.note_compiling(74.0);
        crossing.prove();
        crossing.note_wrong();
        crossing.note_wrong();
        let words = crossing.to_words();
        let mut other = self::crossing();
        other.merge(&words);
        assert_eq!(other.to_words(), words);
        assert_eq!((other.is_proven(), other.wrong_meshes()), (false, 2));
        assert_eq!(other.estimates(5_000, None)[0], 12.5);
        // What another version has kept is ignored.
        other.merge(&[1, 2, 3]);
        assert_eq!(other.to_words(), words);
    }
}
