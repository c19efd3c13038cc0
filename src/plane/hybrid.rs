//! The engine `gpu` in the plane: the paper's Phase 1 on the device, and on the CPU exact edge flips for what the lattice
//! leaves open (§5.6).
//!
//! `points → lattice → device → input indices → mesh`, or, where rounding leaves something open,
//! `points → lattice → device → flips → missing points → mesh`

use super::{
    Mesh2, Triangulation2,
    lawson::{self, GaveUp, NearDelaunay2, Outcome},
};
use crate::{
    Error, Options, Points2, cpu,
    gpu::{
        Gpu,
        plane::{Answer, Input, Mesh, Plane, PlaneOutput, Run, Settings, Unproven, start::first_triangle},
    },
    hybrid::missing_points,
    lattice::{Lattice, Width},
    mesh::NONE,
    parallel,
    predicates::vertices::Vertices2,
    stats::{Fallback, Stats, Stopwatch},
};

/// A device with the kernels of the plane compiled for it: make one and use it for many inputs.
#[derive(Debug)]
pub struct Hybrid2 {
    gpu: Gpu,
    narrow: Plane,
    wide: Plane,
}

/// Triangles, half-edges and hull, as [`Mesh2`] has them.
type Parts = (Vec<[u32; 3]>, Vec<[i32; 3]>, Vec<u32>);

impl Hybrid2 {
    /// Compiles the kernels for `gpu`.
    ///
    /// # Errors
    ///
    /// As [`Gpu::catching`].
    pub async fn new(gpu: Gpu) -> Result<Self, Error> {
        let narrow = Plane::new(&gpu, Width::Narrow).await?;
        let wide = Plane::new(&gpu, Width::Wide).await?;
        Ok(Hybrid2 { gpu, narrow, wide })
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
        let threads = parallel::available();
        points.validate_in_threads(threads)?;
        let lattice = Lattice::fit_in_threads(threads, points);
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
                &mut self.narrow
            }
            Width::Wide => {
                self.narrow.release();
                &mut self.wide
            }
        };
        let input = Input { points, lattice: &lattice, start };
        let mut run = Run::new(plane, &self.gpu, input, *settings, None).await?;
        while run.round().await? {
            let inserted = 1.0 - f64::from(run.waiting()) / points.len() as f64;
            options.report("phase 1", 0.05 + 0.7 * inserted)?;
        }
        let PlaneOutput { answer, united, stats: device } = run.finish().await?;
        stats.gpu = Some(device.summary(&self.gpu.adapter().name));
        let readback = device.readback_milliseconds / 1e3;
        stats.phases.push(("phase 1", stopwatch.lap() - readback));
        stats.phases.push(("readback", readback));

        options.report("finish", 0.8)?;
        let mut duplicate_of = vec![NONE; points.len()];
        let missing = missing_points(points, &united, &mut duplicate_of);
        let (triangles, halfedges, hull) = match answer {
            Answer::Proven(mesh) => proven(mesh, points.len()),
            Answer::Unproven(unproven) => {
                let report = |share: f64| options.report("flip", 0.8 + 0.15 * share);
                let vertices = Vertices2::of_input(points, &lattice);
                let near = near_delaunay(&vertices, unproven, &missing);
                // As many as the CPU engine would take from nothing.
                let most_flips = 3 * points.len() as u64;
                let mesh = match lawson::lawson(&vertices, near, most_flips, &report)? {
                    Outcome::Delaunay(mesh, _) => mesh,
                    Outcome::GaveUp(GaveUp::Work) => return fall_back(points, options, Fallback::Flips, stats),
                    Outcome::GaveUp(GaveUp::Folded) => return fall_back(points, options, Fallback::Folded, stats),
                };
                stats.exact = vertices.exact_counts();
                stats.phases.push(("flip", stopwatch.lap()));
                mesh.into_mesh(&(0..points.len() as u32).collect::<Vec<_>>())
            }
        };
        stats.phases.push(("finish", stopwatch.lap()));
        options.report("finish", 1.0)?;
        Ok(Mesh2 { triangles, halfedges, hull, duplicate_of, dimension: 2, stats })
    }
}

/// The CPU engine's mesh, with what the GPU did before.
fn fall_back(points: Points2<'_>, options: &Options, why: Fallback, before: Stats) -> Result<Mesh2, Error> {
    let mut mesh = super::delaunay2d_in_order(points, options, cpu::Order::default())?;
    mesh.stats = Stats { fallback: Some(why), gpu: before.gpu, ..mesh.stats };
    Ok(mesh)
}

/// What the device gives is the answer but for the order of the hull.
fn proven(mesh: Mesh, points: usize) -> Parts {
    let Mesh { triangles, halfedges, hull: edges } = mesh;
    let mut next = vec![u32::MAX; points];
    for &[from, to] in &edges {
        next[from as usize] = to;
    }
    let mut hull = Vec::with_capacity(edges.len());
    if let Some(lowest) = edges.iter().map(|&[from, _]| from).min() {
        hull.push(lowest);
        hull.extend(
            std::iter::successors(Some(next[lowest as usize]), |&v| Some(next[v as usize])).take(edges.len() - 1),
        );
    }
    (triangles, halfedges, hull)
}

/// The device's result in the form that flipping takes. `missing` are points that are no vertices, each with the one that
/// stands for it.
fn near_delaunay(vertices: &Vertices2<'_>, unproven: Unproven, missing: &[[u32; 2]]) -> NearDelaunay2 {
    let Unproven { triangles, neighbors, doubtful } = unproven;
    let infinite = vertices.len() as u32;
    let mut start_of = rustc_hash::FxHashMap::default();
    start_of.extend(missing.iter().map(|&[_, representative]| (representative, 0)));
    let mut doubtful: Vec<u32> = doubtful.into_iter().map(|[t, _]| t).collect();
    for (t, &[a, b, c]) in (0..).zip(&triangles) {
        if ![a, b, c].contains(&infinite) && vertices.orient2d(a, b, c) <= 0 {
            doubtful.push(t);
        }
        if !start_of.is_empty() {
            for v in [a, b, c] {
                start_of.entry(v).and_modify(|start| *start = t);
            }
        }
    }
    doubtful.sort_unstable();
    doubtful.dedup();
    NearDelaunay2 {
        triangulation: Triangulation2::new(triangles, neighbors, infinite),
        doubtful,
        missing: missing.iter().map(|&[i, representative]| (i, start_of[&representative])).collect(),
    }
}
