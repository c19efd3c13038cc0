//! Figure 6: the running time by distribution and size, and of models, against sequential engines.

use crate::{
    charts::{Bars, Chart, Lines},
    context::Context,
    outcome::{Outcome, Table},
};
use gdel::{
    Points3,
    internals::{
        d3::generate::Distribution3,
        gpu::{engine::GpuEngine, phase1::Settings},
    },
};
use serde_json::{Value, json};
use std::error::Error;

const SIZES: [usize; 6] = [100_000, 300_000, 500_000, 1_000_000, 1_250_000, 1_500_000];
/// Those of the paper.
pub const DISTRIBUTIONS: [Distribution3; 5] = [
    Distribution3::Uniform,
    Distribution3::Gaussian,
    Distribution3::Grid,
    Distribution3::ThinSphere,
    Distribution3::Sphere,
];

/// Milliseconds of the engines.
struct Times {
    gpu: f64,
    cpu: f64,
    cgal: Option<f64>,
    fallback: Value,
}

impl Times {
    fn take<'a>(
        context: &Context,
        engine: &mut GpuEngine<3>,
        points: impl Into<Points3<'a>>,
    ) -> Result<Self, Box<dyn Error>> {
        let points = points.into();
        let gpu = context.on_gpu(engine, points)?;
        Ok(Times {
            gpu: gpu.milliseconds,
            cpu: context.on_cpu(points)?.milliseconds,
            cgal: context.on_cgal(points)?,
            fallback: gpu.stats.fallback.map_or(Value::Null, |why| why.to_string().into()),
        })
    }

    fn speedups(&self) -> [Option<f64>; 2] {
        [Some(self.cpu / self.gpu), self.cgal.map(|cgal| cgal / self.gpu)]
    }

    fn row(&self, name: &str, points: usize) -> [Value; 8] {
        let [cpu, cgal] = self.speedups();
        [
            json!(name),
            json!(points),
            json!(self.gpu),
            json!(self.cpu),
            json!(self.cgal),
            json!(cpu),
            json!(cgal),
            self.fallback.clone(),
        ]
    }
}

const COLUMNS: [&str; 8] = ["input", "points", "gpu, ms", "cpu, ms", "CGAL, ms", "cpu / gpu", "CGAL / gpu", "fallback"];

pub fn run(context: &Context) -> Result<Outcome, Box<dyn Error>> {
    let mut engine = context.engine(Settings::default())?;
    let sizes = context.sizes(&SIZES);
    let mut synthetic = Table::new(COLUMNS);
    let (mut times, mut over_cpu, mut over_cgal) = (Vec::new(), Vec::new(), Vec::new());
    for distribution in DISTRIBUTIONS {
        let measured = sizes
            .iter()
            .map(|&size| Ok((size as f64, Times::take(context, &mut engine, &context.points(distribution, size))?)))
            .collect::<Result<Vec<_>, Box<dyn Error>>>()?;
        let name = distribution.name();
        measured.iter().for_each(|(size, times)| synthetic.push(times.row(name, *size as usize)));
        let line = |of: &dyn Fn(&Times) -> Option<f64>| {
            (name.to_owned(), measured.iter().filter_map(|(size, times)| Some((*size, of(times)?))).collect())
        };
        times.push(line(&|times| Some(times.gpu)));
        over_cpu.push(line(&|times| times.speedups()[0]));
        over_cgal.push(line(&|times| times.speedups()[1]));
    }
    let mut models = Table::new(COLUMNS);
    let mut bars: [Vec<f64>; 2] = Default::default();
    for model in &context.models {
        let times = Times::take(context, &mut engine, &model.cloud)?;
        models.push(times.row(&model.name, model.cloud.points.len()));
        let speedups = times.speedups().map(|speedup| speedup.unwrap_or(0.0));
        bars.iter_mut().zip(speedups).for_each(|(bar, speedup)| bar.push(speedup));
    }
    let lines = |name, title: &str, y, series| {
        Chart::Lines(Lines { name, title: title.to_owned(), x: "points", y, logarithmic: false, series })
    };
    let mut charts = vec![
        lines("time", "GPU engine, running time", "milliseconds", times),
        lines("speedup-cpu", "Speedup over the CPU engine", "times", over_cpu),
    ];
    let [_, cgal] = &bars;
    if over_cgal.iter().any(|(_, points): &(String, Vec<_>)| !points.is_empty()) {
        charts.push(lines("speedup-cgal", "Speedup over CGAL", "times", over_cgal));
    }
    let peer = if cgal.iter().any(|&speedup| speedup > 0.0) { ("CGAL", 1) } else { ("the CPU engine", 0) };
    charts.push(Chart::Bars(Bars {
        name: "models",
        title: format!("Models: speedup over {}", peer.0),
        y: "times",
        groups: context.models.iter().map(|model| model.name.clone()).collect(),
        parts: vec![(format!("over {}", peer.0), bars[peer.1].clone())],
    }));
    Ok(Outcome { tables: vec![synthetic, models], charts })
}
