//! Not in the paper: from which size on the GPU pays, and what opening it costs.
//! [`gdel::internals::triangulator`] has the constants that follow from it.

use crate::{
    charts::{Chart, Lines},
    context::Context,
    outcome::{Outcome, Table},
};
use gdel::internals::{d3::generate::Distribution3, gpu::phase1::Settings};
use serde_json::json;
use std::{error::Error, time::Instant};

const SIZES: [usize; 8] = [1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 200_000];

pub fn run(context: &Context) -> Result<Outcome, Box<dyn Error>> {
    let clock = Instant::now();
    let mut engine = context.engine(Settings::default())?;
    let compiling = clock.elapsed().as_secs_f64() * 1e3;
    let mut engines = [("gpu".to_owned(), Vec::new()), ("cpu".to_owned(), Vec::new())];
    let mut table = Table::new(["points", "gpu, ms", "cpu, ms", "cpu / gpu"]);
    for size in context.sizes(&SIZES) {
        let points = context.points(Distribution3::Uniform, size);
        let (gpu, cpu) = (context.on_gpu(&mut engine, &points)?.milliseconds, context.on_cpu(&points)?.milliseconds);
        table.push([json!(size), json!(gpu), json!(cpu), json!(cpu / gpu)]);
        engines[0].1.push((size as f64, gpu));
        engines[1].1.push((size as f64, cpu));
    }
    let mut opening = Table::new(["opening the device, ms", "compiling the kernels, ms"]);
    opening.push([json!(context.opening), json!(compiling)]);
    let chart = Chart::Lines(Lines {
        name: "time",
        title: "Uniform points, both engines".to_owned(),
        x: "points",
        y: "milliseconds",
        logarithmic: true,
        series: engines.to_vec(),
    });
    Ok(Outcome { tables: vec![table, opening], charts: vec![chart] })
}
