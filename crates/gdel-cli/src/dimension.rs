//! `--dim`, and the operations on meshes of either dimension.

use super::failure::Failure;
use clap::{ValueEnum, builder::PossibleValuesParser, builder::TypedValueParser};
use gdel::{Error, Mesh2, Mesh3, Points, Points2, Points3, Triangulator, internals::mesh, verify::Report as Proof};
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
    fn triangulate(points: Points<'_, D>, triangulator: &Triangulator) -> Result<Self, Error>;
    fn verify(points: Points<'_, D>, mesh: &Self) -> Result<Proof, Error>;
    fn verify_data(points: Points<'_, D>, mesh: &MeshData<D, N>) -> Result<Proof, Error>;
    fn counts(&self) -> Counts;
}

/// The number of simplices.
#[derive(Clone, Copy, Serialize)]
#[serde(untagged)]
pub(super) enum Counts {
    D3 { tetrahedra: usize, hull_triangles: usize },
    D2 { triangles: usize, hull_edges: usize },
}

impl Triangulation<3, 4> for Mesh3 {
    fn triangulate(points: Points3<'_>, triangulator: &Triangulator) -> Result<Self, Error> {
        triangulator.delaunay3d(points)
    }

    fn verify(points: Points3<'_>, mesh: &Self) -> Result<Proof, Error> {
        gdel::verify3d(points, mesh)
    }

    fn verify_data(points: Points3<'_>, mesh: &MeshData3) -> Result<Proof, Error> {
        gdel::verify3d(points, mesh)
    }

    fn counts(&self) -> Counts {
        Counts::D3 { tetrahedra: self.tetrahedra.len(), hull_triangles: self.hull.len() }
    }
}

impl Triangulation<2, 3> for Mesh2 {
    fn triangulate(points: Points2<'_>, triangulator: &Triangulator) -> Result<Self, Error> {
        triangulator.delaunay2d(points)
    }

    fn verify(points: Points2<'_>, mesh: &Self) -> Result<Proof, Error> {
        gdel::verify2d(points, mesh)
    }

    fn verify_data(points: Points2<'_>, mesh: &MeshData2) -> Result<Proof, Error> {
        gdel::verify2d(points, mesh)
    }

    fn counts(&self) -> Counts {
        // The hull of collinear points is a sequence, which has no edges.
        let hull_edges = if self.dimension == 2 { self.hull.len() } else { 0 };
        Counts::D2 { triangles: self.triangles.len(), hull_edges }
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

/// Parses the name of a format of points, which is one of its extensions.
pub(super) fn format_parser() -> impl TypedValueParser<Value = PointFormat> {
    PossibleValuesParser::new(PointFormat::ALL.iter().flat_map(|format| format.extensions()))
        .try_map(|name| PointFormat::from_extension(&name).ok_or("no format of points"))
}
