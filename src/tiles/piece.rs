//! A part with the points of its vertices.

use super::{
    bytes::{Reader, TOO_LONG, Writer},
    part::{BorderFacet, Part, Seam},
};
use crate::{error::Error, index::NONE};

/// The simplices of one tile with the points of their vertices: what a file of the tile needs.
///
/// Points are in the order of their indices, so that ties are the same whether vertices are numbered as here or as in
/// the whole input.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Piece<const D: usize, const N: usize> {
    /// All points that belong to the tile, and the vertices of its simplices that belong to others.
    pub points: Vec<[f64; D]>,
    /// The index of each point in the whole input.
    pub indices: Vec<u32>,
    /// The tile that each point belongs to.
    pub owners: Vec<u32>,
    /// The simplices and the hull, whose vertices are numbers of `points`; all else is as in any [`Part`].
    pub part: Part<N>,
}

impl<const D: usize, const N: usize> Piece<D, N> {
    /// Creates the piece of a tile from the points that it knows and its part, whose vertices are numbers of these.
    pub(super) fn new(tile: u32, points: &[[f64; D]], indices: &[u32], owners: &[u32], mut part: Part<N>) -> Self {
        let mut is_needed: Vec<bool> = owners.iter().map(|&owner| owner == tile).collect();
        for &v in part.simplices.as_flattened().iter().chain(part.hull.as_flattened()).filter(|&&v| v != NONE) {
            is_needed[v as usize] = true;
        }
        let mut order: Vec<u32> = (0..points.len() as u32).filter(|&v| is_needed[v as usize]).collect();
        order.sort_unstable_by_key(|&v| indices[v as usize]);
        let mut number = vec![NONE; points.len()];
        for (new, &v) in (0..).zip(&order) {
            number[v as usize] = new;
        }
        for v in part.simplices.as_flattened_mut().iter_mut().chain(part.hull.as_flattened_mut()) {
            *v = if *v == NONE { NONE } else { number[*v as usize] };
        }
        Piece {
            points: order.iter().map(|&v| points[v as usize]).collect(),
            indices: order.iter().map(|&v| indices[v as usize]).collect(),
            owners: order.iter().map(|&v| owners[v as usize]).collect(),
            part,
        }
    }
}

/// A neighbour in another tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Link {
    /// Its place among all entries of [`Part::neighbors`].
    pub place: u32,
    /// The tile.
    pub tile: u32,
    /// What stands for the neighbour there: an entry of that tile's [`Part::neighbors`].
    pub entry: u32,
}

impl<const D: usize, const N: usize> Piece<D, N> {
    /// Creates a piece from the arrays of a file: the points, their indices and tiles, the simplices, their neighbours, and
    /// duplicates with the points that they duplicate. [`Proof::add`](super::Proof::add) checks them.
    pub fn from_arrays(
        points: Vec<[f64; D]>,
        [indices, owners]: [Vec<u32>; 2],
        [simplices, neighbors]: [Vec<[u32; N]>; 2],
        duplicates: Vec<[u32; 2]>,
    ) -> Self {
        Piece { points, indices, owners, part: Part { simplices, neighbors, duplicates, ..Part::new(D as u8) } }
    }

    /// Returns the facets on which other pieces may border.
    pub fn rim(&self) -> Rim<D> {
        let hull = self.part.hull.iter();
        Rim {
            facets: self.part.borders.clone(),
            hull: hull.map(|facet| std::array::from_fn(|k| self.indices[facet[k] as usize])).collect(),
        }
    }
}

/// The facets of a piece on which other pieces may border, or none: all that is needed to find its [`Link`]s.
#[derive(Debug, Clone, PartialEq)]
pub struct Rim<const D: usize> {
    facets: Vec<BorderFacet>,
    /// The facets of the hull, by indices of points.
    hull: Vec<[u32; D]>,
}

const RIM: u32 = u32::from_le_bytes(*b"gdtr");

impl<const D: usize> Rim<D> {
    /// Returns the rim as bytes, the same on every machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Writer(Vec::new());
        bytes.words(&[RIM, D as u32, self.facets.len() as u32, self.hull.len() as u32]);
        for facet in &self.facets {
            bytes.words(&facet.vertices);
            bytes.words(&[facet.place, facet.entry]);
        }
        bytes.words(self.hull.as_flattened());
        bytes.0
    }

    /// Reads a rim.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BadMessage`] if that is not one, or one of another dimension.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let mut bytes = Reader(bytes);
        if bytes.word()? != RIM || bytes.word()? as usize != D {
            return Err(Error::BadMessage { reason: "it is not a rim of this dimension" });
        }
        let (facets, hull) = (bytes.word()?, bytes.word()?);
        let facets = bytes.rows::<5>(facets)?;
        let hull = bytes.rows::<D>(hull)?;
        let facet = |[a, b, c, place, entry]: [u32; 5]| BorderFacet { vertices: [a, b, c], place, entry };
        let rim = Rim { facets: facets.into_iter().map(facet).collect(), hull };
        if bytes.0.is_empty() { Ok(rim) } else { Err(TOO_LONG) }
    }
}

impl Seam<Link> {
    /// Adds the rim of a tile's piece. Returns the links that are known now: each with the number of the tile that it
    /// leads from.
    pub fn add_rim<const D: usize>(&mut self, tile: u32, rim: &Rim<D>) -> Vec<(u32, Link)> {
        let mut links = Vec::new();
        for &BorderFacet { vertices, place, entry } in &rim.facets {
            if let Some(other) = self.add(vertices, Link { place, tile, entry }) {
                links.push((tile, Link { place, ..other }));
                links.push((other.tile, Link { place: other.place, tile, entry }));
            }
        }
        rim.hull.iter().for_each(|&facet| self.add_hull(facet));
        links
    }
}
