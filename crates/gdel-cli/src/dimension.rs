//! `--dim`, and the operations on meshes of either dimension.

use super::failure::Failure;
use clap::{ValueEnum, builder::PossibleValuesParser, builder::TypedValueParser, error::ErrorKind};
use gdel::{
    AlphaShape, Clip, Error, Mesh2, Mesh3, Points, Points2, Points3, Transport, TransportOptions, Triangulator,
    internals::{
        gpu::{device_mesh::MeshArrays, self_test::fingerprint},
        mesh,
    },
    verify::Report as Proof,
};
use gdel_io::{
    MeshData, MeshData2, MeshData3, PointCloud, PointFormat,
    files::{Input, shown},
};
use serde::Serialize;

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Dimension {
    /// 2D: triangles
    #[value(name = "2")]
    Two,
    /// 3D: tetrahedra
    #[value(name = "3")]
    Three,
}

/// Calls a function that is generic over meshes for those of a dimension.
macro_rules! in_dimension {
    ($dimension:expr, $function:ident, $argument:expr) => {
        match $dimension {
            $crate::dimension::Dimension::Three => $function::<gdel::Mesh3, 3, 4>($argument),
            $crate::dimension::Dimension::Two => $function::<gdel::Mesh2, 2, 3>($argument),
        }
    };
}
pub(super) use in_dimension;

/// A mesh that the commands make and verify.
pub(super) trait Triangulation<const D: usize, const N: usize>:
    gdel_io::Mesh<D, N> + mesh::MeshInfo + Sized
{
    /// Triangulates points, which may have weights.
    fn triangulate(points: Points<'_, D>, weights: Option<&[f64]>, triangulator: &Triangulator) -> Result<Self, Error>;
    /// Finds the weights with which the cells of points have given volumes.
    fn transport(
        points: Points<'_, D>,
        clip: Clip<'_, D>,
        options: &TransportOptions<'_>,
        triangulator: &Triangulator,
    ) -> Result<Transport, Error>;
    fn verify(points: Points<'_, D>, mesh: &Self) -> Result<Proof, Error>;
    fn verify_data(points: Points<'_, D>, mesh: &MeshData<D, N>) -> Result<Proof, Error>;
    /// Gives points in a plane of space the hull that files have: their polygon, from both sides.
    fn close_hull(&mut self, points: Points<'_, D>) -> Result<(), Error>;
    fn counts(&self) -> Counts;
    /// Returns a number that depends on the set of simplices and on which are neighbours.
    fn fingerprint(&self) -> u64;
}

/// The number of simplices.
#[derive(Clone, Copy, Serialize)]
#[serde(untagged)]
pub(super) enum Counts {
    D3 { tetrahedra: usize, hull_triangles: usize },
    D2 { triangles: usize, hull_edges: usize },
}

impl Triangulation<3, 4> for Mesh3 {
    fn triangulate(points: Points3<'_>, weights: Option<&[f64]>, triangulator: &Triangulator) -> Result<Self, Error> {
        match weights {
            Some(weights) => triangulator.regular3d(points, weights),
            None => triangulator.delaunay3d(points),
        }
    }

    fn transport(
        points: Points3<'_>,
        clip: Clip<'_, 3>,
        options: &TransportOptions<'_>,
        triangulator: &Triangulator,
    ) -> Result<Transport, Error> {
        triangulator.transport3d(points, clip, options)
    }

    fn verify(points: Points3<'_>, mesh: &Self) -> Result<Proof, Error> {
        gdel::verify3d(points, mesh)
    }

    fn verify_data(points: Points3<'_>, mesh: &MeshData3) -> Result<Proof, Error> {
        gdel::verify3d(points, mesh)
    }

    fn close_hull(&mut self, points: Points3<'_>) -> Result<(), Error> {
        if self.dimension == 2 {
            // Weights do not change the polygon.
            let mut plain = self.clone();
            plain.weights.clear();
            self.hull = AlphaShape::new(&plain, points)?.at(f64::INFINITY)?.surface().collect();
        }
        Ok(())
    }

    fn counts(&self) -> Counts {
        Counts::D3 { tetrahedra: self.tetrahedra.len(), hull_triangles: self.hull.len() }
    }

    fn fingerprint(&self) -> u64 {
        let [simplices, neighbors, _] = gdel::internals::dimension::Dimension::<3>::words(self);
        fingerprint::<3>(simplices, neighbors)
    }
}

impl Triangulation<2, 3> for Mesh2 {
    fn triangulate(points: Points2<'_>, weights: Option<&[f64]>, triangulator: &Triangulator) -> Result<Self, Error> {
        match weights {
            Some(weights) => triangulator.regular2d(points, weights),
            None => triangulator.delaunay2d(points),
        }
    }

    fn transport(
        points: Points2<'_>,
        clip: Clip<'_, 2>,
        options: &TransportOptions<'_>,
        triangulator: &Triangulator,
    ) -> Result<Transport, Error> {
        triangulator.transport2d(points, clip, options)
    }

    fn verify(points: Points2<'_>, mesh: &Self) -> Result<Proof, Error> {
        gdel::verify2d(points, mesh)
    }

    fn verify_data(points: Points2<'_>, mesh: &MeshData2) -> Result<Proof, Error> {
        gdel::verify2d(points, mesh)
    }

    fn close_hull(&mut self, _: Points2<'_>) -> Result<(), Error> {
        Ok(())
    }

    fn counts(&self) -> Counts {
        // The hull of collinear points is a sequence, which has no edges.
        let hull_edges = if self.dimension == 2 { self.hull.len() } else { 0 };
        Counts::D2 { triangles: self.triangles.len(), hull_edges }
    }

    fn fingerprint(&self) -> u64 {
        let [simplices, neighbors, _] = gdel::internals::dimension::Dimension::<2>::words(self);
        fingerprint::<2>(simplices, neighbors)
    }
}

/// Reads the points, with a note on standard error if a coordinate is dropped.
pub(super) fn read<const D: usize>(input: &Input) -> Result<PointCloud<D>, Failure> {
    let cloud: PointCloud<D> = input.read()?;
    if cloud.dropped_z {
        eprintln!("gdel: {}: the z coordinates are dropped", shown(input.path()));
    }
    Ok(cloud)
}

/// The argument `--rescale`: nothing for the extents, or one factor per axis.
#[derive(Debug, Clone)]
pub(super) struct Rescale(Vec<f64>);

impl Rescale {
    /// Parses factors, separated by commas.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let factor = |text: &str| text.trim().parse().ok().filter(|factor: &f64| *factor > 0.0 && factor.is_finite());
        let factors = if text.is_empty() { Some(Vec::new()) } else { text.split(',').map(factor).collect() };
        factors.map(Rescale).ok_or_else(|| "positive numbers, separated by commas, are needed".into())
    }

    /// Returns the factor of each axis of points.
    pub(super) fn factors<const D: usize>(&self, points: Points<'_, D>) -> Result<[f64; D], Failure> {
        if self.0.is_empty() {
            return Ok(points.unit_factors());
        }
        let what = format!("--rescale needs {D} factors, one per axis");
        self.0.as_slice().try_into().map_err(|_| Failure::Usage(ErrorKind::WrongNumberOfValues, what))
    }
}

/// Parses the name of a format of points, which is one of its extensions.
pub(super) fn format_parser() -> impl TypedValueParser<Value = PointFormat> {
    PossibleValuesParser::new(PointFormat::ALL.iter().flat_map(|format| format.extensions()))
        .try_map(|name| PointFormat::from_extension(&name).ok_or("no format of points"))
}
