//! One star, convex, and how it differs from the triangulation's.

use crate::d3::splay::{
    Aborted,
    flip_flop::flip_flop,
    ledger::Entry,
    predicates::StarPredicates,
    star::{Changes, LinkFinder, NONE, Star, Triangle},
};
use crate::d3::triangulation::Triangulation;
use rustc_hash::FxHashSet;

/// The triangulation, and what is known of it.
pub(super) struct Known<'a> {
    pub(super) mesh: &'a Triangulation,
    /// A tetrahedron at each vertex.
    pub(super) incident: &'a [u32],
    /// For each vertex, whether it is one of a tetrahedron or facet that has failed.
    pub(super) failed: Vec<bool>,
    /// The finite tetrahedra that are not positively oriented.
    pub(super) turned: FxHashSet<u32>,
}

/// How a star came to be convex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum How {
    /// It was, in the triangulation.
    Pulled,
    /// By so many flips of Flip-Flop.
    Flipped(usize),
    /// It was built from its points.
    FromPoints,
}

impl Known<'_> {
    /// The star of `v`: made convex from what the triangulation has, if that has failed or has a tetrahedron that is turned
    /// over; else taken as it is. Adds what the ledger has to know.
    pub(super) fn convex_star(
        &self,
        space: &StarPredicates<'_>,
        links: &mut LinkFinder,
        v: u32,
        entries: &mut Vec<Entry>,
    ) -> Result<(Star, How), Aborted> {
        let mut star = links.star(self.mesh, v, self.incident[v as usize])?;
        let is_oriented = self.is_oriented(space, &star);
        if is_oriented && !self.failed[v as usize] {
            return Ok((star, How::Pulled));
        }
        // Triangles that the triangulation has, and the star has no more.
        let mut gone = Vec::new();
        // All others are locally Delaunay.
        let may_fail = |v: u32| v == space.infinite() || self.failed[v as usize];
        let flips = is_oriented.then(|| flip_flop(&mut star, space, may_fail, &mut gone)).flatten();
        if flips.is_none() {
            gone.extend(star.used().filter(|t| t.tetrahedron != NONE));
            let mut points: Vec<u32> = gone.iter().flat_map(|t| t.vertices).collect();
            points.sort_unstable();
            points.dedup();
            star = Star::from_points(space, v, points.into_iter(), &mut Changes::default())?;
        }
        let added = recognize(&mut star, &mut gone);
        entries.extend(Entry::changes(&star, &gone, &added));
        Ok((star, flips.map_or(How::FromPoints, How::Flipped)))
    }

    /// Whether all tetrahedra of a star that is the triangulation's are positively oriented.
    fn is_oriented(&self, space: &StarPredicates<'_>, star: &Star) -> bool {
        star.used().all(|t| match t.vertices.contains(&space.infinite()) {
            true => space.orient(star.tetrahedron(t.vertices)) > 0,
            false => !self.turned.contains(&t.tetrahedron),
        })
    }
}

/// Finds those triangles of a star that are the triangulation's after all, notes their tetrahedra, and takes them from `gone`.
/// Gives where the others are that have none.
fn recognize(star: &mut Star, gone: &mut Vec<Triangle>) -> Vec<u32> {
    // Not sorted: that would take an inverted tetrahedron for a new one.
    let rotated = |[a, b, c]: [u32; 3]| match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    };
    gone.iter_mut().for_each(|t| t.vertices = rotated(t.vertices));
    gone.sort_unstable_by_key(|t| t.vertices);
    let mut added = Vec::new();
    for (i, t) in star.triangles.iter_mut().enumerate().filter(|(_, t)| t.is_used() && t.tetrahedron == NONE) {
        match gone.binary_search_by_key(&rotated(t.vertices), |t| t.vertices) {
            Ok(at) if gone[at].tetrahedron != NONE => {
                t.tetrahedron = std::mem::replace(&mut gone[at].tetrahedron, NONE)
            }
            _ => added.push(i as u32),
        }
    }
    gone.retain(|t| t.tetrahedron != NONE);
    added
}
