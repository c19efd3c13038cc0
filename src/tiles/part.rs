//! The simplices of one tile, and the mesh of all.

use super::{border::Vertices, dim::Tiled};
use crate::{
    cpu::{Incremental, MeshOf},
    dimension::Dimension,
    error::Error,
    geometry::{self, Euclidean, Geometry},
    index::NONE,
    mesh::MeshInfo,
    options::{Options, Winding},
    parallel::{self, CHUNK},
};
use rustc_hash::FxHashMap;

/// The simplices of which the vertex with the lowest index is one of a [`Tile`](super::Tile)'s own.
///
/// Vertices are indices of the whole input. A neighbour that is a simplex of another part is found by the facet
/// between them: both parts have it in [`borders`](Part::borders), except where it is on the hull.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Part<const N: usize> {
    /// The vertices of the simplices, as in [`Mesh3::tetrahedra`](crate::Mesh3::tetrahedra) or
    /// [`Mesh2::triangles`](crate::Mesh2::triangles).
    pub simplices: Vec<[u32; N]>,
    /// The neighbours in the part, as in [`Mesh3::neighbors`](crate::Mesh3::neighbors) or
    /// [`Mesh2::halfedges`](crate::Mesh2::halfedges); [`NONE`] outside the hull and in other parts.
    pub neighbors: Vec<[u32; N]>,
    /// The facets that may lead to other parts.
    pub borders: Vec<BorderFacet>,
    /// The facets of the hull whose vertex with the lowest index is one of the tile's own, with [`NONE`] after them.
    pub hull: Vec<[u32; N]>,
    /// The tile's own points that duplicate others, each with that one.
    pub duplicates: Vec<[u32; 2]>,
    /// The affine dimension of the whole input.
    pub dimension: u8,
}

/// A facet of a [`Part`] that may lead to another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BorderFacet {
    /// The vertices in ascending order; in 2D, [`NONE`] is the last one.
    pub vertices: [u32; 3],
    /// The place of the neighbour among all entries of [`Part::neighbors`].
    pub place: u32,
    /// What stands for this facet's simplex as a neighbour.
    pub entry: u32,
}

impl<const N: usize> Part<N> {
    /// Creates a part without simplices.
    pub(super) fn new(dimension: u8) -> Self {
        Part {
            simplices: Vec::new(),
            neighbors: Vec::new(),
            borders: Vec::new(),
            hull: Vec::new(),
            duplicates: Vec::new(),
            dimension,
        }
    }
}

/// Marks ghosts among the numbers of simplices.
pub(super) const GHOST: u32 = NONE - 1;

/// Returns the vertices of a facet in ascending order, as a [`BorderFacet`] has them.
pub(super) fn sorted<const D: usize>(facet: [u32; D]) -> [u32; 3] {
    let mut vertices = [NONE; 3];
    vertices.iter_mut().zip(facet).for_each(|(to, v)| *to = v);
    vertices.sort_unstable();
    vertices
}

/// What is around a [`Core`](super::Core): the other simplices of its tile.
pub(super) struct Around<'a> {
    /// Whether the simplex in each slot is one of them, rather than where the core is.
    pub(super) is_around: &'a [bool],
    /// The facets of the core, by those of these simplices that are the same.
    pub(super) across: &'a FxHashMap<u32, u32>,
    /// The number of simplices of the core.
    pub(super) before: u32,
}

/// Adds the finite simplices of a triangulation of which the vertex with the lowest index is one of the tile's own,
/// and the facets of the hull likewise. Vertex *v* has the index `indices[v]`, and `names` turns it to what simplices and
/// hull are to have. The arrays are those of the triangulation. If there is a core, numbers begin after its simplices.
///
/// Returns the number of the simplex in each slot; [`GHOST`] and [`NONE`] for those that are not in the part.
pub(super) fn fill<const D: usize, const N: usize>(
    part: &mut Part<N>,
    triangulation: <Dimension<D> as Incremental<D>>::Triangulation,
    indices: &[u32],
    names: impl Fn(u32) -> u32,
    (of, around): (Vertices<'_>, Option<&Around<'_>>),
    winding: Winding,
) -> Vec<u32>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let slots = Dimension::<D>::slots(&triangulation);
    let index = |v: u32| indices[v as usize];
    let before = around.map_or(0, |around| around.before);
    let (number, count) = numbered::<D, N>(&triangulation, indices, (of, around), |facet| {
        let mut hull = [NONE; N];
        hull.iter_mut().zip(facet).for_each(|(to, v)| *to = names(v));
        part.hull.push(hull);
    });
    let [mut simplices, mut neighbors] = Dimension::<D>::into_arrays(triangulation);
    // None moves to the right, so that each is still where it was when it is read.
    parallel::in_pieces(slots as usize, CHUNK, &mut |piece| {
        for t in piece {
            let this = number[t];
            if this >= GHOST {
                continue;
            }
            let (simplex, mut across) = (simplices[t], neighbors[t]);
            for (k, f) in across.iter_mut().enumerate() {
                let other = number[(*f >> 2) as usize];
                if let Some(&of_core) = around.and_then(|around| around.across.get(&(4 * t as u32 + k as u32))) {
                    *f = of_core;
                    continue;
                }
                if other < GHOST {
                    *f = 4 * other + (*f & 3);
                    continue;
                }
                *f = NONE;
                let facet: [u32; D] = geometry::facet(&simplex, k);
                // What is beyond a facet with one of the tile's own vertices is known.
                if other == GHOST && facet.iter().any(|&v| v < of.own) {
                    continue;
                }
                let vertices = sorted(facet.map(index));
                let [place, entry] = Dimension::<D>::place(this, k, winding);
                part.borders.push(BorderFacet { vertices, place, entry });
            }
            let at = (this - before) as usize;
            simplices[at] = Dimension::<D>::to_mesh(simplex.map(&names), winding);
            neighbors[at] = Dimension::<D>::entries(across, winding);
        }
    });
    simplices.truncate((count - before) as usize);
    neighbors.truncate((count - before) as usize);
    (part.simplices, part.neighbors) = (simplices, neighbors);
    number
}

/// Returns the number of the simplex in each slot, [`GHOST`] and [`NONE`] where there is none in the part, and how many
/// there are with those of the core. Facets of the hull that are in the part go to `add_hull`.
fn numbered<const D: usize, const N: usize>(
    triangulation: &<Dimension<D> as Incremental<D>>::Triangulation,
    indices: &[u32],
    (of, around): (Vertices<'_>, Option<&Around<'_>>),
    mut add_hull: impl FnMut([u32; D]),
) -> (Vec<u32>, u32)
where
    Dimension<D>: Tiled<D, N>,
{
    let infinite = of.infinite();
    let is_ours = |simplex: &[u32; N]| {
        let finite = simplex.iter().copied().filter(|&v| v != infinite);
        let lowest = || finite.min_by_key(|&v| indices[v as usize]);
        !simplex.iter().any(|&v| of.is_foreign(v)) || lowest().is_some_and(|v| v < of.own)
    };
    let slots = Dimension::<D>::slots(triangulation);
    let mut number = vec![NONE; slots as usize];
    let mut count = around.map_or(0, |around| around.before);
    parallel::in_pieces(slots as usize, CHUNK, &mut |piece| {
        for t in piece.start as u32..piece.end as u32 {
            let Some(simplex) = Dimension::<D>::simplex(triangulation, t) else { continue };
            if around.is_some_and(|around| !around.is_around[t as usize]) {
                continue;
            }
            match Dimension::<D>::ghost_facet(simplex, infinite) {
                Some(facet) => {
                    number[t as usize] = GHOST;
                    if is_ours(&simplex) {
                        add_hull(facet);
                    }
                }
                None if is_ours(&simplex) => {
                    number[t as usize] = count;
                    count += 1;
                }
                None => {}
            }
        }
    });
    (number, count)
}

/// Joins the parts of all tiles to the mesh of all `points` points.
///
/// # Errors
///
/// Returns [`Error::BrokenMesh`] if these are not all parts of one triangulation, and [`Error::TooManySimplices`].
///
/// # Examples
///
/// See [`Tile`](super::Tile).
pub fn join<const D: usize, const N: usize>(parts: Vec<Part<N>>, points: usize) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Tiled<D, N>,
{
    join_with::<D, N>(parts, points, &Options::default())
}

/// Joins parts with options.
pub(super) fn join_with<const D: usize, const N: usize>(
    parts: Vec<Part<N>>,
    points: usize,
    options: &Options,
) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Tiled<D, N>,
{
    let broken = |reason| Err(Error::BrokenMesh { reason });
    let count: usize = parts.iter().map(|part| part.simplices.len()).sum();
    let limit = (u32::MAX / 4) as usize;
    if count > limit {
        return Err(Error::TooManySimplices { limit });
    }
    let dimension = parts.first().map_or(0, |part| part.dimension);
    let (mut simplices, mut neighbors) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let (mut hull, mut duplicate_of) = (Vec::new(), vec![NONE; points]);
    let mut all_borders = Vec::new();
    for part in parts {
        let Part { simplices: own, neighbors: near, borders, hull: facets, duplicates, .. } = part;
        if near.len() != own.len() || own.as_flattened().iter().any(|&v| v as usize >= points) {
            return broken("a part has vertices that are no points");
        }
        let base = simplices.len() as u32;
        let by = base * Dimension::<D>::STRIDE;
        simplices.extend(own);
        neighbors.extend(near.into_iter().map(|near| near.map(|e| if e == NONE { NONE } else { e + by })));
        let moved = |facet: BorderFacet| {
            let place = facet.place.checked_add(base * N as u32)?;
            Some(BorderFacet { place, entry: facet.entry.checked_add(by)?, ..facet })
        };
        for facet in borders {
            let Some(facet) = moved(facet) else { return broken("a part has too few facets") };
            all_borders.push(facet);
        }
        for facet in facets {
            let mut vertices = [NONE; D];
            vertices.iter_mut().zip(facet).for_each(|(to, v)| *to = v);
            hull.push(vertices);
        }
        for [i, first] in duplicates {
            let Some(entry) = duplicate_of.get_mut(i as usize) else { return broken("a duplicate is no point") };
            *entry = first;
        }
    }
    let entries: &mut [u32] = neighbors.as_flattened_mut();
    for [place, entry] in links(all_borders, &hull)? {
        let Some(to) = entries.get_mut(place as usize) else { return broken("a part has too few facets") };
        *to = entry;
    }
    let mut mesh = Dimension::<D>::assemble(simplices, neighbors, hull, options.winding);
    mesh.set_input(duplicate_of, dimension);
    Ok(mesh)
}

/// Returns places and the entries that belong there, of the neighbours in other parts, from the border facets of all parts,
/// whose places and entries are those of the whole mesh, and from the facets of the hull.
///
/// # Errors
///
/// Returns [`Error::BrokenMesh`] if a facet leads nowhere.
pub fn links<const D: usize>(
    borders: impl IntoIterator<Item = BorderFacet>,
    hull: &[[u32; D]],
) -> Result<Vec<[u32; 2]>, Error> {
    let mut seam = Seam::default();
    let mut links = Vec::new();
    for BorderFacet { vertices, place, entry } in borders {
        if let Some([other, beyond]) = seam.add(vertices, [place, entry]) {
            links.extend([[place, beyond], [other, entry]]);
        }
    }
    hull.iter().for_each(|&facet| seam.add_hull(facet));
    if seam.is_closed() { Ok(links) } else { Err(Error::BrokenMesh { reason: "a part of it is missing" }) }
}

/// The facets of which one side is known so far. Parts can be added one after the other, in any order.
///
/// # Examples
///
/// ```
/// use gdel::tiles::Seam;
///
/// let mut seam = Seam::default();
/// assert_eq!(seam.add([1, 2, 3], "one"), None);
/// assert_eq!(seam.add([1, 2, 4], "another"), None);
/// assert_eq!(seam.add([1, 2, 3], "the other side"), Some("one"));
/// assert!(!seam.is_closed());
/// seam.add_hull([4, 2, 1]);
/// assert!(seam.is_closed());
/// ```
#[derive(Debug, Clone)]
pub struct Seam<T>(FxHashMap<[u32; 3], Option<T>>);

impl<T> Default for Seam<T> {
    fn default() -> Self {
        Seam(FxHashMap::default())
    }
}

impl<T> Seam<T> {
    /// Adds one side of a facet whose vertices are those of a [`BorderFacet`]. Returns the other side if it was added
    /// before.
    pub fn add(&mut self, vertices: [u32; 3], side: T) -> Option<T> {
        match self.0.remove(&vertices) {
            None => {
                self.0.insert(vertices, Some(side));
                None
            }
            Some(other) => other,
        }
    }

    /// Adds a facet of the hull, in any order of its vertices: it has one side.
    pub fn add_hull<const D: usize>(&mut self, facet: [u32; D]) {
        let vertices = sorted(facet);
        // That of a facet whose simplex knows that nothing is beyond it stays.
        if self.0.remove(&vertices).is_none() {
            self.0.insert(vertices, None);
        }
    }

    /// Returns the sides that have not found the other one.
    pub fn into_open(self) -> impl Iterator<Item = T> {
        self.0.into_values().flatten()
    }

    /// Returns whether every side has found the other one.
    pub fn is_closed(&self) -> bool {
        self.0.values().all(Option::is_none)
    }
}
