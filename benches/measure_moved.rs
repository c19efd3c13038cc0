//! Times meshes that follow their points, in a program that does nothing else:
//! `cargo bench --bench measure_moved -- [DIMENSION] [POINTS] [SHARE] [STEPS]`.
//!
//! All points move, each time by a normal distribution of SHARE (0.002) times their mean spacing; the
//! mesh stays on the device. Prints a line of JSON: the median of the last STEPS (15) of two updates
//! more, in milliseconds, and all of them; the same for as many runs from scratch; and why updates began
//! anew. With EDIT, as many points as one in EDIT (1000) of a mesh in the memory of the host
//! are inserted, and then removed, by the CPU backend.

use gdel::{Backend, DeviceMesh, Error, Moving, Triangulator};
use rand::{RngExt, SeedableRng, rngs::StdRng};
use std::{array, env, error, f64::consts::TAU, time::Instant};

/// The runs before those that are timed.
const TO_WARM_UP: usize = 2;

/// The arguments.
struct Task {
    points: usize,
    share: f64,
    steps: usize,
}

fn main() -> Result<(), Box<dyn error::Error>> {
    // `cargo bench` adds `--bench`.
    let arguments: Vec<String> = env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let argument = |i: usize, default: &str| arguments.get(i).cloned().unwrap_or(default.to_owned());
    let task = Task {
        points: argument(1, "100000").parse()?,
        share: argument(2, "0.002").parse()?,
        steps: argument(3, "15").parse()?,
    };
    let edits = env::var("EDIT").ok().map(|edit| edit.parse::<usize>()).transpose()?;
    match (argument(0, "3").as_str(), edits) {
        ("2", Some(share)) => edit(&task, share, |triangulator, points: &[[f64; 2]]| triangulator.delaunay2d(points)),
        ("2", None) => {
            follow::<2>(&task, |triangulator, points: &[[f64; 2]]| triangulator.delaunay2d_on_device(points))
        }
        (_, Some(share)) => edit(&task, share, |triangulator, points: &[[f64; 3]]| triangulator.delaunay3d(points)),
        (_, None) => follow::<3>(&task, |triangulator, points: &[[f64; 3]]| triangulator.delaunay3d_on_device(points)),
    }?;
    Ok(())
}

/// Times updates of a mesh on the device, which `scratch` makes.
fn follow<const D: usize>(
    task: &Task,
    scratch: impl Fn(&Triangulator, &[[f64; D]]) -> Result<DeviceMesh<D>, Error>,
) -> Result<(), Error>
where
    DeviceMesh<D>: Moving,
    for<'a> <DeviceMesh<D> as Moving>::Points<'a>: From<&'a [[f64; D]]>,
{
    let Task { points, share, steps } = *task;
    let mut random = StdRng::seed_from_u64(1);
    let mut at = uniform::<D>(&mut random, points);
    let displacement = share * (points as f64).powf(-1.0 / D as f64);
    let triangulator = Triangulator::new().backend(Backend::Gpu);
    let mut mesh = scratch(&triangulator, &at)?;
    let (mut updates, mut scratches, mut anew) = (Vec::new(), Vec::new(), Vec::new());
    let mut displace = |at: &mut [[f64; D]]| {
        for x in at.as_flattened_mut() {
            *x += displacement * gaussian(&mut random);
        }
    };
    for _ in 0..TO_WARM_UP + steps {
        displace(&mut at);
        let began = Instant::now();
        triangulator.update(&mut mesh, &at[..])?;
        updates.push(milliseconds(began));
        anew.extend(mesh.stats().update.and_then(|update| update.restarted).map(|why| why.name()));
    }
    for _ in 0..TO_WARM_UP + steps {
        // The device has as long a pause before.
        displace(&mut at);
        let began = Instant::now();
        scratch(&triangulator, &at)?;
        scratches.push(milliseconds(began));
    }
    println!(
        "{{\"dimension\":{D},\"points\":{points},\"share\":{share},\"update\":{},\"scratch\":{},\"anew\":{anew:?}}}",
        times(updates),
        times(scratches),
    );
    Ok(())
}

/// Times insertion into a mesh in the memory of the host, which `scratch` makes, and removal, of one in
/// `share` points.
fn edit<const D: usize, M: Moving>(
    task: &Task,
    share: usize,
    scratch: impl Fn(&Triangulator, &[[f64; D]]) -> Result<M, Error>,
) -> Result<(), Error>
where
    for<'a> M::Points<'a>: From<&'a [[f64; D]]>,
{
    let Task { points, steps, .. } = *task;
    let mut random = StdRng::seed_from_u64(1);
    let at = uniform::<D>(&mut random, points);
    let few = points / share.max(1);
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    let (mut inserts, mut removes, mut scratches) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..TO_WARM_UP + steps {
        let began = Instant::now();
        let mut mesh = scratch(&triangulator, &at)?;
        scratches.push(milliseconds(began));
        let all = [at.clone(), uniform(&mut random, few)].concat();
        let began = Instant::now();
        triangulator.insert(&mut mesh, &all[..])?;
        inserts.push(milliseconds(began));
        let removed: Vec<u32> = (points as u32..all.len() as u32).collect();
        let began = Instant::now();
        triangulator.remove(&mut mesh, &all[..], &removed)?;
        removes.push(milliseconds(began));
    }
    println!(
        "{{\"dimension\":{D},\"points\":{points},\"edited\":{few},\"insert\":{},\"remove\":{},\"scratch\":{}}}",
        times(inserts),
        times(removes),
        times(scratches),
    );
    Ok(())
}

fn uniform<const D: usize>(random: &mut StdRng, count: usize) -> Vec<[f64; D]> {
    (0..count).map(|_| array::from_fn(|_| random.random())).collect()
}

/// Returns a normally distributed number.
fn gaussian(random: &mut StdRng) -> f64 {
    let (u, v) = (1.0 - random.random::<f64>(), random.random::<f64>());
    (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
}

fn milliseconds(began: Instant) -> f64 {
    1e3 * began.elapsed().as_secs_f64()
}

/// Returns the median of the times after those to warm up, and these times.
fn times(all: Vec<f64>) -> String {
    let timed: Vec<f64> = all.into_iter().skip(TO_WARM_UP).collect();
    let mut sorted = timed.clone();
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
    let timed: Vec<String> = timed.iter().map(|ms| format!("{ms:.2}")).collect();
    format!("{{\"median\":{median:.2},\"all\":[{}]}}", timed.join(","))
}
