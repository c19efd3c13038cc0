//! What the verifier found, check by check.

use std::fmt;

/// A property of the Delaunay or regular triangulation that the verifier decides.
///
/// Together they are sufficient: a mesh that passes all of them *is* the triangulation that
/// [`delaunay3d`](crate::delaunay3d) defines. In 2D, tetrahedra are triangles, facets are edges,
/// the neighbours are half-edges, and the checks after the convex hull are not needed.
///
/// # Examples
///
/// ```
/// use gdel::{verify::Check, verify3d};
///
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
/// let mut mesh = gdel::delaunay3d(&points)?;
/// mesh.tetrahedra[0].swap(0, 1);
/// let report = verify3d(&points, &mesh)?;
/// assert_eq!(report.failures().next().map(|(check, ..)| check), Some(Check::Orientation));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Check {
    /// The dimension that the mesh states is the affine dimension of the points.
    Dimension,
    /// The duplicates that the mesh states are those of the points, each with the lowest index of
    /// its coordinates.
    Duplicates,
    /// Every tetrahedron has four different vertices that are indices of points.
    Indices,
    /// The vertices are the distinct points, all of them where the points span three dimensions,
    /// and each is named by the lowest index of its coordinates. With weights, not all need to be
    /// vertices, and the heaviest of equal points names them.
    Vertices,
    /// Every tetrahedron is positively oriented; none is flat.
    Orientation,
    /// No facet belongs to more than two tetrahedra, and two that share a facet lie on either side
    /// of it.
    Facets,
    /// The neighbours that the mesh states are the tetrahedra across the facets.
    Neighbors,
    /// No tetrahedron's circumsphere has the opposite vertex of a neighbour strictly inside. With
    /// weights: no lifted tetrahedron has it strictly below. In 2D, constrained edges are excepted.
    Delaunay,
    /// Where the opposite vertex of a neighbour lies on the circumsphere, or the lifted tetrahedron, the symbolic perturbation
    /// of the heights puts it outside.
    CanonicalTies,
    /// The hull triangles that the mesh states are the facets of a single tetrahedron, turned
    /// outwards.
    Hull,
    /// Every edge of the hull is between exactly two hull triangles.
    HullClosed,
    /// The hull has no concave edge and no fold.
    HullConvex,
    /// Vertices − edges + facets − tetrahedra = 1, as in a ball.
    EulerCharacteristic,
    /// The tetrahedra cover the hull's inside once: all hull triangles are seen from one point
    /// inside, and no second tetrahedron contains that point.
    Covering,
    /// The hidden points that the mesh states are the distinct ones that are no vertices, as weights allow,
    /// and each of these lies above the lifted tetrahedron that contains it.
    Hidden,
    /// The constrained edges that a 2D mesh states are edges, and if segments are given that these were to become, each
    /// segment is a chain of them, and each of them a piece of a segment.
    Constraints,
}

impl Check {
    /// Every check, in the order in which they run.
    pub const ALL: [Check; 16] = [
        Check::Dimension,
        Check::Duplicates,
        Check::Indices,
        Check::Vertices,
        Check::Orientation,
        Check::Facets,
        Check::Neighbors,
        Check::Delaunay,
        Check::CanonicalTies,
        Check::Hull,
        Check::HullClosed,
        Check::HullConvex,
        Check::EulerCharacteristic,
        Check::Covering,
        Check::Hidden,
        Check::Constraints,
    ];

    /// Returns a short name, such as `hull-convex`.
    pub fn name(self) -> &'static str {
        match self {
            Check::Dimension => "dimension",
            Check::Duplicates => "duplicates",
            Check::Indices => "indices",
            Check::Vertices => "vertices",
            Check::Orientation => "orientation",
            Check::Facets => "facets",
            Check::Neighbors => "neighbors",
            Check::Delaunay => "delaunay",
            Check::CanonicalTies => "canonical-ties",
            Check::Hull => "hull",
            Check::HullClosed => "hull-closed",
            Check::HullConvex => "hull-convex",
            Check::EulerCharacteristic => "euler-characteristic",
            Check::Covering => "covering",
            Check::Hidden => "hidden",
            Check::Constraints => "constraints",
        }
    }

    /// Returns the checks without which this one has no meaning.
    fn requires(self) -> &'static [Check] {
        match self {
            Check::Dimension | Check::Duplicates | Check::Indices => &[],
            Check::Vertices | Check::Orientation | Check::Facets => &[Check::Indices],
            Check::Neighbors | Check::Hull | Check::HullClosed | Check::EulerCharacteristic | Check::Constraints => {
                &[Check::Facets]
            }
            Check::Delaunay | Check::CanonicalTies => &[Check::Orientation, Check::Facets],
            Check::HullConvex => &[Check::Orientation, Check::HullClosed],
            Check::Covering => &[Check::HullConvex, Check::EulerCharacteristic],
            // In 3D, a mesh that does not cover its hull may lack the simplex around a point.
            Check::Hidden => &[Check::Vertices, Check::HullConvex],
        }
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Where and how a mesh fails a check.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let mut mesh = gdel::delaunay2d(&points)?;
/// mesh.triangles[0].swap(0, 1);
/// let report = gdel::verify2d(&points, &mesh)?;
/// let (_, defect, _) = report.failures().next().expect("the triangle is clockwise");
/// assert_eq!(defect.triangle, Some(0));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Defect {
    /// The index of the tetrahedron that is to blame; `None` where it is not one.
    pub tetrahedron: Option<usize>,
    /// The index of the triangle of a 2D mesh that is to blame; `None` where it is not one.
    pub triangle: Option<usize>,
    /// The index of the point with the defect; `None` if the defect is not that of a point.
    pub point: Option<usize>,
    /// A description of the defect.
    pub detail: String,
}

impl Defect {
    pub(crate) fn in_mesh(detail: String) -> Self {
        Defect { detail, ..Defect::default() }
    }

    pub(crate) fn at_tetrahedron(tetrahedron: usize, detail: String) -> Self {
        Defect { tetrahedron: Some(tetrahedron), detail, ..Defect::default() }
    }

    pub(crate) fn at_triangle(triangle: usize, detail: String) -> Self {
        Defect { triangle: Some(triangle), detail, ..Defect::default() }
    }

    pub(crate) fn at_point(point: usize, detail: String) -> Self {
        Defect { point: Some(point), detail, ..Defect::default() }
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(tetrahedron) = self.tetrahedron {
            write!(f, "tetrahedron {tetrahedron}: ")?;
        }
        if let Some(triangle) = self.triangle {
            write!(f, "triangle {triangle}: ")?;
        }
        if let Some(point) = self.point {
            write!(f, "point {point}: ")?;
        }
        f.write_str(&self.detail)
    }
}

/// How a check ended.
///
/// # Examples
///
/// ```
/// use gdel::{MeshView2, verify::{Check, Outcome}, verify2d};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let report = verify2d(&points, MeshView2::of_triangles(&[[0, 1, 2]]))?;
/// assert_eq!(report.outcome(Check::Delaunay), Some(&Outcome::Passed));
/// // Only the triangles were given.
/// assert_eq!(report.outcome(Check::Hull), Some(&Outcome::NotStated));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// The property holds.
    Passed,
    /// The property does not hold.
    Failed {
        /// One place where it fails.
        first: Defect,
        /// In how many places it fails.
        count: usize,
    },
    /// The mesh does not state what would be checked.
    NotStated,
    /// Not decided, because the check named here failed or was not decided.
    Blocked(Check),
}

/// The defects of one check: the first of them, and their number.
#[derive(Debug, Default)]
pub struct Findings {
    first: Option<Defect>,
    count: usize,
}

impl Findings {
    pub(crate) fn add(&mut self, defect: impl FnOnce() -> Defect) {
        self.first.get_or_insert_with(defect);
        self.count += 1;
    }

    /// Returns whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Adds where the defects are.
    pub(crate) fn within(mut self, place: &str) -> Self {
        if let Some(defect) = &mut self.first {
            defect.detail = format!("{} ({place})", defect.detail);
        }
        self
    }
}

/// Joins the findings of one check on consecutive parts of a mesh.
impl Extend<Findings> for Findings {
    fn extend<T: IntoIterator<Item = Findings>>(&mut self, parts: T) {
        for Findings { first, count } in parts {
            self.first = self.first.take().or(first);
            self.count += count;
        }
    }
}

impl FromIterator<Findings> for Findings {
    fn from_iter<T: IntoIterator<Item = Findings>>(parts: T) -> Self {
        let mut all = Findings::default();
        all.extend(parts);
        all
    }
}

impl From<Findings> for Outcome {
    fn from(Findings { first, count }: Findings) -> Self {
        first.map_or(Outcome::Passed, |first| Outcome::Failed { first, count })
    }
}

/// `None` are the findings about what the mesh does not state.
impl From<Option<Findings>> for Outcome {
    fn from(findings: Option<Findings>) -> Self {
        findings.map_or(Outcome::NotStated, Outcome::from)
    }
}

/// The numbers of points, edges, facets and so on.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0], [0.0, 0.0f64]];
/// let counts = gdel::verify2d(&points, &gdel::delaunay2d(&points)?)?.counts;
/// assert_eq!((counts.points, counts.distinct_points, counts.edges), (5, 4, 5));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counts {
    /// Points, duplicates included.
    pub points: usize,
    /// Points without duplicates and unused ones.
    pub distinct_points: usize,
    /// Points that the mesh states to be unused, which are not looked at.
    pub unused_points: usize,
    /// Points that are corners of tetrahedra, or of triangles in 2D.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Facets of tetrahedra, those on the hull included; triangles in 2D.
    pub facets: usize,
    /// Tetrahedra.
    pub tetrahedra: usize,
    /// Facets of a single tetrahedron.
    pub hull_triangles: usize,
    /// In 2D, edges of a single triangle.
    pub hull_edges: usize,
}

/// The outcome of every check.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let report = gdel::verify2d(&points, &gdel::delaunay2d(&points)?)?;
/// assert!(report.passed());
/// // One line per check.
/// println!("{report}");
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Report {
    /// Each check with its outcome, in the order of [`Check::ALL`].
    pub outcomes: Vec<(Check, Outcome)>,
    /// The affine dimension of the points, 0 to 3.
    pub dimension: u8,
    /// The numbers of points, simplices and their faces. If indices are broken, only points and
    /// simplices are counted.
    pub counts: Counts,
}

impl Report {
    /// Returns whether the mesh is the Delaunay triangulation of the points, or the regular one of
    /// weighted points.
    pub fn passed(&self) -> bool {
        self.outcomes.iter().all(|(_, outcome)| matches!(outcome, Outcome::Passed | Outcome::NotStated))
    }

    /// Returns the checks that failed, with the first defect of each and the number of its defects.
    pub fn failures(&self) -> impl Iterator<Item = (Check, &Defect, usize)> {
        self.outcomes.iter().filter_map(|(check, outcome)| match outcome {
            Outcome::Failed { first, count } => Some((*check, first, *count)),
            _ => None,
        })
    }

    /// Returns the outcome of one check.
    pub fn outcome(&self, check: Check) -> Option<&Outcome> {
        self.outcomes.iter().find(|(c, _)| *c == check).map(|(_, outcome)| outcome)
    }

    /// Decides the next check, unless one that it requires was not passed.
    pub(crate) fn decide<O: Into<Outcome>>(&mut self, check: Check, outcome: impl FnOnce() -> O) {
        let passed = |required: &&Check| matches!(self.outcome(**required), Some(Outcome::Passed));
        let outcome = match check.requires().iter().find(|required| !passed(required)) {
            Some(&required) => Outcome::Blocked(required),
            None => outcome().into(),
        };
        self.outcomes.push((check, outcome));
    }

    /// Decides the Delaunay property and that of the ties, in this order, by one pass over the
    /// mesh.
    pub(crate) fn decide_delaunay(&mut self, check: impl FnOnce() -> (Findings, Findings)) {
        let mut ties = Findings::default();
        self.decide(Check::Delaunay, || {
            let delaunay;
            (delaunay, ties) = check();
            delaunay
        });
        self.decide(Check::CanonicalTies, || ties);
    }
}

/// Prints one line per check.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (check, outcome)) in self.outcomes.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{check:<21}")?;
            match outcome {
                Outcome::Passed => write!(f, "passed")?,
                Outcome::Failed { first, count: 1 } => write!(f, "FAILED  {first}")?,
                Outcome::Failed { first, count } => write!(f, "FAILED  {first} (and {} more)", count - 1)?,
                Outcome::NotStated => write!(f, "-       not stated by the mesh")?,
                Outcome::Blocked(required) => write!(f, "-       not decided without {required}")?,
            }
        }
        Ok(())
    }
}
