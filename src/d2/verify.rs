//! Verification of a 2D mesh: see [`verify`](mod@crate::verify) for what is checked and why it is
//! enough.

use crate::verify::{
    constraints,
    hidden::Simplices,
    input::{Input, dimension_2d},
    report::{Check, Defect, Findings, Outcome, Report},
};
use crate::{
    d2::Mesh2,
    error::Error,
    index::{Entry, NONE},
    input::points::Points2,
    predicates::{
        Sign,
        exact::power_sign,
        incircle, orient2d,
        symbolic::{break_tie, without},
    },
};

/// What a 2D mesh states: at least its triangles. What is `None` is not checked.
///
/// # Examples
///
/// ```
/// use gdel::{MeshView2, verify2d};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// // A mesh of another program, with its own arrays.
/// let mut mesh = MeshView2::of_triangles(&[[0, 1, 2]]);
/// mesh.hull = Some(&[0, 1, 2]);
/// assert!(verify2d(&points, mesh)?.passed());
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct MeshView2<'a> {
    /// The vertices of each triangle: see [`Mesh2::triangles`].
    pub triangles: &'a [[u32; 3]],
    /// The opposite half-edges: see [`Mesh2::halfedges`].
    pub halfedges: Option<&'a [[u32; 3]]>,
    /// Entry *k* is the triangle across the edge opposite vertex *k*, as in Triangle's files;
    /// [`NONE`] on the hull.
    pub neighbors: Option<&'a [[u32; 3]]>,
    /// The vertices of the hull, from any of them on: see [`Mesh2::hull`].
    pub hull: Option<&'a [u32]>,
    /// The points that stand for duplicates: see [`Mesh2::duplicate_of`].
    pub duplicate_of: Option<&'a [u32]>,
    /// The affine dimension of the points: see [`Mesh2::dimension`].
    pub dimension: Option<u8>,
    /// The weights of the points, if the mesh is to be their regular triangulation: see [`Mesh2::weights`].
    pub weights: Option<&'a [f64]>,
    /// The points that are no vertices because of their weights: see [`Mesh2::hidden`].
    pub hidden: Option<&'a [u32]>,
    /// The constrained edges, across which triangles need not be Delaunay: see [`Mesh2::constraints`].
    pub constraints: Option<&'a [[u32; 2]]>,
    /// The segments that were to become constrained edges: see [`Constraints::segments`](crate::Constraints::segments).
    /// The mesh does not have them; set them to check that it is that of these segments and no others.
    pub segments: Option<&'a [[u32; 2]]>,
}

impl<'a> MeshView2<'a> {
    /// Creates the view of a mesh of which only the triangles are known.
    pub fn of_triangles(triangles: &'a [[u32; 3]]) -> Self {
        MeshView2 { triangles, ..MeshView2::default() }
    }
}

impl<'a> From<&'a Mesh2> for MeshView2<'a> {
    fn from(mesh: &'a Mesh2) -> Self {
        MeshView2 {
            triangles: &mesh.triangles,
            halfedges: Some(&mesh.halfedges),
            neighbors: None,
            hull: Some(&mesh.hull),
            duplicate_of: Some(&mesh.duplicate_of),
            dimension: Some(mesh.dimension),
            weights: (!mesh.weights.is_empty()).then_some(&mesh.weights),
            hidden: Some(&mesh.hidden),
            constraints: Some(&mesh.constraints),
            segments: None,
        }
    }
}

/// Checks that `mesh`, whoever computed it, is the Delaunay triangulation of `points`, or the regular one
/// if it states weights, except for those that it states to be [unused](Mesh2::is_unused).
///
/// ```
/// use gdel::{MeshView2, verify2d};
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// assert!(verify2d(&points, MeshView2::of_triangles(&[[0, 1, 2]]))?.passed());
/// let turned = verify2d(&points, MeshView2::of_triangles(&[[0, 2, 1]]))?;
/// assert_eq!(turned.failures().next().unwrap().0.name(), "orientation");
/// # Ok::<(), gdel::Error>(())
/// ```
///
/// # Errors
///
/// Returns the errors of [`verify3d`](crate::d3::verify::verify3d).
pub fn verify2d<'p, 'm>(points: impl Into<Points2<'p>>, mesh: impl Into<MeshView2<'m>>) -> Result<Report, Error> {
    let mesh = mesh.into();
    let input = Input::new(points.into(), mesh.weights, mesh.duplicate_of, dimension_2d)?;
    let mut report = input.report(mesh.dimension, mesh.duplicate_of);
    report.counts.facets = mesh.triangles.len();
    let indices = check_indices(mesh.triangles, input.points.len()).into();
    let (complex, bad_edges) = match indices {
        Outcome::Passed => Complex::new(mesh.triangles),
        _ => Default::default(),
    };
    report.decide(Check::Indices, || indices);
    report.counts.vertices = complex.vertices;
    report.counts.edges = complex.edges;
    report.counts.hull_edges = complex.hull.len();

    report.decide(Check::Vertices, || input.check_vertices(mesh.triangles, "triangle", Defect::at_triangle));
    report.decide(Check::Orientation, || check_orientation(&input.points, mesh.triangles));
    report.decide(Check::Facets, || bad_edges);
    report.decide(Check::Neighbors, || {
        let mut findings = (mesh.halfedges.is_some() || mesh.neighbors.is_some()).then(Findings::default);
        if let Some(findings) = &mut findings {
            mesh.halfedges.into_iter().for_each(|stated| complex.check_halfedges(stated, findings));
            mesh.neighbors.into_iter().for_each(|stated| complex.check_neighbors(stated, findings));
        }
        findings
    });
    let constraints = constraints::sorted(mesh.constraints.unwrap_or_default());
    report.decide_delaunay(|| complex.check_delaunay(&input, &constraints));
    let mut polygon = Vec::new();
    let closed = complex.check_hull_closed(&mut polygon);
    report.decide(Check::Hull, || {
        mesh.hull.map(|hull| match input.dimension {
            2 => check_hull(hull, rotated(&polygon, hull.first())),
            // Collinear points have no triangles, but ends and an order.
            _ => check_hull(hull, input.distinct_in_order()),
        })
    });
    report.decide(Check::HullClosed, || closed);
    report.decide(Check::HullConvex, || check_hull_convex(&input.points, &polygon));
    let simplices = Simplices {
        simplices: mesh.triangles,
        // The edge opposite vertex k begins at the next.
        across: &|t, k| match complex.halfedges[t][(k + 1) % 3] {
            NONE => NONE,
            across => across / 3,
        },
        orientation: |[a, b, c]| orient2d(a, b, c),
        is_below: &|[a, b, c], d| incircle_of(&input, [a, b, c, d]).iter().any(|&sign| sign > 0),
        blame: Defect::at_triangle,
    };
    report.decide(Check::Hidden, || simplices.check(&input, mesh.hidden));
    report.decide(Check::Constraints, || {
        let is_stated = mesh.constraints.is_some() || mesh.segments.is_some();
        is_stated.then(|| complex.check_constraints(&input, &constraints, mesh.segments))
    });
    Ok(report)
}

pub(crate) fn check_indices(triangles: &[[u32; 3]], points: usize) -> Findings {
    let mut findings = Findings::default();
    if triangles.len() > i32::MAX as usize / 3 {
        let detail = format!("{} triangles have more half-edges than an index can name", triangles.len());
        findings.add(|| Defect::in_mesh(detail));
    }
    for (t, vertices) in triangles.iter().enumerate() {
        let [a, b, c] = *vertices;
        if let Some(v) = vertices.iter().find(|&&v| v as usize >= points) {
            findings.add(|| Defect::at_triangle(t, format!("vertex {v} is not one of the {points} points")));
        } else if a == b || b == c || c == a {
            findings.add(|| Defect::at_triangle(t, format!("the vertices {vertices:?} are not three points")));
        }
    }
    findings
}

pub(crate) fn check_orientation(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> Findings {
    let mut findings = Findings::default();
    for (t, vertices) in triangles.iter().enumerate() {
        let [a, b, c] = vertices.map(|v| points[v as usize]);
        let sign = orient2d(a, b, c);
        if sign <= 0 {
            let what = if sign == 0 { "flat" } else { "clockwise" };
            findings.add(|| Defect::at_triangle(t, format!("{what}: {vertices:?}")));
        }
    }
    findings
}

/// Checks that the hull is convex. Needs the closed hull, counter-clockwise, and triangles that are
/// counter-clockwise.
pub(crate) fn check_hull_convex(points: &[[f64; 2]], polygon: &[u32]) -> Findings {
    let mut findings = Findings::default();
    let mut turns = 0;
    for i in 0..polygon.len() {
        let [a, b, c] = [0, 1, 2].map(|k| polygon[(i + k) % polygon.len()]);
        let [pa, pb, pc] = [a, b, c].map(|v| points[v as usize]);
        // A convex polygon goes up to its greatest point once, in the order of the coordinates.
        let is_greatest = pa < pb && pc < pb;
        turns += usize::from(is_greatest);
        let folded = orient2d(pa, pb, pc) == 0 && (pa < pb) != (pb < pc);
        if orient2d(pa, pb, pc) < 0 || folded {
            findings.add(|| Defect::at_point(b as usize, format!("the hull is concave or folded, from {a} to {c}")));
        }
    }
    if turns > 1 {
        findings.add(|| Defect::in_mesh(format!("the hull turns {turns} times")));
    }
    findings
}

/// Returns the polygon from the vertex `first` on, if that is one of its vertices.
fn rotated(polygon: &[u32], first: Option<&u32>) -> Vec<u32> {
    let from = first.and_then(|first| polygon.iter().position(|v| v == first)).unwrap_or(0);
    let (before, after) = polygon.split_at(from);
    [after, before].concat()
}

fn check_hull(stated: &[u32], expected: Vec<u32>) -> Findings {
    let mut findings = Findings::default();
    if stated.len() != expected.len() {
        findings.add(|| Defect::in_mesh(format!("a hull of {} points, not {}", stated.len(), expected.len())));
    } else if let Some((found, expected)) = stated.iter().zip(&expected).find(|(a, b)| a != b) {
        findings.add(|| Defect::in_mesh(format!("the hull has point {found} in the place of {expected}")));
    }
    findings
}

/// Returns the sign of the in-circle determinant of the last of four points, or that of the lifted points
/// with weights; then, if it vanishes, that of the tie.
#[inline(always)]
fn incircle_of(input: &Input<2>, four: [u32; 4]) -> [Sign; 2] {
    let corners = four.map(|v| input.points[v as usize]);
    if input.weights.is_empty() {
        return incircle_at(corners, four);
    }
    match power_sign(corners, four.map(|v| input.weights[v as usize])) {
        0 => [0, tie(corners, four)],
        sign => [sign, 0],
    }
}

/// Returns the sign of the in-circle determinant of the last of four points with these indices; then, if it vanishes,
/// that of the tie.
#[inline(always)]
pub(crate) fn incircle_at(four: [[f64; 2]; 4], indices: [u32; 4]) -> [Sign; 2] {
    let [a, b, c, d] = four;
    match incircle(a, b, c, d) {
        0 => [0, tie(four, indices)],
        sign => [sign, 0],
    }
}

fn tie(four: [[f64; 2]; 4], indices: [u32; 4]) -> Sign {
    break_tie(indices, |left_out| {
        let [a, b, c] = without(four, left_out);
        orient2d(a, b, c)
    })
}

/// Triangles with the adjacency that follows from their vertices.
#[derive(Default)]
pub(crate) struct Complex<'a> {
    pub(crate) triangles: &'a [[u32; 3]],
    /// The half-edge against each; [`NONE`] where there is none.
    pub(crate) halfedges: Vec<[u32; 3]>,
    /// The half-edges without one against them, by their ends.
    pub(crate) hull: Vec<[u32; 2]>,
    pub(crate) vertices: usize,
    pub(crate) edges: usize,
}

impl<'a> Complex<'a> {
    /// Derives the adjacency, and finds the edges that are wrong. Needs vertices that are indices
    /// of points, three different ones per triangle.
    pub(crate) fn new(triangles: &'a [[u32; 3]]) -> (Self, Findings) {
        let mut findings = Findings::default();
        let mut complex = Complex { triangles, halfedges: vec![[NONE; 3]; triangles.len()], ..Complex::default() };
        // (lower vertex, higher vertex, half-edge); the half-edges of an edge become neighbours.
        let mut sides: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * triangles.len());
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            for (k, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
                sides.push((from.min(to), from.max(to), (3 * t + k) as u32));
            }
        }
        sides.sort_unstable();
        for around in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            complex.edges += 1;
            match *around {
                [(.., e)] => complex.hull.push(complex.ends(e)),
                [(.., e), (.., f)] if complex.ends(e) != complex.ends(f) => {
                    complex.halfedges[e as usize / 3][e as usize % 3] = f;
                    complex.halfedges[f as usize / 3][f as usize % 3] = e;
                }
                [(a, b, e), ..] => findings.add(|| {
                    let detail = match around.len() {
                        2 => format!("on the same side of edge {a}-{b} as triangle {}", around[1].2 / 3),
                        count => format!("edge {a}-{b} belongs to {count} triangles"),
                    };
                    Defect::at_triangle(e as usize / 3, detail)
                }),
                [] => {}
            }
        }
        let mut vertices = triangles.as_flattened().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        complex.vertices = vertices.len();
        (complex, findings)
    }

    pub(crate) fn ends(&self, halfedge: u32) -> [u32; 2] {
        let (t, k) = (self.triangles[halfedge as usize / 3], halfedge as usize % 3);
        [t[k], t[(k + 1) % 3]]
    }

    pub(crate) fn check_halfedges(&self, stated: &[[u32; 3]], findings: &mut Findings) {
        if stated.len() != self.triangles.len() {
            let detail = format!("half-edges of {} triangles, not of {}", stated.len(), self.triangles.len());
            findings.add(|| Defect::in_mesh(detail));
            return;
        }
        for (t, (stated, expected)) in stated.iter().zip(&self.halfedges).enumerate() {
            for k in 0..3 {
                if stated[k] != expected[k] {
                    let detail = format!(
                        "half-edge {} has {} against it, not {}",
                        3 * t + k,
                        Entry(expected[k]),
                        Entry(stated[k])
                    );
                    findings.add(|| Defect::at_triangle(t, detail));
                }
            }
        }
    }

    fn check_neighbors(&self, stated: &[[u32; 3]], findings: &mut Findings) {
        if stated.len() != self.triangles.len() {
            let detail = format!("neighbors of {} triangles, not of {}", stated.len(), self.triangles.len());
            findings.add(|| Defect::in_mesh(detail));
            return;
        }
        for (t, (stated, across)) in stated.iter().zip(&self.halfedges).enumerate() {
            for k in 0..3 {
                // The edge opposite vertex k begins at the next.
                let expected = if across[(k + 1) % 3] == NONE { NONE } else { across[(k + 1) % 3] / 3 };
                if stated[k] != expected {
                    let detail =
                        format!("the neighbor opposite vertex {k} is {}, not {}", Entry(expected), Entry(stated[k]));
                    findings.add(|| Defect::at_triangle(t, detail));
                }
            }
        }
    }

    /// Checks the constrained edges, and that they are what the segments are made of.
    fn check_constraints(&self, input: &Input<2>, constraints: &[[u32; 2]], segments: Option<&[[u32; 2]]>) -> Findings {
        let mut findings = if constraints.is_empty() {
            Findings::default()
        } else if self.triangles.is_empty() {
            // Collinear points have an order.
            let line = input.distinct_in_order();
            constraints::check_edges(constraints, line.windows(2).map(|pair| [pair[0], pair[1]]))
        } else {
            let edges = self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            constraints::check_edges(constraints, edges)
        };
        if let Some(segments) = segments {
            constraints::check_segments(constraints, segments, input, &mut findings);
        }
        findings
    }

    /// Checks the Delaunay property and that of the ties, except across constrained edges. Needs
    /// counter-clockwise triangles.
    pub(crate) fn check_delaunay(&self, input: &Input<2>, constraints: &[[u32; 2]]) -> (Findings, Findings) {
        let (mut delaunay, mut ties) = (Findings::default(), Findings::default());
        for (t, (&[a, b, c], across)) in self.triangles.iter().zip(&self.halfedges).enumerate() {
            for &e in across {
                let e = e as usize;
                // Not the hull, and each edge once.
                if e == NONE as usize || e / 3 < t {
                    continue;
                }
                let beyond = self.triangles[e / 3][(e + 2) % 3];
                let (findings, kind) = match incircle_of(input, [a, b, c, beyond]) {
                    [1, _] => (&mut delaunay, "is inside the circumcircle"),
                    [0, 1] => (&mut ties, "is on the circumcircle, and inside by the order of the indices"),
                    _ => continue,
                };
                let [from, to] = self.ends(e as u32);
                if constraints.binary_search(&[from.min(to), from.max(to)]).is_ok() {
                    continue;
                }
                findings.add(|| Defect::at_triangle(t, format!("point {beyond}, of triangle {}, {kind}", e / 3)));
            }
        }
        (delaunay, ties)
    }

    /// Checks that the hull is closed, and writes it as a polygon.
    pub(crate) fn check_hull_closed(&self, polygon: &mut Vec<u32>) -> Findings {
        let mut findings = Findings::default();
        let mut edges = self.hull.clone();
        edges.sort_unstable();
        for pair in edges.chunk_by(|[a, _], [b, _]| a == b).filter(|pair| pair.len() > 1) {
            findings.add(|| Defect::at_point(pair[0][0] as usize, format!("{} hull edges start here", pair.len())));
        }
        let Some(&[first, mut next]) = edges.first() else { return findings };
        polygon.push(first);
        // Every point of the hull is left as often as it is reached.
        while next != first && polygon.len() < edges.len() {
            polygon.push(next);
            match edges.binary_search_by_key(&next, |&[from, _]| from) {
                Ok(at) => next = edges[at][1],
                Err(_) => break,
            }
        }
        if polygon.len() != edges.len() || next != first {
            let detail = format!("{} of {} hull edges form one polygon", polygon.len(), edges.len());
            findings.add(|| Defect::in_mesh(detail));
        }
        findings
    }
}
