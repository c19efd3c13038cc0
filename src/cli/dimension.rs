//! `--dim`, and what the commands do with the meshes of either dimension.

use super::Failure;
use clap::{ValueEnum, builder::PossibleValuesParser, builder::TypedValueParser};
use gdel::{
    Error, Mesh2, Mesh3, Points, Points2, Triangulator,
    internals::io::{
        Mesh, MeshData, MeshData2, MeshData3, PointCloud, PointFormat,
        files::{Input, shown},
    },
    stats::Stats,
    verify::Report as Proof,
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

/// A mesh that the commands make and verify.
pub(super) trait Triangulation<const D: usize, const N: usize>: Mesh<D, N> + Sized {
    fn triangulate(points: Points<'_, D>, triangulator: &Triangulator) -> Result<Self, Error>;
    fn verify(points: Points<'_, D>, mesh: &Self) -> Result<Proof, Error>;
    fn verify_data(points: Points<'_, D>, mesh: &MeshData<D, N>) -> Result<Proof, Error>;
    fn counts(&self) -> Counts;
    fn duplicates(&self) -> usize;
    fn dimension(&self) -> u8;
    fn stats(&self) -> &Stats;
}

/// How many simplices there are.
#[derive(Clone, Copy, Serialize)]
#[serde(untagged)]
pub(super) enum Counts {
    D3 { tetrahedra: usize, hull_triangles: usize },
    D2 { triangles: usize, hull_edges: usize },
}

impl Triangulation<3, 4> for Mesh3 {
    fn triangulate(points: Points<'_>, triangulator: &Triangulator) -> Result<Self, Error> {
        triangulator.delaunay3d(points)
    }

    fn verify(points: Points<'_>, mesh: &Self) -> Result<Proof, Error> {
        gdel::verify3d(points, mesh)
    }

    fn verify_data(points: Points<'_>, mesh: &MeshData3) -> Result<Proof, Error> {
        gdel::verify3d(points, mesh)
    }

    fn counts(&self) -> Counts {
        Counts::D3 { tetrahedra: self.tetrahedra.len(), hull_triangles: self.hull.len() }
    }

    fn duplicates(&self) -> usize {
        self.duplicate_count()
    }

    fn dimension(&self) -> u8 {
        self.dimension
    }

    fn stats(&self) -> &Stats {
        &self.stats
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
        // Collinear points have ends and an order, which are no edges.
        let hull_edges = if self.dimension == 2 { self.hull.len() } else { 0 };
        Counts::D2 { triangles: self.triangles.len(), hull_edges }
    }

    fn duplicates(&self) -> usize {
        self.duplicate_count()
    }

    fn dimension(&self) -> u8 {
        self.dimension
    }

    fn stats(&self) -> &Stats {
        &self.stats
    }
}

/// Reads the points, with a word on standard error if that loses a coordinate.
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
