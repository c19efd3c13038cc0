//! The alpha complex for one radius.

use super::{
    super::{complex::Complex, sets::DisjointSets, sorted::Sorted, voronoi::ring},
    AlphaEdges, AlphaShape,
    edges::Edges,
    given_edge,
    values::{Alpha, certain},
};
use crate::{
    geometry::{Euclidean, facet},
    index::NONE,
};

/// What a face is in an alpha complex.
///
/// # Examples
///
/// ```
/// use gdel::FaceClass;
///
/// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [9.0, 9.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let shape = gdel::AlphaShape::new(&mesh, &points)?;
/// let complex = shape.at(1.5)?;
/// let class = |v: u32| complex.vertices().find(|&(w, _)| w == v).unwrap().1;
/// assert_eq!((class(0), class(3)), (FaceClass::Regular, FaceClass::Singular));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaceClass {
    /// Not part of the complex.
    Exterior,
    /// Part of the complex, but no face of a larger one that is.
    Singular,
    /// On the boundary of the complex, and a face of a larger one.
    Regular,
    /// Within the complex: all simplices around it are part of it.
    Interior,
}

impl FaceClass {
    /// Returns whether the face is part of the complex.
    pub fn is_part(self) -> bool {
        self != FaceClass::Exterior
    }
}

/// The alpha complex for one radius, which [`AlphaShape::at`] returns.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0f64]];
/// let mesh = gdel::delaunay3d(&points)?;
/// let shape = gdel::AlphaShape::new(&mesh, &points)?;
/// let complex = shape.at(10.0)?;
/// assert_eq!((complex.solid().count(), complex.surface().count()), (2, 6));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct AlphaComplex<'s, const D: usize = 3, const N: usize = 4> {
    shape: &'s AlphaShape<D, N>,
    alpha: Alpha,
    /// Whether each simplex of the sorted mesh is part of the complex, or what is in its place.
    is_solid: Vec<bool>,
}

impl<'s, const D: usize, const N: usize> AlphaComplex<'s, D, N>
where
    Euclidean: AlphaEdges<D, N>,
{
    pub(super) fn new(shape: &'s AlphaShape<D, N>, alpha: f64) -> Self {
        let alpha = shape.radii.alpha(alpha);
        let is_solid = |(simplex, squared): (&[u32], f64)| shape.radii.compare_with(simplex, squared, alpha) <= 0;
        let is_solid = shape.cells().map(is_solid).collect();
        AlphaComplex { shape, alpha, is_solid }
    }

    /// Returns the simplices that are part of the complex, in ascending order.
    pub fn solid(&self) -> impl Iterator<Item = usize> + '_ {
        let places = self.shape.radii.mesh.places.iter().enumerate();
        places.filter(|&(_, &place)| self.is_solid[place as usize]).map(|(t, _)| t)
    }

    /// Returns the boundary of the simplices that are part of the complex: triangles that are
    /// counter-clockwise as seen from outside, in 2D edges that have the inside on their left.
    ///
    /// The surface is closed: every edge belongs to as many triangles in one direction as in the
    /// other, in 2D every vertex to as many edges that end there as start there. Where solids touch
    /// in an edge or a vertex only, these are more than one. Triangles of points in a plane of space, and edges
    /// of points on a line in 2D, come from both sides.
    pub fn surface(&self) -> impl Iterator<Item = [u32; D]> + '_ {
        let mesh = &self.shape.radii.mesh;
        let solid = self.solid().flat_map(move |t| {
            let t = mesh.places[t] as usize;
            let is_outer = move |&k: &usize| mesh.complex.across(t, k).is_none_or(|across| !self.is_solid[across]);
            (0..N).filter(is_outer).map(move |k| mesh.given(facet(&mesh.complex.simplices[t], k)))
        });
        let flat = self.shape.flat_facets().filter(|&(t, _)| self.is_solid[t]);
        solid.chain(flat.flat_map(|(_, facet)| {
            let mut other = facet;
            other.swap(0, 1);
            [facet, other]
        }))
    }

    /// Returns for each simplex the number of its component, and the number of components.
    /// Components are simplices that hang together across facets, counted in the order of their
    /// first simplices; those that are no part of the complex have [`NONE`](crate::NONE).
    pub fn components(&self) -> (Vec<u32>, usize) {
        let Sorted { complex, places, .. } = &self.shape.radii.mesh;
        if let Some(flat) = &self.shape.flat {
            let mut sets = self.united(&flat.complex);
            let is_first = |&t: &u32| self.is_solid[t as usize] && sets.find(t) == t;
            return (Vec::new(), (0..self.is_solid.len() as u32).filter(is_first).count());
        }
        let mut sets = self.united(complex);
        let mut labels = vec![NONE; self.is_solid.len()];
        let mut label_of_set = labels.clone();
        let mut count = 0;
        for t in self.solid() {
            let label = &mut label_of_set[sets.find(places[t]) as usize];
            if *label == NONE {
                *label = count;
                count += 1;
            }
            labels[t] = *label;
        }
        (labels, count as usize)
    }

    /// Returns what hangs together across facets.
    fn united<const K: usize>(&self, complex: &Complex<'_, D, K>) -> DisjointSets {
        let mut sets = DisjointSets::new(self.is_solid.len());
        for t in (0..self.is_solid.len()).filter(|&t| self.is_solid[t]) {
            for across in (0..K).filter_map(|k| complex.across(t, k)).filter(|&across| self.is_solid[across]) {
                sets.unite(t as u32, across as u32);
            }
        }
        sets
    }

    /// Returns all facets and what they are: in the order of [`AlphaShape::facets`].
    pub fn facets(&self) -> impl Iterator<Item = ([u32; D], FaceClass)> + '_ {
        let facets = self.facet_classes().map(|((t, k), class)| (self.shape.given_facet(t, k), class));
        let class = |t: usize| if self.is_solid[t] { FaceClass::Singular } else { FaceClass::Exterior };
        facets.chain(self.shape.flat_facets().map(move |(t, facet)| (facet, class(t))))
    }

    /// Returns the facets of the sorted mesh as (simplex, opposite vertex), and what they are.
    fn facet_classes(&self) -> impl Iterator<Item = ((usize, usize), FaceClass)> + '_ {
        let complex = &self.shape.radii.mesh.complex;
        self.shape.listed_facets().zip(&self.shape.facets).map(move |((t, k), &own)| {
            let other = complex.across(t, k).map(|across| self.is_solid[across]);
            let class = match (self.is_solid[t], other) {
                (true, Some(true)) => FaceClass::Interior,
                (true, _) | (_, Some(true)) => FaceClass::Regular,
                _ if self.is_own(&facet(&complex.simplices[t], k), own) => FaceClass::Singular,
                _ => FaceClass::Exterior,
            };
            ((t, k), class)
        })
    }

    /// Returns all vertices and what they are: in ascending order.
    pub fn vertices(&self) -> impl Iterator<Item = (u32, FaceClass)> + '_ {
        let values = self.shape.vertex_values();
        // What is left open by rounded values depends on the faces around the vertex.
        let mut exactly = None;
        self.shape.given_vertices().map(move |(i, v)| {
            let [regular, interior] = values[v];
            let class = match (self.certainly(regular), self.certainly(interior)) {
                (Some(_), Some(true)) => FaceClass::Interior,
                (Some(true), Some(false)) => FaceClass::Regular,
                (Some(false), Some(false)) => FaceClass::Singular,
                _ => exactly.get_or_insert_with(|| self.classify_vertices())[v],
            };
            (i, class)
        })
    }

    /// Classifies all vertices of the sorted mesh by the faces around them.
    fn classify_vertices(&self) -> Vec<FaceClass> {
        let complex = &self.shape.radii.mesh.complex;
        let start = if complex.simplices.is_empty() { FaceClass::Regular } else { FaceClass::Interior };
        let mut classes = vec![start; complex.points().len()];
        let mut is_face = vec![false; classes.len()];
        for (_, (cell, _)) in self.shape.cells().enumerate().filter(|&(t, _)| self.is_solid[t]) {
            cell.iter().for_each(|&v| is_face[v as usize] = true);
        }
        for (_, simplex) in complex.simplices.iter().enumerate().filter(|&(t, _)| !self.is_solid[t]) {
            simplex.iter().for_each(|&v| classes[v as usize] = FaceClass::Regular);
        }
        for ((t, k), class) in self.facet_classes() {
            for v in facet(&complex.simplices[t], k) {
                is_face[v as usize] |= class != FaceClass::Exterior;
                if complex.across(t, k).is_none() {
                    classes[v as usize] = FaceClass::Regular;
                }
            }
        }
        let Edges { edges, own, .. } = self.shape.edge_values();
        for (edge, &own) in edges.iter().zip(own) {
            if self.is_own(edge, own) {
                edge.iter().for_each(|&v| is_face[v as usize] = true);
            }
        }
        for (class, is_face) in classes.iter_mut().zip(is_face) {
            if *class == FaceClass::Regular && !is_face {
                *class = FaceClass::Singular;
            }
        }
        classes
    }

    /// Returns whether a face is part of the complex by its own smallest sphere.
    fn is_own(&self, face: &[u32], own: f64) -> bool {
        own != f64::INFINITY && self.shape.radii.compare_with(face, own, self.alpha) <= 0
    }

    /// Returns whether a squared radius is at most alpha's, or `None` if rounding leaves that open.
    fn certainly(&self, squared: f64) -> Option<bool> {
        if squared == f64::INFINITY {
            return Some(false);
        }
        certain(squared, self.alpha.squared()).map(|sign| sign < 0)
    }
}

impl AlphaComplex<'_, 3, 4> {
    /// Returns all edges of a 3D mesh and what they are: in the order of [`AlphaShape::edges`].
    pub fn edges(&self) -> impl ExactSizeIterator<Item = ([u32; 2], FaceClass)> + '_ {
        let edges = self.shape.edge_values();
        edges.edges.iter().enumerate().map(move |(e, &edge)| {
            let class = match (self.certainly(edges.regular[e]), self.certainly(edges.interior[e])) {
                (_, Some(true)) => FaceClass::Interior,
                (Some(true), Some(false)) => FaceClass::Regular,
                (Some(false), Some(false)) if self.is_own(&edge, edges.own[e]) => FaceClass::Singular,
                (Some(false), Some(false)) => FaceClass::Exterior,
                _ => self.classify_edge(e),
            };
            (given_edge(&self.shape.radii.mesh, edge), class)
        })
    }

    /// Classifies an edge by the faces around it.
    fn classify_edge(&self, e: usize) -> FaceClass {
        let complex = &self.shape.radii.mesh.complex;
        let edges = self.shape.edge_values();
        let (edge, t) = (edges.edges[e], edges.simplex[e] as usize);
        if let Some(flat) = &self.shape.flat {
            return match flat.has_solid(t, edge, &self.is_solid) {
                true => FaceClass::Regular,
                false if self.is_own(&edge, edges.own[e]) => FaceClass::Singular,
                false => FaceClass::Exterior,
            };
        }
        let mut around = Vec::new();
        let is_closed = ring(complex, edge[0], edge[1], t, &mut around);
        if is_closed && around.iter().all(|&t| self.is_solid[t as usize]) {
            return FaceClass::Interior;
        }
        let has_solid = around.iter().any(|&t| self.is_solid[t as usize]);
        // The facets around the edge, those inside the ring twice.
        let mut facets = around.iter().flat_map(|&t| {
            let t = t as usize;
            let is_at_edge = move |&k: &usize| !edge.contains(&complex.simplices[t][k]);
            (0..4).filter(is_at_edge).map(move |k| (t, k))
        });
        let is_own = |(t, k): (usize, usize)| {
            let vertices = facet(&complex.simplices[t], k);
            let corners = vertices.map(|v| complex.point(v));
            let apexes = [Some((t, k)), complex.across(t, k).map(|u| (u, complex.facet_towards(u, t)))];
            let mut apexes = apexes.into_iter().flatten().filter_map(|(t, k)| complex.simplices[t].get(k));
            let is_attached = apexes.any(|&v| {
                <Euclidean as crate::geometry::Geometry<3, 4>>::in_smallest_sphere(&corners, complex.point(v))
            });
            !is_attached && self.shape.radii.compare_with(&vertices, f64::NAN, self.alpha) <= 0
        };
        if has_solid || facets.any(is_own) {
            FaceClass::Regular
        } else if self.is_own(&edge, edges.own[e]) {
            FaceClass::Singular
        } else {
            FaceClass::Exterior
        }
    }
}
