//! Random degenerate points through files: written, read, triangulated, and the mesh again written,
//! read and proven.

use gdel::{Mesh2, Mesh3, Points, Points3, verify::Report};
use gdel_io::{Mesh, MeshData, MeshFormat, PointBuf, PointCloud, PointFormat, read_neigh, write_ele, write_neigh};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

#[path = "../../../../tests/shared/degenerate.rs"]
mod clouds;

/// What the test does in either dimension.
trait Triangulation<const D: usize, const N: usize>: Mesh<D, N> + Sized {
    fn triangulate(points: Points<'_, D>) -> Self;
    fn verify(points: Points<'_, D>, mesh: &Self) -> Report;
    fn verify_data(points: Points<'_, D>, mesh: &MeshData<D, N>) -> Report;
}

impl Triangulation<3, 4> for Mesh3 {
    fn triangulate(points: Points3<'_>) -> Self {
        gdel::delaunay3d(points).expect("finite points")
    }

    fn verify(points: Points3<'_>, mesh: &Self) -> Report {
        gdel::verify3d(points, mesh).expect("finite points")
    }

    fn verify_data(points: Points3<'_>, mesh: &MeshData<3, 4>) -> Report {
        gdel::verify3d(points, mesh).expect("finite points")
    }
}

impl Triangulation<2, 3> for Mesh2 {
    fn triangulate(points: Points<'_, 2>) -> Self {
        gdel::delaunay2d(points).expect("finite points")
    }

    fn verify(points: Points<'_, 2>, mesh: &Self) -> Report {
        gdel::verify2d(points, mesh).expect("finite points")
    }

    fn verify_data(points: Points<'_, 2>, mesh: &MeshData<2, 3>) -> Report {
        gdel::verify2d(points, mesh).expect("finite points")
    }
}

fn check<M: Triangulation<D, N>, const D: usize, const N: usize>() {
    let point_formats = [PointFormat::Text, PointFormat::Csv, PointFormat::Npy, PointFormat::Node, PointFormat::RawF64];
    for case in clouds::cases(100) {
        let random = &mut Pcg64Mcg::seed_from_u64(case);
        let points = clouds::points::<D>(random, 60);
        let stored = PointBuf::F64(points.clone());
        let points = Points::F64(&points);
        let format = point_formats[case as usize % point_formats.len()];
        let mut file = Vec::new();
        format.write(&mut file, points).expect("memory");
        let cloud: PointCloud<D> = format.read(file).unwrap_or_else(|error| panic!("case {case}, {format:?}: {error}"));
        assert_eq!(cloud.points, stored, "case {case}, {format:?}");

        let mesh = M::triangulate((&cloud).into());
        let report = M::verify(points, &mesh);
        assert!(report.passed(), "case {case}: {report}");
        let files = MeshFormat::ALL.iter().map(|format| {
            let mut file = Vec::new();
            match format {
                MeshFormat::TetGen => write_ele(&mut file, &mesh),
                MeshFormat::Vtu => gdel_io::write_vtu(&mut file, points, &mesh),
                MeshFormat::Npz => gdel_io::write_npz(&mut file, points, &mesh),
            }
            .expect("memory");
            format.read::<M, D, N>(&file).unwrap_or_else(|error| panic!("case {case}, {format:?}: {error}"))
        });
        for mut data in files {
            assert!(data.points.is_none() || data.points == Some(stored.clone()), "case {case}");
            let mut neigh = Vec::new();
            write_neigh(&mut neigh, &mesh).expect("memory");
            data.neighbors = Some(read_neigh::<M, D, N>(&neigh).expect("a whole file"));
            let report = M::verify_data(points, &data);
            assert!(report.passed(), "case {case}: {report}");
            // A simplex that is left out, or has another vertex, is found.
            if data.simplices.is_empty() {
                continue;
            }
            let at = random.random_range(0..data.simplices.len());
            let mut lacking = data.clone();
            lacking.simplices.remove(at);
            (lacking.neighbors, lacking.halfedges) = (None, None);
            assert!(!M::verify_data(points, &lacking).passed(), "case {case}: simplex {at} is missing");
            let vertex = &mut data.simplices[at][random.random_range(0..N)];
            *vertex = (*vertex + random.random_range(1..points.len() as u32)) % points.len() as u32;
            assert!(!M::verify_data(points, &data).passed(), "case {case}: simplex {at} has another vertex");
        }
    }
}

#[test]
fn degenerate_points_in_3d_through_files() {
    check::<Mesh3, _, _>();
}

#[test]
fn degenerate_points_in_2d_through_files() {
    check::<Mesh2, _, _>();
}
