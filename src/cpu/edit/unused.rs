//! Runs from scratch on the points of a mesh that are used.

use crate::{
    cpu::{Incremental, MIN_SHARED, MeshOf, delaunay},
    dimension::Dimension,
    error::Error,
    index::NONE,
    input::points::Points,
    mesh::MeshInfo,
    options::Options,
    parallel,
    stats::{Restart, UpdateStats},
};
use std::num::NonZeroUsize;

/// Why the points of a mesh have to be triangulated from scratch, and which of them are unused.
#[derive(Debug)]
pub struct Again {
    /// Why the mesh was not changed.
    pub why: Restart,
    /// For the points that are unused, their own index, as in the field of a mesh.
    unused: Vec<u32>,
}

impl Again {
    pub(super) fn new(why: Restart, unused: Vec<u32>) -> Self {
        Again { why, unused }
    }

    /// Returns the points that are used; `None` if all are.
    pub fn used<const D: usize>(&self, points: Points<'_, D>) -> Option<Used<D>> {
        Used::of(points, &self.unused)
    }
}

/// The points of a mesh that are used.
#[derive(Debug)]
pub struct Used<const D: usize> {
    /// Their indices, ascending.
    names: Vec<u32>,
    /// Their coordinates.
    points: Vec<[f64; D]>,
    /// The number of all points.
    all: usize,
}

impl<const D: usize> Used<D> {
    /// Returns the used ones of these points, given the field `duplicate_of` of their mesh; `None` if
    /// all are.
    pub fn of(points: Points<'_, D>, duplicate_of: &[u32]) -> Option<Self> {
        let is_unused = |i: u32| duplicate_of.get(i as usize) == Some(&i);
        let all = points.len();
        if !(0..all as u32).any(is_unused) {
            return None;
        }
        let names: Vec<u32> = (0..all as u32).filter(|&i| !is_unused(i)).collect();
        let points = names.iter().map(|&i| points.get(i as usize)).collect();
        Some(Used { names, points, all })
    }

    /// Returns the points.
    pub fn points(&self) -> Points<'_, D> {
        Points::F64(&self.points)
    }

    /// Makes the mesh of these points that of all points, with at most `threads` threads.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Threads`].
    pub fn restore(&self, mesh: &mut (impl MeshInfo + Send), threads: Option<NonZeroUsize>) -> Result<(), Error> {
        let mut duplicate_of: Vec<u32> = (0..self.all as u32).collect();
        for (&name, &first) in self.names.iter().zip(mesh.duplicate_of()) {
            duplicate_of[name as usize] = if first == NONE { NONE } else { self.names[first as usize] };
        }
        let threads = if self.all < MIN_SHARED { Some(NonZeroUsize::MIN) } else { threads };
        parallel::with_threads(threads, |threads| {
            mesh.rename(threads, &self.names);
            Ok(())
        })?;
        mesh.set_input(duplicate_of, mesh.dimension());
        Ok(())
    }
}

/// Triangulates the used points by the CPU engine, as [`Triangulator`](crate::Triangulator) does by
/// any.
///
/// # Errors
///
/// Returns the errors of [`delaunay`](crate::cpu::delaunay).
pub fn delaunay_of_used<const D: usize>(
    points: Points<'_, D>,
    used: Option<&Used<D>>,
    why: Restart,
    options: &Options,
) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Incremental<D>,
{
    let mut mesh = delaunay(used.map_or(points, Used::points), options)?;
    if let Some(used) = used {
        used.restore(&mut mesh, options.threads)?;
    }
    mesh.stats_mut().update = Some(UpdateStats::from_scratch(why));
    Ok(mesh)
}
