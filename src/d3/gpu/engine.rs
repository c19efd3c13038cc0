//! The engine `gpu`: Phase 1 on the device, Phase 2 on the CPU (the paper's §3).
//!
//! `points → lattice → Phase 1 → what it may have missed → splay → drop the ghosts → input indices → mesh`

use crate::{
    Error, Mesh3, Options, Points,
    d3::{
        cpu,
        gpu::{
            phase1::{Input, Phase1, Phase1Output, Settings},
            run::Run,
            start::first_tetrahedron,
            trace::Tracer,
        },
        splay::{self, Aborted, NearDelaunay, SplayOutcome},
        triangulation::{FiniteMesh, Triangulation},
    },
    gpu::Gpu,
    index::NONE,
    input::{
        lattice::{Lattice, Width},
        order::missing_points,
    },
    parallel::Threads,
    predicates::filter::PredicateContext,
    stats::{Fallback, Stats, Stopwatch},
};

/// A device with the kernels of Phase 1 compiled for it: make one and use it for many inputs.
#[derive(Debug)]
pub struct Hybrid {
    gpu: Gpu,
    wide: Phase1,
    /// For points that the narrow lattice holds, once there were some: compiling takes long.
    narrow: Option<Phase1>,
    settings: Settings,
}

impl Hybrid {
    /// Compiles the kernels for `gpu`.
    ///
    /// # Errors
    ///
    /// As [`Gpu::with_error_scope`].
    pub async fn new(gpu: Gpu) -> Result<Self, Error> {
        let wide = Phase1::new(&gpu, Width::Wide).await?;
        Ok(Hybrid { gpu, wide, narrow: None, settings: Settings::default() })
    }

    /// The same with other settings for Phase 1, for experiments: they change the time, and not the mesh.
    pub fn with_settings(self, settings: Settings) -> Self {
        Hybrid { settings, ..self }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The triangulation of `points`: the same set of tetrahedra as every engine's.
    ///
    /// Input that is no work for a device, because its points are coplanar or nearly so, and input on which splaying
    /// gives up, is left to the CPU engine; [`Stats::fallback`] then says why.
    ///
    /// # Errors
    ///
    /// As for [`delaunay3d`](crate::delaunay3d), and those of the device.
    pub async fn delaunay3d(&mut self, points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
        let options = &options.monotone();
        let mut stopwatch = Stopwatch::start();
        options.report("lattice", 0.0)?;
        points.validate_by(Threads::All)?;
        let lattice = Lattice::fit_by(Threads::All, points);
        let position = |i: usize| lattice.coordinates(points.get(i)).map(|c| c.value);
        let Some(start) = first_tetrahedron(lattice.width(), points.len(), position) else {
            return fall_back(points, options, Fallback::Coplanar, Stats::default());
        };
        let mut stats = Stats { engine: "gpu", ..Stats::default() };
        let mut tracer = options.trace.then(Tracer::default);
        stats.phases.push(("lattice", stopwatch.lap()));

        options.report("phase 1", 0.05)?;
        // Points of the other width are likely to come never again, or not soon.
        let phase1 = match lattice.width() {
            Width::Narrow => {
                self.wide.release();
                match &mut self.narrow {
                    Some(narrow) => narrow,
                    none => none.insert(Phase1::new(&self.gpu, Width::Narrow).await?),
                }
            }
            Width::Wide => {
                if let Some(narrow) = &mut self.narrow {
                    narrow.release();
                }
                &mut self.wide
            }
        };
        let input = Input { points, lattice: &lattice, start };
        let mut run = Run::new(phase1, &self.gpu, input, self.settings, None).await?;
        loop {
            let more = run.round().await?;
            if let Some(tracer) = &mut tracer {
                tracer.round(&self.gpu, &run).await?;
            }
            let inserted = 1.0 - f64::from(run.waiting()) / points.len() as f64;
            options.report("phase 1", 0.05 + 0.6 * inserted)?;
            if !more {
                break;
            }
            if run.control().1.iterations > self.settings.max_iterations {
                return fall_back(points, options, Fallback::Flips, stats);
            }
        }
        let output = run.finish().await?;
        stats.gpu = Some(output.stats.summary(&self.gpu.adapter().name));
        let readback = output.stats.readback_milliseconds / 1e3;
        stats.phases.push(("phase 1", stopwatch.lap() - readback));
        stats.phases.push(("readback", readback));

        options.report("splay", 0.8)?;
        let vertices = PredicateContext::of_input(points, &lattice);
        let (near, duplicate_of) = near_delaunay(points, output);
        if let Some(tracer) = &mut tracer {
            tracer.facets(&near.triangulation, &vertices);
        }
        let max_evaluations = near.evaluations_from_scratch();
        let report = |share: f64| options.report("splay", 0.8 + 0.15 * share);
        let triangulation = match splay::splay(&vertices, near, max_evaluations, Threads::All, &report)? {
            SplayOutcome::Delaunay(triangulation, splay) => {
                stats.splay = Some(splay);
                triangulation
            }
            SplayOutcome::Aborted(Aborted::BudgetExceeded) => return fall_back(points, options, Fallback::Work, stats),
            SplayOutcome::Aborted(Aborted::Inconsistent(what)) => {
                return fall_back(points, options, Fallback::Inconsistent(what), stats);
            }
        };
        stats.phases.push(("splay", stopwatch.lap()));

        options.report("finish", 0.95)?;
        stats.exact = vertices.exact_counts();
        let FiniteMesh { tetrahedra, neighbors, hull } = triangulation.into_mesh(None, Threads::All);
        stats.phases.push(("finish", stopwatch.lap()));
        stats.trace = tracer.map(|tracer| tracer.finish(&tetrahedra));
        options.report("finish", 1.0)?;
        Ok(Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension: 3, stats })
    }
}

/// The CPU engine's mesh, with what the GPU did before.
fn fall_back(points: Points<'_>, options: &Options, why: Fallback, before: Stats) -> Result<Mesh3, Error> {
    let mut mesh = cpu::delaunay3d(points, options)?;
    mesh.stats = Stats { fallback: Some(why), gpu: before.gpu, ..mesh.stats };
    Ok(mesh)
}

/// The result of Phase 1 in the form that splaying takes, and what duplicates what.
fn near_delaunay(points: Points<'_>, output: Phase1Output) -> (NearDelaunay, Vec<i32>) {
    let Phase1Output { tets, neighbors, failed, tet_of: mut incident, merged, uncertain, .. } = output;
    let mut duplicate_of = vec![NONE; points.len()];
    let missing = missing_points(points, &merged, &mut duplicate_of);
    let missing = missing.into_iter().map(|[i, _]| i).collect();
    incident.truncate(points.len());
    let triangulation = Triangulation::new(tets, neighbors, points.len() as u32);
    let uncertain = uncertain.into_iter().map(|[t, _]| t).collect();
    (NearDelaunay { triangulation, incident, failed, uncertain, missing }, duplicate_of)
}
