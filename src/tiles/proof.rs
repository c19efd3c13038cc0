//! Whether the pieces of all tiles are together the Delaunay triangulation of their points.

use super::{
    dim::Provable,
    part::{Seam, sorted},
    piece::{Link, Piece},
    survey::Survey,
};
use crate::{
    dimension::Dimension,
    error::Error,
    geometry::{self, Euclidean, Geometry},
    input::points::Points,
    verify::{Check, Defect, Outcome, Report, input::Input, report::Findings},
};
use rustc_hash::FxHashMap;
use std::{
    collections::BTreeMap,
    sync::{Mutex, OnceLock, PoisonError},
};

/// Proves that pieces, whoever computed them, are together the Delaunay triangulation of their points: as
/// [`verify3d`](crate::verify3d) and [`verify2d`](crate::verify2d) do for meshes, without all pieces in memory at a time.
/// Threads may add pieces at the same time, in any order.
///
/// The checks are those of these functions, except that of Euler's characteristic, without which they are enough, too.
/// Numbers of simplices in the report are those within a piece.
///
/// # Examples
///
/// ```
/// use gdel::tiles::{Plan, Proof, Survey, Tile};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0f64]];
/// let plan = Plan::new(Survey::<2>::new(&points, 0, 1)?, 1);
/// let mut tile = Tile::<2, 3>::new(plan, 0, points.to_vec(), vec![0, 1, 2, 3])?;
/// tile.step(Vec::new())?;
/// tile.step(Vec::new())?;
/// let proof = Proof::default();
/// proof.add(0, &tile.into_piece()?, Some(&[]))?;
/// assert!(proof.finish().passed());
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct Proof<const D: usize, const N: usize> {
    /// The corners of the first simplex.
    first: OnceLock<[[f64; D]; N]>,
    state: Mutex<State<D, N>>,
}

/// What is known of all pieces so far.
#[derive(Debug)]
struct State<const D: usize, const N: usize> {
    findings: BTreeMap<Check, Findings>,
    simplices: usize,
    /// Whether all pieces have stated their neighbours.
    has_neighbors: bool,
    survey: Option<Survey<D>>,
    /// The points of which it is known which tile they belong to.
    owned: Bits,
    /// Of these, points that are vertices of no simplex of their tile.
    unused: Vec<(u32, [f64; D])>,
    /// Vertices in other tiles than their own.
    foreign: Vec<(u32, [f64; D])>,
    seam: Seam<Side<D, N>>,
}

/// The side of a facet that is a simplex of a piece.
#[derive(Debug, Clone)]
struct Side<const D: usize, const N: usize> {
    indices: [u32; N],
    corners: [[f64; D]; N],
    /// The vertex that the facet is opposite to.
    k: usize,
    /// The tile and the simplex.
    at: [u32; 2],
    /// The place among the entries of neighbours, and the entry that stands for this simplex.
    place: [u32; 2],
    /// The tile and the entry across the facet as they are stated.
    stated: Option<[u32; 2]>,
}

impl<const D: usize, const N: usize> Default for Proof<D, N> {
    fn default() -> Self {
        let state = State {
            findings: BTreeMap::new(),
            simplices: 0,
            has_neighbors: true,
            survey: None,
            owned: Bits::default(),
            unused: Vec::new(),
            foreign: Vec::new(),
            seam: Seam::default(),
        };
        Proof { first: OnceLock::new(), state: Mutex::new(state) }
    }
}

impl<const D: usize, const N: usize> Proof<D, N>
where
    Dimension<D>: Provable<D, N>,
    Euclidean: Geometry<D, N>,
{
    /// Takes the piece of a tile, and what it states of its neighbours in other tiles. Without `links`, the piece states no
    /// neighbours.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotFinite`] and [`Error::TooManyPoints`], by the numbers of points in the piece, and
    /// [`Error::ValueCount`] if arrays of the piece do not have one entry per point.
    pub fn add(&self, tile: u32, piece: &Piece<D, N>, links: Option<&[Link]>) -> Result<(), Error> {
        let Piece { points, indices, owners, part } = piece;
        for count in [indices.len(), owners.len()] {
            if count != points.len() {
                return Err(Error::ValueCount { values: count, points: points.len() });
            }
        }
        let input = Input::new(Points::F64(points), None, None, Dimension::<D>::dimension_of)?;
        let is_own = |v: u32| owners[v as usize] == tile;
        let mut found: Vec<(Check, Findings)> = Vec::new();
        let mut order = Findings::default();
        if !indices.is_sorted_by(|a, b| a < b) {
            order.add(|| Defect::in_mesh("the indices of its points do not ascend".into()));
        }
        let sides = Dimension::<D>::check_simplices(
            &input,
            &part.simplices,
            links.map(|_| &*part.neighbors),
            &mut |check, findings| {
                found.push((check, findings));
            },
        );
        let is_whole = order.is_empty() && !found.iter().any(|(check, f)| *check == Check::Indices && !f.is_empty());
        found.push((Check::Indices, order));
        if is_whole {
            found.extend(self.check_covering(&input.points, &part.simplices));
        }
        let own: Vec<[f64; D]> = (0..).zip(&input.points).filter(|&(v, _)| is_own(v)).map(|(_, &p)| p).collect();
        let survey = Survey::new(Points::F64(&own), 0, u32::MAX)?;
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.simplices += part.simplices.len();
        state.has_neighbors &= links.is_some();
        if is_whole {
            state.add_points(tile, piece, &input, &mut found);
            state.add_sides(tile, piece, sides, links.unwrap_or_default(), &mut found);
        }
        let place = format!("tile {tile}");
        for (check, findings) in found {
            state.findings.entry(check).or_default().extend([findings.within(&place)]);
        }
        match &mut state.survey {
            Some(known) => known.merge(survey),
            none => *none = Some(survey),
        }
        Ok(())
    }

    /// Checks that no simplex contains a point inside the first one of all pieces.
    fn check_covering(&self, points: &[[f64; D]], simplices: &[[u32; N]]) -> Option<(Check, Findings)> {
        let first = simplices.first()?.map(|v| points[v as usize]);
        let mut others = simplices;
        let inside = self.first.get_or_init(|| {
            others = &simplices[1..];
            first
        });
        Some((Check::Covering, Dimension::<D>::check_overlaps(*inside, points, others)))
    }

    /// Ends the proof: checks the hull, and that every point is a vertex.
    pub fn finish(self) -> Report {
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        state.finish(self.first.into_inner())
    }
}

impl<const D: usize, const N: usize> State<D, N>
where
    Dimension<D>: Provable<D, N>,
    Euclidean: Geometry<D, N>,
{
    /// Notes which points belong to the tile and which are vertices, and checks duplicates.
    fn add_points(&mut self, tile: u32, piece: &Piece<D, N>, input: &Input<D>, found: &mut Vec<(Check, Findings)>) {
        let (mut duplicates, mut vertices) = (Findings::default(), Findings::default());
        let mut stated: FxHashMap<u32, u32> = piece.part.duplicates.iter().map(|&[i, first]| (i, first)).collect();
        let mut is_used = vec![false; input.points.len()];
        piece.part.simplices.as_flattened().iter().for_each(|&v| is_used[v as usize] = true);
        for (v, &index) in piece.indices.iter().enumerate() {
            let (p, first) = (input.points[v], input.representative[v] as usize);
            if piece.owners[v] != tile {
                if is_used[v] {
                    self.foreign.push((index, p));
                }
                continue;
            }
            if !self.owned.insert(index) {
                vertices.add(|| Defect::at_point(index as usize, "it belongs to two tiles".into()));
            }
            let expected = if first == v { None } else { Some(piece.indices[first]) };
            let stated = stated.remove(&index);
            if stated != expected {
                let name = |i: Option<u32>| i.map_or("none".into(), |i| format!("point {i}"));
                let detail = format!("the point that it duplicates is {}, not {}", name(expected), name(stated));
                duplicates.add(|| Defect::at_point(index as usize, detail));
            }
            match (is_used[v], expected) {
                (true, Some(first)) => {
                    vertices
                        .add(|| Defect::at_point(index as usize, format!("a vertex that duplicates point {first}")));
                }
                (false, None) => self.unused.push((index, p)),
                _ => {}
            }
        }
        for i in stated.keys() {
            duplicates.add(|| Defect::at_point(*i as usize, "a duplicate that does not belong to the tile".into()));
        }
        found.extend([(Check::Duplicates, duplicates), (Check::Vertices, vertices)]);
    }

    /// Checks the facets that a simplex of an earlier piece is on the other side of.
    fn add_sides(
        &mut self,
        tile: u32,
        piece: &Piece<D, N>,
        sides: Vec<[u32; 2]>,
        links: &[Link],
        found: &mut Vec<(Check, Findings)>,
    ) {
        let mut stated: FxHashMap<u32, [u32; 2]> = links.iter().map(|l| (l.place, [l.tile, l.entry])).collect();
        for [t, k] in sides {
            let simplex = piece.part.simplices[t as usize];
            let indices = simplex.map(|v| piece.indices[v as usize]);
            let place = Dimension::<D>::side(t, k as usize);
            let side = Side {
                indices,
                corners: simplex.map(|v| piece.points[v as usize]),
                k: k as usize,
                at: [tile, t],
                place,
                stated: stated.remove(&place[0]),
            };
            let facet: [u32; D] = geometry::facet(&indices, side.k);
            if let Some(other) = self.seam.add(sorted(facet), side.clone()) {
                side.check(&other, self.has_neighbors, found);
            }
        }
        let mut extra = Findings::default();
        for (place, [other, entry]) in stated {
            let detail =
                format!("entry {place} of the neighbors is not in another tile, and {entry} of tile {other} stated");
            extra.add(|| Defect::in_mesh(detail));
        }
        found.push((Check::Neighbors, extra));
    }

    /// Checks the hull, and that every point is a vertex.
    fn finish(self, first: Option<[[f64; D]; N]>) -> Report {
        let State { mut findings, survey, simplices, has_neighbors, owned, unused, foreign, seam } = self;
        let mut report = Report { dimension: survey.as_ref().map_or(0, Survey::dimension), ..Report::default() };
        report.counts.points = owned.count();
        let count = if D == 2 { &mut report.counts.facets } else { &mut report.counts.tetrahedra };
        *count = simplices;
        let is_full = usize::from(report.dimension) == D;
        findings.entry(Check::Vertices).or_default().extend([check_vertices(&unused, foreign, &owned, is_full)]);
        let hull: Vec<Side<D, N>> = seam.into_open().collect();
        let mut lost = Findings::default();
        for side in hull.iter().filter(|side| side.stated.is_some()) {
            lost.add(|| side.defect("a neighbor in another tile is stated where there is none"));
        }
        findings.entry(Check::Neighbors).or_default().extend([lost]);
        if let Some(first) = first {
            check_hull(first, &hull, &mut findings);
        }
        let mut taken = |check: Check| findings.remove(&check).unwrap_or_default();
        for check in [Check::Duplicates, Check::Indices, Check::Vertices, Check::Orientation, Check::Facets] {
            report.decide(check, || taken(check));
        }
        report.decide(Check::Neighbors, || has_neighbors.then(|| taken(Check::Neighbors)));
        for check in [Check::Delaunay, Check::CanonicalTies, Check::HullClosed, Check::HullConvex] {
            report.decide(check, || taken(check));
        }
        // Without edges, which cannot be counted piece by piece, Euler's characteristic is not known, nor needed.
        if D == 3 {
            let covering = match report.outcome(Check::HullConvex) {
                Some(Outcome::Passed) => taken(Check::Covering).into(),
                _ => Outcome::Blocked(Check::HullConvex),
            };
            report.outcomes.push((Check::Covering, covering));
        }
        report
    }
}

/// Checks that points are vertices of other tiles where they are none in their own, and that vertices are points.
fn check_vertices<const D: usize>(
    unused: &[(u32, [f64; D])],
    mut foreign: Vec<(u32, [f64; D])>,
    owned: &Bits,
    is_full: bool,
) -> Findings {
    let mut findings = Findings::default();
    foreign.sort_unstable_by_key(|&(index, _)| index);
    for &(index, _) in foreign.iter().filter(|&&(index, _)| !owned.contains(index)) {
        findings.add(|| Defect::at_point(index as usize, "a vertex that belongs to no tile".into()));
    }
    for &(index, p) in unused.iter().filter(|_| is_full) {
        let from = foreign.partition_point(|&(other, _)| other < index);
        match foreign.get(from) {
            Some(&(other, q)) if other == index && q == p => {}
            _ => findings.add(|| Defect::at_point(index as usize, "not a vertex of any simplex".into())),
        }
    }
    if let Some(index) = (0..owned.end()).find(|&index| !owned.contains(index)) {
        findings.add(|| Defect::at_point(index as usize, "it belongs to no tile".into()));
    }
    findings
}

/// Checks the hull, of which these are the sides.
fn check_hull<const D: usize, const N: usize>(
    first: [[f64; D]; N],
    hull: &[Side<D, N>],
    findings: &mut BTreeMap<Check, Findings>,
) where
    Dimension<D>: Provable<D, N>,
{
    let mut all: Vec<(u32, [f64; D])> = hull.iter().flat_map(|s| s.indices.into_iter().zip(s.corners)).collect();
    all.sort_unstable_by_key(|&(index, _)| index);
    all.dedup_by_key(|&mut (index, _)| index);
    let number = |index: u32| all.partition_point(|&(other, _)| other < index) as u32;
    let points: Vec<[f64; D]> = all.iter().map(|&(_, p)| p).collect();
    let simplices: Vec<[u32; N]> = hull.iter().map(|side| side.indices.map(number)).collect();
    let facets: Vec<usize> = hull.iter().map(|side| side.k).collect();
    let mut moved = Findings::default();
    for (side, simplex) in hull.iter().zip(&simplices) {
        if simplex.map(|v| points[v as usize]) != side.corners {
            moved.add(|| side.defect(MOVED));
        }
    }
    findings.entry(Check::Vertices).or_default().extend([moved]);
    for (check, found) in Dimension::<D>::check_hull(first, &points, &simplices, &facets) {
        findings.entry(check).or_default().extend([found]);
    }
}

const MOVED: &str = "a vertex has other coordinates in another tile";

impl<const D: usize, const N: usize> Side<D, N> {
    fn defect(&self, what: &str) -> Defect {
        Defect::in_mesh(format!("{what} (simplex {} of tile {})", self.at[1], self.at[0]))
    }

    /// Checks the facet between two simplices. The neighbours are checked if they are stated.
    fn check(&self, other: &Self, has_neighbors: bool, found: &mut Vec<(Check, Findings)>)
    where
        Dimension<D>: Provable<D, N>,
    {
        let mut note = |check, what: &str| {
            let mut findings = Findings::default();
            findings.add(|| self.defect(what));
            found.push((check, findings));
        };
        for (index, p) in self.indices.iter().zip(&self.corners) {
            if other.indices.iter().zip(&other.corners).any(|(i, q)| i == index && p != q) {
                note(Check::Vertices, MOVED);
            }
        }
        let (apex, index) = (other.corners[other.k], other.indices[other.k]);
        let mut mirrored = self.corners;
        mirrored[self.k] = apex;
        if Dimension::<D>::orientation(mirrored) >= 0 {
            note(Check::Facets, "on the same side of a facet as one of another tile");
        }
        match Dimension::<D>::in_sphere(self.corners, self.indices, apex, index) {
            [1, _] => note(Check::Delaunay, "a point of another tile is inside the circumsphere"),
            [0, 1] => note(Check::CanonicalTies, "a point of another tile is inside by the order of the indices"),
            _ => {}
        }
        let links_to = |other: &Self| Some([other.at[0], other.place[1]]);
        if has_neighbors && (self.stated != links_to(other) || other.stated != links_to(self)) {
            note(Check::Neighbors, "the neighbor that is stated in another tile is a different one");
        }
    }
}

/// A set of indices.
#[derive(Debug, Default)]
struct Bits(Vec<u64>);

impl Bits {
    /// Adds an index. Returns whether it is new.
    fn insert(&mut self, index: u32) -> bool {
        let at = index as usize / 64;
        if self.0.len() <= at {
            self.0.resize(at + 1, 0);
        }
        let is_new = !self.contains(index);
        self.0[at] |= 1 << (index % 64);
        is_new
    }

    fn contains(&self, index: u32) -> bool {
        self.0.get(index as usize / 64).is_some_and(|word| word >> (index % 64) & 1 == 1)
    }

    fn count(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Returns an index that is greater than all of them.
    fn end(&self) -> u32 {
        self.0.last().map_or(0, |word| self.0.len() as u32 * 64 - word.leading_zeros())
    }
}
