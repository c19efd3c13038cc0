//! Building the stars (§3.2.1): one convex star, and how it differs from the triangulation's.

use crate::d3::splay::{
    Aborted,
    flip_flop::flip_flop,
    index_set::IndexSet,
    ledger::Entry,
    memory::Lists,
    predicates::StarPredicates,
    region::Region,
    star::{Changes, Star, Triangle},
};
use crate::{
    index::NONE,
    parallel::{self, Threads},
};

/// The triangulation as far as it is here, and what is known about it.
pub(super) struct Known {
    pub(super) region: Region,
    /// The vertices of tetrahedra and facets that have failed.
    pub(super) failed: IndexSet,
    /// The finite tetrahedra that are not positively oriented, ascending.
    pub(super) inverted: Vec<u32>,
    /// Their vertices.
    pub(super) inverted_at: IndexSet,
}

/// How a star was made convex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    /// It is convex in the triangulation.
    Pulled,
    /// Flip-Flop made it convex, with this number of flips.
    Flipped(usize),
    /// It was built from its points.
    FromPoints,
}

impl Known {
    /// Returns the convex star of `v`. It is that of the triangulation, unless `v` has failed or
    /// has an inverted tetrahedron; then it is made convex, and the differences are added to the
    /// entries of `lists`, for the ledger.
    pub(super) fn convex_star(
        &self,
        predicates: &StarPredicates<'_>,
        lists: &mut Lists,
        v: u32,
    ) -> Result<(Star, Origin), Aborted> {
        let Lists { links, entries, removed, edges, .. } = lists;
        let mut star = links.star(&self.region.mesh, v, self.region.vertex_simplex[v as usize])?;
        let may_wind = || star.used().any(|t| t.vertices.iter().any(|&v| self.inverted_at.has(v)));
        let is_oriented = self.is_oriented(predicates, &star) && (!may_wind() || star.winds_once(predicates));
        if is_oriented && !self.failed.has(v) {
            return Ok((star, Origin::Pulled));
        }
        removed.clear();
        // All other edges are locally Delaunay.
        let may_fail = |v: u32| v == predicates.infinite() || self.failed.has(v);
        let flips = is_oriented.then(|| flip_flop(&mut star, predicates, may_fail, edges, removed)).flatten();
        if flips.is_none() {
            removed.extend(star.used().filter(|t| t.tetrahedron != NONE));
            let mut points: Vec<u32> = removed.iter().flat_map(|t| t.vertices).collect();
            points.sort_unstable();
            points.dedup();
            star = Star::from_points(predicates, v, points.into_iter(), &mut Changes::default())?;
        }
        let (added, doubles) = recognize(&mut star, removed);
        entries.extend(Entry::changes(&star, removed, &added));
        entries.extend(doubles.iter().map(|t| Entry::double(&star, t)));
        Ok((star, flips.map_or(Origin::FromPoints, Origin::Flipped)))
    }

    /// Returns whether all tetrahedra of a star that is the triangulation's are positively
    /// oriented.
    fn is_oriented(&self, predicates: &StarPredicates<'_>, star: &Star) -> bool {
        star.used().all(|t| match t.vertices.contains(&predicates.infinite()) {
            true => predicates.orient(star.tetrahedron(t.vertices)) > 0,
            false => self.inverted.binary_search(&t.tetrahedron).is_err(),
        })
    }
}

/// Finds the triangles of a star that the triangulation has after all, records their tetrahedra,
/// and takes them out of `removed`. Returns the slots of the others, which have none, and the
/// triangles of the triangulation that it has more than once, but for the first of each.
fn recognize(star: &mut Star, removed: &mut Vec<Triangle>) -> (Vec<u32>, Vec<Triangle>) {
    // The corners are not sorted, which would confuse an inverted tetrahedron with a new one.
    let rotated = |[a, b, c]: [u32; 3]| match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    };
    removed.iter_mut().for_each(|t| t.vertices = rotated(t.vertices));
    parallel::sort(Threads::One, removed);
    let mut doubles = Vec::new();
    removed.dedup_by(|double, first| {
        let are_same = double.vertices == first.vertices;
        if are_same {
            // All stars keep the same one.
            if double.tetrahedron < first.tetrahedron {
                std::mem::swap(double, first);
            }
            doubles.push(*double);
        }
        are_same
    });
    let mut added = Vec::new();
    for (i, t) in star.triangles.iter_mut().enumerate().filter(|(_, t)| t.is_used() && t.tetrahedron == NONE) {
        match removed.binary_search_by_key(&rotated(t.vertices), |t| t.vertices) {
            Ok(at) if removed[at].tetrahedron != NONE => {
                t.tetrahedron = std::mem::replace(&mut removed[at].tetrahedron, NONE);
            }
            _ => added.push(i as u32),
        }
    }
    removed.retain(|t| t.tetrahedron != NONE);
    (added, doubles)
}
