//! Tetrahedra whose vertices move: exact signs, flips, star splaying of the vertices of what is
//! inverted or stuck, and a proof that the hull encloses its inside once.

#[cfg(feature = "gpu")]
use crate::input::{lattice::Lattice, points::Points3};
use crate::{
    cpu::update::{Checked, Moved, Update},
    d3::{
        Mesh3, lawson,
        mesh::FACETS,
        splay::{self, Aborted, NearDelaunay3, SplayOutcome, Terms, predicates::StarPredicates},
        triangulation::{MAX_TETRAHEDRA, Triangulation3, state},
    },
    dimension::Dimension,
    error::Error,
    index::{NO_INDEX, NONE},
    parallel::{self, Threads},
    predicates::{
        filter::{PredicateContext, PredicateContext3},
        orient2d,
    },
    stats::{Phase, Restart},
};
use std::ops::Range;

/// Splaying may take this share of the predicate evaluations that triangulating from scratch takes.
const SPLAY_SHARE: u64 = 4;

/// The number of facets of the hull that a thread takes at a time.
#[cfg(feature = "gpu")]
const FACET_GRAIN: usize = 1 << 10;

/// What the signs at the new points leave unproven.
#[derive(Default)]
struct Doubts {
    /// The tetrahedra and ghosts that are flat or inverted.
    inverted: Vec<u32>,
    /// The facets that are not locally Delaunay, each once.
    facets: Vec<u32>,
}

impl Update<3> for Dimension<3> {
    type Corners = [u32; 4];

    fn duplicate_of(mesh: &Mesh3) -> &[i32] {
        &mesh.duplicate_of
    }

    fn corners(triangulation: &Triangulation3, t: u32) -> [u32; 4] {
        match triangulation.state(t) {
            state::UNKNOWN => triangulation.vertices(t),
            _ => [NO_INDEX; 4],
        }
    }

    fn incident(triangulation: &Triangulation3) -> Vec<u32> {
        let mut incident = vec![NO_INDEX; triangulation.infinite as usize + 1];
        let mut ghosts = Vec::new();
        for (t, &v) in (0..).zip(&triangulation.tetrahedra) {
            if v[0] & state::MASK == state::FREE {
                continue;
            }
            if v[3] == triangulation.infinite {
                ghosts.push(t);
            } else {
                v.iter().for_each(|&v| incident[v as usize] = t);
            }
        }
        for t in ghosts {
            triangulation.tetrahedra[t as usize].iter().for_each(|&v| incident[v as usize] = t);
        }
        incident
    }

    fn repair(moved: &mut Moved<'_, 3>, mesh: &Mesh3) -> Result<Result<Triangulation3, Restart>, Error> {
        let spanning = match spanning_tetrahedron(mesh, moved.vertices) {
            Ok(spanning) => spanning,
            Err(why) => return Ok(Err(why)),
        };
        let parts = match moved.check(mesh.tetrahedra.len(), |vertices, range| check(mesh, vertices, range)) {
            Ok(parts) => parts,
            Err(why) => return Ok(Err(why)),
        };
        let Some((mut mesh, Doubts { mut inverted, mut facets })) = triangulation(mesh, parts, moved.threads) else {
            return Ok(Err(Restart::Broken));
        };
        let predicates = StarPredicates::new(moved.vertices, mesh.infinite, spanning);
        let ghosts = check_ghosts(&mesh, &predicates);
        inverted.extend(ghosts.inverted);
        facets.extend(ghosts.facets);
        moved.update.inverted = inverted.len();
        moved.update.not_locally_delaunay = facets.len();
        moved.stats.phases.push((Phase::Check, moved.stopwatch.lap()));

        moved.options.report(Phase::Flip, 0.5)?;
        let report = |_| moved.options.report(Phase::Flip, 0.5);
        let (flips, stuck) = lawson::flip(&mut mesh, &predicates, facets, &inverted, &report)?;
        moved.update.flips = flips;
        moved.stats.phases.push((Phase::Flip, moved.stopwatch.lap()));

        if !inverted.is_empty() || !stuck.is_empty() {
            let corners = |facet: &u32| {
                let v = mesh.vertices(facet >> 2);
                FACETS[*facet as usize % 4].map(|i| v[i])
            };
            let failed = stuck.iter().flat_map(corners).filter(|&v| v != mesh.infinite).collect();
            let mut incident = Dimension::<3>::incident(&mesh);
            incident.truncate(mesh.infinite as usize);
            let max_evaluations = splay::evaluations_from_scratch(mesh.tetrahedra.len()) / SPLAY_SHARE;
            let near =
                NearDelaunay3 { triangulation: mesh, incident, failed, uncertain: inverted, missing: Vec::new() };
            // Nothing is stored, so that threads can share the work.
            let vertices = PredicateContext::of_input(moved.points, moved.lattice);
            let report = |share: f64| moved.options.report(Phase::Splay, 0.6 + 0.3 * share);
            let terms = Terms { max_evaluations, threads: moved.threads, report: &report };
            mesh = match splay::splay(&vertices, near, terms)? {
                SplayOutcome::Delaunay(mesh, stats) => {
                    moved.update.stars = stats.built;
                    moved.stats.splay = Some(stats);
                    *mesh
                }
                SplayOutcome::Aborted(Aborted::BudgetExceeded) => return Ok(Err(Restart::Changed)),
                SplayOutcome::Aborted(Aborted::Inconsistent(_)) => return Ok(Err(Restart::Stuck)),
            };
            moved.stats.exact = moved.stats.exact + vertices.exact_counts();
            moved.stats.phases.push((Phase::Splay, moved.stopwatch.lap()));
        }
        Ok(if is_convex(moved, &mesh) { Ok(mesh) } else { Err(Restart::Stuck) })
    }
}

/// Returns the vertices of the first tetrahedron that is positively oriented, or why there is none.
fn spanning_tetrahedron(mesh: &Mesh3, vertices: &PredicateContext3<'_>) -> Result<[u32; 4], Restart> {
    for &v in &mesh.tetrahedra {
        if v.iter().any(|&v| v as usize >= vertices.len()) {
            return Err(Restart::Broken);
        }
        if vertices.orient3d(v[0], v[1], v[2], v[3]) > 0 {
            return Ok(v);
        }
    }
    Err(Restart::Degenerate)
}

/// A part of a mesh at the new points.
struct Part {
    /// What is across the facets, as a triangulation has it; [`NO_INDEX`] on the hull.
    across: Vec<[u32; 4]>,
    /// The facets of the hull.
    hull: Vec<u32>,
    doubts: Doubts,
}

impl Checked for Part {
    fn counts(&self) -> [usize; 2] {
        [self.doubts.inverted.len(), self.doubts.facets.len()]
    }
}

/// Evaluates the signs of some tetrahedra, and of their facets with later ones. Returns `None` if
/// neighbours do not fit each other.
///
/// All that is known of a neighbour is looked up once: most of the time goes by waiting for memory.
fn check(mesh: &Mesh3, vertices: &PredicateContext3<'_>, range: Range<usize>) -> Option<Part> {
    let points = vertices.len() as u32;
    let mut part = Part { across: Vec::with_capacity(range.len()), hull: Vec::new(), doubts: Doubts::default() };
    for t in range {
        let v = mesh.tetrahedra[t];
        if v.iter().any(|&v| v >= points) {
            return None;
        }
        let is_inverted = vertices.orient3d(v[0], v[1], v[2], v[3]) <= 0;
        if is_inverted {
            part.doubts.inverted.push(t as u32);
        }
        let mut row = [NO_INDEX; 4];
        for (k, &u) in mesh.neighbors.get(t)?.iter().enumerate() {
            let facet = (4 * t + k) as u32;
            if u == NONE {
                part.hull.push(facet);
                continue;
            }
            let (w, back) = (mesh.tetrahedra.get(u as usize)?, mesh.neighbors.get(u as usize)?);
            let l = back.iter().position(|&back| back == t as i32)?;
            let [a, b, c] = FACETS[k].map(|i| v[i]);
            let [d, e, f] = FACETS[l].map(|i| w[i]);
            // The same facet, seen from the other side.
            if ![[d, f, e], [f, e, d], [e, d, f]].contains(&[a, b, c]) || w[l] >= points {
                return None;
            }
            row[k] = 4 * u as u32 + l as u32;
            if !is_inverted && facet < row[k] && vertices.insphere(v, w[l]) > 0 {
                part.doubts.facets.push(facet);
            }
        }
        part.across.push(row);
    }
    Some(part)
}

/// Returns the triangulation of a mesh, whose tetrahedra keep their numbers, with a ghost on each
/// facet of its hull, and the doubts of its parts; `None` if the hull is not closed.
fn triangulation(mesh: &Mesh3, mut parts: Vec<Part>, threads: Threads) -> Option<(Triangulation3, Doubts)> {
    let (count, infinite) = (mesh.tetrahedra.len(), mesh.duplicate_of.len() as u32);
    if mesh.neighbors.len() != count || count > MAX_TETRAHEDRA / 2 {
        return None;
    }
    let mut doubts = Doubts::default();
    for part in &mut parts {
        doubts.inverted.append(&mut part.doubts.inverted);
        doubts.facets.append(&mut part.doubts.facets);
    }
    let hull: Vec<u32> = parts.iter().flat_map(|part| &part.hull).copied().collect();
    let mut across = parallel::joined(parts.into_iter().map(|part| part.across).collect());
    let mut tetrahedra = mesh.tetrahedra.clone();
    // The edges of the hull, ascending, each with the ghosts' facets at it.
    let mut edges = Vec::with_capacity(3 * hull.len());
    for (&facet, ghost) in hull.iter().zip(count as u32..) {
        let v = tetrahedra[facet as usize / 4];
        let [a, b, c] = FACETS[facet as usize % 4].map(|i| v[i]);
        for (k, [from, to]) in (0..).zip([[b, c], [c, a], [a, b]]) {
            edges.push([from.min(to), from.max(to), u32::from(from < to), 4 * ghost + k]);
        }
        tetrahedra.push([a, b, c, infinite]);
        across[facet as usize / 4][facet as usize % 4] = 4 * ghost + 3;
        across.push([NO_INDEX, NO_INDEX, NO_INDEX, facet]);
    }
    parallel::sort(threads, &mut edges);
    let mut mesh = Triangulation3::new(tetrahedra, across, infinite);
    for same in edges.chunk_by(|e, f| e[..2] == f[..2]) {
        let &[[_, _, 0, f], [_, _, 1, g]] = same else { return None };
        mesh.join(f, g);
    }
    Some((mesh, doubts))
}

/// Evaluates the signs of all ghosts, and of the facets between them. One between a ghost and a
/// tetrahedron is locally Delaunay if that is positively oriented.
fn check_ghosts(mesh: &Triangulation3, predicates: &StarPredicates<'_>) -> Doubts {
    let mut doubts = Doubts::default();
    for t in ghosts(mesh) {
        let v = mesh.vertices(t);
        if predicates.orient(v) <= 0 {
            doubts.inverted.push(t);
            continue;
        }
        for (facet, &across) in (4 * t..4 * t + 3).zip(&mesh.neighbors[t as usize]) {
            let apex = mesh.vertices(across >> 2)[across as usize % 4];
            if facet < across && predicates.conflict(v, apex) > 0 {
                doubts.facets.push(facet);
            }
        }
    }
    doubts
}

/// Returns the ghosts of a triangulation.
fn ghosts(mesh: &Triangulation3) -> impl Iterator<Item = u32> {
    (0..mesh.tetrahedra.len() as u32).filter(|&t| mesh.is_ghost(t) && mesh.state(t) != state::FREE)
}

/// Returns whether a hull, whose edges are convex, is the boundary of a convex body that it encloses
/// once, as [`is_convex`] explains. `spanning` are vertices inside of the hull or on it, whose
/// tetrahedron is positively oriented on the lattice.
#[cfg(feature = "gpu")]
pub(in crate::d3) fn encloses_once(
    points: Points3<'_>,
    lattice: &Lattice<3>,
    hull: &[[u32; 3]],
    spanning: [u32; 4],
) -> bool {
    let infinite = points.len() as u32;
    let hits = parallel::map_grains(Threads::All, hull.len(), FACET_GRAIN, |range| {
        let vertices = PredicateContext::of_input(points, lattice);
        let predicates = StarPredicates::new(&vertices, infinite, spanning);
        let mut hits = 0;
        for &[a, b, c] in &hull[range] {
            if predicates.orient([a, b, c, infinite]) <= 0 {
                return None;
            }
            hits += usize::from(is_hit(&vertices, [a, b, c], spanning));
        }
        Some(hits)
    });
    let [a, b, c, d] = spanning;
    let vertices = PredicateContext::of_input(points, lattice);
    vertices.orient3d(a, b, c, d) > 0 && hits.into_iter().sum::<Option<usize>>() == Some(1)
}

/// Returns whether the hull is convex, and encloses its inside once.
///
/// If every ghost is positively oriented, its facet is seen from the inside of the spanning
/// tetrahedron. If a ray from there hits one facet, every ray does, and the hull is the boundary of
/// a star-shaped body; if its edges are convex, too, the body is. Then tetrahedra that are
/// positively oriented, whose facets are shared or on the hull, cover it once. Nothing less
/// suffices: around an edge, tetrahedra may go round twice without any being inverted.
fn is_convex(moved: &Moved<'_, 3>, mesh: &Triangulation3) -> bool {
    let is_spanning = |&t: &u32| {
        let [a, b, c, d] = mesh.vertices(t);
        mesh.state(t) != state::FREE && !mesh.is_ghost(t) && moved.vertices.orient3d(a, b, c, d) > 0
    };
    let Some(spanning) = (0..mesh.tetrahedra.len() as u32).find(is_spanning).map(|t| mesh.vertices(t)) else {
        return false;
    };
    let doubts = check_ghosts(mesh, &StarPredicates::new(moved.vertices, mesh.infinite, spanning));
    let hit = ghosts(mesh).filter(|&t| {
        let [a, b, c, _] = mesh.vertices(t);
        is_hit(moved.vertices, [a, b, c], spanning)
    });
    doubts.inverted.is_empty() && doubts.facets.is_empty() && hit.count() == 1
}

/// Returns whether the ray along the *x* axis from a point inside the spanning tetrahedron hits a
/// facet of the hull, counter-clockwise as seen from outside, that the point is inside of.
///
/// The point is the first vertex of the tetrahedron, displaced towards the second one, far less
/// towards the third, and still less towards the fourth, so that it is in no plane with an edge and
/// the axis.
fn is_hit(vertices: &PredicateContext3<'_>, facet: [u32; 3], spanning: [u32; 4]) -> bool {
    let flat = |v: u32| {
        let [_, y, z] = vertices.point(v);
        [y, z]
    };
    let [a, b, c] = facet.map(flat);
    let is_left =
        |p, q| spanning.iter().map(|&v| orient2d(p, q, flat(v))).find(|&sign| sign != 0).is_some_and(|sign| sign > 0);
    orient2d(a, b, c) > 0 && is_left(a, b) && is_left(b, c) && is_left(c, a)
}
