//! A mesh whose points come and go is the one of a run from scratch, on the device as on the host.

use crate::motions;
use gdel::{
    Backend, DeviceMesh2, DeviceMesh3, Error, Mesh2, Mesh3, Outputs, Points2, Points3, Triangulator,
    internals::gpu::{AdapterChoice, Gpu},
    stats::Restart,
    verify2d, verify3d, wgpu,
};
use pollster::block_on;
use std::ops::ControlFlow;

fn gpu() -> Triangulator {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("a device");
    Triangulator::from_device(gpu.device().clone(), gpu.queue().clone()).backend(Backend::Gpu)
}

macro_rules! tests {
    ($module:ident, $D:literal, $mesh:ident, $device:ident, $points:ident, $delaunay:ident, $verify:ident,
     $from_buffer:ident) => {
        mod $module {
            use super::*;

            /// The mesh is that of a run from scratch on the points that are used.
            fn same(points: &[[f64; $D]], mesh: &$mesh) {
                let mut compact = mesh.clone();
                let kept = compact.compact();
                let used: Vec<_> = kept.iter().map(|&i| points[i as usize]).collect();
                let cpu = Triangulator::new().backend(Backend::Cpu);
                let expected = cpu.$delaunay(&used).expect("triangulates");
                assert!(compact.canonical() == expected.canonical(), "{:?}", mesh.stats.update);
                assert_eq!(compact.duplicate_of, expected.duplicate_of);
                assert_eq!(compact.dimension, expected.dimension);
                let report = $verify(points, mesh).expect("verifies");
                assert!(report.passed(), "{report}");
                assert_eq!(report.counts.unused_points, points.len() - used.len());
            }

            fn read(mesh: &$device) -> $mesh {
                mesh.read(Outputs::ALL).expect("reads")
            }

            #[test]
            fn points_come_and_go_on_the_device() {
                let triangulator = gpu();
                for all in [
                    motions::uniform::<$D>(700, 1),
                    motions::grid::<$D>(if $D == 3 { 8 } else { 24 }),
                    motions::with_duplicates::<$D>(700, 400, 2),
                ] {
                    let few = all.len() - 20;
                    let mut mesh: $device =
                        triangulator.device().expect("opens").$delaunay(&all[..few]).expect("triangulates");
                    assert_eq!(mesh.stats().update, None);
                    let mut points = all[..few].to_vec();
                    for n in [few + 1, few + 1, few + 7, all.len()] {
                        let known = points.len();
                        let inserted = triangulator.insert(&mut mesh, &mut points, &all[known..n]).expect("inserts");
                        assert_eq!(inserted, known as u32..n as u32);
                        let update = mesh.stats().update.expect("the mesh was changed");
                        assert_eq!((update.restarted, update.on_host), (None, true));
                        same(&all[..n], &read(&mesh));
                    }
                    for removed in [&[][..], &[5], &[0, 1, 2], &[few as u32, 99]] {
                        triangulator.remove(&mut mesh, $points::from(&all), removed).expect("removes");
                        let update = mesh.stats().update.expect("the mesh was changed");
                        assert_eq!((update.restarted, update.on_host), (None, true));
                        same(&all, &read(&mesh));
                    }
                    // What the device made is as unaware of the unused points as of duplicates.
                    let simplex = mesh.read_vertex_simplex().expect("reads");
                    assert!([0, 1, 2, 5, 99].iter().all(|&i: &usize| simplex[i] == gdel::NONE));

                    // The points move.
                    for share in [0.0, 1e-3, 10.0] {
                        let to = motions::jitter(&all, share, 3);
                        triangulator.update(&mut mesh, $points::from(&to)).expect("follows");
                        let update = mesh.stats().update.expect("the mesh was changed");
                        assert!(update.on_host);
                        assert_eq!(update.restarted, Some(Restart::NotResident));
                        same(&to, &read(&mesh));
                    }
                    let to = motions::jitter(&all, 10.0, 3);
                    let kept = mesh.compact().expect("compacts");
                    assert_eq!((kept.len(), mesh.point_count()), (all.len() - 6, all.len() - 6));
                    let left: Vec<_> = kept.iter().map(|&i| to[i as usize]).collect();
                    same(&left, &read(&mesh));
                    // Now the device does it again.
                    triangulator.update(&mut mesh, $points::from(&left)).expect("follows");
                    assert!(!mesh.stats().update.expect("the mesh was changed").on_host);
                    same(&left, &read(&mesh));
                }
            }

            #[test]
            fn points_of_a_buffer_move_after_some_were_removed() {
                let device = block_on(Gpu::open(&AdapterChoice::Default)).expect("a device");
                let triangulator = Triangulator::from_device(device.device().clone(), device.queue().clone());
                let triangulator = triangulator.backend(Backend::Gpu);
                let points = motions::uniform::<$D>(300, 4);
                let single: Vec<_> = points.iter().map(|p| p.map(|x| x as f32)).collect();
                let points: Vec<_> = single.iter().map(|p| p.map(f64::from)).collect();
                let bytes: &[u8] = bytemuck::cast_slice(&single);
                let buffer = device.device().create_buffer(&wgpu::BufferDescriptor {
                    label: None,
                    size: bytes.len() as u64,
                    usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                });
                device.queue().write_buffer(&buffer, 0, bytes);
                let mut mesh = triangulator.device().expect("opens").$delaunay(&points).expect("triangulates");
                triangulator.remove(&mut mesh, $points::from(&points), &[7]).expect("removes");
                triangulator.device().expect("opens").$from_buffer(&mut mesh, &buffer).expect("follows");
                same(&points, &read(&mesh));
            }

            #[test]
            fn what_begins_anew_is_made_by_the_device() {
                let triangulator = gpu();
                let all = motions::uniform::<$D>(600, 5);
                let mut mesh = triangulator.device().expect("opens").$delaunay(&all[..300]).expect("triangulates");
                triangulator.insert(&mut mesh, &mut all[..300].to_vec(), &all[300..]).expect("inserts");
                let update = mesh.stats().update.expect("the mesh was changed");
                assert_eq!((update.restarted, update.on_host), (Some(Restart::Points), false));
                assert_eq!((mesh.stats().backend, mesh.stats().fallback.clone()), (Backend::Gpu, None));
                same(&all, &read(&mesh));

                let half: Vec<u32> = (0..300).collect();
                triangulator.remove(&mut mesh, $points::from(&all), &half).expect("removes");
                let update = mesh.stats().update.expect("the mesh was changed");
                assert_eq!((update.restarted, update.on_host), (Some(Restart::Points), true));
                assert_eq!((mesh.stats().backend, mesh.stats().fallback.clone()), (Backend::Gpu, None));
                same(&all, &read(&mesh));

                // The same on the host.
                let mut mesh = triangulator.$delaunay(&all).expect("triangulates");
                triangulator.remove(&mut mesh, $points::from(&all), &half).expect("removes");
                assert_eq!(mesh.stats.update.and_then(|update| update.restarted), Some(Restart::Points));
                assert_eq!(mesh.stats.backend, Backend::Gpu);
                same(&all, &mesh);
                let to = motions::jitter(&all, 10.0, 6);
                triangulator.update(&mut mesh, $points::from(&to)).expect("follows");
                assert_eq!(mesh.stats.backend, Backend::Gpu);
                same(&to, &mesh);
            }

            #[test]
            fn flat_and_empty_meshes_on_the_device() {
                let triangulator = gpu();
                let mut points: Vec<[f64; $D]> = Vec::new();
                let mut mesh = triangulator.device().expect("opens").$delaunay(&points).expect("triangulates");
                for p in motions::grid::<$D>(3).into_iter().take(12) {
                    triangulator.insert(&mut mesh, &mut points, &[p]).expect("inserts");
                    same(&points, &read(&mesh));
                }
                for i in 0..points.len() as u32 {
                    triangulator.remove(&mut mesh, $points::from(&points), &[i]).expect("removes");
                    same(&points, &read(&mesh));
                }
                assert_eq!(mesh.compact().expect("compacts"), [0; 0]);
                assert_eq!(mesh.point_count(), 0);
            }

            #[test]
            fn errors_leave_the_mesh_on_the_device() {
                let triangulator = gpu();
                let mut points = motions::uniform::<$D>(100, 7);
                let mut mesh = triangulator.device().expect("opens").$delaunay(&points).expect("triangulates");
                let removed = triangulator.remove(&mut mesh, $points::from(&points), &[100]);
                assert!(matches!(removed, Err(Error::BadIndex { index: 100, .. })));
                let fewer = triangulator.insert(&mut mesh, &mut points[1..].to_vec(), &[]);
                assert_eq!(fewer, Err(Error::PointCount { points: 99, expected: 100 }));
                let not_finite = triangulator.insert(&mut mesh, &mut points, &[[f64::NAN; $D]]);
                assert!(matches!(not_finite, Err(Error::NotFinite { index: 100, .. })));
                assert_eq!(points.len(), 100);
                let cancel = triangulator.clone().on_progress(|_| ControlFlow::Break(()));
                assert_eq!(cancel.remove(&mut mesh, $points::from(&points), &[1]), Err(Error::Cancelled));
                assert_eq!(mesh.stats().update, None);
                same(&points, &read(&mesh));
            }
        }
    };
}
tests!(d3, 3, Mesh3, DeviceMesh3, Points3, delaunay3d, verify3d, update3d_from_buffer);
tests!(d2, 2, Mesh2, DeviceMesh2, Points2, delaunay2d, verify2d, update2d_from_buffer);
