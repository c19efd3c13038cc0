//! The checks of every mesh: of devices that are wrong about a single simplex, neighbour, vertex or facet of the hull.

use gdel::{
    Error,
    internals::{
        Options,
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        dimension::Dimension,
        gpu::{
            AdapterChoice, Gpu,
            engine::{Complete, Destination, GpuEngine, Outcome},
            host::Here,
            mutation::Mutation,
            phase1::{Settings, WayToHost},
        },
        input::points::Points,
    },
};
use pollster::block_on;
use std::sync::Arc;

/// What is wrong, the kernel, and in its WGSL what is replaced, by what.
type Mistake = (&'static str, &'static str, &'static str, &'static str);

/// In what every mesh is made of.
const OF_PHASE1_3D: [Mistake; 4] = [
    (
        "a wrong neighbour",
        "d3/mesh_compact",
        "mesh_neighbors[number]=across;",
        "if number==7{across.y^=1u;}mesh_neighbors[number]=across;",
    ),
    (
        "a lost tetrahedron",
        "d3/mesh_compact",
        "mesh_tetrahedra[number]=points;",
        "if number!=7{mesh_tetrahedra[number]=points;}",
    ),
    (
        "a flipped tetrahedron",
        "d3/mesh_compact",
        "mesh_tetrahedra[number]=points;",
        "mesh_tetrahedra[number]=select(points,points.yxzw,number==7);",
    ),
    (
        "a wrong vertex",
        "d3/mesh_compact",
        "mesh_tetrahedra[number]=points;",
        "if number==7{points.x=(points.x+1)%1000;}mesh_tetrahedra[number]=points;",
    ),
];

/// In the arrays of meshes that stay on the device.
const OF_ARRAYS_3D: [Mistake; 7] = [
    ("a wrong neighbour", "d3/outputs_write", "across(near.x),", "across(near.x)+i32(number==7),"),
    ("a neighbour that is none", "d3/outputs_write", "across(near.x),", "select(across(near.x),-1,number==7),"),
    (
        "a lost tetrahedron",
        "d3/outputs_write",
        "out_tetrahedra[number]=tet;",
        "if number!=7{out_tetrahedra[number]=tet;}",
    ),
    (
        "a flipped tetrahedron",
        "d3/outputs_write",
        "out_tetrahedra[number]=tet;",
        "out_tetrahedra[number]=select(tet,tet.yxzw,number==7);",
    ),
    (
        "a wrong vertex",
        "d3/outputs_write",
        "out_tetrahedra[number]=tet;",
        "out_tetrahedra[number]=vec4u(select(tet.x,(tet.x+1)%1000,number==7),tet.yzw);",
    ),
    (
        "a facet of the hull turned over",
        "d3/outputs_write",
        "out_hull[at]=tet.x;",
        "if at==9{tet=tet.yxzw;}out_hull[at]=tet.x;",
    ),
    (
        "a wrong simplex of a point",
        "d3/vertex_simplex",
        "let simplex=i/CORNERS;",
        "let simplex=select(i/CORNERS,0u,v==7);",
    ),
];

const OF_2D: [Mistake; 5] = [
    ("a wrong neighbour", "d2/mesh_compact", "select(3*there+", "u32(number==7)+select(3*there+"),
    (
        "a lost triangle",
        "d2/mesh_compact",
        "mesh_triangles[3*number+k]=points[k];",
        "if number!=7{mesh_triangles[3*number+k]=points[k];}",
    ),
    (
        "a flipped triangle",
        "d2/mesh_compact",
        "mesh_triangles[3*number+k]=points[k];",
        "mesh_triangles[3*number+k]=select(points[k],points[(3-k)%3],number==7);",
    ),
    (
        "a wrong vertex",
        "d2/mesh_compact",
        "mesh_triangles[3*number+k]=points[k];",
        "mesh_triangles[3*number+k]=select(points[k],(points[k]+1)%1000,number==7&&k==1);",
    ),
    (
        "a wrong half-edge of the hull",
        "d2/mesh_compact",
        "vec2u(points[k],",
        "vec2u(select(points[k],points[(k+2)%3],true),",
    ),
];

/// Returns what comes of points on a device that makes a mistake.
fn outcome<const D: usize>(gpu: &Gpu, way: WayToHost, points: &[[f64; D]], mistake: Mistake) -> Result<(), Error>
where
    Dimension<D>: Complete<D>,
{
    let (what, kernel, from, to) = mistake;
    let edit = move |wgsl: String| {
        assert!(wgsl.contains(from), "{what}: {kernel} has another text");
        wgsl.replacen(from, to, 1)
    };
    let gpu = gpu.mutated(Some(Mutation { kernel, edit: Arc::new(edit) }));
    let mut engine = block_on(GpuEngine::<D>::new(gpu))?;
    engine.set_settings(Settings { way_to_host: Some(way), ..Settings::default() });
    let options = Options::default();
    let mut host = Here::new(Points::F64(points), &options, Default::default());
    match block_on(engine.drive(&mut host, &options, Destination::Host(Default::default())))? {
        Outcome::Made(_) => Ok(()),
        Outcome::LeftToCpu(stats) => panic!("{what}: left to the CPU, {:?}", stats.fallback),
    }
}

fn is_noticed(outcome: Result<(), Error>, (what, ..): Mistake) {
    println!("{what}: {outcome:?}");
    assert!(matches!(outcome, Err(Error::WrongResults { .. })), "{what}: {outcome:?}");
}

#[test]
fn one_wrong_tetrahedron_is_noticed_wherever_the_mesh_goes() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let points = generate3d(Distribution3::Uniform, 1_000, 1);
    for mistake in OF_PHASE1_3D {
        for way in [WayToHost::MadeOnDevice, WayToHost::ReadMeanwhile, WayToHost::ReadFirst] {
            is_noticed(outcome(&gpu, way, &points, mistake), mistake);
        }
    }
    for mistake in OF_ARRAYS_3D {
        is_noticed(outcome(&gpu, WayToHost::MadeOnDevice, &points, mistake), mistake);
    }
}

#[test]
fn one_wrong_triangle_is_noticed_wherever_the_mesh_goes() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let points = generate2d(Distribution2::Uniform, 1_000, 1);
    for mistake in OF_2D {
        for way in [WayToHost::MadeOnDevice, WayToHost::ReadFirst] {
            is_noticed(outcome(&gpu, way, &points, mistake), mistake);
        }
    }
    let mistake = ("a wrong simplex of a point", "d2/vertex_simplex", OF_ARRAYS_3D[6].2, OF_ARRAYS_3D[6].3);
    is_noticed(outcome(&gpu, WayToHost::MadeOnDevice, &points, mistake), mistake);
}

/// Triangulates on the device, where no check may fail.
fn run_without_alarm<const D: usize>(engine: &mut GpuEngine<D>, points: &[[f64; D]], way: Option<WayToHost>)
where
    Dimension<D>: Complete<D>,
{
    engine.set_settings(Settings { way_to_host: way, ..Settings::default() });
    if let Err(error) = block_on(engine.triangulate(Points::F64(points), &Options::default())) {
        panic!("{} points in {D} dimensions, {way:?}: {error}", points.len());
    }
}

#[test]
#[ignore = "takes minutes: for hardware"]
fn a_thousand_runs_raise_no_alarm() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut d3 = block_on(GpuEngine::<3>::new(gpu.clone())).expect("the kernels compile");
    let mut d2 = block_on(GpuEngine::<2>::new(gpu)).expect("the kernels compile");
    let ways = [None, Some(WayToHost::MadeOnDevice), Some(WayToHost::ReadMeanwhile), Some(WayToHost::ReadFirst)];
    for run in 0..500 {
        let (way, count) = (ways[run % ways.len()], 1_000 * (1 + run * 37 % 60));
        let shape = Distribution3::ALL[run % Distribution3::ALL.len()];
        run_without_alarm(&mut d3, &generate3d(shape, count, run as u64), way);
        let shape = Distribution2::ALL[run % Distribution2::ALL.len()];
        run_without_alarm(&mut d2, &generate2d(shape, count, run as u64), way);
    }
}
