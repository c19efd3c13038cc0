//! What runs in space and in the plane have in common: options in, statistics out.

use std::{ops::ControlFlow, time::Duration};

use js_sys::{Array, Function};
use send_wrapper::SendWrapper;
use wasm_bindgen::prelude::JsValue;

use crate::wasm::objects::object;
use crate::{
    Backend, Progress, Triangulator,
    stats::{GpuStats, Phase, Round, SplayStats, Stats},
};

/// Returns `triangulator` for one run: with the backend of this name, and with `report`, which cancels by returning true.
pub(super) fn for_run(triangulator: &Triangulator, backend: &str, report: Function) -> Triangulator {
    let backend = match backend {
        "gpu" => Backend::Gpu,
        "cpu" => Backend::Cpu,
        _ => Backend::Auto,
    };
    // Nothing moves to another thread: there is none.
    let report = SendWrapper::new(report);
    triangulator.clone().backend(backend).on_progress(move |progress: Progress| {
        let stop = report.call2(&JsValue::NULL, &progress.phase.name().into(), &progress.fraction.into());
        match stop {
            Ok(stop) if stop.is_falsy() => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    })
}

fn milliseconds(time: Duration) -> JsValue {
    (1e3 * time.as_secs_f64()).into()
}

pub(super) fn stats(stats: &Stats) -> JsValue {
    let phase = |&(phase, time): &(Phase, Duration)| {
        object([("name", phase.name().into()), ("milliseconds", milliseconds(time))])
    };
    let phases: Array = stats.phases.iter().map(phase).collect();
    let fallback = stats.fallback.as_ref().map(|why| JsValue::from(why.to_string()));
    object([
        ("engine", stats.backend.name().into()),
        ("why", fallback.unwrap_or(JsValue::NULL)),
        ("phases", phases.into()),
        (
            "exact",
            object([
                ("integer", number(stats.exact.integer)),
                ("expansion", number(stats.exact.expansion)),
                ("symbolic", number(stats.exact.symbolic)),
            ]),
        ),
        ("gpu", stats.gpu.as_ref().map_or(JsValue::NULL, gpu_stats)),
        ("splay", stats.splay.as_ref().map_or(JsValue::NULL, splay_stats)),
    ])
}

fn gpu_stats(stats: &GpuStats) -> JsValue {
    let round = |round: &Round| {
        object([
            ("inserted", round.inserted.into()),
            ("active", round.active.into()),
            ("flips", round.flips.into()),
            ("iterations", round.iterations.into()),
            ("milliseconds", milliseconds(round.time)),
        ])
    };
    let rounds: Array = stats.rounds.iter().map(round).collect();
    object([
        ("rounds", rounds.into()),
        ("flips23", number(stats.flips_23)),
        ("flips32", number(stats.flips_32)),
        ("flipIterations", number(stats.flip_iterations)),
        ("exactTests", number(stats.exact_tests)),
        ("notLocallyDelaunay", number(stats.not_locally_delaunay)),
        ("failedVertices", number(stats.failed_vertices)),
        ("merged", number(stats.merged)),
        ("readbacks", number(stats.readbacks)),
        ("dispatches", number(stats.dispatches)),
        ("submits", number(stats.submits)),
        ("bytes", number(stats.bytes)),
    ])
}

fn splay_stats(stats: &SplayStats) -> JsValue {
    let count = |n: usize| number(n as u64);
    object([
        ("peeled", count(stats.peeled)),
        ("failed", count(stats.failed)),
        ("built", count(stats.built)),
        ("fromPoints", count(stats.from_points)),
        ("pulled", count(stats.pulled)),
        ("flips", count(stats.flips)),
        ("insertions", count(stats.insertions)),
        ("checks", count(stats.checks)),
        ("removed", count(stats.removed)),
        ("added", count(stats.added)),
        ("inserted", count(stats.inserted)),
        ("signs", number(stats.signs)),
        ("rounds", count(stats.rounds)),
    ])
}

/// Counts as JavaScript has them: exact up to 2⁵³.
fn number(count: u64) -> JsValue {
    (count as f64).into()
}
