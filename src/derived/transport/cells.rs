//! Power cells of sites with given weights: their volumes, and how these change with the weights.

use super::{in_order::InOrder, laplacian::Laplacian};
use crate::{
    cpu::{Incremental, MeshOf, regular},
    derived::voronoi::{Clip, Voronoi, VoronoiShapes},
    dimension::Dimension,
    error::Error,
    geometry::{Euclidean, vector},
    input::points::Points,
    mesh::{Mesh, MeshInfo},
    options::Options,
};

/// The cells of sites.
#[derive(Debug)]
pub(super) struct Cells {
    pub(super) volumes: Vec<f64>,
    /// The derivatives of the volumes by the weights: for two neighbours, minus the area of their facet over twice the
    /// distance of the sites.
    pub(super) derivatives: Laplacian,
}

impl Cells {
    /// Computes the cells of sites, which are distinct; none if the weights hide one.
    ///
    /// # Errors
    ///
    /// Returns the errors of the triangulation and of the diagram.
    pub(super) fn new<const D: usize, const N: usize>(
        sites: &[[f64; D]],
        weights: &[f64],
        clip: Clip<'_, D>,
        options: &Options,
    ) -> Result<Option<Self>, Error>
    where
        Dimension<D>: Incremental<D>,
        MeshOf<D>: Mesh<D, N>,
        Euclidean: VoronoiShapes<D, N>,
    {
        let mesh = regular::<D>(Points::F64(sites), weights, options)?;
        if mesh.hidden_count().is_some_and(|count| count > 0) {
            return Ok(None);
        }
        let mesh = InOrder::new(&mesh);
        let voronoi = Voronoi::new(&mesh, Points::F64(sites), clip)?;
        let found = voronoi.map_cells(|i, cell| {
            let site = sites[i as usize];
            let derivative = |(&j, &area): (&u32, &f64)| {
                let other = *sites.get(j as usize)?;
                Some((j, area / (2.0 * vector::norm(vector::minus(other, site)))))
            };
            let edges: Vec<_> = cell.neighbors.iter().zip(&cell.areas).filter_map(derivative).collect();
            (cell.volume, edges)
        });
        Ok(Some(Cells {
            volumes: found.iter().map(|&(volume, _)| volume).collect(),
            derivatives: Laplacian::new(found.iter().map(|(_, edges)| edges.as_slice())),
        }))
    }
}
