//! Figure 9: flipping after every round of insertions (InsFlip) against flipping when all points
//! are in (InsAll).

use crate::{
    charts::{Chart, Lines},
    context::Context,
    outcome::{Outcome, Table},
};
use gdel::internals::{d3::generate::Distribution3, gpu::phase1::Settings};
use serde_json::json;
use std::error::Error;

const SIZES: [usize; 5] = [100_000, 250_000, 500_000, 750_000, 1_000_000];
const STRATEGIES: [(&str, bool); 2] = [("InsFlip", false), ("InsAll", true)];

pub fn run(context: &Context) -> Result<Outcome, Box<dyn Error>> {
    let mut table =
        Table::new(["strategy", "points", "failed vertices", "flips", "flip iterations", "total, ms", "fallback"]);
    let (mut failed, mut flips) = (Vec::new(), Vec::new());
    for (name, insert_all) in STRATEGIES {
        let mut engine = context.engine(Settings { insert_all, ..Settings::default() })?;
        let (mut failed_here, mut flips_here) = (Vec::new(), Vec::new());
        for size in context.sizes(&SIZES) {
            let timed = context.on_gpu(&mut engine, &context.points(Distribution3::Uniform, size))?;
            let gpu = timed.stats.gpu.unwrap_or_default();
            let all_flips = gpu.flips_23 + gpu.flips_32;
            table.push([
                json!(name),
                json!(size),
                json!(gpu.failed_vertices),
                json!(all_flips),
                json!(gpu.flip_iterations),
                json!(timed.milliseconds),
                json!(timed.stats.fallback.map(|why| why.to_string())),
            ]);
            failed_here.push((size as f64, gpu.failed_vertices as f64));
            flips_here.push((size as f64, all_flips as f64));
        }
        failed.push((name.to_owned(), failed_here));
        flips.push((name.to_owned(), flips_here));
    }
    let lines = |name, title: &str, y, logarithmic, series| {
        Chart::Lines(Lines { name, title: title.to_owned(), x: "points", y, logarithmic, series })
    };
    let charts = vec![
        lines("failed", "Failed vertices, uniform points", "vertices", true, failed),
        lines("flips", "Flips, uniform points", "flips", false, flips),
    ];
    Ok(Outcome { tables: vec![table], charts })
}
