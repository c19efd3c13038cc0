//! What is printed: one JSON object per measurement.

use serde_json::{Map, Value, json};
use std::{
    num::NonZeroUsize,
    process::Command,
    time::{Duration, Instant},
};

/// A line of JSON.
pub struct Row(Map<String, Value>);

impl Row {
    /// Returns a row that says what measures, where and when.
    pub fn new() -> Self {
        let words: Vec<String> = std::env::args().skip(1).collect();
        let row = Row(Map::new())
            .with("command", format!("gdel-bench {}", words.join(" ")))
            .with("version", env!("CARGO_PKG_VERSION"))
            .with("processor", processor());
        let row = match output("git", &["rev-parse", "--short", "HEAD"]) {
            Some(commit) => row.with("commit", commit),
            None => row,
        };
        match output("date", &["+%Y-%m-%d"]) {
            Some(date) => row.with("date", date),
            None => row,
        }
    }

    /// Returns the row with one more field.
    pub fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.0.insert(name.to_owned(), value.into());
        self
    }

    /// Returns the row with the times of all runs, and their median, in milliseconds.
    pub fn with_times(self, name: &str, times: &[f64]) -> Self {
        let rounded: Vec<f64> = times.iter().copied().map(microseconds).collect();
        self.with(name, microseconds(median(times))).with(&format!("all_{name}"), rounded)
    }

    pub fn print(self) {
        println!("{}", Value::Object(self.0));
    }
}

/// Returns what a command prints, if it succeeds.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok().map(|text| text.trim().to_owned())
}

/// Returns the model of the processor, where Linux says it.
fn processor() -> Value {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
    model.map_or(Value::Null, |(_, name)| json!(name.trim()))
}

/// Returns a number of milliseconds, rounded to microseconds.
pub fn microseconds(milliseconds: f64) -> f64 {
    (milliseconds * 1e3).round() / 1e3
}

pub fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

pub fn median(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Returns the milliseconds that some work takes, and its result.
pub fn timed<R>(work: impl FnOnce() -> R) -> (f64, R) {
    let clock = Instant::now();
    let result = work();
    (milliseconds(clock.elapsed()), result)
}

/// Returns the milliseconds that some work takes, and its result.
///
/// # Errors
///
/// Returns the error of the work.
pub fn try_timed<R, E>(work: impl FnOnce() -> Result<R, E>) -> Result<(f64, R), E> {
    let (time, result) = timed(work);
    Ok((time, result?))
}

/// Returns the milliseconds of `runs` runs, as they state them, and the last result, after others for `warm_up`
/// seconds. A run finds the memory of the result before free.
///
/// # Errors
///
/// Returns the first error of a run.
pub fn repeated<R, E>(
    runs: NonZeroUsize,
    warm_up: f64,
    mut run: impl FnMut() -> Result<(f64, R), E>,
) -> Result<(Vec<f64>, R), E> {
    let clock = Instant::now();
    while clock.elapsed().as_secs_f64() < warm_up {
        run()?;
    }
    let (first, mut last) = run()?;
    let mut times = vec![first];
    for _ in 1..runs.get() {
        drop(last);
        let (time, result) = run()?;
        last = result;
        times.push(time);
    }
    Ok((times, last))
}
