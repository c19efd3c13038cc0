//! Figure 7: where the time goes, by distribution.
//!
//! The kernels are timed in a run of their own, with a compute pass for each dispatch; what they do
//! not account for of the wall time of Phase 1 is the host's: buffers, recording, waiting, and the
//! readback of the mesh.

use crate::{
    charts::{Bars, Chart},
    context::Context,
    figure6::DISTRIBUTIONS,
    outcome::{Outcome, Table},
};
use gdel::{
    internals::{
        gpu::{
            Profiler,
            phase1::{Input, Phase1, Settings},
            start::first_simplex,
        },
        input::lattice::Lattice,
    },
    stats::Phase,
};
use pollster::block_on;
use serde_json::json;
use std::error::Error;

const SIZE: usize = 1_000_000;
const TASKS: [&str; 8] =
    ["sort points", "insert", "flip", "relocate", "other kernels", "host and readback", "splay", "finish"];

/// Returns the task that a stage of the profiler belongs to.
fn task(stage: &str) -> &'static str {
    match stage {
        "unite" | "keys" | "sort" | "gather" => "sort points",
        "locate" | "pick" | "split" => "insert",
        "relocate" | "relocate after splits" => "relocate",
        "flip: check" | "flip: commit" | "flip: link" => "flip",
        _ => "other kernels",
    }
}

pub fn run(context: &Context) -> Result<Outcome, Box<dyn Error>> {
    let mut engine = context.engine(Settings::default())?;
    let size = context.sizes(&[SIZE])[0];
    let mut table = Table::new([
        "input",
        "points",
        "total, ms",
        "sort points",
        "insert",
        "flip",
        "relocate",
        "other kernels",
        "host and readback",
        "splay",
        "finish",
    ]);
    let mut shares: Vec<(String, Vec<f64>)> = TASKS.iter().map(|task| (task.to_string(), Vec::new())).collect();
    for distribution in DISTRIBUTIONS {
        let points = context.points(distribution, size);
        let timed = context.on_gpu(&mut engine, &points)?;
        let mut spent = [0.0; TASKS.len()];
        let mut add = |task: &str, milliseconds: f64| {
            let place = TASKS.iter().position(|name| *name == task);
            place.into_iter().for_each(|i| spent[i] += milliseconds);
        };
        for &(phase, time) in &timed.stats.phases {
            let task = match phase {
                Phase::Splay | Phase::Finish => phase.name(),
                _ => "host and readback",
            };
            add(task, time.as_secs_f64() * 1e3);
        }
        for (stage, milliseconds) in kernels(context, &points)? {
            add(task(stage), milliseconds);
            add("host and readback", -milliseconds);
        }
        let [a, b, c, d, e, f, g, h] = spent.map(|milliseconds| json!(milliseconds));
        let total = timed.milliseconds;
        table.push([json!(distribution.name()), json!(size), json!(total), a, b, c, d, e, f, g, h]);
        // Timing each dispatch takes time itself, so that on slow hosts nothing may be left for the
        // rest.
        shares.iter_mut().zip(spent).for_each(|((_, share), ms)| share.push(ms.max(0.0) / total * 100.0));
    }
    let chart = Chart::Bars(Bars {
        name: "breakdown",
        title: format!("Where the time goes, {size} points"),
        y: "per cent",
        groups: DISTRIBUTIONS.map(|d| d.name().to_owned()).to_vec(),
        parts: shares,
    });
    Ok(Outcome { tables: vec![table], charts: vec![chart] })
}

/// Returns milliseconds of each stage on the device; none where it has no timestamps.
fn kernels(context: &Context, points: &[[f64; 3]]) -> Result<Vec<(&'static str, f64)>, Box<dyn Error>> {
    let gpu = &context.gpu;
    let Some(mut profiler) = Profiler::new(gpu)? else { return Ok(Vec::new()) };
    let lattice = Lattice::fit(points.into());
    let position = |i: usize| lattice.coordinates(points[i]).map(|c| c.value);
    let start = first_simplex(lattice.width(), points.len(), position).ok_or("the points are coplanar")?;
    let input = Input { points: points.into(), lattice: &lattice, start, starts_later: false, is_uploaded: false };
    let mut phase1 = block_on(Phase1::new(gpu, lattice.width()))?;
    block_on(phase1.finish_compiling(gpu))?;
    block_on(phase1.run(gpu, input, &Settings::default(), None))?;
    block_on(phase1.run(gpu, input, &Settings::default(), Some(&mut profiler)))?;
    let last = gpu.queue().submit([]);
    Ok(block_on(profiler.milliseconds(gpu, &last))?.to_vec())
}
