//! Tiles that are triangulated on devices of their own make the mesh of all points.

use crate::clouds;
use gdel::{
    Backend, Error, Mesh2, Mesh3, Points, Triangulator,
    internals::{
        Options,
        cpu::{self, MeshOf},
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
        gpu::{AdapterChoice, Gpu},
    },
    stats::Fallback,
    tiles::{Message, Plan, Survey, Tile, Tiled, join},
    verify2d, verify3d,
};
use pollster::block_on;
use std::{sync::Arc, thread};

type Sent<const D: usize> = Vec<(u32, Message<D>)>;

/// Two devices, as of two adapters.
fn devices() -> [Triangulator; 2] {
    [(); 2].map(|()| {
        let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a Vulkan driver");
        Triangulator::from_gpu(gpu).backend(Backend::Gpu)
    })
}

/// Triangulates points in tiles, of which each device has every other one. Returns why the CPU did it of some, too.
fn in_tiles<const D: usize, const N: usize>(
    devices: &[Triangulator; 2],
    points: &[[f64; D]],
    tiles: u32,
) -> (MeshOf<D>, Vec<Fallback>)
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
    for<'a> &'a [[f64; D]]: Into<Points<'a, D>>,
{
    let plan = Arc::new(Plan::new(Survey::new(points, 0, 50).unwrap(), tiles));
    let mut tiles: Vec<Tile<D, N>> = (0..)
        .zip(plan.split(points, 0))
        .map(|(number, (own, indices))| Tile::new(Arc::clone(&plan), number, own, indices).unwrap())
        .collect();
    let mut received: Vec<Sent<D>> = vec![Vec::new(); tiles.len()];
    for step in 1.. {
        let mut of_devices: [Vec<(u32, &mut Tile<D, N>, Sent<D>)>; 2] = Default::default();
        for (number, (tile, received)) in (0..).zip(tiles.iter_mut().zip(&mut received)) {
            of_devices[number as usize % 2].push((number, tile, std::mem::take(received)));
        }
        let sent: Vec<(u32, Sent<D>)> = thread::scope(|scope| {
            let work = devices.iter().zip(of_devices).map(|(device, tiles)| {
                let step_on = |(number, tile, received): (u32, &mut Tile<D, N>, Sent<D>)| {
                    Ok((number, tile.step_on(device, received)?))
                };
                scope.spawn(move || tiles.into_iter().map(step_on).collect::<Result<Vec<_>, Error>>())
            });
            let work: Vec<_> = work.collect();
            work.into_iter().flat_map(|work| work.join().unwrap().unwrap()).collect()
        });
        received = vec![Vec::new(); tiles.len()];
        for (from, messages) in sent {
            messages.into_iter().for_each(|(to, message)| received[to as usize].push((from, message)));
        }
        // In the order of their senders, whichever device was first.
        received.iter_mut().for_each(|received| received.sort_by_key(|&(from, _)| from));
        if step > 1 && received.iter().all(Vec::is_empty) {
            break;
        }
    }
    let fallbacks = tiles.iter().filter_map(|tile| tile.stats().fallback.clone()).collect::<Vec<_>>();
    let on_gpu = tiles.iter().filter(|tile| tile.stats().backend == Backend::Gpu).count();
    assert_eq!(on_gpu + fallbacks.len(), tiles.len());
    let parts = tiles.into_iter().map(|tile| tile.finish().unwrap()).collect();
    (join::<D, N>(parts, points.len()).unwrap(), fallbacks)
}

#[test]
fn tiles_on_two_devices_make_the_mesh_of_all_points() {
    let devices = devices();
    let mut inputs: Vec<(&str, Vec<[f64; 3]>)> =
        Distribution3::ALL.iter().map(|&kind| (kind.name(), generate3d(kind, 1500, 3))).collect();
    inputs.extend([
        ("grid", clouds::shuffled(&clouds::grid(10), 1)),
        ("duplicates", clouds::thirty_percent_duplicates(1500)),
        ("clusters", clouds::clusters_at_1e_9_spacing(1500)),
    ]);
    for (name, points) in inputs {
        let expected: Mesh3 = cpu::delaunay::<3>((&points).into(), &Options::default()).unwrap();
        for tiles in [1, 2, 5] {
            let (mesh, fallbacks) = in_tiles::<3, 4>(&devices, &points, tiles);
            assert_eq!(fallbacks, [], "{name} in {tiles} tiles");
            assert!(mesh.canonical() == expected.canonical(), "{name} in {tiles} tiles");
            assert_eq!((&mesh.duplicate_of, mesh.hull.len()), (&expected.duplicate_of, expected.hull.len()), "{name}");
            let report = verify3d(&points, &mesh).unwrap();
            assert!(report.passed(), "{name} in {tiles} tiles: {report}");
        }
    }
    for kind in Distribution2::ALL {
        let points = generate2d(kind, 1500, 3);
        let expected: Mesh2 = cpu::delaunay::<2>((&points).into(), &Options::default()).unwrap();
        let (mesh, fallbacks) = in_tiles::<2, 3>(&devices, &points, 3);
        // On two lines, flips wait for each other.
        assert!(fallbacks.is_empty() || kind == Distribution2::TwoLines, "{}: {fallbacks:?}", kind.name());
        assert!(mesh.canonical() == expected.canonical(), "{}", kind.name());
        assert_eq!((&mesh.duplicate_of, &mesh.hull), (&expected.duplicate_of, &expected.hull), "{}", kind.name());
        let report = verify2d(&points, &mesh).unwrap();
        assert!(report.passed(), "{}: {report}", kind.name());
    }
}

#[test]
fn a_device_that_cannot_triangulate_a_tile_says_so() {
    let points = generate3d(Distribution3::Uniform, 100, 3);
    let plan = Plan::new(Survey::new(&points, 0, 10).unwrap(), 1);
    let mut tile = Tile::<3, 4>::new(plan, 0, points, (0..100).collect()).unwrap();
    let none = Triangulator::new().adapter(AdapterChoice::Name("no such adapter".into())).backend(Backend::Gpu);
    assert_eq!(tile.step_on(&none, Vec::new()), Ok(Vec::new()));
    assert!(matches!(tile.step_on(&none, Vec::new()), Err(Error::AdapterNotFound { .. })));
}
