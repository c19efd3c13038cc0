//! Decides in the true coordinates the signs that rounding to the lattice has left uncertain on the device.

use crate::d2::{lawson::NearDelaunay2, triangulation::Triangulation2};
use crate::{
    d2::gpu::layout::{COUNTER_CLOCKWISE, FLAT, UncertainTest},
    input::{lattice::Lattice, points::Points2},
    parallel::{self, Threads},
    predicates::filter::PredicateContext2,
    stats::ExactCounts,
};

/// The number of tests that a thread takes at a time.
const GRAIN: usize = 1 << 10;

/// Returns the tests whose true sign contradicts the triangulation, and how many evaluations each exact
/// stage decided.
pub(crate) fn failed_tests(
    points: Points2<'_>,
    lattice: &Lattice<2>,
    tests: &[UncertainTest],
) -> (Vec<UncertainTest>, ExactCounts) {
    let parts = parallel::map_grains(Threads::All, tests.len(), GRAIN, |range| {
        let vertices = PredicateContext2::of_input(points, lattice);
        let wrong: Vec<UncertainTest> = tests[range].iter().copied().filter(|q| !is_right(&vertices, q)).collect();
        (wrong, vertices.exact_counts())
    });
    parts.into_iter().fold(Default::default(), |(mut wrong, counts), (more, counted)| {
        wrong.extend(more);
        (wrong, counts + counted)
    })
}

/// Returns whether the true sign agrees with the triangulation.
fn is_right(vertices: &PredicateContext2<'_>, test: &UncertainTest) -> bool {
    let infinite = vertices.len() as u32;
    let &UncertainTest { triangle: [p, a, b], beyond } = test;
    let orient = |[a, b, c]: [u32; 3]| vertices.orient2d(a, b, c);
    match beyond {
        COUNTER_CLOCKWISE => orient([p, a, b]) > 0,
        FLAT => orient([p, a, b]) == 0,
        q if [p, a, b].contains(&infinite) => orient([p, a, b].map(|v| if v == infinite { q } else { v })) <= 0,
        // An edge of a flat triangle is one of the hull, or between two that the answer leaves out;
        // and whether a triangle is counter-clockwise is a test of its own.
        q => vertices.incircle([p, a, b], q) <= 0 || orient([p, a, b]) <= 0 || orient([q, b, a]) <= 0,
    }
}

/// Returns the input of flipping and insertion: `triangulation`, which is Delaunay except for the
/// `wrong` signs (`None`: none of its signs is known), and the points that it lacks, each with the
/// vertex at the same place of the lattice.
pub(crate) fn near_delaunay(
    triangulation: Triangulation2,
    wrong: Option<&[UncertainTest]>,
    missing: &[[u32; 2]],
) -> NearDelaunay2 {
    let infinite = triangulation.infinite;
    let mut is_uncertain = vec![wrong.is_none(); infinite as usize + 1];
    for &UncertainTest { triangle: [p, a, b], beyond } in wrong.unwrap_or_default() {
        for v in [p, a, b, beyond].into_iter().filter(|&v| v <= infinite) {
            is_uncertain[v as usize] = true;
        }
    }
    let mut uncertain = Vec::new();
    let mut start_of = rustc_hash::FxHashMap::default();
    start_of.extend(missing.iter().map(|&[_, representative]| (representative, 0)));
    for (t, triangle) in (0..).zip(&triangulation.triangles) {
        // A triangle that a test names; at a vertex of one, any edge of the hull, since flat
        // triangles between the two may have been left out.
        let mut finite = triangle.iter().filter(|&&v| v != infinite).map(|&v| is_uncertain[v as usize]);
        if if triangle.contains(&infinite) { finite.any(|is| is) } else { finite.all(|is| is) } {
            uncertain.push(t);
        }
        if !start_of.is_empty() {
            for &v in triangle {
                start_of.entry(v).and_modify(|start| *start = t);
            }
        }
    }
    let missing = missing.iter().map(|&[i, representative]| (i, start_of[&representative])).collect();
    NearDelaunay2 { triangulation, uncertain, missing }
}
