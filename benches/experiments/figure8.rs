//! Figure 8: the stars that splaying builds for failed vertices, and those that it pulls from the
//! triangulation.

use crate::{
    charts::{Bars, Chart},
    context::Context,
    figure6::DISTRIBUTIONS,
    outcome::{Outcome, Table},
};
use gdel::{Points3, internals::gpu::phase1::Settings};
use serde_json::json;
use std::error::Error;

const SIZE: usize = 500_000;

pub fn run(context: &Context) -> Result<Outcome, Box<dyn Error>> {
    let mut engine = context.engine(Settings::default())?;
    let size = context.sizes(&[SIZE])[0];
    let mut table =
        Table::new(["input", "points", "failed", "built", "pulled", "built, %", "pulled, %", "all, %", "fallback"]);
    let (mut groups, mut built, mut pulled) = (Vec::new(), Vec::new(), Vec::new());
    let mut add = |name: &str, points: Points3<'_>| -> Result<(), Box<dyn Error>> {
        let stats = context.once_on_gpu(&mut engine, points)?;
        let splay = stats.splay.unwrap_or_default();
        let [b, p] = [splay.built, splay.pulled].map(|stars| 100.0 * stars as f64 / points.len() as f64);
        table.push([
            json!(name),
            json!(points.len()),
            json!(splay.failed),
            json!(splay.built),
            json!(splay.pulled),
            json!(b),
            json!(p),
            json!(b + p),
            json!(stats.fallback.map(|why| why.to_string())),
        ]);
        groups.push(name.to_owned());
        built.push(b);
        pulled.push(p);
        Ok(())
    };
    for distribution in DISTRIBUTIONS {
        add(distribution.name(), (&context.points(distribution, size)).into())?;
    }
    for model in &context.models {
        add(&model.name, (&model.cloud).into())?;
    }
    let chart = Chart::Bars(Bars {
        name: "stars",
        title: "Stars that take part in splaying".to_owned(),
        y: "per cent of the points",
        groups,
        parts: vec![("built".to_owned(), built), ("pulled".to_owned(), pulled)],
    });
    Ok(Outcome { tables: vec![table], charts: vec![chart] })
}
