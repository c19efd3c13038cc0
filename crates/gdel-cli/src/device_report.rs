//! The report of a GPU: whether it computes rightly, and how fast. `scripts/devices.mjs` reads it, and the page
//! `www/report/` writes the same.

use super::{dimension::Triangulation, progress::Progress};
use gdel::{
    AdapterChoice, AdapterSummary, Backend, Error, Mesh2, Mesh3, Points, Triangulator,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        gpu::self_test::KNOWN_ANSWERS,
    },
};
use std::{
    env::consts::{ARCH, OS},
    io::{self, Write},
    panic::{self, AssertUnwindSafe},
    thread,
    time::Instant,
};

/// The runs of which the fastest counts; two if they take more milliseconds than this, since the first one may compile
/// kernels.
const RUNS: usize = 3;
const ENOUGH: f64 = 2_000.0;
/// Inputs are left out for which a run is expected to take more milliseconds than this.
const PATIENCE: f64 = 30_000.0;
const SEED: u64 = 1;

/// What came of a part of the report.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    Right,
    /// Something was left out, or failed with an error.
    Incomplete,
    Wrong,
}

/// A mesh that was made: its fingerprint, why the CPU made it in place of the GPU, and the milliseconds that it took.
struct Run {
    fingerprint: u64,
    fallback: Option<String>,
    milliseconds: f64,
}

/// Why there is no mesh, and what that says of the device.
struct Trouble {
    outcome: Outcome,
    what: String,
}

/// The report while it is written.
struct Report<'a, W> {
    out: &'a mut W,
    cpu: Triangulator,
    gpu: Triangulator,
    outcome: Outcome,
    /// The milliseconds that the slower backend took for a point of the last input.
    pace: f64,
}

/// Tests the adapter of this index, and writes its report, line by line. Returns false if it computes wrongly.
pub(super) fn write(out: &mut impl Write, index: usize, adapter: &AdapterSummary, counts: &[u32]) -> io::Result<bool> {
    let AdapterSummary { name, backend, driver, software, .. } = adapter;
    let threads = thread::available_parallelism().map_or(1, usize::from);
    writeln!(out, "gdel report 1\nversion: {}", env!("CARGO_PKG_VERSION"))?;
    writeln!(out, "device: {name}{}", if *software { " (software)" } else { "" })?;
    writeln!(out, "driver: {backend}, {driver}\nsystem: {OS} {ARCH}, {threads} threads")?;
    let cpu = Triangulator::new().backend(Backend::Cpu);
    let gpu = Triangulator::new().adapter(AdapterChoice::Index(index)).backend(Backend::Gpu).self_test(false);
    let mut report = Report { out, cpu, gpu, outcome: Outcome::Right, pace: 0.0 };
    report.self_test::<Mesh3, 3, 4>()?;
    report.self_test::<Mesh2, 2, 3>()?;
    for count in counts.iter().map(|&count| count as usize) {
        report.compare::<Mesh3, 3, 4>(&generate3d(Distribution3::Uniform, count, SEED))?;
    }
    report.pace = 0.0;
    for count in counts.iter().map(|&count| count as usize) {
        report.compare::<Mesh2, 2, 3>(&generate2d(Distribution2::Uniform, count, SEED))?;
    }
    let outcome = report.outcome;
    let result = match outcome {
        Outcome::Right => "right",
        Outcome::Incomplete => "incomplete",
        Outcome::Wrong => "WRONG",
    };
    writeln!(out, "result: {result}")?;
    Ok(outcome != Outcome::Wrong)
}

impl<W: Write> Report<'_, W> {
    /// Compares meshes with those that are known.
    fn self_test<M: Triangulation<D, N>, const D: usize, const N: usize>(&mut self) -> io::Result<()> {
        let progress = Progress::new("testing the GPU");
        let began = Instant::now();
        let passed = self.known_answers::<M, D, N>();
        let total = shown(millis(began));
        drop(progress);
        match passed {
            Ok(times) => writeln!(self.out, "self-test {D}D: passed in {total} ms ({})", times.join(", ")),
            Err(Trouble { outcome, what }) => {
                self.outcome = self.outcome.max(outcome);
                writeln!(self.out, "self-test {D}D: FAILED at {what}")
            }
        }
    }

    fn known_answers<M: Triangulation<D, N>, const D: usize, const N: usize>(&self) -> Result<Vec<String>, Trouble> {
        let mut times = Vec::new();
        for test in &KNOWN_ANSWERS {
            let at = |Trouble { outcome, what }| Trouble { outcome, what: format!("{}, {what}", test.name) };
            let run = fastest::<M, D, N>(&self.gpu, &test.points()).map_err(at)?;
            if run.fingerprint != test.answer::<D>() || run.fallback.is_some() {
                let what = run.fallback.map_or("another mesh".to_owned(), |why| format!("left to the CPU: {why}"));
                return Err(at(Trouble { outcome: Outcome::Wrong, what }));
            }
            times.push(format!("{} {} ms", test.name, shown(run.milliseconds)));
        }
        Ok(times)
    }

    /// Compares the meshes that both backends make of these points.
    fn compare<M: Triangulation<D, N>, const D: usize, const N: usize>(
        &mut self,
        points: &[[f64; D]],
    ) -> io::Result<()> {
        let progress = Progress::new("triangulating");
        let (outcome, text) = match self.both::<M, D, N>(points) {
            Ok(text) => (Outcome::Right, text),
            Err(Trouble { outcome, what }) => (outcome, what),
        };
        drop(progress);
        self.outcome = self.outcome.max(outcome);
        writeln!(self.out, "{D}D {}: {text}", points.len())
    }

    fn both<M: Triangulation<D, N>, const D: usize, const N: usize>(
        &mut self,
        points: &[[f64; D]],
    ) -> Result<String, Trouble> {
        let expected = self.pace * points.len() as f64;
        if expected > PATIENCE {
            let what = format!("left out, a run would take {} s", shown(1e-3 * expected));
            return Err(Trouble { outcome: Outcome::Incomplete, what });
        }
        let cpu = fastest::<M, D, N>(&self.cpu, points)
            .map_err(|Trouble { outcome, what }| Trouble { outcome, what: format!("CPU failed: {what}") })?;
        let mut text = format!("CPU {} ms, GPU ", shown(cpu.milliseconds));
        let gpu = fastest::<M, D, N>(&self.gpu, points)
            .map_err(|Trouble { outcome, what }| Trouble { outcome, what: format!("{text}failed: {what}") })?;
        self.pace = cpu.milliseconds.max(gpu.milliseconds) / points.len() as f64;
        if let Some(why) = gpu.fallback {
            return Err(Trouble {
                outcome: Outcome::Incomplete,
                what: format!("{text}failed: left to the CPU: {why}"),
            });
        }
        text.push_str(&format!("{} ms, ", shown(gpu.milliseconds)));
        match gpu.fingerprint == cpu.fingerprint {
            true => Ok(text + "same"),
            false => Err(Trouble { outcome: Outcome::Wrong, what: text + "DIFFERENT" }),
        }
    }
}

/// Returns the fastest of a few runs, which all have to make the same mesh.
fn fastest<M: Triangulation<D, N>, const D: usize, const N: usize>(
    triangulator: &Triangulator,
    points: &[[f64; D]],
) -> Result<Run, Trouble> {
    let mut best = run::<M, D, N>(triangulator, points)?;
    for i in 1..RUNS {
        if best.milliseconds > if i == 1 { PATIENCE } else { ENOUGH } {
            break;
        }
        let next = run::<M, D, N>(triangulator, points)?;
        if next.fingerprint != best.fingerprint {
            return Err(Trouble { outcome: Outcome::Wrong, what: "two runs make different meshes".to_owned() });
        }
        if next.milliseconds < best.milliseconds {
            best = next;
        }
    }
    Ok(best)
}

fn run<M: Triangulation<D, N>, const D: usize, const N: usize>(
    triangulator: &Triangulator,
    points: &[[f64; D]],
) -> Result<Run, Trouble> {
    let began = Instant::now();
    // What a device returns may make no sense.
    let made = panic::catch_unwind(AssertUnwindSafe(|| M::triangulate(Points::F64(points), None, triangulator)));
    let milliseconds = millis(began);
    let made = made.map_err(|_| Trouble { outcome: Outcome::Wrong, what: "the program panicked".to_owned() })?;
    let mesh = made.map_err(|error| Trouble {
        outcome: if let Error::WrongResults { .. } = error { Outcome::Wrong } else { Outcome::Incomplete },
        what: error.to_string(),
    })?;
    let fallback = mesh.stats().fallback.as_ref().map(ToString::to_string);
    Ok(Run { fingerprint: mesh.fingerprint(), fallback, milliseconds })
}

fn millis(since: Instant) -> f64 {
    1e3 * since.elapsed().as_secs_f64()
}

/// Returns a time for people, without the unit.
fn shown(time: f64) -> String {
    let decimals = if time < 9.95 { 1 } else { 0 };
    format!("{time:.decimals$}")
}
