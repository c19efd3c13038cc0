//! What the host does with the result of Phase 1: star splaying, and the end of the run, which
//! drops the ghosts.
//!
//! `cargo bench --bench splay -- [DISTRIBUTION:POINTS | FILE …]`. A device runs Phase 1 once for
//! each input, with coordinates rounded to `f32`. Prints medians in milliseconds of nine runs after
//! one to warm up, in one thread and in all.

use gdel::{
    Points,
    internals::{
        d3::{
            generate::{Distribution3, generate3d},
            splay::{NearDelaunay3, SplayOutcome, Terms, splay},
            triangulation::Triangulation3,
        },
        gpu::{
            AdapterChoice, Gpu,
            phase1::{Input, Phase1, Phase1Output, Settings},
            start::first_simplex,
        },
        input::lattice::Lattice,
        io::files::read_points,
        parallel::Threads,
        predicates::filter::PredicateContext,
    },
    stats::SplayStats,
};
use pollster::block_on;
use std::{error::Error, path::Path, time::Instant};

/// The number of timed runs.
const RUNS: usize = 9;

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn read(input: &str) -> Result<Vec<[f32; 3]>, Box<dyn Error>> {
    let distribution = input.split_once(':').and_then(|(name, count)| {
        let distribution = Distribution3::ALL.into_iter().find(|distribution| distribution.name() == name)?;
        Some(generate3d(distribution, count.parse().ok()?, 1))
    });
    let points = match distribution {
        Some(points) => points,
        None => Points::from(&read_points(Path::new(input))?.points).iter().collect(),
    };
    Ok(points.into_iter().map(|p| p.map(|x| x as f32)).collect())
}

/// Returns a copy with room at its end for what splaying adds, as the GPU's results have it.
fn copied(tetrahedra: &[[u32; 4]]) -> Vec<[u32; 4]> {
    let mut copy = Vec::with_capacity(tetrahedra.len() + tetrahedra.len() / 64);
    copy.extend_from_slice(tetrahedra);
    copy
}

/// Returns the milliseconds of splaying and of the end, and what splaying did.
fn run(
    points: &[[f32; 3]],
    lattice: &Lattice<3>,
    phase1: &Phase1Output<3>,
    threads: Threads,
) -> Result<(f64, f64, SplayStats), Box<dyn Error>> {
    let near = NearDelaunay3 {
        triangulation: Triangulation3::new(
            copied(&phase1.result.tets),
            copied(&phase1.result.neighbors),
            points.len() as u32,
        ),
        incident: phase1.result.tet_of[..points.len()].to_vec(),
        failed: phase1.result.failed.clone(),
        uncertain: phase1.result.uncertain.iter().map(|&[t, _]| t).collect(),
        // Duplicates stay out, and nothing else shares a place on the lattice in single precision.
        missing: Vec::new(),
    };
    let vertices = PredicateContext::of_input(points.into(), lattice);
    let started = Instant::now();
    let (triangulation, stats) = match splay(&vertices, near, Terms::unlimited(threads))? {
        SplayOutcome::Delaunay(triangulation, stats) => (triangulation, stats),
        SplayOutcome::Aborted(reason) => return Err(format!("splaying aborted: {reason:?}").into()),
    };
    let splayed = started.elapsed().as_secs_f64() * 1e3;
    let started = Instant::now();
    std::hint::black_box(triangulation.into_mesh(None, threads));
    Ok((splayed, started.elapsed().as_secs_f64() * 1e3, stats))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut inputs: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    if inputs.is_empty() {
        inputs = ["uniform:300000", "grid:300000", "sphere:100000"].map(String::from).to_vec();
    }
    let gpu = block_on(Gpu::open(&AdapterChoice::Default))?;
    for input in inputs {
        let points = read(&input)?;
        let lattice = Lattice::fit((&points).into());
        let position = |i: usize| lattice.coordinates(points[i].map(f64::from)).map(|c| c.value);
        let start = first_simplex(lattice.width(), points.len(), position).ok_or("the points are coplanar")?;
        let mut phase1 = block_on(Phase1::new(&gpu, lattice.width()))?;
        block_on(phase1.finish_compiling(&gpu))?;
        let of_points =
            Input { points: (&points).into(), lattice: &lattice, start, starts_later: false, is_uploaded: false };
        let output = block_on(phase1.run(&gpu, of_points, &Settings::default(), None))?;
        for threads in [Threads::One, Threads::All] {
            let (mut splay, mut end, mut did) = (Vec::new(), Vec::new(), SplayStats::default());
            for i in 0..=RUNS {
                let (splayed, ended, stats) = run(&points, &lattice, &output, threads)?;
                if i > 0 {
                    splay.push(splayed);
                    end.push(ended);
                }
                did = stats;
            }
            let (splay, end) = (median(splay), median(end));
            println!("{input}, {} points, threads: {threads:?}: splay {splay:.1}, end {end:.1}; {did:?}", points.len());
        }
    }
    Ok(())
}
