//! Counts what Phase 1 does on inputs on which flips wait for each other, beside ordinary ones:
//! `cargo bench --features cli --bench measure_rounds -- [PART OF A NAME…]`. Times nothing, so that
//! any adapter will do.
//!
//! Prints a table: rounds that insert, flip iterations, flips, flips per iteration, dispatches,
//! vertices that failed, and flat tetrahedra that are left. A run is given up after ITERATIONS
//! (4,000) flip iterations, marked by `>`.

use gdel::{
    Points,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        dimension::Dimension,
        gpu::{
            AdapterChoice, Gpu,
            layout::Counters,
            phase1::{Finish, Input, Phase1, Run, Settings},
            start::first_simplex,
        },
        input::lattice::{Lattice, Width},
        io::files::read_points,
    },
};
use pollster::block_on;
use std::{error::Error, path::Path};

#[path = "../tests/shared/clouds.rs"]
mod clouds;

/// The kernels for points of either width, once they were needed.
#[derive(Default)]
struct Kernels<const D: usize>([Option<Phase1<D>>; 2])
where
    Dimension<D>: Finish<D>;

impl<const D: usize> Kernels<D>
where
    Dimension<D>: Finish<D>,
{
    fn count(
        &mut self,
        gpu: &Gpu,
        name: &str,
        points: Points<'_, D>,
        extra: impl FnOnce(&<Dimension<D> as Finish<D>>::Result) -> usize,
    ) -> Result<(), Box<dyn Error>> {
        let most = std::env::var("ITERATIONS").ok().and_then(|value| value.parse().ok()).unwrap_or(4000);
        let lattice = Lattice::<D>::fit(points);
        let width = lattice.width();
        let position = |i: usize| lattice.coordinates(points.get(i)).map(|c| c.value);
        let start = first_simplex(width, points.len(), position).ok_or("the points are flat")?;
        let slot = &mut self.0[usize::from(width == Width::Wide)];
        let kernels = match slot {
            Some(kernels) => kernels,
            none => none.insert(block_on(Phase1::new(gpu, width))?),
        };
        block_on(kernels.finish_compiling(gpu))?;
        let input = Input { points, lattice: &lattice, start, starts_later: false, is_uploaded: false };
        let mut run = block_on(Run::new(kernels, gpu, input, Settings::default(), None))?;
        let mut rounds = Vec::new();
        let mut before = Counters::default();
        let mut stopped = false;
        while !stopped && block_on(run.advance())? {
            let now = run.control().1;
            rounds.push((
                now.inserted - before.inserted,
                now.iterations - before.iterations,
                now.flips() - before.flips(),
            ));
            before = now;
            stopped = now.iterations > most;
        }
        let counters = run.control().1;
        let flips = counters.flips();
        let (failed, extra, dispatches) = if stopped {
            (format!("{} of {} inserted", counters.inserted, points.len()), String::new(), String::new())
        } else {
            let output = block_on(run.finish())?;
            let stats = &output.stats;
            (stats.counters.failed.to_string(), extra(&output.result).to_string(), stats.dispatches.to_string())
        };
        let inserting = rounds.iter().filter(|round| round.0 > 0).count();
        println!(
            "| {name} | {} | {}{inserting} | {} | {flips} | {} | {dispatches} | {} | {failed} | {extra} |",
            points.len(),
            if stopped { "> " } else { "" },
            counters.iterations,
            u64::from(flips) / u64::from(counters.iterations.max(1)),
            counters.exact,
        );
        if std::env::var_os("ROUNDS").is_some() {
            println!("{rounds:?}");
        }
        Ok(())
    }
}

type Cloud<const D: usize> = (&'static str, Box<dyn Fn() -> Vec<[f64; D]>>);

fn spatial() -> Vec<Cloud<3>> {
    let random = |distribution, n| move || generate3d(distribution, n, 1);
    let rotated = |points: Vec<[f64; 3]>| -> Vec<[f64; 3]> {
        // The rows of an integer matrix of determinant 27, whose images are no multiples of each
        // other.
        points
            .into_iter()
            .map(|[x, y, z]| [2.0 * x - y + 2.0 * z, 2.0 * x + 2.0 * y - z, -x + 2.0 * y + 2.0 * z])
            .collect()
    };
    vec![
        ("uniform", Box::new(random(Distribution3::Uniform, 10_000))),
        ("Gaussian", Box::new(random(Distribution3::Gaussian, 10_000))),
        ("thin sphere", Box::new(random(Distribution3::ThinSphere, 10_000))),
        ("sphere", Box::new(random(Distribution3::Sphere, 10_000))),
        ("lattice 512³", Box::new(random(Distribution3::Grid, 10_000))),
        ("survey", Box::new(|| clouds::survey(10_000))),
        ("clusters", Box::new(|| clouds::clusters_at_1e_9_spacing(5_000))),
        (
            "bunny",
            Box::new(|| {
                Points::from(&read_points(Path::new("tests/data/bunny.ply")).expect("it is there").points)
                    .iter()
                    .collect()
            }),
        ),
        ("raster, whole heights", Box::new(|| clouds::raster(120, 1.0))),
        ("raster, heights in 1/8", Box::new(|| clouds::raster(120, 0.125))),
        ("raster, unrounded", Box::new(|| clouds::raster(120, 0.0))),
        ("terrain", Box::new(|| clouds::terrain(120, 0.7, 0.0))),
        ("terrain, whole heights", Box::new(|| clouds::terrain(120, 0.7, 1.0))),
        ("terrain with a straight border", Box::new(|| clouds::terrain(120, 0.0, 0.0))),
        ("terrain with a straight border, whole heights", Box::new(|| clouds::terrain(120, 0.0, 1.0))),
        ("raster, shuffled", Box::new(|| clouds::shuffled(&clouds::raster(120, 1.0), 1))),
        ("raster, tilted", Box::new(move || rotated(clouds::raster(120, 1.0)))),
        ("full grid 22³", Box::new(|| clouds::grid(22))),
        ("full grid 32³", Box::new(|| clouds::grid(32))),
        ("full grid 22³, shuffled", Box::new(|| clouds::shuffled(&clouds::grid(22), 1))),
        ("full grid 22³, tilted", Box::new(move || rotated(clouds::grid(22)))),
        ("flat ground", Box::new(|| clouds::flat_ground(5_000))),
        ("two skew lines", Box::new(|| clouds::two_skew_lines(300))),
        ("two skew lines, longer", Box::new(|| clouds::two_skew_lines(1500))),
        ("moment curve", Box::new(|| clouds::moment_curve(1000))),
        ("circle and axis", Box::new(|| clouds::circle_and_its_axis(400))),
        ("cylinder", Box::new(|| clouds::cylinder(1000))),
    ]
}

fn plane() -> Vec<Cloud<2>> {
    let random = |distribution, n| move || generate2d(distribution, n, 1);
    let grid = |side: u32| -> Vec<[f64; 2]> { (0..side * side).map(|i| [i % side, i / side].map(f64::from)).collect() };
    let slanted = |points: Vec<[f64; 2]>| -> Vec<[f64; 2]> {
        points.into_iter().map(|[x, y]| [3.0 * x - y, x + 3.0 * y]).collect()
    };
    vec![
        ("2D uniform", Box::new(random(Distribution2::Uniform, 10_000))),
        ("2D circle", Box::new(random(Distribution2::Circle, 10_000))),
        ("2D thin circle", Box::new(random(Distribution2::ThinCircle, 10_000))),
        ("2D lattice 512²", Box::new(random(Distribution2::Grid, 10_000))),
        ("2D clusters", Box::new(random(Distribution2::Clusters, 10_000))),
        ("2D grid 100²", Box::new(move || grid(100))),
        ("2D grid 100², slanted", Box::new(move || slanted(grid(100)))),
        ("2D ribbon", Box::new(|| (0..10_000).map(|i| [i % 5000, i / 5000].map(f64::from)).collect())),
        ("2D two lines, random", Box::new(random(Distribution2::TwoLines, 16_000))),
        (
            "2D line and a point",
            Box::new(|| (0..10_000).map(|i| [f64::from(i), 0.0]).chain([[3000.0, 5000.0]]).collect()),
        ),
        ("2D saw", Box::new(|| (0..10_000).map(|i| [f64::from(i), f64::from(5 * (i % 2) * (i % 10))]).collect())),
    ]
}

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo bench` adds `--bench`.
    let parts: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let wanted = |name: &str| parts.is_empty() || parts.iter().any(|part| name.contains(&**part));
    let gpu = block_on(Gpu::open(&AdapterChoice::Default))?;
    println!(
        "| input | points | rounds | flip iterations | flips | flips per iteration | dispatches | exact signs | failed vertices | flat |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut kernels = Kernels::default();
    for (name, cloud) in spatial().into_iter().filter(|(name, _)| wanted(name)) {
        kernels.count(&gpu, name, (&cloud()).into(), |near| {
            near.uncertain.iter().filter(|[_, what]| what & 16 != 0).count()
        })?;
    }
    let mut kernels = Kernels::default();
    for (name, cloud) in plane().into_iter().filter(|(name, _)| wanted(name)) {
        kernels.count(&gpu, name, (&cloud()).into(), |near| near.mesh.hull.len())?;
    }
    Ok(())
}
