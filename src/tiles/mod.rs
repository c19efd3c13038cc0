//! Triangulations of points that are split into tiles, for more points than one memory holds, and for machines or
//! workers that share none.
//!
//! `survey → plan → tiles → steps, in which tiles send each other points → parts → mesh`
//!
//! Each [`Tile`] triangulates its own points, and gets to know those of others that its simplices depend on (Tile & Merge:
//! Caraffa, Memari, Yirci and Brédif 2019; Brédif, Caraffa, Yirci and Memari 2020). Ties are broken by the index in the
//! whole input, so every tile computes the same simplices where it knows the same points, and nothing has to be
//! stitched.

mod border;
mod bytes;
mod core;
mod d2;
mod d3;
mod dim;
mod message;
mod part;
mod piece;
mod plan;
mod proof;
mod state;
mod survey;
mod tile;

pub use core::Core;
pub use dim::{Provable, Tiled};
pub use message::Message;
pub use part::{BorderFacet, Part, Seam, join, links};
pub use piece::{Link, Piece, Rim};
pub use plan::Plan;
pub use proof::Proof;
pub use survey::{Indexed, Survey};
pub use tile::Tile;

use crate::{
    backend::Backend,
    cpu::{self, MeshOf},
    dimension::Dimension,
    error::Error,
    geometry::{Euclidean, Geometry},
    input::points::Points,
    mesh::MeshInfo,
    options::Options,
    stats::Stats,
};
use std::sync::Arc;

/// Triangulates `points` in this many tiles, of which each knows one of `every` points from the start, one after the
/// other.
///
/// # Errors
///
/// Returns the errors of [`delaunay3d`](crate::delaunay3d) that are not a GPU's.
#[doc(hidden)]
pub fn delaunay<const D: usize, const N: usize>(
    points: Points<'_, D>,
    tiles: u32,
    every: u32,
    options: &Options,
) -> Result<(MeshOf<D>, Traffic), Error>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let plan = Arc::new(Plan::new(Survey::new(points, 0, every)?, tiles));
    if usize::from(plan.dimension()) < D {
        return Ok((cpu::delaunay(points, options)?, Traffic::default()));
    }
    let own = plan.split(points, 0);
    let mut all = Vec::new();
    for (number, (points, indices)) in (0..).zip(own) {
        all.push(Tile::with_options(Arc::clone(&plan), number, points, indices, options.clone())?);
    }
    let mut traffic = Traffic::default();
    let mut received: Vec<Vec<(u32, Message<D>)>> = vec![Vec::new(); all.len()];
    loop {
        let mut sent = vec![Vec::new(); all.len()];
        for (from, (tile, received)) in (0..).zip(all.iter_mut().zip(&mut received)) {
            for (to, message) in tile.step(std::mem::take(received))? {
                traffic.points += message.points();
                sent[to as usize].push((from, message));
            }
        }
        traffic.steps += 1;
        if traffic.steps > 1 && sent.iter().all(Vec::is_empty) {
            break;
        }
        received = sent;
    }
    let mut stats = Stats::new(Backend::Cpu);
    all.iter().for_each(|tile| stats.exact = stats.exact + tile.stats().exact);
    let parts = all.into_iter().map(Tile::finish).collect::<Result<_, _>>()?;
    let mut mesh = part::join_with::<D, N>(parts, points.len(), options)?;
    *mesh.stats_mut() = stats;
    Ok((mesh, traffic))
}

/// What tiles have sent each other.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Traffic {
    /// The number of steps.
    pub steps: usize,
    /// The number of points that were sent, each as often as it was.
    pub points: usize,
}
