//! The points that weights hide: each lies above the lifted simplex that contains it.

use crate::{
    index::NONE,
    parallel::{self, Threads},
    predicates::Sign,
    verify::{
        input::Input,
        report::{Defect, Findings},
    },
};

/// The simplices of a mesh, of which the other checks have shown that they cover the convex hull.
pub(crate) struct Simplices<'a, const D: usize, const N: usize> {
    pub(crate) simplices: &'a [[u32; N]],
    /// Returns the simplex opposite a vertex of another, or [`NONE`].
    pub(crate) across: &'a (dyn Fn(usize, usize) -> u32 + Sync),
    /// Returns the orientation of points.
    pub(crate) orientation: fn([[f64; D]; N]) -> Sign,
    /// Returns whether a point is below a simplex when all are lifted; ties are broken.
    pub(crate) is_below: &'a (dyn Fn([u32; N], u32) -> bool + Sync),
    /// Creates the defect of a simplex.
    pub(crate) blame: fn(usize, String) -> Defect,
}

impl<const D: usize, const N: usize> Simplices<'_, D, N> {
    /// Checks which points are hidden, and that the mesh states these. Without weights, every distinct point is to be a
    /// vertex, as another check decides: no point may be stated, and a mesh needs to state nothing.
    pub(crate) fn check(&self, input: &Input<D>, stated: Option<&[u32]>) -> Option<Findings> {
        let mut findings = Findings::default();
        if input.weights.is_empty() {
            if let Some(first) = stated?.first() {
                findings.add(|| Defect::in_mesh(format!("the mesh states that {first} is hidden, without weights")));
            }
            return Some(findings);
        }
        let mut is_vertex = vec![false; input.points.len()];
        self.simplices.as_flattened().iter().for_each(|&v| is_vertex[v as usize] = true);
        let is_spanned = usize::from(input.dimension) == D;
        let is_hidden = |&i: &u32| is_spanned && input.representative[i as usize] == i && !is_vertex[i as usize];
        let hidden: Vec<u32> = (0..input.points.len() as u32).filter(is_hidden).collect();
        if let Some(stated) = stated.filter(|&stated| stated != hidden) {
            let detail = match stated.iter().zip(&hidden).find(|(stated, hidden)| stated != hidden) {
                Some((stated, hidden)) => {
                    format!("the mesh states that {stated} is the next hidden point, not {hidden}")
                }
                None => format!("the mesh states {} hidden points, not {}", stated.len(), hidden.len()),
            };
            findings.add(|| Defect::in_mesh(detail));
        }
        findings.extend(parallel::map_ranges(Threads::All, hidden.len(), |range| {
            let (mut findings, mut start) = (Findings::default(), 0);
            for &i in &hidden[range] {
                match self.find(input, i, start) {
                    None => findings.add(|| Defect::at_point(i as usize, "no vertex, and in no simplex".to_owned())),
                    Some(t) => {
                        start = t;
                        if (self.is_below)(self.simplices[t], i) {
                            let detail = format!("hides point {i}, which is below it when all are lifted");
                            findings.add(|| (self.blame)(t, detail));
                        }
                    }
                }
            }
            findings
        }));
        Some(findings)
    }

    /// Returns a simplex that contains point `i`, if there is one, by a walk. The simplices are a regular triangulation,
    /// so it does not go in circles.
    fn find(&self, input: &Input<D>, i: u32, start: usize) -> Option<usize> {
        let is_beyond = |t: usize, k: usize| {
            let corner = |l: usize| if l == k { i } else { self.simplices[t][l] };
            (self.orientation)(std::array::from_fn(|l| input.points[corner(l) as usize])) < 0
        };
        let mut t = start;
        for _ in 0..self.simplices.len() {
            let Some(k) = (0..N).find(|&k| is_beyond(t, k)) else { return Some(t) };
            match (self.across)(t, k) {
                NONE => return None,
                across => t = across as usize,
            }
        }
        None
    }
}
