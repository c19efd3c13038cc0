//! Instruction counts by callgrind, for `scripts/guard.sh`, which compares them with
//! `figures.json`.
//!
//! Setting up and dropping what a function returns are not counted.

use gdel::{
    Backend, Mesh2, Mesh3, Points, Triangulator, internals::d3::splay::SplayOutcome, verify::Report,
    verify2d as prove2d, verify3d as prove3d,
};
use gdel_guard::{
    files::{File, mesh_file},
    points::{self, FEW, POINTS},
    predicates::{Lists, Stage},
    splay::{Spoilt, expect_delaunay},
};
use gdel_io::{MeshData3, MeshFormat, PointCloud, PointFormat};
use gungraun::{Callgrind, prelude::*};
use std::hint::black_box;

/// SSE2 only, and no string instructions, whatever the size.
const PORTABLE_COPIES: &str = "glibc.cpu.hwcaps=-AVX_Fast_Unaligned_Load,-AVX2,-AVX512F,-AVX512VL,-ERMS,-FSRM,-SSSE3:\
                               glibc.cpu.x86_non_temporal_threshold=0x10000000";

fn cpu() -> Triangulator {
    Triangulator::new().backend(Backend::Cpu)
}

#[library_benchmark]
#[bench::uniform(points::uniform())]
#[bench::grid(points::grid(22))]
#[bench::sphere(points::sphere(POINTS))]
#[bench::clusters(points::clusters())]
fn delaunay3d(points: Vec<[f64; 3]>) -> (Vec<[f64; 3]>, Mesh3) {
    let mesh = cpu().delaunay3d(&points).expect("finite points");
    (points, mesh)
}

#[library_benchmark]
#[bench::sphere(points::single(&points::sphere(POINTS)))]
fn delaunay3d_f32(points: Vec<[f32; 3]>) -> (Vec<[f32; 3]>, Mesh3) {
    let mesh = cpu().delaunay3d(&points).expect("finite points");
    (points, mesh)
}

#[library_benchmark]
#[bench::uniform(points::uniform2())]
#[bench::grid(points::grid2())]
#[bench::circle(points::circle2())]
#[bench::clusters(points::clusters2())]
fn delaunay2d(points: Vec<[f64; 2]>) -> (Vec<[f64; 2]>, Mesh2) {
    let mesh = cpu().delaunay2d(&points).expect("finite points");
    (points, mesh)
}

#[library_benchmark(setup = Lists::orient3d)]
#[bench::filter(Stage::Filter)]
#[bench::narrow(Stage::Narrow)]
#[bench::wide(Stage::Wide)]
#[bench::expansion(Stage::Expansion)]
fn orient3d(lists: Lists<3, 4>) -> (i32, Lists<3, 4>) {
    (black_box(&lists).sum_orient3d(), lists)
}

#[library_benchmark(setup = Lists::insphere)]
#[bench::filter(Stage::Filter)]
#[bench::narrow(Stage::Narrow)]
#[bench::wide(Stage::Wide)]
#[bench::expansion(Stage::Expansion)]
#[bench::tie(Stage::Tie)]
fn insphere(lists: Lists<3, 5>) -> (i32, Lists<3, 5>) {
    (black_box(&lists).sum_insphere(), lists)
}

#[library_benchmark(setup = Lists::orient2d)]
#[bench::filter(Stage::Filter)]
#[bench::narrow(Stage::Narrow)]
#[bench::wide(Stage::Wide)]
#[bench::expansion(Stage::Expansion)]
fn orient2d(lists: Lists<2, 3>) -> (i32, Lists<2, 3>) {
    (black_box(&lists).sum_orient2d(), lists)
}

#[library_benchmark(setup = Lists::incircle)]
#[bench::filter(Stage::Filter)]
#[bench::narrow(Stage::Narrow)]
#[bench::wide(Stage::Wide)]
#[bench::expansion(Stage::Expansion)]
#[bench::tie(Stage::Tie)]
fn incircle(lists: Lists<2, 4>) -> (i32, Lists<2, 4>) {
    (black_box(&lists).sum_incircle(), lists)
}

#[library_benchmark(setup = Spoilt::new, teardown = expect_delaunay)]
#[bench::uniform(points::uniform(), 5e-4)]
#[bench::grid(points::grid(11), 1e-6)]
#[bench::sphere(points::sphere(FEW), 1e-4)]
fn splay(spoilt: Spoilt) -> SplayOutcome {
    spoilt.splay()
}

fn triangulated(points: Vec<[f64; 3]>) -> (Vec<[f64; 3]>, Mesh3) {
    let mesh = cpu().delaunay3d(&points).expect("finite points");
    (points, mesh)
}

fn triangulated2(points: Vec<[f64; 2]>) -> (Vec<[f64; 2]>, Mesh2) {
    let mesh = cpu().delaunay2d(&points).expect("finite points");
    (points, mesh)
}

fn expect_passed<T>((report, _): (Report, T)) {
    assert!(report.passed(), "{report:?}");
}

#[library_benchmark(setup = triangulated, teardown = expect_passed)]
#[bench::uniform(points::uniform())]
#[bench::grid(points::grid(11))]
#[bench::sphere(points::sphere(FEW))]
fn verify3d((points, mesh): (Vec<[f64; 3]>, Mesh3)) -> (Report, (Vec<[f64; 3]>, Mesh3)) {
    (prove3d(&points, &mesh).expect("finite points"), (points, mesh))
}

#[library_benchmark(setup = triangulated2, teardown = expect_passed)]
#[bench::uniform(points::uniform2())]
#[bench::grid(points::grid2())]
#[bench::circle(points::circle2())]
fn verify2d((points, mesh): (Vec<[f64; 2]>, Mesh2)) -> (Report, (Vec<[f64; 2]>, Mesh2)) {
    (prove2d(&points, &mesh).expect("finite points"), (points, mesh))
}

fn expect_points(cloud: PointCloud) {
    let read = Points::from(&cloud.points).len();
    assert!((POINTS / 2..=4 * POINTS).contains(&read), "{read} points");
}

#[library_benchmark(setup = File::bytes, teardown = expect_points)]
#[bench::ply_ascii(File::PlyAscii)]
#[bench::ply_binary(File::PlyBinary)]
#[bench::obj(File::Obj)]
#[bench::stl_ascii(File::StlAscii)]
#[bench::stl_binary(File::StlBinary)]
#[bench::text(File::Text)]
#[bench::csv(File::Csv)]
#[bench::pcd_ascii(File::PcdAscii)]
#[bench::pcd_binary(File::PcdBinary)]
#[bench::las(File::Las)]
#[bench::laz(File::Laz)]
#[bench::npy(File::Npy)]
#[bench::raw_f32(File::RawF32)]
fn read_points((format, bytes): (PointFormat, Vec<u8>)) -> PointCloud {
    format.read(bytes).expect("a file of that format")
}

fn expect_mesh(mesh: MeshData3) {
    assert!(mesh.simplices.len() > POINTS);
}

#[library_benchmark(setup = mesh_file, teardown = expect_mesh)]
#[bench::tetgen(MeshFormat::TetGen)]
#[bench::vtu(MeshFormat::Vtu)]
#[bench::npz(MeshFormat::Npz)]
fn read_mesh((format, bytes): (MeshFormat, Vec<u8>)) -> MeshData3 {
    format.read::<Mesh3, _, _>(&bytes).expect("a file of that format")
}

library_benchmark_group!(
    name = all,
    benchmarks = [
        delaunay3d,
        delaunay3d_f32,
        delaunay2d,
        orient3d,
        insphere,
        orient2d,
        incircle,
        splay,
        verify3d,
        verify2d,
        read_points,
        read_mesh,
    ]
);

main!(
    config = LibraryBenchmarkConfig::default()
        // Instructions only: nothing is compared by the simulated caches, which double the time.
        // glibc chooses among its copies of memory by the processor and the sizes of its caches.
        .env("GLIBC_TUNABLES", PORTABLE_COPIES)
        .tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = all
);
