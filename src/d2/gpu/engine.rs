//! The engine `gpu` in the plane: the paper's Phase 1 on the device, and on the CPU exact edge flips for what the lattice
//! leaves open (§5.6).
//!
//! `points → lattice → device → signs that rounding leaves open → mesh`, or, where one of these is not what the lattice made
//! of it, `points → lattice → device → open signs → flips → missing points → mesh`

use crate::d2::{
    Mesh2, Triangulation2, cpu,
    gpu::certify::{failed_tests, near_delaunay},
    lawson::{self, Aborted, LawsonOutcome},
};
use crate::{
    Error, Options, Points2,
    d2::gpu::{
        phase1::{Input, Mesh, Plane, PlaneOutput, Settings},
        run::Run,
        start::first_triangle,
    },
    gpu::Gpu,
    index::NONE,
    input::{
        lattice::{Lattice, Width},
        order::missing_points,
    },
    parallel::Threads,
    predicates::filter::PredicateContext2,
    stats::{Fallback, Stats, Stopwatch},
};

/// A device with the kernels of the plane compiled for it: make one and use it for many inputs.
#[derive(Debug)]
pub struct Hybrid2 {
    gpu: Gpu,
    wide: Plane,
    /// For points that the narrow lattice holds, once there were some: compiling takes long.
    narrow: Option<Plane>,
}

impl Hybrid2 {
    /// Compiles the kernels for `gpu`.
    ///
    /// # Errors
    ///
    /// As [`Gpu::with_error_scope`].
    pub async fn new(gpu: Gpu) -> Result<Self, Error> {
        let wide = Plane::new(&gpu, Width::Wide).await?;
        Ok(Hybrid2 { gpu, wide, narrow: None })
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The triangulation of `points`: the same set of triangles as every engine's.
    ///
    /// Input that is no work for a device, because its points are collinear or nearly so, and input that rounding has
    /// folded over itself, is left to the CPU engine; [`Stats::fallback`] then says why.
    ///
    /// # Errors
    ///
    /// As for [`delaunay2d`](crate::delaunay2d), and those of the device.
    pub async fn delaunay2d(&mut self, points: Points2<'_>, options: &Options) -> Result<Mesh2, Error> {
        self.delaunay2d_with(points, options, &Settings::default()).await
    }

    /// The same with settings of choice, on which the set of triangles does not depend.
    ///
    /// # Errors
    ///
    /// As for [`Hybrid2::delaunay2d`].
    pub async fn delaunay2d_with(
        &mut self,
        points: Points2<'_>,
        options: &Options,
        settings: &Settings,
    ) -> Result<Mesh2, Error> {
        let options = &options.monotone();
        let mut stopwatch = Stopwatch::start();
        options.report("lattice", 0.0)?;
        points.validate_by(Threads::All)?;
        let lattice = Lattice::fit_by(Threads::All, points);
        let position = |i: usize| lattice.coordinates(points.get(i)).map(|c| c.value);
        let Some(start) = first_triangle(points.len(), position) else {
            return fall_back(points, options, Fallback::Collinear, Stats::default());
        };
        let mut stats = Stats { engine: "gpu", ..Stats::default() };
        stats.phases.push(("lattice", stopwatch.lap()));

        options.report("phase 1", 0.05)?;
        // Points of the other width are likely to come never again, or not soon.
        let plane = match lattice.width() {
            Width::Narrow => {
                self.wide.release();
                match &mut self.narrow {
                    Some(narrow) => narrow,
                    none => none.insert(Plane::new(&self.gpu, Width::Narrow).await?),
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
        let mut run = Run::new(plane, &self.gpu, input, *settings, None).await?;
        while run.round().await? {
            if run.control().1.iterations > settings.max_iterations {
                return fall_back(points, options, Fallback::Flips, stats);
            }
            let inserted = 1.0 - f64::from(run.waiting()) / points.len() as f64;
            options.report("phase 1", 0.05 + 0.7 * inserted)?;
        }
        let PlaneOutput { mesh, questions, merged, stats: device } = run.finish().await?;
        stats.gpu = Some(device.summary(&self.gpu.adapter().name));
        let readback = device.readback_milliseconds / 1e3;
        stats.phases.push(("phase 1", stopwatch.lap() - readback));
        stats.phases.push(("readback", readback));

        options.report("finish", 0.8)?;
        let mut duplicate_of = vec![NONE; points.len()];
        let missing = missing_points(points, &merged, &mut duplicate_of);
        let mut wrong = questions;
        if let Some(questions) = wrong.as_mut().filter(|questions| !questions.is_empty()) {
            (*questions, stats.exact) = failed_tests(points, &lattice, questions);
            stats.phases.push(("check", stopwatch.lap()));
        }
        let Mesh { mut triangles, mut halfedges, hull } = mesh;
        let mut hull = in_order(&hull, points.len());
        if !missing.is_empty() || !wrong.as_ref().is_some_and(Vec::is_empty) {
            let report = |share: f64| options.report("flip", 0.8 + 0.15 * share);
            let vertices = PredicateContext2::of_input(points, &lattice);
            let triangulation = Triangulation2::from_mesh(triangles, halfedges, &hull, points.len() as u32);
            let near = near_delaunay(triangulation, wrong.as_deref(), &missing);
            // As many as the CPU engine would take from nothing.
            let max_flips = 3 * points.len() as u64;
            let triangulation = match lawson::lawson(&vertices, near, max_flips, &report)? {
                LawsonOutcome::Delaunay(triangulation, _) => triangulation,
                LawsonOutcome::Aborted(Aborted::BudgetExceeded) => {
                    return fall_back(points, options, Fallback::Flips, stats);
                }
                LawsonOutcome::Aborted(Aborted::Folded) => return fall_back(points, options, Fallback::Folded, stats),
            };
            stats.exact = stats.exact + vertices.exact_counts();
            (triangles, halfedges, hull) = triangulation.into_mesh(&(0..points.len() as u32).collect::<Vec<_>>());
            stats.phases.push(("flip", stopwatch.lap()));
        }
        stats.phases.push(("finish", stopwatch.lap()));
        options.report("finish", 1.0)?;
        Ok(Mesh2 { triangles, halfedges, hull, duplicate_of, dimension: 2, stats })
    }
}

/// The CPU engine's mesh, with what the GPU did before.
fn fall_back(points: Points2<'_>, options: &Options, why: Fallback, before: Stats) -> Result<Mesh2, Error> {
    let mut mesh = cpu::delaunay2d(points, options)?;
    mesh.stats = Stats { fallback: Some(why), gpu: before.gpu, ..mesh.stats };
    Ok(mesh)
}

/// The vertices of the hull, from the lowest index, by its edges.
fn in_order(edges: &[[u32; 2]], points: usize) -> Vec<u32> {
    let mut next = vec![u32::MAX; points];
    for &[from, to] in edges {
        next[from as usize] = to;
    }
    let lowest = edges.iter().map(|&[from, _]| from).min();
    std::iter::successors(lowest, |&v| Some(next[v as usize])).take(edges.len()).collect()
}
