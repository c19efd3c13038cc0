//! What depends on where the vertices are: orientation, the Delaunay property, convexity, covering.

use crate::{
    d3::mesh::FACETS,
    parallel::{self, Threads},
    predicates::{
        Sign,
        exact::power_sign,
        insphere, orient3d,
        symbolic::{break_tie, without},
    },
};
use crate::{
    d3::verify::complex::{Complex, Side},
    verify::{
        input::Input,
        report::{Defect, Findings},
    },
};

fn at<const N: usize>(points: &[[f64; 3]], vertices: [u32; N]) -> [[f64; 3]; N] {
    vertices.map(|v| points[v as usize])
}

fn orientation(points: &[[f64; 3]], tetrahedron: [u32; 4]) -> Sign {
    let [a, b, c, d] = at(points, tetrahedron);
    orient3d(a, b, c, d)
}

pub(crate) fn check_orientation(points: &[[f64; 3]], tetrahedra: &[[u32; 4]]) -> Findings {
    let parts = parallel::map_ranges(Threads::All, tetrahedra.len(), |range| {
        let mut findings = Findings::default();
        for (t, &vertices) in range.clone().zip(&tetrahedra[range]) {
            let sign = orientation(points, vertices);
            if sign <= 0 {
                let what = if sign == 0 { "flat" } else { "negatively oriented" };
                findings.add(|| Defect::at_tetrahedron(t, format!("{what}: {vertices:?}")));
            }
        }
        findings
    });
    parts.into_iter().collect()
}

/// Returns the sign of the in-sphere determinant of the last of five points, or that of the lifted points
/// with weights; then, if it vanishes, that of the tie.
pub(crate) fn insphere_of(input: &Input<3>, five: [u32; 5]) -> [Sign; 2] {
    let corners = at(&input.points, five);
    if input.weights.is_empty() {
        return insphere_at(corners, five);
    }
    match power_sign(corners, five.map(|v| input.weights[v as usize])) {
        0 => [0, tie(corners, five)],
        sign => [sign, 0],
    }
}

/// Returns the sign of the in-sphere determinant of the last of five points with these indices; then, if it vanishes,
/// that of the tie.
pub(crate) fn insphere_at(five: [[f64; 3]; 5], indices: [u32; 5]) -> [Sign; 2] {
    let [a, b, c, d, e] = five;
    match insphere(a, b, c, d, e) {
        0 => [0, tie(five, indices)],
        sign => [sign, 0],
    }
}

fn tie(five: [[f64; 3]; 5], indices: [u32; 5]) -> Sign {
    break_tie(indices, |left_out| {
        let [a, b, c, d] = without(five, left_out);
        orient3d(a, b, c, d)
    })
}

/// Checks the Delaunay property and that of the ties. Needs positive orientation.
pub(crate) fn check_delaunay(input: &Input<3>, complex: &Complex<'_>) -> (Findings, Findings) {
    let parts = parallel::map_ranges(Threads::All, complex.tetrahedra.len(), |range| {
        let (mut delaunay, mut ties) = (Findings::default(), Findings::default());
        for (Side { tetrahedron, k }, beyond) in complex.inner_facets(range) {
            let [a, b, c, d] = complex.tetrahedra[tetrahedron];
            let (findings, kind) = match insphere_of(input, [a, b, c, d, beyond]) {
                [1, _] => (&mut delaunay, "is inside the circumsphere"),
                [0, 1] => (&mut ties, "is on the circumsphere, and inside by the order of the indices"),
                _ => continue,
            };
            findings.add(|| Defect::at_tetrahedron(tetrahedron, format!("point {beyond}, beyond facet {k}, {kind}")));
        }
        (delaunay, ties)
    });
    parts.into_iter().unzip()
}

/// Checks that the hull is convex. Needs positive orientation, and the two hull triangles at each
/// edge of a closed hull.
pub(crate) fn check_hull_convex(points: &[[f64; 3]], complex: &Complex<'_>, ridges: &[[(Side, usize); 2]]) -> Findings {
    let mut findings = Findings::default();
    for &[(side, k), (other, other_k)] in ridges {
        let corners = complex.corners(side);
        let [a, b, c] = std::array::from_fn(|i| corners[(k + i) % 3]);
        let d = complex.corners(other)[(other_k + 2) % 3];
        let concave = match orientation(points, [a, b, c, d]) {
            // Coplanar triangles must lie on either side of their edge, as seen with a point off
            // their plane.
            0 => {
                let apex = complex.apex(side);
                orientation(points, [a, b, apex, d]) * orientation(points, [a, b, apex, c]) >= 0
            }
            sign => sign > 0,
        };
        if concave {
            findings.add(|| {
                let detail =
                    format!("the hull is concave or folded at edge {a}-{b}, to tetrahedron {}", other.tetrahedron);
                Defect::at_tetrahedron(side.tetrahedron, detail)
            });
        }
    }
    findings
}

/// Checks that the tetrahedra cover the hull's inside once. Needs positive orientation.
pub(crate) fn check_covering(points: &[[f64; 3]], complex: &Complex<'_>) -> Findings {
    let Some(&first) = complex.tetrahedra.first() else { return Findings::default() };
    let probe = at(points, first);
    let overlaps = check_overlaps(probe, points, &complex.tetrahedra[1..]);
    [check_hull_turned(probe, points, complex), overlaps].into_iter().collect()
}

/// Returns whether a point inside a tetrahedron is on the inner side of a triangle.
///
/// The point a + ε(b − a) + ε²(c − a) + ε³(d − a) with ε infinitesimal is inside the tetrahedron and on no plane through
/// three points: the first of a, b, c, d that is not on the plane decides its side.
fn is_within(inside: [[f64; 3]; 4], [u, v, w]: [[f64; 3]; 3]) -> bool {
    inside.into_iter().map(|p| orient3d(u, v, w, p)).find(|&sign| sign != 0) == Some(-1)
}

/// Checks that all hull triangles are seen from a point inside a tetrahedron.
pub(crate) fn check_hull_turned(inside: [[f64; 3]; 4], points: &[[f64; 3]], complex: &Complex<'_>) -> Findings {
    let mut findings = Findings::default();
    for &side in &complex.hull {
        let corners = complex.corners(side);
        if !is_within(inside, at(points, corners)) {
            findings.add(|| {
                let detail = format!("its hull triangle {corners:?} is turned away from the inside of tetrahedron 0");
                Defect::at_tetrahedron(side.tetrahedron, detail)
            });
        }
    }
    findings
}

/// Checks that no other tetrahedron contains a point inside the first one. `others` are those after it.
pub(crate) fn check_overlaps(inside: [[f64; 3]; 4], points: &[[f64; 3]], others: &[[u32; 4]]) -> Findings {
    let parts = parallel::map_ranges(Threads::All, others.len(), |range| {
        let mut findings = Findings::default();
        for (t, &vertices) in range.clone().zip(&others[range]) {
            let corners = at(points, vertices);
            if FACETS.iter().all(|facet| is_within(inside, facet.map(|i| corners[i]))) {
                findings.add(|| Defect::at_tetrahedron(t + 1, "overlaps tetrahedron 0".to_owned()));
            }
        }
        findings
    });
    parts.into_iter().collect()
}
