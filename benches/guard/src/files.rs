//! Files of all formats, in memory.

use crate::points::{self, POINTS};
use gdel::{Backend, Mesh3, Triangulator};
use gdel_io::{MeshFormat, PointFormat, SurfaceFormat, write_ele, write_npz, write_vtu};
use las::{Builder, Point, Transform, Vector};
use std::{fmt::Write, io::Cursor};

/// The files that are read.
#[derive(Debug, Clone, Copy)]
pub enum File {
    PlyAscii,
    PlyBinary,
    Obj,
    StlAscii,
    StlBinary,
    Text,
    Csv,
    PcdAscii,
    PcdBinary,
    Las,
    Laz,
    Npy,
    RawF32,
}

impl File {
    /// Returns the format, and a file of about [`POINTS`] points.
    pub fn bytes(self) -> (PointFormat, Vec<u8>) {
        let points = points::single(&points::uniform());
        let written = |format: PointFormat| {
            let mut file = Vec::new();
            format.write(&mut file, (&points).into()).expect("memory");
            (format, file)
        };
        let lines = || {
            points.iter().fold(String::new(), |mut lines, [x, y, z]| {
                writeln!(lines, "{x} {y} {z}").expect("memory");
                lines
            })
        };
        match self {
            File::PlyAscii => {
                let header = format!(
                    "ply\nformat ascii 1.0\nelement vertex {POINTS}\nproperty float x\nproperty float y\n\
                     property float z\nend_header\n"
                );
                (PointFormat::Ply, (header + &lines()).into())
            }
            File::PlyBinary => written(PointFormat::Ply),
            File::Obj => written(PointFormat::Obj),
            File::StlAscii => {
                let facets = points.as_chunks::<3>().0.iter().fold(String::new(), |mut facets, corners| {
                    facets += "facet normal 0 0 0\nouter loop\n";
                    for [x, y, z] in corners {
                        writeln!(facets, "vertex {x} {y} {z}").expect("memory");
                    }
                    facets + "endloop\nendfacet\n"
                });
                (PointFormat::Stl, format!("solid\n{facets}endsolid\n").into())
            }
            File::StlBinary => {
                let points = points::sphere(POINTS / 2);
                let mut file = Vec::new();
                SurfaceFormat::Stl.write(&mut file, (&points).into(), &mesh(&points)).expect("memory");
                (PointFormat::Stl, file)
            }
            File::Text => written(PointFormat::Text),
            File::Csv => written(PointFormat::Csv),
            File::PcdAscii => (PointFormat::Pcd, (pcd_header("ascii") + &lines()).into()),
            File::PcdBinary => {
                let numbers = points.as_flattened().iter().flat_map(|x| x.to_le_bytes());
                (PointFormat::Pcd, pcd_header("binary").into_bytes().into_iter().chain(numbers).collect())
            }
            File::Las => (PointFormat::Las, las(false)),
            File::Laz => (PointFormat::Las, las(true)),
            File::Npy => written(PointFormat::Npy),
            File::RawF32 => written(PointFormat::RawF32),
        }
    }
}

/// Returns a mesh file of that format.
pub fn mesh_file(format: MeshFormat) -> (MeshFormat, Vec<u8>) {
    let points = points::uniform();
    let mesh = mesh(&points);
    let mut file = Vec::new();
    match format {
        MeshFormat::TetGen => write_ele(&mut file, &mesh),
        MeshFormat::Vtu => write_vtu(&mut file, (&points).into(), &mesh),
        MeshFormat::Npz => write_npz(&mut file, (&points).into(), &mesh),
    }
    .expect("memory");
    (format, file)
}

fn mesh(points: &[[f64; 3]]) -> Mesh3 {
    Triangulator::new().backend(Backend::Cpu).delaunay3d(points).expect("finite points")
}

fn pcd_header(data: &str) -> String {
    format!(
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {POINTS}\nHEIGHT 1\n\
         VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {POINTS}\nDATA {data}\n"
    )
}

/// Returns a kilometre of terrain in millimetres.
fn las(is_compressed: bool) -> Vec<u8> {
    let mut builder = Builder::from((1, 4));
    builder.point_format = las::point::Format::new(0).expect("a format");
    builder.point_format.is_compressed = is_compressed;
    let axis = |offset| Transform { scale: 0.001, offset };
    builder.transforms = Vector { x: axis(500_000.0), y: axis(4_500_000.0), z: axis(0.0) };
    let header = builder.into_header().expect("a header");
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).expect("memory");
    for [x, y, z] in points::uniform() {
        let point =
            Point { x: 500_000.0 + 1e3 * x, y: 4_500_000.0 + 1e3 * y, z: 100.0 * z * x * y, ..Point::default() };
        writer.write_point(point).expect("memory");
    }
    writer.into_inner().expect("memory").into_inner()
}
