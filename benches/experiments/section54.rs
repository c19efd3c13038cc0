//! §5.4: which of its points a tetrahedron inserts.

use crate::{
    charts::{Bars, Chart},
    context::Context,
    outcome::{Outcome, Table},
};
use gdel::{
    Points, Points3,
    internals::{
        d3::generate::Distribution3,
        gpu::{layout::Pick, phase1::Settings},
    },
};
use serde_json::json;
use std::error::Error;

const SIZE: usize = 1_000_000;
const PICKS: [(&str, Pick); 4] = [
    ("circumcenter", Pick::Circumcenter),
    ("centroid", Pick::Centroid),
    ("random", Pick::Random),
    ("adaptive", Pick::Adaptive),
];

pub fn run(context: &Context) -> Result<Outcome, Box<dyn Error>> {
    let size = context.sizes(&[SIZE])[0];
    let uniform = context.points(Distribution3::Uniform, size);
    let mut inputs: Vec<(&str, Points3<'_>)> = vec![("uniform", (&uniform).into())];
    inputs.extend(context.models.iter().map(|model| (model.name.as_str(), Points::from(&model.cloud))));
    let mut table = Table::new(["pick", "input", "points", "failed vertices", "flips", "total, ms", "fallback"]);
    let mut failed = Vec::new();
    for (name, pick) in PICKS {
        let mut engine = context.engine(Settings { pick, ..Settings::default() })?;
        let mut failed_here = Vec::new();
        for &(input, points) in &inputs {
            let timed = context.on_gpu(&mut engine, points)?;
            let gpu = timed.stats.gpu.unwrap_or_default();
            table.push([
                json!(name),
                json!(input),
                json!(points.len()),
                json!(gpu.failed_vertices),
                json!(gpu.flips_23 + gpu.flips_32),
                json!(timed.milliseconds),
                json!(timed.stats.fallback.map(|why| why.to_string())),
            ]);
            failed_here.push(100.0 * gpu.failed_vertices as f64 / points.len() as f64);
        }
        failed.push((name, failed_here));
    }
    // A bar for each way and input.
    let (mut groups, mut heights) = (Vec::new(), Vec::new());
    for (i, (input, _)) in inputs.iter().enumerate() {
        for (name, failed) in &failed {
            groups.push(format!("{input}, {name}"));
            heights.push(failed[i]);
        }
    }
    let chart = Chart::Bars(Bars {
        name: "failed",
        title: "Failed vertices by the point that is inserted".to_owned(),
        y: "per cent of the points",
        groups,
        parts: vec![("failed vertices".to_owned(), heights)],
    });
    Ok(Outcome { tables: vec![table], charts: vec![chart] })
}
